//! One ray of a recording against the truth: what it meets.

use std::fmt::Write;

use crate::bounds::Bounds;
use crate::check::said::{Difference, SaidHit};
use crate::check::tally::{SensorCheck, Wrong};
use crate::check::truth::Truth;
use crate::class::{Class, Item, Quantity};
use crate::recorded::Recorded;
use raypencil_referee::Ruling;
use raypencil_scene::Place;
use raypencil_scene::{FaceId, Hit, Ray};

/// One ray while it is judged.
pub(crate) struct Judged<'r> {
    pub(super) place: Place,
    row: &'r mut SensorCheck,
    worst: Option<(Class, Item)>,
    /// What the referee says, in words.
    pub(super) ruling: String,
    is_ruled: bool,
    /// What is said and what is true, for a wrong ray.
    what: String,
}

impl<'r> Judged<'r> {
    pub(super) fn new(place: Place, row: &'r mut SensorCheck) -> Self {
        Self { place, row, worst: None, ruling: "exact".into(), is_ruled: false, what: String::new() }
    }

    /// Enters the class of one quantity.
    pub(super) fn class(&mut self, item: impl Into<Item>, class: Class) {
        let item = item.into();
        let tally = self.row.items.entry(item).or_default();
        tally.by_class[class as usize] += 1;
        if class != Class::Agree {
            tally.others.push((self.place, class));
        }
        if self.worst.is_none_or(|(worst, _)| class > worst) {
            self.worst = Some((class, item));
        }
    }

    /// Enters a difference: of class `class` if it is within its bound, else a defect.
    pub(super) fn difference(&mut self, difference: &Difference, class: Class) {
        if difference.is_lost && difference.is_within() {
            // What the file cannot hold cannot be compared.
            self.unjudged(difference.item);
            return;
        }
        let class = if difference.is_within() { class } else { Class::Defect };
        self.row.items.entry(difference.item).or_default().enter(difference, self.place, &self.ruling);
        if !difference.is_within() {
            let name = crate::class::name_of(difference.item);
            let Difference { error, ulps, bound, .. } = difference;
            self.note(&format!("{name} is off by {error:.3e}, {ulps:.4} ulp; {bound:.3e} is explained"));
        }
        self.class(difference.item, class);
    }

    /// Enters a quantity that is said, but that nothing can be told of.
    fn unjudged(&mut self, item: Item) {
        let tally = self.row.items.entry(item).or_default();
        tally.not_compared += 1;
        tally.unjudged.push(self.place);
    }

    pub(super) fn missing(&mut self, item: impl Into<Item>) {
        self.row.items.entry(item.into()).or_default().not_compared += 1;
    }

    /// Keeps a ruling and counts the ray.
    pub(super) fn ruled(&mut self, words: &str) {
        self.row.ruled += u64::from(!self.is_ruled);
        self.ruling = if self.is_ruled { format!("{}; {words}", self.ruling) } else { words.to_string() };
        self.is_ruled = true;
    }

    /// Adds words about what is wrong.
    pub(super) fn note(&mut self, words: &str) {
        let separator = if self.what.is_empty() { "" } else { "; " };
        let _ = write!(self.what, "{separator}{words}");
    }

    /// The worst class so far.
    pub(super) fn worst(&self) -> Class {
        self.worst.map_or(Class::Agree, |(class, _)| class)
    }

    /// Counts the ray.
    pub(super) fn finish(self) {
        let Self { place, row, worst, ruling, what, .. } = self;
        let Some((class, item)) = worst else {
            row.not_compared += 1;
            return;
        };
        row.by_class[class as usize] += 1;
        if class == Class::Defect || class == Class::Undecided {
            row.wrong.push(Wrong { place, item, what: format!("{what} (referee: {ruling})") });
        }
    }
}

/// What a ray is taken to hit, from then on.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reference {
    /// The exact values of the face that is named, if that is admissible, else of the true one; `None`: no hit.
    pub(super) hit: Option<Hit>,
    /// Whether it is the true answer.
    pub(super) is_true: bool,
    /// Whether the face is named.
    pub(super) is_named: bool,
    /// What the answer is.
    pub(super) class: Class,
    pub(super) bounds: Option<Bounds>,
}

/// The ruling in words.
pub(crate) fn words(ruling: Ruling) -> String {
    match ruling {
        Ruling::Exact => "exact".into(),
        Ruling::Tie => "tie: one of several faces met at exactly this point".into(),
        Ruling::Rounding(witness) => {
            format!("rounding: right for the ray displaced by ({:.3e}, {:.3e}) cells", witness.dx, witness.dy)
        }
        Ruling::Wrong => "wrong: no ray within the arithmetic's reach has this answer".into(),
    }
}

