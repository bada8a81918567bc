//! Where else a pencil might land by the arithmetic of a recording that does not say where it does.

use crate::bounds::Bounds;
use crate::check::pencil::return_bounds;
use crate::check::said::flux_bound;
use crate::check::truth::Truth;
use crate::recorded::Recorded;
use raypencil_referee::{Format, Ruling};
use raypencil_scene::Place;
use raypencil_scene::{FaceId, Pixel, SensorId};

/// A pencil is looked at more closely if its answer changes within so many cells, or pixels: far more than the
/// arithmetic of any recording displaces a ray by, and cheap enough.
const CLOSE: f64 = 1e-2;

/// Light that may be in a pixel's sum or not; less than 0 if it is truly there.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Possible {
    pub(super) pixel: Pixel,
    /// By the scene's model, and by the other.
    pub(super) flux: [f64; 2],
    /// How far the recording's own may be off.
    pub(super) bound: [f64; 2],
}

/// What a pencil may add to pixels, or take from its own, if it is not certain by the arithmetic of the recording
/// where it lands.
pub(crate) fn alternatives(truth: &Truth<'_>, recorded: &Recorded, place: Place) -> Vec<Possible> {
    let Place { sensor, i, j } = place;
    let SensorId::Beam(beam) = sensor else { return Vec::new() };
    let (judge, referee) = (truth.judge(), truth.judge().referee());
    let Some(margins) = referee.margins(sensor, i, j) else { return Vec::new() };
    let sight = referee.visibility_margins(beam, i, j);
    let is_close = |sight: &raypencil_referee::VisibilityMargins| {
        sight.visibility.lo < CLOSE || sight.landing.is_none_or(|[lo, _]| lo < CLOSE)
    };
    if margins.face.lo >= CLOSE && margins.verdict.faces.len() < 2 && !sight.as_ref().is_some_and(is_close) {
        return Vec::new();
    }
    let precision = recorded.precision;
    let true_face = truth.hit(place).map(|hit| hit.face);
    let (seen, pixel) = truth.sight(place);
    let true_pixel = pixel.filter(|_| seen);

    // Every admissible face, those that tie among them, and of each every admissible pixel.
    let mut faces: Vec<FaceId> = true_face.into_iter().collect();
    for face in judge.candidate_faces(place, None, precision) {
        let is_admissible = || !matches!(judge.rule(place, Some(face), None, precision), Ruling::Wrong);
        if Some(face) != true_face && is_admissible() {
            faces.push(face);
        }
    }
    let camera = &truth.scene().camera().sensor;
    let model = truth.scene().flux_model();
    let ray = truth.scene().ray(sensor, i, j).expect("a pencil of this scene");
    let mut found: Vec<Possible> = Vec::new();
    let mut true_flux = None;
    for face in faces {
        let Some(hit) = judge.plane_hit(place, face) else { continue };
        let of_hit = Bounds::of(truth.scene().mesh(), face, &ray, hit.range, precision);
        let about = landing_near(truth, hit.point.to_array(), pixel);
        for pixel in about.into_iter().filter(|pixel| pixel.i < camera.width && pixel.j < camera.height) {
            let is_true = Some(face) == true_face && Some(pixel) == true_pixel;
            let is_admissible = || {
                let ruling =
                    judge.rule_visibility(place, face, Some(hit.range), true, Some(pixel), precision);
                ruling.is_some_and(|ruling| ruling.visible != Ruling::Wrong && ruling.pixel != Ruling::Wrong)
            };
            if !is_true && !is_admissible() {
                continue;
            }
            let Some(back) = judge.rounded_return(place, face, true, Some(pixel)) else { continue };
            let flux = [model, model.other()].map(|model| back.in_format(Format::Double, model).flux);
            let bounds = return_bounds(truth, beam, i, &hit, &back, &of_hit, precision);
            let bound = [flux_bound(&bounds[0], flux[0]), flux_bound(&bounds[1], flux[1])];
            let option = Possible { pixel, flux, bound };
            if is_true {
                true_flux = Some(option);
            } else {
                found.push(option);
            }
        }
    }
    // It may be missing where it is only if it may be elsewhere, or hidden, or lost.
    let Some(there) = true_flux else { return found };
    let may_be_hidden = || {
        let face = true_face?;
        let hit = judge.plane_hit(place, face)?;
        let ruling = judge.rule_visibility(place, face, Some(hit.range), false, pixel, precision)?;
        Some(ruling.visible != Ruling::Wrong)
    };
    let may_miss = || !matches!(judge.rule(place, None, None, precision), Ruling::Wrong);
    if !found.is_empty() || may_be_hidden() == Some(true) || may_miss() {
        found.push(Possible { flux: there.flux.map(|flux| -flux), ..there });
    }
    found
}

/// The pixel in which a point lands, roughly, and those around it; and those around the true one.
fn landing_near(truth: &Truth<'_>, point: [f64; 3], true_pixel: Option<Pixel>) -> Vec<Pixel> {
    let camera = truth.scene().camera();
    let seen = camera.scene_from_sensor.inverse() * glam::DVec3::from_array(point);
    let at = |part: f64, axis: usize| {
        let sensor = &camera.sensor;
        sensor.focal_length * part / seen.z / sensor.pixel_pitch[axis] + sensor.principal_point[axis]
    };
    let rough = [at(seen.x, 0), at(seen.y, 1)];
    let mut centres: Vec<[i64; 2]> =
        true_pixel.iter().map(|pixel| [i64::from(pixel.i), i64::from(pixel.j)]).collect();
    if seen.z > 0.0 && rough.iter().all(|part| part.abs() < 1e9) {
        centres.push(rough.map(|part| part.floor() as i64));
    }
    let mut near = Vec::new();
    for [i, j] in centres {
        for (di, dj) in (-1..=1).flat_map(|dj| (-1..=1).map(move |di| (di, dj))) {
            if let (Ok(i), Ok(j)) = (u32::try_from(i + di), u32::try_from(j + dj))
                && !near.contains(&Pixel { i, j })
            {
                near.push(Pixel { i, j });
            }
        }
    }
    near
}
