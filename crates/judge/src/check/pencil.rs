//! One pencil of a recording against the truth: whether the camera sees it, where, and what it delivers.
//!
//! What is not said (the face, whether it is seen, the pixel) is taken from the truth, or else from what else is
//! admissible and explains the values that are said.

use crate::bounds::{Bounds, ReturnBounds, Returned, least_normal};
use crate::check::ray::{Judged, Reference, words};
use crate::check::said::{Difference, SaidBack, flux_bound};
use crate::check::truth::Truth;
use crate::class::{Class, Item, Quantity};
use crate::recorded::Recorded;
use raypencil_referee::{Format, RoundedReturn};
use raypencil_scene::Place;
use raypencil_scene::{FluxModel, Hit, Pixel, Precision, SensorId};

/// What a pencil delivers, exactly, where it is said to land.
#[derive(Debug, Clone, Copy)]
pub(super) struct Delivered {
    pub(super) pixel: Pixel,
    /// By the scene's model, and by the other.
    pub(super) flux: [f64; 2],
    /// How far the recording's own may be off.
    pub(super) bound: [f64; 2],
    /// What the pencil's answers are.
    pub(super) class: Class,
}

/// Where a pencil's light goes, as it is said.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Landing {
    pub(super) delivered: Option<Delivered>,
    /// The pixel in which it truly lands, if it is said not to, and what that answer is.
    pub(super) left: Option<(Pixel, Class)>,
}

/// The flux of pencils by one of the two models.
fn flux_item(k: usize) -> Item {
    Item { is_other_model: k == 1, ..Quantity::PencilFlux.into() }
}

/// What the answers about a pencil's light are taken to mean.
struct Meaning {
    visible: bool,
    pixel: Option<Pixel>,
    /// Of seeing, and of landing.
    classes: [Class; 2],
    ruling: Option<String>,
    /// The worst of those and of what is hit.
    class: Class,
    exact: RoundedReturn,
    bounds: [ReturnBounds; 2],
    differences: Vec<Difference>,
}

impl Meaning {
    fn fits(&self) -> bool {
        !self.classes.contains(&Class::Defect) && self.differences.iter().all(Difference::is_within)
    }
}

/// One pencil and all that is known of it.
struct Question<'a> {
    truth: &'a Truth<'a>,
    recorded: &'a Recorded,
    place: Place,
    beam: usize,
    said: SaidBack,
}

impl Question<'_> {
    /// What the answers mean if this is what is hit, seen and landed on; `None` if there is no such point.
    fn meaning(
        &self,
        (hit, of_hit, of_class): (&Hit, &Bounds, Class),
        visible: bool,
        pixel: Option<Pixel>,
        is_true: bool,
    ) -> Option<Meaning> {
        let (judge, precision) = (self.truth.judge(), self.recorded.precision);
        let (classes, ruling) = if is_true {
            ([Class::Agree; 2], None)
        } else {
            let ruled =
                judge.rule_visibility(self.place, hit.face, Some(hit.range), visible, pixel, precision);
            match ruled {
                Some(ruling) => (
                    [Class::of(ruling.visible, false), Class::of(ruling.pixel, false)],
                    Some(format!("seen {}, pixel {}", words(ruling.visible), words(ruling.pixel))),
                ),
                None => ([Class::Defect; 2], None),
            }
        };
        let exact = judge.rounded_return(self.place, hit.face, visible, pixel)?;
        let model = self.truth.scene().flux_model();
        let bounds = return_bounds(self.truth, self.beam, self.place.i, hit, &exact, of_hit, precision);
        let differences =
            self.said.differences(self.recorded, self.place.sensor, &exact, model, [&bounds[0], &bounds[1]]);
        let class = of_class.max(classes[0]).max(classes[1]);
        Some(Meaning { visible, pixel, classes, ruling, class, exact, bounds, differences })
    }

    /// Whether it is taken to be seen, if that is not said, and would land on `pixel`.
    fn inferred(&self, pixel: Option<Pixel>) -> bool {
        if pixel.is_none() {
            return false;
        }
        let (truly, _) = self.truth.sight(self.place);
        let said: Vec<(usize, f64)> =
            (0..2).filter_map(|k| self.said.flux[k].map(|flux| (k, flux))).collect();
        if said.iter().any(|(_, flux)| *flux > 0.0) {
            return true;
        }
        // A flux of 0 says that it is not seen, unless the true one is too small to be told from 0.
        let is_told = said.iter().any(|&(k, _)| {
            let storage = self.recorded.storage_of(self.place.sensor, flux_item(k));
            let least = least_normal(self.recorded.precision);
            self.truth.flux(self.place)[k] > 2.0 * (storage.ulp(0.0) + least)
        });
        truly && !is_told
    }
}

