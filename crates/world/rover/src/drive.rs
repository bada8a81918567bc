//! A whole drive: images, pose estimate, maps and obstacles, frame by frame. (Paper, §7 and §8)

use std::sync::{Arc, OnceLock};

use glam::DVec3;
use raypencil_chassis::GroundFaces;
use raypencil_scene::{Image, Mesh, Pose, Renderer, Request, Scene, SceneError};
use raypencil_terrain::HeightIndex;

use crate::drive_plan::{DrivePlan, ExposureMode, PointLookup};
use crate::elevation_map::Inconsistency;
use crate::known_drift::KnownDrift;
use crate::local_mapper::{LocalMapper, Mapping, MissionStart};
use crate::localisation::{Localisation, LocalisationReading};
use crate::mapper::{KnownNoise, MapUpdate, StripePoint};
use crate::navigator_map::{LabelledVector, navigator_map};
use crate::obstacle_map::{ObstacleMap, obstacle_map_due};
use crate::rig::{Pan, Rig};
use crate::route::{Route, RoutePose};
use crate::rules::Rule;
use crate::scan::ScanReason;
use crate::stripe::EdgePoint;
use crate::stripe_extractor::{CameraImage, Exposure, RigExtraction, StripeExtractor};
use crate::triangulation::{SheetPlane, Triangulation, TriangulationTable};
use crate::true_vehicle::TrueVehicle;
use crate::vehicle::Stance;

/// Imaging pipeline of the camera, steps 6 to 8 (§3): from the ideal image, in watts per pixel, to the camera's image.
pub type CameraPipeline<'a> = dyn FnMut(Exposure, Image<f64>) -> CameraImage + 'a;

/// Edge of a stripe in a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FoundEdge {
    /// Index of the sweep position in a vertical scan; otherwise `None`.
    pub step: Option<u32>,
    /// Index of the beam.
    pub beam: usize,
    /// Edge in the image.
    pub edge: EdgePoint,
}

/// Measured point of a stripe.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeasuredPoint {
    /// Index of the sweep position in a vertical scan; otherwise `None`.
    pub step: Option<u32>,
    /// Index of the beam.
    pub beam: usize,
    /// Edge in the image.
    pub edge: EdgePoint,
    /// Point on the beam's plane, vehicle frame, metres.
    pub point: DVec3,
    /// Standard error of its elevation by the edge's row alone, metres.
    pub standard_error: f64,
}

/// Result of one frame of a drive.
#[derive(Debug, Clone, PartialEq)]
pub struct DriveFrame {
    /// Index of the frame.
    pub index: u64,
    /// Time at which the frame begins, seconds since the first: that on the route and that of all scans before.
    pub time: f64,
    /// Commanded pose, from the route.
    pub place: RoutePose,
    /// True pose on the ground.
    pub stance: Stance,
    /// Reading of the localisation sensors.
    pub sensed: LocalisationReading,
    /// Reason for a scan in this frame; `None`: no scan.
    pub scan: Option<ScanReason>,
    /// Edges of the stripes, also those that gave no point.
    pub edges: Vec<FoundEdge>,
    /// Number of measured points.
    pub points: usize,
    /// Number of image columns with light that was left out: with [`ExposureMode::Together`], since more than one beam may
    /// have lit it.
    pub columns_left_out: usize,
    /// Measured points, beam by beam, in row-major order of the image. In a scan: position by position.
    pub measured: Vec<MeasuredPoint>,
    /// Estimated pose `global_from_vehicle`, with which the points were entered into the map.
    pub believed: Pose,
    /// Update of the map by these points.
    pub update: MapUpdate,
    /// Obstacle map and navigator map; `None` in frames that make none.
    pub obstacles: Option<(ObstacleMap, Vec<LabelledVector>)>,
}

