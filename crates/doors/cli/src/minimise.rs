//! `raypencil minimise`: reduces a scene to the smallest one on which two renderers still differ.

use raypencil::Progress as _;
use raypencil::harness::{
    Reproducer, first_interesting_ray, is_interesting_in_class, typed_contenders, write_reproducer,
};
use raypencil::judge::{Class, JudgeShare};
use raypencil::minimise::{MINIMISE_BUDGET, minimise as search};
use serde_json::json;

use crate::args::{Minimise, typed_renderers};
use crate::console::{Spinner, say};
use crate::memory::Rates;
use crate::overwriting::output_folder;
use crate::parsers::class_name;
use crate::subject::{contenders, subject};
use crate::{Outcome, Registry, Trouble, memory};

/// How two renderers differ, as the end of a sentence that begins with their names.
fn difference(class: Class) -> &'static str {
    match class {
        Class::Agree => "agree",
        Class::Defect => "differ, and one of them is wrong",
        Class::Undecided => "differ, and the referee cannot decide which is right",
        Class::Approximation => "differ by an approximation of the paper",
        Class::Rounding => "differ by rounding",
        Class::Tie => "hit several faces at exactly the same point",
    }
}

pub(crate) fn minimise(command: &Minimise, json: bool, registry: &Registry) -> Result<Outcome, Trouble> {
    let spinner = Spinner::new();
    let contenders = contenders(&command.with, &command.switches, 2, registry)?;
    let [a, b] = contenders.as_slice() else {
        return Err(Trouble::Usage(format!("--with {}: expected two renderers", command.with.join(","))));
    };
    let words = typed_renderers(&command.with, &command.switches);
    let subject = subject(&command.scene, &words, &spinner)?;
    memory::ask(Rates::MINIMISE, &subject.scene)?;
    let class = command.class;
    let [of_a, of_b] = [a, b].map(|contender| contender.renderer.name());
    let what = format!("{of_a} and {of_b} {}", difference(class));

    let output = output_folder(&command.output, "minimise", &command.scene.scene, &[])?;
    spinner.stage("searching for the first such ray");
    let found = first_interesting_ray([a, b], &subject.scene, class, JudgeShare::All).and_then(|first| {
        let is_interesting = is_interesting_in_class([a, b], class);
        search(&subject.scene, Some(first.place), &is_interesting, MINIMISE_BUDGET, &spinner).ok()
    });
    let Some(minimised) = found else {
        drop(spinner);
        say(&match json {
            true => format!("{:#}\n", json!({ "scene": null })),
            false => format!("{} has no ray on which {what}: nothing to minimise.\n", subject.name),
        });
        return Ok(Outcome::Differs);
    };
    let name = format!("{}-{}", subject.name, class_name(class));
    let with = typed_contenders(&[a, b]);
    let reproducer = Reproducer { name: &name, what: &format!("{what}."), with: &with };
    let files = write_reproducer(&command.output, &minimised, reproducer)?;
    output.finish()?;
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
            "{what}: {} of {} faces {} left, after {} trials.\n\
             {scene}\n  its terrain: {ground}\n  how to reproduce it: {text}\n",
            minimised.faces_after,
            minimised.faces_before,
            if minimised.faces_after == 1 { "is" } else { "are" },
            minimised.calls
        ),
    });
    Ok(Outcome::Fine)
}
