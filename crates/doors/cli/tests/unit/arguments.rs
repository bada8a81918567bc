//! The command line as clap sees it: well formed, in groups, with examples that parse.

use std::path::Path;

use super::*;

#[path = "shell_words.rs"]
mod shell_words;

#[path = "documents.rs"]
mod documents;

use shell_words::shell_words;

#[test]
fn the_arguments_are_well_formed() {
    command_line().debug_assert();
}

fn parse(words: &[&str]) -> Result<Arguments, clap::Error> {
    let words = ["raypencil"].into_iter().chain(words.iter().copied());
    Arguments::read(words.map(OsString::from).collect(), ColorChoice::Never)
}

#[test]
fn typed_arguments_are_quoted_for_a_shell() {
    let typed = |words: &[&str]| match parse(&[&["validate"], words].concat()).unwrap().command {
        Some(Command::Validate(validate)) => validate.scene.typed(),
        other => panic!("{other:?}"),
    };
    assert_eq!(typed(&[]), "pyramids");
    assert_eq!(
        typed(&["my yard.glb", "--at", "-1.5,2", "--heading", "-90", "--fan", "120"]),
        "'my yard.glb' --fan 120 --at -1.5,2 --heading -90"
    );
}

#[test]
fn colours_are_known_before_the_words_are_parsed() {
    let of = |words: &[&str]| Arguments::color_of(&words.iter().map(OsString::from).collect::<Vec<_>>());
    assert_eq!(of(&["raypencil", "validate"]), ColorChoice::Auto);
    assert_eq!(of(&["raypencil", "--color", "never", "validate"]), ColorChoice::Never);
    assert_eq!(of(&["raypencil", "validate", "--color=always", "--wrong"]), ColorChoice::Always);
    // A wrong value is for clap to refuse; behind `--` there are no options.
    assert_eq!(of(&["raypencil", "--color", "purple"]), ColorChoice::Auto);
    assert_eq!(of(&["raypencil", "validate", "--", "--color=always"]), ColorChoice::Auto);
    assert_eq!(of(&["raypencil", "--color"]), ColorChoice::Auto);
}

/// The commands that people see, each with its words: `["terrain", "generate"]`.
fn commands() -> Vec<(Vec<String>, clap::Command)> {
    fn collect(command: &clap::Command, words: &[String], found: &mut Vec<(Vec<String>, clap::Command)>) {
        found.push((words.to_vec(), command.clone()));
        for below in command.get_subcommands() {
            collect(below, &[words, &[below.get_name().to_string()]].concat(), found);
        }
    }
    let mut found = Vec::new();
    collect(&command_line(), &[], &mut found);
    found
}

#[test]
fn each_command_is_in_one_group() {
    let command_line = command_line();
    for command in command_line.get_subcommands() {
        let groups = help::GROUPS.iter().filter(|(_, names)| names.contains(&command.get_name())).count();
        assert_eq!(groups, usize::from(!command.is_hide_set()), "groups with {}", command.get_name());
    }
    for name in help::GROUPS.iter().flat_map(|(_, names)| names.iter()) {
        assert!(command_line.find_subcommand(name).is_some(), "there is no command {name}");
    }
}

/// What is wrong with an example of a command, if anything is.
fn fault(example: &str, of: &[String]) -> Option<String> {
    let words = match shell_words(example) {
        Ok(words) => words,
        Err(error) => return Some(error),
    };
    let said: Vec<&str> = words.iter().skip(1).map(String::as_str).collect();
    if !said.iter().take(of.len()).eq(of.iter()) {
        return Some(format!("is no example of {of:?}"));
    }
    if let Err(error) = parse(&said) {
        return Some(error.to_string());
    }
    // A file of this repository has to be there; others are the reader's.
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..");
    let missing = said.iter().find(|word| word.starts_with("data/") && !root.join(word).exists());
    missing.map(|word| format!("there is no {word}"))
}

#[test]
fn each_command_has_examples_that_it_understands() {
    let mut examples = 0;
    for (words, command) in commands() {
        let text = command.get_after_help().map(ToString::to_string).unwrap_or_default();
        let mut lines = text.lines();
        assert_eq!(lines.next(), Some("Examples:"), "{words:?} has no examples");
        for (k, line) in lines.enumerate() {
            assert!(line.chars().count() <= 100, "clap would break this line: {line}");
            // A comment and a command take turns.
            let line = line.strip_prefix("  ").expect("two spaces");
            if k % 2 == 0 {
                assert!(line.starts_with("# ") && line.ends_with('.'), "{line}");
            } else {
                assert!(line.starts_with("raypencil"), "{line}");
                assert_eq!(fault(line, &words), None, "{line}");
                examples += 1;
            }
        }
    }
    assert!(examples > 30, "{examples} examples");
}

#[test]
fn a_wrong_example_is_found() {
    let of = |words: &[&str]| words.iter().map(ToString::to_string).collect::<Vec<_>>();
    assert_eq!(fault("raypencil cast data/rays/cube.obj data/rays/cube.npy", &of(&["cast"])), None);
    for (example, command) in [
        ("raypencil cast data/rays/cube.obj data/rays/cubes.npy", &["cast"][..]),
        ("raypencil cast data/rays/cube.obj --exact", &["cast"]),
        ("raypencil validate", &["cast"]),
        ("raypencil terrain inspect facets", &["terrain", "import"]),
        ("raypencil validate 'ground.glb", &["validate"]),
    ] {
        assert!(fault(example, &of(command)).is_some(), "{example}");
    }
}
