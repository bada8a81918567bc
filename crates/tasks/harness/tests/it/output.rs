//! The folder of a validation, and every kind of report in it.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::time::Duration;

use raypencil_explorer::without_explorer;
use raypencil_files::FolderError;
use raypencil_harness::{Candidate, HarnessError, Validation, one_screen, write_validation};
use raypencil_judge::{ApproximationTallies, COMPARE_CLASSES, Class, Recorded};
use raypencil_referee::{Displacement, Referee};
use raypencil_scene::{Image, Place, Precision, Quantities, SensorId, SensorMap, Silent};
use raypencil_scene_io::probe_command;
use raypencil_tests::fixtures;
use serde_json::Value;

use crate::reports::{junit_xml, report_html, summary_json, summary_markdown};

/// Relative paths of all files below a folder.
fn files(folder: &Path) -> Vec<String> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap().to_string();
        if path.is_dir() {
            found.extend(files(&path).into_iter().map(|file| format!("{name}/{file}")));
        } else {
            found.push(name);
        }
    }
    found.sort();
    found
}

/// A validation with fixed times, so that two runs give the same bytes.
fn timeless(mut validation: Validation) -> Validation {
    for stage in &mut validation.stages {
        stage.time = Duration::from_millis(5);
    }
    for rendered in &mut validation.rendered {
        rendered.time = Duration::from_millis(9);
        for stage in &mut rendered.output.stages {
            stage.time = Duration::from_millis(3);
        }
    }
    validation
}

#[test]
fn a_folder_has_every_file_and_the_same_bytes_each_time() {
    let (first, second) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    // A folder below one that does not exist yet.
    let (first, second) = (first.path().join("out/a"), second.path().to_path_buf());
    let written = write_validation(&timeless(fixtures::agreeing()), &first, &Silent).unwrap();
    write_validation(&timeless(fixtures::agreeing()), &second, &Silent).unwrap();
    let expected = [
        "junit.xml",
        "report.html",
        "scanline/beam-0.exr",
        "scanline/camera.exr",
        "summary.json",
        "summary.md",
        "tracer/beam-0.exr",
        "tracer/camera.exr",
    ];
    assert_eq!(files(&first), expected);
    for file in expected {
        assert_eq!(fs::read(first.join(file)).unwrap(), fs::read(second.join(file)).unwrap(), "{file}");
    }
    assert_eq!(written.maps.len(), 4);
    let summary: Value = serde_json::from_slice(&fs::read(written.summary).unwrap()).unwrap();
    for renderer in summary["renderers"].as_array().unwrap() {
        for sensor in renderer["sensors"].as_array().unwrap() {
            assert!(first.join(sensor["file"].as_str().unwrap()).exists());
        }
    }
}

#[test]
fn an_error_in_the_middle_leaves_no_summary() {
    let folder = tempfile::tempdir().unwrap();
    let summary = folder.path().join("summary.json");
    write_validation(&fixtures::agreeing(), folder.path(), &Silent).unwrap();
    assert!(summary.exists());
    // A non-empty folder is in the place of the report.
    let report = folder.path().join("report.html");
    fs::remove_file(&report).unwrap();
    fs::create_dir_all(report.join("occupied")).unwrap();
    let error = write_validation(&fixtures::agreeing(), folder.path(), &Silent).unwrap_err();
    assert!(error.to_string().contains("report.html: cannot write: "), "{error}");
    assert!(!summary.exists());
}

#[test]
fn a_folder_that_cannot_be_created_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "not a folder").unwrap();
    let error = write_validation(&fixtures::agreeing(), &file.join("out"), &Silent).unwrap_err();
    assert!(matches!(error, HarnessError::Folder(FolderError::Create { .. })));
    let message = error.to_string();
    assert!(message.contains("file/out: cannot create the folder: "), "{message}");
}

