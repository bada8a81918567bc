//! Update of the elevation map in a frame: the vehicle's elevation, the map's motion, new points. (Paper, §7)

use glam::{DVec2, DVec3};
use raypencil_scene::Pose;

use crate::elevation_estimate::{Estimate, fitted_ground};
use crate::elevation_map::{ElevationMap, GridPoint, Inconsistency, MapSize, Sight};
use crate::known_drift::KnownDrift;
use crate::localisation::LocalisationReading;
use crate::map_update::{MapPoint, flatter};
use crate::registration::elevation_error;
use crate::rules::{MapRules, Rule, StartRule};
use crate::vehicle::Vehicle;
use crate::vehicle_plane::WheelPlane;

/// Point of a stripe on its way into the map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StripePoint {
    /// The point, vehicle frame, metres.
    pub point: DVec3,
    /// Standard error of its elevation by the image alone, metres.
    pub standard_error: f64,
    /// Camera and beam that saw and lit it, vehicle frame, metres. `None`: not known.
    pub seen_from: Option<[DVec3; 2]>,
}

/// Standard error of a point about which nothing else is said, metres. CHOICE: half a pixel of the default rig.
const DEFAULT_STANDARD_ERROR_M: f64 = 0.01;

impl From<DVec3> for StripePoint {
    /// A point with a standard error of 1 cm, seen from nowhere in particular.
    fn from(point: DVec3) -> Self {
        Self { point, standard_error: DEFAULT_STANDARD_ERROR_M, seen_from: None }
    }
}

/// Noise and drift of the vehicle's sensors, as its makers state them. A bias is in no data sheet.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct KnownNoise {
    /// Standard deviation of a measured angle, radians.
    pub attitude: f64,
    /// Standard deviation of the proximity sensor, metres.
    pub proximity: f64,
    /// Drift of position and heading, with which measured ground ages.
    pub drift: KnownDrift,
}

/// An elevation map and the estimated pose of the vehicle.
#[derive(Debug, Clone, PartialEq)]
pub struct Mapper {
    vehicle: Vehicle,
    map: ElevationMap,
    /// Estimate of `global_from_vehicle`.
    pose: Pose,
    noise: KnownNoise,
    /// Variance of the pose's elevation, square metres.
    variance: f64,
    /// Number of frames so far.
    frames: u64,
}

/// Result of an update of the map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapUpdate {
    /// Whether map and proximity sensor took part in the vehicle's elevation. False if either had no value under the
    /// vehicle.
    pub elevation_read: bool,
    /// Standard error of the vehicle's elevation as the mended rule estimates it, metres; 0 by the printed rule.
    pub elevation_error: f64,
    /// Motion of the map in x and y, grid steps.
    pub moved: (i64, i64),
    /// Difference between new elevations and old ones.
    pub inconsistency: Inconsistency,
}

impl Mapper {
    /// Map at the start of a mission, centred on the vehicle, with the mended rules. `elevation` is that of the vehicle's
    /// origin, global z in metres.
    ///
    /// CHOICE: the paper does not say how the vehicle gets its first elevation, before the LTM has any. Its zero is
    /// arbitrary, since "only relative elevations are important" (§7).
    pub fn start(vehicle: Vehicle, size: MapSize, sensed: &LocalisationReading, elevation: f64) -> Self {
        Self::with_rules(vehicle, size, MapRules::MENDED, sensed, elevation)
    }

    /// Map at the start of a mission with these rules.
    pub fn with_rules(
        vehicle: Vehicle,
        size: MapSize,
        rules: MapRules,
        sensed: &LocalisationReading,
        elevation: f64,
    ) -> Self {
        let map = ElevationMap::with_rules(size, sensed.position, rules);
        let pose = sensed.attitude.at(sensed.position.extend(elevation));
        let mut mapper = Self { vehicle, map, pose, noise: KnownNoise::default(), variance: 0.0, frames: 0 };
        mapper.fill_at_start(sensed);
        mapper
    }

    /// The same with the noise that the vehicle's sensors are known to have.
    pub fn with_noise(mut self, noise: KnownNoise) -> Self {
        self.noise = noise;
        self.map.drift = noise.drift;
        self
    }

    /// The vehicle stands for so many seconds after the last update: what was measured so far ages meanwhile.
    pub fn pause(&mut self, seconds: f64) {
        if seconds > 0.0 {
            self.map.pauses.push((self.map.frame, seconds));
        }
    }

