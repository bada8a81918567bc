//! Checks of candidates: reports for people and programs, and recordings with few channels.

use std::path::{Path, PathBuf};

use raypencil_files::{Limits, Values, read_npy, write_npy};
use raypencil_judge::{Class, GroundTruth, ListedDefect, Quantity, Recorded, check};
use raypencil_pack::{
    BundleFindings, Checked, Declarations, FileRole, Manifest, PackKind, check_pack, write_document,
    write_questions,
};
use raypencil_scanline::Scanline;
use raypencil_scene::{Precision, Renderer, Request, Silent};
use raypencil_scene_io::{Overrides, Subject, load};
use raypencil_tests::schema::{assert_keys_are_closed, schema_faults};
use raypencil_tracer::Tracer;
use serde_json::Value;

const SCHEMA: &str = include_str!("../../../../../docs/formats/check.schema.json");

fn pack() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../data/packs/pyramids")
}

/// The pack checked against itself.
fn perfect() -> Checked {
    check_pack(&pack(), &pack(), Some(Precision::F64), &Silent).expect("a pack as it was written")
}

/// A candidate with the faces and ranges of the camera only. One range is wrong by 1 m.
fn partial() -> Checked {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let candidate = folder.path().join("mine");
    std::fs::create_dir_all(candidate.join("camera")).expect("a folder");
    std::fs::copy(pack().join("camera/face.I.npy"), candidate.join("camera/face.I.npy")).expect("a file");
    let array = read_npy(pack().join("camera/range.T.npy"), &Limits::default()).expect("an array");
    let [Values::Reals(ranges)] = array.planes.as_slice() else { panic!("one plane of reals") };
    let mut ranges = ranges.clone();
    let hit = ranges.cells().iter().position(|range| range.is_finite()).expect("a hit");
    ranges.cells_mut()[hit] += 1.0;
    write_npy(candidate.join("camera/range.T.npy"), &[&ranges]).expect("a file");
    check_pack(&pack(), &candidate, None, &Silent).expect("a candidate that keeps to the conventions")
}

/// Compares a report with its snapshot. Version and paths are left out.
fn assert_report(name: &str, text: &str) {
    let text = text.replace(&pack().display().to_string(), "PACK");
    insta::with_settings!({ filters => vec![(r"raypencil \d+\.\d+\.\d+", "raypencil [version]")] }, {
        insta::assert_snapshot!(name, text);
    });
}

#[test]
fn screens_are_as_the_snapshots_show() {
    assert_report("screen_of_a_perfect_candidate", &perfect().document().screen());
    assert_report("screen_of_a_partial_candidate", &partial().document().screen());
    assert_report("markdown_of_a_partial_candidate", &partial().document().markdown());
}

#[test]
fn junit_is_as_the_snapshot_shows() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let document = partial().document_with_pictures().expect("pictures");
    write_document(&document, folder.path()).expect("a writable folder");
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).expect("a file");
    assert_report("junit_of_a_partial_candidate", &read("junit.xml"));
    assert_eq!((read("summary.md"), read("check.json")), (document.markdown(), document.json()));
}

/// A candidate with three faults in the camera: an early range 1 um too long, a late one 2 m too long, and a pixel of
/// the middle that misses.
fn three_faults() -> Checked {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let candidate = folder.path().join("mine");
    std::fs::create_dir_all(candidate.join("camera")).expect("a folder");
    let reals = |name: &str| {
        let array =
            read_npy(pack().join(format!("camera/{name}.npy")), &Limits::default()).expect("an array");
        let [Values::Reals(image)] = array.planes.as_slice() else { panic!("one plane of reals") };
        image.clone()
    };
    let mut ranges = reals("range.T");
    let hits: Vec<usize> = (0..ranges.cells().len()).filter(|&at| ranges.cells()[at].is_finite()).collect();
    ranges.cells_mut()[hits[0]] += 1e-6;
    ranges.cells_mut()[hits[hits.len() / 2]] = f64::INFINITY;
    ranges.cells_mut()[hits[hits.len() - 1]] += 2.0;
    write_npy(candidate.join("camera/range.T.npy"), &[&ranges]).expect("a file");
    check_pack(&pack(), &candidate, None, &Silent).expect("a candidate that keeps to the conventions")
}

