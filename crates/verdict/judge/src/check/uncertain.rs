//! Light that may be in a pixel's sum or not, where a recording gives the image alone.

use crate::bounds::HitBounds;
use crate::check::ground_truth::GroundTruth;
use crate::check::pencil::BoundedReturn;
use crate::recorded::Recorded;
use raypencil_referee::{Ruling, VisibilityMargins};
use raypencil_scene::{FaceId, Pixel, Place, SensorId};

/// A pencil is uncertain if its answer changes within this margin, in cells or pixels. The arithmetic of any recording
/// displaces a ray by far less; the value is tuned for speed.
const MAX_UNCERTAIN_MARGIN_CELLS: f64 = 1e-2;

/// Light of one pencil that may be in a pixel's sum or not.
#[derive(Debug, Clone, Copy)]
pub(super) struct UncertainFlux {
    pub(super) pixel: Pixel,
    /// Flux by the scene's model and by the other, watts (`eq1`: W/m); negative if it is truly in the sum.
    pub(super) flux: [f64; 2],
    /// How far the recording's own flux may be off.
    pub(super) bound: [f64; 2],
}

/// The light that a pencil may add to pixels or take from its own, if the recording's arithmetic leaves uncertain where
/// it lands.
pub(super) fn uncertain_fluxes(
    truth: &GroundTruth<'_>,
    recorded: &Recorded,
    place: Place,
) -> Vec<UncertainFlux> {
    let Place { sensor, i, j } = place;
    let SensorId::Beam(beam) = sensor else { return Vec::new() };
    let (judge, referee) = (truth.judge(), truth.judge().referee());
    let Some((verdict, margins)) = referee.verdict_with_margins(sensor, i, j) else { return Vec::new() };
    let margins_of_return = referee.visibility_margins(beam, i, j);
    let is_close = |margins: &VisibilityMargins| {
        margins.visibility.lo < MAX_UNCERTAIN_MARGIN_CELLS
            || margins.landing.is_none_or(|[lo, _]| lo < MAX_UNCERTAIN_MARGIN_CELLS)
    };
    if margins.face.lo >= MAX_UNCERTAIN_MARGIN_CELLS
        && verdict.faces.len() < 2
        && !margins_of_return.as_ref().is_some_and(is_close)
    {
        return Vec::new();
    }
    let precision = recorded.precision;
    let true_face = truth.hit(place).map(|hit| hit.face);
    let (visible, pixel) = truth.visibility(place);
    let true_pixel = pixel.filter(|_| visible);

    // Every admissible face, also those that tie, and each of its admissible pixels.
    let mut faces: Vec<FaceId> = true_face.into_iter().collect();
    for face in judge.candidate_faces(place, None, precision) {
        let is_admissible = || !matches!(judge.rule(place, Some(face), None, precision), Ruling::Wrong);
        if Some(face) != true_face && is_admissible() {
            faces.push(face);
        }
    }
    let camera = &truth.scene().camera().sensor;
    let ray = truth.scene().ray(sensor, i, j).expect("a pencil of this scene");
    let mut found: Vec<UncertainFlux> = Vec::new();
    let mut true_flux = None;
    for face in faces {
        let Some(hit) = judge.plane_hit(place, face) else { continue };
        let of_hit = HitBounds::of_exact(truth.scene(), &ray, &hit, precision);
        let near = pixels_near(truth, hit.point.to_array(), pixel);
        for pixel in near.into_iter().filter(|pixel| pixel.i < camera.width && pixel.j < camera.height) {
            let is_true = Some(face) == true_face && Some(pixel) == true_pixel;
            let is_admissible = || {
                let ruling =
                    judge.rule_visibility(place, face, Some(hit.range), true, Some(pixel), precision);
                ruling.is_some_and(|ruling| ruling.visible != Ruling::Wrong && ruling.pixel != Ruling::Wrong)
            };
            if !is_true && !is_admissible() {
                continue;
            }
            let Some(exact) = judge.rounded_return(place, face, true, Some(pixel)) else { continue };
            let told = BoundedReturn::of(truth.scene(), (beam, i), (&hit, &of_hit), &exact, precision);
            let option = UncertainFlux { pixel, flux: told.flux(), bound: told.flux_bounds() };
            if is_true {
                true_flux = Some(option);
            } else {
                found.push(option);
            }
        }
    }
    // The light may be missing from its true pixel only if it may land elsewhere, be hidden, or miss.
    let Some(there) = true_flux else { return found };
    let may_be_hidden = || {
        let face = true_face?;
        let hit = judge.plane_hit(place, face)?;
        let ruling = judge.rule_visibility(place, face, Some(hit.range), false, pixel, precision)?;
        Some(ruling.visible != Ruling::Wrong)
    };
    let may_miss = || !matches!(judge.rule(place, None, None, precision), Ruling::Wrong);
    if !found.is_empty() || may_be_hidden() == Some(true) || may_miss() {
        found.push(UncertainFlux { flux: there.flux.map(|flux| -flux), ..there });
    }
    found
}

/// The pixel in which a point lands, to a few roundings, the true one, and the pixels around both.
fn pixels_near(truth: &GroundTruth<'_>, point: [f64; 3], true_pixel: Option<Pixel>) -> Vec<Pixel> {
    let camera = truth.scene().camera();
    let in_camera = camera.scene_from_sensor.inverse() * glam::DVec3::from_array(point);
    let at = |part: f64, axis: usize| {
        let sensor = &camera.sensor;
        sensor.focal_length * part / in_camera.z / sensor.pixel_pitch[axis] + sensor.principal_point[axis]
    };
    let rough = [at(in_camera.x, 0), at(in_camera.y, 1)];
    let mut centres: Vec<[i64; 2]> =
        true_pixel.iter().map(|pixel| [i64::from(pixel.i), i64::from(pixel.j)]).collect();
    if in_camera.z > 0.0 && rough.iter().all(|part| part.abs() < 1e9) {
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
