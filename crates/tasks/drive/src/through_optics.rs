//! Step 6 around a renderer: the flux that the rover requests has passed the camera's optics. (Paper, §3)

use std::sync::Mutex;
use std::time::{Duration, Instant};

use raypencil_scene::{Image, Pose, Precision, Quantities, RenderOutput, Renderer, Request, Scene, philox};
use raypencil_sensor::{Optics, PointSource, SpecklePattern};

use crate::job::DriveJob;
use crate::sun::Sun;

/// Renderer whose flux has passed the optics of a job: for a drive that is stepped by itself. ([`crate::drive()`] has it
/// already.)
pub struct ThroughOptics<'a> {
    inner: &'a dyn Renderer,
    optics: &'a Optics,
    /// Scenes that were rendered since the last call of `take_backgrounds`, and their backgrounds, watts per pixel.
    backgrounds: Mutex<Vec<(Scene, Image<f64>)>>,
    job: &'a DriveJob,
    sun: Option<&'a Sun>,
    times: Mutex<RenderTimes>,
    /// The scene that was rendered last and its output without flux, if someone wants to see the lit points.
    lit: Option<Mutex<Option<(Scene, RenderOutput)>>>,
}

/// Time spent in all renderings.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct RenderTimes {
    /// Time of the renderer.
    pub rendering: Duration,
    /// Time of the optics.
    pub optics: Duration,
    /// Time of the sun behind the stripes.
    pub sun: Duration,
}

impl<'a> ThroughOptics<'a> {
    /// `inner` behind the optics of `job`, without a sun.
    pub fn new(inner: &'a dyn Renderer, job: &'a DriveJob) -> Self {
        let (backgrounds, times) = (Mutex::default(), Mutex::default());
        Self { inner, optics: &job.optics, backgrounds, job, sun: None, times, lit: None }
    }

    /// The same, computing also the sun's background of each scene.
    pub(crate) fn in_sunlight(self, sun: Option<&'a Sun>) -> Self {
        Self { sun, ..self }
    }

    /// The same, keeping the lit points of each scene for [`ThroughOptics::take_lit`].
    pub(crate) fn keeping_lit(self) -> Self {
        Self { lit: Some(Mutex::default()), ..self }
    }

    /// The scene that was rendered since the last call, with the points that its pencils lit. `None` if there is none.
    pub(crate) fn take_lit(&self) -> Option<(Scene, RenderOutput)> {
        self.lit.as_ref()?.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).take()
    }

    /// Scenes that were rendered since the last call, in their order, and their backgrounds in watts per pixel. None without a
    /// sun.
    pub(crate) fn take_backgrounds(&self) -> Vec<(Scene, Image<f64>)> {
        std::mem::take(&mut self.backgrounds.lock().unwrap_or_else(|poisoned| poisoned.into_inner()))
    }

    /// Computes the background of a scene, if there is a sun.
    fn add_background(&self, scene: &Scene) {
        let Some(sun) = self.sun else { return };
        let start = Instant::now();
        let background = sun.background(self.job, scene);
        let mut all = self.backgrounds.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        all.push((scene.clone(), background));
        self.times.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).sun += start.elapsed();
    }

    pub(crate) fn times(&self) -> RenderTimes {
        *self.times.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }

    /// Whether the optics change nothing: all light of a point lands in its own pixel, as renderers compute it.
    fn is_perfect(&self) -> bool {
        let Optics { focus, blurs, dust, speckle, oversampling: _ } = self.optics;
        focus.is_none() && blurs.is_empty() && dust.is_none() && speckle.is_none()
    }

    /// Replaces the flux of each beam by the image that the optics form of its lit points. Without points or returns of
    /// some beam there is no flux at all.
    fn form_images(&self, scene: &Scene, output: &mut RenderOutput) {
        let camera = scene.camera();
        let camera_from_scene = camera.scene_from_sensor.inverse();
        let beams = scene.beams().iter().map(|beam| beam.scene_from_sensor);
        let formed = output.beams.iter().zip(&output.returns).zip(beams).map(|((map, returns), beam)| {
            let (points, flux) = (map.point.as_ref()?, returns.flux.as_ref()?);
            let lit = points.cells().iter().zip(flux.cells()).filter(|(_, watts)| **watts > 0.0);
            let sources = lit.filter_map(|(point, &watts)| {
                Some(PointSource::project(&camera.sensor, camera_from_scene * point.get()?, watts))
            });
            let number = pattern_number([camera.scene_from_sensor, beam]);
            let pattern = SpecklePattern { seed: self.job.sensor.seed, number };
            Some(self.optics.form_speckled(&camera.sensor, sources, pattern).optical)
        });
        output.flux = formed.collect::<Option<_>>().unwrap_or_default();
    }
}

