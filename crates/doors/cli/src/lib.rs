//! The command `raypencil`: parses arguments, calls the library, prints one screen and gives an exit code.
//!
//! It uses the crate `raypencil` alone. Exit codes are those of `diff`: 0 all agree, 1 a defect or a difference, 2 an
//! error ("trouble").
//!
//! ```
//! use std::process::ExitCode;
//!
//! use raypencil::harness::contender;
//! use raypencil_cli::main_with;
//!
//! let run = |words: &[&str]| main_with(words.iter().map(Into::into), &contender);
//! assert_eq!(run(&["raypencil", "--version"]), ExitCode::SUCCESS);
//! // There is no such scene.
//! assert_eq!(run(&["raypencil", "validate", "nowhere.toml"]), ExitCode::from(2));
//! ```
//!
//! The files, from the floor to the top:
//!
//! ```text
//! outcome               results and errors of the commands
//! console               standard output, standard error, the spinner
//! parsers               values of options
//! memory                asks whether the memory for the work is there
//! args                  the arguments and their help texts
//! subject               the scene and the renderers that the arguments name
//! validate, render, ... one file per command
//! trouble               how an error is shown
//! lib                   runs the command and prints its error
//! ```

mod args;
mod campaign;
mod cast;
mod check;
mod closed_output;
mod completions;
mod console;
mod diff;
mod drive;
mod file_frame;
mod lines;
mod man;
mod memory;
mod minimise;
mod outcome;
pub mod overwriting;
mod pack;
mod pages;
mod parsers;
mod probe;
mod reference;
mod render;
mod replaced;
mod scene;
mod subject;
mod sweep;
mod terrain;
mod trouble;
mod validate;

use std::ffi::OsString;
use std::process::ExitCode;

use clap::error::ErrorKind;
use raypencil::io::harmless_line;

use crate::args::{Arguments, Command, Everywhere, Validate};

pub use crate::outcome::Registry;
pub(crate) use crate::outcome::{Outcome, Trouble};

/// Runs the command with `arguments`, the program's name first. Renderers come from `registry`.
pub fn main_with(arguments: impl IntoIterator<Item = OsString>, registry: &Registry) -> ExitCode {
    live_with_limits_of_files();
    ExitCode::from(run_with(arguments, registry))
}

/// Makes a file that grows beyond the limit of the shell, `ulimit -f`, an error where it is written. By itself the system ends the
/// process by a signal, without a word.
fn live_with_limits_of_files() {
    #[cfg(unix)]
    {
        // Nobody asks for it: the write fails in any case. A handler that cannot be set leaves the process as it was.
        let was_caught = std::sync::Arc::new(std::sync::atomic::AtomicBool::new(false));
        let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, was_caught);
    }
}

/// The same, with the exit code as a number: for programs in which the command is a function.
pub fn run_with(arguments: impl IntoIterator<Item = OsString>, registry: &Registry) -> u8 {
    let words: Vec<OsString> = arguments.into_iter().collect();
    let color = Arguments::color_of(&words);
    let has_codes = words.iter().any(|word| harmless_line(&word.to_string_lossy()) != word.to_string_lossy());
    let words_not_text: Vec<OsString> =
        words.iter().filter(|word| word.to_str().is_none()).cloned().collect();
    let arguments = match Arguments::read(words, color) {
        Ok(arguments) => arguments,
        Err(error) => {
            // `--help` and `--version` are not errors.
            let asked = matches!(error.kind(), ErrorKind::DisplayHelp | ErrorKind::DisplayVersion);
            match words_not_text.as_slice() {
                [first, ..] if error.kind() == ErrorKind::InvalidUtf8 => console::complain(&format!(
                    "Error: {}: the argument is not UTF-8; expected a path or a value that is: give the file another name, or make a link that has one\n",
                    first.to_string_lossy()
                )),
                _ => trouble::print_usage(&error, has_codes),
            }
            return code_after_writing(if asked { 0 } else { 2 });
        }
    };
    let Everywhere { quiet, json, color, max_memory, .. } = arguments.everywhere;
    console::begin(quiet, json, color);
    memory::begin(max_memory);
    let outcome = run(arguments, registry);
    console::end();
    let code = match outcome {
        Ok(Outcome::Fine) => 0,
        Ok(Outcome::Differs) => 1,
        Err(trouble) => {
            console::complain_in_colour(&trouble::rendered(&trouble));
            2
        }
    };
    code_after_writing(code)
}