/// Judges what is said to come back of a pencil.
pub(crate) fn judge_back(
    truth: &Truth<'_>,
    recorded: &Recorded,
    judged: &mut Judged<'_>,
    reference: &Reference,
) -> Landing {
    let place = judged.place;
    let SensorId::Beam(beam) = place.sensor else { return Landing::default() };
    let said = SaidBack::of(&recorded.answers.light[beam], place.i, place.j);
    missing(judged, recorded);
    let true_sight = truth.sight(place);
    let true_pixel = true_sight.1.filter(|_| true_sight.0);
    let (Some(hit), Some(of_hit)) = (&reference.hit, &reference.bounds) else {
        // Nothing comes back of what is not hit.
        let class = if reference.is_true { Class::Agree } else { reference.class };
        nothing(judged, recorded, &said, class);
        return Landing { delivered: None, left: true_pixel.map(|pixel| (pixel, class)) };
    };
    let question = Question { truth, recorded, place, beam, said };
    let of_hit = (hit, of_hit, reference.class);

    let pixel = said.pixel.unwrap_or(true_sight.1);
    let mut visible = said.visible.unwrap_or_else(|| question.inferred(pixel));
    let contradicts = visible && pixel.is_none();
    if contradicts {
        judged.note("it says that the hit is seen, and lands on no pixel");
        visible = false;
    }
    let is_true = reference.is_true && (visible, pixel) == true_sight;
    let Some(plain) = question.meaning(of_hit, visible, pixel, is_true) else { return Landing::default() };
    let meaning = if plain.fits() || contradicts {
        plain
    } else {
        otherwise(&question, reference, of_hit, (visible, pixel)).unwrap_or(plain)
    };
    enter(judged, &question, &meaning, contradicts);

    let model = truth.scene().flux_model();
    let flux = [model, model.other()].map(|model| meaning.exact.in_format(Format::Double, model).flux);
    let delivered = meaning.pixel.filter(|_| meaning.visible).map(|pixel| Delivered {
        pixel,
        flux,
        bound: [flux_bound(&meaning.bounds[0], flux[0]), flux_bound(&meaning.bounds[1], flux[1])],
        class: judged.worst().max(meaning.class),
    });
    let lands = delivered.map(|delivered| delivered.pixel);
    let class = judged.worst().max(meaning.class);
    Landing { delivered, left: true_pixel.filter(|pixel| lands != Some(*pixel)).map(|pixel| (pixel, class)) }
}

/// Another meaning that is admissible and fits all values, if what is not said leaves one.
fn otherwise(
    question: &Question<'_>,
    reference: &Reference,
    of_hit: (&Hit, &Bounds, Class),
    (visible, pixel): (bool, Option<Pixel>),
) -> Option<Meaning> {
    let Question { truth, recorded, place, said, .. } = question;
    let judge = truth.judge();
    // Faces that tie with the true one, if none is named: each has its own reflectivity.
    let mut hits: Vec<(Hit, Bounds, Class)> = vec![(*of_hit.0, *of_hit.1, of_hit.2)];
    if !reference.is_named {
        let verdict = judge.referee().verdict(place.sensor, place.i, place.j);
        let ray = truth.scene().ray(place.sensor, place.i, place.j)?;
        for face in verdict.map(|verdict| verdict.faces).unwrap_or_default() {
            if let Some(hit) = judge.plane_hit(*place, face).filter(|hit| hit.face != of_hit.0.face) {
                let bounds = Bounds::of(truth.scene().mesh(), face, &ray, hit.range, recorded.precision);
                hits.push((hit, bounds, Class::Tie));
            }
        }
    }
    // The neighbours of the pixel, if none is said: equation (1) goes by the pixel's centre.
    let mut pixels = vec![pixel];
    if let (None, Some(Pixel { i, j })) = (said.pixel, pixel) {
        let camera = &truth.scene().camera().sensor;
        let around = (-1i64..=1).flat_map(|dj| (-1i64..=1).map(move |di| (di, dj)));
        let beside = around.filter_map(|(di, dj)| {
            let i = u32::try_from(i64::from(i) + di).ok().filter(|i| *i < camera.width)?;
            let j = u32::try_from(i64::from(j) + dj).ok().filter(|j| *j < camera.height)?;
            Some(Pixel { i, j })
        });
        pixels.extend(beside.map(Some).filter(|other| *other != pixel));
    }
    for (hit, bounds, class) in &hits {
        for &pixel in &pixels {
            if let Some(meaning) = question.meaning((hit, bounds, *class), visible, pixel, false)
                && meaning.fits()
            {
                return Some(meaning);
            }
        }
    }
    None
}

