//! JUnit documents: counts, outcomes, characters that XML forbids.

use raypencil_report::{JunitCase, JunitReport, JunitSuite};

#[test]
fn a_document_has_its_suites_cases_and_counts() {
    let mut suite = JunitSuite::new("yard: a against b");
    suite.push(JunitCase::passed("range").with_class("yard.a-b.camera"));
    suite.push(JunitCase::skipped("flux", "not compared"));
    suite.push(JunitCase::skipped("depth", "only in A").with_kind("missing"));
    suite.push(JunitCase::failed("face", "defect", "1 of 2 rays").with_text("camera 3,4\n    probe"));
    suite.push(JunitCase::failed("something is compared", "nothing_compared", "nothing"));
    let mut report = JunitReport::new("raypencil check");
    report.push(suite);
    let expected = r#"<?xml version="1.0" encoding="UTF-8"?>
<testsuites name="raypencil check" tests="5" skipped="2" failures="2" errors="0">
    <testsuite name="yard: a against b" tests="5" skipped="2" errors="0" failures="2">
        <testcase name="range" classname="yard.a-b.camera"/>
        <testcase name="flux">
            <skipped message="not compared"/>
        </testcase>
        <testcase name="depth">
            <skipped message="only in A" type="missing"/>
        </testcase>
        <testcase name="face">
            <failure message="1 of 2 rays" type="defect">camera 3,4
    probe</failure>
        </testcase>
        <testcase name="something is compared">
            <failure message="nothing" type="nothing_compared"/>
        </testcase>
    </testsuite>
</testsuites>
"#;
    assert_eq!(report.to_xml().unwrap(), expected);
}

#[test]
fn characters_that_xml_forbids_are_removed_and_others_escaped() {
    let mut suite = JunitSuite::new("s");
    suite.push(
        JunitCase::failed("a\u{0}<b>", "k", "\u{1b}[31mred\u{1b}[0m \"q\"").with_text("x\u{ffff}&y\u{7}"),
    );
    let mut report = JunitReport::new("r");
    report.push(suite);
    let xml = report.to_xml().unwrap();
    assert!(xml.contains("<testcase name=\"a&lt;b&gt;\">"), "{xml}");
    assert!(xml.contains("message=\"red &quot;q&quot;\""), "{xml}");
    assert!(xml.contains(">x&amp;y</failure>"), "{xml}");
}
