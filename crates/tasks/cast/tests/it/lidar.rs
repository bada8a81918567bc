//! Patterns of range sensors in worlds with known answers, and their point clouds.

use glam::DVec3;
use raypencil_cast::{Answers, CastSource, PcdData, Questions, cast, range_picture, top_picture, write_set};
use raypencil_files::{Limits, read_npy_numbers};
use raypencil_scene::pattern::{Cone, Grid, Mounting, Spinning, TimedPose, TimedPoses};
use raypencil_scene::{NamedRaySet, Pose, Sides, Silent, Triangles};

/// A VLP-16 at this pose, with its emitters on its axis.
fn vlp_16(pose: Pose, steps: u64) -> NamedRaySet {
    let mut head = Spinning { steps, ..Spinning::preset("vlp-16").unwrap() };
    head.channels.iter_mut().for_each(|channel| channel.vertical_m = 0.0);
    let rays = Mounting::Fixed(pose).place(head.rays("rays").unwrap(), "rays").unwrap();
    NamedRaySet::new("vlp16", rays, Sides::Both).unwrap()
}

/// A square floor at z = 0 that reaches 50 m to each side.
fn floor() -> Triangles {
    let corners = [[-50.0, -50.0], [50.0, -50.0], [50.0, 50.0], [-50.0, 50.0]];
    let vertices = corners.map(|[x, y]| [x, y, 0.0]).to_vec();
    Triangles::new(vertices, vec![[0, 1, 2], [0, 2, 3]]).unwrap()
}

fn answers(mesh: &Triangles, set: &NamedRaySet) -> Answers {
    cast(mesh, set.set.rays(), set.set.sides(), Questions::default(), &Silent)
}

#[test]
fn over_a_floor_the_range_is_the_height_over_the_sine() {
    let height = 1.25;
    let set = vlp_16(Pose::from_position(DVec3::Z * height), 1808);
    let found = answers(&floor(), &set);
    let elevations = set.elevations_deg.as_ref().unwrap();
    for (index, read) in found.first.iter().enumerate() {
        let elevation = elevations[index % 16];
        match read.hit() {
            None => assert!(elevation > -1.5, "ray {index} at {elevation} degrees"),
            Some(hit) => {
                let range = height / libm::sin(-elevation.to_radians());
                assert!(((hit.range - range) / range).abs() < 1e-13, "ray {index}: {} {range}", hit.range);
                assert!(hit.point.z.abs() < 1e-13 && (hit.cos_incidence * range - height).abs() < 1e-13);
            }
        }
    }
    // Eight channels look down. That at -1 degree meets the floor 71.6 m away: outside, for all azimuths.
    assert_eq!(found.counts().0, 1808 * 7);
}

#[test]
fn in_the_middle_of_a_box_ranges_are_those_of_its_planes() {
    // A cube of half side 2, seen from its middle by a raster of 90 x 90 degrees: the plane x = 2 fills the view.
    let corner = |k: u32| [0, 1, 2].map(|axis| if k >> axis & 1 == 1 { 2.0 } else { -2.0 });
    let faces = vec![[1, 3, 5], [3, 7, 5], [0, 4, 2], [2, 4, 6], [0, 1, 4], [1, 5, 4], [2, 6, 3], [3, 6, 7]];
    let mesh = Triangles::new((0..8).map(corner).collect(), faces).unwrap();
    let grid =
        Grid { columns: 9, rows: 7, width_deg: 89.0, height_deg: 80.0, ..Grid::preset("l515").unwrap() };
    let set = NamedRaySet::new("grid", grid.rays("rays").unwrap(), Sides::Both).unwrap();
    for (ray, hit) in set.set.rays().iter().zip(&answers(&mesh, &set).first) {
        let hit = hit.hit().unwrap();
        assert!((hit.point.x - 2.0).abs() < 1e-15 && (hit.t * ray.direction.x - 2.0).abs() < 1e-15);
    }
}