/// A drive in progress.
///
/// ```
/// use std::sync::Arc;
///
/// use glam::{DVec2, DVec3};
/// use raypencil_rover::{CameraImage, Drive, DrivePlan, Extraction, OnVehicle, Rig, Route};
/// use raypencil_scanline::Scanline;
/// use raypencil_scene::{Beam, Camera, Lens, Profile};
/// # let camera = Camera {
/// #     width: 1024, height: 1024, pixel_pitch: [9e-6; 2], focal_length: 8e-3, principal_point: [512.0; 2],
/// #     aperture: 2e-3, lens: Lens::CLEAR, max_range: 20.0,
/// # };
/// # let half_width = Beam::half_width_of(0.1, 60.0_f64.to_radians());
/// # let beam = Beam {
/// #     columns: 64, rows: 4, thickness: 5e-3, grid_distance: 0.1, half_width, max_range: 20.0, power: 1.0,
/// #     wavelength: 810e-9, profile: Profile::Paper,
/// # };
///
/// // A camera 1.5 m up that looks 20 degrees down, and a beam 1.8 m up that points 31 degrees down.
/// let mount = |height, down: f64| Rig::mount(DVec3::new(0.0, 0.0, height), down.to_radians());
/// let rig = Rig {
///     camera: OnVehicle { vehicle_from_sensor: mount(1.5, 20.0), sensor: camera },
///     beams: vec![OnVehicle { vehicle_from_sensor: mount(1.8, 31.0), sensor: beam }],
/// };
/// // 0.03 m at 0.3 m/s and 10 frames per second: two frames, here without scans, on ground that is level there.
/// let route = Route::through(DVec2::new(-9.0, 0.0), vec![DVec2::new(-8.97, 0.0)]);
/// let plan = DrivePlan { scans: None, ..DrivePlan::new(rig, route, Extraction::thresholding(1e-12)) };
/// let mesh = raypencil_terrain::builtin("pyramids", 0.25).unwrap().into_mesh()?;
/// let mut drive = Drive::new(plan, Arc::new(mesh))?;
/// let mut frames = Vec::new();
/// while let Some(frame) = drive.step(&Scanline::exact(), &mut |_, flux| CameraImage::Flux(flux))? {
///     frames.push(frame);
/// }
/// assert_eq!(frames.len(), 2);
/// // The sheet meets level ground 1.8 / tan 31 = 2.996 m ahead, 3.35 m from the camera and at 4.4 degrees to its rays.
/// // A pixel of 9 um / 8 mm = 1.125 mrad covers 3.35 m 0.001125 / sin(4.4) = 0.049 m along the sheet there.
/// assert!(frames[0].points > 50);
/// assert!(frames[0].measured.iter().all(|measured| (measured.point.x - 2.996).abs() < 0.049));
/// # Ok::<(), raypencil_scene::SceneError>(())
/// ```
#[derive(Debug)]
pub struct Drive {
    plan: DrivePlan,
    mesh: Arc<Mesh>,
    true_vehicle: TrueVehicle,
    localisation: Localisation,
    extractor: Arc<dyn StripeExtractor>,
    mapping: Mapping,
    mapper: Option<Box<dyn LocalMapper>>,
    frame: u64,
    /// Time of all scans so far, seconds.
    paused: f64,
    last_scan: Option<f64>,
    inconsistency: Inconsistency,
    /// Tables of the beams as they are mounted, each made when it is first needed.
    tables: Vec<OnceLock<Arc<TriangulationTable>>>,
}

impl Drive {
    /// Starts a drive: puts the vehicle on the ground `mesh` at the start of the route.
    ///
    /// # Errors
    /// As [`DrivePlan::validate`]. Names `drive.route.start` if a wheel has no ground below it there, and `drive.route` with
    /// the place where the route leaves the ground.
    pub fn new(plan: DrivePlan, mesh: Arc<Mesh>) -> Result<Self, SceneError> {
        plan.validate("drive")?;
        let ground = Arc::new(HeightIndex::new(&mesh));
        let localisation = Localisation::new(plan.errors, plan.seed, plan.route.frame_rate);
        let Route { start, heading, .. } = plan.route;
        let faces = match plan.map_rules.settle {
            Rule::Paper => None,
            Rule::Mended => Some(GroundFaces::new(&mesh)),
        };
        let true_vehicle = TrueVehicle { vehicle: plan.vehicle, heights: Arc::clone(&ground), faces };
        if true_vehicle.stance(start, heading).is_none() {
            return Err(SceneError::new("drive.route.start", start, "a place with ground under every wheel"));
        }
        true_vehicle.check_route(&plan.route)?;
        let tables = plan.rig.beams.iter().map(|_| OnceLock::new()).collect();
        let extractor = RigExtraction::new(plan.extraction, &plan.rig, &plan.sweep);
        Ok(Self {
            plan,
            extractor: Arc::new(extractor),
            mapping: Mapping::own(),
            mesh,
            true_vehicle,
            localisation,
            mapper: None,
            frame: 0,
            paused: 0.0,
            last_scan: None,
            inconsistency: Inconsistency::default(),
            tables,
        })
    }

