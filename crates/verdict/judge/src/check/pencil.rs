//! One pencil's return in a recording against the truth: visibility, pixel and flux.
//!
//! What the recording leaves out (the face, the visibility, the pixel) is taken from the truth; if the values do not
//! fit that, from another admissible answer that they fit.

use glam::DVec3;

use crate::answer::StatedReturn;
use crate::bounds::{HitBounds, ReturnBounds, ReturnValues, min_normal};
use crate::check::ground_truth::GroundTruth;
use crate::check::hit::{AssumedHit, words};
use crate::check::stored::stored_difference;
use crate::class::Class;
use crate::difference::{Difference, StatedValue, return_values};
use crate::entry::RayEntry;
use crate::quantity::{Item, Quantity, RETURN_QUANTITIES};
use crate::recorded::Recorded;
use crate::scene_answers::BeamLight;
use raypencil_referee::{Format, RoundedReturn};
use raypencil_scene::{Camera, Hit, Mounted, Pixel, Place, Pose, Precision, Return, Scene, SensorId};

/// The exact light of a pencil in the pixel where it is stated to land.
#[derive(Debug, Clone, Copy)]
pub(super) struct DeliveredLight {
    pub(super) pixel: Pixel,
    /// Flux by the scene's model and by the other, watts (`eq1`: W/m).
    pub(super) flux: [f64; 2],
    /// How far the recording's own flux may be off.
    pub(super) bound: [f64; 2],
    /// The class of the pencil's answers.
    pub(super) class: Class,
}

/// A pencil's part in the image, as the recording states it.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct PencilContribution {
    /// The light where it is stated to land; `None` if it delivers nothing.
    pub(super) delivered: Option<DeliveredLight>,
    /// The true light, if it is stated not to land in its pixel; the class is that of that answer.
    pub(super) missing: Option<DeliveredLight>,
}

/// The true light of a pencil that is stated to be elsewhere, or nowhere; `None` if it delivers nothing.
fn missing_light(
    truth: &GroundTruth<'_>,
    recorded: &Recorded,
    place: Place,
    class: Class,
) -> Option<DeliveredLight> {
    let SensorId::Beam(beam) = place.sensor else { return None };
    let (visible, pixel) = truth.visibility(place);
    let pixel = pixel.filter(|_| visible)?;
    let (scene, precision) = (truth.scene(), recorded.precision);
    let hit = truth.hit(place)?;
    let exact = truth.judge().rounded_return(place, hit.face, visible, Some(pixel))?;
    let of_hit = HitBounds::of_exact(scene, &scene.ray(place.sensor, place.i, place.j)?, &hit, precision);
    let told = BoundedReturn::of(scene, (beam, place.i), (&hit, &of_hit), &exact, precision);
    Some(DeliveredLight { pixel, flux: told.flux(), bound: told.flux_bounds(), class })
}

/// The exact return of a pencil in f64, by the scene's flux model and by the other, and how far a recording may be off it.
pub(super) struct BoundedReturn {
    by_model: [Return; 2],
    bounds: [ReturnBounds; 2],
}

impl BoundedReturn {
    pub(super) fn of(
        scene: &Scene,
        pencil: (usize, u32),
        (hit, of_hit): (&Hit, &HitBounds),
        exact: &RoundedReturn,
        precision: Precision,
    ) -> Self {
        let model = scene.flux_model();
        let by_model = [model, model.other()].map(|model| exact.in_format(Format::Double, model));
        let values = ReturnValues::of_exact(scene, hit, &by_model[0]);
        Self { by_model, bounds: ReturnBounds::by_both_models(scene, pencil, of_hit, values, precision) }
    }

    /// The flux by both models, watts (`eq1`: W/m).
    pub(super) fn flux(&self) -> [f64; 2] {
        self.by_model.map(|one| one.flux)
    }

    /// How far each flux may be off, watts (`eq1`: W/m). No light at all is exactly 0.
    pub(super) fn flux_bounds(&self) -> [f64; 2] {
        let bound = |k: usize, flux: f64| if flux == 0.0 { 0.0 } else { self.bounds[k].of_flux(flux) };
        let [own, other] = self.flux();
        [bound(0, own), bound(1, other)]
    }
}

/// Whether a recording tells which pixels the pencils of a beam light.
pub(super) fn tells_light(light: &BeamLight) -> bool {
    light.returns.pixel.is_some() && (light.returns.flux.is_some() || light.other_flux.is_some())
}

