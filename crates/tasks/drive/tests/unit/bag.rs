//! The bag of a drive, read back by the container's own reader; `reference/rosbag/check.py` reads every message.

use std::collections::BTreeMap;

use raypencil_scanline::Scanline;
use raypencil_scene::Silent;

use crate::RecordContents;
use crate::common::{FLAT, job};
use crate::run::{DriveExtras, drive_with};

#[test]
fn every_frame_has_its_messages_at_its_time() {
    let route = "waypoints_m = [[0.6, 0]]\nframes_per_s = 3\nscan_steps = 6\nobstacles_every_frames = 3\n\
        exposure_interval_ms = 50\nscan_step_s = 0.25";
    let job = job(FLAT, route);
    let folder = tempfile::tempdir().unwrap();
    let contents = RecordContents { mcap: true, ..RecordContents::default() };
    let record = Some((folder.path().to_path_buf(), contents));
    let extras = DriveExtras { record, ..DriveExtras::default() };
    let run = drive_with(&job, &[&Scanline::default()], extras, &Silent).unwrap();

    let bytes = std::fs::read(folder.path().join("recording/rosbag/rosbag_0.mcap")).unwrap();
    let mut counts = BTreeMap::<String, usize>::new();
    let mut points = 0;
    let mut last = 0;
    let (mut seconds_of_images, mut of_scans, mut of_poses) = (Vec::new(), Vec::new(), Vec::new());
    for message in mcap::MessageStream::new(&bytes).unwrap().map(Result::unwrap) {
        // In the order of time.
        assert!(message.log_time >= last, "{}", message.log_time);
        last = message.log_time;
        let topic = message.channel.topic.clone();
        // Header: seconds and nanoseconds.
        let seconds = {
            let word = |at: usize| u32::from_le_bytes(message.data[at..at + 4].try_into().unwrap());
            f64::from(word(4)) + 1e-9 * f64::from(word(8))
        };
        match topic.as_str() {
            "/camera/beam1/image_raw" => seconds_of_images.push(seconds),
            "/camera/scan/beam0/image_raw" => of_scans.push(seconds),
            "/points" => of_poses.push(seconds),
            _ => {}
        }
        if topic == "/points" {
            // Header: time, then the text "base_link" with its length; then rows and columns.
            let columns = &message.data[4 + 8 + 4 + 12 + 4..][..4];
            points += u64::from(u32::from_le_bytes(columns.try_into().unwrap()));
        }
        *counts.entry(topic).or_default() += 1;
    }
    // Three frames a second, the first at 1 s; each scan before takes six quarters of a second. The second beam is lit 50 ms
    // after the frame, and the positions of a scan are a quarter of a second from each other.
    let (mut paused, mut expected_poses) = (0.0, Vec::new());
    let (mut expected_images, mut expected_scans) = (Vec::new(), Vec::new());
    for frame in &run.frames {
        let time = 1.0 + frame.index as f64 / 3.0 + paused;
        assert!((frame.time - (time - 1.0)).abs() < 1e-12);
        expected_poses.push(time);
        if frame.scan.is_some() {
            expected_scans.extend((0..6).map(|step| time + 0.25 * f64::from(step)));
            paused += 1.5;
        } else {
            expected_images.push(time + 0.05);
        }
    }
    let pairs =
        [(of_poses, expected_poses), (seconds_of_images, expected_images), (of_scans, expected_scans)];
    for (found, expected) in pairs {
        assert_eq!(found.len(), expected.len());
        assert!(found.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 2e-9), "{found:?} {expected:?}");
    }
    // Seven frames, some of which are scans of six positions; obstacle maps in frames 0, 3 and 6.
    let scans = run.frames.iter().filter(|frame| frame.scan.is_some()).count();
    assert!((1..7).contains(&scans), "{scans}");
    let (mounted, panned) = (7 - scans, 6 * scans);
    let expected = [
        ("/camera/beam0/camera_info", mounted),
        ("/camera/beam0/image_raw", mounted),
        ("/camera/beam1/camera_info", mounted),
        ("/camera/beam1/image_raw", mounted),
        ("/camera/scan/beam0/camera_info", panned),
        ("/camera/scan/beam0/image_raw", panned),
        ("/camera/scan/beam1/camera_info", panned),
        ("/camera/scan/beam1/image_raw", panned),
        ("/ground_truth/odometry", 7),
        ("/obstacle_map", 3),
        ("/odometry", 7),
        ("/points", 7),
        ("/tf", 7),
        ("/tf_static", 1),
    ];
    let expected: BTreeMap<String, usize> = expected.map(|(topic, count)| (topic.into(), count)).into();
    assert_eq!(counts, expected);
    assert!(points > 0);
    assert_eq!(points, run.edge_points);
    assert!(folder.path().join("recording/rosbag/metadata.yaml").is_file());
}
