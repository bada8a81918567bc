//! A rover's cycle, ten of which the paper plans for each second: a frame (both beams, steps 1 to 5), its two exposures
//! (steps 7 and 8), the extraction of the stripes and the update of the local terrain map (step 9), on a generated ground
//! of half a million triangles, with four pencils to a pixel.
//!
//! The vehicle drives on from frame to frame, so that the map moves. Every tenth cycle makes an obstacle map too.

use divan::{Bencher, black_box};
use std::sync::{Arc, LazyLock};

use raypencil::drive::DriveJob;
use raypencil::harness::contender;
use raypencil::io::{Overrides, load};
use raypencil::rover::{CameraImage, Drive, Pan, SheetPlane, Triangulation};
use raypencil::terrain::HeightIndex;
use raypencil::{Image, Renderer, Request};

fn main() {
    divan::main();
}

const HALF_A_MILLION: &str = r#"
version = 1
[vehicle]
position_m = [-15, 0]
[terrain]
generate = { kind = "plain", seed = 1, faces = 500000, extent_m = 50 }
[drive]
waypoints_m = [[15, 0]]
scans = false
"#;

static JOB: LazyLock<DriveJob> = LazyLock::new(|| {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("plain.toml");
    std::fs::write(&path, HALF_A_MILLION).expect("written");
    let loaded = load(path.to_str().expect("a path in UTF-8"), &Overrides::default()).expect("a valid scene");
    DriveJob::new(&loaded, None, String::new()).expect("a drive")
});

/// One cycle after another on a drive of its own; the drive begins anew where it ends.
struct Cycles {
    renderer: Box<dyn Renderer>,
    drive: Drive,
    exposures: u64,
}

impl Cycles {
    fn new(name: &str) -> Self {
        let drive = Drive::new(JOB.plan.clone(), Arc::clone(&JOB.mesh)).expect("a drive");
        Self { renderer: contender(name).expect("a renderer of this house").renderer, drive, exposures: 0 }
    }

    fn cycle(&mut self) {
        let exposures = &mut self.exposures;
        let mut develop = |_, light: Image<f64>| {
            *exposures += 1;
            CameraImage::Numbers(JOB.sensor.numbers(&light, None, *exposures))
        };
        let frame = self.drive.step(self.renderer.as_ref(), &mut develop).expect("a frame");
        assert!(black_box(frame).is_some_and(|frame| frame.points > 500), "the route is long enough");
    }
}

/// The frame alone: the flux of both beams on the camera's pixels.
#[divan::bench(args = ["scanline", "tracer"], sample_count = 51, sample_size = 1)]
fn frame(bencher: Bencher<'_, '_>, name: &str) {
    let renderer = contender(name).expect("a renderer of this house").renderer;
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
    // Tables and trees are made once.
    cycles.cycle();
    bencher.bench_local(move || cycles.cycle());
}

/// The two exposures of a cycle, by what the sensor adds to them.
#[divan::bench(args = raypencil::sensor::PRESET_NAMES, sample_count = 11, sample_size = 1)]
fn exposures(bencher: Bencher<'_, '_>, name: &str) {
    let plan = &JOB.plan;
    let place = plan.route.frame(0).expect("a first frame");
    let stance = plan.vehicle.settle(&HeightIndex::new(&JOB.mesh), place.place, place.heading);
    let pose = stance.expect("on the ground").pose();
    let scene =
        plan.rig.scene(Arc::clone(&JOB.mesh), pose, plan.atmosphere, plan.flux_model).expect("a scene");
    let light =
        contender("tracer").expect("a renderer of this house").renderer.render(&scene, &Request::FLUX);
    let (_, sensor) = raypencil::sensor::preset(name).expect("a preset");
    bencher.bench_local(|| {
        for (image, exposure) in light.flux.iter().zip(0..) {
            black_box::<Image<i32>>(sensor.numbers(black_box(image), None, exposure));
        }
    });
}

/// The table of one beam, which a panned beam needs anew.
#[divan::bench(sample_count = 11, sample_size = 1)]
fn triangulation_table(bencher: Bencher<'_, '_>) {
    let rig = &JOB.plan.rig;
    let pan = Pan { camera: 0.1, beams: 0.1 };
    bencher.bench_local(|| {
        let panned = black_box(rig).panned(black_box(pan));
        black_box(Triangulation::new(&panned, 0, SheetPlane::LowerEdge).table())
    });
}