    /// The same drive with another extraction of stripes.
    pub fn with_extractor(self, extractor: Arc<dyn StripeExtractor>) -> Self {
        Self { extractor, ..self }
    }

    /// The same drive with another mapping, which is made in the first frame.
    pub fn with_mapping(
        self,
        make: impl Fn(&MissionStart) -> Box<dyn LocalMapper> + Send + Sync + 'static,
    ) -> Self {
        Self { mapping: Mapping::new(make), ..self }
    }

    /// Elevation map and estimated pose; `None` before the first frame.
    pub fn mapper(&self) -> Option<&dyn LocalMapper> {
        self.mapper.as_deref()
    }

    /// How the vehicle stands at the start of the route.
    pub fn start_stance(&self) -> Option<Stance> {
        let Route { start, heading, .. } = self.plan.route;
        self.true_vehicle.stance(start, heading)
    }

    /// Heights of the true ground.
    pub fn ground(&self) -> &Arc<HeightIndex> {
        &self.true_vehicle.heights
    }

    /// Drives one frame. `None` after the end of the route.
    ///
    /// CHOICE: a scan replaces its frame's exposures. All beams are used in every frame.
    ///
    /// # Errors
    /// As [`raypencil_scene::Scene::new`]. Names the renderer if it does not return one image of flux per beam.
    pub fn step(
        &mut self,
        renderer: &dyn Renderer,
        pipeline: &mut CameraPipeline,
    ) -> Result<Option<DriveFrame>, SceneError> {
        let index = self.frame;
        let Some(place) = self.plan.route.frame(index) else { return Ok(None) };
        let Some(stance) = self.true_vehicle.stance(place.place, place.heading) else { return Ok(None) };
        let time = index as f64 / self.plan.route.frame_rate + self.paused;
        let sensed = self.localisation.read(&stance, &self.true_vehicle.heights);
        let rule = self.plan.scans;
        let scan = rule.and_then(|rule| rule.due(place.driven, self.last_scan, &self.inconsistency));
        let mut seen = Seen::default();
        if scan.is_some() {
            for (step, pan) in self.plan.sweep.pans().enumerate() {
                let position = Some((step as u32, pan));
                self.look(renderer, pipeline, &stance, index, position, &mut seen)?;
            }
        } else {
            self.look(renderer, pipeline, &stance, index, None, &mut seen)?;
        }
        let Seen { edges, measured, columns_left_out } = seen;

        let DrivePlan { vehicle, map, map_rules, errors, .. } = self.plan;
        let position = |beam: usize| self.plan.rig.beams[beam].vehicle_from_sensor.position;
        // Sensors turn about their own origins: a panned one is where it was.
        let camera = self.plan.rig.camera.vehicle_from_sensor.position;
        let stripe_point = |measured: &MeasuredPoint| StripePoint {
            point: measured.point,
            standard_error: measured.standard_error,
            seen_from: Some([camera, position(measured.beam)]),
        };
        let points = measured.iter().map(stripe_point).collect();
        let noise = KnownNoise {
            attitude: errors.attitude_noise,
            proximity: errors.proximity_noise,
            drift: KnownDrift::of(&errors, self.plan.route.frame_rate),
        };
        // CHOICE: the first elevation is the true one.
        let elevation = stance.position.z;
        let start = || MissionStart { vehicle, size: map, rules: map_rules, noise, sensed, elevation };
        let mapper = self.mapper.get_or_insert_with(|| self.mapping.start(&start()));
        let update = if scan.is_some() {
            self.last_scan = Some(place.driven);
            // A scan also corrects the elevations that it contradicts.
            self.inconsistency = Inconsistency::default();
            mapper.scan(&sensed, points, rule.is_some_and(|rule| rule.clear_map))
        } else {
            let update = mapper.frame(&sensed, points);
            self.inconsistency = update.inconsistency;
            update
        };

        let obstacles = obstacle_map_due(index, self.plan.obstacles_every).then(|| {
            let DrivePlan { vehicle, rules, grid, vectors, .. } = &self.plan;
            let obstacles = ObstacleMap::extract(mapper.map(), vehicle, rules, grid, &mapper.pose());
            let vectors = navigator_map(&obstacles, vectors);
            (obstacles, vectors)
        });
        if scan.is_some() {
            let duration = self.plan.sweep.duration();
            self.paused += duration;
            self.localisation.pause(duration);
            mapper.pause(duration);
        }
        self.frame += 1;
        let (points, believed) = (measured.len(), mapper.pose());
        Ok(Some(DriveFrame {
            index,
            time,
            place,
            stance,
            sensed,
            scan,
            edges,
            points,
            columns_left_out,
            measured,
            believed,
            update,
            obstacles,
        }))
    }

