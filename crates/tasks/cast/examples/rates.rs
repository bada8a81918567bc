//! How many rays a second: the tracer's first hits, the exact first hits, and their margins.
//!
//!     cargo run --release -p raypencil-cast --features examples --example rates -- MESH TRACED [EXACT [MARGINS]]
//!
//! MESH is any mesh that `raypencil cast` reads; the others are numbers of rays. The rays start at random places above
//! the mesh's bounding box, up to half its height, and aim at random points of its lower half, so that they meet the mesh at
//! all angles. The axis of the shortest side is up.

use std::time::Instant;

use glam::DVec3;
use rayon::prelude::*;
use raypencil_mesh_io::read_triangles;
use raypencil_referee::ExactCast;
use raypencil_scene::{CastRay, Sides, Triangles};
use raypencil_tracer::TracerCast;

/// A number in 0..1 from two counters (SplitMix64, Steele et al. 2014).
fn draw(ray: u64, part: u64) -> f64 {
    let mut z = (ray * 8 + part).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
}

fn rays(mesh: &Triangles, count: u64) -> Vec<CastRay> {
    let [low, high] = mesh.bounds().expect("a mesh with vertices");
    let size = high - low;
    let up = size.min_position();
    let place = |ray: u64, first: u64, lift: f64| {
        let mut share = DVec3::new(draw(ray, first), draw(ray, first + 1), draw(ray, first + 2));
        share[up] = share[up] * 0.5 + lift;
        low + size * share
    };
    let ray = |ray: u64| {
        let origin = place(ray, 0, 1.0);
        CastRay::new(origin, place(ray, 3, 0.0) - origin)
    };
    (0..count).into_par_iter().map(ray).collect()
}

fn report(what: &str, count: usize, hits: usize, start: Instant) {
    let seconds = start.elapsed().as_secs_f64();
    println!("{what}: {count} rays, {hits} hit, {seconds:.2} s, {:.0} rays/s", count as f64 / seconds);
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [mesh, counts @ ..] = &arguments[..] else { panic!("expected MESH TRACED [EXACT [MARGINS]]") };
    let mesh = read_triangles(mesh.as_ref()).expect("a mesh").triangles;
    let counts: Vec<u64> = counts.iter().map(|count| count.parse().expect("a number of rays")).collect();
    let rays = rays(&mesh, counts.iter().copied().max().unwrap_or(0));
    println!("{} faces, {} threads", mesh.faces().len(), rayon::current_num_threads());
    for (what, &count) in ["tracer, first hit", "exact, first hit", "exact, margins"].iter().zip(&counts) {
        let rays = &rays[..count as usize];
        let start = Instant::now();
        let hits = match *what {
            "tracer, first hit" => {
                let tracer = TracerCast::new(&mesh);
                let each = rays.par_iter().map_init(
                    || tracer.traverser(),
                    |traverser, ray| traverser.first(ray, Sides::Both).is_some(),
                );
                each.filter(|&is_hit| is_hit).count()
            }
            "exact, first hit" => {
                let exact = ExactCast::new(&mesh);
                rays.par_iter().filter(|ray| !exact.first(ray, Sides::Both).is_empty()).count()
            }
            _ => {
                let exact = ExactCast::new(&mesh);
                // Counted by their surface: a ray of which something is known.
                rays.par_iter().filter(|ray| exact.margins(ray, Sides::Both).surface.hi > 0.0).count()
            }
        };
        report(what, count as usize, hits, start);
    }
}
