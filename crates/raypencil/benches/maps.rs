//! Range maps of both renderers on a generated ground of 200,000 triangles, on one thread and on all.
//!
//! `cargo bench` prints medians of several runs. What a renderer keeps between the frames of a drive (the
//! tracer's hierarchy, the scanline's camera tables) is kept here too; `first_frame` pays for it.

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use glam::DVec3;
use std::sync::{Arc, LazyLock};

use raypencil::harness::contender;
use raypencil::terrain::{RandomGround, height_at};
use raypencil::{
    Atmosphere, Beam, Camera, FluxModel, Lens, Mounted, Pose, Profile, Quantities, Request, Scene,
};

fn main() {
    divan::main();
}

/// The default rig on a height field of 40 m x 40 m.
static SCENE: LazyLock<Scene> = LazyLock::new(|| {
    let mesh = Arc::new(RandomGround::plain(1, 200_000, 40.0).build().into_mesh().expect("a valid ground"));
    let z = height_at(&mesh, 0.0, 0.0).expect("ground under the vehicle");
    let scene_from_vehicle = Pose::from_position(DVec3::new(0.0, 0.0, z) - mesh.origin());
    let mount = |height: f64, pitch_down_deg: f64| {
        scene_from_vehicle
            * Pose::from_position(DVec3::new(0.3, 0.0, height))
            * Pose::from_axis_angle(DVec3::Y, pitch_down_deg.to_radians())
            * Pose::VEHICLE_FROM_FORWARD_SENSOR
    };
    let camera = Camera {
        width: 1024,
        height: 1024,
        pixel_pitch: [9e-6; 2],
        focal_length: 8e-3,
        principal_point: [512.0; 2],
        aperture: 2e-3,
        lens: Lens::CLEAR,
        max_range: 20.0,
    };
    let beam = Beam {
        columns: 1024,
        rows: 16,
        thickness: 5e-3,
        grid_distance: 0.1,
        half_width: Beam::half_width_of(0.1, 60_f64.to_radians()),
        max_range: 20.0,
        power: 1.0,
        wavelength: 810e-9,
        profile: Profile::Paper,
    };
    let camera = Mounted { scene_from_sensor: mount(1.5, 20.0), sensor: camera };
    let beams = [(1.8, 31.0), (2.0, 22.0)]
        .map(|(height, down)| Mounted { scene_from_sensor: mount(height, down), sensor: beam });
    let air = Atmosphere { attenuation: 0.0 };
    Scene::new(mesh, camera, beams.to_vec(), air, FluxModel::Radiometric).expect("a valid scene")
});

const CAMERA: Request = Request { beams: false, quantities: Quantities::RANGE_MAP, ..Request::MAPS };

const BEAMS: Request = Request { camera: false, quantities: Quantities::RANGE_MAP, ..Request::MAPS };

/// Renders over and over on so many threads; 0 is all cores.
fn frames(bencher: Bencher, name: &str, threads: usize, request: Request, items: u64) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let renderer = contender(name).expect("a renderer of this house").renderer;
    let scene = &*SCENE;
    let render = || pool.install(|| renderer.render(black_box(scene), &request));
    black_box(render());
    bencher.counter(ItemsCount::new(items)).bench_local(render);
}

const PIXELS: u64 = 1024 * 1024;

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

/// A renderer that has seen nothing yet: tables and hierarchy included, every quantity, all cores.
#[divan::bench(args = ["scanline", "tracer"], sample_count = 5, sample_size = 1)]
fn first_frame(bencher: Bencher, name: &str) {
    let scene = &*SCENE;
    bencher
        .with_inputs(|| contender(name).expect("a renderer of this house").renderer)
        .bench_local_values(|renderer| renderer.render(black_box(scene), &Request::EVERYTHING));
}