/// Enters a meaning: what is said of seeing and landing, and every value.
fn enter(judged: &mut Judged<'_>, question: &Question<'_>, meaning: &Meaning, contradicts: bool) {
    let Question { truth, recorded, place, said, .. } = question;
    if let Some(ruling) = &meaning.ruling {
        judged.ruled(ruling);
    }
    let [mut of_visible, mut of_pixel] = meaning.classes;
    if contradicts {
        of_visible = Class::Defect;
    }
    if of_visible == Class::Defect || of_pixel == Class::Defect {
        let (truly, true_pixel) = truth.sight(*place);
        judged.note(&format!(
            "it says {}, true is {}",
            sight_words(meaning.visible, meaning.pixel),
            sight_words(truly, true_pixel)
        ));
        // What is not said cannot be at fault: what leads to it is.
        if said.visible.is_none() && said.pixel.is_some() {
            of_pixel = of_pixel.max(of_visible);
        }
        if said.pixel.is_none() && said.visible.is_some() {
            of_visible = of_visible.max(of_pixel);
        }
    }
    if said.visible.is_some() {
        judged.class(Quantity::Visible, of_visible);
    }
    if said.pixel.is_some() {
        judged.class(Quantity::Pixel, of_pixel);
    }
    let is_blamed =
        of_visible.max(of_pixel) == Class::Defect && said.visible.is_none() && said.pixel.is_none();

    let model = truth.scene().flux_model();
    let is_undecided = [meaning.exact.flux(model).is_err(), meaning.exact.flux(model.other()).is_err()];
    let of_value = if meaning.class == Class::Defect { Class::Agree } else { meaning.class };
    for difference in &meaning.differences {
        let k = usize::from(difference.item.is_other_model);
        let is_flux = difference.item.quantity == Quantity::PencilFlux;
        if is_flux && is_undecided[k] {
            judged.class(difference.item, Class::Undecided);
        } else if is_flux && is_blamed {
            judged.class(difference.item, Class::Defect);
        } else {
            judged.difference(difference, of_value);
        }
    }
    // A number there must be where something is hit.
    for (quantity, is_said) in said.values() {
        if !is_said && recorded.storage.contains_key(&(place.sensor, quantity.into())) {
            judged.note(&format!("it gives no {quantity} of a hit"));
            judged.class(quantity, Class::Defect);
        }
    }
}

/// The bounds of what comes back of a hit, by the scene's model and by the other.
pub(crate) fn return_bounds(
    truth: &Truth<'_>,
    beam: usize,
    column: u32,
    hit: &Hit,
    exact: &RoundedReturn,
    of_hit: &Bounds,
    precision: Precision,
) -> [ReturnBounds; 2] {
    let scene = truth.scene();
    let values = Returned {
        range: hit.range,
        cos_incidence: hit.cos_incidence,
        depth: exact.depth.double,
        cos_off_axis: exact.cos_off_axis.double,
        cos_view: exact.cos_view.double,
        distance: hit.point.distance(scene.camera().scene_from_sensor.position),
    };
    let of = |model: FluxModel| ReturnBounds::of(scene, (beam, column), of_hit, values, precision, model);
    [of(scene.flux_model()), of(scene.flux_model().other())]
}

/// Nothing is hit: nothing may be seen, land, be measured or be delivered.
fn nothing(judged: &mut Judged<'_>, recorded: &Recorded, said: &SaidBack, class: Class) {
    let mut enter = |item: Item, is_wrong: bool, words: &str| {
        if is_wrong {
            judged.note(words);
        }
        judged.class(item, if is_wrong { Class::Defect } else { class });
    };
    if let Some(visible) = said.visible {
        enter(Quantity::Visible.into(), visible, "it says that what is not hit is seen");
    }
    if let Some(pixel) = said.pixel {
        enter(Quantity::Pixel.into(), pixel.is_some(), "it says that what is not hit lands on a pixel");
    }
    for k in 0..2 {
        if let Some(flux) = said.flux[k] {
            enter(flux_item(k), flux != 0.0, "it says that what is not hit delivers");
        }
    }
    let sensor = judged.place.sensor;
    for (quantity, is_said) in said.values() {
        if is_said && recorded.storage.contains_key(&(sensor, quantity.into())) {
            judged.note(&format!("it gives a {quantity} of what is not hit"));
            judged.class(quantity, Class::Defect);
        }
    }
}

fn missing(judged: &mut Judged<'_>, recorded: &Recorded) {
    let plain = [
        Quantity::Visible,
        Quantity::Pixel,
        Quantity::CameraDepth,
        Quantity::CosOffAxis,
        Quantity::CosView,
        Quantity::PencilFlux,
    ];
    for item in plain.map(Item::from).into_iter().chain([flux_item(1)]) {
        if !recorded.storage.contains_key(&(judged.place.sensor, item)) {
            judged.missing(item);
        }
    }
}

fn sight_words(visible: bool, pixel: Option<Pixel>) -> String {
    let seen = if visible { "seen" } else { "not seen" };
    match pixel {
        Some(Pixel { i, j }) => format!("{seen}, in pixel {i},{j}"),
        None => format!("{seen}, off the image"),
    }
}
