//! A document and its parts; what is printed without a layout: JUnit and JSON.

use std::io;

use serde_json::{Map, Value, json};

use super::grid::Grid;
use super::room::Room;
use crate::defect_list::{DefectGroup, DefectLine};
use crate::junit::{JunitReport, JunitSuite};
use crate::version::VERSION;

/// The outcome of what a command checked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// Something was checked, and nothing of it is wrong.
    Agrees,
    /// Something is wrong.
    Fails,
    /// Nothing was found wrong, but what was checked proves nothing.
    Open,
    /// Nothing was checked: these are answers.
    Told,
}

impl Outcome {
    /// A sign that does not depend on colour.
    pub fn sign(self) -> &'static str {
        match self {
            Self::Agrees => "✓",
            Self::Fails => "✗",
            Self::Open => "?",
            Self::Told => "",
        }
    }

    /// The class of its colour on a page.
    pub(super) fn colour(self) -> &'static str {
        match self {
            Self::Agrees => "agree",
            Self::Fails => "defects",
            Self::Open => "nothing",
            Self::Told => "",
        }
    }
}

/// A part of a document.
#[derive(Debug, Clone, PartialEq)]
pub enum Block {
    /// Sentences, each a paragraph.
    Text {
        /// Title on pages and in Markdown; empty if it has none.
        title: &'static str,
        /// The sentences.
        lines: Vec<String>,
        /// Where they are printed.
        room: Room,
    },
    /// A table below its title; a screen shows no title.
    Table {
        /// Title on pages and in Markdown.
        title: &'static str,
        /// The rows.
        grid: Grid,
    },
    /// A table that a page shows when its title is opened, and that is shown nowhere else.
    Folded {
        /// Title on the page.
        title: &'static str,
        /// The rows.
        grid: Grid,
    },
    /// What is wrong, one by one.
    Findings {
        /// Title on pages and in Markdown.
        title: &'static str,
        /// All that is listed, by where it is.
        groups: Vec<DefectGroup>,
        /// The worst of them all, which a screen shows.
        worst: Vec<DefectLine>,
    },
    /// Pictures as HTML, which only a page shows.
    Pictures {
        /// Title on the page.
        title: &'static str,
        /// The pictures.
        html: String,
        /// Whether they stay where the explorer works; else it shows all of them, and more.
        stays: bool,
    },
}

/// A number with its name, which pages show large and Markdown in one line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Count {
    /// The number.
    pub number: String,
    /// Its name.
    pub name: &'static str,
    /// What it counts.
    pub meaning: &'static str,
    /// Whether it counts what is wrong.
    pub is_bad: bool,
}

/// What a command found.
///
/// ```
/// use raypencil_report::{Block, Document, JunitCase, JunitSuite, Outcome, Room};
///
/// let mut suite = JunitSuite::new("yard: mine");
/// suite.push(JunitCase::passed("range"));
/// let document = Document {
///     run: "raypencil check yard mine".into(),
///     question: "mine against the answers to yard".into(),
///     outcome: Outcome::Agrees,
///     headline: "128 rays agree.".into(),
///     remarks: vec![],
///     explanation: vec![],
///     counts: vec![],
///     facts: vec![("Candidate", "mine".into())],
///     blocks: vec![Block::Text { title: "", lines: vec!["Depths are not given.".into()], room: Room::Everywhere }],
///     suites: vec![suite],
///     format: 1,
///     verdict: "agrees",
///     data: Default::default(),
///     explorer: String::new(),
/// };
/// // The last line of a screen is the verdict; a page begins with it.
/// assert!(document.screen().ends_with("Depths are not given.\n\n✓ 128 rays agree.\n"));
/// assert!(document.page()?.contains("<h1><span aria-hidden=\"true\">✓</span> 128 rays agree.</h1>"));
/// assert!(document.markdown().starts_with("### ✓ 128 rays agree.\n"));
/// assert!(document.junit()?.contains("tests=\"1\""));
/// assert!(document.json().contains("\"verdict\": \"agrees\""));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Document {
    /// What was run, such as `raypencil check yard mine`.
    pub run: String,
    /// What was asked, in one line; a screen shows further lines below it.
    pub question: String,
    /// What became of it.
    pub outcome: Outcome,
    /// The same in one sentence, with its full stop.
    pub headline: String,
    /// Sentences that belong to the verdict, such as the mistake that explains it.
    pub remarks: Vec<String>,
    /// Further sentences below the verdict, on pages and in Markdown.
    pub explanation: Vec<String>,
    /// Numbers that are seen first; a screen shows none of them.
    pub counts: Vec<Count>,
    /// Names and values of what was asked.
    pub facts: Vec<(&'static str, String)>,
    /// The parts, in order.
    pub blocks: Vec<Block>,
    /// Test results for continuous integration.
    pub suites: Vec<JunitSuite>,
    /// Number of the format of `data`. It grows when a key changes its meaning or goes away.
    pub format: u32,
    /// The outcome in one word, for programs.
    pub verdict: &'static str,
    /// What was found, for programs. The keys `format`, `version`, `verdict` and `headline` are added where they are missing.
    pub data: Map<String, Value>,
    /// Data, style and script of the part of the page that answers when asked; empty if there is none.
    pub explorer: String,
}

impl Document {
    /// The first line of the question.
    pub(super) fn asked(&self) -> &str {
        self.question.lines().next().unwrap_or_default()
    }

    /// The headline after the sign, if there is one.
    pub(super) fn signed(&self) -> String {
        format!("{} {}", self.outcome.sign(), self.headline).trim_start().to_string()
    }

    /// The document as JUnit.
    ///
    /// # Errors
    /// An error of the XML encoder.
    pub fn junit(&self) -> io::Result<String> {
        let mut report = JunitReport::new(self.run.as_str());
        self.suites.iter().for_each(|suite| report.push(suite.clone()));
        report.to_xml()
    }

    /// The document for programs.
    pub fn json(&self) -> String {
        let mut all = json!({
            "format": self.format,
            "version": VERSION,
            "verdict": self.verdict,
            "headline": self.headline,
        });
        if let Value::Object(keys) = &mut all {
            keys.extend(self.data.clone());
        }
        format!("{all:#}\n")
    }

    /// Every file of the document by its name: `report.html`, `junit.xml`, `summary.md`, and last that of its data.
    ///
    /// # Errors
    /// An error of the template or the XML encoder, with the name of the file.
    pub fn files(
        &self,
        data_name: &'static str,
    ) -> Result<Vec<(&'static str, String)>, (&'static str, io::Error)> {
        let page = self.page().map_err(|error| ("report.html", io::Error::other(error)))?;
        let junit = self.junit().map_err(|error| ("junit.xml", error))?;
        Ok(vec![
            ("report.html", page),
            ("junit.xml", junit),
            ("summary.md", self.markdown()),
            (data_name, self.json()),
        ])
    }
}
