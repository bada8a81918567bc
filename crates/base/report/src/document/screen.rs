//! A document on a terminal.

use std::fmt::Write as _;

use crate::version::VERSION;

use super::grid::Grid;
use super::model::{Block, Document};
use super::room::{Medium, is_shown};

/// How far the later lines of a sentence stand to the right.
const INDENT: &str = "    ";

impl Document {
    /// The document for a terminal, whatever its width.
    pub fn screen(&self) -> String {
        self.screen_of_width(usize::MAX)
    }

    /// The document for a terminal with lines of so many characters: long names lose their beginning, sentences are wrapped.
    /// Commands stay whole, as they are to be copied.
    pub fn screen_of_width(&self, chars: usize) -> String {
        screen(self, chars)
    }
}

/// What was asked, the blocks that have room, and the verdict as the last lines: they stand above the prompt.
fn screen(document: &Document, chars: usize) -> String {
    let question = format!("raypencil {VERSION}: {}", document.question);
    let mut text: String = question.lines().map(|line| without_beginning(line, chars) + "\n").collect();
    for block in &document.blocks {
        let part = of_block(block, chars);
        if !part.is_empty() {
            text.push('\n');
            text += &part;
        }
    }
    let _ = write!(text, "\n{}", wrapped(&document.signed(), chars));
    for remark in &document.remarks {
        text += &wrapped(&format!("  {remark}"), chars);
    }
    text
}

fn of_block(block: &Block, chars: usize) -> String {
    match block {
        Block::Text { lines, room, .. } if is_shown(*room, Medium::Screen) => {
            lines.iter().map(|line| wrapped(line, chars)).collect()
        }
        Block::Table { grid, .. } if grid.rows(Medium::Screen).next().is_some() => table(grid, chars),
        Block::Findings { worst, .. } => {
            let mut text = String::new();
            for one in worst {
                let of = if one.quantity.is_empty() { String::new() } else { format!(", {}", one.quantity) };
                text += &wrapped(&format!("{}{of}: {}", one.place, one.words), chars);
                for more in [&one.what, &one.command].into_iter().filter(|more| !more.is_empty()) {
                    let _ = writeln!(text, "{INDENT}{more}");
                }
            }
            text
        }
        Block::Text { .. } | Block::Table { .. } | Block::Folded { .. } | Block::Pictures { .. } => {
            String::new()
        }
    }
}

/// The table. Where it would be too wide, its columns are less apart; if that is not enough, the names of its rows are
/// shortened.
fn table(grid: &Grid, chars: usize) -> String {
    let whole = grid.to_table();
    if whole.width() <= chars {
        return whole.to_string();
    }
    let whole = whole.with_gap(1);
    let too_wide = whole.width().saturating_sub(chars);
    if too_wide == 0 {
        return whole.to_string();
    }
    let longest = grid.rows(Medium::Screen).map(|row| row.cells[0].chars().count()).max().unwrap_or(0);
    let left = longest.saturating_sub(too_wide).max(1);
    grid.to_table_with(|name| without_beginning(name, left)).with_gap(1).to_string()
}

/// The last `chars` characters of a text, since the end of a path tells more than its beginning.
fn without_beginning(text: &str, chars: usize) -> String {
    let length = text.chars().count();
    if length <= chars {
        return text.to_string();
    }
    format!("…{}", text.chars().skip(length - chars + 1).collect::<String>())
}

/// A sentence in lines of so many characters, the later ones to the right. A word that is longer stays whole.
fn wrapped(sentence: &str, chars: usize) -> String {
    let (mut text, mut length) = (String::new(), 0);
    for (index, word) in sentence.split(' ').enumerate() {
        let word_length = word.chars().count();
        if index > 0 && length + 1 + word_length > chars {
            let _ = write!(text, "\n{INDENT}{word}");
            length = INDENT.len() + word_length;
        } else {
            let blank = usize::from(index > 0);
            text += &" "[..blank];
            text += word;
            length += blank + word_length;
        }
    }
    text.push('\n');
    text
}
