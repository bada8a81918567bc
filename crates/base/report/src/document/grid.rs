//! A table of a document.

use std::borrow::Cow;

use crate::table::{Align, Table};

use super::room::{Medium, Room, is_shown};

/// A column.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Column {
    /// Its head; the head of the first column may be empty.
    pub head: Cow<'static, str>,
    /// Texts stand left, numbers right.
    pub align: Align,
    /// Where it is shown.
    pub room: Room,
    /// Whether its cells are commands.
    pub is_code: bool,
}

impl Column {
    /// A column of texts.
    pub fn text(head: impl Into<Cow<'static, str>>) -> Self {
        Self { head: head.into(), align: Align::Left, room: Room::Everywhere, is_code: false }
    }

    /// A column of commands.
    pub fn code(head: impl Into<Cow<'static, str>>) -> Self {
        Self { is_code: true, ..Self::text(head) }
    }

    /// A column of numbers.
    pub fn number(head: impl Into<Cow<'static, str>>) -> Self {
        Self { head: head.into(), align: Align::Right, room: Room::Everywhere, is_code: false }
    }

    /// The same column, on pages and in Markdown only.
    pub fn wide(self) -> Self {
        Self { room: Room::Wide, ..self }
    }
}

/// A row.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Row {
    pub(super) cells: Vec<String>,
    /// Whether something in it is wrong.
    pub(super) fails: bool,
    pub(super) room: Room,
}

/// Columns and rows. A column without any entry is left out.
///
/// ```
/// use raypencil_report::{Column, Grid};
///
/// let mut grid = Grid::new([Column::text("quantity"), Column::number("defect"), Column::number("ulp")]);
/// grid.row(["range", "1", ""], true);
/// grid.row(["depth", "", ""], false);
/// // No ulp is known. An entry that is missing among others is a dash.
/// assert_eq!(grid.to_table().to_string(), "quantity  defect\nrange          1\ndepth          -\n");
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Grid {
    columns: Vec<Column>,
    rows: Vec<Row>,
}

impl Grid {
    /// A table without rows.
    pub fn new(columns: impl IntoIterator<Item = Column>) -> Self {
        Self { columns: columns.into_iter().collect(), rows: Vec::new() }
    }

    /// Adds a row below the others. An empty cell has no entry.
    ///
    /// # Panics
    /// If it has not one cell for each column.
    pub fn row<T: Into<String>>(&mut self, cells: impl IntoIterator<Item = T>, fails: bool) {
        self.row_with_room(cells, fails, Room::Everywhere);
    }

    /// The same row, where it has room.
    ///
    /// # Panics
    /// If it has not one cell for each column.
    pub fn row_with_room<T: Into<String>>(
        &mut self,
        cells: impl IntoIterator<Item = T>,
        fails: bool,
        room: Room,
    ) {
        let cells: Vec<String> = cells.into_iter().map(Into::into).collect();
        assert_eq!(cells.len(), self.columns.len(), "cells of a row");
        self.rows.push(Row { cells, fails, room });
    }

    /// The rows that a medium shows.
    pub(super) fn rows(&self, medium: Medium) -> impl Iterator<Item = &Row> {
        self.rows.iter().filter(move |row| is_shown(row.room, medium))
    }

    /// The columns that have an entry, with their indices; those that a medium shows.
    pub(super) fn shown(&self, medium: Medium) -> Vec<(usize, &Column)> {
        let has_entry = |index: usize| self.rows(medium).any(|row| !row.cells[index].is_empty());
        let columns = self.columns.iter().enumerate();
        columns.filter(|(index, column)| has_entry(*index) && is_shown(column.room, medium)).collect()
    }

    /// The table for a screen.
    pub fn to_table(&self) -> Table {
        self.to_table_with(|name| name.to_string())
    }

    /// The same with other names of rows.
    pub(super) fn to_table_with(&self, named: impl Fn(&str) -> String) -> Table {
        let shown = self.shown(Medium::Screen);
        let mut table = Table::new(shown.iter().map(|(_, column)| column.align));
        if has_heads(&shown) {
            table.row(shown.iter().map(|(_, column)| column.head.as_ref()));
        }
        for row in self.rows(Medium::Screen) {
            table.row(shown.iter().map(|(index, _)| match row.cells[*index].as_str() {
                name if *index == 0 => named(name),
                "" => "-".into(),
                cell => cell.to_string(),
            }));
        }
        table
    }
}

/// Whether a column has a head; names and values need none.
pub(super) fn has_heads(shown: &[(usize, &Column)]) -> bool {
    shown.iter().any(|(_, column)| !column.head.is_empty())
}
