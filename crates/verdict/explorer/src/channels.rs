//! The channels of one side of one sensor, as `docs/formats/files.md` names them, packed for a page.

use rayon::prelude::*;
use raypencil_scene::{FaceId, HitQuantity, Image, Maybe, Returns, Scene, SensorId, SensorMap};
use serde_json::{Map, Value, json};

use crate::arrays::{Arrays, Change, Packed};
use crate::derived::DerivedHit;

/// Face and pixel of a ray without one, in files.
const NOTHING: u32 = u32::MAX;

/// Share of the cells that may differ from what the page computes, as one in so many. With more, the whole channel is
/// stored: a cell that differs takes its number and its bits.
const MIN_CELLS_PER_FIX: usize = 4;

/// The answers of one side to the rays of one sensor.
#[derive(Debug, Clone, Copy)]
pub struct SideMaps<'a> {
    /// Values of the hits.
    pub map: &'a SensorMap,
    /// A beam's returns.
    pub returns: Option<&'a Returns>,
    /// Flux of each beam on the camera's image; none for a beam.
    pub flux: &'a [Option<&'a Image<f64>>],
}

/// Packs the channels of a sensor's sides, one after the other. What is the same as on the first side takes no bytes.
#[derive(Debug, Default)]
pub(crate) struct ChannelPacker {
    /// The first side's stored arrays, by channel.
    first: std::collections::BTreeMap<String, Packed>,
}

impl ChannelPacker {
    /// The channels of one side, as the page model has them.
    pub(crate) fn pack(&mut self, arrays: &mut Arrays, scene: &Scene, side: &SideMaps<'_>) -> Value {
        let mut channels = Map::new();
        let faces = side.map.face.as_ref().map(faces_of);
        if let Some(faces) = &faces {
            channels.insert("face.I".into(), self.whole(arrays, "face.I", faces));
        }
        for quantity in HitQuantity::ALL {
            let Some(raster) = side.map.raster(quantity) else { continue };
            let recorded: Vec<Vec<f32>> = (0..quantity.channels().len())
                .map(|axis| {
                    cells(side.map)
                        .into_par_iter()
                        .map(|(i, j)| {
                            let value = raster.at(i, j).map(|value| value.components()[axis] as f32);
                            value.unwrap_or_else(|| missing(quantity))
                        })
                        .collect()
                })
                .collect();
            let derived = faces.as_ref().map(|faces| derived(scene, side.map, faces, quantity));
            for (axis, name) in quantity.channels().iter().enumerate() {
                let of_page = derived.as_ref().map(|all| all[axis].as_slice());
                let packed = self.derived(arrays, name, &recorded[axis], of_page);
                channels.insert((*name).to_string(), packed);
            }
        }
        if let Some(returns) = side.returns {
            if let Some(visible) = &returns.visible {
                let bytes: Vec<u8> = visible.cells().iter().map(|seen| u8::from(*seen)).collect();
                channels.insert("visible.V".into(), json!({ "stored": arrays.u8(&bytes) }));
            }
            if let Some(pixels) = &returns.pixel {
                let axes: [(&str, Vec<u32>); 2] = [
                    ("pixel.I", pixels.cells().iter().map(|p| p.get().map_or(NOTHING, |p| p.i)).collect()),
                    ("pixel.J", pixels.cells().iter().map(|p| p.get().map_or(NOTHING, |p| p.j)).collect()),
                ];
                for (name, values) in axes {
                    channels.insert(name.into(), self.whole(arrays, name, &values));
                }
            }
            if let Some(flux) = &returns.flux {
                channels.insert("flux.V".into(), self.light(arrays, "flux.V", flux));
            }
        }
        for (beam, image) in side.flux.iter().enumerate() {
            if let Some(image) = image {
                let name = format!("flux.beam{beam}");
                let packed = self.light(arrays, &name, image);
                channels.insert(name, packed);
            }
        }
        json!({ "channels": channels })
    }

