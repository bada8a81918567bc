//! A file with its mutants: each is an arm of a `match` of the number of now.

use std::collections::BTreeMap;
use std::ops::Range;

use crate::places::{Form, Mutant, Source};

/// The name of the function that gives the number of now, and of its variable.
const NOW: &str = "crate::mutant_of_now()";

/// What every mutated crate gets: the number of now, which is read once.
pub(crate) const NUMBER_OF_NOW: &str = r#"
static MUTANT_OF_NOW: core::sync::atomic::AtomicU32 = core::sync::atomic::AtomicU32::new(u32::MAX);
#[cold]
#[inline(never)]
fn read_mutant_of_now() -> u32 {
    let number = std::env::var("MUTANT").ok().and_then(|text| text.parse().ok()).unwrap_or(0);
    MUTANT_OF_NOW.store(number, core::sync::atomic::Ordering::Relaxed);
    number
}
#[inline(always)]
pub(crate) fn mutant_of_now() -> u32 {
    let number = MUTANT_OF_NOW.load(core::sync::atomic::Ordering::Relaxed);
    if number == u32::MAX { read_mutant_of_now() } else { number }
}
"#;

/// What every mutated crate begins with: a mutant may be code that nobody would write.
pub(crate) const ALLOWED: &str =
    "#![allow(warnings, arithmetic_overflow, unconditional_panic, overflowing_literals)] ";

/// A file as it was written, and where its mutants are.
#[derive(Debug, Default)]
pub(crate) struct Written {
    pub(crate) text: String,
    /// The bytes of the code of each mutant.
    pub(crate) codes: Vec<(u32, Range<usize>)>,
    /// The bytes of each place, with its mutants.
    pub(crate) places: Vec<(Vec<u32>, Range<usize>)>,
}

impl Written {
    /// The mutants that an error at a byte of the file is about: that whose code is there, or else all of the innermost
    /// place around it.
    pub(crate) fn at(&self, byte: usize) -> Vec<u32> {
        if let Some((number, _)) = self.codes.iter().find(|(_, bytes)| bytes.contains(&byte)) {
            return vec![*number];
        }
        let around = self.places.iter().filter(|(_, bytes)| bytes.contains(&byte));
        around.min_by_key(|(_, bytes)| bytes.len()).map_or(vec![], |(numbers, _)| numbers.clone())
    }

    /// The mutant whose code is at a byte of the file.
    pub(crate) fn code_at(&self, byte: usize) -> Option<u32> {
        self.codes.iter().find(|(_, bytes)| bytes.contains(&byte)).map(|(number, _)| *number)
    }
}

/// All numbers but these, as a pattern.
fn all_but(numbers: &[u32]) -> String {
    let mut parts = Vec::new();
    let mut from = 0;
    for &number in numbers {
        if number > from {
            parts.push(format!("{from}..={}", number - 1));
        }
        from = number + 1;
    }
    parts.push(format!("{from}.."));
    parts.join(" | ")
}

/// Writes a file with the mutants of these numbers. Lines keep their numbers.
pub(crate) fn write(number: usize, source: &Source, live: &[(u32, &Mutant)]) -> Written {
    let mut of_place: BTreeMap<usize, Vec<(u32, usize)>> = BTreeMap::new();
    for (id, mutant) in live.iter().filter(|(_, mutant)| mutant.source == number) {
        of_place.entry(mutant.place).or_default().push((*id, mutant.change));
    }
    // What is inserted: the byte; an end before a start; of two starts the outer one first, of two ends the inner one.
    let mut marks: Vec<(usize, bool, isize, usize)> = Vec::new();
    for &place in of_place.keys() {
        let bytes = &source.places[place].bytes;
        let order = isize::try_from(place).expect("few places");
        marks.push((bytes.start, true, order, place));
        if source.places[place].form != Form::Body {
            marks.push((bytes.end, false, -order, place));
        }
    }
    marks.sort_unstable();

    let mut written = Written::default();
    let mut starts: BTreeMap<usize, usize> = BTreeMap::new();
    let mut copied = 0;
    for (byte, is_start, _, index) in marks {
        written.text.push_str(&source.text[copied..byte]);
        copied = byte;
        let place = &source.places[index];
        let changes = &of_place[&index];
        let numbers: Vec<u32> = changes.iter().map(|(id, _)| *id).collect();
        let from = written.text.len();
        if is_start {
            starts.insert(index, from);
        }
        match (place.form, is_start) {
            (Form::Expression, true) => {
                written.text.push_str(&format!("(match {NOW} {{ {} => (", all_but(&numbers)));
            }
            (Form::Expression, false) => {
                written.text.push(')');
                for (k, (id, change)) in changes.iter().enumerate() {
                    let pattern = if k + 1 == changes.len() { "_".into() } else { id.to_string() };
                    written.text.push_str(&format!(", {pattern} => "));
                    let from = written.text.len();
                    // In parentheses: `a < b` alone could be taken for the start of generics.
                    written.text.push_str(&format!("({})", place.changes[*change].code));
                    written.codes.push((*id, from..written.text.len()));
                }
                written.text.push_str(" })");
            }
            (Form::Body, _) => {
                written.text.push_str(&format!(" match {NOW} {{ "));
                for (id, change) in changes {
                    written.text.push_str(&format!("{id} => "));
                    let from = written.text.len();
                    written.text.push_str(&format!("return ({})", place.changes[*change].code));
                    written.codes.push((*id, from..written.text.len()));
                    written.text.push_str(", ");
                }
                written.text.push_str("_ => {} } ");
            }
            (Form::Guarded, true) => {
                written.text.push_str(&format!("{NOW} != {} && (", numbers[0]));
            }
            (Form::Guarded, false) => written.text.push(')'),
            (Form::Arm, true) => {}
            (Form::Arm, false) => written.text.push_str(&format!(" if {NOW} != {}", numbers[0])),
        }
        if !is_start || place.form == Form::Body {
            written.places.push((numbers, starts[&index]..written.text.len()));
        }
    }
    written.text.push_str(&source.text[copied..]);
    written
}
