//! Tables for screens: columns of text, aligned by blanks.

use std::fmt;

/// Side of a column on which its cells are aligned.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Align {
    /// Cells start at the left edge: texts.
    Left,
    /// Cells end at the right edge: numbers.
    Right,
}

/// A column's alignment and minimum width.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Column {
    align: Align,
    min_width: usize,
}

/// Rows of text in aligned columns. Each column is as wide as its widest cell; widths are in characters.
///
/// ```
/// use raypencil_report::{Align, Table};
///
/// let mut table = Table::new([Align::Left, Align::Right]);
/// table.row(["", "rays"]);
/// table.row(["agree", "1,024"]);
/// table.row(["tie", "3"]);
/// // Two columns of 5 characters each, with the default gap of two blanks.
/// assert_eq!(table.to_string(), "        rays\nagree  1,024\ntie        3\n");
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Table {
    columns: Vec<Column>,
    rows: Vec<Vec<String>>,
    gap: usize,
}

impl Table {
    /// A table without rows, with these columns and a gap of two blanks between them.
    pub fn new(columns: impl IntoIterator<Item = Align>) -> Self {
        let column = |align| Column { align, min_width: 0 };
        Self { columns: columns.into_iter().map(column).collect(), rows: Vec::new(), gap: 2 }
    }

    /// The same table with `gap` blanks between columns.
    pub fn with_gap(mut self, gap: usize) -> Self {
        self.gap = gap;
        self
    }

    /// The same table with columns at least this wide; further columns keep their minimum.
    pub fn with_min_widths(mut self, widths: impl IntoIterator<Item = usize>) -> Self {
        for (column, min_width) in self.columns.iter_mut().zip(widths) {
            column.min_width = min_width;
        }
        self
    }

    /// Adds a row below the others.
    ///
    /// # Panics
    /// If it has not one cell for each column.
    pub fn row<T: Into<String>>(&mut self, cells: impl IntoIterator<Item = T>) {
        let cells: Vec<String> = cells.into_iter().map(Into::into).collect();
        assert_eq!(cells.len(), self.columns.len(), "cells of a row");
        self.rows.push(cells);
    }

    /// Takes out column `index`, counted from 0.
    ///
    /// # Panics
    /// If there is no such column.
    pub fn remove_column(&mut self, index: usize) {
        self.columns.remove(index);
        for row in &mut self.rows {
            row.remove(index);
        }
    }

    /// Width of the table with its gaps, characters.
    pub fn width(&self) -> usize {
        self.widths().iter().sum::<usize>() + self.gap * self.columns.len().saturating_sub(1)
    }

    /// The rows as lines, without blanks at their ends.
    pub fn lines(&self) -> Vec<String> {
        let widths = self.widths();
        let line = |row: &Vec<String>| {
            let cells = row.iter().zip(&self.columns).zip(&widths);
            let cells = cells.map(|((cell, column), &width)| match column.align {
                Align::Left => format!("{cell:<width$}"),
                Align::Right => format!("{cell:>width$}"),
            });
            let line = cells.collect::<Vec<_>>().join(&" ".repeat(self.gap));
            line.trim_end().to_string()
        };
        self.rows.iter().map(line).collect()
    }

    fn widths(&self) -> Vec<usize> {
        let width = |(index, column): (usize, &Column)| {
            let widest = self.rows.iter().map(|row| row[index].chars().count()).max();
            column.min_width.max(widest.unwrap_or(0))
        };
        self.columns.iter().enumerate().map(width).collect()
    }
}

/// The rows as lines, each with a line feed.
impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.lines().iter().try_for_each(|line| writeln!(f, "{line}"))
    }
}
