//! Head and end of every HTML report: one file without links to others.

use crate::text::escaped;
use crate::version::VERSION;

/// CSS of every report.
const STYLE: &str = include_str!("../templates/style.css");

/// What a page may load: nothing but what it holds itself.
const POLICY: &str =
    "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data: blob:";

/// Start of a page up to and including `<main>`, with title, style and the version of raypencil.
///
/// `title` is plain text; `more_style` is CSS that only this page needs. [`PAGE_END`] ends the page.
///
/// ```
/// let page = raypencil_report::page_head("a < b", "") + raypencil_report::PAGE_END;
/// assert!(page.starts_with("<!DOCTYPE html>") && page.ends_with("</html>\n"));
/// // The title is text: its `<` is escaped.
/// assert!(page.contains("<title>a &lt; b</title>"));
/// ```
pub fn page_head(title: &str, more_style: &str) -> String {
    let title = escaped(title);
    format!(
        r#"<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<meta http-equiv="Content-Security-Policy" content="{POLICY}">
<meta name="generator" content="raypencil {VERSION}">
<title>{title}</title>
<style>
{STYLE}{more_style}</style>
</head>
<body>
<main>
"#
    )
}

/// End of a page that [`page_head`] began.
pub const PAGE_END: &str = "</main>\n</body>\n</html>\n";