    /// Adds the stripes that the camera sees to `seen`. `scan` holds the index and the angles of a scan position.
    fn look(
        &self,
        renderer: &dyn Renderer,
        pipeline: &mut CameraPipeline,
        stance: &Stance,
        frame: u64,
        scan: Option<(u32, Pan)>,
        seen: &mut Seen,
    ) -> Result<(), SceneError> {
        let plan = &self.plan;
        let rig = scan.map_or_else(|| plan.rig.clone(), |(_, pan)| plan.rig.panned(pan));
        let step = scan.map(|(step, _)| step);
        let first = seen.edges.len();
        // Steps 6 to 9.
        let mut expose = |beam: Option<usize>, light: Image<f64>| -> Result<(), SceneError> {
            let exposure = Exposure { frame, step, beam };
            let stripes = self.extractor.stripes(exposure, &pipeline(exposure, light))?;
            seen.columns_left_out += stripes.columns_left_out;
            seen.edges.extend(stripes.edges.into_iter().map(|of| FoundEdge {
                step,
                beam: of.beam,
                edge: of.edge,
            }));
            Ok(())
        };
        let lit: Vec<Option<usize>> = match plan.exposures {
            ExposureMode::InTurn => (0..rig.beams.len()).map(Some).collect(),
            ExposureMode::Together => vec![None],
        };
        // In a scan the vehicle stands.
        if scan.is_some() || plan.times.is_at_once() {
            let mut flux = self.flux(renderer, &rig, stance)?;
            if let ExposureMode::Together = plan.exposures {
                flux = sum(flux).into_iter().collect();
            }
            for (beam, light) in lit.into_iter().zip(flux) {
                expose(beam, light)?;
            }
        } else {
            for (number, beam) in lit.into_iter().enumerate() {
                if let Some(light) = self.moving_light(renderer, &rig, frame, number, beam)? {
                    expose(beam, light)?;
                }
            }
        }
        let plane = SheetPlane::for_location(plan.extraction.place);
        let triangulations: Vec<_> = (0..rig.beams.len())
            .map(|beam| {
                let triangulation = Triangulation::new(&rig, beam, plane);
                let table = self.table(&triangulation, beam, step.is_some());
                (triangulation, table)
            })
            .collect();
        for &FoundEdge { beam, edge, .. } in &seen.edges[first..] {
            let Some((triangulation, table)) = triangulations.get(beam) else {
                let expected = format!("below {}, the number of beams", rig.beams.len());
                return Err(SceneError::new("stripe extraction: beam of an edge", beam, expected));
            };
            let point = match table {
                Some(table) => table.at_pixel(edge.i, edge.j),
                None => triangulation.at_edge(&edge),
            };
            let row_error = plan.extraction.place.row_error(&edge);
            let standard_error = || triangulation.elevation_error(&edge, row_error).unwrap_or(0.0);
            seen.measured.extend(point.map(|point| MeasuredPoint {
                step,
                beam,
                edge,
                point,
                standard_error: standard_error(),
            }));
        }
        Ok(())
    }

