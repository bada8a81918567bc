//! One ray of a recording against the truth: its hit.

use crate::answer::StatedHit;
use crate::bounds::HitBounds;
use crate::check::ground_truth::GroundTruth;
use crate::class::Class;
use crate::difference::{Difference, hit_values};
use crate::entry::RayEntry;
use crate::quantity::Quantity;
use crate::recorded::Recorded;
use raypencil_referee::{Displacement, Ruling};
use raypencil_scene::{FaceId, Hit, HitQuantity, Ray};

/// The exact hit that a ray's values, and its pencil's return, are held to.
#[derive(Debug, Clone, Copy)]
pub(super) struct AssumedHit {
    /// The exact values of the face that is named, if that is admissible, else of the true one; `None`: no hit.
    pub(super) hit: Option<Hit>,
    pub(super) is_true: bool,
    /// Whether the recording names the face.
    pub(super) is_named: bool,
    /// The class of the recording's hit.
    pub(super) class: Class,
    /// Error that the recording's arithmetic explains.
    pub(super) bounds: Option<HitBounds>,
}

pub(super) fn words(ruling: Ruling) -> String {
    match ruling {
        Ruling::Exact => "exact".into(),
        Ruling::Tie => "tie: one of several faces met at exactly this point".into(),
        Ruling::Rounding(Displacement::ZERO) => {
            "rounding: right up to the errors of ranges, normals and points".into()
        }
        Ruling::Rounding(witness) => {
            format!("rounding: right for the ray displaced by ({:.3e}, {:.3e}) cells", witness.dx, witness.dy)
        }
        Ruling::Wrong => "wrong: no ray within the arithmetic's reach has this answer".into(),
    }
}

/// Judges one ray's hit.
pub(super) fn judge_hit(
    truth: &GroundTruth<'_>,
    recorded: &Recorded,
    entry: &mut RayEntry<'_>,
) -> AssumedHit {
    let place = entry.place;
    let stated = StatedHit::of(recorded.answers.map(place.sensor), place.i, place.j);
    let true_hit = truth.hit(place);
    let ray = truth.scene().ray(place.sensor, place.i, place.j).expect("a cell of this sensor");
    let of_truth = |class| AssumedHit {
        hit: true_hit,
        is_true: true,
        is_named: stated.names_faces(),
        class,
        bounds: true_hit.map(|hit| bounds(truth, &ray, &hit, recorded)),
    };
    missing_values(entry, recorded);
    let Some(states_hit) = stated.hits_by_any_value() else {
        entry.missing(Quantity::Hit);
        entry.missing(Quantity::Face);
        return of_truth(Class::Agree);
    };

    let is_exact = match stated.names_faces() {
        true => stated.face == true_hit.map(|hit| hit.face),
        false => states_hit == true_hit.is_some(),
    };
    let mut assumed = of_truth(Class::Agree);
    if !is_exact {
        assumed = ruled_otherwise(truth, recorded, entry, &stated, of_truth);
    } else if let (false, Some(hit), Some(own)) = (stated.names_faces(), &true_hit, &assumed.bounds) {
        // Values that are not those of the true face may be those of another one, which is not named.
        let differences = recorded.differences(place.sensor, hit_values(&stated, hit, own));
        let off = differences.iter().any(|one| !one.is_within());
        if off && let Some(other) = unnamed_face(truth, recorded, entry, &stated, &ray) {
            assumed = other;
        }
    }

    let class = assumed.class;
    let is_right = states_hit == true_hit.is_some();
    entry.class(Quantity::Hit, if is_right { Class::Agree } else { class });
    if class == Class::Defect {
        let name = |face: Option<FaceId>| face.map_or("a face that it does not name".into(), face_name);
        let said_words = if states_hit { name(stated.face) } else { "no hit".into() };
        let true_words = true_hit.map_or_else(
            || format!("no hit{}", why_no_hit(truth, entry, &stated, &ray)),
            |hit| format!("{} at {} m", face_name(hit.face), hit.range),
        );
        entry.note(&format!("it says {said_words}, true is {true_words}"));
    }
    match (stated.names_faces(), states_hit || true_hit.is_some()) {
        (false, _) => entry.missing(Quantity::Face),
        // Neither hits: there is no face to compare.
        (true, false) => entry.class(Quantity::Face, Class::Agree),
        (true, true) => entry.class(Quantity::Face, class),
    }
    if states_hit && let (Some(hit), Some(bounds)) = (&assumed.hit, &assumed.bounds) {
        let own = if class == Class::Defect { Class::Agree } else { class };
        for difference in recorded.differences(place.sensor, hit_values(&stated, hit, bounds)) {
            entry.difference(&difference, own);
        }
    }
    assumed
}

