//! What a renderer returns: per sensor, a raster of each quantity asked for and known.

use std::time::Duration;

use glam::DVec3;

use crate::{FaceId, Hit, Image, Maybe, Returns, Sampling, SensorId};

/// The quantities to render.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Request {
    /// The camera's own range map.
    pub camera: bool,
    /// The maps of every beam.
    pub beams: bool,
    /// Visibility and flux of the pencils, and the flux on the camera's image.
    pub returns: bool,
    /// The ray that represents a pencil, in the maps of the beams and in their returns.
    pub sampling: Sampling,
    /// Which quantities of each map.
    pub quantities: Quantities,
}

impl Request {
    /// Every quantity of every sensor.
    pub const EVERYTHING: Self = Self {
        camera: true,
        beams: true,
        returns: true,
        sampling: Sampling::Centres,
        quantities: Quantities::ALL,
    };
    /// Range maps only: no visibility, no flux.
    pub const MAPS: Self = Self { returns: false, ..Self::EVERYTHING };
    /// Only the flux of each beam on the camera's image: no maps.
    pub const FLUX: Self =
        Self { camera: false, beams: false, quantities: Quantities::NONE, ..Self::EVERYTHING };
    /// Nothing at all.
    pub const NOTHING: Self = Self { returns: false, ..Self::FLUX };
}

/// The quantities of a map to fill. A quantity that is left out costs neither time nor memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Quantities {
    /// Distance along the ray.
    pub range: bool,
    /// Distance along the sensor's normal axis.
    pub depth: bool,
    /// The face hit.
    pub face: bool,
    /// The point hit.
    pub point: bool,
    /// The face's normal.
    pub normal: bool,
    /// The cosine of incidence.
    pub cos_incidence: bool,
}

impl Quantities {
    /// None of them.
    pub const NONE: Self =
        Self { range: false, depth: false, face: false, point: false, normal: false, cos_incidence: false };
    /// All of them.
    pub const ALL: Self =
        Self { range: true, depth: true, face: true, point: true, normal: true, cos_incidence: true };
    /// The paper's range raster map alone, with the face that each range belongs to.
    pub const RANGE_MAP: Self =
        Self { range: true, depth: false, face: true, point: false, normal: false, cos_incidence: false };
}

/// The maps of one sensor. Every quantity is optional; within one, a cell without a hit is `None`.
#[derive(Debug, Clone, PartialEq)]
pub struct SensorMap {
    /// Whose cells these are.
    pub sensor: SensorId,
    /// Columns of every raster.
    pub width: u32,
    /// Rows of every raster.
    pub height: u32,
    /// [`Hit::range`], metres.
    pub range: Option<Image<Maybe<f64>>>,
    /// [`Hit::depth`], metres.
    pub depth: Option<Image<Maybe<f64>>>,
    /// [`Hit::face`].
    pub face: Option<Image<Maybe<FaceId>>>,
    /// [`Hit::point`], scene frame, metres.
    pub point: Option<Image<Maybe<DVec3>>>,
    /// [`Hit::normal`], scene frame.
    pub normal: Option<Image<Maybe<DVec3>>>,
    /// [`Hit::cos_incidence`].
    pub cos_incidence: Option<Image<Maybe<f64>>>,
}

impl SensorMap {
    /// Empty maps (no hit anywhere) of the `quantities` asked for.
    pub fn empty(sensor: SensorId, width: u32, height: u32, quantities: Quantities) -> Self {
        Self::of::<true>(sensor, width, height, quantities)
    }

    /// Maps of the `quantities` asked for whose cells are yet to be written, *every one of them*: by
    /// [`SensorRow::put`] or [`SensorRow::put_miss`]. For renderers: to fill large maps with misses first takes as long as
    /// to render them.
    pub fn unwritten(sensor: SensorId, width: u32, height: u32, quantities: Quantities) -> Self {
        Self::of::<false>(sensor, width, height, quantities)
    }

    fn of<const MISSES: bool>(sensor: SensorId, width: u32, height: u32, quantities: Quantities) -> Self {
        fn raster<const MISSES: bool, T: crate::Sample>(
            wanted: bool,
            width: u32,
            height: u32,
        ) -> Option<Image<Maybe<T>>> {
            let new = || {
                if MISSES { Image::filled(width, height, Maybe::NONE) } else { Image::zeroed(width, height) }
            };
            wanted.then(new)
        }
        Self {
            sensor,
            width,
            height,
            range: raster::<MISSES, _>(quantities.range, width, height),
            depth: raster::<MISSES, _>(quantities.depth, width, height),
            face: raster::<MISSES, _>(quantities.face, width, height),
            point: raster::<MISSES, _>(quantities.point, width, height),
            normal: raster::<MISSES, _>(quantities.normal, width, height),
            cos_incidence: raster::<MISSES, _>(quantities.cos_incidence, width, height),
        }
    }

