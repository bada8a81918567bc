//! What a side states of one item of one ray, in words and as a number, for lists of defects.

use crate::answer::{StatedHit, StatedReturn};
use crate::difference::distance;
use crate::quantity::{Item, Quantity, unit_of};
use crate::scene_answers::Answers;
use raypencil_scene::{FluxModel, Hit, HitQuantity, HitValue, Pixel, Place, Return, SensorId};

/// One item of one ray.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ItemValue {
    /// The value with its unit, or in words.
    pub(crate) words: String,
    /// The number or vector by which it differs from another: of a hit or a face its range, metres.
    value: Option<HitValue>,
}

impl ItemValue {
    fn words(words: impl Into<String>) -> Self {
        Self { words: words.into(), value: None }
    }

    fn number(value: HitValue, unit: &str) -> Self {
        let texts: Vec<String> = value.components().iter().map(|number| digits(*number)).collect();
        let text = if texts.len() == 1 { texts.join("") } else { format!("({})", texts.join(", ")) };
        let words = if unit.is_empty() { text } else { format!("{text} {unit}") };
        Self { words, value: Some(value) }
    }

    /// A hit on a face at a range; each of them may be unknown.
    fn hit(hits: bool, face: Option<u32>, range: Option<f64>) -> Self {
        if !hits {
            return Self::words("no hit");
        }
        let face = face.map_or("a hit".to_string(), |face| format!("face {face}"));
        let words = range.map_or(face.clone(), |range| format!("{face} at {} m", digits(range)));
        Self { words, value: range.map(HitValue::Scalar) }
    }

    fn visible(visible: bool) -> Self {
        Self::words(if visible { "seen" } else { "not seen" })
    }

    fn pixel(pixel: Option<Pixel>) -> Self {
        Self::words(pixel.map_or("off the image".into(), |Pixel { i, j }| format!("pixel {i},{j}")))
    }

    /// How far two values are apart, in the unit of [`difference_unit`]; `None` if one of them is no number.
    pub(crate) fn distance(&self, other: &Self) -> Option<f64> {
        let (a, b) = (self.value.as_ref()?, other.value.as_ref()?);
        (a.components().len() == b.components().len()).then(|| distance(a, b))
    }

    /// What a side states of a ray; `None` if it leaves the item out.
    pub(crate) fn stated(
        hit: &StatedHit<'_>,
        back: Option<&StatedReturn>,
        model: FluxModel,
        item: Item,
    ) -> Option<Self> {
        let unit = unit_of(model, item);
        let number = |value: Option<f64>| match value {
            Some(value) => Self::number(HitValue::Scalar(value), unit),
            None => Self::words("no number"),
        };
        let of_hit = |quantity| match hit.value(quantity) {
            Some(value) => Self::number(value, unit),
            None => Self::words("no number"),
        };
        Some(match item.quantity {
            Quantity::Hit | Quantity::Face => {
                Self::hit(hit.hits_by_any_value()?, hit.face.map(|face| face.0), hit.range)
            }
            Quantity::Range => of_hit(HitQuantity::Range),
            Quantity::Depth => of_hit(HitQuantity::Depth),
            Quantity::Point => of_hit(HitQuantity::Point),
            Quantity::Normal => of_hit(HitQuantity::Normal),
            Quantity::CosIncidence => of_hit(HitQuantity::CosIncidence),
            Quantity::Visible => Self::visible(back?.visible?),
            Quantity::Pixel => Self::pixel(back?.pixel?),
            Quantity::CameraDepth => number(back?.depth),
            Quantity::CosOffAxis => number(back?.cos_off_axis),
            Quantity::CosView => number(back?.cos_view),
            Quantity::PencilFlux => number(Some(back?.flux[usize::from(item.is_other_model)]?)),
            Quantity::PixelFlux => return None,
        })
    }

    /// What the answers about a scene state of a ray; `None` if they leave the item out.
    pub(crate) fn of_answers(answers: &Answers, model: FluxModel, place: Place, item: Item) -> Option<Self> {
        let Place { sensor, i, j } = place;
        if item.quantity == Quantity::PixelFlux {
            let light = answers.light.get(item.beam? as usize)?;
            let image = if item.is_other_model { &light.other_image } else { &light.image };
            let value = HitValue::Scalar(image.as_ref()?.at(i, j));
            return Some(Self::number(value, unit_of(model, item)));
        }
        let back = match sensor {
            SensorId::Camera => None,
            SensorId::Beam(beam) => {
                let light = &answers.light[beam];
                Some(StatedReturn::of(&light.returns, light.other_flux.as_ref(), i, j))
            }
        };
        Self::stated(&StatedHit::of(answers.map(sensor), i, j), back.as_ref(), model, item)
    }

