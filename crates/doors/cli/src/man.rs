//! `raypencil man`: the manual pages of this command, one for each command below it.

use clap_mangen::Man;

use crate::args::ManPages;
use crate::pages::write_pages;
use crate::{Outcome, Trouble};

pub(crate) fn man(command: &ManPages, json: bool) -> Result<Outcome, Trouble> {
    write_pages(&command.output, json, |command| {
        let man = Man::new(command.clone());
        let mut page = Vec::new();
        man.render(&mut page).expect("memory takes all that is written");
        (man.get_filename(), page)
    })
}
