//! Range maps by both renderers on a generated terrain of 200,000 triangles, on one thread and on all cores.
//!
//! The printed medians are of several runs with the same renderer, so that its cached data (the tracer's hierarchy, the
//! scanline renderer's camera tables) is reused, as between the frames of a drive. `first_frame` includes its
//! construction.

use std::sync::{Arc, LazyLock};

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use glam::DVec3;
use raypencil::harness::contender;
use raypencil::terrain::{RandomGround, height_at};
use raypencil::{Atmosphere, FluxModel, Quantities, Request, Scene, rig};

fn main() {
    divan::main();
}

/// The default rig on a terrain of 40 m x 40 m.
static SCENE: LazyLock<Scene> = LazyLock::new(|| {
    let mesh = Arc::new(RandomGround::plain(1, 200_000, 40.0).build().into_mesh().expect("a valid ground"));
    let z = height_at(&mesh, 0.0, 0.0).expect("ground under the vehicle");
    let (camera, beams) = rig::default_rig(1, DVec3::new(0.0, 0.0, z) - mesh.origin(), 0.0);
    let air = Atmosphere { attenuation: 0.0 };
    Scene::new(mesh, camera, beams, air, FluxModel::Radiometric).expect("a valid scene")
});

/// The camera's range map alone.
const CAMERA: Request = Request { beams: false, quantities: Quantities::RANGE_MAP, ..Request::MAPS };

/// The range maps of both beams alone.
const BEAMS: Request = Request { camera: false, quantities: Quantities::RANGE_MAP, ..Request::MAPS };

/// Measures a renderer on `threads` threads; 0 is all cores.
fn frames(bencher: Bencher, name: &str, threads: usize, request: Request, items: u64) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let renderer = contender(name).expect("a renderer's name").renderer;
    let scene = &*SCENE;
    let render = || pool.install(|| renderer.render(black_box(scene), &request));
    black_box(render());
    bencher.counter(ItemsCount::new(items)).bench_local(render);
}

/// Pixels of the default camera.
const PIXELS: u64 = 1024 * 1024;

/// Pencils of both default beams.
const PENCILS: u64 = 2 * 1024 * 16;

#[divan::bench(args = ["scanline", "tracer"], sample_count = 11, sample_size = 1)]
fn camera_one_thread(bencher: Bencher, name: &str) {
    frames(bencher, name, 1, CAMERA, PIXELS);
}

#[divan::bench(args = ["scanline", "tracer"], sample_count = 11, sample_size = 1)]
fn camera_all_cores(bencher: Bencher, name: &str) {
    frames(bencher, name, 0, CAMERA, PIXELS);
}

#[divan::bench(args = ["scanline", "tracer"], sample_count = 11, sample_size = 1)]
fn both_beams_one_thread(bencher: Bencher, name: &str) {
    frames(bencher, name, 1, BEAMS, PENCILS);
}

/// The first frame of a new renderer: every quantity, on all cores, with the construction of its tables and hierarchy.
#[divan::bench(args = ["scanline", "tracer"], sample_count = 5, sample_size = 1)]
fn first_frame(bencher: Bencher, name: &str) {
    let scene = &*SCENE;
    bencher
        .with_inputs(|| contender(name).expect("a renderer's name").renderer)
        .bench_local_values(|renderer| renderer.render(black_box(scene), &Request::EVERYTHING));
}
