//! Finds the causes of one output, first of its hits, then of its visibility.

use std::collections::HashMap;

use raypencil_scene::{Place, Precision, RenderOutput, Switches};

use crate::attribution::cause::Attributions;
use crate::attribution::context::{AttributionContext, Rerender};
use crate::attribution::{geometry, visibility};
use crate::judge::Judge;

impl Attributions {
    /// Finds the causes of `output`, which `rerender` made of the judge's scene with `switches`.
    pub fn find(
        judge: &Judge<'_>,
        output: &RenderOutput,
        switches: Switches,
        precision: Precision,
        rerender: &Rerender<'_>,
    ) -> Self {
        let context = AttributionContext { judge, switches, precision, rerender };
        let key = |Place { sensor, i, j }: Place| (sensor, i, j);
        let of_hit =
            geometry::causes(context, output).into_iter().map(|(at, cause)| (key(at), cause)).collect();
        let mut found = Self { of_hit, of_visibility: HashMap::new() };
        let of_visibility = visibility::causes(context, output, &found);
        found.of_visibility = of_visibility.into_iter().map(|(at, cause)| (key(at), cause)).collect();
        found
    }
}