    /// The rows of all rasters, to be filled in any order and on any thread.
    pub fn rows_mut(&mut self) -> Vec<SensorRow<'_>> {
        fn rows<T: Copy>(raster: &mut Option<Image<T>>, width: usize) -> impl Iterator<Item = &mut [T]> {
            raster.as_mut().map(|image| image.cells_mut().chunks_exact_mut(width)).into_iter().flatten()
        }
        let width = self.width as usize;
        let mut range = rows(&mut self.range, width);
        let mut depth = rows(&mut self.depth, width);
        let mut face = rows(&mut self.face, width);
        let mut point = rows(&mut self.point, width);
        let mut normal = rows(&mut self.normal, width);
        let mut cos_incidence = rows(&mut self.cos_incidence, width);
        (0..self.height)
            .map(|j| SensorRow {
                j,
                range: range.next(),
                depth: depth.next(),
                face: face.next(),
                point: point.next(),
                normal: normal.next(),
                cos_incidence: cos_incidence.next(),
            })
            .collect()
    }

    /// Number of cells of each raster.
    pub fn cell_count(&self) -> usize {
        self.width as usize * self.height as usize
    }
}

/// One row of a sensor's maps, to be written.
#[derive(Debug)]
pub struct SensorRow<'a> {
    /// Which row.
    pub j: u32,
    /// Its cells of [`SensorMap::range`].
    pub range: Option<&'a mut [Maybe<f64>]>,
    /// Its cells of [`SensorMap::depth`].
    pub depth: Option<&'a mut [Maybe<f64>]>,
    /// Its cells of [`SensorMap::face`].
    pub face: Option<&'a mut [Maybe<FaceId>]>,
    /// Its cells of [`SensorMap::point`].
    pub point: Option<&'a mut [Maybe<DVec3>]>,
    /// Its cells of [`SensorMap::normal`].
    pub normal: Option<&'a mut [Maybe<DVec3>]>,
    /// Its cells of [`SensorMap::cos_incidence`].
    pub cos_incidence: Option<&'a mut [Maybe<f64>]>,
}

impl SensorRow<'_> {
    /// Writes those quantities of a hit that the maps hold into column `i`.
    #[inline]
    pub fn put(&mut self, i: u32, hit: &Hit) {
        self.put_place(i, hit.face, hit.range, hit.depth, hit.point);
        self.put_plane(i, hit.normal, hit.cos_incidence);
    }

    /// Writes "no hit" into column `i` of all maps.
    #[inline]
    pub fn put_miss(&mut self, i: u32) {
        fn clear<T: crate::Sample>(row: &mut Option<&mut [Maybe<T>]>, i: u32) {
            if let Some(cells) = row {
                cells[i as usize] = Maybe::NONE;
            }
        }
        clear(&mut self.range, i);
        clear(&mut self.depth, i);
        clear(&mut self.face, i);
        clear(&mut self.point, i);
        clear(&mut self.normal, i);
        clear(&mut self.cos_incidence, i);
    }

    /// Writes those of a hit's face, range, depth and point that the maps hold into column `i`.
    #[inline]
    pub fn put_place(&mut self, i: u32, face: FaceId, range: f64, depth: f64, point: DVec3) {
        write(&mut self.range, i, range);
        write(&mut self.depth, i, depth);
        write(&mut self.face, i, face);
        write(&mut self.point, i, point);
    }

    /// Writes those of a hit's normal and cosine of incidence that the maps hold into column `i`.
    #[inline]
    pub fn put_plane(&mut self, i: u32, normal: DVec3, cos_incidence: f64) {
        write(&mut self.normal, i, normal);
        write(&mut self.cos_incidence, i, cos_incidence);
    }

    /// Whether the maps hold the normal or the cosine of incidence, for which the face's plane is needed.
    pub fn wants_the_plane(&self) -> bool {
        self.normal.is_some() || self.cos_incidence.is_some()
    }
}

#[inline]
fn write<T: crate::Sample>(row: &mut Option<&mut [Maybe<T>]>, i: u32, value: T) {
    if let Some(cells) = row {
        cells[i as usize] = Maybe::some(value);
    }
}

/// All results of one renderer for one scene.
#[derive(Debug, Clone)]
pub struct RenderOutput {
    /// The camera's maps, if they were asked for and are known.
    pub camera: Option<SensorMap>,
    /// The maps of each beam, in the scene's order; empty if not asked for.
    pub beams: Vec<SensorMap>,
    /// The returns of each beam, in the scene's order; empty if not asked for.
    pub returns: Vec<Returns>,
    /// The flux of each beam on the camera's image, in the scene's order, watts per pixel (`eq1`: W/m); empty if
    /// not asked for or not known.
    pub flux: Vec<Image<f64>>,
    /// Wall-clock time of each part of the work, in order.
    pub stages: Vec<Stage>,
}

impl RenderOutput {
    /// The maps of one sensor.
    pub fn map(&self, sensor: SensorId) -> Option<&SensorMap> {
        match sensor {
            SensorId::Camera => self.camera.as_ref(),
            SensorId::Beam(index) => self.beams.get(index),
        }
    }

    /// The maps of all sensors, the camera's first.
    pub fn maps(&self) -> impl Iterator<Item = &SensorMap> {
        self.camera.iter().chain(&self.beams)
    }
}

/// A named part of a render and the wall-clock time it took. Times are reported, never compared.
#[derive(Debug, Clone, PartialEq)]
pub struct Stage {
    /// Name of the part.
    pub name: String,
    /// Wall-clock time.
    pub time: Duration,
}