/// Number of the pattern of speckle that camera and beam see from these poses: a digest of the poses, rounded to a millimetre and
/// to 1/4096 of the components of their rotations.
///
/// The pattern is that of the ground between them. From the same place it is the same, and it is another one when the stripe lies
/// elsewhere on the ground. CHOICE: a millimetre, about the size on the ground of the default camera's speckle at 4 m (lambda N / m is
/// 1.6 mm). Both sides of a comparison have the same pattern.
fn pattern_number(poses: [Pose; 2]) -> u64 {
    let words = poses.iter().flat_map(|pose| {
        let millimetres = pose.position.to_array().map(|metres| 1e3 * metres);
        let turned = pose.rotation.normalize().to_array().map(|component| 4096.0 * component);
        let rounded = millimetres.into_iter().chain(turned).map(|number| number.round() as i64);
        rounded.flat_map(|number| [number as u32, (number >> 32) as u32])
    });
    let words: Vec<u32> = words.collect();
    let digest = words.chunks(4).fold([0; 4], |mut state: [u32; 4], chunk| {
        state.iter_mut().zip(chunk).for_each(|(state, word)| *state ^= word);
        philox(state, [0; 2])
    });
    u64::from(digest[1]) << 32 | u64::from(digest[0])
}

impl Renderer for ThroughOptics<'_> {
    fn name(&self) -> &str {
        self.inner.name()
    }

    fn precision(&self) -> Precision {
        self.inner.precision()
    }

    fn render(&self, scene: &Scene, request: &Request) -> RenderOutput {
        if *request == Request::NOTHING {
            // The scene of an image without the laser.
            self.add_background(scene);
            return RenderOutput {
                camera: None,
                beams: Vec::new(),
                returns: Vec::new(),
                flux: Vec::new(),
                stages: Vec::new(),
            };
        }
        let is_perfect = self.is_perfect();
        let wants_points = !is_perfect || self.lit.is_some();
        let quantities = Quantities { point: wants_points || request.quantities.point, ..request.quantities };
        let request = Request { beams: wants_points || request.beams, quantities, ..*request };
        let start = Instant::now();
        let mut output = self.inner.render(scene, &request);
        let rendering = start.elapsed();
        let mut optics = Duration::ZERO;
        if !is_perfect {
            let start = Instant::now();
            self.form_images(scene, &mut output);
            optics = start.elapsed();
        }
        self.add_background(scene);
        if let Some(lit) = &self.lit {
            // The flux goes on to the camera; the points stay here.
            let points = RenderOutput {
                camera: None,
                beams: std::mem::take(&mut output.beams),
                returns: std::mem::take(&mut output.returns),
                flux: Vec::new(),
                stages: Vec::new(),
            };
            *lit.lock().unwrap_or_else(|poisoned| poisoned.into_inner()) = Some((scene.clone(), points));
        }
        let mut times = self.times.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        times.rendering += rendering;
        times.optics += optics;
        output
    }
}

#[cfg(test)]
mod tests {
    use raypencil_files::write_npy;
    use raypencil_rover::{CameraImage, Drive};
    use raypencil_scene_io::load;
    use raypencil_tracer::Tracer;

    use super::*;
    use crate::common::{FLAT, SHORT, scene_text};

    #[test]
    fn a_kernel_from_a_file_moves_the_stripe() {
        // The kernel moves all light two rows down, and pixels have one cell: so the edges move down by two rows, too.
        let folder = tempfile::tempdir().unwrap();
        let mut kernel = Image::filled(1, 5, 0.0);
        kernel.set(0, 4, 3.0);
        write_npy(folder.path().join("down.npy"), &[&kernel]).unwrap();
        let path = folder.path().join("scene.toml");
        let edges = |optics: &str| {
            std::fs::write(&path, scene_text("", 1, FLAT, &format!("{SHORT}\n{optics}"))).unwrap();
            let loaded = load(path.to_str().unwrap(), &Default::default()).unwrap();
            let job = DriveJob::new(&loaded, None, String::new()).unwrap();
            let renderer = Tracer::new();
            let mut drive = Drive::new(job.plan.clone(), job.mesh.clone()).unwrap();
            let through_optics = ThroughOptics::new(&renderer, &job);
            let frame = drive.step(&through_optics, &mut |_, flux| {
                CameraImage::Numbers(job.sensor.numbers(&flux, None, 0))
            });
            let measured = frame.unwrap().unwrap().measured;
            (measured.iter().map(|one| (one.edge.i, one.edge.j)).collect::<Vec<_>>(), loaded.source_sha256)
        };
        let (plain, sha) = edges("");
        let (moved, other) = edges("[drive.optics]\nblurs = [{ kernel = \"down.npy\" }]");
        assert!(plain.len() > 100 && moved == plain.iter().map(|&(i, j)| (i, j + 2)).collect::<Vec<_>>());
        // A file with other numbers makes another scene.
        assert_ne!(sha, other);
        kernel.set(0, 4, 4.0);
        kernel.set(0, 0, 4.0);
        write_npy(folder.path().join("down.npy"), &[&kernel]).unwrap();
        assert_ne!(edges("[drive.optics]\nblurs = [{ kernel = \"down.npy\" }]").1, other);
    }
}

#[cfg(test)]
#[path = "../tests/unit/speckle.rs"]
mod speckle_tests;
