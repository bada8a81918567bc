//! The renderer: the maps of all sensors, then the returns of the beams.

use std::sync::{Arc, Mutex};
use std::time::Instant;

use raypencil_scene::{
    Beam, FaceId, Image, Maybe, Mounted, Precision, Quantities, RenderOutput, Renderer, Request, Returns,
    Sampling, Scene, SensorId, SensorMap, Stage,
};

use crate::Switches;
use crate::bands::{self, MetSide};
use crate::cache::{Cached, cached};
use crate::clusters::Clusters;
use crate::cylindrical::Cylindrical;
use crate::flux::PixelTables;
use crate::options::ScanlineOptions;
use crate::perspective::Perspective;
use crate::returns::{self, ReturnTables};
use crate::shares::ColumnShares;
use crate::tables::CameraTables;

/// The scanline renderer.
///
/// It caches the tables of the last camera and beams that it rendered, which depend on nothing else, and the clusters of the
/// last terrain.
///
/// It answers for the pencils' central rays. With [`Sampling::Jittered`] the maps of the beams have no quantity, the
/// returns are [unsupported](Returns::unsupported), and there is no flux.
///
/// # Light
///
/// ```
/// # mod doc { include!(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/doc/scene.rs")); }
/// # use doc::scene_above;
/// use raypencil_scanline::Scanline;
/// use raypencil_scene::{Renderer, Request};
///
/// // Camera and beam are 10 m above a horizontal triangle and look straight down.
/// let scene = scene_above([[-40.0, -40.0, 0.0], [40.0, -40.0, 0.0], [0.0, 40.0, 0.0]], 20.0);
/// let frame = Scanline::exact().render(&scene, &Request::FLUX);
/// // One pencil of P = 4 W on ground of r_d = 1/4, seen at right angles from r = 10 m through an aperture of D = 2 mm:
/// // P r_d (D^2 / 4) / r^2 = 4 * 0.25 * 1e-6 / 100 = 1e-8 W. It arrives in the middle one of three pixels.
/// let flux = &frame.flux[0];
/// assert!((flux.at(1, 0) / 1e-8 - 1.0).abs() < 1e-14);
/// assert_eq!((flux.at(0, 0), flux.at(2, 0)), (0.0, 0.0));
/// ```
#[derive(Debug)]
pub struct Scanline {
    options: ScanlineOptions,
    name: String,
    clusters: Cached<Clusters>,
    camera_tables: Cached<CameraTables>,
    pixel_tables: Cached<PixelTables>,
    shares: Cached<Vec<ColumnShares>>,
}

impl Default for Scanline {
    fn default() -> Self {
        Self::new(ScanlineOptions::default())
    }
}

impl Scanline {
    /// A renderer with these options.
    ///
    /// Its [name](Renderer::name) is `scanline` if all switches are exact, and `scanline-paper` if all are the paper's.
    /// Otherwise the names of those that are the paper's follow: `scanline-paper-beam-edges`.
    ///
    /// ```
    /// use raypencil_scanline::{Fidelity, ScanlineOptions, Scanline, Switches};
    /// use raypencil_scene::Renderer;
    ///
    /// let switches = Switches { beam_edges: Fidelity::Paper, ..Switches::EXACT };
    /// let renderer = Scanline::new(ScanlineOptions { switches, ..ScanlineOptions::EXACT });
    /// assert_eq!(renderer.name(), "scanline-paper-beam-edges");
    /// assert_eq!(Scanline::exact().name(), "scanline");
    /// ```
    pub fn new(options: ScanlineOptions) -> Self {
        let name = match options.switches {
            Switches::EXACT => "scanline".into(),
            Switches::PAPER => "scanline-paper".into(),
            some => format!("scanline-paper-{some}"),
        };
        Self {
            options,
            name,
            clusters: Mutex::new(None),
            camera_tables: Mutex::new(None),
            pixel_tables: Mutex::new(None),
            shares: Mutex::new(None),
        }
    }

    /// The renderer `scanline`, with [`ScanlineOptions::EXACT`].
    pub fn exact() -> Self {
        Self::new(ScanlineOptions::EXACT)
    }

