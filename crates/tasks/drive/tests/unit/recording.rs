use std::sync::Arc;

use raypencil_files::{Limits, read_npy, read_npy_numbers};
use raypencil_rover::StripeExtractor;
use raypencil_scanline::Scanline;
use raypencil_scene::Silent;

use super::*;
use crate::common::{FLAT, SHORT, job};
use crate::run::{DriveExtras, DriveRun, drive_with};
use crate::stripe_file::StripeFile;

/// Rocks: edges, gaps, obstacles.
const ROCKS: &str = "[terrain]\ngenerate = { preset = \"pathfinder\", seed = 5, extent_m = 24 }";

/// Route with a coarse scan in the first frame.
const WITH_SCAN: &str =
    "waypoints_m = [[0.6, 0]]\nframes_per_s = 3\nscan_steps = 6\nobstacles_every_frames = 3";

fn recorded(
    job: &DriveJob,
    folder: &Path,
    contents: RecordContents,
    extractor: Option<Arc<dyn StripeExtractor>>,
) -> DriveRun {
    let record = Some((folder.to_path_buf(), contents));
    drive_with(job, &[&Scanline::default()], DriveExtras { extractor, record, output: None }, &Silent)
        .unwrap()
}

fn all() -> RecordContents {
    RecordContents { png: true, npy: true, points: true, maps: true, mcap: true }
}

/// Lines of a table without its first.
fn lines(path: PathBuf) -> Vec<String> {
    std::fs::read_to_string(path).unwrap().lines().skip(1).map(String::from).collect()
}

#[test]
fn recorded_stripes_drive_the_same_drive_again() {
    let job = job(ROCKS, WITH_SCAN);
    let (first, second) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let contents = RecordContents { points: true, maps: true, ..RecordContents::default() };
    let run = recorded(&job, first.path(), contents, None);
    assert!(run.edge_points > 1000, "{}", run.edge_points);
    let stripes = Arc::new(StripeFile::read(&first.path().join("recording"), 2).unwrap());
    let again = recorded(&job, second.path(), contents, Some(Arc::clone(&stripes) as _));
    assert_eq!(stripes.left_over(), None);
    assert_eq!(run.map, again.map);
    assert_eq!(run.frames, again.frames);
    // Every file of the recording is the same, byte for byte.
    let names =
        ["poses.csv", "points.csv", "stripes.npy", "points.npy", "sectors.csv", "vectors.csv", "maps.csv"];
    for name in names.map(|name| Path::new("recording").join(name)) {
        let [a, b] = [&first, &second].map(|folder| std::fs::read(folder.path().join(&name)).unwrap());
        assert!(a == b, "{}", name.display());
    }
    // Without one edge it is another drive: the stripes are what it is made of.
    let path = first.path().join("recording/stripes.npy");
    let numbers = read_npy_numbers(&path, &Limits::default()).unwrap();
    let values = &numbers.values[..numbers.values.len() / 2 / 5 * 5];
    raypencil_files::write_npy_numbers(&path, &[values.len() as u64 / 5, 5], values).unwrap();
    let half = StripeFile::read(&first.path().join("recording"), 2).unwrap();
    assert_ne!(recorded(&job, second.path(), contents, Some(Arc::new(half))).map, run.map);
    // Frames counted otherwise are those of no image.
    let late: Vec<f64> =
        values.chunks_exact(5).flat_map(|row| [row[0] + 1000.0, row[1], row[2], row[3], row[4]]).collect();
    raypencil_files::write_npy_numbers(&path, &[late.len() as u64 / 5, 5], &late).unwrap();
    let late = StripeFile::read(&first.path().join("recording"), 2).unwrap();
    let warnings = recorded(&job, second.path(), contents, Some(Arc::new(late))).warnings;
    let said: Vec<&str> = warnings.iter().map(|warning| warning.code.word()).collect();
    assert!(said.contains(&"stripes_left_over") && said.contains(&"nothing_measured"), "{said:?}");
}

