//! Misses: rays that a candidate answers wrongly, each written as a pack of that ray, so that the candidate's author
//! can reproduce it.

use std::path::Path;

use raypencil_files::{harmless, harmless_line, markdown_text, write_atomically};
use raypencil_judge::{ListedDefect, Quantity, name_of};
use raypencil_minimise::reduce_to_ray;
use raypencil_pack::{PackError, write_pack_of_ray};
use raypencil_referee::{Displacement, Format, Referee};
use raypencil_scene::{Place, Progress, Sampling, Scene, SensorId};
use raypencil_scene_io::{Subject, probe_command, quoted, scene_sha256};

use crate::scoreboard::CandidateReport;

/// Maximum misses per candidate that a validation writes.
pub(crate) const MAX_MISSES: usize = 10;

/// Maximum faces of a miss's terrain: those nearest the ray.
const MAX_FACES: usize = 1000;

/// The exact answer to a ray, with the reason for its visibility.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct TrueAnswer {
    /// Bits of the range, metres in f64; `None` if nothing is hit.
    range: Option<u64>,
    /// A pencil's hit: whether the camera sees it, whether it lands on the image, whether a face hides it.
    sight: Option<[bool; 3]>,
    /// Bits of the pencil's flux.
    flux: Option<u64>,
}

impl TrueAnswer {
    fn of(scene: &Scene, Place { sensor, i, j }: Place) -> Self {
        let referee = Referee::new(scene);
        let range = referee.values(sensor, i, j).map(|hit| hit.in_format(Format::Double).range.to_bits());
        let SensorId::Beam(beam) = sensor else { return Self { range, sight: None, flux: None } };
        let sight = referee.visibility(beam, i, j, Displacement::ZERO);
        let light = referee.light(beam, Sampling::Centres);
        let back = light.and_then(|light| light.returned(i, j));
        let flux = back.map(|back| back.in_format(Format::Double, scene.flux_model()).flux.to_bits());
        let sight = sight.map(|sight| [sight.visible, sight.pixel.is_some(), sight.hidden_by.is_some()]);
        Self { range, sight, flux }
    }
}

/// Writes each of a candidate's worst misses, at most `max_count`, as a pack of that ray, in `folder/NAME-1`, `folder/NAME-2`, ... A
/// README.md in it states the candidate's answer and the exact one.
///
/// # Errors
/// A file that could not be written; the message names it.
pub(crate) fn write_misses(
    subject: &Subject,
    report: &CandidateReport,
    (folder, max_count): (&Path, usize),
    progress: &dyn Progress,
) -> Result<(), PackError> {
    for (index, wrong) in report.misses().take(max_count).enumerate() {
        progress.stage(&format!("{}: miss {}", report.candidate.name, index + 1));
        let name = report.miss_name(index);
        let folder = folder.join(&name);
        // Where the profile is divided by its sum, the flux of a pencil depends on the other pencils, so it is compared
        // only if the miss is in the flux. The flux of a pixel is a sum over many pencils and is not reduced at all.
        let of_ray = |scene: &Scene, place: Place| {
            let answer = TrueAnswer::of(scene, place);
            if wrong.item.quantity == Quantity::PencilFlux {
                answer
            } else {
                TrueAnswer { flux: None, ..answer }
            }
        };
        let true_answer = of_ray(&subject.scene, wrong.place);
        let is_sum = wrong.item.quantity == Quantity::PixelFlux;
        let is_interesting = |scene: &Scene, place: Option<Place>| {
            !is_sum && place.is_some_and(|place| of_ray(scene, place) == true_answer)
        };
        let (scene, place) = reduce_to_ray(&subject.scene, wrong.place, MAX_FACES, &is_interesting, progress);
        let sha256 = scene_sha256(&scene);
        let arguments = quoted("scene.toml");
        let small = Subject { arguments, name, sha256, scene, vehicle: None, file_facts: Default::default() };
        write_pack_of_ray(&small, &folder, progress)?;
        let text = readme(subject, report, wrong, &small, place);
        let path = folder.join("README.md");
        write_atomically(&path, |file| file.write_all(text.as_bytes()))?;
    }
    Ok(())
}

/// Contents of a miss's README.md.
fn readme(
    subject: &Subject,
    report: &CandidateReport,
    wrong: &ListedDefect,
    small: &Subject,
    place: Place,
) -> String {
    // The program names itself, and a scene is named by its file.
    let program = markdown_text(&report.candidate.name);
    let faces = small.scene.mesh().faces().len();
    let of = subject.scene.mesh().faces().len();
    format!(
        "# {program}, {at}\n\n{quantity}: {words}. {what}\n\n\
         This folder is a reference pack of that ray ({place} here) over {faces} of the {of} faces; the exact\n\
         answer to the ray is that of the whole scene. To see the exact answer, and to ask a program again:\n\n\
         ```sh\n{probe}\n\
         raypencil check . CANDIDATE    # reference/make.py --pack . makes one by Embree and one by Mitsuba\n```\n\n\
         In the scene {name}, {sha256}: `{again}`\n",
        at = wrong.place,
        quantity = name_of(wrong.item),
        words = wrong.words(),
        what = harmless(&wrong.what),
        probe = harmless_line(&probe_command(small, place)),
        name = markdown_text(&subject.name),
        sha256 = scene_sha256(&subject.scene),
        again = harmless_line(&probe_command(subject, wrong.place)).replace('`', "'"),
    )
}
