//! Whole frames, the paper's steps 1 to 5: both beams' range maps, visibility and flux, and the camera's range map.
//!
//! The paper: "processing of a single camera scene with 256 triangles requires about 8 seconds on a Mac II". The scenes
//! are the built-in facets with about as many triangles, and a generated terrain with half a million. Cached data of a
//! renderer is reused, as between the frames of a drive.

use std::sync::LazyLock;

use divan::{Bencher, black_box};
use raypencil::harness::contender;
use raypencil::io::{Overrides, load};
use raypencil::{Request, Scene};

fn main() {
    divan::main();
}

const HALF_A_MILLION: &str = r#"
version = 1
[terrain]
generate = { kind = "plain", seed = 1, faces = 500000, extent_m = 50 }
"#;

static FACETS: LazyLock<Scene> =
    LazyLock::new(|| load("facets", &Overrides::default()).expect("a built-in scene").scene);

static PLAIN: LazyLock<Scene> = LazyLock::new(|| {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("plain.toml");
    std::fs::write(&path, HALF_A_MILLION).expect("written");
    load(path.to_str().expect("a path in UTF-8"), &Overrides::default()).expect("a valid scene").scene
});

/// Measures a renderer after a first frame.
fn measure(bencher: Bencher<'_, '_>, scene: &Scene, name: &str) {
    let renderer = contender(name).expect("a renderer's name").renderer;
    let render = || renderer.render(black_box(scene), &Request::EVERYTHING);
    // The first frame constructs the cached data.
    render();
    bencher.bench_local(render);
}

#[divan::bench(args = ["scanline", "scanline-paper", "tracer"], sample_count = 11, sample_size = 1)]
fn facets(bencher: Bencher<'_, '_>, name: &str) {
    measure(bencher, &FACETS, name);
}

#[divan::bench(args = ["scanline", "scanline-paper", "tracer"], sample_count = 11, sample_size = 1)]
fn half_a_million(bencher: Bencher<'_, '_>, name: &str) {
    measure(bencher, &PLAIN, name);
}
