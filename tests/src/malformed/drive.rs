//! Malformed scene files with a drive, and kernels of its optics.

use super::case::{Case, Item};
use super::npy::array;

const FILE: &str = "scene.toml";
const RUN: &str = "drive scene.toml -o out";

pub(super) fn cases() -> Vec<Case> {
    let drive = |name: &str, what, place: &str, text: &str| {
        let text = format!("version = 1\n[drive]\n{text}\n");
        Case::of_file(&format!("drive-{name}"), what, RUN, FILE, text.into_bytes(), place)
    };
    let way = |name: &str, what, place: &str, text: &str| {
        drive(name, what, place, &format!("waypoints_m = [[1, 0]]\n{text}"))
    };
    let kernel = |name: &str, what, place: &str, item: Item| {
        way(&format!("kernel-{name}"), what, place, "optics = { blurs = [{ kernel = \"k.npy\" }] }")
            .item("k.npy", item)
    };
    let many = format!("waypoints_m = [{}]", "[0, 0],".repeat(100_000));
    vec![
        drive("none", "no waypoints", "the drive has no waypoints; expected --to X,Y", "seed = 1"),
        drive("nowhere", "an empty list of waypoints", "scene.toml:3:15", "waypoints_m = []"),
        drive("far", "a waypoint that is not finite", "scene.toml:3:", "waypoints_m = [[inf, 0]]"),
        drive("many", "a hundred thousand waypoints", "scene.toml:3:15", &many),
        drive("endless", "a route of 10^13 frames", "frames", "waypoints_m = [[1e12, 0]]"),
        drive(
            "slow",
            "a route of 10^11 frames",
            "frames",
            "waypoints_m = [[1e3, 0]]\nspeed_m_per_s = 1e-4\nframes_per_s = 1e4",
        ),
        way("backwards", "a speed below 0", "scene.toml:4:", "speed_m_per_s = -1"),
        way("nan", "a speed that is not a number", "scene.toml:4:", "speed_m_per_s = nan"),
        way("map-even", "a map with an even number of points", "scene.toml:4:14", "map_points = 2"),
        way("map-large", "a map of 2^62 points", "scene.toml:4:14", "map_points = 2147483647"),
        way("steps", "a scan of 2^63 - 1 stripes", "scene.toml:4:", "scan_steps = 9223372036854775807"),
        way("pencils", "a billion pencils for each pixel", "scene.toml:4:", "pencils_per_pixel = 1e9"),
        way(
            "grid",
            "a radial grid of 9 x 10^9 points",
            "drive.grid_sectors",
            "grid_sectors = 100000\ngrid_first_m = 0.7\ngrid_last_m = 900\ngrid_step_m = 0.01",
        ),
        way("unknown", "an unknown key", "scene.toml:4:", "evil = 1"),
        way("fine", "a fine image of 2^32 cells", "drive.optics", "optics = { oversampling = 64 }"),
        way(
            "bias",
            "a bias beyond the range of the converter",
            "drive.electronics.bias",
            "electronics = { bias_dn = 300, bits = 8 }",
        ),
        way(
            "two-blurs",
            "a blur with two kernels",
            "scene.toml:4:",
            "optics = { blurs = [{ airy_rings = 1, gaussian_px = 1 }] }",
        ),
        kernel("missing", "a missing kernel", "scene.toml:4:", Item::Folder),
        kernel("empty", "an empty kernel", "k.npy", Item::File(Vec::new())).says(&["k.npy", "first bytes"]),
        kernel(
            "large",
            "a kernel of 2^40 weights in its header",
            "k.npy",
            Item::File(array("<f8", "(1048576, 1048576)", &[0; 8])),
        )
        .says(&["k.npy", "shape"]),
        kernel(
            "even",
            "a kernel with an even number of columns",
            "kernel.columns",
            Item::File(array("<f8", "(1, 2)", &[0; 16])),
        ),
        kernel(
            "dark",
            "a kernel with the sum 0",
            "kernel.weights",
            Item::File(array("<f8", "(1, 1)", &[0; 8])),
        ),
        kernel(
            "nan",
            "a weight that is not a number",
            "kernel.weights[0]",
            Item::File(array("<f8", "(1, 1)", &f64::NAN.to_le_bytes())),
        ),
    ]
}
