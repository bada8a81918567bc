//! From checked numbers and a mesh to a scene.

use glam::DVec3;
use std::sync::Arc;

use raypencil_rover::{OnVehicle, Rig};
use raypencil_scene::{Atmosphere, Mesh, Mounted, NamedRaySet, Pose, Scene, SceneError};
use raypencil_survey::{TerrainShape, lies_on_its_side};

use crate::plan::{Mount, ScenePlan, VehiclePlacement};

/// Minimum cosine between the vertical and the normal of a face on which a vehicle can stand: slopes up to 60 degrees.
const MIN_COS_SLOPE: f64 = 0.5;

/// Turns about z, then y, then x, each about the axis as the turns before left it: yaw (or heading) to the left, pitch
/// down, roll to the right. In a frame with x forward, y left and z up all three are right-handed.
pub(crate) fn turned(yaw_left_deg: f64, pitch_down_deg: f64, roll_right_deg: f64) -> Pose {
    let turn = |axis, degrees: f64| Pose::from_axis_angle(axis, degrees.to_radians());
    turn(DVec3::Z, yaw_left_deg) * turn(DVec3::Y, pitch_down_deg) * turn(DVec3::X, roll_right_deg)
}

impl Mount {
    fn vehicle_from_sensor(&self) -> Pose {
        let turned = turned(self.yaw_left_deg, self.pitch_down_deg, self.roll_right_deg);
        Pose { position: self.position, ..turned * Pose::VEHICLE_FROM_FORWARD_SENSOR }
    }
}

impl VehiclePlacement {
    /// Pose of the vehicle; `None` if it should stand on the ground where there is none.
    pub(crate) fn global_from_vehicle(&self, mesh: &Mesh) -> Option<Pose> {
        let [x, y] = self.position;
        let z = match self.height {
            Some(z) => z,
            None => raypencil_terrain::height_at(mesh, x, y)?,
        };
        let turned = turned(self.heading_deg, self.pitch_down_deg, self.roll_right_deg);
        Some(Pose { position: DVec3::new(x, y, z), ..turned })
    }
}

/// Rig of a plan, in the vehicle frame.
pub(crate) fn mounted_rig(plan: &ScenePlan) -> Rig {
    fn mounted<S: Copy>((mount, sensor): &(Mount, S)) -> OnVehicle<S> {
        OnVehicle { vehicle_from_sensor: mount.vehicle_from_sensor(), sensor: *sensor }
    }
    Rig { camera: mounted(&plan.camera), beams: plan.beams.iter().map(mounted).collect() }
}

/// Scene of a plan. Each pose is composed and rounded once.
pub(crate) fn resolve(
    plan: &ScenePlan,
    mesh: Arc<Mesh>,
    global_from_vehicle: Pose,
) -> Result<Scene, SceneError> {
    // Subtract the origin first: at 1e6 m, sensor offsets added to global coordinates would lose seven digits.
    let scene_from_vehicle =
        Pose { position: global_from_vehicle.position - mesh.origin(), ..global_from_vehicle };
    let (mount, camera) = plan.camera;
    let camera =
        Mounted { scene_from_sensor: scene_from_vehicle * mount.vehicle_from_sensor(), sensor: camera };
    let beams = plan.beams.iter().map(|&(mount, beam)| Mounted {
        scene_from_sensor: scene_from_vehicle * mount.vehicle_from_sensor(),
        sensor: beam,
    });
    let atmosphere = Atmosphere { attenuation: plan.attenuation };
    let placed = |set: &NamedRaySet| set.placed(&scene_from_vehicle);
    let ray_sets = plan.ray_sets.iter().map(placed).collect::<Result<_, _>>()?;
    Scene::new(mesh, camera, beams.collect(), atmosphere, plan.flux_model)?.with_ray_sets(ray_sets)
}

/// Place for a vehicle, seen from above: the centre of the ground, else the middle of the nearest face that is not too
/// steep. `None` if there is no such face.
pub(crate) fn central_place(mesh: &Mesh) -> Option<[f64; 2]> {
    let [low, high] = mesh.bounds()?;
    let centre = 0.5 * low + 0.5 * high;
    let origin = mesh.origin();
    let global = |place: DVec3| [place.x + origin.x, place.y + origin.y];
    let [x, y] = global(centre);
    if raypencil_terrain::height_at(mesh, x, y).is_some() {
        return Some([x, y]);
    }
    let vertex = |index: u32| {
        let [x, y, z] = mesh.vertices()[index as usize];
        DVec3::new(f64::from(x), f64::from(y), f64::from(z))
    };
    let mut nearest: Option<(f64, DVec3)> = None;
    for face in mesh.faces() {
        let [a, b, c] = face.map(vertex);
        let normal = (b - a).cross(c - a);
        if normal.z <= MIN_COS_SLOPE * normal.length() {
            continue;
        }
        let middle = (a + b + c) / 3.0;
        let (dx, dy) = (middle.x - centre.x, middle.y - centre.y);
        let distance = dx * dx + dy * dy;
        // Strictly nearer: of equally near faces the first one stays.
        if nearest.is_none_or(|(least, _)| distance < least) {
            nearest = Some((distance, middle));
        }
    }
    nearest.map(|(_, middle)| global(middle))
}

/// Extent of the ground seen from above, in words.
pub(crate) fn extent(mesh: &Mesh) -> String {
    match mesh.bounds() {
        None => "a ground that has faces (this one has none)".to_string(),
        Some([low, high]) => {
            let (low, high) = (low + mesh.origin(), high + mesh.origin());
            let place = format!("x {:.3} to {:.3}, y {:.3} to {:.3} m", low.x, high.x, low.y, high.y);
            match has_face_that_looks_up(mesh) {
                true => place,
                false => {
                    let on_its_side = TerrainShape::of(mesh).is_some_and(|shape| lies_on_its_side(&shape));
                    let question = match on_its_side {
                        true => "does its file have y up? Then set terrain.up=y",
                        false => "are corners clockwise seen from above?",
                    };
                    format!("{place}, and faces whose fronts are up (here none is: {question})")
                }
            }
        }
    }
}

/// Whether the front of any face points up, by the sign of the triangle's area seen from above.
fn has_face_that_looks_up(mesh: &Mesh) -> bool {
    let vertices = mesh.vertices();
    mesh.faces().iter().any(|face| {
        let [a, b, c] = face.map(|corner| vertices[corner as usize].map(f64::from));
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0.0
    })
}
