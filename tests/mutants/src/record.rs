//! What came out: a line for each run of a mutant, in the order of the runs.

use std::collections::{BTreeMap, HashMap};
use std::fs::{self, OpenOptions};
use std::io::Write;
use std::path::Path;

use crate::Result;

/// What became of a mutant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Outcome {
    /// A test failed.
    Caught,
    /// The tests did not end in time.
    Timeout,
    /// All tests passed.
    Missed,
    /// It does not compile.
    Unviable,
}

impl Outcome {
    const ALL: [(Self, &'static str); 4] = [
        (Self::Caught, "caught"),
        (Self::Timeout, "timeout"),
        (Self::Missed, "missed"),
        (Self::Unviable, "unviable"),
    ];

    fn name(self) -> &'static str {
        Self::ALL.iter().find(|(outcome, _)| *outcome == self).map_or("", |(_, name)| name)
    }
}

/// The record of a crate.
pub(crate) struct Record {
    file: fs::File,
    /// The first and the last outcome of each mutant, by its key.
    pub(crate) of: HashMap<String, (Outcome, Outcome)>,
}

impl Record {
    pub(crate) fn open(results: &Path) -> Result<Self> {
        let path = results.join("outcomes.tsv");
        let of = read(&path)?;
        // Two parts that run at the same time write whole lines, each at the end.
        let file = OpenOptions::new().create(true).append(true).open(path)?;
        Ok(Self { file, of })
    }

    /// Adds what became of a mutant, and the test that told it.
    pub(crate) fn add(&mut self, key: &str, outcome: Outcome, test: &str) -> Result<()> {
        self.file.write_all(format!("{}\t{test}\t{key}\n", outcome.name()).as_bytes())?;
        let of = self.of.entry(key.to_string()).or_insert((outcome, outcome));
        of.1 = outcome;
        Ok(())
    }
}

fn read(path: &Path) -> Result<HashMap<String, (Outcome, Outcome)>> {
    let mut of: HashMap<String, (Outcome, Outcome)> = HashMap::new();
    let text = if path.exists() { fs::read_to_string(path)? } else { String::new() };
    for line in text.lines() {
        let mut parts = line.splitn(3, '\t');
        let (Some(name), Some(_), Some(key)) = (parts.next(), parts.next(), parts.next()) else { continue };
        let Some((outcome, _)) = Outcome::ALL.iter().find(|(_, of)| *of == name) else { continue };
        of.entry(key.to_string()).or_insert((*outcome, *outcome)).1 = *outcome;
    }
    Ok(of)
}

/// The head of the table of scores.
pub const HEAD: &str = "\
| crate | drawn | without result | viable | caught | timeouts | missed at first | missed now | score |
| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |";

/// The row of a crate: what its record in this folder says of the mutants that are drawn now.
pub fn row(results: &Path, name: &str) -> Result<String> {
    let drawn = results.join("drawn.tsv");
    if !drawn.exists() {
        return Ok(format!("| {name} | not yet run | | | | | | | |"));
    }
    let of = read(&results.join("outcomes.tsv"))?;
    let text = fs::read_to_string(drawn)?;
    let mut first: BTreeMap<Outcome, usize> = BTreeMap::new();
    let mut last: BTreeMap<Outcome, usize> = BTreeMap::new();
    let (mut count, mut without) = (0, 0);
    for line in text.lines() {
        let Some(key) = line.split('\t').nth(1) else { continue };
        count += 1;
        match of.get(key) {
            None => without += 1,
            Some((at_first, now)) => {
                *first.entry(*at_first).or_insert(0) += 1;
                *last.entry(*now).or_insert(0) += 1;
            }
        }
    }
    let [caught, timeouts, missed] =
        [Outcome::Caught, Outcome::Timeout, Outcome::Missed].map(|of| last.get(&of).copied().unwrap_or(0));
    // A mutant that never ends counts as caught. One that does not compile is not viable.
    let viable = caught + timeouts + missed;
    let score = match viable {
        0 => String::new(),
        _ => format!("{:.1} %", 100.0 * (caught + timeouts) as f64 / viable as f64),
    };
    let at_first = first.get(&Outcome::Missed).copied().unwrap_or(0);
    Ok(format!(
        "| {name} | {count} | {without} | {viable} | {caught} | {timeouts} | {at_first} | {missed} | {score} |"
    ))
}
