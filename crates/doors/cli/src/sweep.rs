//! `raypencil sweep`: one scene with many settings, in parts; `merge`.

use std::path::Path;

use indicatif::ProgressBar;
use raypencil::drive::drive_renderer;
use raypencil::io::{MIN_ABANDONED_AGE, SharedFolder, remove_abandoned};
use raypencil::sweep::{
    Axis, Chart, Finished, Part, Sweep, SweepProgress, SweepTable, Task, default_charts, finish, read_plan,
    run_part, sweep_document, write_sweep,
};

use crate::args::{self, DEFAULT_WITH, SweepCommand, SwitchArguments};
use crate::console::{progress_bar, say};
use crate::overwriting::ask_sweep;
use crate::subject::contenders;
use crate::{Outcome, Registry, Trouble};

pub(crate) fn sweep(command: &args::Sweep, json: bool, registry: &Registry) -> Result<Outcome, Trouble> {
    match &command.command {
        None => run(&command.run, json, registry),
        Some(SweepCommand::Merge(command)) => merged(command, json),
    }
}

/// Progress bar: runs that are done, and the frames of a drive. Hidden if standard error is not a terminal.
struct Bar(ProgressBar);

impl Bar {
    fn new(runs: u64) -> Self {
        let bar = progress_bar(runs, "{bar:30} {pos}/{len} runs{msg}  {elapsed} elapsed, {eta} left");
        Self(bar)
    }
}

impl SweepProgress for Bar {
    fn runs(&self, done: u64, _of: u64, _made: u64) {
        self.0.set_position(done);
        self.0.set_message("");
    }

    fn frames(&self, done: u64, planned: u64) {
        self.0.set_message(format!(", frame {done}/{planned}"));
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}

fn run(command: &args::SweepRun, json: bool, registry: &Registry) -> Result<Outcome, Trouble> {
    let names: Vec<String> = match (command.with.is_empty(), command.task) {
        (false, _) => command.with.clone(),
        (true, Task::Validate) => DEFAULT_WITH.map(String::from).to_vec(),
        (true, _) => vec![drive_renderer(command.as_printed).to_string()],
    };
    let (least, most) = if command.task == Task::Validate { (2, usize::MAX) } else { (1, 1) };
    if names.len() > most {
        let (given, task) = (names.join(","), command.task.word());
        return Err(Trouble::Usage(format!("--with {given}: expected one renderer to {task}")));
    }
    if command.as_printed && command.task != Task::Drive {
        return Err(Trouble::Usage(
            "--as-printed is how a drive is driven; expected it with --do drive".into(),
        ));
    }
    let contenders = contenders(&names, &SwitchArguments::default(), least, registry)?;
    let mut axes: Vec<Axis> = command.set.clone();
    if let Some(list) = &command.list {
        axes.push(Axis::read_list(list)?);
    }
    let mut sweep = Sweep::new(&command.scene, axes, command.task, names, command.as_printed)?;
    sweep.build = crate::build();
    sweep.check_values()?;
    let part = Part { index: command.shard.index, count: command.shard.count };
    let bar = Bar::new(part.runs(sweep.runs()).count() as u64);
    ask_sweep(&command.output, &command.scene, command.task.word())?;
    let _shared = SharedFolder::begin(&command.output)?;
    remove_abandoned(&command.output, MIN_ABANDONED_AGE);
    run_part(&sweep, part, &contenders, &command.output, &bar)?;
    drop(bar);
    if part != Part::WHOLE {
        let (folder, of) = (command.output.display(), part.count);
        let text = match json {
            true => format!("{:#}\n", serde_json::json!({ "records": command.output.join("runs") })),
            false => format!(
                "{folder}: part {} of {of} is finished; join all parts with `raypencil sweep merge`\n",
                part.index + 1
            ),
        };
        say(&text);
        return Ok(Outcome::Fine);
    }
    let finished = finish(&sweep, std::slice::from_ref(&command.output))?;
    tell(&finished, &command.chart, &command.output, json)
}

fn merged(command: &args::SweepMerge, json: bool) -> Result<Outcome, Trouble> {
    let sweep = read_plan(&command.folders[0])?;
    for folder in &command.folders[1..] {
        if read_plan(folder)? != sweep {
            let (first, other) = (command.folders[0].display(), folder.display());
            return Err(Trouble::Usage(format!(
                "{other}: is of another sweep than {first}; expected parts of one sweep, made by one build"
            )));
        }
    }
    ask_sweep(&command.output, &sweep.scene, sweep.task.word())?;
    let finished = finish(&sweep, &command.folders)?;
    tell(&finished, &command.chart, &command.output, json)
}

/// Writes table and charts, prints them and tells the exit code.
fn tell(finished: &Finished, charts: &[Chart], folder: &Path, json: bool) -> Result<Outcome, Trouble> {
    let table = SweepTable::new(finished);
    let mut all = default_charts(&table, finished.sweep.task);
    all.extend(charts.iter().filter(|chart| !all.contains(chart)).cloned().collect::<Vec<_>>());
    let written = write_sweep(finished, &table, &all, folder)?;
    let document = sweep_document(finished, &table, &written, &[]);
    say(&if json { document.json() } else { document.screen() });
    Ok(if finished.passes() { Outcome::Fine } else { Outcome::Differs })
}
