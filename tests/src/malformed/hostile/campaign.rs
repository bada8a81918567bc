//! Hostile records of campaigns: the result of a shard, which a merge reads, and the record of a terrain, from which a run goes
//! on.

use raypencil::campaign::Campaign;
use raypencil::campaign::records::sealed;
use serde_json::{Value, json};

use super::Family;
use super::edits::{cut_anywhere, half_of};
use crate::malformed::case::Case;

/// What stands in place of a value: its name and its JSON, or what is none.
fn hostile_values() -> Vec<(&'static str, String)> {
    let values = [
        ("nan", "NaN"),
        ("overflow", "1e999"),
        ("minus-one", "-1"),
        ("minus-half", "-0.5"),
        ("half", "0.5"),
        ("two-to-63", "9223372036854775808"),
        ("two-to-64", "18446744073709551616"),
        ("no-value", ""),
        ("null", "null"),
        ("true", "true"),
        ("empty-text", "\"\""),
        ("codes", "\"\\u001b[2J\""),
        ("half-a-letter", "\"\\ud800\""),
        ("nested", "[[[0]]]"),
        ("object", "{\"a\":0}"),
    ];
    let mut values: Vec<_> = values.into_iter().map(|(name, value)| (name, value.to_string())).collect();
    values.push(("deep", "[".repeat(100_000)));
    values.push(("long", format!("\"{}\"", "x".repeat(1 << 15))));
    values
}

/// A record whose numbers fit together.
fn record(terrain: u64) -> Value {
    let worst = json!({ "value": 1e-12, "sensor": "camera", "i": 1, "j": 2 });
    let part = |part: &str| {
        json!({
            "part": part, "compared": 60, "hits": 30, "by_class": [50, 3, 2, 3, 1, 1], "not_compared": 4, "judged": 10,
            "quantities": [{
                "quantity": "range", "by_class": [30, 0, 0, 0, 0, 0], "not_compared": 0,
                "worst_error": worst, "worst_ratio": worst,
            }],
            "wrong": [{ "sensor": "beam-0", "i": 3, "j": 1, "quantity": "range", "what": "1 m and 2 m" }],
            "candidate": "tracer", "failed": "it stopped",
        })
    };
    let parts: Vec<Value> = ["own", "paper", "aimed", "lattice"].map(part).to_vec();
    json!({ "terrain": terrain, "faces": 2, "parts": parts })
}

/// The text of a file with the digest of its contents, if it has contents.
fn with_digest(text: String) -> String {
    sealed(text.as_bytes()).unwrap_or(text)
}

/// Places to change: each key of an object, and the first of a list. Four scenes have the same keys; one is changed.
fn places(value: &Value, pointer: &str, found: &mut Vec<String>) {
    match value {
        Value::Object(keys) => {
            // Whether there is a commit depends on the build; the number of cases must not.
            for (key, value) in keys.iter().filter(|(key, _)| *key != "commit") {
                found.push(format!("{pointer}/{key}"));
                places(value, &format!("{pointer}/{key}"), found);
            }
        }
        Value::Array(values) => {
            if let Some(first) = values.first() {
                found.push(format!("{pointer}/0"));
                places(first, &format!("{pointer}/0"), found);
            }
        }
        _ => {}
    }
}

/// The file's text with the value of a place replaced by a text, JSON or not.
fn with(file: &Value, place: &str, text: &str) -> String {
    let mut file = file.clone();
    *file.pointer_mut(place).expect("a place of the file") = "@".into();
    file.to_string().replacen("\"@\"", text, 1)
}

/// The file's text with one place after the other changed, sealed anew where that is possible.
fn changed(file: &Value) -> Vec<(String, String)> {
    let mut all = Vec::new();
    places(file, "", &mut all);
    let values = hostile_values();
    let mut texts = Vec::new();
    texts.push(("unchanged".into(), with_digest(file.to_string())));
    for (at, place) in all.into_iter().enumerate() {
        let name = place.trim_start_matches('/').replace(['/', '_'], "-");
        // A digest that is put right would hide what stands in its own place, or in that of the format.
        let seal =
            |text| if ["/sha256", "/format"].contains(&place.as_str()) { text } else { with_digest(text) };
        for (what, value) in half_of(&values, at) {
            texts.push((format!("{name}-{what}"), seal(with(file, &place, value))));
        }
        let (parent, key) = place.rsplit_once('/').expect("a place below the top");
        let value = file.pointer(&place).expect("a place of the file").to_string();
        if let Some(Value::Object(_)) = file.pointer(parent) {
            let mut without = file.clone();
            without.pointer_mut(parent).and_then(Value::as_object_mut).map(|keys| keys.remove(key));
            texts.push((format!("{name}-left-out"), with_digest(without.to_string())));
            let twice = with(file, &place, &format!("{value},\"{key}\":{value}"));
            texts.push((format!("{name}-twice"), with_digest(twice)));
            let beside = with(file, &place, &format!("{value},\"surplus\":0"));
            texts.push((format!("{name}-surplus"), with_digest(beside)));
        }
        // A count one higher, with its own digest and with the old one; more than any count may be.
        if let Some(number) = file.pointer(&place).and_then(Value::as_u64) {
            let more = (number + 1).to_string();
            let text = sealed(file.to_string().as_bytes()).expect("a good file");
            let whole: Value = serde_json::from_str(&text).expect("JSON");
            texts.push((format!("{name}-unsealed"), with(&whole, &place, &more)));
            texts.push((format!("{name}-one-more"), seal(with(file, &place, &more))));
            texts.push((format!("{name}-too-many"), seal(with(file, &place, "4398046511105"))));
        }
    }
    texts
}

