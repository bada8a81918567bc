//! A whole drive: what a rover sees, believes and marks, frame by frame. (Paper, §7 and §8)

use std::sync::Arc;

use glam::DVec3;
use raypencil_scene::{Atmosphere, FluxModel, Image, Mesh, Pose, Renderer, Request, SceneError};
use raypencil_terrain::HeightIndex;

use crate::check::check_count;
use crate::elevation_map::{Inconsistency, MapSize};
use crate::localisation::{Localisation, LocalisationErrors, LocalisationReading};
use crate::mapper::{MapUpdate, Mapper};
use crate::navigator_map::{LabelledVector, VectorRules, navigator_map};
use crate::obstacle_map::{FRAMES_PER_OBSTACLE_MAP, ObstacleMap, RadialGrid, obstacle_map_due};
use crate::rig::{Pan, Rig};
use crate::route::{Route, RoutePose};
use crate::scan::{ScanReason, ScanRule, Sweep};
use crate::stripe::{EdgePoint, Extraction};
use crate::traversability::TraversabilityRules;
use crate::triangulation::{SheetPlane, Triangulation};
use crate::vehicle::{Stance, Vehicle};

/// How the camera tells the beams' stripes apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ExposureMode {
    /// Each beam is lit alone, in an exposure of its own. CHOICE: the paper does not say; this needs no guess.
    #[default]
    InTurn,
    /// All beams are lit at once, and told apart by their order in the image.
    Together,
}

/// Everything that a drive is made of but the ground and the renderer.
#[derive(Debug, Clone, PartialEq)]
pub struct DrivePlan {
    /// The vehicle.
    pub vehicle: Vehicle,
    /// Its sensors.
    pub rig: Rig,
    /// Where it drives.
    pub route: Route,
    /// How stripes are extracted.
    pub extraction: Extraction,
    /// How they are told apart.
    pub exposures: ExposureMode,
    /// What it knows of where it is.
    pub errors: LocalisationErrors,
    /// Other seeds give other errors.
    pub seed: u64,
    /// The local terrain map.
    pub map: MapSize,
    /// When it stops to pan its beams; `None`: never.
    pub scans: Option<ScanRule>,
    /// Through which angles.
    pub sweep: Sweep,
    /// An obstacle map every so many frames.
    pub obstacles_every: u64,
    /// Its thresholds.
    pub rules: TraversabilityRules,
    /// Its grid.
    pub grid: RadialGrid,
    /// Those of the navigator map.
    pub vectors: VectorRules,
    /// The air.
    pub atmosphere: Atmosphere,
    /// The equation of flux.
    pub flux_model: FluxModel,
}

impl DrivePlan {
    /// A drive of the default vehicle with everything as the defaults have it.
    pub fn new(rig: Rig, route: Route, extraction: Extraction) -> Self {
        let vehicle = Vehicle::default();
        Self {
            rules: TraversabilityRules::for_vehicle(&vehicle),
            grid: RadialGrid::for_vehicle(&vehicle),
            vectors: VectorRules::for_vehicle(&vehicle),
            vehicle,
            rig,
            route,
            extraction,
            exposures: ExposureMode::InTurn,
            errors: LocalisationErrors::default(),
            seed: 0,
            map: MapSize::default(),
            scans: Some(ScanRule::default()),
            sweep: Sweep::default(),
            obstacles_every: FRAMES_PER_OBSTACLE_MAP,
            atmosphere: Atmosphere { attenuation: 0.0 },
            flux_model: FluxModel::Radiometric,
        }
    }

    /// Refuses a plan that cannot be driven, naming the field.
    pub fn validate(&self, field: &str) -> Result<(), SceneError> {
        let name = |part: &str| format!("{field}.{part}");
        self.vehicle.validate(&name("vehicle"))?;
        self.rig.validate(&name("rig"))?;
        self.route.validate(&name("route"))?;
        self.extraction.validate(&name("extraction"))?;
        self.errors.validate(&name("errors"))?;
        self.map.validate(&name("map"))?;
        if let Some(scans) = self.scans {
            scans.validate(&name("scans"))?;
        }
        self.sweep.validate(&name("sweep"))?;
        check_count(field, "obstacles_every", self.obstacles_every, 1, u64::MAX)?;
        self.rules.validate(&name("rules"))?;
        self.grid.validate(&name("grid"))?;
        self.vectors.validate(&name("vectors"))
    }
}

/// Which exposure an image is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Exposure {
    /// The frame.
    pub frame: u64,
    /// In a vertical scan, which position of the sweep.
    pub step: Option<u32>,
    /// The beam that was lit; `None`: all of them.
    pub beam: Option<usize>,
}

