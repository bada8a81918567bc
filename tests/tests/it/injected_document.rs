//! `docs/evidence/injected-faults.md` against the list of faults: each is in the table of its kind, and all are caught.

use std::fs;
use std::path::Path;

use raypencil_tests::injected_faults::files::FileFault;
use raypencil_tests::naive::{Fault, FaultKind};

/// The names of the faults of a kind, and the mistakes that they imitate.
fn faults(kind: FaultKind) -> Vec<(String, &'static str)> {
    let injected = Fault::ALL.iter().filter(|fault| fault.kind() == kind);
    let injected = injected.map(|fault| (format!("{fault:?}"), fault.imitates()));
    let of_files = FileFault::ALL.iter().filter(|_| kind == FaultKind::Files);
    injected.chain(of_files.map(|fault| (format!("{fault:?}"), fault.imitates()))).collect()
}

#[test]
fn the_page_lists_exactly_the_faults() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/evidence/injected-faults.md");
    let page = fs::read_to_string(path).expect("the page, as `just injected-faults` writes it");
    for kind in FaultKind::ALL {
        let name = kind.to_string();
        let heading = format!("\n## {}{}\n", name[..1].to_uppercase(), &name[1..]);
        let (_, section) = page.split_once(&heading).unwrap_or_else(|| panic!("a section {heading}"));
        let section = section.split("\n## ").next().unwrap();
        let rows: Vec<Vec<&str>> = section
            .lines()
            .filter(|line| line.starts_with("| `"))
            .map(|line| line.trim_matches('|').split(" | ").map(str::trim).collect())
            .collect();
        let listed: Vec<(String, &str)> =
            rows.iter().map(|row| (row[0].trim_matches('`').to_string(), row[1])).collect();
        assert_eq!(listed, faults(kind), "{kind}: `just injected-faults` writes the page again");
        for row in &rows {
            // A scene, a count of rays and one of faces.
            assert_eq!(row.len(), 5, "{row:?}");
            assert!(row[2].contains("defect") || row[2].contains("refused"), "{row:?}");
            assert!(row[3].parse::<u64>().is_ok(), "{row:?}");
            assert!(row[4].split(" of ").all(|count| count.parse::<u64>().is_ok()), "{row:?}");
        }
    }
    let count: usize = FaultKind::ALL.iter().map(|kind| faults(*kind).len()).sum();
    assert!(page.ends_with(&format!("\nCaught: {count} of {count}.\n")), "all of {count} are caught");
    let all = page.lines().find(|line| line.starts_with("| all |")).expect("the totals");
    let median_faces: f64 =
        all.trim_matches('|').rsplit('|').next().unwrap().trim().parse().expect("a number");
    assert!(median_faces <= 4.0, "{median_faces} faces");
}

#[test]
fn every_kind_has_faults() {
    let counts = FaultKind::ALL.map(|kind| faults(kind).len());
    assert!(counts.iter().all(|count| *count >= 3), "{counts:?}");
}
