//! Point clouds, byte by byte.

use glam::DVec3;
use raypencil_cast::{Answers, CloudFrame, CloudMap, PcdData, Questions, cast, write_pcd, write_ply};
use raypencil_scene::pattern::{EchoLight, Mounting, Spinning, TimedPose, TimedPoses};
use raypencil_scene::{CastRay, NamedRaySet, Pose, RaySet, Sides, Silent, Triangles};

/// The ring of each point of a set with this shape, as its PCD file gives it.
fn rings(shape: &[u64]) -> Vec<u16> {
    let count: u64 = shape.iter().product();
    let plate = vec![[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [0.0, 9.0, 0.0]];
    let mesh = Triangles::new(plate, vec![[0, 1, 2]]).expect("a plate");
    let rays: Vec<CastRay> =
        (0..count).map(|k| CastRay::new(DVec3::new(k as f64 / 64.0, 0.0, 1.0), DVec3::NEG_Z)).collect();
    let answers = cast(&mesh, &rays, Sides::Both, Questions::default(), &Silent);
    let set = NamedRaySet {
        name: "rays".into(),
        shape: shape.to_vec(),
        set: RaySet::new(rays, Sides::Both).expect("rays"),
        times: None,
        weights: None,
        returns: None,
        elevations_deg: None,
        mounting: Mounting::HERE,
        echo: EchoLight::default(),
    };
    points_of(&answers, &set, CloudFrame::Mesh).1.iter().map(|point| point.ring).collect()
}

/// A point of a PCD file.
#[derive(Debug, Clone, Copy)]
struct Point {
    place: [f32; 3],
    intensity: f32,
    ring: u16,
    time: f32,
    timestamp: f64,
    channel: u16,
    range: f32,
    face: u32,
}

/// The header of a set's PCD file, and its points.
fn points_of(answers: &Answers, set: &NamedRaySet, frame: CloudFrame) -> (String, Vec<Point>) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("cloud.pcd");
    write_pcd(&path, answers, (set, None), (frame, PcdData::Binary), &CloudMap::default()).expect("a file");
    let bytes = std::fs::read(path).expect("the file");
    let text = b"DATA binary\n";
    let start =
        bytes.windows(text.len()).position(|at| at == text).expect("the end of the header") + text.len();
    let header = String::from_utf8(bytes[..start].to_vec()).expect("text");
    assert_eq!((bytes.len() - start) % 40, 0);
    let points = bytes[start..].chunks_exact(40).map(|point| {
        let four = |at: usize| -> [u8; 4] { point[at..at + 4].try_into().expect("four bytes") };
        let two = |at: usize| u16::from_le_bytes([point[at], point[at + 1]]);
        Point {
            place: [0, 4, 8].map(|at| f32::from_le_bytes(four(at))),
            intensity: f32::from_le_bytes(four(12)),
            ring: two(16),
            time: f32::from_le_bytes(four(18)),
            timestamp: f64::from_le_bytes(point[22..30].try_into().expect("eight bytes")),
            channel: two(30),
            range: f32::from_le_bytes(four(32)),
            face: u32::from_le_bytes(four(36)),
        }
    });
    (header, points.collect())
}

#[test]
fn the_ring_is_the_index_in_the_second_dimension() {
    assert_eq!(rings(&[4]), [0; 4]);
    assert_eq!(rings(&[2, 3]), [0, 1, 2, 0, 1, 2]);
    // Of a third dimension four rays each are in one ring.
    let of_two_steps = [0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2].repeat(2);
    assert_eq!(rings(&[2, 3, 4]), of_two_steps);
    let of_five = (0..3).flat_map(|ring| [ring; 10]).collect::<Vec<u16>>();
    assert_eq!(rings(&[1, 3, 2, 5]), of_five);
}

/// A floor of 200 x 200 m.
fn floor() -> Triangles {
    let corners = [[-100.0, -100.0], [100.0, -100.0], [100.0, 100.0], [-100.0, 100.0]];
    let vertices = corners.map(|[x, y]| [x, y, 0.0]).to_vec();
    Triangles::new(vertices, vec![[0, 1, 2], [0, 2, 3]]).expect("a floor")
}

