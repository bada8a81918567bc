//! Cuts of a file, and values in place of others.

use std::ops::Range;

/// What stands in place of a word of a text: its name and itself.
pub(super) fn hostile_words() -> Vec<(&'static str, String)> {
    let words = [
        ("nan", "NaN"),
        ("minus-inf", "-inf"),
        ("overflow", "1e999"),
        ("minus-one", "-1"),
        ("two-to-63", "9223372036854775808"),
        ("two-to-64", "18446744073709551616"),
        ("half", "0.5"),
        ("none", ""),
        ("nested", "[[[0]]]"),
        ("control", "\u{1b}[2J"),
        ("word", "x"),
        ("byte-0", "\0"),
    ];
    let mut words: Vec<_> = words.into_iter().map(|(name, word)| (name, word.to_string())).collect();
    words.push(("long", "9".repeat(1 << 16)));
    words
}

/// What stands in place of a value of TOML: the hostile words, and values of every type.
pub(super) fn hostile_toml() -> Vec<(&'static str, String)> {
    let values = [
        ("not-a-number", "nan"),
        ("infinite", "inf"),
        ("top", "9223372036854775807"),
        ("far", "1e308"),
        ("tiny", "5e-324"),
        ("empty-text", "\"\""),
        ("text", "\"1\""),
        ("codes", "\"\\u001b[2J\""),
        ("list", "[]"),
        ("lists", "[[[0]]]"),
        ("table", "{}"),
        ("true", "true"),
    ];
    let mut all = hostile_words();
    all.extend(values.into_iter().map(|(name, value)| (name, value.to_string())));
    all
}

/// Places of the words of a text, which stand between letters of `separators`.
pub(super) fn places(text: &str, separators: &str) -> Vec<Range<usize>> {
    let mut start = 0;
    let mut found = Vec::new();
    for part in text.split_inclusive(|letter| separators.contains(letter)) {
        let word = part.trim_end_matches(|letter| separators.contains(letter));
        if !word.is_empty() {
            found.push(start..start + word.len());
        }
        start += part.len();
    }
    found
}

/// The text with a part replaced.
pub(super) fn replaced(text: &str, place: Range<usize>, word: &str) -> String {
    [&text[..place.start], word, &text[place.end..]].concat()
}

/// Every second of `values`: the ones of neighbouring places together are all of them, in half the time.
pub(super) fn half_of<T>(values: &[T], place: usize) -> impl Iterator<Item = &T> {
    values.iter().skip(place % 2).step_by(2)
}

/// The text with each word in turn replaced by hostile words, and by each of `others`. A name says the number of the word and what takes its place.
pub(super) fn with_each_word(
    text: &str,
    separators: &str,
    others: &[(&'static str, &str)],
) -> Vec<(String, String)> {
    let words = hostile_words();
    let mut texts = vec![("unchanged".to_string(), text.to_string())];
    for (at, place) in places(text, separators).into_iter().enumerate() {
        let hostile = half_of(&words, at).map(|(name, word)| (*name, word.as_str()));
        for (name, word) in hostile.chain(others.iter().copied()) {
            texts.push((format!("word-{at}-{name}"), replaced(text, place.clone(), word)));
        }
    }
    texts
}

/// The bytes, cut at every second position.
pub(super) fn cut_anywhere(bytes: &[u8]) -> Vec<(String, Vec<u8>)> {
    (0..bytes.len()).step_by(2).map(|at| (format!("cut-at-{at}"), bytes[..at].to_vec())).collect()
}

/// What stands in place of a byte: letters that end or begin something in a text, and bytes that no text has.
const HOSTILE_BYTES: [u8; 6] = [0, 0xff, b'"', b'9', b'-', b'}'];

/// The bytes as they are, and with each of them replaced by three others; which three alternates.
pub(super) fn with_each_byte(bytes: &[u8]) -> Vec<(String, Vec<u8>)> {
    let mut all = vec![("unchanged".to_string(), bytes.to_vec())];
    for (at, &byte) in bytes.iter().enumerate() {
        for &other in half_of(&HOSTILE_BYTES, at).filter(|other| **other != byte) {
            let mut bytes = bytes.to_vec();
            bytes[at] = other;
            all.push((format!("byte-{at}-{other}"), bytes));
        }
    }
    all
}

/// Hostile words that are good numbers of a file whose numbers have no range.
pub(super) const NUMBERS: [&str; 5] = ["four", "half", "minus-one", "two-to-63", "two-to-64"];

/// The number of a replaced word and what took its place, from the name of a case.
pub(super) fn word_of(name: &str) -> Option<(usize, &str)> {
    let (at, what) = name.split_once("-word-")?.1.split_once('-')?;
    Some((at.parse().ok()?, what))
}