/// The exit code, which is 2 if the answer could not be written: then nobody has it.
fn code_after_writing(code: u8) -> u8 {
    let Some(error) = console::failed_write() else { return code };
    let why = trouble::without_codes_of_the_system(&error.to_string());
    console::complain(&format!("Error: standard output: cannot write: {why}\n"));
    2
}

/// Maximum number of worker threads.
const MAX_THREADS: usize = 1024;

fn run(arguments: Arguments, registry: &Registry) -> Result<Outcome, Trouble> {
    let (threads, words) = number_of_threads(&arguments)?;
    // A pool of its own: the one that rayon makes by itself panics where the system refuses a thread.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().map_err(|error| {
        let expected = "expected fewer threads, such as --threads 1, or a system that allows more";
        Trouble::Usage(format!("{words}: {threads} threads cannot be started: {error}; {expected}"))
    })?;
    pool.install(|| {
        overwriting::begin(arguments.everywhere.force);
        dispatch(&arguments, registry)
    })
}

/// The number of worker threads, and what says so: the option, the variable RAYON_NUM_THREADS, or the machine.
fn number_of_threads(arguments: &Arguments) -> Result<(usize, String), Trouble> {
    if let Some(threads) = arguments.everywhere.threads {
        return Ok((threads.into(), format!("--threads {threads}")));
    }
    let Some(text) = std::env::var_os("RAYON_NUM_THREADS").filter(|text| !text.is_empty()) else {
        let cores = std::thread::available_parallelism().map_or(1, usize::from).min(MAX_THREADS);
        return Ok((cores, "threads".into()));
    };
    let words = format!("RAYON_NUM_THREADS={}", text.to_string_lossy());
    match text.to_str().and_then(|text| text.trim().parse::<usize>().ok()) {
        Some(0) => Ok((std::thread::available_parallelism().map_or(1, usize::from).min(MAX_THREADS), words)),
        Some(threads) if threads <= MAX_THREADS => Ok((threads, words)),
        _ => Err(Trouble::Usage(format!("{words}: expected a number of threads from 1 to {MAX_THREADS}"))),
    }
}

fn dispatch(arguments: &Arguments, registry: &Registry) -> Result<Outcome, Trouble> {
    let json = arguments.everywhere.json;
    match &arguments.command {
        None => validate::validate(&Validate::pyramids(), json, registry),
        Some(Command::Validate(command)) => validate::validate(command, json, registry),
        Some(Command::Render(command)) => render::render(command, json, registry),
        Some(Command::Pack(command)) => pack::pack(command, json),
        Some(Command::Campaign(command)) => campaign::campaign(command, json),
        Some(Command::Minimise(command)) => minimise::minimise(command, json, registry),
        Some(Command::Check(command)) => check::check(command, json),
        Some(Command::Drive(command)) => drive::drive(command, json, registry),
        Some(Command::Sweep(command)) => sweep::sweep(command, json, registry),
        Some(Command::Diff(command)) => diff::diff(command, json),
        Some(Command::Cast(command)) => cast::cast(command, json),
        Some(Command::Scene(command)) => scene::scene(command, json),
        Some(Command::Terrain(command)) => terrain::terrain(command, json),
        Some(Command::Probe(command)) => probe::probe(command, json, registry),
        Some(Command::Completions(command)) => completions::completions(command),
        Some(Command::Man(command)) => man::man(command, json),
        Some(Command::Reference(command)) => reference::reference(command, json),
    }
}

/// The commit that this program is built from, where git knew it.
pub fn commit() -> Option<&'static str> {
    option_env!("RAYPENCIL_COMMIT")
}

/// The build of this program: version and, where git knew it, commit. Records of another build are not mixed with its own.
pub fn build() -> String {
    let version = env!("CARGO_PKG_VERSION");
    commit().map_or(version.to_string(), |commit| format!("{version} {commit}"))
}

/// The README's example, compiled and run with the documentation tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