#[test]
fn a_footprint_on_a_floor_is_as_wide_as_its_divergence() {
    // Straight down from 10 m, 20 mrad full angle: the outermost ring has the radius 10 tan(0.01).
    let grid = Grid { columns: 1, rows: 1, ..Grid::preset("l515").unwrap() };
    let grid = Grid { max_range_m: 100.0, ..grid };
    let cone = Cone { divergence_rad: 0.02, rings: 2 };
    let rays = cone.spread(&grid.rays("rays").unwrap(), "cone").unwrap();
    let down =
        Pose { position: DVec3::Z * 10.0, ..Pose::from_axis_angle(DVec3::Y, std::f64::consts::FRAC_PI_2) };
    let rays = Mounting::Fixed(down).place(rays, "rays").unwrap();
    let set = NamedRaySet::new("beam", rays, Sides::Both).unwrap();
    let found = answers(&floor(), &set);
    for (k, hit) in found.first.iter().enumerate() {
        let expected = match k {
            0 => 0.0,
            1..=6 => 10.0 * libm::tan(0.005),
            _ => 10.0 * libm::tan(0.01),
        };
        assert!((hit.hit().unwrap().point.truncate().length() - expected).abs() < 1e-13, "{k}");
    }
}

/// The lines of a header and the bytes that follow it.
fn parts(bytes: &[u8], end: &str) -> (Vec<String>, Vec<u8>) {
    let at = bytes.windows(end.len()).position(|part| part == end.as_bytes()).unwrap() + end.len();
    let header = std::str::from_utf8(&bytes[..at]).unwrap();
    (header.lines().map(str::to_string).collect(), bytes[at..].to_vec())
}

fn double(bytes: &[u8], at: usize) -> f64 {
    f64::from_le_bytes(bytes[at..at + 8].try_into().unwrap())
}

fn single(bytes: &[u8], at: usize) -> f32 {
    f32::from_le_bytes(bytes[at..at + 4].try_into().unwrap())
}

