//! Plots of a sensor's maps for the page: range maps of the renderers, and their differences.

use raypencil_report::{MapPair, SensorPlots, max_side_of_pictures};
use raypencil_scene::{Image, Maybe, SensorId};

use crate::rendered::Rendered;
use crate::validation::Validation;

/// Maximum columns and rows of a picture that keep the page to a few megabytes. A candidate has two pictures of every
/// sensor, and all candidates together share that of the exact ranges.
pub(crate) fn max_columns(validation: &Validation) -> u32 {
    let candidates = validation.scoreboard.as_ref().map_or(0, |scoreboard| scoreboard.candidates.len());
    let pictures = validation.rendered.len() + validation.pairs.len() + 3 * candidates;
    let scene = &validation.subject.scene;
    let sizes: Vec<(u32, u32)> = scene.sensors().filter_map(|sensor| scene.size(sensor)).collect();
    max_side_of_pictures(&sizes, pictures as u64)
}

/// The plots of one sensor, each picture with at most `max_columns` columns and rows.
pub(crate) fn plots(validation: &Validation, sensor: SensorId, max_columns: u32) -> SensorPlots {
    let size = validation.subject.scene.size(sensor).expect("a sensor of this scene");
    let mut plots = SensorPlots::new(sensor, size, max_columns);
    let range = |rendered| range_of(rendered, sensor);
    let maps: Vec<_> = validation.rendered.iter().filter_map(range).collect();
    plots.add_ranges(&maps);
    for pair in &validation.pairs {
        let [a, b] = [pair.a, pair.b].map(|index| range(&validation.rendered[index]));
        let comparison = pair.sensors.iter().find(|comparison| comparison.sensor == sensor);
        if let (Some(a), Some(b), Some(comparison)) = (a, b, comparison)
            && let Some(differences) = &comparison.range_difference
        {
            let defects = comparison.defects.iter().map(|defect| defect.place);
            plots.add_difference(MapPair { a, b }, Some(differences), defects);
        }
    }
    plots
}

/// The name and the range map of a renderer.
fn range_of(rendered: &Rendered, sensor: SensorId) -> Option<(&str, &Image<Maybe<f64>>)> {
    Some((rendered.name.as_str(), rendered.output.map(sensor)?.range.as_ref()?))
}
