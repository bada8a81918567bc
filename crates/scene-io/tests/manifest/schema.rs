//! Holds `manifest.json` to `docs/pack.schema.json`, with as much of JSON Schema as that file uses.

use serde_json::Value;

use super::{blind, manifest};

const SCHEMA: &str = include_str!("../../../../docs/pack.schema.json");

/// What `value` has that `schema` does not allow, or lacks that it requires.
fn faults(root: &Value, schema: &Value, value: &Value, place: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut hold = |holds: bool, what: String| {
        if !holds {
            found.push(format!("{place}: {what}"));
        }
    };
    let mut below = Vec::new();
    for (keyword, rule) in schema.as_object().expect("a schema is an object") {
        let number = || rule.as_f64().unwrap();
        match keyword.as_str() {
            "$schema" | "title" | "description" | "$defs" => {}
            "$ref" => {
                let pointer = rule.as_str().unwrap().strip_prefix('#').expect("a reference into this file");
                below.extend(faults(root, root.pointer(pointer).expect("what it refers to"), value, place));
            }
            "type" => hold(is(rule.as_str().unwrap(), value), format!("{value} is no {rule}")),
            "const" => hold(value == rule, format!("{value} is not {rule}")),
            "enum" => hold(rule.as_array().unwrap().contains(value), format!("{value} is not one of {rule}")),
            "minimum" => {
                hold(value.as_f64().is_none_or(|n| n >= number()), format!("{value} is below {rule}"))
            }
            "maximum" => {
                hold(value.as_f64().is_none_or(|n| n <= number()), format!("{value} is above {rule}"))
            }
            "minItems" => {
                hold(value.as_array().is_none_or(|list| list.len() as f64 >= number()), "too short".into());
            }
            "maxItems" => {
                hold(value.as_array().is_none_or(|list| list.len() as f64 <= number()), "too long".into());
            }
            "pattern" => {
                assert_eq!(rule, "^[0-9a-f]{64}$", "teach this check patterns");
                let text = value.as_str().unwrap_or("");
                let digit = |c: char| c.is_ascii_digit() || ('a'..='f').contains(&c);
                hold(text.len() == 64 && text.chars().all(digit), format!("{value} is no digest"));
            }
            "required" => {
                for key in rule.as_array().unwrap() {
                    hold(value.get(key.as_str().unwrap()).is_some(), format!("no {key}"));
                }
            }
            "properties" => {
                for (key, part) in value.as_object().into_iter().flatten() {
                    if let Some(of_key) = rule.get(key) {
                        below.extend(faults(root, of_key, part, &format!("{place}/{key}")));
                    }
                }
            }
            "additionalProperties" => {
                assert_eq!(rule, &Value::Bool(false), "teach this check other rules");
                for key in value.as_object().into_iter().flatten().map(|(key, _)| key) {
                    hold(schema["properties"].get(key).is_some(), format!("{key} is not in the schema"));
                }
            }
            "items" => {
                for (index, part) in value.as_array().into_iter().flatten().enumerate() {
                    below.extend(faults(root, rule, part, &format!("{place}/{index}")));
                }
            }
            unknown => panic!("teach this check what {unknown} means"),
        }
    }
    found.extend(below);
    found
}

fn is(name: &str, value: &Value) -> bool {
    match name {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "integer" => value.is_u64() || value.is_i64(),
        unknown => panic!("teach this check what a {unknown} is"),
    }
}

fn faults_of(value: &Value) -> Vec<String> {
    let schema: Value = serde_json::from_str(SCHEMA).unwrap();
    faults(&schema, &schema, value, "")
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
fn the_check_sees_what_is_wrong() {
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
        "/files/0/sha256: \"00\" is no digest",
        "/files/1/shape: too short",
        "/format: 2 is not 1",
        "/kind: \"secret\" is not one of [\"answers\",\"blind\"]",
        "/scene: no \"name\"",
        "/sensors/0/rows: 0 is below 1",
        ": host is not in the schema",
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