fn head(mounting: Mounting, steps: u64) -> (NamedRaySet, Answers) {
    let mut head = Spinning { steps, ..Spinning::preset("vlp-16").expect("a preset") };
    head.channels.iter_mut().for_each(|channel| channel.vertical_m = 0.0);
    let rays = head.rays("rays").expect("rays").starting_at(100.0);
    let rays = mounting.place(rays, "rays").expect("poses");
    let set = NamedRaySet::new("head", rays, Sides::Both).expect("a set");
    let answers = cast(&floor(), set.set.rays(), Sides::Both, Questions::default(), &Silent);
    (set, answers)
}

#[test]
fn rings_ascend_with_the_elevation_and_channels_keep_the_order_of_the_manual() {
    // The elevations of the VLP-16 are -15, 1, -13, 3, ...: laser 1 looks at +1 degree, which is the ninth from below.
    let (set, answers) = head(Mounting::Fixed(Pose::from_position(DVec3::Z)), 3);
    let (_, points) = points_of(&answers, &set, CloudFrame::Mesh);
    let of_driver = [0, 8, 1, 9, 2, 10, 3, 11, 4, 12, 5, 13, 6, 14, 7, 15];
    for (index, point) in points.iter().enumerate() {
        assert_eq!((point.ring, usize::from(point.channel)), (of_driver[index % 16], index % 16));
        // Firing k of a sequence is 2.304 us after the one before; a sequence takes 55.296 us.
        let seconds = (index / 16) as f64 * 55.296e-6 + (index % 16) as f64 * 2.304e-6;
        assert!((f64::from(point.time) - seconds).abs() < 1e-10, "{point:?}");
        assert!((point.timestamp - 100.0 - seconds).abs() < 1e-13, "{point:?}");
        assert_eq!(point.range.is_nan(), point.face == u32::MAX);
        if !point.range.is_nan() {
            // Over a floor the cosine is the height over the range: 1 / R^3 in all, for a height of 1 m.
            let expected = 1.0 / (point.range * point.range * point.range);
            assert!((point.intensity / expected - 1.0).abs() < 1e-5, "{point:?}");
        }
    }
}

#[test]
fn each_frame_has_a_file_and_a_word_of_its_own() {
    assert_eq!(
        CloudFrame::ALL.map(|frame| (frame.file(), frame.option())),
        [
            ("cloud.pcd", "mesh"),
            ("cloud-sensor.pcd", "sensor"),
            ("cloud-start.pcd", "start"),
            ("cloud-end.pcd", "end")
        ]
    );
}

#[test]
fn points_stand_in_the_frame_that_the_header_says() {
    // One metre up, turned by a quarter to the left, and three metres ahead.
    let turned = Pose::from_axis_angle(DVec3::Z, std::f64::consts::FRAC_PI_2);
    let pose = Pose { position: DVec3::new(3.0, 0.0, 1.0), ..turned };
    let (set, answers) = head(Mounting::Fixed(pose), 1);
    assert_eq!(CloudFrame::of(&set.mounting), [CloudFrame::Mesh, CloudFrame::Sensor]);
    let (header, of_mesh) = points_of(&answers, &set, CloudFrame::Mesh);
    assert!(
        header.contains("frame of the mesh\n") && header.contains("VIEWPOINT 0 0 0 1 0 0 0\n"),
        "{header}"
    );
    let (header, of_sensor) = points_of(&answers, &set, CloudFrame::Sensor);
    assert!(header.contains("VIEWPOINT 3 0 1 0.707106781186547"), "{header}");
    // Channel 0 looks 15 degrees down: the floor is 1 / tan 15 away, along x for the sensor and along y on the mesh.
    let ahead = 1.0 / libm::tan(15.0_f64.to_radians());
    let near = |place: [f32; 3], expected: [f64; 3]| {
        place.iter().zip(expected).all(|(a, b)| (f64::from(*a) - b).abs() < 1e-5)
    };
    assert!(near(of_mesh[0].place, [3.0, ahead, 0.0]), "{:?}", of_mesh[0]);
    assert!(near(of_sensor[0].place, [ahead, 0.0, -1.0]), "{:?}", of_sensor[0]);
    // The viewpoint takes the one to the other.
    for (of_sensor, of_mesh) in of_sensor.iter().zip(&of_mesh).filter(|(one, _)| !one.range.is_nan()) {
        let point = pose * DVec3::from_array(of_sensor.place.map(f64::from));
        assert!(near(of_mesh.place, point.to_array()), "{of_mesh:?}");
    }
}