#[test]
fn the_worst_defects_are_listed_hits_before_values() {
    let checked = three_faults();
    let listed = &checked.check.sensors[0].listed;
    let found: Vec<Quantity> = listed.iter().map(|one| one.item.quantity).collect();
    // In reading order the smallest fault would be the first.
    assert_eq!(found, [Quantity::Hit, Quantity::Range, Quantity::Range]);
    assert_eq!(checked.check.sensors[0].defects[0].place, listed[2].place);
    assert_eq!((listed[0].said[0].1.as_str(), listed[0].difference), ("no hit", None));
    assert!(listed[0].truth.starts_with("face "), "{}", listed[0].truth);
    let off = |k: usize| listed[k].difference.expect("two numbers");
    assert!((off(1) - 2.0).abs() < 1e-9 && (off(2) - 1e-6).abs() < 1e-12, "{listed:?}");
    assert!(listed[1].ratio > listed[2].ratio && listed[2].ratio > Some(1.0));
    // The margin is that of the pack, which was computed apart, rounded down to single precision.
    let array = read_npy(pack().join("camera/margin.face.npy"), &Limits::default()).expect("an array");
    for one in &listed[1..] {
        let index = one.place.i as usize + one.place.j as usize * 96;
        let margin = one.margin.as_ref().expect("a ray has one");
        assert_eq!((margin.of, margin.unit), ("face", "cells"));
        let of_pack = array.planes[0].real(index);
        assert!(margin.lo >= of_pack && margin.lo <= of_pack * (1.0 + 1e-6), "{margin:?} {of_pack}");
    }
    let screen = checked.document().screen();
    assert!(screen.contains("hit/miss: mine says no hit; true is face"), "{screen}");
}

fn page_of(checked: &Checked) -> String {
    checked.document_with_pictures().expect("pictures").page().expect("a page")
}

#[test]
fn the_page_has_verdict_quantities_defects_and_pictures() {
    let page = raypencil_explorer::without_explorer(&page_of(&three_faults()));
    assert!(page.contains("<span aria-hidden=\"true\">✗</span> 3 of 6,912 rays are wrong"), "{page}");
    assert!(page.contains("mine says no hit; true is face"), "the worst defect is told");
    assert_eq!(page.matches("<li>").count(), 3);
    // The camera has three pictures; the nine beams, which are not given, the exact one.
    assert_eq!(page.matches("src=\"data:image/png;base64,").count(), 12);
    assert!(
        page.contains("mine minus exact") && page.contains("Colours span ±2.00 m, the largest difference")
    );
    assert!(page.contains("hit on one side only"));
    assert_eq!(page.matches("range: not given").count(), 9);
    let row = page.lines().find(|line| line.contains("<th scope=\"row\">depth</th>")).expect("a row");
    assert!(row.contains("not given") && !row.contains("<td>0</td>"), "{row}");
    for outside in ["http:", "https:", "<script", "<link", "url("] {
        assert!(!page.contains(outside), "{outside}");
    }
    // The page opens on the worst ray, which is the first of the list, and on the difference there.
    let checked = three_faults();
    let worst = &checked.check.sensors[0].listed[0].place;
    let opening = format!("\"opening\":\"camera/{},{}/range.T/diff\"", worst.i, worst.j);
    assert!(page_of(&checked).contains(&opening), "{opening}");
    let perfect = page_of(&perfect());
    assert!(!perfect.contains("\"opening\":\""));
    assert!(perfect.contains("✓") && perfect.contains("<p>None.</p>"));
    assert!(perfect.contains("ranges are equal to the last bit"));
}