    /// The renderer `scanline-paper`, with [`ScanlineOptions::PAPER`].
    ///
    /// Rule 3b as printed skips a triangle if all its vertices are on the screen and beyond the maximum range, even if
    /// its interior is nearer:
    ///
    /// ```
    /// # mod doc { include!(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/doc/scene.rs")); }
    /// # use doc::scene_above;
    /// use raypencil_scanline::Scanline;
    /// use raypencil_scene::{Renderer, Request};
    ///
    /// // From 10 m above, the ranges of the vertices are sqrt(100 + 64 + 9) = 13.2 m, twice, and
    /// // sqrt(100 + 9) = 10.4 m. The point straight below is at 10 m. The maximum range is 10.2 m.
    /// let scene = scene_above([[-8.0, -3.0, 0.0], [8.0, -3.0, 0.0], [0.0, 3.0, 0.0]], 10.2);
    /// let range_below = |renderer: Scanline| {
    ///     let camera = renderer.render(&scene, &Request::MAPS).camera.expect("asked for");
    ///     camera.range.expect("asked for").at(1, 0).get()
    /// };
    /// assert_eq!(range_below(Scanline::exact()), Some(10.0));
    /// assert_eq!(range_below(Scanline::paper()), None);
    /// ```
    pub fn paper() -> Self {
        Self::new(ScanlineOptions::PAPER)
    }

    /// The options that the renderer was made with.
    pub fn options(&self) -> ScanlineOptions {
        self.options
    }

    /// The range maps of all sensors as if every face of the terrain were turned over: rays meet the backs, and nothing but
    /// the backs. Of the camera first, then of the beams.
    ///
    /// ```
    /// # mod doc { include!(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/doc/scene.rs")); }
    /// # use doc::scene_above;
    /// use raypencil_scanline::Scanline;
    ///
    /// // From above, a triangle whose corners run clockwise shows its back.
    /// let scene = scene_above([[-40.0, -40.0, 0.0], [0.0, 40.0, 0.0], [40.0, -40.0, 0.0]], 20.0);
    /// let maps = Scanline::exact().ranges_of_backs(&scene);
    /// assert_eq!(maps[0].range.as_ref().expect("a range map").at(1, 0).get(), Some(10.0));
    /// ```
    pub fn ranges_of_backs(&self, scene: &Scene) -> Vec<SensorMap> {
        let (mesh, clusters) = (scene.mesh(), self.clusters_of(scene));
        let tables = self.camera_tables_of(scene);
        let camera = Perspective::new(scene.camera(), &tables);
        // The range alone: normals and angles are those of the faces as they are.
        let asked = (Quantities { range: true, ..Quantities::NONE }, MetSide::Backs);
        let of_camera = bands::render(mesh, &clusters, &camera, SensorId::Camera, asked, self.options);
        let of_beam = |(index, beam): (usize, &Mounted<Beam>)| {
            let cylindrical = Cylindrical::new(beam, self.options.switches);
            bands::render(mesh, &clusters, &cylindrical, SensorId::Beam(index), asked, self.options)
        };
        std::iter::once(of_camera).chain(scene.beams().iter().enumerate().map(of_beam)).collect()
    }

    fn clusters_of(&self, scene: &Scene) -> Arc<Clusters> {
        let mesh = scene.mesh();
        cached(&self.clusters, |clusters| clusters.fit(mesh), || Clusters::new(mesh))
    }

    fn camera_tables_of(&self, scene: &Scene) -> Arc<CameraTables> {
        let camera = &scene.camera().sensor;
        cached(&self.camera_tables, |tables| tables.fit(camera), || CameraTables::new(camera))
    }