    /// The elevation map.
    pub fn map(&self) -> &ElevationMap {
        &self.map
    }

    /// Estimate of `global_from_vehicle`.
    pub fn pose(&self) -> Pose {
        self.pose
    }

    /// Updates the map with one frame: a reading of the sensors, and the points of all stripes (vehicle frame, metres).
    /// In this order: the vehicle's elevation, from the old map and the proximity sensor; the motion of the map; the
    /// points. (§7)
    pub fn update<P: Into<StripePoint>>(
        &mut self,
        sensed: &LocalisationReading,
        points: impl IntoIterator<Item = P>,
    ) -> MapUpdate {
        let elevation_read = self.locate(sensed);
        let moved = self.map.recentre(sensed.position);
        self.enter(sensed, points, elevation_read, moved)
    }

    /// Updates the map with a vertical scan at rest: the points of all its stripes (vehicle frame, metres). "The beams
    /// are vertically panned to completely refresh the local map." (abstract) "... to obtain a fresh LTM." (§7)
    ///
    /// CHOICE: "fresh" means that the map is cleared first, if `clear_map` is set, and begins as at the start. The points
    /// of all stripes are new data points of one update, so that the extrapolation of one stripe does not overwrite the
    /// measurement of another.
    pub fn update_from_scan<P: Into<StripePoint>>(
        &mut self,
        sensed: &LocalisationReading,
        points: impl IntoIterator<Item = P>,
        clear_map: bool,
    ) -> MapUpdate {
        let elevation_read = self.locate(sensed);
        let moved = self.map.recentre(sensed.position);
        if clear_map {
            self.map.clear();
            self.fill_at_start(sensed);
        }
        self.enter(sensed, points, elevation_read, moved)
    }

    /// Enters points by the estimated pose. "After converting the edge points to global coordinates" (§7)
    fn enter<P: Into<StripePoint>>(
        &mut self,
        sensed: &LocalisationReading,
        points: impl IntoIterator<Item = P>,
        elevation_read: bool,
        moved: (i64, i64),
    ) -> MapUpdate {
        let points: Vec<StripePoint> = points.into_iter().map(Into::into).collect();
        if self.map.rules.elevation == Rule::Mended {
            self.register(&points);
        }
        if self.map.rules.start == StartRule::Circle {
            for (point, elevation) in self.wheel_plane_around(sensed) {
                self.map.stand_over(point, elevation);
            }
        }
        let (pose, noise, variance) = (self.pose, self.noise, self.variance);
        let points = points.into_iter().map(|point| {
            let StripePoint { point, standard_error, seen_from } = point;
            let place = pose * point;
            // An error of an angle lifts a point by its horizontal distance.
            let by_angle = noise.attitude * (place - pose.position).truncate().length();
            let error = (standard_error * standard_error + by_angle * by_angle + variance).sqrt();
            let sight = |sensor: DVec3| {
                let away = (pose * sensor - place).truncate();
                let distance = away.length();
                let rise = (pose * sensor).z - place.z;
                (distance > 0.0).then(|| Sight { towards: away / distance, slope: rise / distance })
            };
            let sight = seen_from.and_then(|[camera, beam]| flatter(sight(camera), sight(beam)));
            MapPoint { point: place, standard_error: error, sight }
        });
        let inconsistency = self.map.insert(points);
        MapUpdate { elevation_read, elevation_error: self.variance.sqrt(), moved, inconsistency }
    }

    /// Corrects the vehicle's elevation by the ground that its stripes meet again.
    fn register(&mut self, points: &[StripePoint]) {
        let placed: Vec<DVec3> = points.iter().map(|point| self.pose * point.point).collect();
        let errors = points.iter().map(|point| point.standard_error);
        let row_error = errors.sum::<f64>() / points.len().max(1) as f64;
        let Some(error) = elevation_error(&self.map, &placed, row_error, self.variance) else { return };
        let z = self.pose.position.z;
        let believed = Estimate { elevation: z, variance: self.variance };
        let registered = Estimate { elevation: z - error.elevation, variance: error.variance };
        let estimate = believed.corrected(registered);
        self.map.correct(estimate.elevation - z);
        self.pose.position.z = estimate.elevation;
        self.variance = estimate.variance;
    }

