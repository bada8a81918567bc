//! Step 6 around a renderer: the rover asks for the flux on its camera, and gets it through the optics. (Paper, §3)

use std::sync::Mutex;
use std::time::{Duration, Instant};

use crate::job::DriveJob;
use crate::sun::Sun;
use raypencil_scene::{Image, Precision, Quantities, RenderOutput, Renderer, Request, Scene};
use raypencil_sensor::{Optics, PointSource};

/// A renderer seen through optics; a renderer itself.
pub(crate) struct Eye<'a> {
    inner: &'a dyn Renderer,
    optics: &'a Optics,
    /// The last background, and the scene that it is of.
    behind: Mutex<Option<(Scene, Image<f64>)>>,
    job: &'a DriveJob,
    sun: Option<&'a Sun>,
    times: Mutex<Times>,
}

/// How long it worked in all.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Times {
    /// The renderer.
    pub rendering: Duration,
    /// The optics.
    pub optics: Duration,
    /// The sun behind the stripes.
    pub sun: Duration,
}

impl<'a> Eye<'a> {
    pub(super) fn new(inner: &'a dyn Renderer, job: &'a DriveJob, sun: Option<&'a Sun>) -> Self {
        Self { inner, optics: &job.optics, behind: Mutex::default(), job, sun, times: Mutex::default() }
    }

    /// What the sun puts on the image that was rendered last, with its scene; nothing without a sun.
    pub(super) fn behind(&self) -> Option<(Scene, Image<f64>)> {
        self.behind.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).clone()
    }

    pub(super) fn times(&self) -> Times {
        *self.times.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }

    /// Whether every point lands in its own pixel, as renderers themselves have it.
    fn is_perfect(&self) -> bool {
        let Optics { focus, blurs, dust, .. } = self.optics;
        focus.is_none() && blurs.is_empty() && dust.is_none()
    }

    /// Puts the light of every pencil through the optics; leaves out all light if the renderer tells no points.
    fn through_optics(&self, scene: &Scene, frame: &mut RenderOutput) {
        let camera = scene.camera();
        let camera_from_scene = camera.scene_from_sensor.inverse();
        let formed = frame.beams.iter().zip(&frame.returns).map(|(map, returns)| {
            let (points, flux) = (map.point.as_ref()?, returns.flux.as_ref()?);
            let lit = points.cells().iter().zip(flux.cells()).filter(|(_, watts)| **watts > 0.0);
            let sources = lit.filter_map(|(point, &watts)| {
                Some(PointSource::project(&camera.sensor, camera_from_scene * point.get()?, watts))
            });
            Some(self.optics.form_image(&camera.sensor, sources).optical)
        });
        frame.flux = formed.collect::<Option<_>>().unwrap_or_default();
    }
}

impl Renderer for Eye<'_> {
    fn name(&self) -> &str {
        self.inner.name()
    }

    fn precision(&self) -> Precision {
        self.inner.precision()
    }

    fn render(&self, scene: &Scene, request: &Request) -> RenderOutput {
        let is_perfect = self.is_perfect();
        let quantities = Quantities { point: !is_perfect || request.quantities.point, ..request.quantities };
        let request = Request { beams: !is_perfect || request.beams, quantities, ..*request };
        let start = Instant::now();
        let mut frame = self.inner.render(scene, &request);
        let rendering = start.elapsed();
        let (mut optics, mut sun) = (Duration::ZERO, Duration::ZERO);
        if !is_perfect {
            let start = Instant::now();
            self.through_optics(scene, &mut frame);
            optics = start.elapsed();
        }
        if let Some(shining) = self.sun {
            let start = Instant::now();
            let background = shining.background(self.job, scene);
            let mut behind = self.behind.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
            *behind = Some((scene.clone(), background));
            sun = start.elapsed();
        }
        let mut times = self.times.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        times.rendering += rendering;
        times.optics += optics;
        times.sun += sun;
        frame
    }
}
