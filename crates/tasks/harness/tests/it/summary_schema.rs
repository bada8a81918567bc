//! Every summary of a validation keeps to `docs/formats/summary.schema.json`.

use raypencil_tests::fixtures;
use raypencil_tests::schema::{assert_keys_are_closed, schema_faults};
use serde_json::Value;

use crate::reports::summary_json;

const SCHEMA: &str = include_str!("../../../../../docs/formats/summary.schema.json");

fn faults_of(summary: &Value) -> Vec<String> {
    let schema: Value = serde_json::from_str(SCHEMA).unwrap();
    schema_faults(&schema, summary)
}

#[test]
fn every_summary_keeps_to_the_schema() {
    for validation in [
        fixtures::agreeing(),
        fixtures::defective(),
        fixtures::approximate(),
        fixtures::lonely(),
        fixtures::with_candidate(),
    ] {
        let summary: Value = serde_json::from_str(&summary_json(&validation)).unwrap();
        assert_eq!(faults_of(&summary), Vec::<String>::new());
    }
}

#[test]
fn the_check_sees_what_is_wrong() {
    let mut summary: Value = serde_json::from_str(&summary_json(&fixtures::agreeing())).unwrap();
    summary["agree"] = (-1).into();
    summary["verdict"] = "fine".into();
    summary["host"] = "here".into();
    summary["scene"].as_object_mut().unwrap().remove("name");
    summary["pairs"][0]["sensors"][0]["quantities"][2]["worst_error"]["value"] = "large".into();
    let found = faults_of(&summary);
    let expected = [
        "/agree: -1 is less than the minimum of 0",
        "/verdict: \"fine\" is not one of",
        ": Additional properties are not allowed ('host' was unexpected)",
        "/scene: \"name\" is a required property",
        "/pairs/0/sensors/0/quantities/2/worst_error/value: \"large\" is not",
    ];
    for start in expected {
        assert!(found.iter().any(|fault| fault.starts_with(start)), "{start}: {found:?}");
    }
    assert_eq!(found.len(), expected.len(), "{found:?}");
}

#[test]
fn the_schema_allows_no_other_keys() {
    assert_keys_are_closed(&serde_json::from_str(SCHEMA).unwrap());
}
