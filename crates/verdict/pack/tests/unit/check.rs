//! Which answers of a pack are asked about where a candidate is wrong, and what a check refuses.

use raypencil_files::write_npy;
use raypencil_scene::{Image, Maybe, Silent};

use super::*;

fn hard() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../data/packs/hard")
}

/// The place of the first answer by which a candidate is wrong and which is not the referee's. `forge` changes the pack's answers, and
/// `given` makes the candidate of the one that has all of them.
fn first_forged(forge: &dyn Fn(&mut Answers), given: &dyn Fn(Recorded, &Scene) -> Recorded) -> Option<Place> {
    let manifest = Manifest::read(hard()).expect("a manifest");
    let scene = manifest.load_scene(hard()).expect("a scene").scene;
    let declared = Declarations::default();
    let channels = Recorded::channels(&hard(), &scene, &declared.declared()).expect("channels");
    let whole = Recorded::of_folder(&hard(), &scene, Precision::F64, &channels, declared.conventions());
    let candidate = given(whole.expect("a candidate"), &scene);
    let mut answers = read_answers(&hard(), &manifest, &scene, true).expect("answers").into_answers();
    forge(&mut answers);
    let truth = GroundTruth::of_answers(&scene, answers);
    let found = check(&truth, &candidate, &Silent);
    assert!(!found.passes());
    first_wrong_answer(&truth, &found).map(|found| found.place)
}

/// Makes the first range of a map 1 m longer, and returns where it is.
fn lengthen(answers: &mut Answers, sensor: SensorId) -> Place {
    let at = match sensor {
        SensorId::Camera => 0,
        SensorId::Beam(beam) => 1 + beam,
    };
    let ranges = answers.maps[at].range.as_mut().expect("ranges");
    let at = ranges.cells().iter().position(|range| range.get().is_some()).expect("a hit");
    let cell = &mut ranges.cells_mut()[at];
    *cell = Maybe::from(cell.get().map(|range| range + 1.0));
    Place { sensor, i: at as u32 % ranges.width(), j: at as u32 / ranges.width() }
}

/// A candidate that gives nothing.
fn empty(scene: &Scene) -> Recorded {
    Recorded::without_maps(&hard(), scene, Precision::F64)
}

#[test]
fn an_answer_by_which_a_right_candidate_is_wrong_is_asked_about_and_no_other() {
    // The candidate has the referee's answers, and the pack a range that is not: the candidate is wrong by it.
    let at = std::cell::Cell::new(None);
    let forge = |answers: &mut Answers| at.set(Some(lengthen(answers, SensorId::Beam(0))));
    assert_eq!(first_forged(&forge, &|whole, _| whole), at.get());
    // Who gives the ranges of the camera alone, and is wrong there, is not wrong by that of the beam.
    let camera_alone = |mut whole: Recorded, scene: &Scene| {
        lengthen(&mut whole.answers, SensorId::Camera);
        let mut alone = empty(scene);
        alone.answers.maps[0].range = whole.answers.maps[0].range.take();
        alone.storage.insert((SensorId::Camera, Quantity::Range.into()), Storage::F64);
        alone
    };
    assert_eq!(first_forged(&forge, &camera_alone), None);
}

#[test]
fn who_gives_images_alone_may_be_wrong_by_any_pencil() {
    // A pencil has twice its flux, and so has its pixel of the image: the sums agree, and none of the camera's rays is wrong.
    let at = std::cell::Cell::new(None);
    let forge = |answers: &mut Answers| {
        let light = &mut answers.light[1];
        let flux = light.returns.flux.as_mut().expect("fluxes");
        let cell = flux.cells().iter().position(|flux| *flux > 0.0).expect("a pencil that comes back");
        let more = flux.cells()[cell];
        flux.cells_mut()[cell] += more;
        let pencil = (cell as u32 % flux.width(), cell as u32 / flux.width());
        let pixel = light.returns.pixel.as_ref().and_then(|pixel| pixel.at(pencil.0, pencil.1).get());
        let pixel = pixel.expect("a pixel");
        let image = light.image.as_mut().expect("an image");
        let cell = (pixel.j * image.width() + pixel.i) as usize;
        image.cells_mut()[cell] += more;
        at.set(Some(Place { sensor: SensorId::Beam(1), i: pencil.0, j: pencil.1 }));
    };
    let images_alone = |whole: Recorded, scene: &Scene| {
        let mut alone = empty(scene);
        for (beam, light) in whole.answers.light.into_iter().enumerate() {
            alone.answers.light[beam].image = light.image;
            alone.storage.insert((SensorId::Camera, Item::of_image(beam)), Storage::F64);
        }
        alone
    };
    assert_eq!(first_forged(&forge, &images_alone), at.get());
}

#[test]
fn a_pack_that_is_no_published_one_is_refused_without_a_map_of_each_sensor_in_single_precision() {
    let folder = tempfile::tempdir().expect("a folder");
    let whole = Manifest::read(hard()).expect("a manifest");
    for file in &whole.files {
        let to = folder.path().join(&file.path);
        std::fs::create_dir_all(to.parent().expect("a folder")).expect("a folder");
        std::fs::copy(hard().join(&file.path), to).expect("a file");
    }
    let refused = |is_left_out: fn(&str) -> bool| {
        let mut manifest = whole.clone();
        manifest.version = None;
        manifest.files.retain(|file| !is_left_out(&file.path));
        manifest.write(folder.path()).expect("a manifest");
        check_pack(folder.path(), &hard(), None, &Silent).expect_err("no map").to_string()
    };
    let none = refused(|path| path.ends_with(".exr"));
    assert!(none.contains("no EXR file with answers that manifest.json lists; expected"), "{none}");
    // What is listed counts, and not what else lies there; an array in double precision is none in single precision.
    let one = refused(|path| path == "beam-1.exr");
    assert!(one.contains("of beam-1 in an EXR file that manifest.json lists; expected"), "{one}");
}

#[test]
fn help_is_that_of_the_candidate_alone() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::create_dir(folder.path().join("camera")).expect("a folder");
    write_npy(folder.path().join("camera/mine.npy"), &[&Image::filled(24, 18, 2.0)]).expect("an array");
    let refused = |pack: &Path| check_pack(pack, folder.path(), None, &Silent).expect_err("no map").help();
    let help = refused(&hard()).expect("a candidate without a map that is known");
    assert!(help.contains("--channel camera/depth.Z="), "{help}");
    assert_eq!(refused(folder.path()), None);
}
