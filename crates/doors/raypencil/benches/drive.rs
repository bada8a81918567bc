//! Cycle of the rover, of which the paper plans ten per second: a frame (both beams, steps 1 to 5), its two exposures
//! (steps 7 and 8), the extraction of the stripes and the update of the elevation map (step 9), on a generated ground
//! of half a million triangles, with four pencils per pixel.
//!
//! The vehicle moves from frame to frame, and so does the map. Every tenth cycle also makes an obstacle map.

use std::sync::{Arc, LazyLock};

use divan::{Bencher, black_box};
use raypencil::drive::DriveJob;
use raypencil::harness::contender;
use raypencil::io::{Overrides, load};
use raypencil::rover::{CameraImage, Drive, Pan, SheetPlane, Triangulation};
use raypencil::terrain::HeightIndex;
use raypencil::{Image, Renderer, Request};

fn main() {
    divan::main();
}

const SCENE: &str = r#"
version = 1
[vehicle]
position_m = [-15, 0]
[terrain]
generate = { kind = "plain", seed = 1, faces = 500000, extent_m = 50 }
[drive]
waypoints_m = [[30, 0]]
scans = false
"#;

/// Drive over the scene.
static JOB: LazyLock<DriveJob> = LazyLock::new(|| {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("plain.toml");
    std::fs::write(&path, SCENE).expect("written");
    let loaded = load(path.to_str().expect("a path in UTF-8"), &Overrides::default()).expect("a valid scene");
    DriveJob::new(&loaded, None, String::new()).expect("a drive")
});

fn renderer(name: &str) -> Box<dyn Renderer> {
    contender(name).expect("raypencil has this renderer").renderer
}

/// Drive that runs cycle by cycle.
struct Cycles {
    renderer: Box<dyn Renderer>,
    drive: Drive,
    exposures: u64,
}

impl Cycles {
    fn new(name: &str) -> Self {
        let drive = Drive::new(JOB.plan.clone(), Arc::clone(&JOB.mesh)).expect("a drive");
        Self { renderer: renderer(name), drive, exposures: 0 }
    }

    fn cycle(&mut self) {
        let exposures = &mut self.exposures;
        let mut camera_pipeline = |_, flux: Image<f64>| {
            *exposures += 1;
            CameraImage::Numbers(JOB.sensor.numbers(&flux, None, *exposures))
        };
        let frame = self.drive.step(self.renderer.as_ref(), &mut camera_pipeline).expect("a frame");
        assert!(black_box(frame).is_some_and(|frame| frame.points > 500), "the route is long enough");
    }
}

/// Frame alone: the flux of both beams on the camera's pixels.
#[divan::bench(args = ["scanline", "tracer"], sample_count = 51, sample_size = 1)]
fn frame(bencher: Bencher<'_, '_>, name: &str) {
    let renderer = renderer(name);
    let plan = &JOB.plan;
    let ground = HeightIndex::new(&JOB.mesh);
    let mut index = 0;
    let mut render = move || {
        let place = plan.route.frame(index).expect("the route is long enough");
        index += 1;
        let stance = plan.vehicle.settle(&ground, place.place, place.heading).expect("on the ground");
        let scene = plan.rig.scene(Arc::clone(&JOB.mesh), stance.pose(), plan.atmosphere, plan.flux_model);
        renderer.render(black_box(&scene.expect("a scene")), &Request::FLUX)
    };
    render();
    bencher.bench_local(render);
}

#[divan::bench(args = ["scanline", "tracer"], sample_count = 51, sample_size = 1)]
fn cycle(bencher: Bencher<'_, '_>, name: &str) {
    let mut cycles = Cycles::new(name);
    // The first cycle makes tables and trees that later ones use again.
    cycles.cycle();
    bencher.bench_local(move || cycles.cycle());
}

/// Two exposures of a cycle, by the preset of the sensor.
#[divan::bench(args = raypencil::sensor::PRESET_NAMES, sample_count = 11, sample_size = 1)]
fn exposures(bencher: Bencher<'_, '_>, name: &str) {
    let plan = &JOB.plan;
    let place = plan.route.frame(0).expect("a first frame");
    let stance = plan.vehicle.settle(&HeightIndex::new(&JOB.mesh), place.place, place.heading);
    let pose = stance.expect("on the ground").pose();
    let scene =
        plan.rig.scene(Arc::clone(&JOB.mesh), pose, plan.atmosphere, plan.flux_model).expect("a scene");
    let output = renderer("tracer").render(&scene, &Request::FLUX);
    let (_, sensor) = raypencil::sensor::preset(name).expect("a preset");
    let camera = plan.rig.camera.sensor;
    let pattern = sensor.fixed_pattern(camera.width, camera.height);
    bencher.bench_local(|| {
        for (image, exposure) in output.flux.iter().zip(0..) {
            black_box::<Image<i32>>(sensor.numbers_with(Some(&pattern), black_box(image), None, exposure));
        }
    });
}

/// Triangulation table of one beam, which must be made anew after a pan.
#[divan::bench(sample_count = 11, sample_size = 1)]
fn triangulation_table(bencher: Bencher<'_, '_>) {
    let rig = &JOB.plan.rig;
    let pan = Pan { camera: 0.1, beams: 0.1 };
    bencher.bench_local(|| {
        let panned = black_box(rig).panned(black_box(pan));
        black_box(Triangulation::new(&panned, 0, SheetPlane::LowerEdge).table())
    });
}