    /// Estimates the vehicle's pose. "The vehicle determines its global elevation by adding its measured elevation
    /// above the ground surface to the elevation of its current location on the LTM." (§7) Returns whether both were
    /// known.
    ///
    /// CHOICE: if not, the vehicle is taken to have moved in the plane of its wheels: its rise follows from the
    /// measured attitude and the horizontal displacement.
    fn locate(&mut self, sensed: &LocalisationReading) -> bool {
        let displacement = sensed.position - self.pose.position.truncate();
        let attitude = sensed.attitude.at(DVec3::ZERO);
        self.map.drive(displacement.length());
        self.map.frame = self.frames;
        self.frames += 1;
        let (elevation, read) = match self.map.rules.elevation {
            Rule::Paper => {
                let below = self.map.elevation(self.map.nearest(sensed.position));
                let read = below.zip(sensed.proximity).map(|(ground, distance)| ground + distance);
                let by_tilt = || self.pose.position.z + WheelPlane::of(&attitude).rise(displacement);
                (read.unwrap_or_else(by_tilt), read.is_some())
            }
            Rule::Mended => {
                let (estimate, read) = self.estimate(sensed, displacement, &attitude);
                self.variance = estimate.variance;
                (estimate.elevation, read)
            }
        };
        self.pose = Pose { position: sensed.position.extend(elevation), ..attitude };
        read
    }

    /// Mended elevation: the prediction by the mean of the tilts before and now, corrected by the ground around.
    fn estimate(
        &mut self,
        sensed: &LocalisationReading,
        displacement: DVec2,
        attitude: &Pose,
    ) -> (Estimate, bool) {
        let (before, now) = (WheelPlane::of(&self.pose), WheelPlane::of(attitude));
        let rise = 0.5 * (before.rise(displacement) + now.rise(displacement));
        let start = Estimate { elevation: self.pose.position.z, variance: self.variance };
        let predicted = start.predicted(rise, displacement.length(), self.noise.attitude);
        let Some(distance) = sensed.proximity else { return (predicted, false) };
        // The ground is as uncertain as the vehicle above it and the distance between them.
        let noise = self.noise.proximity * self.noise.proximity;
        let ground =
            Estimate { elevation: predicted.elevation - distance, variance: predicted.variance + noise };
        match fitted_ground(&self.map, sensed.position, ground, &now) {
            None => (predicted, false),
            Some(fit) => {
                let fit = Estimate { elevation: fit.elevation + distance, variance: fit.variance + noise };
                let estimate = predicted.corrected(fit);
                self.map.correct(estimate.elevation - predicted.elevation);
                (estimate, true)
            }
        }
    }

    /// Sets the elevations that the proximity sensor gives at the start, and after a scan that cleared the map.
    fn fill_at_start(&mut self, sensed: &LocalisationReading) {
        let Some(distance) = sensed.proximity else { return };
        let ground = self.pose.position.z - distance;
        match self.map.rules.start {
            StartRule::Origin | StartRule::Circle => {
                self.map.set_proximity(self.map.nearest(sensed.position), ground)
            }
            StartRule::Footprint => self.fill_under_vehicle(sensed, ground),
        }
    }

    /// Sets the elevations under the whole vehicle as if the ground were parallel to the plane of the wheels.
    fn fill_under_vehicle(&mut self, sensed: &LocalisationReading, ground: f64) {
        let vehicle_from_global = self.pose.inverse();
        let rise = ground - self.pose.position.z;
        for (point, elevation) in self.wheel_plane_around(sensed) {
            let place = self.map.place(point).extend(elevation);
            if self.vehicle.covers((vehicle_from_global * place).truncate()) {
                self.map.set_proximity(point, elevation + rise);
            }
        }
    }

    /// Grid points on which the vehicle stands when it turns on the spot, each with the elevation of the wheels' plane
    /// there.
    fn wheel_plane_around(&self, sensed: &LocalisationReading) -> Vec<(GridPoint, f64)> {
        let plane = WheelPlane::of(&self.pose);
        let middle = self.map.nearest(sensed.position);
        let radius = self.vehicle.turning_radius();
        let steps = (radius / self.map.size().spacing).ceil() as i64;
        let reach = steps.min(i64::from(self.map.size().points));
        let mut around = Vec::new();
        for j in -reach..=reach {
            for i in -reach..=reach {
                let point = GridPoint { i: middle.i + i, j: middle.j + j };
                let displacement = self.map.place(point) - sensed.position;
                if self.map.contains(point) && displacement.length() <= radius {
                    around.push((point, self.pose.position.z + plane.rise(displacement)));
                }
            }
        }
        around
    }
}
