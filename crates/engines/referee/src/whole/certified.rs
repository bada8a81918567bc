//! Correctly rounded values of a whole sensor: the content of reference files.

use std::collections::BTreeMap;

use rayon::prelude::*;
use raypencil_scene::{FluxModel, Image, Pixel, Quantities, Returns, Sampling, SensorId, SensorMap};

use crate::hits::values::{RoundedHit, values};
use crate::hits::verdict::Referee;
use crate::light::beam_returns::{BeamReturns, Contribution, RoundedReturn};
use crate::light::flux::Flux;
use crate::numbers::rounding::Format;
use crate::rays::ray::{Aim, MountedSensor};

/// The hit of each ray of a sensor.
#[derive(Debug, Clone, PartialEq)]
pub struct CertifiedMap {
    /// The sensor.
    pub sensor: SensorId,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// The hits, in row-major order; `None` for a miss.
    pub hits: Vec<Option<RoundedHit>>,
}

/// The return of each pencil of a beam, and their sums on the camera's image.
#[derive(Debug, Clone, PartialEq)]
pub struct CertifiedReturns {
    /// Columns of the beam.
    pub columns: u32,
    /// Rows of the beam.
    pub rows: u32,
    /// The returns of the pencils, in row-major order; `None` for a miss.
    pub returns: Vec<Option<RoundedReturn>>,
    /// Columns and rows of the camera's image.
    pub image: (u32, u32),
    /// The pixels that receive light, in row-major order, with the sum over their pencils.
    pub sums: Vec<(Pixel, PixelSum)>,
}

/// The flux that one pixel receives from one beam.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PixelSum {
    /// Number of pencils in the sum.
    pub pencils: u32,
    /// Flux by the model `radiometric`, watts.
    pub radiometric: Flux,
    /// Flux by the model `eq1`, W/m.
    pub eq1: Flux,
}

impl PixelSum {
    /// The flux by a model.
    pub fn flux(&self, model: FluxModel) -> Flux {
        match model {
            FluxModel::Radiometric => self.radiometric,
            FluxModel::Eq1 => self.eq1,
        }
    }
}

impl CertifiedMap {
    /// The map with values rounded to f64, or to f32 and stored as f64.
    pub fn in_format(&self, format: Format, quantities: Quantities) -> SensorMap {
        let mut map = SensorMap::empty(self.sensor, self.width, self.height, quantities);
        for (mut row, hits) in map.rows_mut().into_iter().zip(self.hits.chunks(self.width as usize)) {
            for (i, hit) in (0..).zip(hits) {
                if let Some(hit) = hit {
                    row.put(i, &hit.in_format(format));
                }
            }
        }
        map
    }
}

impl CertifiedReturns {
    /// The returns with values rounded to f64 or f32.
    pub fn returns_in(&self, format: Format, model: FluxModel) -> Returns {
        let mut returns = Returns::empty(self.columns, self.rows);
        let cells = (0..self.rows).flat_map(|j| (0..self.columns).map(move |i| (i, j)));
        for ((i, j), back) in cells.zip(&self.returns) {
            if let Some(back) = back {
                returns.put(i, j, &back.in_format(format, model));
            }
        }
        returns
    }

    /// The flux on the camera's image, rounded to f64 or f32.
    pub fn image_in(&self, format: Format, model: FluxModel) -> Image<f64> {
        let mut image = Image::filled(self.image.0, self.image.1, 0.0);
        for (pixel, sum) in &self.sums {
            let flux = sum.flux(model).unwrap_or_else(|undecided| undecided.0);
            image.set(pixel.i, pixel.j, flux.in_format(format));
        }
        image
    }

    /// Number of values whose rounding stayed [`Undecided`](crate::Undecided).
    pub fn undecided(&self) -> usize {
        let models = [FluxModel::Radiometric, FluxModel::Eq1];
        let of =
            |flux: &dyn Fn(FluxModel) -> Flux| models.iter().filter(|model| flux(**model).is_err()).count();
        let pencils = self.returns.iter().flatten().map(|back| of(&|model| back.flux(model)));
        let pixels = self.sums.iter().map(|(_, sum)| of(&|model| sum.flux(model)));
        pencils.chain(pixels).sum()
    }
}

impl Referee<'_> {
    /// The hits of all rays of a sensor; `None` if there is no such sensor.
    ///
    /// ```
    /// # mod wall { include!(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/common/wall.rs")); }
    /// # use wall::wall_scene;
    /// use raypencil_referee::Referee;
    /// use raypencil_scene::{Sampling, SensorId};
    ///
    /// let scene = wall_scene();
    /// let map = Referee::new(&scene).certified_map(SensorId::Camera, Sampling::Centres).unwrap();
    /// // The wall covers the columns 0 to 4 of all nine rows, at a depth of 2 m.
    /// assert_eq!(map.hits.iter().flatten().count(), 5 * 9);
    /// assert!(map.hits.iter().flatten().all(|hit| hit.depth.double == 2.0));
    /// ```
    pub fn certified_map(&self, id: SensorId, sampling: Sampling) -> Option<CertifiedMap> {
        let sensor = MountedSensor::of(self.scene, id)?;
        let (width, height) = sensor.size();
        let row = |j: u32| {
            (0..width).map(move |i| {
                let [dx, dy] = match id {
                    SensorId::Camera => [0.0; 2],
                    SensorId::Beam(index) => sampling.offset(index, i, j),
                };
                let aim = Aim { i, j, dx, dy };
                self.nearest(&sensor, aim).first().and_then(|face| values(&sensor, aim, face))
            })
        };
        let hits = (0..height).into_par_iter().flat_map_iter(row).collect();
        Some(CertifiedMap { sensor: id, width, height, hits })
    }

    /// The returns of all pencils of a beam; `None` if there is no such beam.
    pub fn certified_returns(&self, beam: usize, sampling: Sampling) -> Option<CertifiedReturns> {
        let light = self.light(beam, sampling)?;
        let beam = &self.scene.beams()[beam].sensor;
        let camera = &self.scene.camera().sensor;
        let returned = |j: u32| {
            let light = &light;
            (0..beam.columns).map(move |i| light.returned_of_face(i, j))
        };
        let rows: Vec<_> = (0..beam.rows).into_par_iter().flat_map_iter(returned).collect();

        // Group the contributing pencils by pixel, each group in row-major order.
        let mut pixels: BTreeMap<(u32, u32), Vec<Contribution>> = BTreeMap::new();
        let cells = (0..beam.rows).flat_map(|j| (0..beam.columns).map(move |i| (i, j)));
        for ((i, j), found) in cells.zip(&rows) {
            if let Some((face, RoundedReturn { visible: true, pixel: Some(pixel), .. })) = found {
                let pencil = Contribution { i, j, face: *face, pixel: *pixel };
                pixels.entry((pixel.j, pixel.i)).or_default().push(pencil);
            }
        }
        let sums = pixels.into_par_iter().map(|((j, i), pencils)| (Pixel { i, j }, sum(&light, &pencils)));
        Some(CertifiedReturns {
            columns: beam.columns,
            rows: beam.rows,
            sums: sums.collect(),
            returns: rows.into_iter().map(|found| found.map(|(_, back)| back)).collect(),
            image: (camera.width, camera.height),
        })
    }
}

fn sum(light: &BeamReturns<'_, '_>, pencils: &[Contribution]) -> PixelSum {
    PixelSum {
        pencils: pencils.len() as u32,
        radiometric: light.sum(FluxModel::Radiometric, pencils),
        eq1: light.sum(FluxModel::Eq1, pencils),
    }
}
