//! JUnit documents, for continuous integration that reads test results: suites of cases with their outcomes.

use std::io;

use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};

/// A JUnit document.
///
/// ```
/// use raypencil_report::{JunitCase, JunitReport, JunitSuite};
///
/// let mut suite = JunitSuite::new("yard: tracer against scanline");
/// suite.push(JunitCase::passed("range").with_class("yard.camera"));
/// suite.push(JunitCase::failed("face", "defect", "2 of 9 rays differ").with_text("camera 3,4: face 7"));
/// let mut report = JunitReport::new("raypencil validate yard.toml");
/// report.push(suite);
///
/// let xml = report.to_xml()?;
/// // The document counts its cases: two, of which one fails.
/// assert!(xml.contains("tests=\"2\" skipped=\"0\" failures=\"1\""));
/// assert!(xml.contains("<failure message=\"2 of 9 rays differ\" type=\"defect\">camera 3,4: face 7</failure>"));
/// # Ok::<(), std::io::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct JunitReport {
    name: String,
    suites: Vec<JunitSuite>,
}

impl JunitReport {
    /// A document without suites; `name` is usually the command that was run.
    pub fn new(name: impl Into<String>) -> Self {
        Self { name: name.into(), suites: Vec::new() }
    }

    /// Adds a suite after the others.
    pub fn push(&mut self, suite: JunitSuite) {
        self.suites.push(suite);
    }

    /// The document as XML.
    ///
    /// Control characters other than tab and line end, terminal escapes, U+FFFE and U+FFFF are removed from all texts.
    ///
    /// # Errors
    /// An error of the XML encoder.
    pub fn to_xml(&self) -> io::Result<String> {
        let mut report = Report::new(allowed(&self.name));
        for suite in &self.suites {
            report.add_test_suite(suite.to_test_suite());
        }
        report.to_string().map_err(io::Error::other)
    }
}

/// A suite: cases that belong together.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct JunitSuite {
    name: String,
    cases: Vec<JunitCase>,
}

impl JunitSuite {
    /// A suite without cases.
    pub fn new(name: impl Into<String>) -> Self {
        Self { name: name.into(), cases: Vec::new() }
    }

    /// Adds a case after the others.
    pub fn push(&mut self, case: JunitCase) {
        self.cases.push(case);
    }

    fn to_test_suite(&self) -> TestSuite {
        let mut suite = TestSuite::new(allowed(&self.name));
        suite.add_test_cases(self.cases.iter().map(JunitCase::to_test_case));
        suite
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Outcome {
    Passed,
    Skipped,
    Failed,
}

/// One case: a name and its outcome.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct JunitCase {
    name: String,
    class: Option<String>,
    outcome: Outcome,
    kind: Option<String>,
    message: Option<String>,
    text: Option<String>,
}

impl JunitCase {
    /// A case that passed.
    pub fn passed(name: impl Into<String>) -> Self {
        let (name, outcome) = (name.into(), Outcome::Passed);
        Self { name, class: None, outcome, kind: None, message: None, text: None }
    }

    /// A case that was not decided; `message` is the reason in one line.
    pub fn skipped(name: impl Into<String>, message: impl Into<String>) -> Self {
        Self { outcome: Outcome::Skipped, message: Some(message.into()), ..Self::passed(name) }
    }

    /// A case that failed; `kind` is the kind of failure in one word, `message` the failure in one line.
    pub fn failed(name: impl Into<String>, kind: impl Into<String>, message: impl Into<String>) -> Self {
        Self { outcome: Outcome::Failed, ..Self::skipped(name, message) }.with_kind(kind)
    }

    /// The same case with a class name, dots between its parts, by which readers of JUnit group cases.
    pub fn with_class(self, class: impl Into<String>) -> Self {
        Self { class: Some(class.into()), ..self }
    }

    /// The same case with the kind of its failure or of its reason to be skipped, in one word.
    pub fn with_kind(self, kind: impl Into<String>) -> Self {
        Self { kind: Some(kind.into()), ..self }
    }

    /// The same case with a text of several lines; a case that passed does not show it.
    pub fn with_text(self, text: impl Into<String>) -> Self {
        Self { text: Some(text.into()), ..self }
    }

    fn to_test_case(&self) -> TestCase {
        let mut status = match self.outcome {
            Outcome::Passed => TestCaseStatus::success(),
            Outcome::Skipped => TestCaseStatus::skipped(),
            Outcome::Failed => TestCaseStatus::non_success(NonSuccessKind::Failure),
        };
        // A status of success has none of these three.
        if self.outcome != Outcome::Passed {
            if let Some(message) = &self.message {
                status.set_message(allowed(message));
            }
            if let Some(kind) = &self.kind {
                status.set_type(allowed(kind));
            }
            if let Some(text) = &self.text {
                status.set_description(allowed(text));
            }
        }
        let mut case = TestCase::new(allowed(&self.name), status);
        if let Some(class) = &self.class {
            case.set_classname(allowed(class));
        }
        case
    }
}

/// A text without U+FFFE and U+FFFF, which XML forbids. (XML 1.0, section 2.2) `quick-junit` removes control characters
/// and terminal escapes, but not these two.
fn allowed(text: &str) -> String {
    text.replace(['\u{fffe}', '\u{ffff}'], "")
}
