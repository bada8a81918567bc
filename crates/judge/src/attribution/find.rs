//! Finds the causes of one frame, first of what is hit, then of what the camera sees.

use std::collections::HashMap;

use raypencil_scene::{Place, Precision, RenderOutput, Switches};

use crate::attribution::cause::Attributions;
use crate::attribution::court::{Court, Rerender};
use crate::attribution::{geometry, sight};
use crate::judge::Judge;

impl Attributions {
    /// Finds the causes of `output`, which the scanline renderer made of the judge's scene with `switches`.
    pub fn find(
        judge: &Judge<'_>,
        output: &RenderOutput,
        switches: Switches,
        precision: Precision,
        rerender: &Rerender<'_>,
    ) -> Self {
        let court = Court { judge, switches, precision, rerender };
        let key = |Place { sensor, i, j }: Place| (sensor, i, j);
        let by_ray =
            geometry::causes(court, output).into_iter().map(|(at, cause)| (key(at), cause)).collect();
        let mut found = Self { by_ray, of_visibility: HashMap::new() };
        let of_visibility = sight::causes(court, output, &found);
        found.of_visibility = of_visibility.into_iter().map(|(at, cause)| (key(at), cause)).collect();
        found
    }
}
