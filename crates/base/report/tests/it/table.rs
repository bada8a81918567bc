//! Tables for screens: alignment, gaps, columns that are taken out.

use raypencil_report::{Align, Table};

fn table() -> Table {
    let mut table = Table::new([Align::Left, Align::Right, Align::Left]);
    table.row(["", "agree", "at"]);
    table.row(["range", "12", "camera 3,4"]);
    table.row(["µ", "1,024", ""]);
    table
}

#[test]
fn columns_are_as_wide_as_their_widest_cell() {
    // A letter of two bytes is one character, and no line ends in blanks.
    let lines = ["       agree  at", "range     12  camera 3,4", "µ      1,024"];
    assert_eq!(table().lines(), lines);
    assert_eq!(table().to_string(), format!("{}\n", lines.join("\n")));
    // 5 + 2 + 5 + 2 + 10 characters.
    assert_eq!(table().width(), 24);
}

#[test]
fn the_gap_and_the_least_widths_can_be_chosen() {
    let table = table().with_gap(1).with_min_widths([7, 0, 0]);
    assert_eq!(table.lines()[1], "range      12 camera 3,4");
    assert_eq!(table.width(), 7 + 1 + 5 + 1 + 10);
}

#[test]
fn a_column_can_be_taken_out() {
    let mut table = table();
    table.remove_column(2);
    assert_eq!(table.lines(), ["       agree", "range     12", "µ      1,024"]);
    assert_eq!(Table::new([Align::Left]).to_string(), "");
}
