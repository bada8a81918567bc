//! `raypencil check`: another program's answers against a reference pack.

use raypencil::Precision;
use raypencil::cast::{
    CandidateConventions, check_ray_pack, is_ray_pack, ray_check_json, ray_check_text, write_ray_check,
};
use raypencil::harness::{CheckedRaySet, check_packed_ray_sets};
use raypencil::io::OutputFolder;
use raypencil::judge::JudgeShare;
use raypencil::pack::{
    Declarations, check_input, check_json, check_pack_by, check_screen, input_json, input_screen,
    is_input_pack, write_check, write_input_check,
};

use crate::args::Check;
use crate::console::{Spinner, say};
use crate::{Outcome, Trouble, memory};

pub(crate) fn check(command: &Check, json: bool) -> Result<Outcome, Trouble> {
    let output = command.output.as_deref().map(OutputFolder::begin).transpose()?;
    let outcome = checked(command, json)?;
    output.map_or(Ok(()), OutputFolder::finish)?;
    Ok(outcome)
}

fn checked(command: &Check, json: bool) -> Result<Outcome, Trouble> {
    if is_input_pack(&command.pack) {
        return check_loader(command, json);
    }
    if is_ray_pack(&command.pack) {
        return check_rays(command, json);
    }
    let spinner = Spinner::new();
    let declarations = Declarations {
        precision: command.arithmetic,
        miss: command.miss,
        ignores_faces: command.no_faces,
        ..command.declared.declarations()
    };
    let share = if command.verify { JudgeShare::All } else { JudgeShare::Sample };
    let (pack, candidate) = (&command.pack, &command.candidate);
    memory::ask_check(pack)?;
    let mut checked = check_pack_by(pack, candidate, &declarations, share, &spinner)?;
    // The sets of rays that the pack has besides, if there are any.
    let precision = checked.recorded.precision;
    let declared = &checked.declared;
    let of_rays = CandidateConventions { miss: declared.miss, ignores_faces: declared.ignores_faces };
    let sets = check_packed_ray_sets(&command.pack, &command.candidate, precision, of_rays, &spinner)?;
    checked.ray_sets = sets.iter().map(CheckedRaySet::outcome).collect();
    if let Some(folder) = &command.output {
        write_check(&checked, folder)?;
        for CheckedRaySet { name, checked } in &sets {
            if let Some(checked) = checked {
                write_ray_check(checked, &folder.join("rays").join(name))?;
            }
        }
    }
    drop(spinner);
    if json {
        say(&check_json(&checked));
    } else {
        say(&check_screen(&checked));
        sets.iter().for_each(|set| say(&set_text(set)));
    }
    Ok(if checked.passes() { Outcome::Fine } else { Outcome::Differs })
}

/// A set of rays on the screen.
fn set_text(CheckedRaySet { name, checked }: &CheckedRaySet) -> String {
    match checked {
        Some(checked) => format!("\nrays {}", ray_check_text(checked)),
        None => format!("\nrays {name}: not given\n"),
    }
}

/// The same for a pack of rays.
fn check_rays(command: &Check, json: bool) -> Result<Outcome, Trouble> {
    refuse_declared(command, "pack of rays, whose answers are NPY files of fixed names")?;
    let spinner = Spinner::new();
    let conventions = CandidateConventions { miss: command.miss, ignores_faces: command.no_faces };
    let precision = command.arithmetic.unwrap_or(Precision::F64);
    let checked = check_ray_pack(&command.pack, &command.candidate, precision, conventions, &spinner)?;
    if let Some(folder) = &command.output {
        write_ray_check(&checked, folder)?;
    }
    drop(spinner);
    say(&match json {
        true => format!("{:#}\n", ray_check_json(&checked)),
        false => ray_check_text(&checked),
    });
    Ok(if checked.passes() { Outcome::Fine } else { Outcome::Differs })
}

/// Refuses options that concern maps of sensors alone.
fn refuse_declared(command: &Check, kind: &str) -> Result<(), Trouble> {
    if command.declared.is_empty() {
        return Ok(());
    }
    let pack = command.pack.display();
    Err(Trouble::Usage(format!(
        "--channel, --scale: {pack} is a{} {kind}; expected neither",
        if kind.starts_with('i') { "n" } else { "" }
    )))
}

/// The same for an input pack, which asks for triangles.
fn check_loader(command: &Check, json: bool) -> Result<Outcome, Trouble> {
    let is_of_rays = command.arithmetic.is_some() || command.miss.is_some() || command.no_faces;
    if is_of_rays {
        let pack = command.pack.display();
        let text = "--arithmetic, --miss and --no-faces declare how rays are answered; expected none of them";
        return Err(Trouble::Usage(format!("{pack} is an input pack: {text}")));
    }
    refuse_declared(command, "input pack, which asks for triangles.npy")?;
    let checked = check_input(&command.pack, &command.candidate)?;
    if let Some(folder) = &command.output {
        write_input_check(&checked, folder)?;
    }
    say(&if json { input_json(&checked) } else { input_screen(&checked) });
    Ok(if checked.passes() { Outcome::Fine } else { Outcome::Differs })
}
