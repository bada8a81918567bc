//! Checks of altered and partial recordings: which errors must be found, and which differences must be accepted.

use std::path::Path;
use std::sync::Arc;

use raypencil::harness::contender;
use raypencil::io::{Overrides, Storage, load};
use raypencil::judge::{Check, Class, GroundTruth, Item, Quantity, Recorded, check};
use raypencil::pack::blind_scene;
use raypencil::referee::Format;
use raypencil::{
    FaceId, FluxModel, Image, Maybe, Pixel, Place, Precision, Profile, Request, Scene, SensorId, Silent,
};

/// The scene of a committed pack.
fn scene_of(pack: &str) -> Scene {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../data/packs").join(pack).join("scene.toml");
    load(&file.to_string_lossy(), &Overrides::default()).expect("a pack's scene").scene
}

/// The tracer's recording of a scene, declared to have this precision.
fn recorded(scene: &Scene, precision: Precision) -> Recorded {
    let output = contender("tracer").unwrap().renderer.render(scene, &Request::EVERYTHING);
    Recorded::of_output("tracer", scene, &output, precision)
}

/// Removes all other quantities from a recording.
fn keep_only(recorded: &mut Recorded, kept: &[Quantity]) {
    // No test here uses these quantities.
    let is_kept = |quantity: Quantity| {
        let is_other = matches!(
            quantity,
            Quantity::Depth
                | Quantity::Point
                | Quantity::Normal
                | Quantity::CosIncidence
                | Quantity::CosOffAxis
                | Quantity::CosView
        );
        kept.contains(&quantity) && !is_other
    };
    recorded.storage.retain(|(_, item), _| is_kept(item.quantity));
    for map in &mut recorded.answers.maps {
        if !is_kept(Quantity::Face) {
            map.face = None;
        }
        if !is_kept(Quantity::Range) {
            map.range = None;
        }
        (map.depth, map.point, map.normal, map.cos_incidence) = (None, None, None, None);
    }
    for light in &mut recorded.answers.light {
        let returns = &mut light.returns;
        if !is_kept(Quantity::Visible) {
            returns.visible = None;
        }
        if !is_kept(Quantity::Pixel) {
            returns.pixel = None;
        }
        if !is_kept(Quantity::CameraDepth) {
            returns.depth = None;
        }
        (returns.cos_off_axis, returns.cos_view) = (None, None);
        if !is_kept(Quantity::PencilFlux) {
            returns.flux = None;
        }
        if !is_kept(Quantity::PixelFlux) {
            light.image = None;
        }
    }
}

/// Checks a recording against the exact answers.
fn judged(scene: &Scene, recorded: &Recorded) -> Check {
    check(&GroundTruth::certified(scene, &Silent), recorded, &Silent)
}

#[track_caller]
fn assert_passes(found: &Check) {
    let wrong = found.sensors.iter().find_map(|sensor| sensor.defects.first());
    assert!(found.passes(), "{wrong:?}");
}

/// Column and row of all cells.
fn cells(image: &Image<f64>) -> impl Iterator<Item = (u32, u32)> + use<> {
    let (width, height) = (image.width(), image.height());
    (0..height).flat_map(move |j| (0..width).map(move |i| (i, j)))
}

