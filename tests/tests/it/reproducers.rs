//! The reproducer of a failing property: an injected fault must come out as a scene of one face.

use raypencil::harness::{Contender, contender, is_interesting_in_class};
use raypencil::io::{Overrides, load};
use raypencil::judge::Class;
use raypencil_tests::injected_faults::geometry::pyramids;
use raypencil_tests::naive::{Fault, Naive};
use raypencil_tests::reproducers::{commit, reproduce};

#[test]
fn a_failure_leaves_the_smallest_scene_that_shows_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let tracer = contender("tracer").expect("a renderer of the workspace");
    let naive = Contender::from(Naive { fault: Some(Fault::DepthForRange) });
    let line = reproduce(folder.path(), "agree", [&tracer, &naive], &pyramids());
    let file = line.strip_prefix("reproducer: ").and_then(|rest| rest.strip_suffix(", 1 of 224 faces"));
    let loaded =
        load(file.unwrap_or_else(|| panic!("{line}")), &Overrides::default()).expect("a scene").scene;
    assert_eq!(loaded.mesh().faces().len(), 1);
    assert!(is_interesting_in_class([&tracer, &naive], Class::Defect)(&loaded, None));
    let words = std::fs::read_to_string(file.unwrap().replace(".toml", ".md")).expect("its description");
    assert!(words.contains(&commit()) && words.contains("--with tracer,naive"), "{words}");
}

#[test]
fn where_there_is_no_defect_nothing_is_left() {
    let folder = tempfile::tempdir().expect("a folder");
    let [a, b] = ["tracer", "scanline"].map(|name| contender(name).expect("a renderer of the workspace"));
    let line = reproduce(folder.path(), "agree", [&a, &b], &pyramids());
    assert!(line.starts_with("no reproducer"), "{line}");
    assert_eq!(std::fs::read_dir(folder.path()).expect("the folder").count(), 0);
}