    /// The exact answer to a ray; `None` for what the hit and the return of one ray do not tell.
    pub(crate) fn exact(
        hit: Option<&Hit>,
        back: Option<&Return>,
        model: FluxModel,
        item: Item,
    ) -> Option<Self> {
        let unit = unit_of(model, item);
        let of_hit = |quantity| match hit {
            Some(hit) => Self::number(hit.value(quantity), unit),
            None => Self::words("no number"),
        };
        let of_return = |value: fn(&Return) -> f64| match back {
            Some(back) => Self::number(HitValue::Scalar(value(back)), unit),
            None => Self::words("no number"),
        };
        Some(match item.quantity {
            Quantity::Hit | Quantity::Face => {
                Self::hit(hit.is_some(), hit.map(|hit| hit.face.0), hit.map(|hit| hit.range))
            }
            Quantity::Range => of_hit(HitQuantity::Range),
            Quantity::Depth => of_hit(HitQuantity::Depth),
            Quantity::Point => of_hit(HitQuantity::Point),
            Quantity::Normal => of_hit(HitQuantity::Normal),
            Quantity::CosIncidence => of_hit(HitQuantity::CosIncidence),
            Quantity::Visible => Self::visible(back.is_some_and(|back| back.visible)),
            Quantity::Pixel => Self::pixel(back.and_then(|back| back.pixel)),
            Quantity::CameraDepth => of_return(|back| back.depth),
            Quantity::CosOffAxis => of_return(|back| back.cos_off_axis),
            Quantity::CosView => of_return(|back| back.cos_view),
            Quantity::PencilFlux if !item.is_other_model => of_return(|back| back.flux),
            Quantity::PencilFlux | Quantity::PixelFlux => return None,
        })
    }
}

/// Unit of [`ItemValue::distance`]: a hit and a face differ by their ranges.
pub(crate) fn difference_unit(model: FluxModel, item: Item) -> &'static str {
    match item.quantity {
        Quantity::Hit | Quantity::Face => "m",
        _ => unit_of(model, item),
    }
}

/// A number with all its digits, in the shorter notation.
fn digits(number: f64) -> String {
    let is_plain = number == 0.0 || (1e-3..1e6).contains(&number.abs()) || !number.is_finite();
    if is_plain { number.to_string() } else { format!("{number:e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_told_with_their_unit_and_their_difference() {
        let range = |metres| ItemValue::number(HitValue::Scalar(metres), "m");
        assert_eq!(range(2.5).words, "2.5 m");
        assert_eq!(range(2.5).distance(&range(2.0)), Some(0.5));
        // Two faces differ by their ranges; a miss has none.
        let far = ItemValue::hit(true, Some(7), Some(4.0));
        assert_eq!(far.words, "face 7 at 4 m");
        assert_eq!(far.distance(&ItemValue::hit(true, Some(3), Some(3.0))), Some(1.0));
        assert_eq!(far.distance(&ItemValue::hit(false, None, None)), None);
        let vector = |x| ItemValue::number(HitValue::Vector(glam::DVec3::new(x, 0.0, 1e-9)), "");
        assert_eq!(vector(1.0).words, "(1, 0, 1e-9)");
        assert_eq!(vector(1.0).distance(&vector(3.0)), Some(2.0));
        assert_eq!(vector(1.0).distance(&range(1.0)), None);
    }

    #[test]
    fn the_exact_flux_is_that_of_the_scenes_model() {
        let back =
            Return { visible: true, pixel: None, depth: 1.0, cos_off_axis: 1.0, cos_view: 1.0, flux: 0.25 };
        let flux = |is_other_model| {
            let item = Item::pencil_flux(is_other_model);
            ItemValue::exact(None, Some(&back), FluxModel::Radiometric, item).map(|value| value.words)
        };
        assert_eq!(flux(false).as_deref(), Some("0.25 W"));
        // A return has the flux of one model only.
        assert_eq!(flux(true), None);
    }
}
