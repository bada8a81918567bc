//! The command `raypencil`: arguments in, one screen and an exit code out.
//!
//! Exit codes are those of `diff`: 0 all agree, 1 a defect or difference, 2 trouble.

mod args;
mod campaign;
mod check;
mod console;
mod diff;
mod drive;
mod minimise;
mod pack;
mod probe;
mod render;
mod subject;
mod terrain;
mod validate;

use std::ffi::OsString;
use std::process::ExitCode;

use clap::Parser;
use clap::error::ErrorKind;
use miette::{Diagnostic, GraphicalReportHandler, GraphicalTheme};
use raypencil::campaign::CampaignError;
use raypencil::diff::DiffError;
use raypencil::drive::DriveError;
use raypencil::harness::{CandidateError, Contender, HarnessError, NoSuchRay};
use raypencil::io::{FileError, FolderError, SceneIoError};
use raypencil::pack::{CheckError, PackError};
use thiserror::Error;

use args::{Arguments, Command};

/// Where the command finds renderers by name.
pub type Registry = dyn Fn(&str) -> Option<Contender> + Sync;

/// What a command that ran to its end found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Outcome {
    /// All agree, or there was nothing to disagree about.
    Fine,
    /// A defect or a difference.
    Differs,
}

/// Why a command could not do its work.
#[derive(Debug, Error, Diagnostic)]
enum Trouble {
    /// A scene, or a file that it needs.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Scene(#[from] SceneIoError),

    /// A file of another kind.
    #[error(transparent)]
    #[diagnostic(transparent)]
    File(#[from] FileError),

    /// The output folder.
    #[error(transparent)]
    Folder(#[from] FolderError),

    /// The folder of a validation.
    #[error(transparent)]
    Validation(#[from] HarnessError),

    /// A ray that the scene does not have.
    #[error(transparent)]
    Ray(#[from] NoSuchRay),

    /// A pack that could not be written.
    #[error(transparent)]
    Pack(#[from] PackError),

    /// A pack or a candidate that cannot be judged.
    #[error(transparent)]
    Check(#[from] CheckError),

    /// What another program recorded of a scene.
    #[error(transparent)]
    Candidate(#[from] CandidateError),

    /// Two recordings that do not fit together.
    #[error(transparent)]
    Diff(#[from] DiffError),

    /// A campaign that cannot go on.
    #[error(transparent)]
    Campaign(#[from] CampaignError),

    /// A drive that cannot be driven.
    #[error("{scene}: {error}")]
    Drive {
        /// As it was given.
        scene: String,
        /// Why not.
        error: DriveError,
    },

    /// Words that clap cannot judge.
    #[error("{0}")]
    Usage(String),
}

/// Runs the command with `arguments` (the program's name first), taking renderers from `registry`.
pub fn main_with(arguments: impl IntoIterator<Item = OsString>, registry: &Registry) -> ExitCode {
    let arguments = match Arguments::try_parse_from(arguments) {
        Ok(arguments) => arguments,
        Err(error) => {
            // `--help` and `--version` are no trouble. Printing may fail only on a closed pipe.
            let asked = matches!(error.kind(), ErrorKind::DisplayHelp | ErrorKind::DisplayVersion);
            let _ = error.print();
            return ExitCode::from(if asked { 0 } else { 2 });
        }
    };
    match run(arguments, registry) {
        Ok(Outcome::Fine) => ExitCode::SUCCESS,
        Ok(Outcome::Differs) => ExitCode::from(1),
        Err(trouble) => {
            console::complain(&render_trouble(&trouble));
            ExitCode::from(2)
        }
    }
}

fn run(arguments: Arguments, registry: &Registry) -> Result<Outcome, Trouble> {
    if let Some(threads) = arguments.threads {
        rayon::ThreadPoolBuilder::new()
            .num_threads(threads as usize)
            .build()
            .map_err(|error| Trouble::Usage(format!("--threads {threads}: {error}")))?
            .install(|| dispatch(&arguments, registry))
    } else {
        dispatch(&arguments, registry)
    }
}

fn dispatch(arguments: &Arguments, registry: &Registry) -> Result<Outcome, Trouble> {
    match &arguments.command {
        None => validate::validate(&args::Validate::pyramids(), arguments.json, registry),
        Some(Command::Validate(command)) => validate::validate(command, arguments.json, registry),
        Some(Command::Render(command)) => render::render(command, arguments.json, registry),
        Some(Command::Pack(command)) => pack::pack(command, arguments.json),
        Some(Command::Campaign(command)) => campaign::campaign(command, arguments.json),
        Some(Command::Minimise(command)) => minimise::minimise(command, arguments.json, registry),
        Some(Command::Check(command)) => check::check(command, arguments.json),
        Some(Command::Drive(command)) => drive::drive(command, arguments.json, registry),
        Some(Command::Diff(command)) => diff::diff(command, arguments.json),
        Some(Command::Terrain(command)) => terrain::terrain(command, arguments.json),
        Some(Command::Probe(command)) => probe::probe(command, arguments.json, registry),
    }
}

/// One clear message: what is wrong, where, what was expected; with the line and a caret where there is one.
fn render_trouble(trouble: &Trouble) -> String {
    let mut text = String::new();
    let theme =
        if console::in_colour() { GraphicalTheme::unicode() } else { GraphicalTheme::unicode_nocolor() };
    let rendered =
        GraphicalReportHandler::new_themed(theme).with_links(false).render_report(&mut text, trouble);
    if rendered.is_err() {
        text = format!("{trouble}\n");
    }
    text
}
