//! `raypencil minimise`: the smallest scene on which two renderers still differ so.

use clap::ValueEnum as _;
use raypencil::Progress as _;
use raypencil::harness::{Reproducer, first_shown, shows_class, typed_contenders, write_reproducer};
use raypencil::judge::{Class, JudgeShare};
use raypencil::minimise::{MINIMISE_BUDGET, minimise as search};
use serde_json::json;

use crate::args::{ClassWord, Minimise, typed_renderers};
use crate::console::{Spinner, say};
use crate::subject::{contenders, subject};
use crate::{Outcome, Registry, Trouble};

impl ClassWord {
    fn class(self) -> Class {
        match self {
            Self::Defect => Class::Defect,
            Self::Undecided => Class::Undecided,
            Self::Approximation => Class::Approximation,
            Self::Rounding => Class::Rounding,
            Self::Tie => Class::Tie,
        }
    }

    /// As it is typed.
    fn word(self) -> String {
        self.to_possible_value().map_or(String::new(), |value| value.get_name().to_string())
    }

    /// What of two renderers, as the end of a sentence.
    fn words(self) -> &'static str {
        match self {
            Self::Defect => "differ beyond doubt",
            Self::Undecided => "differ, and the referee cannot tell who is right",
            Self::Approximation => "differ by an approximation of the paper",
            Self::Rounding => "differ by rounding",
            Self::Tie => "meet several faces at exactly the same point",
        }
    }
}

pub(crate) fn minimise(command: &Minimise, json: bool, registry: &Registry) -> Result<Outcome, Trouble> {
    let spinner = Spinner::new();
    let contenders = contenders(&command.with, &command.switches, 2, registry)?;
    let [a, b] = contenders.as_slice() else {
        return Err(Trouble::Usage(format!(
            "--with {}: expected two renderers, no more",
            command.with.join(",")
        )));
    };
    let words = typed_renderers(&command.with, &command.switches);
    let subject = subject(&command.scene, &words, &spinner)?;
    let class = command.class.class();
    let [of_a, of_b] = [a, b].map(|contender| contender.renderer.name());
    let what = format!("{of_a} and {of_b} {}", command.class.words());

    spinner.stage("looking for the first such ray");
    let found = first_shown([a, b], &subject.scene, class, JudgeShare::All).and_then(|first| {
        let shows = shows_class([a, b], class);
        search(&subject.scene, Some(first.place), &shows, MINIMISE_BUDGET, &spinner).ok()
    });
    let Some(minimised) = found else {
        drop(spinner);
        say(&match json {
            true => format!("{:#}\n", json!({ "scene": null })),
            false => format!("There is no ray of {} on which {what}: nothing to minimise.\n", subject.name),
        });
        return Ok(Outcome::Differs);
    };
    let name = format!("{}-{}", subject.name, command.class.word());
    let with = typed_contenders(&[a, b]);
    let reproducer = Reproducer { name: &name, what: &format!("{what}."), with: &with };
    let files = write_reproducer(&command.output, &minimised, reproducer)?;
    drop(spinner);
    let [scene, ground, text] = files.map(|file| file.display().to_string());
    say(&match json {
        true => {
            let place = minimised.place.map(|place| place.to_string());
            let report = json!({
                "scene": scene,
                "ground": ground,
                "text": text,
                "faces_before": minimised.faces_before,
                "faces_after": minimised.faces_after,
                "is_finished": minimised.is_finished,
                "renders": minimised.calls,
                "ray": place,
            });
            format!("{report:#}\n")
        }
        false => format!(
            "{what}: {} of {} faces are left, after {} trials.\n{scene}\n  beside it: its ground {ground}, and how to see it again {text}\n",
            minimised.faces_after, minimised.faces_before, minimised.calls
        ),
    });
    Ok(Outcome::Fine)
}
