//! How sharp benches are, and that the measure tells blunt ones from sharp ones.

use raypencil_judge::{Class, GroundTruth, Quantity, Recorded, check};
use raypencil_naive::{Lax, Naive, Slack};
use raypencil_scene::{Image, Precision, Renderer, Request, Scene, Silent};
use raypencil_scene_io::{Overrides, Subject, load, load_text, scene_sha256};

use super::*;
use crate::bench::{Edition, has_bench, with_bench_of};
use crate::blind::blind_scene_of;
use crate::{Manifest, PackKind, PackLabel, check_pack, write_pack, write_questions};

/// The scene of the pack `hard`, without a bench.
fn hard() -> Scene {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../data/scenes/packs/hard.toml");
    load(file, &Overrides::default()).expect("a scene").scene
}

fn measured(edition: Edition) -> Vec<Sharpness> {
    let scene = with_bench_of(&hard(), edition).expect("room");
    sharpness(&scene, Precision::F64, &Silent).expect("a scene")
}

/// The digest of a scene is of every coordinate of every face and of every number of every beam: where a row, a plate or a corner that
/// bites stands elsewhere, the packs that people have are no longer those of this version.
#[test]
fn the_bench_of_each_edition_is_that_of_the_published_packs() {
    let digest = |edition| scene_sha256(&with_bench_of(&hard(), edition).expect("room"));
    // By the manifest of the version 1.0.0, whose own digest `PUBLISHED` has.
    let first = "4a8e84e83da44a75dec0503c1c6403b1da5a0a8aeacbe80700d487accadd68f6";
    assert_eq!(digest(Edition::First), first);
    let pack = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../data/packs/hard");
    assert_eq!(digest(Edition::Second), Manifest::read(pack).expect("a manifest").scene.sha256);
}

#[test]
fn the_first_bench_lets_large_tolerances_pass_and_the_second_none() {
    let (first, second) = (measured(Edition::First), measured(Edition::Second));
    let noticed = |all: &[Sharpness], slack: Slack| {
        all.iter().find(|one| one.slack == slack).and_then(|one| one.noticed).unwrap_or(f64::INFINITY)
    };
    // A shadow bias, shadow rays that stop short, a face that is decided beside the pencil, and a farther face.
    for (slack, least) in [
        (Slack::ShadowStartsAway, 1e-2),
        (Slack::ShadowStopsShort, 1e-1),
        (Slack::ShiftDown, 1e-4),
        (Slack::FartherFace, 1e-3),
    ] {
        assert!(noticed(&first, slack) >= least, "{slack:?}: {:e}", noticed(&first, slack));
        assert!(noticed(&second, slack) <= 1e-4 * least, "{slack:?}: {:e}", noticed(&second, slack));
    }
    assert!(!first.iter().all(Sharpness::suffices));
    assert_eq!(second.len(), Slack::ALL.len());
    for one @ Sharpness { slack, noticed, .. } in second {
        assert!(one.suffices(), "{one:?}");
        // One of 1, 2 and 5 times a power of ten, and no larger than what is worth trying.
        let size = noticed.expect("a size");
        assert!(["1e", "2e", "5e"].iter().any(|digit| format!("{size:e}").starts_with(digit)), "{size:e}");
        assert!(size <= slack.largest());
    }
}

#[test]
fn a_bench_is_known_by_its_beams_and_not_by_their_sizes() {
    let of = |pack: &str| {
        let file = format!("{}/../../../data/packs/{pack}/scene.toml", env!("CARGO_MANIFEST_DIR"));
        load(&file, &Overrides::default()).expect("a scene").scene
    };
    for pack in ["facets", "hard", "pyramids"] {
        assert!(has_bench(&of(pack)), "{pack}");
    }
    // The same beams in another order, and the last one a millimetre beside its place.
    let scene = of("hard");
    let with = |beams| {
        let (mesh, air) = (Arc::clone(scene.mesh()), scene.atmosphere());
        Scene::new(mesh, *scene.camera(), beams, air, scene.flux_model()).expect("a scene")
    };
    let mut beams = scene.beams().to_vec();
    beams.rotate_right(1);
    assert!(!has_bench(&with(beams)));
    let mut beams = scene.beams().to_vec();
    beams.last_mut().expect("a beam").scene_from_sensor.position.x += 1e-3;
    assert!(!has_bench(&with(beams)));
}

