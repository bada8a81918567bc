use raypencil_scene::pattern::{
    Cone, EchoLight, Keep, PatternRays, Returns, Spinning, TimedPose, TimedPoses,
};
use raypencil_scene::{Pose, Reading, Silent};

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
    let ranges = scan_ranges(SetOfScans::Made(&set), 5).unwrap();
    assert_eq!(ranges, [0..5, 5..10, 10..12]);
    let scan = scan_of(&set, 5..10).unwrap();
    assert_eq!((scan.shape.as_slice(), scan.set.rays()), ([5, 16].as_slice(), &set.set.rays()[80..160]));
    let times = scan.times.as_ref().unwrap();
    assert_eq!(times, &set.times.as_ref().unwrap()[80..160]);
    // Its frame is that of its own first ray, wherever the drive begins, and it ends where its own last ray is fired.
    assert_eq!(
        scan.mounting.ends(Some(times)).map(Some),
        [times[0], times[79]].map(|time| set.mounting.at(time))
    );
}

#[test]
fn scans_whose_rays_are_made_in_their_turn_have_the_bytes_of_those_that_are_parts() {
    let (floor, of_head) = drive();
    let Mounting::Moving(poses) = &of_head.mounting else { panic!("it moves") };
    let mut head = Spinning::preset("vlp-16").unwrap();
    head.steps = 12;
    let cone = Cone { divergence_rad: 3e-3, rings: 1 };
    let returns = Returns { keep: Keep::UpTo(2), separation_m: 0.5 };
    let echo = EchoLight { reflectivity: 0.5, extinction_per_m: 0.01 };
    for cone in [None, Some((cone, Some(returns)))] {
        let mut pattern = head.rays("drive").unwrap();
        if let Some((cone, returns)) = cone {
            pattern = PatternRays { returns, ..cone.spread(&pattern, "cone").unwrap() };
        }
        let pattern = of_head.mounting.place(pattern.starting_at(1e-5), "drive").unwrap();
        let set = NamedRaySet { echo, ..NamedRaySet::new("drive", pattern, Sides::Both).unwrap() };
        let sweep = HeadSweep {
            name: "drive".into(),
            head: head.clone(),
            cone,
            mounting: of_head.mounting.clone(),
            start_s: Some(1e-5),
            sides: Sides::Both,
            echo,
        };
        sweep.check("rays").unwrap();
        assert_eq!((SetOfScans::Sweep(&sweep).rays(), sweep.head.steps), (set.set.rays().len(), 12));
        let folder = tempfile::tempdir().unwrap();
        let form = Some(BagForm { fields: crate::BagFields::Velodyne, is_dense: false });
        for (of_set, name) in [(SetOfScans::Made(&set), "made"), (SetOfScans::Sweep(&sweep), "sweep")] {
            let of_mesh = (&floor, of_set, Sides::Both);
            let forms = (form, PcdData::BinaryCompressed);
            write_scans(&folder.path().join(name), of_mesh, 5, forms, &CastSource::default(), &Silent)
                .unwrap();
        }
        for file in
            ["scans/000000.pcd", "scans/000002.pcd", "scans.csv", "rosbag/rosbag_0.mcap", "summary.json"]
        {
            let [made, swept] =
                ["made", "sweep"].map(|name| std::fs::read(folder.path().join(name).join(file)).unwrap());
            assert_eq!(made, swept, "{file}");
        }
        // Only the rays of a scan are there at a time.
        let at_a_time = [SetOfScans::Made(&set), SetOfScans::Sweep(&sweep)].map(|of| of.rays_at_a_time(5));
        assert_eq!(at_a_time, [set.set.rays().len(), set.set.rays().len() / 12 * 5]);
    }
    // A drive that ends before its last ray is refused before the first scan is made, in the words of the whole.
    let short = poses.poses()[..5].to_vec();
    let mounting = Mounting::Moving(TimedPoses::new(short, "poses").unwrap());
    let whole = mounting.place(head.rays("rays").unwrap(), "rays").unwrap_err();
    let sweep = HeadSweep {
        name: "drive".into(),
        head,
        cone: None,
        mounting,
        start_s: None,
        sides: Sides::Both,
        echo,
    };
    assert_eq!(sweep.check("rays").unwrap_err().to_string(), whole.to_string());
}

#[test]
fn only_a_head_has_scans() {
    let (_, mut set) = drive();
    assert!(scan_ranges(SetOfScans::Made(&set), 0).unwrap_err().to_string().contains("at least 1"));
    set.elevations_deg = None;
    assert!(scan_ranges(SetOfScans::Made(&set), 5).unwrap_err().to_string().contains("a spinning head"));
}

#[test]
fn each_scan_is_written_with_its_own_times() {
    let (floor, set) = drive();
    let folder = tempfile::tempdir().unwrap();
    let source = CastSource::default();
    let form = Some(BagForm { fields: crate::BagFields::Velodyne, is_dense: false });
    let written = write_scans(
        folder.path(),
        (&floor, SetOfScans::Made(&set), Sides::Both),
        5,
        (form, PcdData::Binary),
        &source,
        &Silent,
    )
    .unwrap();
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
    write_pcd(&alone, &answers, (&scan, None), (CloudFrame::Sensor, PcdData::Binary), &CloudMap::default())
        .unwrap();
    let bytes = |path: &Path| std::fs::read(path).unwrap();
    assert_eq!(bytes(&alone), bytes(&folder.path().join("scans/000002.pcd")));
    assert!(answers.first.iter().any(|read| matches!(read, Reading::Miss)));
    // Three clouds in one bag.
    let metadata = std::fs::read_to_string(folder.path().join("rosbag/metadata.yaml")).unwrap();
    let points = metadata.split("name: /points").nth(1).unwrap();
    let count = points.lines().find(|line| line.trim_start().starts_with("message_count")).unwrap();
    assert_eq!(count.trim(), "message_count: 3");
}
