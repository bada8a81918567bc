//! The vehicle on the true ground: where it really stands. The rover's own estimates know nothing of this.

use std::sync::Arc;

use glam::DVec2;
use rayon::prelude::*;
use raypencil_chassis::GroundFaces;
use raypencil_scene::SceneError;
use raypencil_terrain::HeightIndex;

use crate::route::Route;
use crate::vehicle::{Stance, Vehicle};

/// Frames that are checked at a time: a route of unknown length is not checked beyond its end by more than these.
const FRAMES_AT_A_TIME: u64 = 1024;

/// A vehicle and the ground that it stands on.
#[derive(Debug, Clone)]
pub(crate) struct TrueVehicle {
    pub vehicle: Vehicle,
    pub heights: Arc<HeightIndex>,
    /// Faces for the mended rule; `None`: by the printed rule.
    pub faces: Option<GroundFaces>,
}

impl TrueVehicle {
    /// How the vehicle stands with its centre at a global place. `None` if a wheel has no ground below it.
    pub fn stance(&self, place: DVec2, heading: f64) -> Option<Stance> {
        match &self.faces {
            Some(faces) => self.vehicle.stand(faces, place, heading),
            None => self.vehicle.settle(&self.heights, place, heading),
        }
    }

    /// Checks that every frame of a route has ground under every wheel.
    ///
    /// # Errors
    /// Names `drive.route`, and the distance and the place at which it leaves the ground.
    pub fn check_route(&self, route: &Route) -> Result<(), SceneError> {
        for first in (0..).step_by(FRAMES_AT_A_TIME as usize) {
            let poses: Vec<_> =
                (first..first + FRAMES_AT_A_TIME).map_while(|frame| route.frame(frame)).collect();
            let off = poses.par_iter().find_first(|pose| self.stance(pose.place, pose.heading).is_none());
            if let Some(pose) = off {
                let value = format!(
                    "off the ground after {:.2} m, at ({:.2}, {:.2}) m",
                    pose.driven, pose.place.x, pose.place.y
                );
                return Err(SceneError::new("drive.route", value, "ground under every wheel all along it"));
            }
            if poses.len() < FRAMES_AT_A_TIME as usize {
                return Ok(());
            }
        }
        Ok(())
    }
}
