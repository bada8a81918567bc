//! The whole way on a tiny crate, whose mutants can be counted by hand.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

use raypencil_mutants::{Asked, Options, list, row, run};

/// What stays as it is: a constant, a pattern, a type, a macro, a test, `Debug`. What changes is told below.
const LIB: &str = r#"
//! A tiny crate.
mod part;

const HALF: u32 = 1 + 2;

pub struct Two([u32; 1 + 1]);

impl std::fmt::Debug for Two {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(f, "{}", self.0[0 + 1])
    }
}

pub const fn twice(n: u32) -> u32 {
    n + n
}

/// Two changes of `+`, two of `*`; two values.
pub fn linear(a: u32, b: u32) -> u32 {
    debug_assert!(a + b < 100);
    HALF * a +
        b
}

/// One change of `&&`, one of `!`; two values.
pub fn only(a: bool, b: bool) -> bool {
    a && !b
}

/// Each arm but the last may go; a guard is true or false, and `>` is one of three others; four values.
pub fn name(n: Option<u32>) -> Option<String> {
    match n {
        Some(0..=1) => Some("few".into()),
        Some(n) if n > HALF => Some("many".into()),
        _ => None,
    }
}

/// The loop never ends with `*=`. One value.
pub fn count(slice: &[u8], n: &mut u32) {
    for _ in slice {
        let mut k = 0_u32;
        while k == 0 {
            k += 1;
            *n = part::next(*n);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn linear_has_its_value() {
        assert_eq!(linear(2, 5), 1 + 10);
    }

    #[test]
    fn only_one_of_the_two() {
        assert!(only(true, false) && !only(true, true) && !only(false, false));
    }

    #[test]
    fn names_are_few_or_many() {
        let name = |n| name(n).unwrap_or_default();
        assert_eq!([None, Some(1), Some(3), Some(4)].map(name), ["", "few", "", "many"]);
    }

    #[test]
    fn all_are_counted() {
        let mut n = 0;
        count(&[0; 3], &mut n);
        assert_eq!(n, 3);
    }
}
"#;

/// A value of a type without one does not compile. At 7 and beyond nothing is tested.
const PART: &str = r#"
pub(crate) struct Bare;

pub(crate) fn next(n: u32) -> u32 {
    let _ = bare();
    if n < 7 { n + 1 } else { n }
}

fn bare() -> Bare {
    Bare
}
"#;

fn git(folder: &Path, arguments: &[&str]) {
    let command = ["-c", "user.name=tiny", "-c", "user.email=tiny@example.org"];
    let status = Command::new("git").current_dir(folder).args(command).args(arguments).status();
    assert!(status.expect("git").success(), "{arguments:?}");
}

#[test]
fn a_tiny_crate_has_so_many_mutants_and_its_tests_miss_one_kind() {
    let folder = tempfile::tempdir().expect("a folder");
    let root = folder.path();
    let write = |name: &str, text: &str| {
        let path = root.join(name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("folders");
        fs::write(path, text).expect("a file");
    };
    write("Cargo.toml", "[workspace]\nresolver = \"3\"\nmembers = [\"crates/*/*\"]\n");
    write(".gitignore", "/out\n/target\n");
    write(
        "crates/base/tiny/Cargo.toml",
        "[package]\nname = \"of-tiny\"\nversion = \"0.0.0\"\nedition = \"2024\"\n",
    );
    write("crates/base/tiny/src/lib.rs", LIB);
    write("crates/base/tiny/src/part.rs", PART);
    git(root, &["init", "--quiet"]);
    git(root, &["add", "."]);
    git(root, &["commit", "--quiet", "-m", "tiny"]);

    let options = Options { name: "tiny".into(), ..Options::default() };
    let all = list(root, &options).expect("a list");
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    for mutant in &all {
        let function = mutant.words.split(": ").nth(1).expect("a function");
        *counts.entry(function).or_default() += 1;
    }
    let expected = [("bare", 1), ("count", 4), ("linear", 6), ("name", 10), ("next", 7), ("only", 4)];
    assert_eq!(counts, BTreeMap::from(expected), "{all:#?}");
    assert_eq!(all.len(), 32);
    let [place, ..] = &all[..] else { unreachable!() };
    let lib = "crates/base/tiny/src/lib.rs";
    assert_eq!(place.words, format!("{lib}:20:5: linear: the body is 0"));
    assert_eq!(all[2].words, format!("{lib}:22:14: linear: `HALF * a + b`: + made -"));

    // A draw is a part of all, and the same each time.
    let some = list(root, &Options { draw: Some(9), ..options.clone() }).expect("a draw");
    let again = list(root, &Options { draw: Some(9), ..options.clone() }).expect("a draw");
    let keys = |of: &[raypencil_mutants::Mutant]| of.iter().map(|of| of.key.clone()).collect::<Vec<_>>();
    assert_eq!((some.len(), keys(&some)), (9, keys(&again)));
    assert!(keys(&some).iter().all(|key| keys(&all).contains(key)));

    // `k += 1` made `-= 1` is caught, since 0 - 1 is refused; made `*= 1` it never ends. `n < 7` made `<= 7` is missed.
    run(root, &options).expect("a run");
    let results = root.join("out/mutants/tiny");
    assert_eq!(row(&results, "tiny").expect("a row"), "| tiny | 32 | 0 | 31 | 29 | 1 | 1 | 1 | 96.8 % |");
    let record = fs::read_to_string(results.join("outcomes.tsv")).expect("the record");
    let missed: Vec<&str> = record.lines().filter_map(|line| line.strip_prefix("missed\t\t")).collect();
    assert_eq!(missed, ["crates/base/tiny/src/part.rs: next: `n < 7`: < made <="]);
    assert!(record.contains("caught\ttests::linear_has_its_value\t"), "{record}");
    assert!(record.contains(
        "timeout\ttests::all_are_counted\tcrates/base/tiny/src/lib.rs: count: `k += 1`: += made *="
    ));
    assert!(record.contains("unviable\tthe compiler\tcrates/base/tiny/src/part.rs: bare: "));

    // What has a result is not asked again; what was missed is, when a test is added for it.
    run(root, &options).expect("a second run");
    assert_eq!(fs::read_to_string(results.join("outcomes.tsv")).expect("the record"), record);
    let told = "#[test]\nfn it_stays_at_7() { assert_eq!(next(7), 7); }\n";
    write("crates/base/tiny/src/part.rs", &format!("{PART}{told}"));
    git(root, &["commit", "--quiet", "--all", "-m", "test"]);
    run(root, &Options { asked: Asked::Missed, ..options }).expect("another run");
    assert_eq!(row(&results, "tiny").expect("a row"), "| tiny | 32 | 0 | 31 | 30 | 1 | 1 | 0 | 100.0 % |");

    // Without a mutant all tests must pass.
    write("crates/base/tiny/src/part.rs", &PART.replace("n + 1", "n + 2"));
    git(root, &["commit", "--quiet", "--all", "-m", "wrong"]);
    let options = Options { name: "tiny".into(), ..Options::default() };
    let refused = run(root, &options).expect_err("a failure").to_string();
    assert!(refused.contains("without a mutant the tests do not pass"), "{refused}");
}
