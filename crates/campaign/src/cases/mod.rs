//! Scenes to be tried: random rigs on random grounds, rays aimed at what is hard, lattices whose vertices lie on rays.
//! Property tests and campaigns draw from the same ones.
//!
//! ```text
//! random    any ground before any camera and beams, as strategies of proptest
//! mars      ground as Mars has it: presets of any size, of which more or less is there
//! aimed     many narrow sensors at vertices, edges, silhouettes and grazing faces of a ground
//! lattice   meshes all of whose vertices lie exactly on rays
//! rig       plain sensors, and the default rig
//! ```

pub mod aimed;
pub mod lattice;
pub mod mars;
pub mod random;

use glam::DVec3;
use std::sync::Arc;

use raypencil_scene::{Atmosphere, Beam, Camera, FluxModel, Material, Mesh, Mounted, Pose, Scene};

/// A mesh of one material in the scene frame, origin 0.
///
/// # Panics
/// If it is no mesh.
pub fn mesh(vertices: Vec<[f32; 3]>, faces: Vec<[u32; 3]>) -> Arc<Mesh> {
    let materials = vec![Material { name: "ground".into(), reflectivity: 0.25 }];
    let face_materials = vec![0; faces.len()];
    Arc::new(Mesh::new(DVec3::ZERO, vertices, faces, face_materials, materials).expect("a mesh"))
}

/// A scene in clear air.
///
/// # Panics
/// If it is no scene.
pub fn scene(mesh: Arc<Mesh>, camera: Mounted<Camera>, beams: Vec<Mounted<Beam>>) -> Scene {
    let clear = Atmosphere { attenuation: 0.0 };
    Scene::new(mesh, camera, beams, clear, FluxModel::Radiometric).expect("a scene")
}

/// A sensor at the scene's origin, its axes the scene's: z forward, x right, y down.
pub fn at_origin<S>(sensor: S) -> Mounted<S> {
    Mounted { scene_from_sensor: Pose::IDENTITY, sensor }
}
