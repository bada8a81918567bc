//! The map as an exchangeable part of the rover: one's own mapping in place of [`Mapper`].

use std::fmt::Debug;
use std::sync::Arc;

use raypencil_scene::Pose;

use crate::elevation_map::{ElevationMap, MapSize};
use crate::localisation::LocalisationReading;
use crate::mapper::{KnownNoise, MapUpdate, Mapper, StripePoint};
use crate::rules::MapRules;
use crate::vehicle::Vehicle;

/// What a mapping is told at the start of a drive, in the first frame.
#[derive(Debug, Clone, PartialEq)]
pub struct MissionStart {
    /// The vehicle.
    pub vehicle: Vehicle,
    /// Size of the map.
    pub size: MapSize,
    /// Rules of the rover's own map.
    pub rules: MapRules,
    /// Noise that the vehicle's sensors are known to have.
    pub noise: KnownNoise,
    /// First reading of the sensors.
    pub sensed: LocalisationReading,
    /// Elevation of the vehicle's origin, global z in metres.
    pub elevation: f64,
}

/// Mapping: from readings of the sensors and points of stripes to the vehicle's pose and the elevation map. [`Mapper`] is the
/// rover's own; [`crate::Drive::with_mapping`] takes any other. The obstacle map is made from [`LocalMapper::map`].
pub trait LocalMapper: Debug + Send {
    /// Takes one frame: a reading of the sensors and the points of all stripes. The map is to be centred on the vehicle.
    fn frame(&mut self, sensed: &LocalisationReading, points: Vec<StripePoint>) -> MapUpdate;

    /// Takes a vertical scan at rest: the points of all its stripes. `clear_map`: the old map is to be forgotten first.
    fn scan(&mut self, sensed: &LocalisationReading, points: Vec<StripePoint>, clear_map: bool) -> MapUpdate;

    /// The vehicle stands for so many seconds after the last frame, before the next one: the time of a scan. By default nothing
    /// happens.
    fn pause(&mut self, seconds: f64) {
        let _ = seconds;
    }

    /// The elevation map. [`ElevationMap::insert`] and [`ElevationMap::set_measured`] fill one.
    fn map(&self) -> &ElevationMap;

    /// Estimate of `global_from_vehicle`.
    fn pose(&self) -> Pose;
}

impl LocalMapper for Mapper {
    fn frame(&mut self, sensed: &LocalisationReading, points: Vec<StripePoint>) -> MapUpdate {
        self.update(sensed, points)
    }

    fn scan(&mut self, sensed: &LocalisationReading, points: Vec<StripePoint>, clear_map: bool) -> MapUpdate {
        self.update_from_scan(sensed, points, clear_map)
    }

    fn pause(&mut self, seconds: f64) {
        self.pause(seconds);
    }

    fn map(&self) -> &ElevationMap {
        self.map()
    }

    fn pose(&self) -> Pose {
        self.pose()
    }
}

/// Maker of the mapping of a drive.
#[derive(Clone)]
pub(crate) struct Mapping(Arc<MakeMapper>);

type MakeMapper = dyn Fn(&MissionStart) -> Box<dyn LocalMapper> + Send + Sync;

impl Mapping {
    pub(crate) fn new(make: impl Fn(&MissionStart) -> Box<dyn LocalMapper> + Send + Sync + 'static) -> Self {
        Self(Arc::new(make))
    }

    /// The rover's own mapping.
    pub(crate) fn own() -> Self {
        Self::new(|start| {
            let MissionStart { vehicle, size, rules, noise, sensed, elevation } = start;
            Box::new(Mapper::with_rules(*vehicle, *size, *rules, sensed, *elevation).with_noise(*noise))
        })
    }

    pub(crate) fn start(&self, start: &MissionStart) -> Box<dyn LocalMapper> {
        (self.0)(start)
    }
}

impl Debug for Mapping {
    fn fmt(&self, formatter: &mut std::fmt::Formatter) -> std::fmt::Result {
        formatter.write_str("Mapping")
    }
}
