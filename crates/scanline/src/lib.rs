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
//! What the camera sees of the pencils follows from the faces that they hit (§5, §6), with the steps of §3:
//!
//! ```text
//! 3     points     where the reflected pencils land on the camera's image
//! 5     bins       those points, sorted by pixel
//!       occluders  the faces that may hide them, clipped to the part at or beyond the camera's SPP
//!       occlusion  every face against the points in the pixels it touches, at their own places
//!       printed_occlusion  at the pixels' centres, and within the upper beam's extent, as the paper prints it
//!       rounding   what "through the point itself" means in `f64`
//! 4     shares     a pencil's part of the laser's power, by column
//!       flux       equation (1), the radiometric model, and the pixels' tables
//!       returns    all of it, and the sums on the image
//! ```
//!
//! Where the paper approximates there is a switch ([`Switches`]), which stands on `exact` unless asked:
//!
//! | switch | `paper` | `exact` |
//! | --- | --- | --- |
//! | `beam-edges` | clip to the stripe, project vertices, straight lines between (`stripe`) | a row is a plane of space, which cuts a side in one point (`cylindrical`) |
//! | `skip-rules` | 1b, 3a, 3b, 3c as printed (`printed`) | conservative forms (`skip`); skipping never changes a map |
//! | `facing` | faces turned away from the camera's axis occlude | every face does |
//! | `extent` | so do those not past the upper beam's farthest hit | however deep |
//! | `place` | asked at the centre of a point's pixel | at its own place on the image |
//!
//! "Without square roots" (§5): along a row 1/t is affine in x in *both* transformations, so nearest means
//! largest 1/t, and the range follows from a table of |q|.
//!
//! Rows are worked on in bands, in parallel. A band meets its faces in ascending order whatever the number
//! of threads, so a frame's bits do not depend on it.

mod bands;
mod bins;
mod clip;
mod cylindrical;
#[cfg(test)]
#[path = "../tests/unit/fixtures.rs"]
mod fixtures;
mod flux;
mod occluders;
mod occlusion;
mod perspective;
mod points;
mod printed;
mod printed_occlusion;
mod raster;
mod returns;
mod rounding;
mod scan;
mod shares;
mod sides;
mod skip;
mod stripe;
mod switches;
mod tables;
mod vertices;

use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

use raypencil_scene::{
    FaceId, Frame, Image, Maybe, Quantities, Renderer, Request, Resolution, Returns, Sampling, Scene,
    SensorId, SensorMap, Stage,
};

use cylindrical::Cylindrical;
use flux::PixelTables;
use perspective::Perspective;
use shares::Shares;
pub use switches::{Fidelity, Switches, UnknownSwitch};
use tables::CameraTables;

/// The scanline renderer. It keeps the tables of the last camera and beams it saw: they depend on those alone.
#[derive(Debug)]
pub struct Scanline {
    options: Options,
    name: String,
    tables: Kept<CameraTables>,
    pixel_tables: Kept<PixelTables>,
    shares: Kept<Vec<Shares>>,
}

/// A table kept between frames.
type Kept<T> = Mutex<Option<Arc<T>>>;

/// The table kept, if `fits`, or one made in its place.
fn keep<T>(kept: &Kept<T>, fits: impl FnOnce(&T) -> bool, make: impl FnOnce() -> T) -> Arc<T> {
    // A panic elsewhere cannot leave half a table here: it is stored whole.
    let mut kept = kept.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(table) = kept.as_ref()
        && fits(table)
    {
        return Arc::clone(table);
    }
    let table = Arc::new(make());
    *kept = Some(Arc::clone(&table));
    table
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
        Self {
            options,
            name,
            tables: Mutex::new(None),
            pixel_tables: Mutex::new(None),
            shares: Mutex::new(None),
        }
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
}

