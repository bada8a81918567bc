//! `raypencil check`: another program's answers against a reference pack.

use raypencil::judge::Conventions;
use raypencil::pack::{check_json, check_pack_by, check_screen, write_check};

use crate::args::Check;
use crate::console::{Spinner, say};
use crate::{Outcome, Trouble};

pub(crate) fn check(command: &Check, json: bool) -> Result<Outcome, Trouble> {
    let spinner = Spinner::new();
    let conventions = Conventions { miss: command.miss, ignores_faces: command.no_faces };
    let checked =
        check_pack_by(&command.pack, &command.candidate, command.arithmetic, conventions, &spinner)?;
    if let Some(folder) = &command.output {
        write_check(&checked, folder)?;
    }
    drop(spinner);
    say(&if json { check_json(&checked) } else { check_screen(&checked) });
    Ok(if checked.check.passes() { Outcome::Fine } else { Outcome::Differs })
}
