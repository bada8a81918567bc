//! One document, five writers: the same words everywhere, each part where it has room, names that are not to be trusted.

use raypencil_report::{
    Block, Column, DefectGroup, DefectLine, Document, Grid, JunitCase, JunitSuite, Outcome, Room,
};

const EVIL: &str = "<b>a|b</b> `x`";

fn line() -> DefectLine {
    DefectLine {
        place: "camera 3,4".into(),
        quantity: "range".into(),
        words: format!("{EVIL} says 2 m"),
        what: "a hit on another face".into(),
        links: vec![("whole scene", "wrong/a.toml".into())],
        command: format!("raypencil probe {}.toml --pixel 3,4", "a-long-name/".repeat(12)),
        ..DefectLine::default()
    }
}

/// A document with every kind of block.
fn document() -> Document {
    let columns = [Column::text(""), Column::number("compared"), Column::number("defect")];
    let more = [Column::number("ulp"), Column::text("stored as").wide(), Column::code("again").wide()];
    let mut grid = Grid::new(columns.into_iter().chain(more));
    grid.row(["range", "1,024", "1", "", "half", "raypencil a|b"], true);
    grid.row(["depth", "not given", "", "", "", ""], false);
    grid.row([EVIL, "3", "0", "", EVIL, EVIL], false);
    grid.row_with_room(["page only", "7", "0", "", "", ""], false, Room::Wide);
    let mut suite = JunitSuite::new("yard");
    suite.push(JunitCase::failed("range", "defect", "1 of 1,024"));
    let text = |words: &str, room| Block::Text { title: "", lines: vec![words.into()], room };
    Document {
        run: "raypencil check yard mine".into(),
        question: format!("{EVIL} against the answers to yard"),
        outcome: Outcome::Fails,
        headline: "1 of 1,024 rays is wrong.".into(),
        remarks: vec!["Why: rows are reversed.".into()],
        explanation: Vec::new(),
        counts: Vec::new(),
        facts: vec![("Candidate", EVIL.into())],
        blocks: vec![
            Block::Table { title: "Every quantity", grid },
            text("This stands everywhere.", Room::Everywhere),
            text("This stands on screens.", Room::Screen),
            text("This stands on pages.", Room::Wide),
            Block::Findings {
                title: "Defects",
                groups: vec![DefectGroup {
                    title: "camera: 1 wrong".into(),
                    lines: vec![line()],
                    more: String::new(),
                }],
                worst: vec![line()],
            },
            Block::Pictures { title: "Maps", html: "<img alt=\"map\">".into(), stays: false },
        ],
        suites: vec![suite],
        format: 7,
        verdict: "defects",
        data: [("sentence".to_string(), "told".into())].into_iter().collect(),
        explorer: String::new(),
    }
}

#[test]
fn all_writers_say_the_same() {
    let document = document();
    let (screen, page, markdown) = (document.screen(), document.page().unwrap(), document.markdown());
    let json: serde_json::Value = serde_json::from_str(&document.json()).unwrap();
    assert_eq!(json["headline"], document.headline.as_str());
    assert_eq!(
        (&json["format"], &json["verdict"], &json["sentence"]),
        (&7.into(), &"defects".into(), &"told".into())
    );
    for words in
        ["1 of 1,024 rays is wrong.", "Why: rows are reversed.", "This stands everywhere.", "camera 3,4"]
    {
        for report in [&screen, &page, &markdown] {
            assert!(report.contains(words), "{words}: {report}");
        }
    }
    // The verdict is what a reader sees first: the last lines above a prompt, the first of a page.
    assert!(screen.ends_with("\n✗ 1 of 1,024 rays is wrong.\n  Why: rows are reversed.\n"), "{screen}");
    assert!(page.find("rays is wrong").unwrap() < page.find("Every quantity").unwrap());
    assert!(markdown.starts_with("### ✗ 1 of 1,024 rays is wrong.\n"), "{markdown}");
    assert!(document.junit().unwrap().contains("failures=\"1\""));
    let files = document.files("check.json").unwrap();
    let names: Vec<&str> = files.iter().map(|(name, _)| *name).collect();
    assert_eq!(names, ["report.html", "junit.xml", "summary.md", "check.json"]);
}