/// Why what is stated is no hit, in brackets, if its distance says it.
fn why_no_hit(truth: &GroundTruth<'_>, entry: &RayEntry<'_>, stated: &StatedHit<'_>, ray: &Ray) -> String {
    let place = entry.place;
    let of_face = || Some(truth.judge().plane_hit(place, stated.face?)?.range);
    let Some(range) = stated.range.or_else(of_face) else { return String::new() };
    let longest = truth.scene().max_range(place.sensor).unwrap_or(f64::INFINITY);
    let plane = ray.direction.length();
    if range > longest {
        format!(" ({range} m is beyond the maximum range of {longest} m)")
    } else if range < plane {
        format!(" ({range} m is before the sensor's plane, which the ray meets at {plane} m)")
    } else {
        String::new()
    }
}

fn face_name(face: FaceId) -> String {
    format!("face {}", face.0)
}

fn bounds(truth: &GroundTruth<'_>, ray: &Ray, hit: &Hit, recorded: &Recorded) -> HitBounds {
    HitBounds::of_exact(truth.scene(), ray, hit, recorded.precision)
}

/// Asks the referee about a hit that is not the true one.
fn ruled_otherwise(
    truth: &GroundTruth<'_>,
    recorded: &Recorded,
    entry: &mut RayEntry<'_>,
    stated: &StatedHit<'_>,
    of_truth: impl Fn(Class) -> AssumedHit,
) -> AssumedHit {
    let place = entry.place;
    let ray = truth.scene().ray(place.sensor, place.i, place.j).expect("a cell of this sensor");
    if stated.hits_by_any_value() == Some(true) && stated.face.is_none() {
        // The ray truly misses.
        return unnamed_face(truth, recorded, entry, stated, &ray).unwrap_or_else(|| {
            entry.ruled(&words(Ruling::Wrong));
            of_truth(Class::Defect)
        });
    }
    let ruling = truth.judge().rule(place, stated.face, stated.range, recorded.precision);
    entry.ruled(&words(ruling));
    let class = Class::of(ruling, false);
    if class == Class::Defect {
        // A wrong face excuses no value: the values are held to the truth.
        return of_truth(class);
    }
    let hit = stated.face.and_then(|face| truth.judge().plane_hit(place, face));
    AssumedHit {
        bounds: hit.as_ref().map(|hit| bounds(truth, &ray, hit, recorded)),
        hit,
        is_true: ruling == Ruling::Exact,
        is_named: stated.names_faces(),
        class,
    }
}

/// A face that the recording does not name, found by its values: it ties with the true one, or a displaced ray meets
/// it.
fn unnamed_face(
    truth: &GroundTruth<'_>,
    recorded: &Recorded,
    entry: &mut RayEntry<'_>,
    stated: &StatedHit<'_>,
    ray: &Ray,
) -> Option<AssumedHit> {
    let place = entry.place;
    let judge = truth.judge();
    for face in judge.candidate_faces(place, stated.range, recorded.precision) {
        let Some(hit) = judge.plane_hit(place, face) else { continue };
        let bounds = bounds(truth, ray, &hit, recorded);
        let differences = recorded.differences(place.sensor, hit_values(stated, &hit, &bounds));
        if !differences.iter().all(Difference::is_within) {
            continue;
        }
        let ruling = judge.rule(place, Some(face), stated.range, recorded.precision);
        if matches!(ruling, Ruling::Tie | Ruling::Rounding(_)) {
            entry.ruled(&format!("{}, if {} is meant", words(ruling), face_name(face)));
            let class = Class::of(ruling, false);
            return Some(AssumedHit {
                hit: Some(hit),
                is_true: false,
                is_named: false,
                class,
                bounds: Some(bounds),
            });
        }
    }
    None
}

/// Enters the values of which the recording has no channel.
fn missing_values(entry: &mut RayEntry<'_>, recorded: &Recorded) {
    for quantity in HitQuantity::ALL.map(Quantity::from) {
        if !recorded.storage.contains_key(&(entry.place.sensor, quantity.into())) {
            entry.missing(quantity);
        }
    }
}
