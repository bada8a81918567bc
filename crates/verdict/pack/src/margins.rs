//! The margins of a sensor's rays, as channels: how far each ray is from another answer.
//!
//! A channel holds the proven lower bound `lo`, rounded down to f32: no ray displaced by less has another answer.

use rayon::prelude::*;
use raypencil_referee::Referee;
use raypencil_scene::{Image, Scene, SensorId};

use crate::canonical_nan::CANONICAL_NAN;

/// The margins of one sensor's rays.
#[derive(Debug)]
pub(crate) struct SensorMargins {
    /// Until the set of nearest faces changes, cells.
    face: Image<f64>,
    /// Until a hit becomes a miss, or the range jumps, cells.
    surface: Image<f64>,
    /// Beams only. Until the hit becomes visible or hidden, cells; until it lands in another pixel, camera pixels.
    visibility_and_landing: Option<[Image<f64>; 2]>,
}

impl SensorMargins {
    pub(crate) fn find(referee: &Referee<'_>, scene: &Scene, sensor: SensorId) -> Self {
        let (width, height) = scene.size(sensor).expect("a sensor of this scene");
        let row = |j: u32| {
            (0..width).map(move |i| {
                let margins = referee.margins(sensor, i, j).expect("a cell of this sensor");
                let (visibility, landing) = match sensor {
                    SensorId::Camera => (CANONICAL_NAN, CANONICAL_NAN),
                    SensorId::Beam(beam) => match referee.visibility_margins(beam, i, j) {
                        Some(beam) => {
                            (beam.visibility.lo, beam.landing.map_or(CANONICAL_NAN, |[lo, _]| lo.min(1.0)))
                        }
                        None => (CANONICAL_NAN, CANONICAL_NAN),
                    },
                };
                [margins.face.lo, margins.surface.lo, visibility, landing].map(round_down_to_f32)
            })
        };
        let cells: Vec<[f64; 4]> = (0..height).into_par_iter().flat_map_iter(row).collect();
        let image = |k: usize| Image::from_cells(width, height, cells.iter().map(|cell| cell[k]).collect());
        let visibility_and_landing = (sensor != SensorId::Camera).then(|| [image(2), image(3)]);
        Self { face: image(0), surface: image(1), visibility_and_landing }
    }

    /// Name, unit and cells of each channel.
    pub(crate) fn channels(&self) -> Vec<(&'static str, &'static str, &Image<f64>)> {
        let mut channels =
            vec![("margin.face", "cell", &self.face), ("margin.surface", "cell", &self.surface)];
        if let Some([visibility, landing]) = &self.visibility_and_landing {
            channels.push(("margin.visibility", "cell", visibility));
            channels.push(("margin.landing", "pixel", landing));
        }
        channels
    }
}

/// The largest f32 that is at most `margin`. A lower bound stays one, and f32 files hold the same numbers as f64 files.
fn round_down_to_f32(margin: f64) -> f64 {
    if margin.is_nan() {
        return CANONICAL_NAN;
    }
    let single = margin as f32;
    f64::from(if f64::from(single) > margin { single.next_down() } else { single })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_margin_is_rounded_to_the_largest_single_that_is_no_larger() {
        // The single that is nearest to 0.1 is above it, and that to 0.7 below it.
        assert!(f64::from(0.1_f32) > 0.1 && f64::from(0.7_f32) < 0.7);
        assert_eq!(round_down_to_f32(0.1), f64::from(0.1_f32.next_down()));
        assert_eq!(round_down_to_f32(0.7), f64::from(0.7_f32));
        for exact in [0.0, 0.375, 1.0, f64::INFINITY] {
            assert_eq!(round_down_to_f32(exact), exact);
        }
        assert_eq!(round_down_to_f32(f64::NAN).to_bits(), CANONICAL_NAN.to_bits());
    }
}
