use std::sync::Arc;

use raypencil_files::OutputFolder;
use raypencil_mesh_io::read_dem;
use raypencil_rover::{CameraImage, Exposure, StripeExtractor, Stripes};
use raypencil_scanline::Scanline;
use raypencil_scene::{SceneError, Silent};
use raypencil_tests::schema::{assert_keys_are_closed, schema_faults};

use super::*;
use crate::common::{FLAT, LOW_SUN, SHORT, driven, filtered, job};
use crate::document::drive_document;
use crate::run::{DriveExtras, drive_with};

/// Times vary from run to run; versions and pictures have their own tests.
const FILTERS: [(&str, &str); 5] = [
    (r"(?s)<style>.*?</style>", "[style]"),
    (r"(?s)<svg.*?</svg>", "[figure]"),
    (r"data:image/png;base64,[^\x22]*", "[animation]"),
    (r" *\b\d+(\.\d+)? (µs|ms|s)\b", " [time]"),
    (r"raypencil \d+\.\d+\.\d+", "raypencil [version]"),
];

#[test]
fn screens_and_pages_tell_facts_warnings_times_and_differences() {
    // With two renderers, and with one under a sun that the default threshold does not take into account.
    let sunny = format!("{SHORT}\n{LOW_SUN}");
    let cases = [
        ("two_renderers", job(FLAT, SHORT), &["scanline", "tracer"][..]),
        ("one_renderer", filtered(&sunny), &["tracer"]),
    ];
    for (name, job, renderers) in cases {
        let run = driven(&job, renderers);
        let page = drive_document_with_pictures(&job, &run, &figures(&job, &run), b"").page().unwrap();
        insta::with_settings!({ filters => FILTERS }, {
            insta::assert_snapshot!(format!("screen_{name}"), drive_document(&job, &run).screen());
            insta::assert_snapshot!(format!("page_{name}"), raypencil_explorer::without_explorer(&page));
        });
    }
}

#[test]
fn the_folder_holds_everything_and_the_summary_comes_last() {
    let job = job(FLAT, SHORT);
    let run = driven(&job, &["scanline", "tracer"]);
    let folder = tempfile::tempdir().unwrap();
    let written = write_drive(&job, &run, folder.path(), &Silent).unwrap();
    let names: Vec<_> =
        written.files.iter().map(|file| file.file_name().unwrap().to_string_lossy().into_owned()).collect();
    assert_eq!(names.last().map(String::as_str), Some("summary.json"));
    for file in &written.files {
        assert!(file.is_file(), "{}", file.display());
    }
    // There are no other files, such as partly written ones.
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), names.len());
    let page = std::fs::read_to_string(&written.report).unwrap();
    // Four figures, and the plan of the start.
    assert_eq!(page.matches("<svg").count(), 5);
    assert!(!page.contains("src=\"http") && !page.contains("href=\"http"));
    // The map can be read as an elevation model with the same posts.
    let dem = read_dem(folder.path().join("local-map.tif"), None).unwrap();
    let posts = height_grid(&run.map);
    assert_eq!((dem.posts.columns, dem.posts.rows), (201, 201));
    assert!(dem.posts.heights.iter().zip(&posts.heights).all(|(a, b)| a.to_bits() == b.to_bits()));
    assert!((dem.posts.corner - posts.corner).length() < 1e-9);
    // The animation has one picture per frame.
    let bytes = std::fs::read(folder.path().join("drive.png")).unwrap();
    let reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
    assert_eq!(reader.info().animation_control().map(|control| control.num_frames), Some(7));
}

#[test]
fn the_summary_keeps_to_its_schema() {
    let schema: serde_json::Value =
        serde_json::from_str(include_str!("../../../../../docs/formats/drive.schema.json")).unwrap();
    assert_keys_are_closed(&schema);
    let sunny = format!("{SHORT}\n{LOW_SUN}\nsubtract_unlit = true");
    for (drive, names) in [(SHORT, &["tracer"][..]), (sunny.as_str(), &["scanline", "tracer"])] {
        let job = job(FLAT, drive);
        let summary = serde_json::from_str(&drive_document(&job, &driven(&job, names)).json()).unwrap();
        assert_eq!(schema_faults(&schema, &summary), Vec::<String>::new());
    }
}

/// An extraction that fails in the fourth frame.
#[derive(Debug)]
struct Stopped;

impl StripeExtractor for Stopped {
    fn stripes(&self, exposure: Exposure, _: &CameraImage) -> Result<Stripes, SceneError> {
        match exposure.frame {
            3 => Err(SceneError::new("stripes", "none", "some")),
            _ => Ok(Stripes::default()),
        }
    }
}

#[test]
fn a_drive_that_is_stopped_leaves_nothing_of_an_earlier_one_beside_it() {
    let folder = tempfile::tempdir().unwrap();
    let driven =
        |job: &DriveJob, extractor: Option<Arc<dyn StripeExtractor>>| -> Result<(), crate::DriveError> {
            let output = Arc::new(OutputFolder::begin(folder.path())?);
            let record = Some((folder.path().to_path_buf(), Default::default()));
            let extras = DriveExtras { extractor, record, output: Some(Arc::clone(&output)) };
            let run = drive_with(job, &[&Scanline::default()], extras, &Silent)?;
            write_drive(job, &run, folder.path(), &Silent)?;
            Ok(Arc::into_inner(output).expect("let go of").finish()?)
        };
    let names = |within: &str| -> Vec<String> {
        let entries = std::fs::read_dir(folder.path().join(within)).unwrap();
        let names = entries.map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned());
        let mut names: Vec<String> = names.filter(|name| !name.starts_with(".raypencil-")).collect();
        names.sort();
        names
    };
    let long = job(FLAT, SHORT);
    driven(&long, None).unwrap();
    std::fs::write(folder.path().join("notes.txt"), "mine").unwrap();
    let whole = [names(""), names("recording")];
    assert!(whole[0].len() > 20 && whole[1].len() > 4, "{whole:?}");

    // One that is refused changes nothing.
    let off = job(FLAT, "waypoints_m = [[99, 0]]\nscans = false");
    assert!(
        driven(&off, None).unwrap_err().to_string().starts_with("the route (drive.waypoints_m, --to) is off")
    );
    assert_eq!([names(""), names("recording")], whole);

    // One that is stopped on its way leaves neither maps nor poses of the drive before.
    let error = driven(&long, Some(Arc::new(Stopped))).unwrap_err().to_string();
    assert!(error.starts_with("stripes is none"), "{error}");
    assert_eq!(names(""), ["notes.txt", "recording"]);
    let left = names("recording");
    assert!(
        !left.contains(&"sectors.csv".to_string()) && !left.contains(&"setup.json".to_string()),
        "{left:?}"
    );
    driven(&long, None).unwrap();
    assert_eq!([names(""), names("recording")], whole);
}
