//! A miss of an outsider as a pack of its one ray: whoever has the program can see it again.

use std::path::{Path, PathBuf};

use crate::panel::HeldOutsider;
use raypencil_files::write_atomically;
use raypencil_judge::{Defect, Quantity, name_of};
use raypencil_minimise::single_ray;
use raypencil_pack::{PackError, write_pack};
use raypencil_referee::{Displacement, Format, Referee};
use raypencil_scene::Place;
use raypencil_scene::{Progress, Sampling, Scene, SensorId};
use raypencil_scene_io::{Subject, probe_command, quoted, scene_sha256};

/// How many misses of each outsider get a reproducer.
pub const REPRODUCED: usize = 10;

/// The most faces of a reproducer's ground: those nearest the ray.
const FACES: usize = 1000;

/// A reproducer that was written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MissReproducer {
    /// Which ray of the scene.
    pub place: Place,
    /// Its folder.
    pub folder: PathBuf,
}

/// What is true of a ray, and for what reason.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct TrueAnswer {
    /// The bits of its range.
    range: Option<u64>,
    /// Of a pencil's hit: whether it is seen, lands on the image, and is hidden by a face.
    sight: Option<[bool; 3]>,
    /// The bits of what the pencil delivers.
    flux: Option<u64>,
}

impl TrueAnswer {
    fn of(scene: &Scene, Place { sensor, i, j }: Place) -> Self {
        let referee = Referee::new(scene);
        let range = referee.values(sensor, i, j).map(|hit| hit.in_format(Format::Double).range.to_bits());
        let SensorId::Beam(beam) = sensor else { return Self { range, sight: None, flux: None } };
        let sight = referee.sight(beam, i, j, Displacement::ZERO);
        let light = referee.light(beam, Sampling::Centres);
        let back = light.and_then(|light| light.returned(i, j));
        let flux = back.map(|back| back.in_format(Format::Double, scene.flux_model()).flux.to_bits());
        let sight = sight.map(|sight| [sight.visible, sight.pixel.is_some(), sight.hidden_by.is_some()]);
        Self { range, sight, flux }
    }
}

/// Writes a pack of the one ray for each of the first ten misses of an outsider, as `folder/NAME-1`, `NAME-2`, ..., each
/// with a README.md that says what was said and what is true.
///
/// # Errors
/// Names the file that could not be written.
pub fn write_misses(
    subject: &Subject,
    held: &HeldOutsider,
    folder: &Path,
    progress: &dyn Progress,
) -> Result<Vec<MissReproducer>, PackError> {
    let mut written = Vec::new();
    for (index, wrong) in held.misses().take(REPRODUCED).enumerate() {
        progress.stage(&format!("{}: miss {}", held.outsider.name, index + 1));
        let name = held.miss_name(index);
        let folder = folder.join(&name);
        // A pencil's flux is that of the others too, where the profile is divided by its sum; a pixel's is of many pencils.
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
        let shows = |scene: &Scene, place: Option<Place>| {
            !is_sum && place.is_some_and(|place| of_ray(scene, place) == true_answer)
        };
        let (scene, place) = single_ray(&subject.scene, wrong.place, FACES, &shows, progress);
        let small = Subject { arguments: quoted("scene.toml"), name, sha256: scene_sha256(&scene), scene };
        write_pack(&small, None, &folder, progress)?;
        let text = words(subject, held, wrong, &small, place);
        let readme = folder.join("README.md");
        write_atomically(&readme, |file| file.write_all(text.as_bytes()))?;
        written.push(MissReproducer { place: wrong.place, folder });
    }
    Ok(written)
}

fn words(subject: &Subject, held: &HeldOutsider, wrong: &Defect, small: &Subject, place: Place) -> String {
    let program = &held.outsider.name;
    let faces = small.scene.mesh().faces().len();
    let of = subject.scene.mesh().faces().len();
    format!(
        "# {program}, {at}\n\n{quantity}: {what}\n\nThis folder is a reference pack of that ray ({place} here) over {faces} of the {of} faces; its answer to the\n\
         ray is that of the whole scene. To see what is true, and to ask a program again:\n\n```sh\n{probe}\nraypencil check . CANDIDATE    # of Embree and Mitsuba reference/make.py --pack . makes one\n```\n\n\
         Of the scene {name}, {sha256}: `{again}`\n",
        at = wrong.place,
        quantity = name_of(wrong.item),
        what = wrong.what,
        probe = probe_command(small, place),
        name = subject.name,
        sha256 = scene_sha256(&subject.scene),
        again = probe_command(subject, wrong.place),
    )
}