#[test]
fn a_moving_head_distorts_its_own_cloud_and_not_that_of_its_start() {
    // 10 m/s along x: one sequence of 55.296 us later the same point of the floor is 0.55 mm nearer.
    let at = |time_s: f64, x: f64| TimedPose { time_s, pose: Pose::from_position(DVec3::new(x, 0.0, 1.0)) };
    let poses = TimedPoses::new(vec![at(100.0, 0.0), at(101.0, 10.0)], "poses").expect("poses");
    let (set, answers) = head(Mounting::Moving(poses), 1000);
    let [of_mesh, of_sensor, of_start] = [CloudFrame::Mesh, CloudFrame::Sensor, CloudFrame::SensorAtStart]
        .map(|frame| points_of(&answers, &set, frame).1);
    for ((mesh, sensor), start) in
        of_mesh.iter().zip(&of_sensor).zip(&of_start).filter(|((one, _), _)| !one.range.is_nan())
    {
        let moved = 10.0 * (mesh.timestamp - 100.0);
        let x = |point: &Point| f64::from(point.place[0]);
        assert!((x(mesh) - moved - x(sensor)).abs() < 1e-5, "{mesh:?} {sensor:?}");
        assert!(
            (x(mesh) - x(start)).abs() < 1e-5 && (start.place[2] + 1.0).abs() < 1e-6,
            "{mesh:?} {start:?}"
        );
    }
    // Placed with a vehicle, the poses go with it.
    let vehicle = Pose::from_position(DVec3::new(0.0, 7.0, 0.0));
    let placed = set.placed(&vehicle).expect("rays");
    assert_eq!(placed.mounting.at(100.5).map(|pose| pose.position), Some(DVec3::new(5.0, 7.0, 1.0)));
}

/// The numbers of a header's line.
fn numbers(header: &str, key: &str) -> Vec<f64> {
    let line = header.lines().find_map(|line| line.strip_prefix(key)).expect("the line");
    line.split_whitespace().map(|word| word.parse().expect("a number")).collect()
}

#[test]
fn points_of_a_drive_over_a_floor_stand_where_the_scan_starts_and_ends() {
    // 10 m/s along y for a second before the scan, during it, and after it; the sensor looks along y, 1 m over the floor.
    let turned = Pose::from_axis_angle(DVec3::Z, std::f64::consts::FRAC_PI_2);
    let at = |time_s: f64| TimedPose {
        time_s,
        pose: Pose { position: DVec3::new(0.0, 10.0 * (time_s - 99.0), 1.0), ..turned },
    };
    let mounting = Mounting::Moving(TimedPoses::new(vec![at(99.0), at(102.0)], "poses").expect("poses"));
    assert_eq!(CloudFrame::of(&mounting), CloudFrame::ALL);
    let (set, answers) = head(mounting, 1000);
    // The last channel of the last sequence: 999 periods of 55.296 us and 15 firings of 2.304 us after the first.
    let duration = 999.0 * 55.296e-6 + 15.0 * 2.304e-6;
    let frames = [(CloudFrame::SensorAtStart, 0.0, "first"), (CloudFrame::SensorAtEnd, duration, "last")];
    for (frame, moment, which) in frames {
        let (header, points) = points_of(&answers, &set, frame);
        assert!(
            header.contains(&format!("frame of the sensor, at the time of the {which} ray\n")),
            "{header}"
        );
        let viewpoint = numbers(&header, "VIEWPOINT ");
        let position = [0.0, 10.0 * (1.0 + moment), 1.0];
        assert!(viewpoint.iter().zip(position).all(|(a, b)| (a - b).abs() < 1e-9), "{header}");
        let mut seen = 0;
        for (index, point) in points.iter().enumerate().filter(|(_, point)| !point.range.is_nan()) {
            // Down by the elevation, at an azimuth that runs clockwise; less the way to the moment of the frame.
            let since = f64::from(point.time);
            let down = -set.elevations_deg.as_ref().expect("a head")[index % 16].to_radians();
            let azimuth = -since / 55.296e-6 * 360.0 * 10.0 * 55.296e-6;
            let level = 1.0 / libm::tan(down);
            let expected = [
                level * libm::cos(azimuth.to_radians()) + 10.0 * (since - moment),
                level * libm::sin(azimuth.to_radians()),
                -1.0,
            ];
            let near = |(found, expected): (&f32, f64)| (f64::from(*found) - expected).abs() < 2e-5;
            assert!(point.place.iter().zip(expected).all(near), "{frame:?} {index}: {point:?} {expected:?}");
            seen += 1;
        }
        assert!(seen > 7000, "{seen}");
    }
}