/// The file before it is sealed.
fn unsealed(campaign: &Value, contents: Value) -> Value {
    json!({ "format": 3, "campaign": campaign, "sha256": "", "contents": contents })
}

/// A result of half a campaign of two terrains.
fn result(campaign: &Value, index: u64) -> Value {
    unsealed(campaign, json!({ "shard": { "index": index, "count": 2 }, "terrains": [record(index)] }))
}

/// The results of both halves of a campaign of two terrains, for a program that writes `campaign` into its own.
pub(super) fn sealed_results(campaign: &Value) -> [String; 2] {
    [0, 1].map(|index| sealed(result(campaign, index).to_string().as_bytes()).expect("a good file"))
}

/// Hostile results, for a program that writes `campaign` into its own: two terrains of any seed.
pub fn campaign_records(campaign: &Value) -> Family {
    let [first, second] = sealed_results(campaign);
    let mut cases = Vec::new();
    let mut add = |name: String, bytes: Vec<u8>| {
        let (file, run) = ("b/shard-2-of-2.json", "campaign merge a b -o out");
        let mut case = Case::of_file(&format!("campaign-{name}"), "a changed record", run, file, bytes, "")
            .file("a/shard-1-of-2.json", first.clone());
        case.words = vec!["shard-2-of-2.json".into()];
        cases.push(case);
    };
    for (name, text) in changed(&result(campaign, 1)) {
        add(name, text.into_bytes());
    }
    for (name, bytes) in cut_anywhere(second.as_bytes()).into_iter().step_by(32) {
        add(name, bytes);
    }
    Family { is_good, ..Family::of(cases) }
}

/// Good files as seeds of a fuzz target: the record of terrain 3 of four, and the result of all of a campaign.
pub(crate) fn good() -> Vec<(&'static str, Vec<u8>)> {
    let campaign =
        |terrains| serde_json::to_value(Campaign::new(5, terrains)).expect("JSON of numbers and texts");
    let whole = json!({ "shard": { "index": 0, "count": 1 }, "terrains": [record(0), record(1)] });
    let files = [("record", unsealed(&campaign(4), record(3))), ("result", unsealed(&campaign(2), whole))];
    let text = |file: Value| sealed(file.to_string().as_bytes()).expect("a good file").into_bytes();
    files.map(|(name, file)| (name, text(file))).to_vec()
}

/// Hostile records of terrain 1 of a campaign: each with its name, and whether it is right to go on from it.
pub fn hostile_record(campaign: &Value) -> Vec<(String, Vec<u8>, bool)> {
    let file = unsealed(campaign, record(1));
    let good = sealed(file.to_string().as_bytes()).expect("a good file");
    let texts = changed(&file).into_iter().map(|(name, text)| (name, text.into_bytes()));
    let cuts = cut_anywhere(good.as_bytes()).into_iter().step_by(16);
    texts
        .chain(cuts)
        .map(|(name, bytes)| {
            let good = is_good(&name);
            (name, bytes, good)
        })
        .collect()
}

fn is_good(name: &str) -> bool {
    // Texts and the size of an error are free; what may be left out may be null.
    let is_free =
        |key: &str, values: &[&str]| name.split_once(key).is_some_and(|(_, value)| values.contains(&value));
    let absent = ["null", "left-out"];
    name.ends_with("unchanged")
        // Nothing in place of the only quantity leaves an empty list.
        || name.ends_with("-quantities-0-no-value")
        || is_free("-worst-error-", &absent)
        || is_free("-worst-ratio-", &absent)
        || is_free("-value-", &["half", "two-to-63", "two-to-64", "null", "left-out"])
        || is_free("-candidate-", &["empty-text", "codes", "null", "left-out"])
        || is_free("-failed-", &["empty-text", "codes", "null", "left-out"])
        || is_free("-what-", &["empty-text", "codes"])
        // These counts need not fit to another one.
        || ["faces", "hits", "not-compared", "judged", "quantities-0-by-class-0", "-i", "-j"]
            .iter()
            .any(|count| name.strip_suffix("-one-more").is_some_and(|key| key.ends_with(count)))
}
