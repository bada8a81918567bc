//! Test scenes: random rigs on random grounds, beams aimed at hard targets, lattices whose vertices lie on rays.
//!
//! Property tests and campaigns use the same scenes. Random scenes are strategies of proptest, so that a failing test
//! shrinks its scene.
//!
//! ```text
//! split_mix   random numbers of a seed
//! mars        Mars-like grounds of any preset and size
//! random      any ground in front of any camera and beams
//! aimed       narrow beams aimed at vertices, edges, silhouettes and grazing faces of a ground
//! lattice     meshes all of whose vertices lie exactly on rays
//! fingerprint   a digest of samples of all of them
//! drawing     a runner of proptest that the environment does not change
//! ```

pub mod aimed;
mod drawing;
mod fingerprint;
pub mod lattice;
pub mod mars;
pub mod random;
pub(crate) mod split_mix;

pub(crate) use drawing::drawing;
pub(crate) use fingerprint::fingerprint;

use std::sync::Arc;

use glam::DVec3;
use raypencil_scene::{Atmosphere, Beam, Camera, FluxModel, Material, Mesh, Mounted, Pose, Scene};

/// A mesh of one material in the scene frame, origin 0.
///
/// # Panics
/// If vertices and faces do not make a valid mesh.
pub fn mesh(vertices: Vec<[f32; 3]>, faces: Vec<[u32; 3]>) -> Arc<Mesh> {
    let materials = vec![Material { name: "ground".into(), reflectivity: 0.25 }];
    let face_materials = vec![0; faces.len()];
    Arc::new(Mesh::new(DVec3::ZERO, vertices, faces, face_materials, materials).expect("a mesh"))
}

/// A scene in clear air, with radiometric flux.
///
/// # Panics
/// If the parts do not make a valid scene.
pub fn scene(mesh: Arc<Mesh>, camera: Mounted<Camera>, beams: Vec<Mounted<Beam>>) -> Scene {
    let clear = Atmosphere { attenuation: 0.0 };
    Scene::new(mesh, camera, beams, clear, FluxModel::Radiometric).expect("a scene")
}

/// A sensor at the scene's origin. Its axes are those of the scene: z forward, x right, y down.
pub fn at_origin<S>(sensor: S) -> Mounted<S> {
    Mounted { scene_from_sensor: Pose::IDENTITY, sensor }
}