#[test]
fn clouds_hold_the_points_their_channels_and_their_times() {
    let folder = tempfile::tempdir().unwrap();
    let set = vlp_16(Pose::from_position(DVec3::new(3.0, -1.0, 1.25)), 5);
    let mesh = floor();
    let found = answers(&mesh, &set);
    let source = CastSource { mesh: "m".into(), rays: "r".into(), ..CastSource::default() };
    write_set(folder.path(), &found, (&mesh, &set, Sides::Both), &source, PcdData::Binary).unwrap();

    let (header, body) = parts(&std::fs::read(folder.path().join("cloud.ply")).unwrap(), "end_header\n");
    let hits: Vec<_> = found.hits().collect();
    assert_eq!(header[0..2], ["ply", "format binary_little_endian 1.0"]);
    assert!(header.contains(&format!("element vertex {}", hits.len())), "{header:?}");
    let properties: Vec<&str> = header.iter().filter_map(|line| line.strip_prefix("property ")).collect();
    assert_eq!(properties, ["double x", "double y", "double z", "uint face", "double cos_incidence"]);
    assert_eq!(body.len(), 36 * hits.len());
    for (point, hit) in body.chunks_exact(36).zip(&hits) {
        assert_eq!([0, 8, 16].map(|at| double(point, at)), hit.point.to_array());
        assert_eq!(u32::from_le_bytes(point[24..28].try_into().unwrap()), hit.face.0);
        assert_eq!(double(point, 28), hit.cos_incidence);
    }

    let (header, body) = parts(&std::fs::read(folder.path().join("cloud.pcd")).unwrap(), "DATA binary\n");
    for line in [
        "VERSION 0.7",
        "FIELDS x y z intensity ring time timestamp channel range face",
        "SIZE 4 4 4 4 2 4 8 2 4 4",
        "TYPE F F F F U F F U F U",
        "COUNT 1 1 1 1 1 1 1 1 1 1",
        "WIDTH 16",
        "HEIGHT 5",
        "POINTS 80",
    ] {
        assert!(header.contains(&line.to_string()), "{line}: {header:?}");
    }
    assert_eq!(body.len(), 40 * 80);
    let times = set.times.as_ref().unwrap();
    for (index, point) in body.chunks_exact(40).enumerate() {
        assert_eq!(usize::from(u16::from_le_bytes(point[30..32].try_into().unwrap())), index % 16);
        assert_eq!(double(point, 22), times[index]);
        let hit = found.first[index].hit();
        assert_eq!(single(point, 0).is_nan(), hit.is_none());
        if let Some(hit) = hit {
            assert_eq!([single(point, 0), single(point, 8)], [hit.point.x as f32, hit.point.z as f32]);
            assert_eq!(single(point, 32), hit.range as f32);
        }
    }
    let summary = std::fs::read_to_string(folder.path().join("summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    assert_eq!(summary["rays"]["name"], "vlp16");
    assert_eq!(summary["pictures"], serde_json::json!(["range.png", "top.png"]));
    assert!(summary["arrays"].as_array().unwrap().contains(&"time.npy".into()));
}

#[test]
fn origins_and_directions_are_those_of_each_firing() {
    // 10 m/s along y, and a quarter of a turn to the left in the second.
    let at = |time_s: f64| TimedPose {
        time_s,
        pose: Pose {
            position: DVec3::new(0.0, 10.0 * time_s, 2.0),
            ..Pose::from_axis_angle(DVec3::Z, time_s * std::f64::consts::FRAC_PI_2)
        },
    };
    let mounting = Mounting::Moving(TimedPoses::new(vec![at(0.0), at(1.0)], "poses").unwrap());
    let head = Spinning {
        steps: 5,
        azimuth_step_deg: 0.0625,
        period_s: 0.125,
        ..Spinning::preset("vlp-16").unwrap()
    };
    let pattern = mounting.place(head.rays("rays").unwrap(), "rays").unwrap();
    let set = NamedRaySet::new("vlp16", pattern, Sides::Both).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let (mesh, source) = (floor(), CastSource::default());
    let found = answers(&mesh, &set);
    write_set(folder.path(), &found, (&mesh, &set, Sides::Both), &source, PcdData::Binary).unwrap();
    let read = |name: &str| {
        let array = read_npy_numbers(folder.path().join(name), &Limits::default()).unwrap();
        assert_eq!(array.shape, [5, 16, 3], "{name}");
        array.values.chunks(3).map(DVec3::from_slice).collect::<Vec<DVec3>>()
    };
    let [origins, directions] = ["origin.npy", "direction.npy"].map(read);
    for (index, (origin, direction)) in origins.into_iter().zip(directions).enumerate() {
        let channel = &head.channels[index % 16];
        let time = (index / 16) as f64 * 0.125 + channel.firing_s;
        let emitter = DVec3::new(0.0, 10.0 * time, 2.0 + channel.vertical_m);
        assert!((origin - emitter).length() < 1e-12, "{index}: {origin} {emitter}");
        let azimuth = (90.0 * time + 0.0625 * (time / 0.125)).to_radians();
        let elevation = channel.elevation_deg.to_radians();
        let expected = DVec3::new(
            libm::cos(elevation) * libm::cos(azimuth),
            libm::cos(elevation) * libm::sin(azimuth),
            libm::sin(elevation),
        );
        assert!((direction - expected).length() < 1e-12, "{index}: {direction} {expected}");
    }
    let summary = std::fs::read_to_string(folder.path().join("summary.json")).unwrap();
    assert!(summary.contains("\"origin.npy\"") && summary.contains("\"direction.npy\""));
}

#[test]
fn pictures_name_their_scales_and_are_left_out_if_nothing_is_hit() {
    let set = vlp_16(Pose::from_position(DVec3::Z), 3);
    let nothing = Triangles::new(vec![], vec![]).unwrap();
    let found = answers(&nothing, &set);
    assert!(range_picture(&found, &set).is_none() && top_picture(&found, &set).is_none());
    let found = answers(&floor(), &set);
    let picture = range_picture(&found, &set).unwrap();
    let svg = picture.svg();
    for text in ["15.0°", "-15.0°", "range, m", "nothing is hit"] {
        assert!(svg.contains(text), "{text}");
    }
    assert!(top_picture(&found, &set).unwrap().svg().contains("height z, m"));
}
