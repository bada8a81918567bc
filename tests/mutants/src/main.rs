//! `just mutants CRATE`: asks the tests of a crate about random mutants of it.

use std::path::Path;
use std::process::{Command, ExitCode};

use raypencil_mutants::{Asked, Options, Result, list, row, run};

const HELP: &str = "\
Asks the tests of a crate about random mutants of it, all of which are in one build. Goes on where it was interrupted.

    mutants CRATE [OPTIONS]        the crate by its folder's name, such as tracer
    mutants --table [CRATE ...]    the table of scores of what was run

    --draw N      so many mutants, by a seed, which is the crate's name (400 of an engine, 150 of another crate)
    --all         all mutants
    --only TEXT   the mutants whose line in the list contains TEXT, such as 'plane.rs:12'; may be repeated
    --again       those that were missed so far, after new tests were written
    --part K/N    part K of N, counted from 0; parts can run at the same time
    --ask NAME    asks only the tests whose names contain NAME; may be repeated, as --skip may
    --skip NAME   leaves out the tests whose names contain NAME
    --list        lists them and does nothing else
    --build       builds them, and runs the tests without a mutant: MUTANT=NUMBER out/mutants/CRATE/tests-0 tries one
";

/// Engines have more code than tests that say what each line is for.
const ENGINES: [&str; 3] = ["referee", "scanline", "tracer"];

fn main() -> ExitCode {
    match begin(std::env::args().skip(1).collect()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(2)
        }
    }
}

fn begin(arguments: Vec<String>) -> Result<()> {
    let mut names = Vec::new();
    let mut options = Options::default();
    let (mut is_list, mut is_all, mut is_table) = (false, false, false);
    let mut words = arguments.into_iter();
    while let Some(word) = words.next() {
        let mut value = || words.next().ok_or(format!("{word} needs a value"));
        match word.as_str() {
            "--draw" => options.draw = Some(value()?.parse()?),
            "--all" => is_all = true,
            "--only" => options.only.push(value()?),
            "--again" => options.asked = Asked::Missed,
            "--part" => {
                let text = value()?;
                let (part, parts) = text.split_once('/').ok_or("a part is K/N")?;
                let (part, parts) = (part.parse()?, parts.parse()?);
                if part >= parts {
                    return Err("a part is K/N, with K less than N".into());
                }
                options.part = Some((part, parts));
            }
            "--ask" => options.ask.push(value()?),
            "--skip" => options.skip.push(value()?),
            "--list" => is_list = true,
            "--build" => options.only_build = true,
            "--table" => is_table = true,
            "--help" | "-h" => {
                print!("{HELP}");
                return Ok(());
            }
            _ if word.starts_with('-') => return Err(format!("{word} is no option\n\n{HELP}").into()),
            _ => names.push(word),
        }
    }
    let root = Command::new("git").args(["rev-parse", "--show-toplevel"]).output()?;
    let root = String::from_utf8(root.stdout)?;
    let root = Path::new(root.trim());
    if is_table {
        return table(root, names);
    }
    let [name] = <[String; 1]>::try_from(names).map_err(|_| HELP)?;
    options.name = name;
    if !is_all && options.draw.is_none() {
        options.draw = Some(if ENGINES.contains(&options.name.as_str()) { 400 } else { 150 });
    }
    if is_list {
        for (k, mutant) in list(root, &options)?.iter().enumerate() {
            println!("{} {}", k + 1, mutant.words);
        }
        return Ok(());
    }
    run(root, &options)
}

/// The table of scores of these crates, or of all that were run.
fn table(root: &Path, mut names: Vec<String>) -> Result<()> {
    let results = root.join("out/mutants");
    if names.is_empty() {
        for entry in std::fs::read_dir(&results)? {
            let entry = entry?;
            let name = entry.file_name().to_string_lossy().into_owned();
            if entry.path().join("drawn.tsv").exists() && !name.ends_with("-chosen") {
                names.push(name);
            }
        }
        names.sort();
    }
    println!("{}", raypencil_mutants::HEAD);
    for name in names {
        println!("{}", row(&results.join(&name), &name)?);
    }
    Ok(())
}