#[test]
fn every_file_has_what_the_frames_had() {
    let job = job(ROCKS, WITH_SCAN);
    let folder = tempfile::tempdir().unwrap();
    let run = recorded(&job, folder.path(), all(), None);
    let recording = folder.path().join("recording");
    let named = |name: &str| recording.join(name);

    // 6 stripes of two beams in the scan of frame 0, then two images a frame; each as PNG and as NPY.
    let images = std::fs::read_dir(named("images")).unwrap().count();
    assert_eq!((run.frames.len(), images), (7, 2 * (6 * 2 + 6 * 2)));
    let array = read_npy(named("images/000004-beam1.npy"), &Limits::default()).unwrap();
    let file = std::fs::File::open(named("images/000004-beam1.png")).unwrap();
    let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut bytes).unwrap();
    let grey: Vec<u16> = bytes.chunks_exact(2).map(|pair| u16::from_be_bytes([pair[0], pair[1]])).collect();
    let exact: Vec<u16> = (0..grey.len()).map(|index| array.planes[0].real(index) as u16).collect();
    assert!(
        grey == exact && grey.iter().any(|&number| number > 400),
        "the brightest: {:?}",
        grey.iter().max()
    );

    // Tables: a line for each frame, edge, point, sector and map.
    assert_eq!(lines(named("poses.csv")).len(), 7);
    assert_eq!(lines(named("points.csv")).len() as u64, run.edge_points);
    let points = read_npy_numbers(named("points.npy"), &Limits::default()).unwrap();
    assert_eq!(points.shape, [run.edge_points, 11]);
    let edges = read_npy_numbers(named("stripes.npy"), &Limits::default()).unwrap();
    assert!(edges.shape[0] >= run.edge_points);
    // The first point by its own two files.
    let first: Vec<f64> =
        lines(named("points.csv"))[0].split(',').map(|field| field.parse().unwrap()).collect();
    assert_eq!(first[..11], points.values[..11]);
    // The last global point is the last one that the run kept.
    let last = &points.values[points.values.len() - 3..];
    assert_eq!(last, run.points.last().unwrap().point.to_array());
    // Obstacle maps of frames 0, 3 and 6, of 31 sectors each; every unknown sector has its reason.
    let sectors = lines(named("sectors.csv"));
    assert_eq!((sectors.len(), lines(named("vectors.csv")).len()), (3 * 31, 3 * 30));
    let fields = |line: &String| line.split(',').map(String::from).collect::<Vec<_>>();
    for line in &sectors {
        let fields = fields(line);
        let has_reason = !fields[7].is_empty();
        assert_eq!((fields.len(), has_reason), (14, fields[6] != "visibility"), "{line}");
        // The truth: a radius of the grid, or none. No sector passes one here.
        let radius = (!fields[11].is_empty()).then(|| fields[11].parse::<f64>().unwrap());
        assert!(radius.is_none_or(|radius| (0.69..4.81).contains(&radius)), "{line}");
        assert!(["unknown", "clear", "off_ground"].contains(&&fields[12][..]), "{line}");
        assert_eq!(fields[9].is_empty(), fields[6] != "unknown", "{line}");
        // The rule that stops the vehicle stands beside its radius; other rules than these are off by default.
        let rules = ["front_slope", "rear_slope", "length_slope", "belly"];
        assert_eq!(rules.contains(&&fields[13][..]), radius.is_some(), "{line}");
    }
    assert!(sectors.iter().any(|line| fields(line)[6] == "unknown"));
    // The snapshot of the last frame is the map at the end.
    let map = read_npy_numbers(named("maps/000006-elevation.npy"), &Limits::default()).unwrap();
    let expected = crate::maps::elevations::elevation_image(&run.map);
    assert!(map.values.iter().zip(expected.cells()).all(|(a, b)| a.to_bits() == b.to_bits()));
    assert_eq!(lines(named("maps.csv")).len(), 3);

    let setup: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(named("setup.json")).unwrap()).unwrap();
    assert_eq!(setup["format_version"], 1);
    assert_eq!(setup["beams"].as_array().unwrap().len(), 2);
    assert_eq!(setup["scan"]["steps"], 6);
    assert_eq!(setup["start_elevation"].as_f64(), Some(run.frames[0].stance.position.z));
}

#[test]
fn a_new_recording_removes_what_the_last_one_left_and_nothing_else() {
    let job = job(FLAT, SHORT);
    let folder = tempfile::tempdir().unwrap();
    recorded(&job, folder.path(), all(), None);
    let recording = folder.path().join("recording");
    assert!(recording.join("setup.json").is_file() && recording.join("stripes.npy").is_file());
    let foreign = recording.join("images/notes.txt");
    std::fs::write(&foreign, "mine").unwrap();
    // Its name is one that a recording could give, and it is none of a recording's.
    let like_ours = recording.join("images/000007-notes.png");
    std::fs::write(&like_ours, "mine").unwrap();
    // Begun and given up: no file says that it is complete.
    drop(Recording::begin(folder.path(), &job, RecordContents::default(), None).unwrap());
    assert!(!recording.join("setup.json").exists() && !recording.join("stripes.npy").exists());
    recorded(&job, folder.path(), RecordContents::default(), None);
    assert!(recording.join("setup.json").exists() && !recording.join("points.npy").exists());
    let mut left: Vec<_> =
        std::fs::read_dir(recording.join("images")).unwrap().map(|e| e.unwrap().path()).collect();
    left.sort();
    assert_eq!(left, [like_ours, foreign]);
}
