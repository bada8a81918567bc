//! Fuzz target: any text as a file of sets of rays.

#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use raypencil::io::ray_sets_from_text;

/// Sets with larger counts are valid but slow, so that the fuzzer would report a timeout.
const MAX_COUNT: i64 = 99;

fn is_small(value: &toml::Value) -> bool {
    match value {
        toml::Value::Integer(count) => *count <= MAX_COUNT,
        toml::Value::Array(values) => values.iter().all(is_small),
        toml::Value::Table(table) => table.values().all(is_small),
        _ => true,
    }
}

fuzz_target!(|text: &str| {
    let Ok(table) = toml::from_str::<toml::Table>(text) else { return };
    if table.values().all(is_small)
        && let Ok(loaded) = ray_sets_from_text(text, Path::new("no-such-folder/any.toml"))
    {
        for set in &loaded.sets {
            assert_eq!(set.shape.iter().product::<u64>(), set.set.rays().len() as u64);
        }
    }
});