    /// Returns and flux of all beams, with cached tables.
    fn render_returns(
        &self,
        scene: &Scene,
        clusters: &Clusters,
        camera_tables: &CameraTables,
        hits: &[Image<Maybe<FaceId>>],
        stages: &mut Vec<Stage>,
    ) -> (Vec<Returns>, Vec<Image<f64>>) {
        let start = Instant::now();
        let (camera, beams) = (&scene.camera().sensor, scene.beams());
        let shares = cached(
            &self.shares,
            |shares| ColumnShares::fit(shares, beams),
            || beams.iter().map(|beam| ColumnShares::new(&beam.sensor)).collect(),
        );
        let pixels = returns::needs_pixel_tables(scene).then(|| {
            let fits = |tables: &PixelTables| tables.fit(camera, beams);
            cached(&self.pixel_tables, fits, || PixelTables::new(camera, camera_tables, beams))
        });
        stages.push(Stage { name: "flux tables".into(), time: start.elapsed() });
        let tables = ReturnTables { camera: camera_tables, shares: &shares, pixels: pixels.as_deref() };
        returns::render(scene, self.options, &tables, clusters, hits, stages)
    }
}

impl Renderer for Scanline {
    fn name(&self) -> &str {
        &self.name
    }

    fn precision(&self) -> Precision {
        Precision::F64
    }

    fn render(&self, scene: &Scene, request: &Request) -> RenderOutput {
        let mut stages = Vec::new();
        // Jittered pencils are not supported: faces are projected onto the grid and cover its cells' centres. There is
        // no ray that could be displaced.
        let supported = request.sampling == Sampling::Centres;
        let needs_returns = request.returns && supported;

        let start = Instant::now();
        let clusters = self.clusters_of(scene);
        stages.push(Stage { name: "clusters".into(), time: start.elapsed() });
        let tables = (request.camera || needs_returns).then(|| {
            let start = Instant::now();
            let tables = self.camera_tables_of(scene);
            stages.push(Stage { name: "tables".into(), time: start.elapsed() });
            tables
        });
        let camera = tables.as_ref().filter(|_| request.camera).map(|tables| {
            let start = Instant::now();
            let perspective = Perspective::new(scene.camera(), tables);
            let map = bands::render(
                scene.mesh(),
                &clusters,
                &perspective,
                SensorId::Camera,
                (request.quantities, MetSide::Fronts),
                self.options,
            );
            stages.push(Stage { name: SensorId::Camera.to_string(), time: start.elapsed() });
            map
        });
        if !supported {
            let (beams, returns) = unsupported(scene, request);
            return RenderOutput { camera, beams, returns, flux: Vec::new(), stages };
        }

        // Of the maps, the returns need the faces alone.
        let requested = if request.beams { request.quantities } else { Quantities::NONE };
        let quantities = Quantities { face: requested.face || needs_returns, ..requested };
        let asked = (quantities, MetSide::Fronts);
        let beams = if request.beams || needs_returns { scene.beams() } else { &[] };
        let mut beams: Vec<SensorMap> = beams
            .iter()
            .enumerate()
            .map(|(index, beam)| {
                let start = Instant::now();
                let sensor = SensorId::Beam(index);
                let cylindrical = Cylindrical::new(beam, self.options.switches);
                let map = bands::render(scene.mesh(), &clusters, &cylindrical, sensor, asked, self.options);
                stages.push(Stage { name: sensor.to_string(), time: start.elapsed() });
                map
            })
            .collect();
        let (returns, flux) = match &tables {
            Some(tables) if needs_returns => {
                let faces = |map: &mut SensorMap| {
                    if requested.face { map.face.clone() } else { map.face.take() }
                };
                let hits: Vec<_> = beams.iter_mut().filter_map(faces).collect();
                self.render_returns(scene, &clusters, tables, &hits, &mut stages)
            }
            _ => (Vec::new(), Vec::new()),
        };
        if !request.beams {
            beams.clear();
        }
        RenderOutput { camera, beams, returns, flux, stages }
    }
}

/// The answer for jittered pencils: maps and returns without a quantity.
fn unsupported(scene: &Scene, request: &Request) -> (Vec<SensorMap>, Vec<Returns>) {
    let sizes = scene.beams().iter().map(|beam| (beam.sensor.columns, beam.sensor.rows)).enumerate();
    let map =
        |(index, (columns, rows))| SensorMap::empty(SensorId::Beam(index), columns, rows, Quantities::NONE);
    let returns = |(_, (columns, rows))| Returns::unsupported(columns, rows);
    (
        if request.beams { sizes.clone().map(map).collect() } else { Vec::new() },
        if request.returns { sizes.map(returns).collect() } else { Vec::new() },
    )
}
