//! Warnings and a validation in which nothing is hit, in every output; and text that is cut on a terminal alone.

use raypencil_explorer::without_explorer;
use raypencil_harness::{Validation, one_screen, whole_screen};
use raypencil_scene_io::scene_sha256;
use raypencil_survey::{Warning, WarningCode};
use raypencil_tests::fixtures;
use raypencil_tests::schema::schema_faults;
use serde_json::Value;

use crate::reports::{junit_xml, report_html, summary_json, summary_markdown};

fn summary(validation: &Validation) -> Value {
    serde_json::from_str(&summary_json(validation)).unwrap()
}

fn assert_keeps_to_the_schema(summary: &Value) {
    let schema = include_str!("../../../../../docs/formats/summary.schema.json");
    assert_eq!(schema_faults(&serde_json::from_str(schema).unwrap(), summary), Vec::<String>::new());
}

#[test]
fn a_validation_in_which_nothing_is_hit_is_never_green() {
    let mut validation = fixtures::empty();
    // All agree, so nothing else fails it.
    let counts = validation.counts();
    assert_eq!((counts.agree, counts.compared, counts.defects), (2176, 2176, 0));
    assert!(!validation.passes());
    for allow_empty in [false, true] {
        validation.allow_empty = allow_empty;
        assert_eq!(validation.passes(), allow_empty);
        let headline = "Nothing is hit: all 2,176 rays miss the terrain";
        for text in [
            one_screen(&validation, None),
            summary_markdown(&validation),
            without_explorer(&report_html(&validation)),
        ] {
            assert!(text.contains(headline), "{text}");
            assert!(!text.contains("✓") && !text.contains("All "), "{text}");
        }
        assert!(report_html(&validation).contains("<header class=\"verdict nothing\">"));
        let summary = summary(&validation);
        assert_eq!(summary["verdict"], "nothing_hit");
        assert_keeps_to_the_schema(&summary);
        let junit = junit_xml(&validation);
        assert_eq!(junit.contains("<failure message=\"Nothing is hit: "), !allow_empty, "{junit}");
        assert_eq!(junit.contains("<skipped message=\"Nothing is hit: "), allow_empty, "{junit}");
    }
}

#[test]
fn one_hit_of_one_renderer_is_something() {
    let mut validation = fixtures::empty();
    let map = validation.rendered[1].output.camera.as_mut().unwrap();
    map.range.as_mut().unwrap().set(3, 4, raypencil_scene::Maybe::some(7.0));
    assert!(validation.hits_something());
}

#[test]
fn each_sensor_that_sees_nothing_is_warned_about_in_every_output() {
    let validation = fixtures::empty();
    let warned: Vec<String> = validation.warnings.iter().map(ToString::to_string).collect();
    let sentence = |sensor, rays| {
        format!("{sensor}: none of its {rays} rays hits the front of the terrain within the maximum range.")
    };
    assert_eq!(warned, [sentence("camera", "1,920"), sentence("beam-0", "256")]);
    let summary = summary(&validation);
    assert_keeps_to_the_schema(&summary);
    assert_eq!(summary["warnings"][0]["code"], "no_hits");
    assert_eq!(summary["warnings"][1]["sensor"], "beam-0");
    let page = report_html(&validation);
    let (screen, markdown) = (one_screen(&validation, None), summary_markdown(&validation));
    for warning in warned {
        assert!(page.contains(&format!("<p>{warning}</p>")), "{page}");
        assert!(markdown.contains("**Warnings**\n") && markdown.contains(&warning), "{markdown}");
        // On the screen the sentence is wrapped.
        let words: Vec<&str> = screen.split_whitespace().collect();
        assert!(words.join(" ").contains(&format!("warning: {warning}")), "{screen}");
    }
    assert!(screen.lines().all(|line| line.chars().count() <= 80), "{screen}");
}

#[test]
fn a_scene_that_is_fine_has_no_warnings() {
    for validation in [fixtures::agreeing(), fixtures::defective(), fixtures::approximate()] {
        assert_eq!(validation.warnings, []);
        assert_eq!(summary(&validation)["warnings"], serde_json::json!([]));
        assert!(!report_html(&validation).contains("<h2>Warnings</h2>"));
        assert!(!one_screen(&validation, None).contains("warning"));
    }
}

#[test]
fn many_warnings_stay_on_one_screen() {
    let mut validation = fixtures::defective();
    let first = validation.pairs[0].sensors[1].defects[0].clone();
    validation.pairs[0].sensors[1].defects = vec![first; 100];
    let warning = Warning::of_scene(WarningCode::TerrainOnItsSide, "word ".repeat(20));
    validation.warnings = vec![warning; 9];
    let screen = one_screen(&validation, Some("out/pyramids".as_ref()));
    assert!(screen.lines().count() <= 40, "{screen}");
    assert!(screen.contains("... and 7 more warnings in the summary\n"), "{screen}");
    assert_eq!(whole_screen(&validation, None).matches("warning: ").count(), 9);
}

#[test]
fn a_text_that_is_not_for_a_terminal_is_not_cut() {
    let mut validation = fixtures::approximate();
    for sensor in &mut validation.pairs[0].sensors {
        sensor.by_class = [67_108_864, 1_000_000, 55_555, 123_456, 0, 99_999];
        for tally in sensor.items.values_mut() {
            tally.by_class = sensor.by_class;
        }
    }
    let (cut, whole) = (one_screen(&validation, None), whole_screen(&validation, None));
    assert!(cut.lines().all(|line| line.chars().count() <= 80) && cut.contains("..."), "{cut}");
    assert!(!whole.contains("..."), "{whole}");
    let camera = "camera  1,920 rays: 67,108,864 agree, 1,000,000 tie, 99,999 defect, 55,555 rounding, 123,456 \
                  approximation; 1,495 hit\n";
    assert!(whole.contains(camera), "{whole}");
    // The column of places, which a terminal has no room for, and all stages.
    assert!(!cut.contains("beam-0 5,0") && whole.contains("beam-0 5,0"), "{whole}");
    assert!(cut.contains(" more\n") && !whole.contains(" more\n"), "{whole}");
}

#[test]
fn the_digest_that_a_candidate_must_name_is_the_one_that_is_shown() {
    let validation = fixtures::agreeing();
    let (scene, source) = (scene_sha256(&validation.subject.scene), &validation.subject.sha256);
    assert_ne!(&scene, source);
    let summary = summary(&validation);
    assert_eq!(summary["scene"]["sha256"], scene.as_str());
    assert_eq!(summary["scene"]["source_sha256"], source.as_str());
    assert!(one_screen(&validation, None).contains(&format!("\nScene SHA-256 {scene}\n")));
    assert!(summary_markdown(&validation).contains(&format!("* Scene SHA-256: `{scene}`")));
    let page = report_html(&validation);
    assert!(page.contains(&format!("<dt>Scene SHA-256</dt><dd>{scene}</dd>")));
    assert!(page.contains(&format!("<dt>Source SHA-256</dt><dd>{source}</dd>")));
    // `candidate.json` of a candidate of this scene wants this digest, and refuses that of the source.
    let note = |sha256: &str| {
        let folder = tempfile::tempdir().unwrap();
        let json = serde_json::json!({
            "format": 1, "program": "mine", "arithmetic": "f64", "scene": { "name": "pyramids", "sha256": sha256 }
        });
        std::fs::write(folder.path().join("candidate.json"), json.to_string()).unwrap();
        raypencil_pack::note(folder.path(), &validation.subject.scene)
    };
    assert!(note(&scene).unwrap().is_some());
    assert!(note(source).unwrap_err().to_string().contains(&scene));
}
