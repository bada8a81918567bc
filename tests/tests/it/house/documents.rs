//! The documents: each link leads somewhere, and each page of `docs` is in the book.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Component, Path, PathBuf};

use super::source::root;

/// The Markdown files below a folder, without what builds leave and what is hidden.
pub(super) fn pages(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        // A link would be followed in a circle; what it leads to is looked at where it lies.
        if path.is_symlink()
            || name.starts_with('.')
            || ["target", "out", "node_modules"].contains(&name.as_str())
        {
            continue;
        }
        if path.is_dir() {
            pages(&path, found);
        } else if name.ends_with(".md") {
            found.push(path);
        }
    }
}

/// The lines of a page that are no code. What stands between backticks is taken out.
fn prose(text: &str) -> String {
    let mut fence: Option<String> = None;
    let mut kept = String::new();
    for line in text.lines() {
        let start = line.trim_start();
        let marks: String = start.chars().take_while(|letter| *letter == '`' || *letter == '~').collect();
        match &fence {
            Some(open) if start.trim_end() == open => fence = None,
            Some(_) => {}
            None if marks.len() >= 3 => fence = Some(marks),
            None => {
                kept.push_str(line);
                kept.push('\n');
            }
        }
    }
    let mut out = String::new();
    let mut rest = kept.as_str();
    while let Some(at) = rest.find('`') {
        out.push_str(&rest[..at]);
        let marks = rest[at..].chars().take_while(|letter| *letter == '`').count();
        let after = &rest[at + marks..];
        // A span ends with as many marks as it began with; in a heading its words count.
        let Some(end) = after.find(&"`".repeat(marks)) else { break };
        out.push_str(&after[..end].replace("](", "] ("));
        rest = &after[end + marks..];
    }
    out + rest
}

/// The targets of a page's links and pictures.
fn links(text: &str) -> Vec<String> {
    let text = prose(text);
    let starts = text.match_indices("](").map(|(at, _)| &text[at + 2..]);
    let inline = starts.filter_map(|rest| rest.split([')', ' ', '\n']).next());
    inline.map(|target| target.trim_matches(['<', '>']).to_string()).collect()
}

/// The anchors of a page's headings, as GitHub and mdBook form them.
fn anchors(text: &str) -> BTreeSet<String> {
    let mut counts: BTreeMap<String, u32> = BTreeMap::new();
    let mut found = BTreeSet::new();
    for line in prose(text).lines().filter(|line| line.starts_with('#')) {
        let title = line.trim_start_matches('#').trim();
        // Of a link only its words are in the anchor.
        let mut words = String::new();
        let mut in_target = false;
        for letter in title.replace("](", "\u{0}").chars() {
            match letter {
                '\u{0}' => in_target = true,
                ')' if in_target => in_target = false,
                _ if in_target => {}
                ' ' => words.push('-'),
                _ if letter.is_alphanumeric() || "-_".contains(letter) => words.extend(letter.to_lowercase()),
                _ => {}
            }
        }
        let count = counts.entry(words.clone()).or_insert(0);
        found.insert(if *count == 0 { words } else { format!("{words}-{count}") });
        *count += 1;
    }
    found
}

/// A path without `.` and `..`.
fn plain(path: &Path) -> PathBuf {
    let mut out = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir => drop(out.pop()),
            Component::CurDir => {}
            part => out.push(part),
        }
    }
    out
}

/// What is wrong with a link on a page, if anything is.
fn fault(page: &Path, target: &str) -> Option<String> {
    if ["https://", "http://", "mailto:"].iter().any(|scheme| target.starts_with(scheme)) {
        return None;
    }
    let (path, anchor) = target.split_once('#').unwrap_or((target, ""));
    let file = match path {
        "" => page.to_path_buf(),
        path => plain(&page.parent().expect("a page is in a folder").join(path)),
    };
    if !file.exists() {
        return Some("leads nowhere".into());
    }
    if !file.starts_with(root()) {
        return Some("leads out of the repository".into());
    }
    if anchor.is_empty() {
        return None;
    }
    let text = fs::read_to_string(&file).ok()?;
    let anchors = anchors(&text);
    (!anchors.contains(anchor)).then(|| format!("there is no such heading; there are {anchors:?}"))
}

#[test]
fn each_link_leads_somewhere() {
    let mut all = Vec::new();
    pages(&root(), &mut all);
    let (mut count, mut found) = (0, Vec::new());
    for page in &all {
        for target in links(&fs::read_to_string(page).expect("a page")) {
            count += 1;
            if let Some(fault) = fault(page, &target) {
                found.push(format!("{}: {target} {fault}", page.strip_prefix(root()).unwrap().display()));
            }
        }
    }
    assert!(found.is_empty(), "{found:#?}");
    // A test that sees no link sees no broken one.
    assert!(all.len() > 80 && count > 300, "{} pages with {count} links", all.len());
}

#[test]
fn each_page_is_in_the_book_once() {
    let docs = root().join("docs");
    let summary = fs::read_to_string(docs.join("SUMMARY.md")).expect("docs/SUMMARY.md");
    let mut listed: Vec<PathBuf> = links(&summary).iter().map(|target| docs.join(target)).collect();
    let mut all = Vec::new();
    pages(&docs, &mut all);
    all.retain(|page| !page.ends_with("SUMMARY.md"));
    all.sort();
    listed.sort();
    assert_eq!(listed, all);
    // The index lists them too: each page, but of the command line the first alone.
    let index: BTreeSet<PathBuf> = links(&fs::read_to_string(docs.join("README.md")).expect("the index"))
        .iter()
        .map(|target| plain(&docs.join(target)))
        .collect();
    let of_commands = docs.join("reference/commands");
    for page in all.iter().filter(|page| !page.starts_with(&of_commands) && !page.ends_with("docs/README.md"))
    {
        assert!(index.contains(page), "docs/README.md does not list {}", page.display());
    }
    assert!(index.contains(&of_commands.join("raypencil.md")));
}

#[test]
fn broken_links_are_recognised() {
    let page = root().join("docs/README.md");
    for good in [
        "../README.md",
        "theory/contract.md#loading",
        "https://example.org/x",
        "figures/report.png",
        "theory",
    ] {
        assert_eq!(fault(&page, good), None, "{good}");
    }
    for bad in ["README2.md", "theory/contract.md#loadings", "#nowhere", "../../elsewhere.md"] {
        assert!(fault(&page, bad).is_some(), "{bad}");
    }
    let text = "# A `b_c` [d](e.md), f!\n\n# Twice\n# Twice\n```sh\n# no heading [no](link)\n```\n\
                See [x](y.md#z) and ![p](q.png). `[no](link)`\n";
    assert_eq!(links(text), ["e.md", "y.md#z", "q.png"]);
    let expected = ["a-b_c-d-f", "twice", "twice-1"].map(ToString::to_string);
    assert_eq!(anchors(text), BTreeSet::from(expected));
}
