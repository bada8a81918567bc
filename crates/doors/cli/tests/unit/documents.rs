//! The commands on the pages: each line of a block of shell that calls this program is one that it understands.

use std::path::{Path, PathBuf};

use super::{fault, shell_words::shell_words};

/// The Markdown files of the repository that people read.
fn pages(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
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

/// The commands of a page's blocks of shell that call this program, each with the number of its line.
fn commands(page: &str) -> Vec<(usize, String)> {
    let (mut is_shell, mut is_code) = (false, false);
    let mut found: Vec<(usize, String)> = Vec::new();
    let mut goes_on = false;
    for (k, line) in page.lines().enumerate() {
        let line = line.trim();
        if let Some(language) = line.strip_prefix("```") {
            is_code = !is_code;
            is_shell = is_code && ["sh", "bash", "shell"].contains(&language);
            continue;
        }
        let text = line.strip_suffix('\\').unwrap_or(line);
        if goes_on {
            found.last_mut().expect("a command to go on with").1.push_str(text);
        } else if is_shell
            && let Some(words) =
                ["cargo run --release --bin raypencil --", "cargo run --release --", "raypencil"]
                    .iter()
                    .find_map(|start| text.strip_prefix(start))
            && words.starts_with([' ', '\n']) | words.is_empty()
        {
            found.push((k + 1, format!("raypencil{words}")));
        } else {
            continue;
        }
        goes_on = line.ends_with('\\');
    }
    found
}

#[test]
fn the_commands_on_the_pages_parse() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..");
    let mut all = Vec::new();
    pages(&root, &mut all);
    let (mut count, mut found) = (0, Vec::new());
    for page in all {
        let text = std::fs::read_to_string(&page).expect("a page");
        for (line, command) in commands(&text) {
            count += 1;
            // The shell puts a number in the place of a variable.
            let command = command.replace("$SLURM_ARRAY_TASK_ID", "1");
            if let Some(fault) = fault(&command, &[]) {
                let page = page.strip_prefix(&root).expect("in the repository").display().to_string();
                found.push(format!("{page}:{line}: {command}\n{fault}"));
            }
        }
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
    assert!(count > 100, "{count} commands on all pages");
}

#[test]
fn commands_are_found_on_a_page() {
    let page = "```sh\ncargo run --release -- cast a b   # why\nraypencil check \\\n  p q\ncargo run --release\n\
                raypencils\n```\n```text\nraypencil no\n```\n    raypencil no\n```sh\nraypencil\n```\n";
    let expected = [(2, "raypencil cast a b   # why"), (3, "raypencil check p q"), (13, "raypencil")];
    assert_eq!(commands(page), expected.map(|(line, text)| (line, text.to_string())));
    assert_eq!(shell_words(expected[0].1).unwrap().len(), 4);
}
