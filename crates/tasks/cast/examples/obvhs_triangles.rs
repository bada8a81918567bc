//! First hits by the triangle test that comes with obvhs, in single precision, for the comparison of ray tracers.
//!
//!     cargo run --release -p raypencil-cast --features examples --example obvhs_triangles -- MESH RAYS OUT
//!
//! MESH and RAYS are what `raypencil cast` reads; OUT gets the index of each ray's first face as an NPY array, -1 where it
//! hits nothing. Our own tracer takes only the boxes of obvhs, not this test.

use std::time::Duration;

use glam::DVec3;
use obvhs::BvhBuildParams;
use obvhs::bvh2::builder::build_bvh2_from_tris;
use obvhs::ray::{Ray, RayHit};
use obvhs::triangle::Triangle;
use raypencil_cast::read_rays;
use raypencil_files::write_npy_numbers;
use raypencil_mesh_io::read_triangles;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [mesh, rays, out] = &arguments[..] else { panic!("expected MESH RAYS OUT") };
    let mesh = read_triangles(mesh.as_ref()).expect("a mesh").triangles;
    let rays = read_rays(rays.as_ref()).expect("rays");
    let corners =
        |face: &[u32; 3]| face.map(|index| DVec3::from(mesh.vertices()[index as usize]).as_vec3().into());
    let triangles: Vec<Triangle> = mesh
        .faces()
        .iter()
        .map(|face| {
            let [v0, v1, v2] = corners(face);
            Triangle { v0, v1, v2 }
        })
        .collect();
    let tree = build_bvh2_from_tris(&triangles, BvhBuildParams::medium_build(), &mut Duration::default());
    let first = |ray: &raypencil_scene::CastRay| {
        let (origin, direction) = (ray.origin.as_vec3().into(), ray.direction.as_vec3().into());
        let ray = Ray::new(origin, direction, ray.t_min as f32, ray.t_max as f32);
        let mut hit = RayHit::none();
        let is_hit = tree.ray_traverse(ray, &mut hit, |ray, id| {
            triangles[tree.primitive_indices[id] as usize].intersect(ray)
        });
        if is_hit { f64::from(tree.primitive_indices[hit.primitive_id as usize]) } else { -1.0 }
    };
    let faces: Vec<f64> = rays.rays.iter().map(first).collect();
    write_npy_numbers(out, &rays.shape, &faces).expect("a file");
}
