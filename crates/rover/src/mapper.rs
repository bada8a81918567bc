//! Update of the elevation map in a frame: the vehicle's elevation, the map's motion, new points. (Paper, §7)

use glam::{DVec2, DVec3};
use raypencil_scene::Pose;

use crate::elevation_map::{ElevationMap, ElevationSource, Inconsistency, MapSize};
use crate::localisation::LocalisationReading;
use crate::vehicle::Vehicle;

/// An elevation map and the estimated pose of the vehicle.
#[derive(Debug, Clone, PartialEq)]
pub struct Mapper {
    vehicle: Vehicle,
    map: ElevationMap,
    /// Estimate of `global_from_vehicle`.
    pose: Pose,
}

/// Result of an update of the map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapUpdate {
    /// Whether the vehicle's elevation came from the map and the proximity sensor. False if either had no value under
    /// the vehicle.
    pub elevation_read: bool,
    /// Motion of the map in x and y, grid steps.
    pub moved: (i64, i64),
    /// Difference between new elevations and old ones.
    pub inconsistency: Inconsistency,
}

impl Mapper {
    /// Map at the start of a mission, centred on the vehicle. `elevation` is that of the vehicle's origin, global z in
    /// metres. The elevations under the vehicle come from the proximity sensor.
    ///
    /// CHOICE: the paper does not say how the vehicle gets its first elevation, before the LTM has any. Its zero is
    /// arbitrary, since "only relative elevations are important" (§7).
    pub fn start(vehicle: Vehicle, size: MapSize, sensed: &LocalisationReading, elevation: f64) -> Self {
        let map = ElevationMap::new(size, sensed.position);
        let pose = sensed.attitude.at(sensed.position.extend(elevation));
        let mut mapper = Self { vehicle, map, pose };
        mapper.fill_under_vehicle(sensed);
        mapper
    }

    /// The elevation map.
    pub fn map(&self) -> &ElevationMap {
        &self.map
    }

    /// Estimate of `global_from_vehicle`.
    pub fn pose(&self) -> Pose {
        self.pose
    }

    /// The vehicle.
    pub fn vehicle(&self) -> &Vehicle {
        &self.vehicle
    }

    /// Updates the map with one frame: a reading of the sensors, and the points of all stripes (vehicle frame, metres).
    /// In this order: the vehicle's elevation, from the old map and the proximity sensor; the motion of the map; the
    /// points. (§7)
    pub fn update(
        &mut self,
        sensed: &LocalisationReading,
        points: impl IntoIterator<Item = DVec3>,
    ) -> MapUpdate {
        let elevation_read = self.locate(sensed);
        let moved = self.map.recentre(sensed.position);
        // "After converting the edge points to global coordinates" (§7)
        let pose = self.pose;
        let inconsistency = self.map.insert(points.into_iter().map(|point| pose * point));
        MapUpdate { elevation_read, moved, inconsistency }
    }

    /// Updates the map with a vertical scan at rest: the points of all its stripes (vehicle frame, metres). "The beams
    /// are vertically panned to completely refresh the local map." (abstract) "... to obtain a fresh LTM." (§7)
    ///
    /// CHOICE: "fresh" means that the map is cleared first, if `clear_map` is set. The elevations under the vehicle
    /// then come from the proximity sensor, as at the start. The points of all stripes are new data points of one
    /// update, so that the extrapolation of one stripe does not overwrite the measurement of another.
    pub fn update_from_scan(
        &mut self,
        sensed: &LocalisationReading,
        points: impl IntoIterator<Item = DVec3>,
        clear_map: bool,
    ) -> MapUpdate {
        let elevation_read = self.locate(sensed);
        let moved = self.map.recentre(sensed.position);
        if clear_map {
            self.map.clear();
            self.fill_under_vehicle(sensed);
        }
        let pose = self.pose;
        let inconsistency = self.map.insert(points.into_iter().map(|point| pose * point));
        MapUpdate { elevation_read, moved, inconsistency }
    }

    /// Estimates the vehicle's pose. "The vehicle determines its global elevation by adding its measured elevation
    /// above the ground surface to the elevation of its current location on the LTM." (§7) Returns whether both were
    /// known.
    ///
    /// CHOICE: if not, the vehicle is taken to have moved in the plane of its wheels: its rise follows from the
    /// measured attitude and the horizontal displacement.
    fn locate(&mut self, sensed: &LocalisationReading) -> bool {
        let below = self.map.elevation(self.map.nearest(sensed.position));
        let read = below.zip(sensed.proximity).map(|(ground, distance)| ground + distance);
        let displacement = sensed.position - self.pose.position.truncate();
        let attitude = sensed.attitude.at(DVec3::ZERO);
        let elevation = read.unwrap_or_else(|| self.pose.position.z + rise(&attitude, displacement));
        self.pose = Pose { position: sensed.position.extend(elevation), ..attitude };
        read.is_some()
    }

    /// Sets the elevations under the vehicle from the proximity sensor.
    ///
    /// CHOICE: the sensor measures one distance. The ground around that point is taken to be parallel to the plane of
    /// the wheels.
    fn fill_under_vehicle(&mut self, sensed: &LocalisationReading) {
        let Some(distance) = sensed.proximity else { return };
        let ground = self.pose.position.z - distance;
        let vehicle_from_global = self.pose.inverse();
        let under: Vec<_> = self
            .map
            .points()
            .filter_map(|point| {
                let displacement = self.map.place(point) - sensed.position;
                let offset = displacement.extend(rise(&self.pose, displacement));
                let in_vehicle = vehicle_from_global.rotate(offset);
                self.vehicle.covers(in_vehicle.truncate()).then_some((point, ground + offset.z))
            })
            .collect();
        for (point, elevation) in under {
            self.map.set_proximity(point, elevation);
        }
    }

    /// Number of grid points with a known elevation.
    pub fn known_count(&self) -> usize {
        self.map.points().filter(|&point| self.map.source(point) != ElevationSource::Unknown).count()
    }
}

/// Rise of the plane of a vehicle's wheels over a horizontal `displacement`, metres.
fn rise(pose: &Pose, displacement: DVec2) -> f64 {
    let up = pose.rotate(DVec3::Z);
    // A vehicle on its side has no such plane.
    if up.z > 0.1 { -up.truncate().dot(displacement) / up.z } else { 0.0 }
}