#[test]
fn a_summary_that_cannot_be_removed_is_named() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("summary.json")).unwrap();
    let error = write_validation(&fixtures::agreeing(), folder.path(), &Silent).unwrap_err();
    assert!(matches!(error, HarnessError::Folder(FolderError::RemoveEarlier { .. })));
    // Nothing was written beside it.
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn renderers_need_folders_of_their_own() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["", ".", "..", "../up", "a/b", "a/", "/tmp", "scanline"] {
        let mut validation = fixtures::agreeing();
        validation.rendered[1].name = name.into();
        let error = write_validation(&validation, folder.path(), &Silent).unwrap_err();
        assert!(matches!(error, HarnessError::Name { .. }), "{name}: {error}");
    }
    assert!(files(folder.path()).is_empty());
}

#[test]
fn the_summary_adds_up() {
    for (validation, defects) in [(fixtures::agreeing(), 0), (fixtures::defective(), 2)] {
        let summary: Value = serde_json::from_str(&summary_json(&validation)).unwrap();
        let classes = ["agree", "tie", "rounding", "undecided", "defects"];
        let of = |value: &Value, key: &str| value[key].as_u64().unwrap();
        let sum = |value: &Value| classes.iter().map(|class| of(value, class)).sum::<u64>();
        // The camera's 48 x 40 pixels and the beam's 64 x 4 pencils.
        assert_eq!(of(&summary, "compared"), 48 * 40 + 64 * 4);
        assert_eq!(sum(&summary), of(&summary, "compared"));
        assert_eq!(of(&summary, "defects"), defects);
        let sensors = summary["pairs"][0]["sensors"].as_array().unwrap();
        for sensor in sensors {
            assert_eq!(sum(sensor), of(sensor, "compared"));
            let hit = &sensor["quantities"][0];
            let judged: u64 = ["agree", "tie", "defects"].iter().map(|class| of(hit, class)).sum();
            assert_eq!(judged + of(hit, "not_compared"), of(sensor, "compared"));
        }
        for class in ["compared"].iter().chain(&classes) {
            assert_eq!(sensors.iter().map(|sensor| of(sensor, class)).sum::<u64>(), of(&summary, class));
        }
    }
}

#[test]
fn numbers_that_are_not_finite_are_null_and_keep_their_place() {
    let summary: Value = serde_json::from_str(&summary_json(&fixtures::defective())).unwrap();
    let range = &summary["pairs"][0]["sensors"][1]["quantities"][2];
    for worst in ["worst_error", "worst_ratio"] {
        assert_eq!(range[worst]["value"], Value::Null);
        assert_eq!(range[worst]["probe"], "raypencil probe pyramids --fan 60 --beam 0 --pencil 9,2");
    }
}

#[test]
fn every_ray_has_its_command() {
    let subject = fixtures::subject();
    let pixel = Place { sensor: SensorId::Camera, i: 4, j: 5 };
    assert_eq!(probe_command(&subject, pixel), "raypencil probe pyramids --fan 60 --pixel 4,5");
    let pencil = "raypencil probe pyramids --fan 60 --beam 0 --pencil 7,1";
    assert_eq!(probe_command(&subject, fixtures::DEFECTS[0]), pencil);
}

