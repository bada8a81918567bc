//! `raypencil diff`: compares two recordings channel by channel.

use std::path::Path;

use raypencil::Progress as _;
use raypencil::diff::{Sides, Thresholds, diff as compare, diff_document, rule, write_diff};
use raypencil::harness::read_sides;
use raypencil::io::{OutputFolder, Overrides, load};
use raypencil::judge::{GroundTruth, check as judge};

use crate::args::Diff;
use crate::console::{Spinner, is_terminal, say};
use crate::overwriting::output_folder;
use crate::{Outcome, Trouble};

/// Length of a line on a terminal, characters.
const LINE_CHARS: usize = 100;

pub(crate) fn diff(command: &Diff, json: bool) -> Result<Outcome, Trouble> {
    let spinner = Spinner::new();
    if let Some(folder) = &command.output {
        // Its files would overwrite those of the recording, such as the summary.json of a validation.
        let same = |path: &Path| {
            path.canonicalize().ok().is_some_and(|path| folder.canonicalize().ok() == Some(path))
        };
        if same(&command.a) || same(&command.b) {
            let folder = folder.display();
            return Err(Trouble::Usage(format!(
                "--output {folder}: is one of the folders to compare; expected another folder"
            )));
        }
    }
    let output = match &command.output {
        Some(folder) => Some(output_folder(folder, "diff", &command.a.to_string_lossy(), &[&command.b])?),
        None => None,
    };
    let [a, b] = read_sides([&command.a, &command.b], &command.declared.declarations(), &spinner)?;
    let thresholds = Thresholds {
        fail: command.fail,
        fail_relative: command.fail_relative,
        fail_ulp: command.fail_ulp,
        fail_percent: command.fail_percent,
        hard_fail: command.hard_fail,
        shared_only: command.shared_only,
    };
    spinner.stage("comparing");
    let mut difference = compare(&a.channels, &b.channels, &thresholds)?;
    let names = [&command.a, &command.b].map(|path| path.display().to_string());
    let sides = Sides { names: [&names[0], &names[1]], channels: [&a.channels, &b.channels] };
    if let Some(scene) = &command.scene {
        spinner.stage(&format!("{scene}: loading"));
        let scene = load(scene, &Overrides { settings: command.set.clone(), ..Overrides::default() })?.scene;
        let recorded = [&a, &b].map(|side| side.recorded(&scene, command.arithmetic));
        let [of_a, of_b] = recorded;
        let (of_a, of_b) = (of_a?, of_b?);
        let truth = GroundTruth::certified(&scene, &spinner);
        let [of_a, of_b] = [of_a, of_b].map(|recorded| judge(&truth, &recorded, &spinner));
        let rulings = rule(&difference, &sides, &truth, [&of_a, &of_b]);
        difference = difference.with_rulings(rulings);
    }
    if let Some(folder) = &command.output {
        write_diff(&difference, &sides, folder, &spinner)?;
    }
    output.map_or(Ok(()), OutputFolder::finish)?;
    drop(spinner);
    let document = diff_document(&difference, &sides);
    say(&match json {
        true => document.json(),
        false if is_terminal() => document.screen_of_width(LINE_CHARS),
        false => document.screen(),
    });
    if let Some(folder) = command.output.as_deref().filter(|_| !json) {
        say(&format!("  Report: {}\n", folder.join("report.html").display()));
    }
    Ok(if difference.passes() { Outcome::Fine } else { Outcome::Differs })
}