/// The recorded values of a pencil under one hypothesis of its hit, visibility and pixel.
struct Hypothesis {
    visible: bool,
    pixel: Option<Pixel>,
    /// The classes of visibility and pixel.
    classes: [Class; 2],
    ruling: Option<String>,
    /// The worst class of hit, visibility and pixel.
    class: Class,
    exact: RoundedReturn,
    told: BoundedReturn,
    differences: Vec<Difference>,
}

impl Hypothesis {
    /// Whether it is admissible and all values fit it.
    fn fits(&self) -> bool {
        !self.classes.contains(&Class::Defect) && self.differences.iter().all(Difference::is_within)
    }
}

/// One pencil of a recording and all that is known of it.
struct RecordedPencil<'a> {
    truth: &'a GroundTruth<'a>,
    recorded: &'a Recorded,
    place: Place,
    beam: usize,
    stated: StatedReturn,
}

impl RecordedPencil<'_> {
    /// Judges the recorded values under the hypothesis of this hit, visibility and pixel; `None` if the face has no
    /// such point.
    fn hypothesis(
        &self,
        (hit, of_hit, of_class): (&Hit, &HitBounds, Class),
        visible: bool,
        pixel: Option<Pixel>,
        is_true: bool,
    ) -> Option<Hypothesis> {
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
        let pencil = (self.beam, self.place.i);
        let told = BoundedReturn::of(self.truth.scene(), pencil, (hit, of_hit), &exact, precision);
        let values = return_values(&self.stated, &told.by_model[0], &told.bounds[0]);
        let mut differences = self.recorded.differences(self.place.sensor, values);
        let (flux, bounds) = (told.flux(), told.flux_bounds());
        differences.extend((0..2).filter_map(|k| self.flux_difference(k, flux[k], bounds[k])));
        let class = of_class.max(classes[0]).max(classes[1]);
        Some(Hypothesis { visible, pixel, classes, ruling, class, exact, told, differences })
    }

    /// The difference of the flux by one of the two models.
    fn flux_difference(&self, k: usize, exact: f64, bound: f64) -> Option<Difference> {
        let item = Item::pencil_flux(k == 1);
        let value = StatedValue::scalar(item, self.stated.flux[k], exact, bound)?;
        let difference = stored_difference(&value, self.recorded.storage_of(self.place.sensor, item));
        // No light at all is exactly 0, however it is stored.
        Some(if exact == 0.0 { Difference { bound: Some(0.0), ..difference } } else { difference })
    }

    /// Whether the hit is taken to be visible, if that is not stated, and would land on `pixel`.
    fn infers_visible(&self, pixel: Option<Pixel>) -> bool {
        if pixel.is_none() {
            return false;
        }
        let (truly, _) = self.truth.visibility(self.place);
        let stated: Vec<(usize, f64)> =
            (0..2).filter_map(|k| self.stated.flux[k].map(|flux| (k, flux))).collect();
        if stated.iter().any(|(_, flux)| *flux > 0.0) {
            return true;
        }
        // A flux of 0 tells that it is hidden, unless the true flux is too small to be told from 0.
        let is_told = stated.iter().any(|&(k, _)| {
            let storage = self.recorded.storage_of(self.place.sensor, Item::pencil_flux(k == 1));
            let least = min_normal(self.recorded.precision);
            self.truth.flux(self.place)[k] > 2.0 * (storage.ulp(0.0) + least)
        });
        truly && !is_told
    }
}

