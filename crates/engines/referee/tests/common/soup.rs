//! Random meshes for tests of a ray's surroundings. Unit tests include this file.

use raypencil_scene::Triangles;

use crate::splitmix::SplitMix64;

/// Faces of any size, some of them in one plane or beside each other.
pub fn soup(random: &mut SplitMix64) -> Triangles {
    let mut point = |size: f64| [0; 3].map(|_| size * random.part());
    let mut corners = Vec::new();
    for k in 0..12 {
        let size = [1.0, 0.3, 0.05][k % 3];
        let middle = point(1.0 - size);
        corners.extend([0; 3].map(|_| {
            let [x, y, z] = point(size);
            [middle[0] + x, middle[1] + y, middle[2] + z]
        }));
    }
    let mut faces: Vec<[u32; 3]> = (0..12).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    faces.extend((0..6).map(|k| [3 * k + 1, 3 * k, 3 * k + 5]));
    Triangles::new(corners, faces).expect("a mesh")
}
