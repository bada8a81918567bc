use raypencil_scene::pattern::Spinning;
use raypencil_scene::{Reading, Silent};

use super::*;
use crate::answers::Answers;
use crate::cloud::CloudMap;

/// A VLP-16 that drives along x for half a second, with a pose every tenth, over a floor: twelve sequences in three scans.
fn drive() -> (Triangles, NamedRaySet) {
    let corners = vec![[-99.0, -99.0, 0.0], [99.0, -99.0, 0.0], [99.0, 99.0, 0.0], [-99.0, 99.0, 0.0]];
    let floor = Triangles::new(corners, vec![[0, 1, 2], [0, 2, 3]]).unwrap();
    let mut spinning = Spinning::preset("vlp-16").unwrap();
    spinning.steps = 12;
    let pattern = spinning.rays("drive").unwrap();
    // A period of 55 microseconds: poses between which the sensor moves a millimetre each.
    let pose = |k: u32| TimedPose {
        time_s: 1e-4 * f64::from(k),
        pose: Pose::from_position(glam::DVec3::new(1e-3 * f64::from(k), 0.0, 1.2)),
    };
    let poses = TimedPoses::new((0..9).map(pose).collect(), "poses").unwrap();
    let pattern = Mounting::Moving(poses).place(pattern, "drive").unwrap();
    (floor, NamedRaySet::new("drive", pattern, Sides::Both).unwrap())
}

#[test]
fn scans_are_the_parts_of_their_set() {
    let (_, set) = drive();
    let ranges = scan_ranges(&set, 5).unwrap();
    assert_eq!(ranges, [0..5, 5..10, 10..12]);
    let scan = scan_of(&set, 5..10).unwrap();
    assert_eq!((scan.shape.as_slice(), scan.set.rays()), ([5, 16].as_slice(), &set.set.rays()[80..160]));
    let times = scan.times.as_ref().unwrap();
    assert_eq!(times, &set.times.as_ref().unwrap()[80..160]);
    // Its frame is that of its own first ray, and between its poses it moves as the whole does.
    let Mounting::Moving(poses) = &scan.mounting else { panic!("it moves") };
    assert_eq!(poses.span_s(), [times[0], times[79]]);
    for time in times {
        let [part, whole] = [&scan.mounting, &set.mounting].map(|of| of.at(*time).unwrap().position);
        assert!((part - whole).length() < 1e-15, "{part} {whole}");
    }
}

#[test]
fn only_a_head_has_scans() {
    let (_, mut set) = drive();
    assert!(scan_ranges(&set, 0).unwrap_err().to_string().contains("at least 1"));
    set.elevations_deg = None;
    assert!(scan_ranges(&set, 5).unwrap_err().to_string().contains("a spinning head"));
}

#[test]
fn each_scan_is_written_with_its_own_times() {
    let (floor, set) = drive();
    let folder = tempfile::tempdir().unwrap();
    let source = CastSource::default();
    let form = Some(BagForm { fields: crate::BagFields::Velodyne, is_dense: false });
    let written = write_scans(folder.path(), (&floor, &set, Sides::Both), 5, form, &source, &Silent).unwrap();
    // Eight of 16 channels look down, one of them by 1 degree: 1.2 m / sin 1 degree is 69 m, within the range of 100 m.
    assert_eq!((written.scans, written.rays, written.hits), (3, 192, 96));
    let rows = std::fs::read_to_string(folder.path().join("scans.csv")).unwrap();
    assert_eq!(rows.lines().count(), 4);
    assert!(rows.lines().nth(3).unwrap().starts_with("scans/000002.pcd,0.00055296,"), "{rows}");
    // The same as the whole, cast at once: the last point of the last scan.
    let scan = scan_of(&set, 10..12).unwrap();
    let exact = ExactCast::new(&floor);
    let answers: Answers = cast_with(&exact, scan.set.rays(), Sides::Both, Questions::default(), &Silent);
    let alone = folder.path().join("alone.pcd");
    write_pcd(&alone, &answers, (&scan, None), CloudFrame::Sensor, &CloudMap::default()).unwrap();
    let bytes = |path: &Path| std::fs::read(path).unwrap();
    assert_eq!(bytes(&alone), bytes(&folder.path().join("scans/000002.pcd")));
    assert!(answers.first.iter().any(|read| matches!(read, Reading::Miss)));
    // Three clouds in one bag.
    let metadata = std::fs::read_to_string(folder.path().join("rosbag/metadata.yaml")).unwrap();
    let points = metadata.split("name: /points").nth(1).unwrap();
    let count = points.lines().find(|line| line.trim_start().starts_with("message_count")).unwrap();
    assert_eq!(count.trim(), "message_count: 3");
}
