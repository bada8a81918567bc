//! One sensor of the page model: its geometry, its sides, its pairs and the margins of its rays.

use rayon::prelude::*;
use raypencil_judge::Judge;
use raypencil_scene::{Place, Scene, SensorId};
use serde_json::{Value, json};

use crate::arrays::{Arrays, Change};
use crate::pair::SensorPair;

/// Maximum number of rays of a sensor whose margins a page has.
const MAX_MARGINS: usize = 100_000;

/// Margins of some rays of a sensor: how far each is from another answer, by the lower bounds that the referee proves.
#[derive(Debug, Clone, Default)]
pub struct RayMargins {
    /// Number of the cell: row times width, plus column; ascending.
    pub cells: Vec<u32>,
    /// Until the set of nearest faces changes, cells; at most 1.
    pub face: Vec<f32>,
    /// Until a hit becomes a miss, or the range jumps, cells; at most 1.
    pub surface: Vec<f32>,
    /// Beams: until a hit becomes visible or hidden, cells; NaN where nothing is hit. Empty for the camera.
    pub visibility: Vec<f32>,
    /// Beams: until a hit lands in another pixel, camera pixels; NaN where it lands in none. Empty for the camera.
    pub landing: Vec<f32>,
}

impl RayMargins {
    /// Margins of the rays of a sensor that the judge ruled on: those that differ, and the sample of those that agree.
    /// Of more than a hundred thousand a fair share.
    pub fn of_judged(judge: &Judge<'_>, sensor: SensorId, pairs: &[SensorPair<'_>]) -> Self {
        let (width, height) = judge.scene().size(sensor).expect("a sensor of this scene");
        let mut cells: Vec<u32> = (0..width * height)
            .filter(|cell| judge.samples(Place { sensor, i: cell % width, j: cell / width }))
            .collect();
        let differing = pairs.iter().flat_map(|pair| &pair.result.differing);
        cells.extend(differing.map(|ray| ray.j * width + ray.i));
        cells.sort_unstable();
        cells.dedup();
        let stride = cells.len().div_ceil(MAX_MARGINS).max(1);
        let cells: Vec<u32> = cells.into_iter().step_by(stride).collect();
        let referee = judge.referee();
        let all: Vec<[f32; 4]> = cells
            .par_iter()
            .map(|cell| {
                let (i, j) = (cell % width, cell / width);
                let margins = referee.margins(sensor, i, j).expect("a cell of this sensor");
                let of_view = match sensor {
                    SensorId::Camera => None,
                    SensorId::Beam(beam) => referee.visibility_margins(beam, i, j),
                };
                let visibility = of_view.as_ref().map_or(f64::NAN, |margins| margins.visibility.lo);
                let landing = of_view.and_then(|margins| margins.landing);
                let landing = landing.map_or(f64::NAN, |[lo, _]| lo.min(1.0));
                [margins.face.lo, margins.surface.lo, visibility, landing].map(rounded_down)
            })
            .collect();
        let of = |k: usize| all.iter().map(|margins| margins[k]).collect();
        let of_beam = |k: usize| if sensor == SensorId::Camera { Vec::new() } else { of(k) };
        Self { face: of(0), surface: of(1), visibility: of_beam(2), landing: of_beam(3), cells }
    }

    pub(crate) fn model(&self, arrays: &mut Arrays) -> Value {
        if self.cells.is_empty() {
            return Value::Null;
        }
        let mut margins = |values: &[f32]| match values {
            [] => Value::Null,
            values => arrays.f32(values, Change::None).reference,
        };
        let [face, surface, visibility, landing] =
            [&self.face, &self.surface, &self.visibility, &self.landing].map(|values| margins(values));
        json!({
            "cells": arrays.u32(&self.cells, Change::Delta).reference,
            "face": face, "surface": surface, "visibility": visibility, "landing": landing,
        })
    }
}

/// The largest f32 that is at most `margin`: a lower bound stays one.
fn rounded_down(margin: f64) -> f32 {
    let single = margin as f32;
    if f64::from(single) > margin { single.next_down() } else { single }
}

/// Name, size, pose and rays of a sensor; its sides, pairs and margins are added by the caller.
pub(crate) fn sensor_model(scene: &Scene, sensor: SensorId) -> Value {
    let (width, height) = scene.size(sensor).expect("a sensor of this scene");
    let pose = match sensor {
        SensorId::Camera => scene.camera().scene_from_sensor,
        SensorId::Beam(index) => scene.beams()[index].scene_from_sensor,
    };
    let camera = (sensor == SensorId::Camera).then(|| {
        let camera = scene.camera().sensor;
        json!({
            "pixel_pitch": camera.pixel_pitch,
            "principal_point": camera.principal_point,
            "focal_length": camera.focal_length,
        })
    });
    let beam = match sensor {
        SensorId::Camera => None,
        SensorId::Beam(index) => Some(index),
    };
    let grid = beam.map(|index| {
        let beam = scene.beams()[index].sensor;
        json!({ "half_width": beam.half_width, "thickness": beam.thickness, "grid_distance": beam.grid_distance })
    });
    json!({
        "name": sensor.to_string(),
        "kind": if beam.is_some() { "beam" } else { "camera" },
        "beam": beam,
        "width": width, "height": height,
        "max_range": scene.max_range(sensor),
        "pose": {
            "position": pose.position.to_array(),
            "quaternion": [pose.rotation.x, pose.rotation.y, pose.rotation.z, pose.rotation.w],
        },
        "camera": camera,
        "grid": grid,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_margin_of_a_page_is_the_largest_single_number_below_it() {
        let margins = [0.1, 0.3, 0.7, 1.0 / 3.0, 1e-9, 0.5, 1.0, 1e-60, 0.0];
        for margin in margins {
            let on_page = rounded_down(margin);
            assert!(
                f64::from(on_page) <= margin && margin < f64::from(on_page.next_up()),
                "{margin}: {on_page}"
            );
        }
        // The nearest numbers of some lie above them, and of some below.
        let above = margins.iter().filter(|margin| f64::from(**margin as f32) > **margin).count();
        assert!(above > 1 && above < margins.len() - 3, "{above}");
        assert!(rounded_down(f64::NAN).is_nan());
    }
}