#[test]
fn the_json_keeps_to_its_schema() {
    let schema: Value = serde_json::from_str(SCHEMA).unwrap();
    assert_keys_are_closed(&schema);
    let mut checked = perfect();
    let clean: Value = serde_json::from_str(&checked.document().json()).unwrap();
    assert_eq!(schema_faults(&schema, &clean), Vec::<String>::new());
    assert_eq!(clean["verdict"], "agrees");
    // A report with a defect and an unknown channel.
    checked.check.sensors[0].by_class[Class::Defect as usize] = 1;
    checked.recorded.unknown.push("camera/mine".into());
    let largest = checked.check.sensors[0]
        .items
        .get(Quantity::Range.into())
        .unwrap()
        .worst_ulps
        .clone()
        .expect("compared");
    checked.check.sensors[0].listed.push(ListedDefect {
        place: largest.place,
        item: Quantity::Range.into(),
        said: vec![("mine".into(), "4 m".into())],
        truth: String::new(),
        difference: Some(f64::INFINITY),
        difference_unit: "m",
        ratio: None,
        margin: None,
        what: "off".into(),
    });
    let wrong: Value = serde_json::from_str(&checked.document().json()).unwrap();
    assert_eq!(schema_faults(&schema, &wrong), Vec::<String>::new());
    assert_eq!(wrong["verdict"], "defects");
    let faulty: Value = serde_json::from_str(&three_faults().document().json()).unwrap();
    assert_eq!(schema_faults(&schema, &faulty), Vec::<String>::new());
    let depth = &faulty["bundles"][0]["quantities"][3];
    assert_eq!((&depth["quantity"], &depth["not_given"]), (&"depth".into(), &"not given".into()));
}

/// The verdict in all its forms: what the exit code follows, the word for programs, the words for people, the sign.
fn verdict(checked: &Checked) -> (bool, String, String, String) {
    let document = checked.document();
    let json: Value = serde_json::from_str(&document.json()).unwrap();
    let word = json["verdict"].as_str().expect("a word").to_string();
    (checked.passes(), word, document.headline.clone(), document.outcome.sign().to_string())
}

#[test]
fn what_could_not_be_decided_is_no_pass() {
    let mut checked = perfect();
    let camera = &mut checked.check.sensors[0];
    (camera.by_class[Class::Agree as usize], camera.by_class[Class::Undecided as usize]) =
        (camera.by_class[Class::Agree as usize] - 3, 3);
    let (passes, word, headline, sign) = verdict(&checked);
    assert_eq!((passes, word.as_str(), sign.as_str()), (false, "defects", "✗"));
    assert!(headline.contains(" 3 undecided"), "{headline}");
    assert!(checked.document().screen().contains("✗"));
}

#[test]
fn a_set_of_rays_that_hits_nothing_is_no_pass_beside_sensors_that_hit() {
    let set = |name: &str, hits_anything: bool| {
        let mut bundle = BundleFindings::not_given(format!("rays/{name}"), 0);
        bundle.by_class[Class::Agree as usize] = 40;
        bundle.hits_anything = hits_anything;
        bundle
    };
    let with = |ray_sets: Vec<BundleFindings>| verdict(&Checked { ray_sets, ..perfect() });
    let (passes, word, ..) = with(vec![set("head", true)]);
    assert_eq!((passes, word.as_str()), (true, "agrees"));
    for sets in [vec![set("head", false)], vec![set("head", true), set("roof", false)]] {
        let (passes, word, headline, sign) = with(sets);
        assert_eq!((passes, word.as_str(), sign.as_str()), (false, "nothing_hit", "?"));
        assert!(
            headline.starts_with("No ray of this pack, or of one of its sets, hits anything"),
            "{headline}"
        );
    }
    // One that is not given is not asked.
    let (passes, word, ..) = with(vec![BundleFindings::not_given("rays/head".into(), 40)]);
    assert_eq!((passes, word.as_str()), (true, "agrees"));
}

#[test]
fn the_verdict_says_of_a_pack_that_nobody_has_published_that_it_is_none() {
    let words = |checked: &Checked| verdict(checked).2;
    assert!(!words(&perfect()).contains("not published"), "{}", words(&perfect()));
    let mut forged = perfect();
    forged.pack.sha256 = "0123456789ab".repeat(6)[..64].into();
    assert!(
        words(&forged).ends_with(" (By a pack that is not published: sha256 0123456789ab...)"),
        "{}",
        words(&forged)
    );
    // Whose answers are computed needs no word of anybody.
    forged.has_answers = false;
    assert!(!words(&forged).contains("not published"));
}