#[test]
fn the_smallest_size_fails_a_check_and_the_next_smaller_one_passes() {
    let scene = with_bench_of(&hard(), Edition::Second).expect("room");
    let truth = GroundTruth::certified(&scene, &Silent);
    let defects = |slack: Slack, size: f64| {
        let lax = Lax { slack, size }.render(&scene, &Request::EVERYTHING);
        let recorded = Recorded::of_output("lax", &scene, &lax, Precision::F64);
        check(&truth, &recorded, &Silent).of(Class::Defect)
    };
    let found = measured(Edition::Second);
    // One of each kind: rays, a limit along the ray, shadows, landing.
    for slack in [Slack::ShiftUp, Slack::PlaneEarlier, Slack::ShadowStartsAway, Slack::LandsLeft] {
        let noticed =
            found.iter().find(|one| one.slack == slack).and_then(|one| one.noticed).expect("a size");
        assert_ne!(defects(slack, noticed), 0, "{slack:?} {noticed:e}");
        // Of 1, 2 and 5 times a power of ten, the next smaller is at least 0.4 times as large.
        assert_eq!(defects(slack, 0.4 * noticed), 0, "{slack:?} {noticed:e}");
    }
}

#[test]
fn who_states_no_pixel_may_see_what_lands_beside_the_image_by_rounding_alone() {
    let scene = with_bench_of(&hard(), Edition::Second).expect("room");
    let truth = GroundTruth::certified(&scene, &Silent);
    let defects = |size: f64| {
        let lax = Lax { slack: Slack::ImageWider, size }.render(&scene, &Request::EVERYTHING);
        let mut recorded = Recorded::of_output("lax", &scene, &lax, Precision::F32);
        recorded
            .storage
            .retain(|(_, item), _| item.quantity == Quantity::Visible || item.quantity == Quantity::Face);
        for light in &mut recorded.answers.light {
            (light.returns.pixel, light.returns.flux, light.image) = (None, None, None);
        }
        check(&truth, &recorded, &Silent).of(Class::Defect)
    };
    // Points lie 2e-9, 1e-8, 1e-7, 1e-5, 3e-3 and 1e-2 of a pixel beside the image.
    assert_eq!(defects(1e-6), 0);
    assert_ne!(defects(0.02), 0);
}

#[test]
fn a_slack_without_size_is_the_honest_renderer() {
    let scene = with_bench_of(&hard(), Edition::Second).expect("room");
    let honest = Naive { fault: None }.render(&scene, &Request::EVERYTHING);
    for slack in Slack::ALL {
        let lax = Lax { slack: *slack, size: 0.0 }.render(&scene, &Request::EVERYTHING);
        assert_eq!(format!("{:?}", lax.beams), format!("{:?}", honest.beams), "{slack:?}");
        assert_eq!(format!("{:?}", lax.returns), format!("{:?}", honest.returns), "{slack:?}");
    }
}

#[test]
fn packs_of_the_first_edition_are_still_checked() {
    let folder = tempfile::tempdir().expect("a folder");
    let of = |scene: Scene, name: &str| {
        let loaded = load_text("version = 1\n", name).expect("a scene");
        let arguments = loaded.name.clone();
        Subject { sha256: scene_sha256(&scene), scene, ..loaded.into_subject(arguments) }
    };
    let pack = folder.path().join("hard");
    let subject = of(with_bench_of(&hard(), Edition::First).expect("room"), "hard");
    let label = PackLabel { version: Some("0.9.0".into()), licence: None };
    let manifest = write_pack(&subject, None, &label, &pack, &Silent).expect("a pack");
    assert!(manifest.sharpness.is_empty(), "only the second bench is measured");
    assert_eq!(manifest.clauses.len(), 51, "as many as the published pack has");
    let checked = check_pack(&pack, &pack, None, &Silent).expect("a check");
    assert!(checked.passes());
    // Nobody has published this one: all of its answers are compared with the referee's, and not a sample.
    assert_eq!(checked.verified.answers, checked.verified.of);
    // The answers are those of the pack `hard` with the version 1.0.0.
    let of_beam = manifest.files.iter().find(|file| file.path == "beam-5.exr").expect("a map");
    assert_eq!(of_beam.sha256, "a52c90ab8cf91a90e99c04c8dc52fca812b7b205431272546d74f4073abbcf83");

    // A blind pack of the first edition: its scene is that of its seed.
    let blind = folder.path().join("blind-7");
    let subject = of(blind_scene_of(7, Edition::First).expect("a scene"), "blind-7");
    let mut manifest = write_questions(&subject, &blind, &Silent).expect("a pack");
    manifest.kind = PackKind::Blind;
    // A candidate that meets nothing.
    let candidate = folder.path().join("candidate");
    std::fs::create_dir_all(candidate.join("camera")).expect("a folder");
    let nothing = Image::filled(96, 72, f64::NAN);
    raypencil_files::write_npy(candidate.join("camera/range.T.npy"), &[&nothing]).expect("an array");
    for (seed, is_its_seed) in [(7, true), (8, false)] {
        manifest.blind_seed = Some(seed);
        manifest.write(&blind).expect("a manifest");
        let checked = check_pack(&blind, &candidate, None, &Silent);
        let error = checked.err().map_or(String::new(), |error| error.to_string());
        assert_eq!(error.contains("its scene differs from that of seed"), !is_its_seed, "{error}");
    }
}