/// Judges what one ray meets.
pub(crate) fn judge_hit(truth: &Truth<'_>, recorded: &Recorded, judged: &mut Judged<'_>) -> Reference {
    let place = judged.place;
    let said = SaidHit::of(recorded.answers.map(place.sensor), place.i, place.j);
    let true_hit = truth.hit(place);
    let ray = truth.scene().ray(place.sensor, place.i, place.j).expect("a cell of this sensor");
    let of_truth = |class| Reference {
        hit: true_hit,
        is_true: true,
        is_named: said.names_faces,
        class,
        bounds: true_hit.map(|hit| bounds(truth, &ray, &hit, recorded)),
    };
    let Some(says_hit) = said.hit else {
        missing_values(judged, recorded);
        judged.missing(Quantity::Hit);
        return of_truth(Class::Agree);
    };

    let is_exact = match said.names_faces {
        true => said.face == true_hit.map(|hit| hit.face),
        false => says_hit == true_hit.is_some(),
    };
    let mut reference = of_truth(Class::Agree);
    if !is_exact {
        reference = ruled_otherwise(truth, recorded, judged, &said, of_truth);
    } else if let (false, Some(hit), Some(own)) = (said.names_faces, &true_hit, &reference.bounds) {
        // A face that is not named may be another than the true one: if the values are not those of that.
        let off = said.differences(recorded, place.sensor, hit, own).iter().any(|one| !one.is_within());
        if off && let Some(other) = unnamed(truth, recorded, judged, &said, &ray) {
            reference = other;
        }
    }

    let class = reference.class;
    let both = says_hit == true_hit.is_some();
    judged.class(Quantity::Hit, if both { Class::Agree } else { class });
    if class == Class::Defect {
        let name = |face: Option<FaceId>| face.map_or("a face that it does not name".into(), face_name);
        let said_words = if says_hit { name(said.face) } else { "no hit".into() };
        let true_words =
            true_hit.map_or("no hit".into(), |hit| format!("{} at {} m", face_name(hit.face), hit.range));
        judged.note(&format!("it says {said_words}, true is {true_words}"));
    }
    match (said.names_faces, says_hit || true_hit.is_some()) {
        (false, _) => judged.missing(Quantity::Face),
        // Both miss: no face to compare.
        (true, false) => judged.class(Quantity::Face, Class::Agree),
        (true, true) => judged.class(Quantity::Face, class),
    }
    if says_hit && let (Some(hit), Some(bounds)) = (&reference.hit, &reference.bounds) {
        let own = if class == Class::Defect { Class::Agree } else { class };
        for difference in said.differences(recorded, place.sensor, hit, bounds) {
            judged.difference(&difference, own);
        }
    }
    missing_values(judged, recorded);
    reference
}

fn face_name(face: FaceId) -> String {
    format!("face {}", face.0)
}

fn bounds(truth: &Truth<'_>, ray: &Ray, hit: &Hit, recorded: &Recorded) -> Bounds {
    Bounds::of(truth.scene().mesh(), hit.face, ray, hit.range, recorded.precision)
}

/// What the referee makes of an answer that is not the exact one.
fn ruled_otherwise(
    truth: &Truth<'_>,
    recorded: &Recorded,
    judged: &mut Judged<'_>,
    said: &SaidHit,
    of_truth: impl Fn(Class) -> Reference,
) -> Reference {
    let place = judged.place;
    let ray = truth.scene().ray(place.sensor, place.i, place.j).expect("a cell of this sensor");
    if said.hit == Some(true) && said.face.is_none() {
        // Truly a miss.
        return unnamed(truth, recorded, judged, said, &ray).unwrap_or_else(|| {
            judged.ruled(&words(Ruling::Wrong));
            of_truth(Class::Defect)
        });
    }
    let ruling = truth.judge().rule(place, said.face, said.range, recorded.precision);
    judged.ruled(&words(ruling));
    let class = Class::of(ruling, false);
    if class == Class::Defect {
        // A wrong face excuses no value: they are held to the truth.
        return of_truth(class);
    }
    let hit = said.face.and_then(|face| truth.judge().plane_hit(place, face));
    Reference {
        bounds: hit.as_ref().map(|hit| bounds(truth, &ray, hit, recorded)),
        hit,
        is_true: ruling == Ruling::Exact,
        is_named: said.names_faces,
        class,
    }
}

/// A face that is not named, by its values: one that ties with the true face or that a displaced ray meets.
fn unnamed(
    truth: &Truth<'_>,
    recorded: &Recorded,
    judged: &mut Judged<'_>,
    said: &SaidHit,
    ray: &Ray,
) -> Option<Reference> {
    let place = judged.place;
    let judge = truth.judge();
    for face in judge.candidate_faces(place, said.range, recorded.precision) {
        let Some(hit) = judge.plane_hit(place, face) else { continue };
        let bounds = bounds(truth, ray, &hit, recorded);
        let differences = said.differences(recorded, place.sensor, &hit, &bounds);
        if !differences.iter().all(Difference::is_within) {
            continue;
        }
        let ruling = judge.rule(place, Some(face), said.range, recorded.precision);
        if matches!(ruling, Ruling::Tie | Ruling::Rounding(_)) {
            judged.ruled(&format!("{}, if {} is meant", words(ruling), face_name(face)));
            let class = Class::of(ruling, false);
            return Some(Reference {
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

/// The values that the recording does not have at all.
fn missing_values(judged: &mut Judged<'_>, recorded: &Recorded) {
    for quantity in
        [Quantity::Range, Quantity::Depth, Quantity::Point, Quantity::Normal, Quantity::CosIncidence]
    {
        if !recorded.storage.contains_key(&(judged.place.sensor, quantity.into())) {
            judged.missing(quantity);
        }
    }
}
