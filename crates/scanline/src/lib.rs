//! The first renderer: the paper's algorithm. (§4, §5)
//!
//! Every triangle of the terrain is thrown forward onto a sensor's projection plane (SPP) and scanned row
//! by row; each cell keeps the nearest. The camera uses the perspective transformation, a beam the
//! cylindrical one of figure 7. The steps, with the paper's numbers:
//!
//! ```text
//! 1, 3  skip       faces that cannot be seen, in a form that never changes a map
//!       printed    the same rules as the paper prints them
//! 2     vertices   into the sensor's frame, onto the SPP
//!       clip       to the part at or beyond the SPP (figure 9)
//!       stripe     to the part within a beam's stripe (figure 8), sides straight
//! 4a    scan       two triangles with a common horizontal side (figure 4)
//! 4b    raster     a row from left to right; the nearest face stays (figure 5)
//! ```
//!
//! Where the paper approximates there is a switch ([`Switches`]), which stands on `exact` unless asked:
//!
//! | switch | `paper` | `exact` |
//! | --- | --- | --- |
//! | `beam-edges` | clip to the stripe, project vertices, straight lines between (`stripe`) | a row is a plane of space, which cuts a side in one point (`cylindrical`) |
//! | `skip-rules` | 1b, 3a, 3b, 3c as printed (`printed`) | conservative forms (`skip`); skipping never changes a map |
//!
//! "Without square roots" (§5): along a row 1/t is affine in x in *both* transformations, so nearest means
//! largest 1/t, and the range follows from a table of |q|.
//!
//! Rows are worked on in bands, in parallel. A band meets its faces in ascending order whatever the number
//! of threads, so a frame's bits do not depend on it.

mod bands;
mod clip;
mod cylindrical;
mod perspective;
mod printed;
mod raster;
mod scan;
mod sides;
mod skip;
mod stripe;
mod switches;
mod tables;
mod vertices;

use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

use raypencil_scene::{Camera, Frame, Renderer, Request, Resolution, Scene, SensorId, Stage};

use cylindrical::Cylindrical;
use perspective::Perspective;
pub use switches::{Fidelity, Switches, UnknownSwitch};
use tables::CameraTables;

/// The scanline renderer. It keeps the tables of the last camera it saw: they depend on the camera alone.
#[derive(Debug)]
pub struct Scanline {
    options: Options,
    name: String,
    tables: Mutex<Option<Arc<CameraTables>>>,
}

/// How the renderer works: what it may leave undone, and where it follows the paper into error.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Options {
    /// Skip faces that cannot be seen before they are scanned. (§4, 1a, 3a, 3b, 3c) It saves time and, with
    /// `skip-rules = exact`, never changes a map; without it, a test can show that. With `skip-rules =
    /// paper` it is rules 3a, 3b and 3c as printed that are left out, and 1b stays: which side of a face is
    /// seen is no matter of saving time.
    pub skip_unseen: bool,
    /// The paper's approximations.
    pub switches: Switches,
}

impl Options {
    /// The contract's answers.
    pub const EXACT: Self = Self { skip_unseen: true, switches: Switches::EXACT };
    /// The paper's answers. Costs what each of [`Switches`] says.
    pub const PAPER: Self = Self { skip_unseen: true, switches: Switches::PAPER };
}

impl Default for Options {
    fn default() -> Self {
        Self::EXACT
    }
}

impl Default for Scanline {
    fn default() -> Self {
        Self::new(Options::default())
    }
}

impl Scanline {
    /// A renderer with these options. Its name is `scanline` if all switches are exact, `scanline-paper` if
    /// all are the paper's, else that with the names of the latter: `scanline-paper-beam-edges`.
    pub fn new(options: Options) -> Self {
        let name = match options.switches {
            Switches::EXACT => "scanline".into(),
            Switches::PAPER => "scanline-paper".into(),
            some => format!("scanline-paper-{some}"),
        };
        Self { options, name, tables: Mutex::new(None) }
    }

    /// `scanline`: [`Options::EXACT`].
    pub fn exact() -> Self {
        Self::new(Options::EXACT)
    }

    /// `scanline-paper`: [`Options::PAPER`].
    pub fn paper() -> Self {
        Self::new(Options::PAPER)
    }

    /// What it was made with.
    pub fn options(&self) -> Options {
        self.options
    }

    /// The tables of `camera`, made if those kept are another's.
    fn tables(&self, camera: &Camera) -> Arc<CameraTables> {
        // A panic elsewhere cannot leave half a table here: it is stored whole.
        let mut kept = self.tables.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(tables) = kept.as_ref()
            && tables.are_of(camera)
        {
            return Arc::clone(tables);
        }
        let tables = Arc::new(CameraTables::of(camera));
        *kept = Some(Arc::clone(&tables));
        tables
    }
}

impl Renderer for Scanline {
    fn name(&self) -> &str {
        &self.name
    }

    fn resolution(&self) -> Resolution {
        Resolution::F64
    }

    fn render(&self, scene: &Scene, request: &Request) -> Frame {
        let mut stages = Vec::new();
        let camera = request.camera.then(|| {
            let start = Instant::now();
            let tables = self.tables(&scene.camera().sensor);
            stages.push(Stage { name: "tables".into(), time: start.elapsed() });
            let start = Instant::now();
            let perspective = Perspective::new(scene.camera(), &tables);
            let map =
                bands::render(scene.mesh(), &perspective, SensorId::Camera, request.quantities, self.options);
            stages.push(Stage { name: SensorId::Camera.to_string(), time: start.elapsed() });
            map
        });
        let beams = if request.beams { scene.beams() } else { &[] };
        let beams = beams
            .iter()
            .enumerate()
            .map(|(index, beam)| {
                let start = Instant::now();
                let sensor = SensorId::Beam(index);
                let cylindrical = Cylindrical::new(beam, self.options.switches);
                let map = bands::render(scene.mesh(), &cylindrical, sensor, request.quantities, self.options);
                stages.push(Stage { name: sensor.to_string(), time: start.elapsed() });
                map
            })
            .collect();
        Frame { camera, beams, returns: Vec::new(), flux: Vec::new(), stages }
    }
}