#[test]
fn a_missing_pencil_near_a_border_is_a_defect() {
    let scene = scene_of("pyramids");
    let truth = GroundTruth::certified(&scene, &Silent);
    let referee = truth.judge().referee();
    let mut image_only = recorded(&scene, Precision::F64);
    let flux = image_only.answers.light[0].returns.flux.clone().unwrap();
    // Near the border, but beyond what single precision explains: met under a cosine of at least 0.3, its point is good
    // to 36 kappa u S / 0.3 = 0.09 mm (kappa 2, S 6 m), which 2.5 m away is 0.004 pixels. A filter lets nothing through
    // of some pencils.
    let incidence = image_only.answers.maps[1].cos_incidence.clone().unwrap();
    keep_only(&mut image_only, &[Quantity::PixelFlux]);
    assert_passes(&check(&truth, &image_only, &Silent));
    let near = cells(&flux).find(|&(i, j)| {
        let is_lit = flux.at(i, j) > 0.0 && incidence.at(i, j).get().is_some_and(|cosine| cosine > 0.3);
        let margins = referee.visibility_margins(0, i, j).filter(|_| is_lit);
        margins.is_some_and(|margins| {
            margins.sight.visible && margins.landing.is_some_and(|[lo, _]| lo > 0.01 && lo < 0.05)
        })
    });
    let (i, j) = near.expect("such a pencil is in this pack");
    let (_, pixel) = truth.visibility(Place { sensor: SensorId::Beam(0), i, j });
    let Pixel { i: column, j: row } = pixel.unwrap();
    let image = image_only.answers.light[0].image.as_mut().unwrap();
    image.set(column, row, (image.at(column, row) - flux.at(i, j)).max(0.0));
    for precision in [Precision::F64, Precision::F32] {
        image_only.precision = precision;
        let found = check(&truth, &image_only, &Silent);
        assert_eq!(found.of(Class::Defect), 1);
        assert_eq!(found.of(Class::Rounding), 0);
    }
}

/// A pencil, and a scene with the camera's principal point moved so that this pencil lands 1e-7 pixels right of a
/// border.
fn on_a_border() -> (Scene, Place) {
    let scene = scene_of("pyramids");
    let place = Place { sensor: SensorId::Beam(0), i: 37, j: 2 };
    let truth = GroundTruth::certified(&scene, &Silent);
    let hit = truth.hit(place).unwrap();
    assert!(truth.visibility(place).0);
    let mut camera = *scene.camera();
    let seen = camera.scene_from_sensor.inverse() * hit.point;
    let sensor = &mut camera.sensor;
    let landing = sensor.principal_point[0] + sensor.focal_length * seen.x / (seen.z * sensor.pixel_pitch[0]);
    sensor.principal_point[0] -= landing - landing.floor() - 1e-7;
    let moved = Scene::new(
        Arc::clone(scene.mesh()),
        camera,
        scene.beams().to_vec(),
        scene.atmosphere(),
        scene.flux_model(),
    );
    (moved.unwrap(), place)
}

#[test]
fn a_pencil_that_rounds_over_a_border_is_rounding_in_both_pixels() {
    let (scene, Place { i, j, .. }) = on_a_border();
    let truth = GroundTruth::certified(&scene, &Silent);
    let mut moved = recorded(&scene, Precision::F32);
    let light = &mut moved.answers.light[0];
    let flux = light.returns.flux.as_ref().unwrap().at(i, j);
    let from = light.returns.pixel.as_ref().unwrap().at(i, j).get().unwrap();
    let to = Pixel { i: from.i - 1, j: from.j };
    light.returns.pixel.as_mut().unwrap().set(i, j, Maybe::some(to));
    let image = light.image.as_mut().unwrap();
    image.set(from.i, from.j, (image.at(from.i, from.j) - flux).max(0.0));
    image.set(to.i, to.j, image.at(to.i, to.j) + flux);
    let found = check(&truth, &moved, &Silent);
    assert_passes(&found);
    // The pencil and the two pixels.
    assert_eq!(found.of(Class::Rounding), 3);

    // The image alone, with errors of single precision.
    keep_only(&mut moved, &[Quantity::PixelFlux]);
    for flux in moved.answers.light[0].image.as_mut().unwrap().cells_mut() {
        *flux *= 1.0 + 1e-7;
    }
    let found = check(&truth, &moved, &Silent);
    assert_passes(&found);
    assert_eq!(found.of(Class::Rounding), 2);
    // Only a whole pencil can cross the border.
    let image = moved.answers.light[0].image.as_mut().unwrap();
    image.set(to.i, to.j, image.at(to.i, to.j) - 0.4 * flux);
    assert_eq!(check(&truth, &moved, &Silent).of(Class::Defect), 1);
    // In double precision no pencil can cross the border.
    moved.answers.light[0].image.as_mut().unwrap().set(to.i, to.j, image_at(&truth, to) + flux);
    moved.precision = Precision::F64;
    assert!(!check(&truth, &moved, &Silent).passes());
}

