//! A document as a comment on a pull request.

use std::fmt::Write as _;

use crate::defect_list::DefectLine;
use crate::table::Align;
use crate::version::VERSION;

use super::grid::{Column, Grid};
use super::model::{Block, Document};
use super::room::{Medium, is_shown};

/// Maximum number of findings that are listed.
const MAX_LISTED: usize = 10;

impl Document {
    /// The document as a comment on a pull request.
    pub fn markdown(&self) -> String {
        markdown(self)
    }
}

fn markdown(document: &Document) -> String {
    let mut text = format!("### {}\n", markdown_text(&document.signed()));
    for remark in document.remarks.iter().chain(&document.explanation) {
        let _ = write!(text, "\n{}\n", markdown_text(remark));
    }
    let _ = write!(text, "\nraypencil {VERSION}: {}\n\n", markdown_text(document.asked()));
    for (name, value) in &document.facts {
        let _ = writeln!(text, "* {name}: {}", markdown_code(value));
    }
    if !document.counts.is_empty() {
        let counts: Vec<String> =
            document.counts.iter().map(|count| format!("{} {}", count.number, count.name)).collect();
        let _ = writeln!(text, "* Rays: {}", markdown_text(&counts.join(", ")));
    }
    for block in &document.blocks {
        match block {
            Block::Text { title, lines, room } if is_shown(*room, Medium::Markdown) && !lines.is_empty() => {
                if !title.is_empty() {
                    let _ = write!(text, "\n**{title}**\n");
                }
                lines.iter().for_each(|line| {
                    // Four blanks would make code of it.
                    let _ = write!(text, "\n{}\n", markdown_text(line.trim_start()));
                });
            }
            Block::Table { title, grid } if grid.rows(Medium::Markdown).next().is_some() => {
                let _ = write!(text, "\n**{title}**\n\n{}", table(grid));
            }
            Block::Findings { title, groups, .. } => {
                let all = groups.iter().map(|group| group.lines.len()).sum::<usize>();
                let lines: Vec<&DefectLine> =
                    groups.iter().flat_map(|group| &group.lines).take(MAX_LISTED).collect();
                if lines.is_empty() {
                    continue;
                }
                let _ = write!(text, "\n**{title}**\n\n");
                lines.iter().for_each(|line| text.push_str(&finding(line)));
                if all > lines.len() {
                    let _ = write!(text, "\n{} more are on the page.\n", all - lines.len());
                }
                for group in groups.iter().filter(|group| !group.more.is_empty()) {
                    let _ =
                        write!(text, "\n{}: {}\n", markdown_text(&group.title), markdown_text(&group.more));
                }
            }
            Block::Text { .. } | Block::Table { .. } | Block::Folded { .. } | Block::Pictures { .. } => {}
        }
    }
    text
}

fn finding(line: &DefectLine) -> String {
    let of = if line.quantity.is_empty() { String::new() } else { format!(", {}", line.quantity) };
    let mut text = format!("1. {}", markdown_text(&format!("{}{of}: {}", line.place, line.words)));
    if !line.command.is_empty() {
        let _ = write!(text, "<br>{}", markdown_code(&line.command));
    }
    text + "\n"
}

fn table(grid: &Grid) -> String {
    let shown = grid.shown(Medium::Markdown);
    let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
    let mut text = line(shown.iter().map(|(_, column)| markdown_text(&column.head)).collect());
    let rule = |align: Align| if align == Align::Left { "---" } else { "---:" }.to_string();
    text += &line(shown.iter().map(|(_, column)| rule(column.align)).collect());
    for row in grid.rows(Medium::Markdown) {
        let cell = |(index, column): &(usize, &Column)| match row.cells[*index].as_str() {
            code if column.is_code && !code.is_empty() => markdown_code(code).replace('|', "\\|"),
            words => markdown_text(words),
        };
        text += &line(shown.iter().map(cell).collect());
    }
    text
}

/// Text with its markup escaped: a candidate's name is not to be trusted.
///
/// ```
/// assert_eq!(raypencil_report::markdown_text("a|b <i>"), "a\\|b \\<i\\>");
/// ```
pub fn markdown_text(text: &str) -> String {
    text.chars()
        .flat_map(|c| {
            let is_markup = "\\`*_[]<>|&~".contains(c);
            is_markup.then_some('\\').into_iter().chain([if c.is_control() { ' ' } else { c }])
        })
        .collect()
}

/// A code span, with a fence longer than any run of backticks in the text.
///
/// ```
/// use raypencil_report::markdown_code;
///
/// assert_eq!(markdown_code("pyramids"), "`pyramids`");
/// assert_eq!(markdown_code("a`b"), "`` a`b ``");
/// ```
pub fn markdown_code(text: &str) -> String {
    let longest = text.split(|character| character != '`').map(str::len).max().unwrap_or(0);
    let fence = "`".repeat(longest + 1);
    let pad = if longest > 0 { " " } else { "" };
    format!("{fence}{pad}{}{pad}{fence}", text.replace(['\n', '\r'], " "))
}
