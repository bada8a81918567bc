//! `docs/evidence/injected-faults.md` is held to the list of faults: each is in the table of its kind, and all are caught.

use std::fs;
use std::path::Path;

use raypencil_tests::files::FileFault;
use raypencil_tests::naive::{Fault, Kind};

/// The faults of a kind, by name, with what each imitates.
fn faults(kind: Kind) -> Vec<(String, &'static str)> {
    let planted = Fault::ALL.iter().filter(|fault| fault.kind() == kind);
    let planted = planted.map(|fault| (format!("{fault:?}"), fault.imitates()));
    let of_files = FileFault::ALL.iter().filter(|_| kind == Kind::Files);
    planted.chain(of_files.map(|fault| (format!("{fault:?}"), fault.imitates()))).collect()
}

#[test]
fn the_page_has_every_fault_and_none_else() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/evidence/injected-faults.md");
    let page = fs::read_to_string(path).expect("the page, as `just planted-faults` writes it");
    for kind in Kind::ALL {
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
        assert_eq!(listed, faults(kind), "{kind}: `just planted-faults` makes the page again");
        for row in &rows {
            // A scene, a count of rays and one of faces.
            assert_eq!(row.len(), 5, "{row:?}");
            assert!(row[2].contains("defect") || row[2].contains("refused"), "{row:?}");
            assert!(row[3].parse::<u64>().is_ok(), "{row:?}");
            assert!(row[4].split(" of ").all(|count| count.parse::<u64>().is_ok()), "{row:?}");
        }
    }
    let count: usize = Kind::ALL.iter().map(|kind| faults(*kind).len()).sum();
    assert!(page.ends_with(&format!("\nCaught: {count} of {count}.\n")), "all of {count} are caught");
    let all = page.lines().find(|line| line.starts_with("| all |")).expect("the totals");
    let median_faces: f64 =
        all.trim_matches('|').rsplit('|').next().unwrap().trim().parse().expect("a number");
    assert!(median_faces <= 4.0, "{median_faces} faces");
}

#[test]
fn every_kind_has_faults() {
    let counts = Kind::ALL.map(|kind| faults(kind).len());
    assert!(counts.iter().all(|count| *count >= 3), "{counts:?}");
}
