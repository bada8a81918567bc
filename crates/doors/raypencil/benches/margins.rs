//! The referee: exact verdicts per second, with and without margins, and correctly rounded values, on one thread and on
//! all cores.
//!
//! The terrain is the Mars yard of half a million triangles if RAYPENCIL_EXTRA_DATA names the folder with
//! `marsyard2021.glb`, else a generated terrain with as many faces, each under the default rig. Two thirds of the rays
//! are the camera's, the rest are those of both beams. They are the same in every run.

use std::path::Path;
use std::sync::LazyLock;

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use rayon::prelude::*;
use raypencil::io::load;
use raypencil::referee::Referee;
use raypencil::{Scene, SensorId};

fn main() {
    divan::main();
}

/// Number of rays of one run.
const RAYS: u64 = 60_000;

/// A terrain with as many faces and the same extent as the yard.
const GENERATED: &str = r#"
version = 1
[terrain]
generate = { kind = "plain", seed = 1, faces = 504512, extent_m = 50 }
"#;

static SCENE: LazyLock<Scene> = LazyLock::new(|| {
    let yard = std::env::var_os("RAYPENCIL_EXTRA_DATA")
        .map(|folder| Path::new(&folder).join("marsyard2021.glb"))
        .filter(|path| path.exists());
    if let Some(path) = yard {
        let path = path.to_str().expect("a path in UTF-8");
        return load(path, &Default::default()).expect("a valid yard").scene;
    }
    eprintln!("RAYPENCIL_EXTRA_DATA names no folder with marsyard2021.glb: on generated ground");
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("plain.toml");
    std::fs::write(&path, GENERATED).expect("written");
    load(path.to_str().expect("a path in UTF-8"), &Default::default()).expect("a valid scene").scene
});

static REFEREE: LazyLock<Referee<'static>> = LazyLock::new(|| Referee::new(&SCENE));

/// The rays: a Weyl sequence over the cells of each sensor.
static PLACES: LazyLock<Vec<(SensorId, u32, u32)>> = LazyLock::new(|| {
    (0..RAYS)
        .map(|k| {
            let sensor = match k % 6 {
                4 => SensorId::Beam(0),
                5 => SensorId::Beam(1),
                _ => SensorId::Camera,
            };
            let (width, height) = SCENE.size(sensor).expect("the default rig");
            // 1/x and 1/x^2 for the root x of x^3 = x + 1: the points fill a plane evenly.
            let part = |step: f64, count: u32| ((k as f64 * step).fract() * f64::from(count)) as u32;
            (sensor, part(0.754_877_666_246_692_8, width), part(0.569_840_290_998_053_3, height))
        })
        .collect()
});

/// Measures `ask` over every ray on `threads` threads; 0 is all cores.
fn all_rays<T: Send>(
    bencher: Bencher,
    threads: usize,
    ask: impl Fn(&(SensorId, u32, u32)) -> Option<T> + Sync + Send,
) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let run = || pool.install(|| PLACES.par_iter().filter(|place| ask(black_box(place)).is_some()).count());
    assert_eq!(run(), PLACES.len());
    bencher.counter(ItemsCount::new(RAYS)).bench_local(run);
}

/// The camera's pixels among the rays: the verdict and all values, correctly rounded to f64 and f32.
#[divan::bench(args = [1, 0], sample_count = 11, sample_size = 1)]
fn certified_camera_pixels(bencher: Bencher, threads: usize) {
    let pixels: Vec<_> = PLACES.iter().filter(|place| place.0 == SensorId::Camera).collect();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let ask = |place: &&(SensorId, u32, u32)| REFEREE.values(place.0, place.1, place.2).is_some();
    let run = || pool.install(|| pixels.par_iter().filter(|place| ask(black_box(place))).count());
    assert!(run() > pixels.len() / 4, "many pixels see the ground");
    bencher.counter(ItemsCount::new(pixels.len())).bench_local(run);
}

#[divan::bench(args = [1, 0], sample_count = 11, sample_size = 1)]
fn verdict(bencher: Bencher, threads: usize) {
    all_rays(bencher, threads, |&(sensor, i, j)| REFEREE.verdict(sensor, i, j));
}

#[divan::bench(args = [1, 0], sample_count = 11, sample_size = 1)]
fn verdict_and_face_margin(bencher: Bencher, threads: usize) {
    all_rays(bencher, threads, |&(sensor, i, j)| REFEREE.face_margin(sensor, i, j));
}

#[divan::bench(args = [1, 0], sample_count = 11, sample_size = 1)]
fn verdict_and_both_margins(bencher: Bencher, threads: usize) {
    all_rays(bencher, threads, |&(sensor, i, j)| REFEREE.margins(sensor, i, j));
}