/// The exact flux of a pixel by beam 0, W.
fn image_at(truth: &GroundTruth<'_>, pixel: Pixel) -> f64 {
    truth.answers().light[0].image.as_ref().unwrap().at(pixel.i, pixel.j)
}

#[test]
fn a_pencil_off_the_image_delivers_no_flux() {
    let scene = scene_of("facets");
    let truth = GroundTruth::certified(&scene, &Silent);
    let off = (0..4)
        .flat_map(|j| (0..128).map(move |i| Place { sensor: SensorId::Beam(1), i, j }))
        .find(|place| truth.hit(*place).is_some() && truth.visibility(*place) == (false, None))
        .expect("some pencils of this pack land off the image");
    for without in [[].as_slice(), &[Quantity::Visible], &[Quantity::Visible, Quantity::Pixel]] {
        let mut altered = recorded(&scene, Precision::F64);
        let all = Quantity::ALL.into_iter().filter(|quantity| !without.contains(quantity));
        keep_only(&mut altered, &all.collect::<Vec<_>>());
        assert_passes(&check(&truth, &altered, &Silent));
        altered.answers.light[1].returns.flux.as_mut().unwrap().set(off.i, off.j, 1e3);
        let found = check(&truth, &altered, &Silent);
        assert_eq!(found.of(Class::Defect), 1, "without {without:?}");
    }
}

#[test]
fn a_visible_hit_has_a_pixel() {
    let scene = scene_of("pyramids");
    let mut altered = recorded(&scene, Precision::F64);
    keep_only(&mut altered, &[Quantity::Face, Quantity::Range, Quantity::Pixel, Quantity::PencilFlux]);
    let pixels = altered.answers.light[0].returns.pixel.as_mut().unwrap();
    let landed = pixels.cells().iter().filter(|pixel| pixel.get().is_some()).count() as u64;
    pixels.cells_mut().fill(Maybe::NONE);
    let found = judged(&scene, &altered);
    let of_pixel = &found.totals()[&Quantity::Pixel.into()];
    assert_eq!(of_pixel.of(Class::Defect), landed);
}

#[test]
fn a_value_is_present_exactly_where_a_ray_hits() {
    let scene = scene_of("facets");
    let truth = GroundTruth::certified(&scene, &Silent);
    let mut altered = recorded(&scene, Precision::F64);
    keep_only(&mut altered, &[Quantity::CameraDepth]);
    assert_passes(&check(&truth, &altered, &Silent));
    let depth = altered.answers.light[0].returns.depth.clone().unwrap();
    let places: Vec<_> = (0..4).flat_map(|j| (0..128).map(move |i| (i, j))).collect();
    let hit = places.iter().copied().find(|&(i, j)| depth.at(i, j).get().is_some()).unwrap();
    let beam = usize::from(places.iter().all(|&(i, j)| depth.at(i, j).get().is_some()));
    let depth = altered.answers.light[beam].returns.depth.clone().unwrap();
    let miss = places.iter().copied().find(|&(i, j)| depth.at(i, j).get().is_none()).expect("a miss");
    for ((beam, (i, j)), value) in [((0, hit), Maybe::NONE), ((beam, miss), Maybe::some(3.0))] {
        let mut altered = altered.clone();
        altered.answers.light[beam].returns.depth.as_mut().unwrap().set(i, j, value);
        assert_eq!(check(&truth, &altered, &Silent).of(Class::Defect), 1);
    }
}

#[test]
fn each_beams_image_is_checked_in_its_own_storage_type() {
    let scene = scene_of("pyramids");
    let mut altered = recorded(&scene, Precision::F64);
    altered.answers.light[0].image.as_mut().unwrap().cells_mut().fill(0.0);
    altered.storage.insert((SensorId::Camera, Item::of_image(1)), Storage::F16);
    let found = judged(&scene, &altered);
    assert!(found.of(Class::Defect) > 50);
    let totals = found.totals();
    assert!(totals[&Item::of_image(0)].of(Class::Defect) > 50);
    // Half precision cannot hold so small a flux: only pixels with exactly 0 are compared.
    let second = &totals[&Item::of_image(1)];
    assert!(second.not_compared > 50 && second.not_compared == second.unjudged.len() as u64);
    assert_eq!(second.of(Class::Defect), 0);
    // A value far too large is a defect all the same.
    let image = altered.answers.light[1].image.as_mut().unwrap();
    image.set(3, 3, 0.5);
    assert!(judged(&scene, &altered).totals()[&Item::of_image(1)].of(Class::Defect) == 1);
}