    fn whole(&mut self, arrays: &mut Arrays, name: &str, values: &[u32]) -> Value {
        let packed = match self.first.get(name) {
            Some(first) => arrays.u32_beside(values, first),
            None => {
                let packed = arrays.u32(values, Change::Delta);
                self.first.insert(name.to_string(), packed.clone());
                packed
            }
        };
        json!({ "stored": packed.reference })
    }

    fn light(&mut self, arrays: &mut Arrays, name: &str, image: &Image<f64>) -> Value {
        let values: Vec<f32> = image.cells().iter().map(|flux| *flux as f32).collect();
        self.stored(arrays, name, &values)
    }

    fn stored(&mut self, arrays: &mut Arrays, name: &str, values: &[f32]) -> Value {
        let packed = match self.first.get(name) {
            Some(first) => arrays.f32_beside(values, first),
            None => {
                let packed = arrays.f32(values, Change::None);
                self.first.insert(name.to_string(), packed.clone());
                packed
            }
        };
        json!({ "stored": packed.reference })
    }

    /// A channel that the page computes, with the cells in which the recording has other bits; the whole channel, if
    /// these are many or if the page cannot compute it.
    fn derived(
        &mut self,
        arrays: &mut Arrays,
        name: &str,
        recorded: &[f32],
        of_page: Option<&[f32]>,
    ) -> Value {
        if let Some(of_page) = of_page {
            let fixes: Vec<u32> = (0..recorded.len() as u32)
                .filter(|&cell| !is_same(recorded[cell as usize], of_page[cell as usize]))
                .collect();
            if fixes.len() * MIN_CELLS_PER_FIX <= recorded.len() {
                let bits: Vec<u32> = fixes.iter().map(|&cell| recorded[cell as usize].to_bits()).collect();
                let fixed = arrays.u32(&fixes, Change::Delta).reference;
                let bits = arrays.u32(&bits, Change::None).reference;
                return json!({ "derived": { "cells": fixed, "bits": bits } });
            }
        }
        self.stored(arrays, name, recorded)
    }
}

/// Whether two recorded numbers are the same: the same bits, or both no number.
fn is_same(a: f32, b: f32) -> bool {
    a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan())
}

/// What files have where nothing is hit.
fn missing(quantity: HitQuantity) -> f32 {
    if quantity.is_length() { f32::INFINITY } else { f32::NAN }
}

fn cells(map: &SensorMap) -> Vec<(u32, u32)> {
    (0..map.height).flat_map(|j| (0..map.width).map(move |i| (i, j))).collect()
}

/// Face of each cell. A face that the mesh does not have stays, and the page derives nothing from it.
fn faces_of(faces: &Image<Maybe<FaceId>>) -> Vec<u32> {
    faces.cells().iter().map(|face| face.get().map_or(NOTHING, |face| face.0)).collect()
}

/// What the page computes for a quantity: its components, each for all cells.
fn derived(scene: &Scene, map: &SensorMap, faces: &[u32], quantity: HitQuantity) -> Vec<Vec<f32>> {
    let mesh = scene.mesh();
    let count = quantity.channels().len();
    let local_z = match map.sensor {
        SensorId::Camera => scene.camera().sensor.focal_length,
        SensorId::Beam(beam) => scene.beams()[beam].sensor.grid_distance,
    };
    let all: Vec<[f32; 3]> = cells(map)
        .into_par_iter()
        .zip(faces)
        .map(|((i, j), &face)| {
            let ray = scene.ray(map.sensor, i, j).filter(|_| (face as usize) < mesh.faces().len());
            let Some(ray) = ray else { return [missing(quantity); 3] };
            let hit = DerivedHit::of(mesh, FaceId(face), &ray, local_z);
            [0, 1, 2].map(|axis| hit.component(quantity, axis))
        })
        .collect();
    (0..count).map(|axis| all.iter().map(|values| values[axis]).collect()).collect()
}