    /// Steps 1 to 5: flux of each beam on the camera's image, from a stance of the vehicle.
    fn flux(
        &self,
        renderer: &dyn Renderer,
        rig: &Rig,
        stance: &Stance,
    ) -> Result<Vec<Image<f64>>, SceneError> {
        let flux = renderer.render(&self.scene(rig, stance)?, &Request::FLUX).flux;
        if flux.len() != rig.beams.len() {
            let given = format!("{} images of flux", flux.len());
            let expected = format!("{}, one for each beam", rig.beams.len());
            return Err(SceneError::new(renderer.name(), given, expected));
        }
        Ok(flux)
    }

    fn scene(&self, rig: &Rig, stance: &Stance) -> Result<Scene, SceneError> {
        let plan = &self.plan;
        rig.scene(Arc::clone(&self.mesh), stance.pose(), plan.atmosphere, plan.flux_model)
    }

    /// Light of the lit exposure `number` of a frame, of one beam or of all (`None`), while the vehicle drives: the mean over
    /// the poses of the exposure. `None` without beams.
    ///
    /// The renderer gets the scenes of the lit exposure, and then those of the unlit one that follows, if any: of these nothing is
    /// requested.
    fn moving_light(
        &self,
        renderer: &dyn Renderer,
        rig: &Rig,
        frame: u64,
        number: usize,
        beam: Option<usize>,
    ) -> Result<Option<Image<f64>>, SceneError> {
        let DrivePlan { times, route, .. } = &self.plan;
        let height = rig.camera.sensor.height;
        let middle = frame as f64 / route.frame_rate + times.lit(number);
        let mut images = Vec::new();
        for moment in times.moments(middle, height) {
            let mut flux = self.flux(renderer, rig, &self.stance_at(moment)?)?;
            images.extend(match beam {
                Some(beam) => Some(flux.swap_remove(beam)),
                None => sum(flux),
            });
        }
        if times.has_unlit {
            for moment in times.moments(middle + times.interval, height) {
                renderer.render(&self.scene(rig, &self.stance_at(moment)?)?, &Request::NOTHING);
            }
        }
        Ok(times.exposed(&images))
    }

    /// How the vehicle stands at a time of the route, seconds.
    fn stance_at(&self, time: f64) -> Result<Stance, SceneError> {
        let RoutePose { place, heading, driven } = self.plan.route.at(time);
        self.true_vehicle.stance(place, heading).ok_or_else(|| {
            let value = format!("off the ground after {driven:.2} m, at ({:.2}, {:.2}) m", place.x, place.y);
            SceneError::new("drive.route", value, "ground under every wheel all along it")
        })
    }

    /// Table of a beam's points, if the plan looks points up. That of the rig as it is mounted is kept; a scan position
    /// has its own. (Paper, §8)
    fn table(
        &self,
        triangulation: &Triangulation,
        beam: usize,
        panned: bool,
    ) -> Option<Arc<TriangulationTable>> {
        match self.plan.lookup {
            PointLookup::Computed => None,
            PointLookup::Table if panned => Some(Arc::new(triangulation.table())),
            PointLookup::Table => {
                let kept = self.tables[beam].get_or_init(|| Arc::new(triangulation.table()));
                Some(Arc::clone(kept))
            }
        }
    }
}

/// What the camera saw of the stripes in a frame.
#[derive(Debug, Default)]
struct Seen {
    edges: Vec<FoundEdge>,
    measured: Vec<MeasuredPoint>,
    columns_left_out: usize,
}

/// Sum of images of one size; `None` if there are none.
fn sum(images: Vec<Image<f64>>) -> Option<Image<f64>> {
    let mut images = images.into_iter();
    let mut sum = images.next()?;
    for image in images {
        for (pixel, more) in sum.cells_mut().iter_mut().zip(image.cells()) {
            *pixel += more;
        }
    }
    Some(sum)
}