/// Judges the return of a pencil, whose hit is judged already.
pub(super) fn judge_return(
    truth: &GroundTruth<'_>,
    recorded: &Recorded,
    entry: &mut RayEntry<'_>,
    assumed: &AssumedHit,
) -> PencilContribution {
    let place = entry.place;
    let SensorId::Beam(beam) = place.sensor else { return PencilContribution::default() };
    let light = &recorded.answers.light[beam];
    let stated = StatedReturn::of(&light.returns, light.other_flux.as_ref(), place.i, place.j);
    missing_values(entry, recorded);
    let true_visibility = truth.visibility(place);
    let true_pixel = true_visibility.1.filter(|_| true_visibility.0);
    let (Some(hit), Some(of_hit)) = (&assumed.hit, &assumed.bounds) else {
        // A pencil without a hit has no return.
        let class = if assumed.is_true { Class::Agree } else { assumed.class };
        judge_no_return(entry, recorded, &stated, class);
        return PencilContribution { delivered: None, missing: missing_light(truth, recorded, place, class) };
    };
    let pencil = RecordedPencil { truth, recorded, place, beam, stated };
    let of_hit = (hit, of_hit, assumed.class);

    // Who states no pixel lands on that of the hit: the true one, or that of the face which it names. Who sees a hit that lands
    // beside the image lands on the nearest pixel: rounding may excuse that.
    let nearest = || nearest_pixel(truth.scene().camera(), hit.point);
    let own = || match nearest() {
        _ if assumed.is_true => true_visibility.1,
        Some((pixel, is_on_image)) => is_on_image.then_some(pixel),
        None => None,
    };
    let clamped = || nearest().filter(|_| stated.visible == Some(true)).map(|(pixel, _)| pixel);
    let pixel = stated.pixel.unwrap_or_else(|| own().or_else(clamped));
    let mut visible = stated.visible.unwrap_or_else(|| pencil.infers_visible(pixel));
    let contradicts = visible && pixel.is_none();
    if contradicts {
        entry.note("it says that the hit is seen, and lands on no pixel");
        visible = false;
    }
    let is_true = assumed.is_true && (visible, pixel) == true_visibility;
    let Some(direct) = pencil.hypothesis(of_hit, visible, pixel, is_true) else {
        return PencilContribution::default();
    };
    let hypothesis = if direct.fits() || contradicts {
        direct
    } else {
        alternative(&pencil, assumed, of_hit, (visible, pixel)).unwrap_or(direct)
    };
    enter(entry, &pencil, &hypothesis, contradicts);

    let delivered = hypothesis.pixel.filter(|_| hypothesis.visible).map(|pixel| DeliveredLight {
        pixel,
        flux: hypothesis.told.flux(),
        bound: hypothesis.told.flux_bounds(),
        class: entry.worst().max(hypothesis.class),
    });
    let lands = delivered.map(|delivered| delivered.pixel);
    let class = entry.worst().max(hypothesis.class);
    let is_missing = true_pixel.is_some() && lands != true_pixel;
    let missing = is_missing.then(|| missing_light(truth, recorded, place, class)).flatten();
    PencilContribution { delivered, missing }
}

/// The pixel of the image that is nearest to where a point lands, and whether it lands there; `None` for a point that is not before the
/// camera.
fn nearest_pixel(camera: &Mounted<Camera>, point: DVec3) -> Option<(Pixel, bool)> {
    let Mounted { scene_from_sensor: pose, sensor } = camera;
    let seen = Pose { position: DVec3::ZERO, ..pose.inverse() }.rotate(point - pose.position);
    if !(seen.z > sensor.focal_length) {
        return None;
    }
    let place = [0, 1].map(|axis: usize| {
        let at = sensor.focal_length * seen[axis] / seen.z / sensor.pixel_pitch[axis]
            + sensor.principal_point[axis];
        let within = at.floor().clamp(0.0, f64::from([sensor.width, sensor.height][axis] - 1));
        (within as u32, within == at.floor())
    });
    let [(i, is_across), (j, is_down)] = place;
    Some((Pixel { i, j }, is_across && is_down))
}

/// Another hypothesis that is admissible and that all values fit, if what is not stated leaves one.
fn alternative(
    pencil: &RecordedPencil<'_>,
    assumed: &AssumedHit,
    of_hit: (&Hit, &HitBounds, Class),
    (visible, pixel): (bool, Option<Pixel>),
) -> Option<Hypothesis> {
    let RecordedPencil { truth, recorded, place, stated, .. } = pencil;
    let judge = truth.judge();
    // Faces that tie with the true one, if the recording names none: each has its own reflectivity.
    let mut hits: Vec<(Hit, HitBounds, Class)> = vec![(*of_hit.0, *of_hit.1, of_hit.2)];
    if !assumed.is_named {
        let verdict = judge.referee().verdict(place.sensor, place.i, place.j);
        let ray = truth.scene().ray(place.sensor, place.i, place.j)?;
        for face in verdict.map(|verdict| verdict.faces).unwrap_or_default() {
            if let Some(hit) = judge.plane_hit(*place, face).filter(|hit| hit.face != of_hit.0.face) {
                let bounds = HitBounds::of_exact(truth.scene(), &ray, &hit, recorded.precision);
                hits.push((hit, bounds, Class::Tie));
            }
        }
    }
    // The neighbours of the pixel, if the recording states none: equation (1) goes by the pixel's centre.
    let mut pixels = vec![pixel];
    if let (None, Some(Pixel { i, j })) = (stated.pixel, pixel) {
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
            if let Some(hypothesis) = pencil.hypothesis((hit, bounds, *class), visible, pixel, false)
                && hypothesis.fits()
            {
                return Some(hypothesis);
            }
        }
    }
    None
}

