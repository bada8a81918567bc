//! JSON documents against their schemas.

use jsonschema::Validator;
use serde_json::Value;

/// Everything in `document` that `schema` does not allow, or that it requires and the document lacks: place and reason.
///
/// # Panics
/// If `schema` is not a JSON schema.
pub fn schema_faults(schema: &Value, document: &Value) -> Vec<String> {
    let validator: Validator = jsonschema::validator_for(schema).expect("a JSON schema");
    validator.iter_errors(document).map(|error| format!("{}: {error}", error.instance_path())).collect()
}

/// Asserts that no object of a schema may have other keys than those named, and that all of them are always there:
/// readers need not ask.
pub fn assert_keys_are_closed(schema: &Value) {
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
    parts.into_iter().for_each(assert_keys_are_closed);
}