/// What the camera hands on of an exposure.
#[derive(Debug, Clone, PartialEq)]
pub enum CameraImage {
    /// The flux itself, watts: of a camera without steps 6 to 8.
    Flux(Image<f64>),
    /// Digital numbers; may be less than 0 where those of an unlit exposure are taken off.
    Numbers(Image<i32>),
}

/// What turns the ideal image into the camera's: steps 6 to 8 (§3).
pub type CameraPipeline<'a> = dyn FnMut(Exposure, Image<f64>) -> CameraImage + 'a;

/// One edge point of a stripe, and where it is thought to be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeasuredPoint {
    /// In a vertical scan, which position of the sweep.
    pub step: Option<u32>,
    /// The beam whose stripe it is.
    pub beam: usize,
    /// Its place in the image.
    pub edge: EdgePoint,
    /// Its place on the beam's plane, vehicle frame, metres.
    pub point: DVec3,
}

/// One frame of a drive.
#[derive(Debug, Clone, PartialEq)]
pub struct DriveFrame {
    /// Which one.
    pub index: u64,
    /// Where the route has the vehicle.
    pub place: RoutePose,
    /// How it really stands.
    pub stance: Stance,
    /// What its sensors say.
    pub sensed: LocalisationReading,
    /// If it stopped to scan, why.
    pub scan: Option<ScanReason>,
    /// How many points its stripes gave.
    pub points: usize,
    /// With all beams in one exposure: how many columns hold light, but not one run for each beam.
    pub columns_left_out: usize,
    /// These points, beam by beam, each in row-major order of its image; those of a scan position after position.
    pub measured: Vec<MeasuredPoint>,
    /// The vehicle as it believes itself to be, `global_from_vehicle`: where the points were entered.
    pub believed: Pose,
    /// What they did to the map.
    pub update: MapUpdate,
    /// The obstacle map and the navigator map, in frames that make them.
    pub obstacles: Option<(ObstacleMap, Vec<LabelledVector>)>,
}

/// A drive under way.
#[derive(Debug, Clone)]
pub struct Drive {
    plan: DrivePlan,
    mesh: Arc<Mesh>,
    ground: HeightIndex,
    localisation: Localisation,
    mapper: Option<Mapper>,
    frame: u64,
    last_scan: Option<f64>,
    inconsistency: Inconsistency,
}

impl Drive {
    /// Puts the vehicle on the ground.
    ///
    /// # Errors
    /// As [`DrivePlan::validate`], and names the frame's place where there is no ground under a wheel at the start.
    pub fn new(plan: DrivePlan, mesh: Arc<Mesh>) -> Result<Self, SceneError> {
        plan.validate("drive")?;
        let ground = HeightIndex::new(&mesh);
        let localisation = Localisation::new(plan.errors, plan.seed, plan.route.frame_rate);
        let Route { start, heading, .. } = plan.route;
        if plan.vehicle.settle(&ground, start, heading).is_none() {
            return Err(SceneError::new("drive.route.start", start, "a place with ground under every wheel"));
        }
        Ok(Self {
            plan,
            mesh,
            ground,
            localisation,
            mapper: None,
            frame: 0,
            last_scan: None,
            inconsistency: Inconsistency::default(),
        })
    }

    /// The map, and where the vehicle believes to be; `None` before the first frame.
    pub fn mapper(&self) -> Option<&Mapper> {
        self.mapper.as_ref()
    }

    /// The plan.
    pub fn plan(&self) -> &DrivePlan {
        &self.plan
    }

    /// The true ground.
    pub fn ground(&self) -> &HeightIndex {
        &self.ground
    }

