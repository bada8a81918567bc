//! Headings of CSV files that stand in a comment, as NumPy's `savetxt` writes them.

use std::ops::RangeInclusive;

/// The words of a comment that is meant as a heading, each with its unit: as many as a row has numbers, whatever stands between
/// them, and of half of a row's numbers or more `is_name` knows the name. `None`: it is a comment of another kind.
///
/// ```
/// use raypencil_files::heading_in_comment;
///
/// let words = |comment| heading_in_comment(comment, 3..=3, |name| ["t", "x", "y"].contains(&name));
/// assert_eq!(words("# t [s] x y").unwrap(), ["t [s]", "x", "y"]);
/// assert_eq!(words("#t/s; x/m; z").unwrap(), ["t/s", "x/m", "z"]);
/// assert_eq!(words("# x and y of the tip"), None);
/// ```
pub fn heading_in_comment(
    comment: &str,
    columns: RangeInclusive<usize>,
    is_name: impl Fn(&str) -> bool,
) -> Option<Vec<String>> {
    let text = comment.trim().trim_start_matches('#').trim();
    let separators: &[char] = if text.contains([',', ';']) { &[',', ';'] } else { &[' ', '\t'] };
    let mut words: Vec<String> = Vec::new();
    for word in text.split(separators).map(|word| word.trim().trim_matches(['"', '\'']).trim()) {
        let is_of_blanks = !separators.contains(&',');
        match words.last_mut() {
            // A unit after a blank.
            Some(last) if is_of_blanks && word.starts_with(['[', '(']) => *last += &format!(" {word}"),
            _ if is_of_blanks && word.is_empty() => {}
            _ => words.push(word.to_string()),
        }
    }
    let without_unit = |word: &str| word.split([' ', '[', '(', '/']).next().unwrap_or_default().to_string();
    // A unit is one word; a comment that says what the columns are has more.
    let is_short = words.iter().all(|word| word.split_whitespace().count() <= 2);
    let named = words.iter().filter(|word| is_name(&without_unit(word))).count();
    (columns.contains(&words.len()) && is_short && 2 * named >= *columns.start()).then_some(words)
}