impl Scanline {
    /// Returns and flux of all beams, with the tables that are kept for them.
    fn returns(
        &self,
        scene: &Scene,
        camera_tables: &CameraTables,
        hits: &[Image<Maybe<FaceId>>],
        stages: &mut Vec<Stage>,
    ) -> (Vec<Returns>, Vec<Image<f64>>) {
        let start = Instant::now();
        let (camera, beams) = (&scene.camera().sensor, scene.beams());
        let shares = keep(
            &self.shares,
            |kept| Shares::are_of(kept, beams),
            || beams.iter().map(|beam| Shares::of(&beam.sensor)).collect(),
        );
        let pixels = returns::Tables::want_pixels(scene).then(|| {
            let fits = |kept: &PixelTables| kept.are_of(camera, beams);
            keep(&self.pixel_tables, fits, || PixelTables::of(camera, camera_tables, beams))
        });
        stages.push(Stage { name: "flux tables".into(), time: start.elapsed() });
        let tables = returns::Tables { camera: camera_tables, shares: &shares, pixels: pixels.as_deref() };
        returns::of_beams(scene, self.options, &tables, hits, stages)
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
        // There are no rays to displace: a face is projected, and the grid's cells find themselves in it.
        let supported = request.sampling == Sampling::Centres;
        let returns = request.returns && supported;

        let tables = (request.camera || returns).then(|| {
            let start = Instant::now();
            let camera = &scene.camera().sensor;
            let tables = keep(&self.tables, |kept| kept.are_of(camera), || CameraTables::of(camera));
            stages.push(Stage { name: "tables".into(), time: start.elapsed() });
            tables
        });
        let camera = tables.as_ref().filter(|_| request.camera).map(|tables| {
            let start = Instant::now();
            let perspective = Perspective::new(scene.camera(), tables);
            let map =
                bands::render(scene.mesh(), &perspective, SensorId::Camera, request.quantities, self.options);
            stages.push(Stage { name: SensorId::Camera.to_string(), time: start.elapsed() });
            map
        });
        if !supported {
            let (beams, returns) = unsupported(scene, request);
            return Frame { camera, beams, returns, flux: Vec::new(), stages };
        }

        // The faces that pencils hit are all that returns want of the maps.
        let wanted = if request.beams { request.quantities } else { NOTHING };
        let quantities = Quantities { face: wanted.face || returns, ..wanted };
        let beams = if request.beams || returns { scene.beams() } else { &[] };
        let mut beams: Vec<SensorMap> = beams
            .iter()
            .enumerate()
            .map(|(index, beam)| {
                let start = Instant::now();
                let sensor = SensorId::Beam(index);
                let cylindrical = Cylindrical::new(beam, self.options.switches);
                let map = bands::render(scene.mesh(), &cylindrical, sensor, quantities, self.options);
                stages.push(Stage { name: sensor.to_string(), time: start.elapsed() });
                map
            })
            .collect();
        let (returns, flux) = match &tables {
            Some(tables) if returns => {
                let faces = |map: &mut SensorMap| {
                    if wanted.face { map.face.clone() } else { map.face.take() }
                };
                let hits: Vec<_> = beams.iter_mut().filter_map(faces).collect();
                self.returns(scene, tables, &hits, &mut stages)
            }
            _ => (Vec::new(), Vec::new()),
        };
        if !request.beams {
            beams.clear();
        }
        Frame { camera, beams, returns, flux, stages }
    }
}

const NOTHING: Quantities =
    Quantities { range: false, depth: false, face: false, point: false, normal: false, incidence: false };

/// Of jittered pencils nothing is known: maps and returns without a quantity, and no flux.
fn unsupported(scene: &Scene, request: &Request) -> (Vec<SensorMap>, Vec<Returns>) {
    let sizes = scene.beams().iter().map(|beam| (beam.sensor.columns, beam.sensor.rows)).enumerate();
    let map = |(index, (columns, rows))| SensorMap::empty(SensorId::Beam(index), columns, rows, NOTHING);
    let returns = |(_, (columns, rows))| Returns::unsupported(columns, rows);
    (
        if request.beams { sizes.clone().map(map).collect() } else { Vec::new() },
        if request.returns { sizes.map(returns).collect() } else { Vec::new() },
    )
}
