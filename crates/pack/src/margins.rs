//! How far the answer to each ray is from changing: the margins of a sensor, as channels.
//!
//! What is written is the proven end, lo, rounded down to f32: no ray displaced by less has another answer.

use rayon::prelude::*;

use raypencil_referee::Referee;
use raypencil_scene::{Image, Scene, SensorId};

/// The margins of one sensor's rays.
#[derive(Debug)]
pub(crate) struct SensorMargins {
    /// Cells: the set of nearest faces.
    face: Image<f64>,
    /// Cells: hit or miss, or a jump of the range.
    surface: Image<f64>,
    /// Of a beam: cells, whether the hit is seen; and camera pixels, from the border of the pixel it lands in.
    sight: Option<[Image<f64>; 2]>,
}

/// The one NaN that stands for nothing.
const NOTHING: f64 = f64::from_bits(0x7ff8_0000_0000_0000);

impl SensorMargins {
    pub(super) fn find(referee: &Referee<'_>, scene: &Scene, sensor: SensorId) -> Self {
        let (width, height) = scene.size(sensor).expect("a sensor of this scene");
        let of = |j: u32| {
            (0..width).map(move |i| {
                let margins = referee.margins(sensor, i, j).expect("a cell of this sensor");
                let (visibility, landing) = match sensor {
                    SensorId::Camera => (NOTHING, NOTHING),
                    SensorId::Beam(beam) => match referee.visibility_margins(beam, i, j) {
                        Some(sight) => {
                            (sight.visibility.lo, sight.landing.map_or(NOTHING, |[lo, _]| lo.min(1.0)))
                        }
                        None => (NOTHING, NOTHING),
                    },
                };
                [margins.face.lo, margins.surface.lo, visibility, landing].map(single_below)
            })
        };
        let cells: Vec<[f64; 4]> = (0..height).into_par_iter().flat_map_iter(of).collect();
        let image = |k: usize| Image::from_cells(width, height, cells.iter().map(|cell| cell[k]).collect());
        let sight = (sensor != SensorId::Camera).then(|| [image(2), image(3)]);
        Self { face: image(0), surface: image(1), sight }
    }

    /// Name, unit and cells of each channel.
    pub(super) fn channels(&self) -> Vec<(&'static str, &'static str, &Image<f64>)> {
        let mut channels =
            vec![("margin.face", "cell", &self.face), ("margin.surface", "cell", &self.surface)];
        if let Some([visibility, landing]) = &self.sight {
            channels.push(("margin.visibility", "cell", visibility));
            channels.push(("margin.landing", "pixel", landing));
        }
        channels
    }
}

/// The nearest f32 that is not above, so that what is proven of the one is proven of the other, and f32 files hold
/// the same numbers.
fn single_below(margin: f64) -> f64 {
    if margin.is_nan() {
        return NOTHING;
    }
    let single = margin as f32;
    f64::from(if f64::from(single) > margin { single.next_down() } else { single })
}
