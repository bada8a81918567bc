//! The place in a scene file of a place in its text with settings.
//!
//! Settings insert, replace and remove lines, so a line of the changed text is another one in the file, or none. What both
//! have in common is the keys that lead there.

use std::ops::Range;

use toml_edit::{Document, Item, TableLike, Value};

/// What is marked: the key, the value, or the head of a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Mark {
    Key,
    Value,
}

/// Keys and indices that lead to an item, from the root on, as a setting has them: `beam`, `0`, `fan_deg`.
pub(crate) type Way = Vec<String>;

/// Where a place of the changed text comes from.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Origin {
    /// These bytes of the file.
    File(Range<usize>),
    /// Nowhere in the file: a table that settings made, with the keys that lead to it.
    Made(Way),
}

/// Where the bytes `span` of `changed` come from, the text of a file with settings in it; `original` is the file's own text.
pub(crate) fn origin(original: &str, changed: &str, span: &Range<usize>) -> Origin {
    let whole = Origin::File(0..0);
    let (Ok(file), Ok(text)) = (Document::parse(original), Document::parse(changed)) else { return whole };
    let mut way = Way::new();
    let Some((mark, found)) = way_to(text.as_table(), span.start, &mut way) else { return whole };
    match place_of(file.as_table(), &way, mark) {
        // The same number of bytes behind the start: a place within a list or a text.
        Some(place) => {
            let start = place.start + (span.start - found.start).min(place.len());
            Origin::File(start..(start + span.len()).min(place.end).max(start))
        }
        None => Origin::Made(way),
    }
}

/// Follows the keys to the byte `at`; the bytes of the item that has it.
fn way_to(table: &dyn TableLike, at: usize, way: &mut Way) -> Option<(Mark, Range<usize>)> {
    for (name, _) in table.iter() {
        let (key, item) = table.get_key_value(name)?;
        way.push(name.to_string());
        if let Some(place) = key.span().filter(|place| place.contains(&at)) {
            return Some((Mark::Key, place));
        }
        if let Some(found) = way_within(item, at, way) {
            return Some(found);
        }
        way.pop();
    }
    None
}

fn way_within(item: &Item, at: usize, way: &mut Way) -> Option<(Mark, Range<usize>)> {
    let own = |place: Option<Range<usize>>| {
        place.filter(|place| place.contains(&at)).map(|place| (Mark::Value, place))
    };
    match item {
        Item::Table(table) => way_to(table, at, way).or_else(|| own(table.span())),
        Item::ArrayOfTables(tables) => tables.iter().enumerate().find_map(|(index, table)| {
            way.push(index.to_string());
            let found = way_to(table, at, way).or_else(|| own(table.span()));
            if found.is_none() {
                way.pop();
            }
            found
        }),
        Item::Value(Value::InlineTable(table)) => way_to(table, at, way).or_else(|| own(table.span())),
        Item::Value(Value::Array(values)) => {
            let within = values.iter().enumerate().find_map(|(index, value)| {
                let Value::InlineTable(table) = value else { return None };
                way.push(index.to_string());
                let found = way_to(table, at, way).or_else(|| own(table.span()));
                if found.is_none() {
                    way.pop();
                }
                found
            });
            within.or_else(|| own(values.span()))
        }
        item => own(item.span()),
    }
}

/// The bytes of what the keys lead to.
fn place_of(table: &dyn TableLike, way: &[String], mark: Mark) -> Option<Range<usize>> {
    let (name, rest) = way.split_first()?;
    let (key, item) = table.get_key_value(name)?;
    match (rest, mark) {
        ([], Mark::Key) => key.span(),
        (rest, mark) => place_within(item, rest, mark),
    }
}

fn place_within(item: &Item, way: &[String], mark: Mark) -> Option<Range<usize>> {
    let Some((name, rest)) = way.split_first() else { return item.span() };
    let of_element = |table: &dyn TableLike, own: Option<Range<usize>>| {
        if rest.is_empty() { own } else { place_of(table, rest, mark) }
    };
    match item {
        Item::Table(table) => place_of(table, way, mark),
        Item::Value(Value::InlineTable(table)) => place_of(table, way, mark),
        Item::ArrayOfTables(tables) => {
            let table = tables.get(name.parse().ok()?)?;
            of_element(table, table.span())
        }
        Item::Value(Value::Array(values)) => {
            let table = values.get(name.parse().ok()?)?.as_inline_table()?;
            of_element(table, table.span())
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILE: &str = "version = 1\n\n[camera]\nwidth_px = 8 # wide\n\n[[beam]]\nfan_deg = 70\n\n[drive]\nways = [[1, 2], [3, 4]]\nsun = { up = 3 }\n";

    /// The bytes of the file that belong to the place of `part` in the changed text.
    fn text_of(changed: &str, part: &str) -> String {
        let start = changed.find(part).expect("a part of the text");
        match origin(FILE, changed, &(start..start + part.len())) {
            Origin::File(place) => FILE[place].to_string(),
            Origin::Made(way) => format!("made: {}", way.join(".")),
        }
    }

    #[test]
    fn a_place_is_found_by_its_keys_wherever_lines_are_put() {
        let changed = "version = 1\n\n[camera]\nwidth_px = 8 # wide\npitch = 1\nyaw = 2\n\n[[beam]]\nfan_deg = 70\nroll = 9\n\n[drive]\nways = [[1, 2], [3, 4]]\nsun = { up = 3, down = 4 }\n[drive.dust]\nnear = 1\n";
        for part in ["version", "8", "[camera]", "fan_deg", "70", "[[beam]]", "[3, 4]", "up", "[drive]"] {
            assert_eq!(text_of(changed, part), part);
        }
        assert_eq!(text_of(changed, "[drive.dust]"), "made: drive.dust");
        assert_eq!(text_of(changed, "near"), "made: drive.dust.near");
        // A place beyond all items is the file's start.
        assert_eq!(origin(FILE, changed, &(changed.len()..changed.len())), Origin::File(0..0));
    }
}