/// Enters a hypothesis: the classes of visibility and pixel, and every value.
fn enter(entry: &mut RayEntry<'_>, pencil: &RecordedPencil<'_>, hypothesis: &Hypothesis, contradicts: bool) {
    let RecordedPencil { truth, recorded, place, stated, .. } = pencil;
    if let Some(ruling) = &hypothesis.ruling {
        entry.ruled(ruling);
    }
    let [mut of_visible, mut of_pixel] = hypothesis.classes;
    if contradicts {
        of_visible = Class::Defect;
    }
    if of_visible == Class::Defect || of_pixel == Class::Defect {
        let (truly, true_pixel) = truth.visibility(*place);
        entry.note(&format!(
            "it says {}, true is {}",
            visibility_words(hypothesis.visible, hypothesis.pixel),
            visibility_words(truly, true_pixel)
        ));
        // A channel that is absent cannot be at fault: the one that leads to its value is.
        if stated.visible.is_none() && stated.pixel.is_some() {
            of_pixel = of_pixel.max(of_visible);
        }
        if stated.pixel.is_none() && stated.visible.is_some() {
            of_visible = of_visible.max(of_pixel);
        }
    }
    if stated.visible.is_some() {
        entry.class(Quantity::Visible, of_visible);
    }
    if stated.pixel.is_some() {
        entry.class(Quantity::Pixel, of_pixel);
    }
    let is_blamed =
        of_visible.max(of_pixel) == Class::Defect && stated.visible.is_none() && stated.pixel.is_none();

    let model = truth.scene().flux_model();
    let is_undecided = [hypothesis.exact.flux(model).is_err(), hypothesis.exact.flux(model.other()).is_err()];
    let of_value = if hypothesis.class == Class::Defect { Class::Agree } else { hypothesis.class };
    for difference in &hypothesis.differences {
        let k = usize::from(difference.item.is_other_model);
        let is_flux = difference.item.quantity == Quantity::PencilFlux;
        if is_flux && is_undecided[k] {
            entry.class(difference.item, Class::Undecided);
        } else if is_flux && is_blamed {
            entry.class(difference.item, Class::Defect);
        } else {
            entry.difference(difference, of_value);
        }
    }
    // A hit must have a number in every channel.
    for (quantity, is_stated) in optional_values(stated) {
        if !is_stated && recorded.storage.contains_key(&(place.sensor, quantity.into())) {
            entry.note(&format!("it gives no {quantity} of a hit"));
            entry.class(quantity, Class::Defect);
        }
    }
}

/// The values that only a hit has, and whether they are stated.
fn optional_values(stated: &StatedReturn) -> [(Quantity, bool); 3] {
    [
        (Quantity::CameraDepth, stated.depth.is_some()),
        (Quantity::CosOffAxis, stated.cos_off_axis.is_some()),
        (Quantity::CosView, stated.cos_view.is_some()),
    ]
}

/// Judges the return of a pencil that is taken to hit nothing: no value but "none" is right.
fn judge_no_return(entry: &mut RayEntry<'_>, recorded: &Recorded, stated: &StatedReturn, class: Class) {
    let mut enter = |item: Item, is_wrong: bool, words: &str| {
        if is_wrong {
            entry.note(words);
        }
        entry.class(item, if is_wrong { Class::Defect } else { class });
    };
    if let Some(visible) = stated.visible {
        enter(Quantity::Visible.into(), visible, "it says that what is not hit is seen");
    }
    if let Some(pixel) = stated.pixel {
        enter(Quantity::Pixel.into(), pixel.is_some(), "it says that what is not hit lands on a pixel");
    }
    for k in 0..2 {
        if let Some(flux) = stated.flux[k] {
            enter(Item::pencil_flux(k == 1), flux != 0.0, "it says that what is not hit delivers");
        }
    }
    let sensor = entry.place.sensor;
    for (quantity, is_stated) in optional_values(stated) {
        if is_stated && recorded.storage.contains_key(&(sensor, quantity.into())) {
            entry.note(&format!("it gives a {quantity} of what is not hit"));
            entry.class(quantity, Class::Defect);
        }
    }
}

/// Enters the values of which the recording has no channel.
fn missing_values(entry: &mut RayEntry<'_>, recorded: &Recorded) {
    for item in RETURN_QUANTITIES.map(Item::from).into_iter().chain([Item::pencil_flux(true)]) {
        if !recorded.storage.contains_key(&(entry.place.sensor, item)) {
            entry.missing(item);
        }
    }
}

fn visibility_words(visible: bool, pixel: Option<Pixel>) -> String {
    let seen = if visible { "seen" } else { "not seen" };
    match pixel {
        Some(Pixel { i, j }) => format!("{seen}, in pixel {i},{j}"),
        None => format!("{seen}, off the image"),
    }
}
