//! The work that `docs/speed.md` sets beside Embree's, row by row, without Embree: `just speed` has the ratios.
//!
//! The grounds are generated plains of 2,000, 200,000 and 2,000,000 faces, and the Mars yard if RAYPENCIL_EXTRA_DATA names
//! the folder with `marsyard2021.glb`. One thread, but for what is said to be on all. Memory is no time: the example `speed`
//! tells that of a validation.

use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use raypencil::harness::{Validator, contender};
use raypencil::io::Subject;
use raypencil::{Referee, Request, SensorId};

#[path = "../examples/speed/work.rs"]
mod work;

use work::{BEAMS, CAMERA, DriveCycles, both_renderers, certify, subject, validated, write_whole_pack};

fn main() {
    divan::main();
}

/// A ground, loaded when it is first asked for.
struct Ground {
    name: &'static str,
    subject: LazyLock<Option<Subject>>,
}

static GROUNDS: [Ground; 4] = [
    Ground { name: "2k", subject: LazyLock::new(|| subject("2000").ok()) },
    Ground { name: "200k", subject: LazyLock::new(|| subject("200000").ok()) },
    Ground { name: "2M", subject: LazyLock::new(|| subject("2000000").ok()) },
    Ground { name: "yard", subject: LazyLock::new(yard) },
];

fn yard_file() -> Option<PathBuf> {
    let file = Path::new(&std::env::var_os("RAYPENCIL_EXTRA_DATA")?).join("marsyard2021.glb");
    file.exists().then_some(file)
}

fn yard() -> Option<Subject> {
    Some(subject(yard_file()?.to_str().expect("a path in UTF-8")).expect("a valid yard"))
}

/// Names of the grounds.
fn grounds() -> Vec<&'static str> {
    let is_there = |name: &&str| *name != "yard" || yard_file().is_some();
    GROUNDS.iter().map(|ground| ground.name).filter(is_there).collect()
}

fn ground(name: &str) -> &'static Subject {
    let ground = GROUNDS.iter().find(|ground| ground.name == name).expect("a ground's name");
    ground.subject.as_ref().expect("a ground")
}

/// Frames of a renderer after the first, on one thread.
fn frames(bencher: Bencher, name: &str, renderer: &str, request: &Request) {
    let scene = &ground(name).scene;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    let renderer = contender(renderer).expect("a renderer's name").renderer;
    let render = || pool.install(|| renderer.render(black_box(scene), request));
    black_box(render());
    bencher.bench_local(render);
}

#[divan::bench(args = grounds(), sample_count = 11, sample_size = 1)]
fn camera_scanline(bencher: Bencher, name: &str) {
    frames(bencher, name, "scanline", &CAMERA);
}

#[divan::bench(args = grounds(), sample_count = 11, sample_size = 1)]
fn camera_tracer(bencher: Bencher, name: &str) {
    frames(bencher, name, "tracer", &CAMERA);
}

#[divan::bench(args = grounds(), sample_count = 51, sample_size = 1)]
fn beams_scanline(bencher: Bencher, name: &str) {
    frames(bencher, name, "scanline", &BEAMS);
}

#[divan::bench(args = grounds(), sample_count = 51, sample_size = 1)]
fn beams_tracer(bencher: Bencher, name: &str) {
    frames(bencher, name, "tracer", &BEAMS);
}

/// The flux of both beams on the camera's image: hits, lines of sight, geometry and light.
#[divan::bench(args = grounds(), sample_count = 11, sample_size = 1)]
fn flux_scanline(bencher: Bencher, name: &str) {
    frames(bencher, name, "scanline", &Request::FLUX);
}

#[divan::bench(args = grounds(), sample_count = 11, sample_size = 1)]
fn flux_tracer(bencher: Bencher, name: &str) {
    frames(bencher, name, "tracer", &Request::FLUX);
}

/// The first map of the beams by a new renderer, on all threads: nearly all of it is the tree.
#[divan::bench(args = grounds(), sample_count = 5, sample_size = 1)]
fn tree_of_tracer_and_beams(bencher: Bencher, name: &str) {
    let scene = &ground(name).scene;
    bencher
        .with_inputs(|| contender("tracer").expect("a renderer's name").renderer)
        .bench_local_values(|renderer| renderer.render(black_box(scene), &BEAMS));
}

/// On all threads, with the tree and the tables of the one before.
#[divan::bench(args = grounds(), sample_count = 5, sample_size = 1)]
fn whole_validation(bencher: Bencher, name: &str) {
    let (subject, renderers) = (ground(name), both_renderers());
    let mut validator = Validator::default();
    validated(subject, &renderers, &mut validator);
    bencher.bench_local(|| validated(subject, &renderers, &mut validator));
}

/// Every pixel of the camera, on all threads.
#[divan::bench(args = grounds(), sample_count = 3, sample_size = 1)]
fn certified_camera_rays(bencher: Bencher, name: &str) {
    let scene = &ground(name).scene;
    let referee = Referee::new(scene);
    let (width, height) = scene.size(SensorId::Camera).expect("every scene has a camera");
    let rays = u64::from(width) * u64::from(height);
    bencher.counter(ItemsCount::new(rays)).bench_local(|| certify(&referee, width, height));
}

/// On all threads.
#[divan::bench(args = grounds(), sample_count = 1, sample_size = 1)]
fn whole_pack(bencher: Bencher, name: &str) {
    let subject = ground(name);
    bencher.bench_local(|| write_whole_pack(subject));
}

/// A cycle of a drive with the noise of `cmos`, on all threads.
#[divan::bench(args = grounds(), sample_count = 21, sample_size = 1)]
fn cycle_of_the_rover(bencher: Bencher, name: &str) {
    let mut cycles = DriveCycles::new(ground(name)).expect("a drive");
    cycles.step();
    bencher.bench_local(|| cycles.step());
}
