//! Holds `summary.json` to `docs/summary.schema.json`, with as much of JSON Schema as that file uses.

use serde_json::Value;

use super::{fixtures, summary_json};

const SCHEMA: &str = include_str!("../../../../docs/summary.schema.json");

/// What `value` has that `schema` does not allow, or lacks that it requires.
pub(crate) fn faults(root: &Value, schema: &Value, value: &Value, place: &str) -> Vec<String> {
    let mut found = Vec::new();
    for (keyword, rule) in schema.as_object().expect("a schema is an object") {
        match keyword.as_str() {
            "$schema" | "title" | "description" | "$defs" => {}
            "$ref" => {
                let pointer = rule.as_str().unwrap().strip_prefix('#').expect("a reference into this file");
                found.extend(faults(root, root.pointer(pointer).expect("what it refers to"), value, place));
            }
            "type" => {
                let names: Vec<&Value> = rule.as_array().map_or(vec![rule], |names| names.iter().collect());
                if !names.iter().any(|name| is(name.as_str().unwrap(), value)) {
                    found.push(format!("{place}: {value} is not {rule}"));
                }
            }
            "const" if value != rule => found.push(format!("{place}: {value} is not {rule}")),
            "enum" if !rule.as_array().unwrap().contains(value) => {
                found.push(format!("{place}: {value} is not one of {rule}"));
            }
            "minimum" if value.as_f64().is_some_and(|number| number < rule.as_f64().unwrap()) => {
                found.push(format!("{place}: {value} is below {rule}"));
            }
            "const" | "enum" | "minimum" => {}
            // Of a value that may be null as well, what is said of objects goes for objects.
            "required" => {
                let keys = rule.as_array().unwrap().iter().map(|key| key.as_str().unwrap());
                let lacking = keys.filter(|key| value.is_object() && value.get(key).is_none());
                found.extend(lacking.map(|key| format!("{place}: no {key}")));
            }
            "properties" | "additionalProperties" => {
                for (key, part) in value.as_object().into_iter().flatten() {
                    let known = schema.get("properties").and_then(|properties| properties.get(key));
                    let place = format!("{place}/{key}");
                    match (keyword.as_str(), known) {
                        ("properties", Some(of_key)) => found.extend(faults(root, of_key, part, &place)),
                        ("additionalProperties", None) if rule == &Value::Bool(false) => {
                            found.push(format!("{place}: not in the schema"));
                        }
                        ("additionalProperties", None) => found.extend(faults(root, rule, part, &place)),
                        _ => {}
                    }
                }
            }
            "items" => {
                for (index, part) in value.as_array().into_iter().flatten().enumerate() {
                    found.extend(faults(root, rule, part, &format!("{place}/{index}")));
                }
            }
            unknown => panic!("teach this check what {unknown} means"),
        }
    }
    found
}

fn is(name: &str, value: &Value) -> bool {
    match name {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "number" => value.is_number(),
        "integer" => value.is_u64() || value.is_i64(),
        "boolean" => value.is_boolean(),
        "null" => value.is_null(),
        unknown => panic!("teach this check what a {unknown} is"),
    }
}

fn faults_of(summary: &Value) -> Vec<String> {
    let schema: Value = serde_json::from_str(SCHEMA).unwrap();
    faults(&schema, &schema, summary, "")
}

#[test]
fn every_summary_keeps_to_the_schema() {
    for validation in [
        fixtures::agreeing(),
        fixtures::defective(),
        fixtures::approximate(),
        fixtures::lonely(),
        fixtures::with_outsider(),
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
        "/agree: -1 is below 0",
        "/verdict: \"fine\" is not one of",
        "/host: not in the schema",
        "/scene: no name",
        "/pairs/0/sensors/0/quantities/2/worst_error/value: \"large\" is not",
    ];
    for start in expected {
        assert!(found.iter().any(|fault| fault.starts_with(start)), "{start}: {found:?}");
    }
    assert_eq!(found.len(), expected.len(), "{found:?}");
}

/// Asserts that no object of a schema may have other keys than those named, and that all of them are always there:
/// readers need not ask.
pub(crate) fn keys_are_closed(schema: &Value) {
    if let Some(properties) = schema.get("properties").and_then(Value::as_object) {
        assert_eq!(schema["additionalProperties"], Value::Bool(false));
        let mut required: Vec<&str> =
            schema["required"].as_array().unwrap().iter().map(|key| key.as_str().unwrap()).collect();
        required.sort_unstable();
        let mut known: Vec<&str> = properties.keys().map(String::as_str).collect();
        known.sort_unstable();
        assert_eq!(required, known);
    }
    let parts: Vec<&Value> = match schema {
        Value::Object(parts) => parts.values().collect(),
        Value::Array(parts) => parts.iter().collect(),
        _ => Vec::new(),
    };
    parts.into_iter().for_each(keys_are_closed);
}

#[test]
fn the_schema_allows_no_other_keys() {
    keys_are_closed(&serde_json::from_str(SCHEMA).unwrap());
}