#[test]
fn what_is_declared_now_counts_more_than_a_note_which_still_says_the_rest() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let note = r#"{"format": 1, "program": "P", "arithmetic": "f32", "scale": 0.001, "miss": -1,
        "channels": {"range.T": "far", "depth.Z": "deep", "face.I": "id"}, "no_faces": true}"#;
    std::fs::write(folder.path().join("candidate.json"), note).expect("a file");
    let channel = |text: &str| text.parse().expect("a channel");
    let with = |declared: Declarations| declared.with_note_of(folder.path()).expect("a note");
    let noted = with(Declarations::default());
    assert_eq!((noted.precision(), noted.scale, noted.miss), (Precision::F32, Some(0.001), Some(-1.0)));
    assert!(noted.ignores_faces);
    let all = ["range.T=far", "depth.Z=deep", "face.I=id"].map(channel);
    assert_eq!(noted.channels, all);
    let declared = Declarations {
        precision: Some(Precision::F64),
        miss: Some(0.0),
        scale: Some(0.01),
        channels: vec![channel("depth.Z=other")],
        ..Declarations::default()
    };
    let both = with(declared.clone());
    assert_eq!((both.precision(), both.scale, both.miss), (Precision::F64, Some(0.01), Some(0.0)));
    assert_eq!(both.channels, ["depth.Z=other", "range.T=far", "face.I=id"].map(channel));
    // Without a note all is as it is declared.
    let elsewhere = tempfile::tempdir().expect("a temporary folder");
    assert_eq!(declared.clone().with_note_of(elsewhere.path()).expect("no note"), declared);
}

#[test]
fn classes_add_up_and_a_perfect_candidate_has_no_error() {
    let Checked { check, .. } = perfect();
    assert!(check.passes());
    for sensor in &check.sensors {
        assert_eq!(sensor.compared(), sensor.by_class[Class::Agree as usize]);
        for (item, tally) in sensor.items.iter() {
            assert!(tally.compared() <= sensor.compared(), "{item:?}");
            assert!(tally.others.is_empty(), "{item:?}");
            assert!(
                tally.worst_error.as_ref().is_none_or(|largest| largest.value == 0.0),
                "{item:?}: {tally:?}"
            );
        }
    }
}

#[test]
fn outputs_in_memory_are_judged_in_double_precision() {
    let scene = load(&pack().join("scene.toml").to_string_lossy(), &Overrides::default())
        .expect("the pack's scene")
        .scene;
    let truth = GroundTruth::certified(&scene, &Silent);
    let renderers: [&dyn Renderer; 2] = [&Scanline::default(), &Tracer::new()];
    for renderer in renderers {
        let output = renderer.render(&scene, &Request::EVERYTHING);
        let mut recorded = Recorded::of_output(renderer.name(), &scene, &output, Precision::F64);
        let found = check(&truth, &recorded, &Silent);
        assert!(found.passes());
        let totals = found.totals();
        let ratio = |quantity: Quantity| {
            let items = totals.iter().filter(|(item, _)| item.quantity == quantity);
            items
                .filter_map(|(_, tally)| tally.worst_ratio.as_ref())
                .fold(0.0, |largest: f64, one| largest.max(one.value))
        };
        for quantity in Quantity::ALL {
            // The derived bounds leave room.
            assert!(ratio(quantity) < 0.5, "{}: {quantity} {}", renderer.name(), ratio(quantity));
        }
        // Without faces the values are judged, and without the pencils' pixels the images.
        for map in &mut recorded.answers.maps {
            map.face = None;
        }
        for light in &mut recorded.answers.light {
            light.returns.pixel = None;
            light.returns.visible = None;
        }
        recorded.storage.retain(|(_, item), _| {
            !matches!(item.quantity, Quantity::Face | Quantity::Pixel | Quantity::Visible)
        });
        let found = check(&truth, &recorded, &Silent);
        assert!(
            found.passes(),
            "{}: {:?}",
            renderer.name(),
            found.sensors.iter().find_map(|s| s.defects.first())
        );
        // An image that lacks a quarter of one pixel's flux is wrong nevertheless.
        let image = recorded.answers.light[0].image.as_mut().unwrap();
        let at = image.cells().iter().position(|flux| *flux > 0.0).unwrap();
        image.cells_mut()[at] *= 0.75;
        assert!(!check(&truth, &recorded, &Silent).passes());
    }
}