/// Asserts a snapshot in `snapshots/`. The version, the style, pictures and curves are placeholders.
macro_rules! assert_report {
    ($name:expr, $text:expr) => {
        insta::with_settings!({
            filters => vec![
                (r"raypencil \d+\.\d+\.\d+", "raypencil [version]"),
                (r"(?s)<style>.*?</style>", "<style>[style]</style>"),
                (r#"src="data:[^"]*""#, r#"src="[picture]""#),
                (r#"points="[^"]*""#, r#"points="[curve]""#),
            ],
            omit_expression => true,
        }, { insta::assert_snapshot!($name, $text) })
    };
}

/// Every kind of validation, with a name for its snapshots.
fn every_validation() -> [(&'static str, Validation); 5] {
    [
        ("agreeing", fixtures::agreeing()),
        ("defective", fixtures::defective()),
        ("approximate", fixtures::approximate()),
        ("lonely", fixtures::lonely()),
        ("with_candidate", fixtures::with_candidate()),
    ]
    .map(|(name, validation)| (name, timeless(validation)))
}

#[test]
fn screens() {
    for (name, validation) in every_validation() {
        let folder = Path::new("out/pyramids");
        assert_report!(format!("screen_{name}"), one_screen(&validation, Some(folder)));
    }
}

#[test]
fn markdown() {
    for (name, validation) in every_validation() {
        assert_report!(format!("markdown_{name}"), summary_markdown(&validation));
    }
}

#[test]
fn junit() {
    for (name, validation) in every_validation() {
        let text = junit_xml(&validation);
        assert_well_formed(&text);
        // The cases of an agreeing validation pass alike: the others are enough.
        if ["defective", "lonely"].contains(&name) {
            assert_report!(format!("junit_{name}"), text);
        }
    }
}

#[test]
fn pages() {
    for (name, validation) in every_validation() {
        let page = static_page(&validation);
        // The section in which each differs from the others; the whole page once.
        let (start, end) = match name {
            "defective" => ("<!DOCTYPE", "</html>"),
            "approximate" => ("<h2>The paper&#39;s approximations</h2>", "<div class=\"static-maps\">"),
            "with_candidate" => ("<h2>Candidates</h2>", "<div class=\"static-maps\">"),
            _ => ("<header", "</header>"),
        };
        let section = page.split_once(start).expect("the section").1.split_once(end).expect("its end").0;
        assert_report!(format!("page_{name}"), section);
    }
}

#[test]
fn junit_has_a_case_per_quantity_and_fails_on_defects() {
    let agreeing = junit_xml(&fixtures::agreeing());
    // One suite of two sensors: seven quantities each, a pixel's flux, and six quantities of a pencil's return.
    assert_eq!(agreeing.matches("<testcase ").count(), 21);
    assert!(agreeing.contains("tests=\"21\" skipped=\"0\" failures=\"0\" errors=\"0\""), "{agreeing}");
    let defective = junit_xml(&fixtures::defective());
    assert_eq!(defective.matches("<failure ").count(), 2);
}

#[test]
fn nothing_compared_is_no_pass_anywhere() {
    let validation = fixtures::lonely();
    assert!(junit_xml(&validation).contains("<failure message=\"Nothing was compared\""));
    assert!(summary_json(&validation).contains("\"verdict\": \"nothing_compared\""));
    for text in [one_screen(&validation, None), summary_markdown(&validation), static_page(&validation)] {
        assert!(text.contains("Nothing was compared"), "{text}");
        assert!(!text.contains("All "), "{text}");
    }
}

#[test]
fn the_page_is_self_contained_and_escapes_what_it_quotes() {
    let html = static_page(&fixtures::defective());
    assert!(html.contains("&#60;no&#62; &#38;") && !html.contains("<no>"));
    for outside in ["http:", "https:", "<script", "<link", "@import", "url("] {
        assert!(!html.contains(outside), "{outside}");
    }
    // A range map of each renderer and a difference, of two sensors; an image of each renderer's light, and a chart.
    assert_eq!(html.matches("src=\"data:image/png;base64,").count(), 8);
    assert_eq!(html.matches("src=").count(), 8);
    assert_eq!(html.matches("<polyline ").count(), 2);
    assert!(!html.contains("NaN%") && !html.contains("inf%"));
    // The whole page may load nothing but what it holds.
    let whole = report_html(&fixtures::defective());
    assert!(whole.contains("content=\"default-src 'none';") && whole.contains("id=\"page-model\""));
    let with_candidate = static_page(&fixtures::with_candidate());
    assert!(with_candidate.contains("Odd &#60;renderer&#62; 1") && !with_candidate.contains("<renderer>"));
}

#[test]
fn every_row_of_a_markdown_table_has_as_many_cells_as_its_head() {
    for (name, validation) in every_validation() {
        let text = summary_markdown(&validation);
        for table in text.split("\n\n").filter(|block| block.starts_with('|')) {
            let cells: Vec<usize> = table.lines().map(|line| line.matches('|').count()).collect();
            assert!(cells.len() > 2 || name == "lonely", "{table}");
            assert!(cells.iter().all(|&count| count == cells[0]), "{table}");
        }
    }
}

#[test]
fn one_screen_is_one_screen() {
    let mut crowded = fixtures::defective();
    // As many defects, stages and counts as there can be.
    let first = crowded.pairs[0].sensors[1].defects[0].clone();
    crowded.pairs[0].sensors[1].defects = vec![first; 100];
    for sensor in &mut crowded.pairs[0].sensors {
        for tally in sensor.items.values_mut() {
            tally.by_class = [67_108_864, 1_000_000, 55_555, 0, 0, 99_999];
        }
    }
    let stage = crowded.stages[0].clone();
    crowded.stages.extend(vec![stage; 60]);
    for validation in [fixtures::agreeing(), fixtures::defective(), fixtures::lonely(), crowded] {
        let text = one_screen(&validation, Some(Path::new("out/pyramids")));
        assert!(text.lines().count() <= 40, "{text}");
        for line in text.lines() {
            assert!(line.chars().count() <= 80, "{line}");
        }
        assert!(text.contains("out/pyramids/report.html\n"), "{text}");
        assert!(text.ends_with('\n') && !text.contains("\n\n\n"));
    }
    // Without a folder nothing was written, and no file is named.
    assert!(!one_screen(&fixtures::agreeing(), None).contains("report.html"));
}

/// Asserts that tags open and close in pairs and that text has no stray markup: enough for XML by `quick-junit`.
fn assert_well_formed(xml: &str) {
    let mut open = Vec::new();
    let mut rest = xml.strip_prefix("<?xml version=\"1.0\" encoding=\"UTF-8\"?>").expect("a declaration");
    while let Some((text, after)) = rest.split_once('<') {
        assert!(!text.contains('>') || !text.contains("]]>"), "{text}");
        let (tag, after) = after.split_once('>').expect("a tag that ends");
        assert_eq!(tag.matches('"').count() % 2, 0, "{tag}");
        if let Some(name) = tag.strip_prefix('/') {
            assert_eq!(open.pop(), Some(name), "{xml}");
        } else if !tag.ends_with('/') {
            open.push(tag.split_whitespace().next().unwrap());
        }
        rest = after;
    }
    assert!(open.is_empty() && rest.trim().is_empty());
}

#[test]
fn every_ray_that_differs_is_kept_with_its_class_and_its_cause() {
    let validation = fixtures::approximate();
    let sensors = &validation.pairs[0].sensors;
    let mut by_causes: ApproximationTallies = BTreeMap::new();
    for sensor in sensors {
        for class in COMPARE_CLASSES.into_iter().filter(|class| *class != Class::Agree) {
            let kept = sensor.differing.iter().filter(|ray| ray.class == class).count() as u64;
            assert_eq!(kept, sensor.of(class), "{} {class:?}", sensor.sensor);
        }
        assert!(sensor.differing.is_sorted_by_key(|ray| (ray.j, ray.i)), "in reading order");
        for ray in &sensor.differing {
            by_causes.entry(ray.causes).or_default().rays += 1;
        }
    }
    let expected = validation.approximations();
    assert!(expected.len() > 1 && expected.values().map(|tally| tally.rays).sum::<u64>() > 10);
    for (causes, tally) in &expected {
        assert_eq!(by_causes[causes].rays, tally.rays, "{causes}");
    }
    assert_eq!(by_causes.len(), expected.len());
}

/// The page as people see it without JavaScript.
fn static_page(validation: &Validation) -> String {
    without_explorer(&report_html(validation))
}

/// Every report of a validation that people or CI read, by name.
fn every_report(validation: &Validation) -> [(&'static str, String); 4] {
    [
        ("screen", one_screen(validation, None)),
        ("page", static_page(validation)),
        ("markdown", summary_markdown(validation)),
        ("junit", junit_xml(validation)),
    ]
}

/// [`fixtures::agreeing`] with a candidate that gives nothing but the camera's ranges, all of them 1 m too long.
fn with_wrong_ranges() -> Validation {
    let mut validation = fixtures::agreeing();
    let scene = &validation.subject.scene;
    let mut output = validation.rendered[1].output.clone();
    let camera = output.camera.as_mut().unwrap();
    let (range, size) = (camera.range.clone().unwrap(), (camera.width, camera.height));
    let longer = range.cells().iter().map(|cell| cell.get().map(|range| range + 1.0).into()).collect();
    *camera = SensorMap {
        range: Some(Image::from_cells(size.0, size.1, longer)),
        ..SensorMap::empty(SensorId::Camera, size.0, size.1, Quantities::NONE)
    };
    output.beams.clear();
    output.returns.clear();
    output.flux.clear();
    let recorded = Recorded::of_output("mine", scene, &output, Precision::F64);
    let (images, radiance) = (Vec::new(), Vec::new());
    let declared = Default::default();
    let candidate = Candidate {
        name: "mine".into(),
        folder: "mine".into(),
        declared,
        recorded,
        images,
        radiance,
        ray_sets: vec![],
    };
    validation.evaluate(vec![candidate], &Silent);
    validation
}

#[test]
fn a_wrong_candidate_is_in_every_headline_and_fails() {
    let mut validation = with_wrong_ranges();
    assert!(validation.renderers_pass() && !validation.passes());
    for (name, text) in every_report(&validation) {
        // All 1,495 pixels that hit are wrong; the others have no range.
        assert!(text.contains("1,495"), "{name}: {text}");
    }
    let [(_, screen), (_, page), (_, markdown), (_, junit)] = every_report(&validation);
    let last: Vec<&str> =
        screen.lines().filter(|line| line.starts_with("✗ Candidate mine is wrong")).collect();
    assert_eq!(last, ["✗ Candidate mine is wrong on 1,495 of 1,920 rays; scanline and tracer: all 2,176"]);
    assert!(page.split_once("<h1>").unwrap().1.split_once("</h1>").unwrap().0.contains("mine is wrong"));
    assert!(!page.contains("<p>None.</p>"), "the defects of candidates are defects");
    assert!(markdown.starts_with("### ✗ Candidate mine is wrong on 1,495 of 1,920 rays"), "{markdown}");
    assert!(junit.contains("camera: range is wrong on 1,495 of 1,495 rays"), "{junit}");
    let summary: Value = serde_json::from_str(&summary_json(&validation)).unwrap();
    assert_eq!(summary["verdict"], "candidates_wrong");

    // Where candidates may fail, the verdict stays, and neither the exit code nor CI fails.
    validation.candidates_may_fail = true;
    assert!(validation.passes());
    let [(_, screen), (_, page), (_, markdown), (_, junit)] = every_report(&validation);
    for text in [screen, page, markdown] {
        assert!(text.contains("Candidate mine is wrong on 1,495 of 1,920 rays, and may be"), "{text}");
        assert!(!text.contains("✓"), "{text}");
    }
    assert!(
        junit.contains("wrong, which --candidates-must-pass=false allows") && !junit.contains("<failure")
    );
    let summary: Value = serde_json::from_str(&summary_json(&validation)).unwrap();
    assert_eq!((&summary["verdict"], &summary["passes"]), (&"candidates_wrong".into(), &true.into()));
    assert_eq!(summary["candidates"]["must_pass"], false);
}

#[test]
fn what_a_candidate_does_not_give_is_not_given_everywhere() {
    let validation = with_wrong_ranges();
    let [(_, screen), (_, page), (_, markdown), (_, junit)] = every_report(&validation);
    let not_given = screen.lines().find(|line| line.contains("not given: ")).expect("a line");
    assert!(not_given.contains("face, depth, point"), "{screen}");
    // The last cell of a row is the candidate's.
    for quantity in ["face", "depth", "visible", "pixel flux, beam 0"] {
        let row = page.lines().find(|line| {
            line.starts_with(&format!("<tr><th scope=\"row\">{quantity}</th>")) && line.contains(">0 wrong")
        });
        assert!(row.expect("a row").ends_with("<td class=\"wide\">not given</td></tr>"), "{quantity}");
        let row = markdown.lines().find(|line| line.starts_with(&format!("| {quantity} | 0 wrong")));
        assert!(row.expect("a row").ends_with("| not given |"), "{quantity}");
        let case = junit.split_once(&format!("name=\"{quantity}\" classname=\"pyramids.mine.")).unwrap().1;
        assert!(
            case.split_once("</testcase>").unwrap().0.contains("skipped message=\"not given\""),
            "{case}"
        );
    }
    assert!(page.contains("range: not given"), "the beam has no range map");
    let summary: Value = serde_json::from_str(&summary_json(&validation)).unwrap();
    let mine = &summary["panel"]["renderers"][2];
    let of = |name: &str| {
        let all = mine["quantities"].as_array().unwrap();
        all.iter().find(|one| one["quantity"] == name).unwrap_or_else(|| panic!("{name}"))
    };
    for name in ["face", "depth", "visible", "pencil_flux", "pixel_flux.beam0"] {
        assert_eq!(of(name)["absent"], "not given", "{name}");
        for key in ["agree", "tie", "rounding", "wrong"] {
            assert_eq!(of(name)[key], Value::Null, "{name} {key}");
        }
    }
    // A range of each pixel is given, and none of the 256 pencils.
    assert_eq!((&of("range")["wrong"], &of("range")["not_given"]), (&1495.into(), &256.into()));
    assert_eq!((&of("range")["absent"], &of("range")["storage"]), (&Value::Null, &"double".into()));
}

#[test]
fn the_page_shows_a_candidates_ranges_beside_the_exact_ones() {
    let page = report_html(&with_wrong_ranges());
    let section = page.split_once("<h2>Candidates beside the exact ranges</h2>").expect("the section").1;
    let section = section.split_once("<h2>").expect("its end").0;
    for text in
        ["<figcaption>exact</figcaption>", "<figcaption>mine</figcaption>", "<figcaption>mine minus exact"]
    {
        assert!(section.contains(text), "{text}");
    }
    // Every range is 1 m too long: the scale of the difference says so, with its unit.
    assert!(section.contains("Colours span ±1.00 m, the largest difference."), "{section}");
    assert!(section.contains("difference, m"), "{section}");
    assert!(section.contains("class=\"ring\""), "its defects are marked");
}

#[test]
fn a_candidates_misses_are_reported_and_written_as_packs() {
    let folder = tempfile::tempdir().unwrap();
    let validation = fixtures::with_candidate();
    let written = write_validation(&validation, folder.path(), &Silent).unwrap();

    let summary: Value = serde_json::from_slice(&fs::read(written.summary).unwrap()).unwrap();
    let reports = summary["panel"]["renderers"].as_array().unwrap();
    let wrong: Vec<(&str, u64)> = reports
        .iter()
        .map(|report| (report["name"].as_str().unwrap(), report["wrong"].as_u64().unwrap()))
        .collect();
    assert_eq!(wrong, [("scanline", 0), ("tracer", 0), ("Odd <renderer> 1", 2)]);
    let misses = reports[2]["misses"].as_array().unwrap();
    assert_eq!(misses.len(), 2);
    assert!(misses.iter().all(|miss| miss["quantity"] == "visible"));
    // The renderers agree, and the candidate fails the validation all the same.
    assert_eq!((&summary["verdict"], &summary["passes"]), (&"candidates_wrong".into(), &false.into()));
    assert_eq!(summary["candidates"], serde_json::json!({ "count": 1, "wrong": 1, "must_pass": true }));
    assert!(validation.renderers_pass() && !validation.passes());

    // A miss is a pack of that ray, with the same exact answer for the same reason.
    let of_whole = |i: u32, j: u32| {
        Referee::new(&validation.subject.scene)
            .visibility(0, i, j, Displacement::ZERO)
            .unwrap()
            .hidden_by
            .is_some()
    };
    let mut hidden = Vec::new();
    for miss in misses {
        let [i, j] = ["i", "j"].map(|key| miss[key].as_u64().unwrap() as u32);
        let pack = folder.path().join(miss["reproducer"].as_str().unwrap());
        let readme = fs::read_to_string(pack.join("README.md")).unwrap();
        assert!(
            readme.contains("visible: odd says ") && readme.contains("raypencil probe scene.toml --beam 0"),
            "{readme}"
        );
        let found = raypencil_pack::check_pack(&pack, &pack, None, &Silent).unwrap();
        assert!(found.check.passes());
        let scene = &found.subject.scene;
        assert!(scene.camera().sensor.width < 48, "the image is reduced");
        let words = readme.split_once("pack of that ray (beam-0 pencil ").unwrap().1;
        let place = words.split_once(" here").unwrap().0;
        let (at_i, at_j) = place.split_once(',').unwrap();
        let sight = Referee::new(scene)
            .visibility(0, at_i.parse().unwrap(), at_j.parse().unwrap(), Displacement::ZERO)
            .unwrap();
        assert!(sight.pixel.is_some(), "it still lands on the image");
        assert_eq!(sight.hidden_by.is_some(), of_whole(i, j));
        hidden.push(sight.hidden_by.is_some());
    }
    hidden.sort_unstable();
    assert_eq!(hidden, [false, true]);
}

#[test]
fn a_miss_of_a_sum_over_pencils_is_written_with_the_whole_scene() {
    let folder = tempfile::tempdir().unwrap();
    let mut validation = fixtures::agreeing();
    let scene = &validation.subject.scene;
    let mut recorded = Recorded::of_output("mine", scene, &validation.rendered[1].output, Precision::F64);
    let image = recorded.answers.light[0].image.as_mut().unwrap();
    let lit = image.cells().iter().position(|flux| *flux > 0.0).expect("a pixel with light") as u32;
    let (i, j) = (lit % image.width(), lit / image.width());
    image.set(i, j, 2.0 * image.at(i, j));
    let candidate = Candidate {
        name: "mine".into(),
        folder: "mine".into(),
        declared: Default::default(),
        recorded,
        images: Vec::new(),
        radiance: Vec::new(),
        ray_sets: vec![],
    };
    validation.evaluate(vec![candidate], &Silent);
    let written = write_validation(&validation, folder.path(), &Silent).unwrap();
    let summary: Value = serde_json::from_slice(&fs::read(written.summary).unwrap()).unwrap();
    let misses = summary["panel"]["renderers"][2]["misses"].as_array().unwrap();
    assert_eq!(misses.len(), 1);
    // Which pencils land in a pixel depends on all of the ground: without a part of it the sum would be another.
    let pack = folder.path().join(misses[0]["reproducer"].as_str().unwrap());
    let small = raypencil_pack::check_pack(&pack, &pack, None, &Silent).unwrap().subject.scene;
    let whole = &validation.subject.scene;
    assert_eq!(small.mesh().faces().len(), whole.mesh().faces().len());
    assert_eq!((small.camera().sensor.width, small.beams()[0].sensor.columns), (48, 64));
}
