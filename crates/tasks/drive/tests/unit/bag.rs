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
        exposure_interval_ms = 50";
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
    for message in mcap::MessageStream::new(&bytes).unwrap().map(Result::unwrap) {
        // Three frames a second, the first at 1 s; in the order of time.
        let frame = (message.log_time as f64 * 1e-9 - 1.0) * 3.0;
        assert!((frame - frame.round()).abs() < 1e-8 && message.log_time >= last, "{}", message.log_time);
        last = message.log_time;
        let topic = message.channel.topic.clone();
        if topic == "/camera/beam1/image_raw" {
            // Header: seconds and nanoseconds. The second beam is lit 50 ms after the frame.
            let word = |at: usize| u32::from_le_bytes(message.data[at..at + 4].try_into().unwrap());
            let seconds = f64::from(word(4)) + 1e-9 * f64::from(word(8));
            assert!((seconds - message.log_time as f64 * 1e-9 - 0.05).abs() < 1e-8, "{seconds}");
        }
        if topic == "/points" {
            // Header: time, then the text "base_link" with its length; then rows and columns.
            let columns = &message.data[4 + 8 + 4 + 12 + 4..][..4];
            points += u64::from(u32::from_le_bytes(columns.try_into().unwrap()));
        }
        *counts.entry(topic).or_default() += 1;
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