#[test]
fn each_part_stands_where_it_has_room() {
    let document = document();
    let (screen, page, markdown) = (document.screen(), document.page().unwrap(), document.markdown());
    let on = |words: &str| [&screen, &page, &markdown].map(|report| report.contains(words));
    assert_eq!(on("This stands on screens."), [true, false, false]);
    assert_eq!(on("This stands on pages."), [false, true, true]);
    assert_eq!(on("page only"), [false, true, true]);
    assert_eq!(on("stored as"), [false, true, true]);
    assert_eq!(on("<img alt=\"map\">"), [false, true, false]);
    // No entry in the whole column.
    assert_eq!(on("ulp"), [false; 3]);
    // A page colours the row that fails, and no other.
    assert_eq!(page.matches("<tr class=\"fails\">").count(), 1);
    assert!(page.contains("<td class=\"defect\">1</td>"));
    let depth: Vec<&str> =
        screen.lines().find(|line| line.starts_with("depth")).unwrap().split("  ").collect();
    assert_eq!((depth[0], depth.last().map(|cell| cell.trim())), ("depth", Some("-")), "{screen}");
    // A document without a verdict has no sign.
    let told = Document { outcome: Outcome::Told, ..document };
    assert!(told.screen().contains("\n\n1 of 1,024 rays is wrong.") && !told.page().unwrap().contains('✗'));
}

#[test]
fn what_a_writer_leaves_out_is_counted() {
    let mut document = document();
    for (count, left_out) in [(9, None), (10, None), (11, Some(1)), (37, Some(27))] {
        let lines = (0..count).map(|k| DefectLine { place: format!("place {k}."), ..line() }).collect();
        let group = DefectGroup { title: "camera".into(), lines, more: String::new() };
        document.blocks = vec![Block::Findings { title: "Defects", groups: vec![group], worst: Vec::new() }];
        let markdown = document.markdown();
        let listed = (0..count).filter(|k| markdown.contains(&format!("place {k}."))).count();
        assert_eq!(listed, count - left_out.unwrap_or(0), "{markdown}");
        let words = left_out.map(|more| format!("\n{more} more are on the page.\n"));
        assert_eq!(markdown.contains("more are on the page"), words.is_some(), "{markdown}");
        assert!(words.is_none_or(|words| markdown.contains(&words)), "{markdown}");
    }
}

#[test]
fn names_are_no_markup() {
    let document = document();
    let (page, markdown) = (document.page().unwrap(), document.markdown());
    assert!(!page.contains("<b>a|b") && page.contains("&#60;b&#62;a|b"), "{page}");
    assert!(page.contains("<a href=\"wrong/a.toml\">whole scene</a>"), "{page}");
    assert!(markdown.contains(r"\<b\>a\|b\</b\> \`x\`"), "{markdown}");
    // A row of a table has as many cells as its head, whatever its texts hold.
    let cells = |line: &&str| line.replace(r"\|", "").matches('|').count();
    let rows: Vec<usize> =
        markdown.lines().filter(|line| line.starts_with('|')).map(|line| cells(&line)).collect();
    assert_eq!(rows, [6; 6]);
}

#[test]
fn a_narrow_screen_cuts_names_and_wraps_sentences_but_no_command() {
    let long = format!("{}the-end", "a-folder/".repeat(20));
    let mut grid = Grid::new([Column::text("channel"), Column::number("cells")]);
    grid.row([long.as_str(), "3"], false);
    let mut document = document();
    document.question = format!("A {long}");
    document.blocks.push(Block::Table { title: "Channels", grid });
    document.blocks.push(Block::Text { title: "", lines: vec!["word ".repeat(60)], room: Room::Everywhere });
    let screen = document.screen_of_width(100);
    let command = line().command;
    for line in screen.lines().filter(|line| !line.contains(&command)) {
        assert!(line.chars().count() <= 100, "{line}");
    }
    assert!(screen.contains(&command), "{screen}");
    // The end of a path tells more than its beginning.
    assert_eq!(screen.matches("/the-end").count(), 2);
    assert_eq!(screen.matches("word").count(), 60);
    assert!(document.screen().contains(&long) && !document.screen().contains('…'));
}