#[test]
fn surface_and_air_take_light_by_the_law_of_beer_and_lambert() {
    let (plain, answers) = head(Mounting::Fixed(Pose::from_position(DVec3::Z)), 3);
    let echo = EchoLight { reflectivity: 0.25, extinction_per_m: 0.03 };
    let hazy = NamedRaySet { echo, ..plain.clone() };
    let [clear, dim] = [&plain, &hazy].map(|set| points_of(&answers, set, CloudFrame::Mesh).1);
    let mut seen = 0;
    for (clear, dim) in clear.iter().zip(&dim).filter(|(one, _)| !one.range.is_nan()) {
        // Over a floor, 1 m up: 1 / R^3 in all, to the floor and back.
        let range = f64::from(dim.range);
        let expected = 0.25 / (range * range * range) * libm::exp(-0.06 * range);
        assert!((f64::from(dim.intensity) / expected - 1.0).abs() < 1e-5, "{dim:?}");
        assert!(dim.intensity < 0.25 * clear.intensity && dim.place == clear.place);
        seen += 1;
    }
    assert_eq!(seen, 24);
}

#[test]
fn headers_name_the_map_in_which_the_mesh_lies() {
    let mesh = Triangles::new(vec![[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [0.0, 9.0, 0.0]], vec![[0, 1, 2]])
        .expect("a plate");
    let rays = vec![CastRay::new(DVec3::Z, DVec3::NEG_Z)];
    let answers = cast(&mesh, &rays, Sides::Both, Questions::default(), &Silent);
    let set = NamedRaySet {
        name: "rays".into(),
        shape: vec![1],
        set: RaySet::new(rays, Sides::Both).expect("rays"),
        times: None,
        weights: None,
        returns: None,
        elevations_deg: None,
        mounting: Mounting::HERE,
        echo: EchoLight::default(),
    };
    let folder = tempfile::tempdir().expect("a folder");
    let header = |map: &CloudMap| {
        let [ply, pcd] = ["c.ply", "c.pcd"].map(|name| folder.path().join(name));
        write_ply(&ply, &answers, None, map).expect("a file");
        write_pcd(&pcd, &answers, (&set, None), (CloudFrame::Mesh, PcdData::Binary), map).expect("a file");
        [ply, pcd].map(|path| String::from_utf8_lossy(&std::fs::read(path).expect("the file")).into_owned())
    };
    assert!(header(&CloudMap::default()).iter().all(|text| !text.contains("map_")));
    let map = CloudMap {
        origin: [491_000.0, 5_540_123.0, 212.5],
        system: Some("WGS 84 / UTM zone 33N (EPSG:32633)".into()),
    };
    let [ply, pcd] = header(&map);
    let lines = |word: &str| {
        format!(
            "{word} map_origin_m 491000 5540123 212.5\n{word} map_system WGS 84 / UTM zone 33N (EPSG:32633)\n"
        )
    };
    assert!(ply.starts_with(&format!(
        "ply\nformat binary_little_endian 1.0\ncomment raypencil cast, frame of the mesh\n{}element vertex 1\n",
        lines("comment")
    )), "{ply}");
    assert!(
        pcd.contains(&format!("\n# raypencil cast, frame of the mesh\n{}VERSION 0.7\n", lines("#"))),
        "{pcd}"
    );
}

#[test]
fn compressed_points_are_read_back_as_they_were() {
    let (set, answers) = head(Mounting::Fixed(Pose::from_position(DVec3::Z)), 200);
    let folder = tempfile::tempdir().expect("a folder");
    let [plain, packed] = [PcdData::Binary, PcdData::BinaryCompressed].map(|data| {
        let path = folder.path().join(data.word());
        write_pcd(&path, &answers, (&set, None), (CloudFrame::Sensor, data), &CloudMap::default())
            .expect("a file");
        std::fs::read(path).expect("the file")
    });
    let read = |bytes: &[u8]| {
        raypencil_mesh_io::cloud_from_bytes(bytes, "c.pcd".as_ref(), |_| true).expect("a cloud")
    };
    let [of_plain, of_packed] = [read(&plain), read(&packed)];
    assert_eq!((of_packed.width, of_packed.height), (16, 200));
    for name in ["x", "y", "z", "intensity", "ring", "time", "timestamp", "channel", "range", "face"] {
        let values = |cloud: &raypencil_mesh_io::Cloud| -> Vec<u64> {
            cloud.column(name).expect("a field").values.iter().map(|value| value.to_bits()).collect()
        };
        assert_eq!(values(&of_plain), values(&of_packed), "{name}");
    }
    assert!(2 * packed.len() < plain.len(), "{} of {} bytes", packed.len(), plain.len());
}

/// A ray that meets a plate 0.25 m from its edge, one that passes 0.5 m beside it, and one through its diagonal.
#[test]
fn margins_are_fields_of_clouds() {
    let corners = vec![[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [4.0, 4.0, 0.0], [0.0, 4.0, 0.0]];
    let plate = Triangles::new(corners, vec![[0, 1, 2], [0, 2, 3]]).expect("a plate");
    let down = |x: f64, y: f64| CastRay::new(DVec3::new(x, y, 1.0), DVec3::NEG_Z);
    let rays = vec![down(3.75, 1.75), down(4.5, 1.0), down(1.0, 1.0)];
    let questions = Questions { margins: true, ..Questions::default() };
    let answers = cast(&plate, &rays, Sides::Both, questions, &Silent);
    let set = NamedRaySet {
        name: "rays".into(),
        shape: vec![3],
        set: RaySet::new(rays, Sides::Both).expect("rays"),
        times: None,
        weights: None,
        returns: None,
        elevations_deg: None,
        mounting: Mounting::HERE,
        echo: EchoLight::default(),
    };
    let folder = tempfile::tempdir().expect("a folder");
    let (pcd, ply) = (folder.path().join("cloud.pcd"), folder.path().join("cloud.ply"));
    write_pcd(&pcd, &answers, (&set, None), (CloudFrame::Mesh, PcdData::Binary), &CloudMap::default())
        .expect("a file");
    write_ply(&ply, &answers, None, &CloudMap::default()).expect("a file");
    let bytes = std::fs::read(&pcd).expect("the file");
    let text = String::from_utf8_lossy(&bytes);
    for line in [
        "FIELDS x y z intensity ring time timestamp channel range face margin_face margin_surface\n",
        "SIZE 4 4 4 4 2 4 8 2 4 4 4 4\n",
        "TYPE F F F F U F F U F U F F\n",
        "COUNT 1 1 1 1 1 1 1 1 1 1 1 1\n",
    ] {
        assert!(text.contains(line), "{line}");
    }
    let points = &bytes[bytes.len() - 3 * 48..];
    let single = |point: usize, at: usize| {
        let bytes = points[48 * point + at..][..4].try_into().expect("four bytes");
        f32::from_le_bytes(bytes)
    };
    let margins = answers.margins.as_ref().expect("margins");
    for (ray, margin) in margins.iter().enumerate() {
        for (at, low) in [(40, margin.face.lo), (44, margin.surface.lo)] {
            let stored = f64::from(single(ray, at));
            assert!(stored <= low && low - stored <= 1e-6 * low, "ray {ray}: {stored} of {low}");
        }
    }
    // The edge at x = 4 is 0.25 m from the first ray, and 0.5 m from the second; the third runs on the diagonal.
    let near = |found: f32, expected: f32| (found - expected).abs() < 1e-6;
    assert!(near(single(0, 44), 0.25) && near(single(1, 44), 0.5), "{} {}", single(0, 44), single(1, 44));
    assert_eq!(single(2, 40), 0.0);
    // The hits alone are in the PLY file: the first and the third ray.
    let bytes = std::fs::read(&ply).expect("the file");
    let text = String::from_utf8_lossy(&bytes);
    assert!(text.contains("property double margin_face\nproperty double margin_surface\nend_header\n"));
    let double = |at: usize| f64::from_le_bytes(bytes[at..][..8].try_into().expect("eight bytes"));
    let (first, third) = (bytes.len() - 2 * 52, bytes.len() - 52);
    assert_eq!([double(first + 36), double(first + 44)], [margins[0].face.lo, margins[0].surface.lo]);
    assert_eq!([double(third + 36), double(third + 44)], [margins[2].face.lo, margins[2].surface.lo]);
}
