//! The referee as a renderer: slow, exact about every face, and correctly rounded in every value.

use std::time::Instant;

use raypencil_scene::{Precision, RenderOutput, Renderer, Request, Scene, SensorId, Stage};

use crate::hits::verdict::Referee;
use crate::numbers::rounding::Format;

/// A [`Renderer`] that gives the referee's own answers.
///
/// ```
/// # mod wall { include!(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/common/wall.rs")); }
/// # use wall::wall_scene;
/// use raypencil_referee::ExactRenderer;
/// use raypencil_scene::{Renderer, Request};
///
/// let frame = ExactRenderer.render(&wall_scene(), &Request::EVERYTHING);
/// // One pencil: the image on the camera sums to its flux, 2^-21 16/25 W (see `Referee::light`).
/// let watts: f64 = frame.flux[0].cells().iter().sum();
/// assert_eq!(watts, 16.0 / 25.0 / f64::from(1 << 21));
/// ```
#[derive(Debug, Clone, Copy, Default)]
pub struct ExactRenderer;

impl Renderer for ExactRenderer {
    fn name(&self) -> &str {
        "referee"
    }

    fn precision(&self) -> Precision {
        Precision::F64
    }

    fn render(&self, scene: &Scene, request: &Request) -> RenderOutput {
        let start = Instant::now();
        let referee = Referee::new(scene);
        let mut stages = vec![Stage { name: "tree".into(), time: start.elapsed() }];
        let mut timed = |id: SensorId| {
            let start = Instant::now();
            let map = referee.certified_map(id, request.sampling);
            let map = map.map(|map| map.in_format(Format::Double, request.quantities));
            stages.push(Stage { name: id.to_string(), time: start.elapsed() });
            map
        };
        let camera = if request.camera { timed(SensorId::Camera) } else { None };
        let beams = if request.beams { scene.beams().len() } else { 0 };
        let beams = (0..beams).filter_map(|index| timed(SensorId::Beam(index))).collect();
        let (mut returns, mut flux) = (Vec::new(), Vec::new());
        for index in 0..if request.returns { scene.beams().len() } else { 0 } {
            let start = Instant::now();
            if let Some(light) = referee.certified_returns(index, request.sampling) {
                let model = scene.flux_model();
                returns.push(light.returns_in(Format::Double, model));
                flux.push(light.image_in(Format::Double, model));
            }
            stages.push(Stage { name: format!("{} returns", SensorId::Beam(index)), time: start.elapsed() });
        }
        RenderOutput { camera, beams, returns, flux, stages }
    }
}
