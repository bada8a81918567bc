//! Checks `manifest.json` against `docs/formats/pack.schema.json`, with every key that can be written.

use raypencil_tests::schema::schema_faults;
use serde_json::Value;

use super::{blind, manifest};

const SCHEMA: &str = include_str!("../../../../../../docs/formats/pack.schema.json");

fn faults_of(value: &Value) -> Vec<String> {
    let schema: Value = serde_json::from_str(SCHEMA).unwrap();
    schema_faults(&schema, value)
}

#[test]
fn written_manifests_keep_to_the_schema() {
    for manifest in [manifest(), blind()] {
        let folder = tempfile::tempdir().unwrap();
        manifest.write(folder.path()).unwrap();
        let text = std::fs::read_to_string(folder.path().join("manifest.json")).unwrap();
        let value: Value = serde_json::from_str(&text).unwrap();
        assert_eq!(faults_of(&value), Vec::<String>::new());
    }
}

#[test]
fn the_schema_refuses_faults() {
    let mut value = serde_json::to_value(manifest()).unwrap();
    value["format"] = 2.into();
    value["kind"] = "secret".into();
    value["host"] = "here".into();
    value["scene"].as_object_mut().unwrap().remove("name");
    value["files"][0]["sha256"] = "00".into();
    value["files"][1]["shape"] = serde_json::json!([72]);
    value["sensors"][0]["rows"] = 0.into();
    let mut found = faults_of(&value);
    found.sort();
    let expected = [
        "/files/0/sha256: \"00\" does not match \"^[0-9a-f]{64}$\"",
        "/files/1/shape: [72] has less than 2 items",
        "/format: 1 was expected",
        "/kind: \"secret\" is not one of \"answers\", \"blind\" or \"questions\"",
        "/scene: \"name\" is a required property",
        "/sensors/0/rows: 0 is less than the minimum of 1",
        ": Additional properties are not allowed ('host' was unexpected)",
    ];
    assert_eq!(found, expected);
}

#[test]
fn every_key_of_the_schema_can_be_written() {
    fn keys(value: &Value, into: &mut Vec<String>) {
        match value {
            Value::Object(object) => object.iter().for_each(|(key, part)| {
                into.push(key.clone());
                keys(part, into);
            }),
            Value::Array(list) => list.iter().for_each(|part| keys(part, into)),
            _ => {}
        }
    }
    fn known(schema: &Value, into: &mut Vec<String>) {
        if let Some(properties) = schema.get("properties").and_then(Value::as_object) {
            into.extend(properties.keys().cloned());
        }
        match schema {
            Value::Object(object) => object.values().for_each(|part| known(part, into)),
            Value::Array(list) => list.iter().for_each(|part| known(part, into)),
            _ => {}
        }
    }
    let (mut written, mut described) = (Vec::new(), Vec::new());
    for manifest in [manifest(), blind()] {
        keys(&serde_json::to_value(manifest).unwrap(), &mut written);
    }
    known(&serde_json::from_str(SCHEMA).unwrap(), &mut described);
    for list in [&mut written, &mut described] {
        list.sort();
        list.dedup();
    }
    assert_eq!(written, described);
}