#[test]
fn a_pack_of_questions_is_checked_by_its_scene() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let questions = folder.path().join("questions");
    let loaded = load(&pack().join("scene.toml").to_string_lossy(), &Overrides::default()).expect("a scene");
    let subject = Subject {
        vehicle: None,
        name: loaded.name,
        arguments: String::new(),
        sha256: loaded.source_sha256,
        scene: loaded.scene,
        file_facts: Default::default(),
    };
    let manifest = write_questions(&subject, &questions, &Silent).expect("a writable folder");
    assert_eq!((manifest.kind, manifest.blind_seed), (PackKind::Questions, None));
    // Scene, terrain, and the rays of each sensor: no answers.
    assert_eq!(manifest.files.len(), 2 + subject.scene.sensors().count());
    assert!(manifest.files.iter().all(|file| file.role != FileRole::Answers));
    assert_eq!(Manifest::read_verified(&questions).expect("its manifest"), manifest);
    // The answers of the whole pack are right for its questions; one range that is wrong is found.
    let right = check_pack(&questions, &pack(), None, &Silent).expect("a candidate");
    assert!(right.passes());
    assert_eq!(right.check.compared(), perfect().check.compared());
    let wrong = folder.path().join("wrong/camera");
    std::fs::create_dir_all(&wrong).expect("a folder");
    let array = read_npy(pack().join("camera/range.T.npy"), &Limits::default()).expect("an array");
    let [Values::Reals(ranges)] = array.planes.as_slice() else { panic!("one plane of reals") };
    let mut ranges = ranges.clone();
    let hit = ranges.cells().iter().position(|range| range.is_finite()).expect("a hit");
    ranges.cells_mut()[hit] += 1.0;
    write_npy(wrong.join("range.T.npy"), &[&ranges]).expect("a file");
    let found = check_pack(&questions, &folder.path().join("wrong"), None, &Silent).expect("a candidate");
    assert_eq!(found.check.of(Class::Defect), 1);
}

#[test]
fn a_pass_tells_only_what_the_candidate_could_have_shown() {
    let told = |checked: &Checked| -> Vec<String> {
        let json: Value = serde_json::from_str(&checked.document().json()).unwrap();
        let sizes = json["sharpness"].as_array().expect("sizes");
        sizes.iter().map(|one| format!("{} {}", one["slack"].as_str().unwrap(), one["noticed"])).collect()
    };
    let has = |told: &[String], slack: &str| told.iter().any(|one| one.starts_with(slack));
    let all = told(&perfect());
    assert_eq!(all.len(), 37);
    // The bluntest first.
    assert!(!all[0].ends_with("e-16") && all[36].ends_with("e-16"), "{all:?}");

    let without = |quantity: Quantity| {
        let mut checked = perfect();
        checked.recorded.storage.retain(|(_, item), _| item.quantity != quantity);
        checked
    };
    let blind = told(&without(Quantity::Visible));
    assert!(!has(&blind, "shadow-starts-away") && !has(&blind, "image-wider"), "{blind:?}");
    assert!(has(&blind, "shift-right") && has(&blind, "lands-left"), "{blind:?}");
    let faceless = told(&without(Quantity::Face));
    assert!(!has(&faceless, "shift-right") && has(&faceless, "range-scaled"), "{faceless:?}");
    // Stored in single precision, values of a candidate in double precision say less than it computes.
    let mut coarse = perfect();
    for ((_, item), storage) in &mut coarse.recorded.storage {
        if item.quantity == Quantity::Range {
            *storage = raypencil_files::Storage::F32;
        }
    }
    assert!(!has(&told(&coarse), "range-scaled") && has(&told(&coarse), "depth-scaled"));
    // In single precision the sizes are those of single precision.
    let mut single = perfect();
    single.recorded.precision = Precision::F32;
    assert_ne!(told(&single), all);
    let text = perfect().document().screen();
    assert!(text.contains("a shadow bias of") && !text.contains("the pack's own word"), "{text}");
    let text = without(Quantity::Visible).document().screen();
    assert!(text.contains("of a cell off") && !text.contains("a shadow bias of"), "{text}");
}

/// Sets of rays are of the same candidate: the verdict calls none of it exact if one set has half precision.
#[test]
fn a_set_of_rays_in_half_precision_is_not_called_exact() {
    let screen = |coarseness: Option<&str>| {
        let mut checked = perfect();
        let set = BundleFindings::not_given("rays/head".into(), 5);
        checked.ray_sets = vec![BundleFindings { coarseness: coarseness.map(String::from), ..set }];
        checked.document().screen()
    };
    assert!(screen(None).contains(" rays agree with the exact answers: "), "{}", screen(None));
    let half = screen(Some("half precision"));
    assert!(half.contains(" rays agree to half precision: ") && !half.contains(" exact, "), "{half}");
}
