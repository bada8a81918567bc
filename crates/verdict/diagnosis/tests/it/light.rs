//! Mistakes in the light of pencils alone: what they meet is right.

use std::sync::Arc;

use raypencil_judge::{Quantity, Recorded};
use raypencil_scene::{Image, Maybe, Scene, SensorId};

use super::candidates::*;

fn visible(candidate: &mut Recorded, beam: usize) -> &mut Image<bool> {
    candidate.answers.light[beam].returns.visible.as_mut().unwrap()
}

fn cells(image: &Image<bool>) -> impl Iterator<Item = (u32, u32)> + use<> {
    let (width, height) = (image.width(), image.height());
    (0..height).flat_map(move |j| (0..width).map(move |i| (i, j)))
}

/// What a program says that calls each hit visible which faces the camera and lands on a pixel; and how many that changed.
fn without_shadows(bench: &Bench) -> (Recorded, usize) {
    let mut candidate = bench.exact.clone();
    let mut changed = 0;
    let exact = bench.exact.answers.clone();
    for (beam, light) in exact.light.iter().enumerate() {
        let returns = &light.returns;
        let at =
            |image: &Option<Image<Maybe<f64>>>, (i, j): (u32, u32)| image.as_ref().unwrap().at(i, j).get();
        for (i, j) in cells(returns.visible.as_ref().unwrap()) {
            let faces_it = at(&returns.cos_view, (i, j)).is_some_and(|cosine| cosine > 0.0);
            let Some(pixel) = returns.pixel.as_ref().unwrap().at(i, j).get() else { continue };
            if !faces_it || returns.visible.as_ref().unwrap().at(i, j) {
                continue;
            }
            changed += 1;
            let own = &mut candidate.answers.light[beam];
            own.returns.visible.as_mut().unwrap().set(i, j, true);
            own.returns.flux.as_mut().unwrap().set(i, j, 1e-12);
            let image = own.image.as_mut().unwrap();
            image.set(pixel.i, pixel.j, image.at(pixel.i, pixel.j) + 1e-12);
        }
    }
    // The other model's flux is not what this is about.
    candidate.storage.retain(|(_, item), _| !item.is_other_model);
    (candidate, changed)
}

#[test]
fn hits_that_nothing_hides_are_a_missing_shadow_test() {
    let bench = pyramids();
    let (candidate, changed) = without_shadows(bench);
    assert!(changed >= 24, "only {changed} hits are hidden by a face");
    let told = bench.reasons(&candidate);
    assert!(told.iter().any(|one| one.ends_with(": no_shadow_test")), "{told:?}");
    // Each pixel of the camera is the sum of its pencils, and these are wrong.
    assert!(told.iter().any(|one| one == "camera: flux_of_wrong_pencils"), "{told:?}");

    // Half of the hidden hits are said to be hidden: there is a shadow test.
    let mut all = candidate;
    for beam in 0..2 {
        let is_seen = bench.exact.answers.light[beam].returns.visible.as_ref().unwrap();
        for (i, j) in cells(is_seen).filter(|(i, j)| (i + j) % 2 == 0) {
            visible(&mut all, beam).set(i, j, is_seen.at(i, j));
        }
    }
    let told = bench.reasons(&all);
    assert!(told.iter().all(|one| !one.contains("no_shadow_test")), "{told:?}");
}

#[test]
fn visible_hits_alone_are_not_taken_for_a_reversed_flag() {
    let bench = pyramids();
    let mut candidate = bench.exact.clone();
    candidate.storage.retain(|(_, item), _| !item.is_other_model);
    for beam in 0..2 {
        let returns = &bench.exact.answers.light[beam].returns;
        for (i, j) in cells(returns.visible.as_ref().unwrap()) {
            let is_hit = returns.cos_view.as_ref().unwrap().at(i, j).get().is_some();
            visible(&mut candidate, beam).set(i, j, is_hit);
        }
    }
    // Flux and image stay: a pencil that is called visible should have some, and it is told that it has none.
    candidate.storage.retain(|(_, item), _| item.quantity == Quantity::Visible);
    let told = bench.reasons(&candidate);
    assert!(!told.is_empty() && told.iter().all(|one| !one.contains("visible_reversed")), "{told:?}");

    // Seen ones are called hidden, and misses are left as they are.
    let mut hidden = bench.exact.clone();
    for beam in 0..2 {
        let returns = &bench.exact.answers.light[beam].returns;
        for (i, j) in cells(returns.visible.as_ref().unwrap()) {
            if returns.cos_view.as_ref().unwrap().at(i, j).get().is_some() {
                let seen = returns.visible.as_ref().unwrap().at(i, j);
                visible(&mut hidden, beam).set(i, j, !seen);
            }
        }
    }
    assert_eq!(bench.reasons(&hidden), ["beam-0, beam-1: visible_reversed"]);
}

