//! A document as HTML.

use askama::Template;

use crate::defect_list::defect_list;
use crate::page::page_head;
use crate::table::Align;
use crate::version::VERSION;

use super::grid::{Grid, has_heads};
use super::model::{Block, Document};
use super::room::{Medium, is_shown};

#[derive(Template)]
#[template(path = "document.html")]
struct Page<'a> {
    head: String,
    colour: &'static str,
    sign: &'static str,
    document: &'a Document,
    blocks: Vec<Part<'a>>,
    version: &'static str,
}

/// A block, ready for the template.
enum Part<'a> {
    Text { title: &'static str, lines: &'a [String] },
    Table { title: &'static str, folded: bool, heads: Vec<Head<'a>>, rows: Vec<RowOfPage<'a>> },
    Findings { title: &'static str, html: String },
    Pictures { title: &'static str, html: &'a str, stays: bool },
}

struct Head<'a> {
    words: &'a str,
    is_text: bool,
}

struct RowOfPage<'a> {
    fails: bool,
    first: &'a str,
    cells: Vec<CellOfPage<'a>>,
}

struct CellOfPage<'a> {
    words: &'a str,
    is_text: bool,
    is_code: bool,
    /// Whether it counts what is wrong: it is then coloured in a row that fails.
    is_wrong: bool,
}

impl Document {
    /// The document as one HTML file that links to nothing.
    ///
    /// # Errors
    /// An error of the template.
    pub fn page(&self) -> Result<String, askama::Error> {
        page(self)
    }
}

fn page(document: &Document) -> Result<String, askama::Error> {
    let sign = document.outcome.sign();
    let blocks: Vec<Option<Part<'_>>> = document.blocks.iter().map(part).collect::<Result<_, _>>()?;
    Page {
        // With what was asked: of several pages that are open the tabs tell which is which.
        head: page_head(&format!("{} {}", document.signed(), document.asked()), ""),
        colour: document.outcome.colour(),
        sign,
        document,
        blocks: blocks.into_iter().flatten().collect(),
        version: VERSION,
    }
    .render()
}

/// A block, or `None` if it has nothing to show.
fn part(block: &Block) -> Result<Option<Part<'_>>, askama::Error> {
    Ok(match block {
        Block::Text { title, lines, room } if is_shown(*room, Medium::Page) && !lines.is_empty() => {
            Some(Part::Text { title, lines })
        }
        Block::Table { title, grid } if grid.rows(Medium::Page).next().is_some() => {
            Some(table(title, grid, false))
        }
        Block::Folded { title, grid } if grid.rows(Medium::Page).next().is_some() => {
            Some(table(title, grid, true))
        }
        Block::Findings { title, groups, .. } => Some(Part::Findings { title, html: defect_list(groups)? }),
        Block::Pictures { title, html, stays } if !html.is_empty() => {
            Some(Part::Pictures { title, html, stays: *stays })
        }
        Block::Text { .. } | Block::Table { .. } | Block::Folded { .. } | Block::Pictures { .. } => None,
    })
}

fn table<'a>(title: &'static str, grid: &'a Grid, folded: bool) -> Part<'a> {
    let shown = grid.shown(Medium::Page);
    let rows = grid.rows(Medium::Page).map(|row| RowOfPage {
        fails: row.fails,
        first: &row.cells[0],
        cells: shown
            .iter()
            .filter(|(index, _)| *index > 0)
            .map(|(index, column)| CellOfPage {
                words: &row.cells[*index],
                is_text: column.align == Align::Left,
                is_code: column.is_code,
                is_wrong: matches!(column.head.as_ref(), "defect" | "wrong" | "differ"),
            })
            .collect(),
    });
    Part::Table {
        title,
        folded,
        rows: rows.collect(),
        heads: shown
            .iter()
            .filter(|_| has_heads(&shown))
            .map(|(_, column)| Head { words: &column.head, is_text: column.align == Align::Left })
            .collect(),
    }
}
