//! Draws random wrong renderers and counts the reasons that are false:
//!
//! ```text
//! cargo run --profile test -p raypencil-diagnosis --features examples --example wrong_renderers -- 500 1
//! ```
//!
//! The arguments: how many, and the first seed. Each false reason is printed with its seed; exit code 1 if there is one.
//! With a third argument, all that is told is printed.

// Tests use the rest of it.
#[allow(dead_code)]
#[path = "../tests/it/candidates.rs"]
mod candidates;
#[path = "../tests/it/wrong_renderers/mod.rs"]
mod wrong_renderers;

use candidates::{pyramids, walls};
use wrong_renderers::wrong::draw;

fn main() -> std::process::ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let number = |index: usize, other: u64| {
        arguments.get(index).map_or(other, |word| word.parse().expect("a whole number"))
    };
    let (count, first) = (number(0, 500), number(1, 1));
    let (mut told, mut silent, mut reasons, mut all_false) = (0, 0, 0, 0);
    for seed in first..first + count {
        let bench = if seed % 3 == 0 { walls() } else { pyramids() };
        let wrong = draw(bench, seed);
        let found = bench.diagnosis(&wrong.candidate);
        match &found {
            Some(found) => {
                told += 1;
                reasons += found.reasons.len();
            }
            None => silent += 1,
        }
        if let Some(what) = wrong.false_reason(found.as_ref()) {
            all_false += 1;
            println!("seed {seed}: FALSE: {what}");
        } else if arguments.len() > 2 {
            let words = found.map_or("nothing".into(), |found| found.sentence());
            println!("seed {seed}: made {:?}, told: {words}", wrong.made);
        }
    }
    println!(
        "{count} wrong renderers from seed {first}: {told} told {reasons} reasons, {silent} told none; {all_false} false"
    );
    std::process::ExitCode::from(u8::from(all_false > 0))
}