#[test]
fn flags_that_are_never_set_are_not_taken_for_reversed_ones() {
    // Every hit of these pencils is seen: without a hidden one nobody knows whether flags are reversed, or not written.
    let few = few_pyramids().scene;
    let (mesh, camera, mut beams) = (Arc::clone(few.mesh()), *few.camera(), few.beams().to_vec());
    for beam in &mut beams {
        // From where the camera is, in a narrow fan.
        beam.scene_from_sensor = camera.scene_from_sensor;
        (beam.sensor.columns, beam.sensor.rows, beam.sensor.half_width) =
            (24, 1, 0.1 * beam.sensor.grid_distance);
    }
    let bench = Bench::of(Scene::new(mesh, camera, beams, few.atmosphere(), few.flux_model()).unwrap());
    let mut candidate = bench.exact.clone();
    candidate.storage.retain(|(_, item), _| item.quantity == Quantity::Visible);
    let mut all_seen = 0;
    for beam in 0..2 {
        let returns = &bench.exact.answers.light[beam].returns;
        let flags = returns.visible.as_ref().unwrap();
        let is_hit = |(i, j): &(u32, u32)| returns.cos_view.as_ref().unwrap().at(*i, *j).get().is_some();
        let seen: Vec<bool> = cells(flags).filter(is_hit).map(|(i, j)| flags.at(i, j)).collect();
        all_seen += usize::from(seen.len() >= 12 && seen.iter().all(|seen| *seen));
        visible(&mut candidate, beam).cells_mut().fill(false);
    }
    assert!(all_seen > 0, "each beam has hidden hits");
    assert_eq!(bench.reasons(&candidate), [""; 0]);
}

#[test]
fn visibility_the_other_way_round_is_told_of_its_beam() {
    let bench = pyramids();
    let mut candidate = bench.exact.clone();
    visible(&mut candidate, 1).cells_mut().iter_mut().for_each(|one| *one = !*one);
    assert_eq!(bench.reasons(&candidate), ["beam-1: visible_reversed"]);
}

#[test]
fn flux_of_exchanged_beams_is_told_of_the_camera() {
    let bench = pyramids();
    let mut candidate = bench.exact.clone();
    let [a, b] = [0, 1].map(|beam| bench.exact.answers.light[beam].clone());
    for (own, other) in [(0, &b), (1, &a)] {
        candidate.answers.light[own].image.clone_from(&other.image);
        candidate.answers.light[own].other_image.clone_from(&other.other_image);
    }
    assert_eq!(bench.reasons(&candidate), ["camera: beam_flux_exchanged"]);
}

#[test]
fn an_image_of_wrong_pencils_has_them_for_a_reason() {
    let bench = pyramids();
    let mut candidate = bench.exact.clone();
    candidate.storage.retain(|(_, item), _| !item.is_other_model);
    // Each pencil has an error of its own: no reason is known. The image is the sum of them.
    let returns = &mut candidate.answers.light[0].returns;
    let flux = returns.flux.as_mut().unwrap();
    let size = (flux.width(), flux.height());
    let mut sum = Image::filled(bench.exact.answers.light[0].image.as_ref().unwrap().width(), 36, 0.0);
    for (i, j) in (0..size.1).flat_map(|j| (0..size.0).map(move |i| (i, j))) {
        flux.set(i, j, flux.at(i, j) * (1.0 + 0.1 * libm::sin(f64::from(7 * i + 31 * j))));
        if let Some(pixel) = returns.pixel.as_ref().unwrap().at(i, j).get() {
            sum.set(pixel.i, pixel.j, sum.at(pixel.i, pixel.j) + flux.at(i, j));
        }
    }
    candidate.answers.light[0].image = Some(sum.clone());
    let found = bench.diagnosis(&candidate).unwrap();
    assert_eq!(bench.reasons(&candidate), ["camera: flux_of_wrong_pencils"]);
    assert_eq!(found.unexplained, [SensorId::Beam(0)]);

    // Another sum is not what the pencils say.
    sum.cells_mut()
        .iter_mut()
        .enumerate()
        .for_each(|(index, one)| *one *= 1.0 + 0.2 * f64::from(index as u32 % 7));
    candidate.answers.light[0].image = Some(sum);
    assert_eq!(bench.reasons(&candidate), [""; 0]);
}

#[test]
fn distances_from_the_camera_are_no_depths() {
    let bench = pyramids();
    let mut candidate = bench.exact.clone();
    for beam in 0..2 {
        let returns = &mut candidate.answers.light[beam].returns;
        let cosines = returns.cos_off_axis.clone().unwrap();
        let depths = returns.depth.as_mut().unwrap();
        for (i, j) in cells(bench.exact.answers.light[beam].returns.visible.as_ref().unwrap()) {
            let distance =
                depths.at(i, j).get().zip(cosines.at(i, j).get()).map(|(depth, cosine)| depth / cosine);
            depths.set(i, j, distance.into());
        }
    }
    let told = bench.reasons(&candidate);
    assert_eq!(told, ["beam-0, beam-1: distance_for_view"]);
}