#[test]
fn faces_that_tie_may_deliver_different_flux() {
    // Faces are copied with other materials: a recording without face indices may contain either.
    let (scene, place, face) = (1..40)
        .find_map(|seed| {
            let scene = blind_scene(seed).unwrap();
            let found = {
                let truth = GroundTruth::certified(&scene, &Silent);
                tied(&truth)
            };
            found.map(|(place, face)| (scene, place, face))
        })
        .expect("a seed with such a pencil");
    let truth = GroundTruth::certified(&scene, &Silent);
    let SensorId::Beam(beam) = place.sensor else { panic!("a pencil") };
    let Place { i, j, .. } = place;
    let (visible, pixel) = truth.visibility(place);
    let back = truth.judge().rounded_return(place, face, visible, pixel).unwrap();
    let other = back.in_format(Format::Double, scene.flux_model()).flux;
    for kept in [
        [Quantity::Range, Quantity::PencilFlux, Quantity::Pixel, Quantity::PixelFlux].as_slice(),
        &[Quantity::PencilFlux],
        &[Quantity::PixelFlux],
    ] {
        let mut taken = recorded(&scene, Precision::F64);
        let light = &mut taken.answers.light[beam];
        let flux = light.returns.flux.as_mut().unwrap();
        let own = flux.at(i, j);
        flux.set(i, j, other);
        let Pixel { i: column, j: row } = pixel.unwrap();
        let image = light.image.as_mut().unwrap();
        image.set(column, row, image.at(column, row) - own + other);
        keep_only(&mut taken, kept);
        assert_passes(&check(&truth, &taken, &Silent));
    }
}

/// A visible pencil, and a face that ties with the hit face and delivers another flux.
fn tied(truth: &GroundTruth<'_>) -> Option<(Place, FaceId)> {
    let model: FluxModel = truth.scene().flux_model();
    for beam in 0..truth.scene().beams().len() {
        let sensor = SensorId::Beam(beam);
        let (columns, rows) = truth.scene().size(sensor)?;
        for place in (0..rows).flat_map(|j| (0..columns).map(move |i| Place { sensor, i, j })) {
            let (true, Some(pixel)) = truth.visibility(place) else { continue };
            let verdict = truth.judge().referee().verdict(sensor, place.i, place.j)?;
            for face in verdict.faces.into_iter().skip(1) {
                let back = truth.judge().rounded_return(place, face, true, Some(pixel))?;
                let flux = back.in_format(Format::Double, model).flux;
                if flux > 0.0 && (flux / truth.flux(place)[0] - 1.0).abs() > 0.1 {
                    return Some((place, face));
                }
            }
        }
    }
    None
}

#[test]
fn underflow_in_single_precision_is_not_taken_for_hidden() {
    // A narrow Gaussian: the flux of outer pencils is below the smallest single-precision number.
    let scene = scene_of("pyramids");
    let mut beams = scene.beams().to_vec();
    beams[0].sensor.profile = Profile::Gaussian { half_width: 0.03 };
    let scene =
        Scene::new(Arc::clone(scene.mesh()), *scene.camera(), beams, scene.atmosphere(), scene.flux_model())
            .unwrap();
    let mut single = recorded(&scene, Precision::F32);
    keep_only(&mut single, &[Quantity::Face, Quantity::Range, Quantity::PencilFlux]);
    let flux = single.answers.light[0].returns.flux.as_mut().unwrap();
    flux.cells_mut().iter_mut().for_each(|flux| *flux = f64::from(*flux as f32));
    assert!(flux.cells().iter().filter(|flux| **flux == 0.0).count() > 100);
    for (_, storage) in
        single.storage.iter_mut().filter(|((_, item), _)| item.quantity == Quantity::PencilFlux)
    {
        *storage = Storage::F32;
    }
    assert_passes(&judged(&scene, &single));
}
