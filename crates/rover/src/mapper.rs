//! One frame of the local terrain map: the vehicle's elevation, the map's move, new points. (Paper, §7)

use glam::{DVec2, DVec3};
use raypencil_scene::Pose;

use crate::elevation_map::{ElevationMap, ElevationSource, Inconsistency, MapSize};
use crate::localisation::LocalisationReading;
use crate::vehicle::Vehicle;

/// A local terrain map and where the vehicle believes that it stands on it.
#[derive(Debug, Clone, PartialEq)]
pub struct Mapper {
    vehicle: Vehicle,
    map: ElevationMap,
    /// `global_from_vehicle`, as believed.
    pose: Pose,
}

/// What a frame did.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapUpdate {
    /// Whether the vehicle's elevation came from the map and the proximity sensor; false if the map did not know
    /// the ground under it.
    pub elevation_read: bool,
    /// By how many grid steps the map moved.
    pub moved: (i64, i64),
    /// How new points fitted old ones.
    pub inconsistency: Inconsistency,
}

impl Mapper {
    /// A map at the start of a mission: centred on the vehicle, whose origin's `elevation` is given; under the
    /// vehicle it comes from the proximity sensor.
    ///
    /// CHOICE: the paper does not say how the vehicle knows its first elevation, which must come from the LTM; its
    /// zero is arbitrary, since "only relative elevations are important" (§7).
    pub fn start(vehicle: Vehicle, size: MapSize, sensed: &LocalisationReading, elevation: f64) -> Self {
        let map = ElevationMap::new(size, sensed.position);
        let pose = sensed.attitude.at(sensed.position.extend(elevation));
        let mut mapper = Self { vehicle, map, pose };
        mapper.fill_under_vehicle(sensed);
        mapper
    }

    /// The map.
    pub fn map(&self) -> &ElevationMap {
        &self.map
    }

    /// `global_from_vehicle`, as believed.
    pub fn pose(&self) -> Pose {
        self.pose
    }

    /// The vehicle.
    pub fn vehicle(&self) -> &Vehicle {
        &self.vehicle
    }

    /// One frame: what the sensors say, and the points of all its stripes in vehicle coordinates. In this order: the
    /// vehicle's elevation from the old map and the proximity sensor; the map's move; the points. (§7)
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

    /// A vertical scan at rest: the points of all its stripes at once, in vehicle coordinates. "The beams are
    /// vertically panned to completely refresh the local map." (abstract) "... to obtain a fresh LTM." (§7)
    ///
    /// CHOICE: fresh means that all is forgotten first, if `forget`; what is under the vehicle then comes from the
    /// proximity sensor again, as at the start. All points count as new data points, whichever stripe they are of, so
    /// that no stripe's extrapolation overwrites another's measurement.
    pub fn update_from_scan(
        &mut self,
        sensed: &LocalisationReading,
        points: impl IntoIterator<Item = DVec3>,
        forget: bool,
    ) -> MapUpdate {
        let elevation_read = self.locate(sensed);
        let moved = self.map.recentre(sensed.position);
        if forget {
            self.map.clear();
            self.fill_under_vehicle(sensed);
        }
        let pose = self.pose;
        let inconsistency = self.map.insert(points.into_iter().map(|point| pose * point));
        MapUpdate { elevation_read, moved, inconsistency }
    }

    /// "The vehicle determines its global elevation by adding its measured elevation above the ground surface to the
    /// elevation of its current location on the LTM." (§7) Whether it could.
    ///
    /// CHOICE: where the map does not know, the vehicle goes on along the plane of its own wheels: its measured tilt
    /// and its way tell how much it rose.
    fn locate(&mut self, sensed: &LocalisationReading) -> bool {
        let below = self.map.elevation(self.map.nearest(sensed.position));
        let read = below.zip(sensed.proximity).map(|(ground, distance)| ground + distance);
        let way = sensed.position - self.pose.position.truncate();
        let attitude = sensed.attitude.at(DVec3::ZERO);
        let elevation = read.unwrap_or_else(|| self.pose.position.z + rise(&attitude, way));
        self.pose = Pose { position: sensed.position.extend(elevation), ..attitude };
        read.is_some()
    }

    /// Gives the grid points under the vehicle the ground's elevation.
    ///
    /// CHOICE: one distance tells one elevation; around it the ground is taken to be parallel to the plane of the
    /// wheels.
    fn fill_under_vehicle(&mut self, sensed: &LocalisationReading) {
        let Some(distance) = sensed.proximity else { return };
        let ground = self.pose.position.z - distance;
        let vehicle_from_global = self.pose.inverse();
        let under: Vec<_> = self
            .map
            .points()
            .filter_map(|point| {
                let way = self.map.place(point) - sensed.position;
                let place = way.extend(rise(&self.pose, way));
                let seen = vehicle_from_global.rotate(place);
                self.vehicle.covers(seen.truncate()).then_some((point, ground + place.z))
            })
            .collect();
        for (point, elevation) in under {
            self.map.set_proximity(point, elevation);
        }
    }

    /// How many of the map's grid points are known.
    pub fn known_count(&self) -> usize {
        self.map.points().filter(|&point| self.map.source(point) != ElevationSource::Unknown).count()
    }
}

/// By how much the plane of a vehicle's wheels rises along a level `way`.
fn rise(pose: &Pose, way: DVec2) -> f64 {
    let up = pose.rotate(DVec3::Z);
    // On its side there is no such plane.
    if up.z > 0.1 { -up.truncate().dot(way) / up.z } else { 0.0 }
}
