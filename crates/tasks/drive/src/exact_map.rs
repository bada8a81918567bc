//! The upper bound of a drive: the elevation map that a rover with exact eyes would have of the ground that its stripes swept.
//!
//! It holds the true ground of each cell that a beam lit and the camera saw, with all points between the stripes, and nothing else. Its
//! own cells are finer than the rover's, so that it is the ground and not a picture of it. The
//! rules of map and obstacles are the drive's own, and the vehicle knows where it stands. What such a rover does not find
//! either, no better image and no better inertial sensor would find: the stripes did not come there, or the rules do not see
//! it. What it finds and the rover does not is lost in between.

use std::collections::BTreeSet;

use glam::{DVec2, DVec3};
use raypencil_rover::{DrivePlan, ElevationMap, ElevationSource, GridPoint, MapPoint, MapSize, Sight};
use raypencil_scene::{RenderOutput, Scene};
use raypencil_terrain::HeightIndex;

use crate::swept_ground::{Swept, SweptGround};

/// Standard error of an exact point, metres: none.
const EXACT: f64 = 0.0;

/// Cells of this map along a side of one of the rover's: 2.5 cm by default. A cell keeps one place of the ground and its highest
/// point, so that in cells of 10 cm a wheel on rough ground stands up to 2 cm too high or too low, however exact the points.
const CELLS_A_SIDE: u32 = 4;

/// Maximum number of grid points along a side of this map: 140 MB in all.
const MAX_POINTS: u32 = 801;

/// Size of the map of exact points beside a rover's map: finer cells on the same ground.
fn fine(size: MapSize) -> MapSize {
    let cells = ((MAX_POINTS - 1) / (size.points - 1)).clamp(1, CELLS_A_SIDE);
    MapSize { spacing: size.spacing / f64::from(cells), points: cells * (size.points - 1) + 1 }
}

/// Map of the exact points of a drive.
#[derive(Debug, Clone)]
pub(crate) struct ExactMap {
    map: ElevationMap,
    /// The cells of the rover's map: a map without elevations, the grid alone.
    cells: ElevationMap,
    /// Points of the exposures since the last frame.
    new: Vec<MapPoint>,
    /// Cells of the rover's map whose true ground is in the map.
    filled: BTreeSet<GridPoint>,
    /// Whether the map is to be cleared first: a scan has begun.
    clears: bool,
}

impl ExactMap {
    /// Nothing is swept yet.
    pub(crate) fn new(plan: &DrivePlan) -> Self {
        let map = ElevationMap::with_rules(fine(plan.map), plan.route.start, plan.map_rules);
        let cells = ElevationMap::new(plan.map, plan.route.start);
        Self { map, cells, new: Vec::new(), filled: BTreeSet::new(), clears: false }
    }

    /// Forgets everything before the next points, as the rover's map does before a scan.
    pub(crate) fn clear(&mut self) {
        self.clears = true;
        self.new.clear();
    }

    /// Adds an exposure: the points of `scene` that were lit and seen. The middle row of each beam stands for its sheet.
    pub(crate) fn add(&mut self, scene: &Scene, lit: &RenderOutput) {
        let origin = scene.mesh().origin();
        let camera = scene.camera().scene_from_sensor.position;
        for (beam, (map, returns)) in scene.beams().iter().zip(lit.beams.iter().zip(&lit.returns)) {
            let (Some(points), Some(visible)) = (&map.point, &returns.visible) else { continue };
            let middle = points.height() / 2;
            for i in 0..points.width() {
                let (Some(point), true) = (points.at(i, middle).get(), visible.at(i, middle)) else {
                    continue;
                };
                let sights = [camera, beam.scene_from_sensor.position].map(|sensor| sight(point, sensor));
                let sight = sights.into_iter().flatten().min_by(|a, b| a.slope.total_cmp(&b.slope));
                self.new.push(MapPoint { point: point + origin, standard_error: EXACT, sight });
            }
        }
    }

    /// Takes the points of a frame into the map, which moves to the vehicle's true place. What the proximity sensor measured
    /// on the rover's own map, and the ground that the rule of the start invents, are taken from there; the former with its true elevation.
    pub(crate) fn end_frame(&mut self, rover: &ElevationMap, ground: &HeightIndex, place: DVec2) {
        if std::mem::take(&mut self.clears) {
            self.map.clear();
            self.filled.clear();
        }
        self.map.recentre(place);
        self.cells.recentre(place);
        self.map.stand_as(rover);
        for cell in rover.points().filter(|cell| rover.source(*cell) == ElevationSource::Proximity) {
            for point in self.map.points_in(rover, cell) {
                let place = self.map.place(point);
                if self.map.source(point) == ElevationSource::Unknown
                    && let Some(elevation) = ground.height_at(place.x, place.y)
                {
                    self.map.set_proximity(point, elevation);
                }
            }
        }
        self.map.insert(std::mem::take(&mut self.new));
    }

    /// Adds the true ground of all cells that were lit and seen so far.
    pub(crate) fn fill(&mut self, swept: &SweptGround, ground: &HeightIndex) {
        let Self { map, cells, filled, .. } = self;
        filled.retain(|cell| cells.contains(*cell));
        let true_point = |place: DVec2| Some(place.extend(ground.height_at(place.x, place.y)?));
        let mut points = Vec::new();
        for cell in cells.points() {
            let is_seen =
                || true_point(cells.place(cell)).is_some_and(|point| swept.at(point) == Swept::Seen);
            if filled.contains(&cell) || !is_seen() {
                continue;
            }
            filled.insert(cell);
            let exact =
                map.points_in(cells, cell).into_iter().filter_map(|point| true_point(map.place(point)));
            points.extend(exact.map(|point| MapPoint { point, standard_error: EXACT, sight: None }));
        }
        self.map.insert(points);
    }

    /// The map after the last frame.
    pub(crate) fn map(&self) -> &ElevationMap {
        &self.map
    }
}

/// Line of sight from a sensor to a point.
fn sight(point: DVec3, sensor: DVec3) -> Option<Sight> {
    let (away, rise) = ((sensor - point).truncate(), sensor.z - point.z);
    let distance = away.length();
    (distance > 0.0).then(|| Sight { towards: away / distance, slope: rise / distance })
}