    /// Drives on by a frame. `None` once the route is over, or leads off the ground.
    ///
    /// CHOICE: a scan takes the place of its frame's exposure. Both beams are used in every frame.
    ///
    /// # Errors
    /// As [`raypencil_scene::Scene::new`]; and if the renderer gives no flux.
    pub fn step(
        &mut self,
        renderer: &dyn Renderer,
        pipeline: &mut CameraPipeline,
    ) -> Result<Option<DriveFrame>, SceneError> {
        let index = self.frame;
        let Some(place) = self.plan.route.frame(index) else { return Ok(None) };
        let Some(stance) = self.plan.vehicle.settle(&self.ground, place.place, place.heading) else {
            return Ok(None);
        };
        let sensed = self.localisation.read(&stance, &self.ground);
        let rule = self.plan.scans;
        let scan = rule.and_then(|rule| rule.due(place.driven, self.last_scan, &self.inconsistency));
        let (mut measured, mut columns_left_out) = (Vec::new(), 0);
        if scan.is_some() {
            for (step, pan) in self.plan.sweep.pans().enumerate() {
                let seen =
                    self.measure_stripes(renderer, pipeline, &stance, index, Some((step as u32, pan)))?;
                measured.extend(seen.0);
                columns_left_out += seen.1;
            }
        } else {
            (measured, columns_left_out) = self.measure_stripes(renderer, pipeline, &stance, index, None)?;
        }

        let points = measured.iter().map(|measured| measured.point);
        let DrivePlan { vehicle, map, .. } = self.plan;
        // CHOICE: its first elevation is the true one.
        let mapper =
            self.mapper.get_or_insert_with(|| Mapper::start(vehicle, map, &sensed, stance.position.z));
        let update = if scan.is_some() {
            self.last_scan = Some(place.driven);
            // What a scan contradicts it has also mended.
            self.inconsistency = Inconsistency::default();
            mapper.update_from_scan(&sensed, points, rule.is_some_and(|rule| rule.forget))
        } else {
            let update = mapper.update(&sensed, points);
            self.inconsistency = update.inconsistency;
            update
        };

        let obstacles = obstacle_map_due(index, self.plan.obstacles_every).then(|| {
            let DrivePlan { vehicle, rules, grid, vectors, .. } = &self.plan;
            let obstacles = ObstacleMap::extract(mapper.map(), vehicle, rules, grid, &mapper.pose());
            let vectors = navigator_map(&obstacles, vectors);
            (obstacles, vectors)
        });
        self.frame += 1;
        let (points, believed) = (measured.len(), mapper.pose());
        Ok(Some(DriveFrame {
            index,
            place,
            stance,
            sensed,
            scan,
            points,
            columns_left_out,
            measured,
            believed,
            update,
            obstacles,
        }))
    }

    /// The points of the stripes that the camera sees from a stance: beam by beam, each in row-major order. And how many
    /// columns were left out.
    fn measure_stripes(
        &self,
        renderer: &dyn Renderer,
        pipeline: &mut CameraPipeline,
        stance: &Stance,
        frame: u64,
        scan: Option<(u32, Pan)>,
    ) -> Result<(Vec<MeasuredPoint>, usize), SceneError> {
        let plan = &self.plan;
        let rig = scan.map_or_else(|| plan.rig.clone(), |(_, pan)| plan.rig.panned(pan));
        let mesh = Arc::clone(&self.mesh);
        let scene = rig.scene(mesh, stance.pose(), plan.atmosphere, plan.flux_model)?;
        // Steps 1 to 5.
        let flux = renderer.render(&scene, &Request::FLUX).flux;
        if flux.len() != rig.beams.len() {
            let given = format!("{} images of flux", flux.len());
            return Err(SceneError::new(renderer.name(), given, format!("{}", rig.beams.len())));
        }
        let step = scan.map(|(step, _)| step);
        let exposure = |beam| Exposure { frame, step, beam };
        // Steps 6 to 9.
        let mut columns_left_out = 0;
        let stripes = match plan.exposures {
            ExposureMode::InTurn => {
                let images = flux.into_iter().enumerate();
                images
                    .map(|(beam, ideal)| match pipeline(exposure(Some(beam)), ideal) {
                        CameraImage::Flux(image) => plan.extraction.edges(&image),
                        CameraImage::Numbers(image) => plan.extraction.edges(&image),
                    })
                    .collect()
            }
            ExposureMode::Together => {
                let mut images = flux.into_iter();
                let Some(mut sum) = images.next() else { return Ok((Vec::new(), 0)) };
                for image in images {
                    for (pixel, more) in sum.cells_mut().iter_mut().zip(image.cells()) {
                        *pixel += more;
                    }
                }
                let beams = rig.beams.len();
                let (stripes, columns) = match pipeline(exposure(None), sum) {
                    CameraImage::Flux(image) => plan.extraction.edges_by_order(&image, beams),
                    CameraImage::Numbers(image) => plan.extraction.edges_by_order(&image, beams),
                };
                columns_left_out = columns;
                stripes
            }
        };
        let plane = SheetPlane::for_location(plan.extraction.place);
        let mut measured = Vec::new();
        for (beam, edges) in stripes.iter().enumerate() {
            let triangulation = Triangulation::new(&rig, beam, plane);
            measured.extend(edges.iter().filter_map(|&edge| {
                let point = triangulation.at_edge(&edge)?;
                Some(MeasuredPoint { step, beam, edge, point })
            }));
        }
        Ok((measured, columns_left_out))
    }
}
