//! `summary.json` of a comparison, for programs. `docs/guide/diff.md` lists the keys.

use raypencil_scene::Place;
use serde_json::{Map, Value, json};

use crate::difference::{ChannelDifference, Difference, Sides};
use crate::rulings::{ChannelRuling, Rulings};
use crate::words::class_name;

/// The keys of a difference. A statistic that is not finite is null; a cell's value that is not finite is a string such as
/// `"NaN"`.
pub(crate) fn diff_data(difference: &Difference, sides: &Sides) -> Map<String, Value> {
    let side = |index: usize| {
        let files: Vec<String> =
            sides.channels[index].files.iter().map(|file| file.display().to_string()).collect();
        json!({ "path": sides.names[index], "files": files })
    };
    let thresholds = &difference.thresholds;
    let keys = json!({
        "a": side(0),
        "b": side(1),
        "thresholds": {
            "fail": thresholds.fail,
            "fail_relative": thresholds.fail_relative,
            "fail_ulp": thresholds.fail_ulp,
            "fail_percent": thresholds.fail_percent,
            "hard_fail": thresholds.hard_fail,
            "shared_only": thresholds.shared_only,
        },
        "channels": difference.channels.iter().map(channel).collect::<Vec<_>>(),
        "rulings": difference.rulings.as_ref().map(rulings),
        "only_a": difference.only[0],
        "only_b": difference.only[1],
    });
    match keys {
        Value::Object(keys) => keys,
        _ => Map::new(),
    }
}

/// The referee's rulings, channel by channel.
fn rulings(rulings: &Rulings) -> Value {
    let channel = |(key, ruling): (&String, &ChannelRuling)| {
        let classes = ruling
            .by_class
            .iter()
            .map(|((a, b), cells)| json!({ "a": class_name(*a), "b": class_name(*b), "cells": cells }));
        let wrong = ruling.wrong.iter().map(|cell| {
            let Place { sensor, i, j } = cell.place;
            json!({ "sensor": sensor.to_string(), "column": i, "row": j, "who": cell.who, "what": cell.what })
        });
        json!({
            "key": key,
            "classes": classes.collect::<Vec<_>>(),
            "faults": ruling.faults(),
            "not_judged": ruling.not_judged,
            "first_wrong": wrong.collect::<Vec<_>>(),
        })
    };
    json!({ "channels": rulings.channels.iter().map(channel).collect::<Vec<_>>(), "not_ruled": rulings.not_ruled })
}

fn channel(channel: &ChannelDifference) -> Value {
    let worst = channel.worst.map(
        |worst| json!({ "column": worst.i, "row": worst.j, "a": number(worst.a), "b": number(worst.b) }),
    );
    json!({
        "key": channel.key,
        "fails": channel.fails,
        "columns": channel.width,
        "rows": channel.height,
        "files": channel.files.iter().map(|file| file.display().to_string()).collect::<Vec<_>>(),
        "storage": channel.storage.to_string(),
        "unit": channel.unit,
        "cells": channel.cells(),
        "unequal": channel.unequal,
        "differing": channel.differing,
        "incomparable": channel.incomparable,
        "beyond_hard": channel.beyond_hard,
        "largest": finite(channel.largest),
        "largest_ulp": finite(channel.largest_ulp),
        "rms": finite(channel.rms),
        "mean": finite(channel.mean),
        "worst": worst,
    })
}

/// A statistic; null if it is not finite.
fn finite(value: Option<f64>) -> Option<f64> {
    value.filter(|value| value.is_finite())
}

/// A cell's value. JSON has no number for NaN and infinities, so they are strings.
fn number(value: f64) -> Value {
    match value {
        finite if finite.is_finite() => finite.into(),
        nan if nan.is_nan() => "NaN".into(),
        infinite if infinite > 0.0 => "Infinity".into(),
        _ => "-Infinity".into(),
    }
}
