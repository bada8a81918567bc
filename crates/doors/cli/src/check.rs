//! `raypencil check`: another program's answers against a reference pack.

use std::path::Path;

use raypencil::cast::{CloudChoice, CloudConventions, is_bag_of_clouds, no_cloud};
use raypencil::harness::{check_any_pack, pack_form};
use raypencil::io::OutputFolder;
use raypencil::pack::{Declarations, PackForm, Verification};

use crate::args::Check;
use crate::console::{Spinner, say};
use crate::overwriting::output_folder;
use crate::{Outcome, Trouble, memory};

pub(crate) fn check(command: &Check, json: bool) -> Result<Outcome, Trouble> {
    let output = match &command.output {
        Some(folder) => {
            Some(output_folder(folder, "check", &command.pack.to_string_lossy(), &[&command.candidate])?)
        }
        None => None,
    };
    if let Some(folder) = command.output.as_ref().filter(|folder| is_same(folder, &command.candidate)) {
        let text = "is the folder of the answers to check; expected another folder";
        return Err(Trouble::Usage(format!("--output {}: {text}", folder.display())));
    }
    let outcome = checked(command, json)?;
    output.map_or(Ok(()), OutputFolder::finish)?;
    Ok(outcome)
}

/// Whether two paths are one folder or file.
fn is_same(a: &Path, b: &Path) -> bool {
    a.canonicalize().is_ok_and(|a| b.canonicalize().is_ok_and(|b| a == b))
}

fn checked(command: &Check, json: bool) -> Result<Outcome, Trouble> {
    refuse_declared(command)?;
    let spinner = Spinner::new();
    let declarations = Declarations {
        precision: command.arithmetic,
        miss: command.miss,
        ignores_faces: command.no_faces,
        ..command.declared.declarations()
    };
    match pack_form(&command.pack) {
        PackForm::Sensors => memory::ask_check(&command.pack)?,
        PackForm::Rays => memory::ask_check_rays(&command.pack, &command.candidate)?,
        PackForm::Triangles => {}
    }
    let choice = CloudChoice { topic: command.topic.as_deref(), message: command.message };
    let cloud = CloudConventions { frame: command.frame.unwrap_or_default(), choice };
    let declared = (&declarations, cloud);
    let checked =
        check_any_pack(&command.pack, &command.candidate, declared, verification(command), &spinner)?;
    if let Some(folder) = &command.output {
        checked.write(folder)?;
    }
    drop(spinner);
    let document = checked.document();
    say(&if json { document.json() } else { document.screen() });
    Ok(if checked.passes() { Outcome::Fine } else { Outcome::Differs })
}

/// Which answers of the pack are held to the referee's.
fn verification(command: &Check) -> Verification {
    if command.verify { Verification::All } else { Verification::Drawn { seed: command.seed } }
}

/// Refuses options that a pack of this form has no use for.
fn refuse_declared(command: &Check) -> Result<(), Trouble> {
    let pack = command.pack.display();
    let of_rays = command.arithmetic.is_some() || command.miss.is_some() || command.no_faces;
    let of_sensors = !command.declared.is_empty();
    let of_bag = command.topic.is_some() || command.message.is_some();
    let usage = |text: String| Err(Trouble::Usage(text));
    match pack_form(&command.pack) {
        PackForm::Triangles if of_rays => usage(format!(
            "{pack} is an input pack: --arithmetic, --miss and --no-faces declare how rays are answered; expected none of them"
        )),
        PackForm::Triangles if of_sensors => usage(format!(
            "--channel, --scale: {pack} is an input pack, which asks for triangles.npy; expected neither"
        )),
        PackForm::Triangles | PackForm::Sensors if command.frame.is_some() && command.pack.exists() => {
            usage(format!(
                "--frame: {pack} is no pack of rays, which alone takes point clouds; expected no --frame"
            ))
        }
        PackForm::Triangles | PackForm::Sensors if of_bag && command.pack.exists() => usage(format!(
            "--topic, --message: {pack} is no pack of rays, which alone takes bags; expected neither"
        )),
        PackForm::Rays if of_sensors => usage(format!(
            "--channel, --scale: {pack} is a pack of rays, whose answers are NPY files of fixed names; expected neither"
        )),
        PackForm::Rays if command.frame.is_some() || of_bag => match no_cloud(&command.candidate) {
            Some(words) => usage(words),
            None if of_bag && !is_bag_of_clouds(&command.candidate) => usage(format!(
                "--topic, --message: {} is no bag (.mcap); expected neither",
                command.candidate.display()
            )),
            None => Ok(()),
        },
        PackForm::Triangles | PackForm::Rays | PackForm::Sensors => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use clap::ColorChoice;

    use super::*;
    use crate::args::{Arguments, Command};

    #[test]
    fn all_answers_are_held_or_those_that_the_asked_seed_draws() {
        for (options, expected) in [
            (&[][..], Verification::Drawn { seed: None }),
            (&["--seed", "7"], Verification::Drawn { seed: Some(7) }),
            (&["--seed", "0"], Verification::Drawn { seed: Some(0) }),
            (&["--verify"], Verification::All),
        ] {
            let words = ["raypencil", "check", "pack", "answers"].iter().chain(options);
            let read =
                Arguments::read(words.map(Into::into).collect(), ColorChoice::Never).expect("arguments");
            let Some(Command::Check(command)) = read.command else { panic!("{options:?}") };
            assert_eq!(verification(&command), expected, "{options:?}");
        }
    }
}
