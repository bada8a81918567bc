//! What another camera does to the light of beams: a pencil meets what it meets, and its light lands elsewhere.

use std::sync::Arc;

use raypencil_judge::{Check, GroundTruth, Recorded, check_rays};
use raypencil_scene::{Camera, Mounted, Place, Pose, Scene, SensorId, Silent};

use crate::rules::Numbers;
use crate::sample::WrongRays;
use crate::tally::{LEFT_ONE_IN, MIN_CONFIRMING_RAYS, Tally};

/// What numbers of the camera explain of those beams whose hits are right, nearly all.
///
/// The scene with that camera has exact answers of its own, and the judge holds the beams' rays to them. A beam of which they
/// explain too little is left out, and one whose pencils meet something else.
pub(crate) fn explained_by_camera(
    truth: &GroundTruth<'_>,
    recorded: &Recorded,
    check: &Check,
    sensors: &[SensorId],
    numbers: &Numbers,
) -> Vec<(SensorId, Tally)> {
    let wrong_of = |sensor: &SensorId| (*sensor, WrongRays::of(check, &[*sensor]));
    let beams = sensors.iter().filter(|sensor| **sensor != SensorId::Camera).map(wrong_of);
    // No camera mends what pencils meet.
    let is_of_light = |wrong: &WrongRays| wrong.of_hits.len() as u64 * LEFT_ONE_IN <= wrong.all.len() as u64;
    let beams: Vec<(SensorId, WrongRays)> = beams.filter(|(_, wrong)| is_of_light(wrong)).collect();
    if beams.is_empty() || *numbers == Numbers::SCENE {
        return Vec::new();
    }
    let Some(scene) = with_camera(truth.scene(), numbers) else { return Vec::new() };
    let truth = GroundTruth::certified(&scene, &Silent);
    let is_asked = |place: Place| beams.iter().any(|(beam, _)| place.sensor == *beam);
    let check = check_rays(&truth, recorded, &is_asked, &Silent);
    let explained = |(beam, wrong): &(SensorId, WrongRays)| {
        let after = WrongRays::of(&check, &[*beam]);
        let left = wrong.all.intersection(&after.all).count();
        let tally = Tally {
            explained: (wrong.all.len() - left) as u64,
            wrong: wrong.all.len() as u64,
            broken: (after.all.len() - left) as u64,
            right: wrong.right(),
        };
        tally.is_enough(MIN_CONFIRMING_RAYS, [tally.wrong, tally.right]).then_some((*beam, tally))
    };
    beams.iter().filter_map(explained).collect()
}

/// The scene with the camera that has these numbers; `None`: no scene can have it.
fn with_camera(scene: &Scene, numbers: &Numbers) -> Option<Scene> {
    let Mounted { scene_from_sensor: pose, sensor: camera } = *scene.camera();
    let Numbers { offset: [dx, dy], focal, pitch, turn, shift, .. } = *numbers;
    let ([cx, cy], [px, py]) = (camera.principal_point, camera.pixel_pitch);
    // A ray through another point of its pixel is the ray of a camera with another principal point.
    let sensor = Camera {
        principal_point: [cx - dx, cy - dy],
        pixel_pitch: [px * pitch[0], py * pitch[1]],
        focal_length: camera.focal_length * focal,
        ..camera
    };
    let angle = turn.length();
    let rotation = match angle == 0.0 {
        true => pose.rotation,
        false => pose.rotation * Pose::from_axis_angle(turn / angle, angle).rotation,
    };
    let pose = Pose { position: pose.position + shift, rotation };
    let camera = Mounted { scene_from_sensor: pose, sensor };
    let (mesh, beams) = (Arc::clone(scene.mesh()), scene.beams().to_vec());
    Scene::new(mesh, camera, beams, scene.atmosphere(), scene.flux_model()).ok()
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::it::candidates::pyramids;

    /// Each number of the camera changes in its own way: the rays of a pixel by those numbers are those of the camera.
    #[test]
    fn the_camera_with_other_numbers_has_their_rays() {
        let scene = pyramids().scene;
        let numbers = Numbers {
            offset: [0.25, -0.5],
            focal: 1.5,
            pitch: [1.25, 0.75],
            turn: DVec3::new(0.02, -0.01, 0.03),
            shift: DVec3::new(0.1, 0.2, -0.3),
            ..Numbers::SCENE
        };
        let other = with_camera(scene, &numbers).expect("a scene");
        for (i, j) in [(0, 0), (3, 1), (7, 5)] {
            let place = Place { sensor: SensorId::Camera, i, j };
            let asked = crate::rules::ray(scene, place, &numbers).expect("a ray");
            let ray = other.ray(SensorId::Camera, i, j).expect("a ray");
            assert!((ray.origin - asked.origin).length() < 1e-12, "{ray:?} {asked:?}");
            assert!((ray.direction - asked.direction).length() < 1e-15, "{ray:?} {asked:?}");
        }
    }
}
