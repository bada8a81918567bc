//! Sensors and meshes for the unit tests.

use std::sync::Arc;

use glam::DVec3;
use raypencil_scene::{Beam, Camera, Lens, Material, Mesh, Profile};

/// A camera of 8 x 8 pixels that sees x / z and y / z from -1 to 1. A pixel is 1/4 m wide on the SPP at z = 1.
pub(crate) fn camera() -> Camera {
    Camera {
        width: 8,
        height: 8,
        pixel_pitch: [0.25; 2],
        focal_length: 1.0,
        principal_point: [4.0; 2],
        aperture: 0.1,
        lens: Lens::CLEAR,
        max_range: 100.0,
    }
}

/// A beam of eight columns, x / z from -1 to 1, and two rows, y from -1/2 to 1/2 m. The grid is at z = 1.
pub(crate) fn beam() -> Beam {
    Beam {
        columns: 8,
        rows: 2,
        thickness: 1.0,
        grid_distance: 1.0,
        half_width: 1.0,
        max_range: 100.0,
        power: 1.0,
        wavelength: 8e-7,
        profile: Profile::Paper,
    }
}

/// A mesh of faces that share no vertex.
pub(crate) fn mesh(faces: &[[[f32; 3]; 3]]) -> Arc<Mesh> {
    let indices = (0..faces.len() as u32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    let materials = vec![Material { name: "ground".into(), reflectivity: 0.5 }];
    Arc::new(
        Mesh::new(DVec3::ZERO, faces.concat(), indices, vec![0; faces.len()], materials).expect("a mesh"),
    )
}
