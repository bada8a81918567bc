//! Corrections: what undoes a mistake on the numbers of a recording.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::case::Case;
use crate::channel::{Channel, Value, hit_quantity};
use crate::forward::foretold;
use crate::mistake::{Cosine, Length, Mistake, Vectors};
use glam::DVec3;
use raypencil_judge::{Item, Quantity};
use raypencil_scene::{FaceId, HitQuantity, Image, Pixel, Place, SensorId};

/// Factors that correct the flux: of each beam's pencils and of its image, by the scene's model and by the other.
pub(crate) type FluxFactors = Vec<[[Image<f64>; 2]; 2]>;

/// Numbers that a correction needs beside its mistake.
#[derive(Debug, Clone)]
pub(crate) enum Table {
    Empty,
    /// The true face of each index that is stated.
    Faces(Arc<BTreeMap<u32, u32>>),
    Flux(Arc<FluxFactors>),
}

/// A mistake and what undoes it.
#[derive(Debug, Clone)]
pub(crate) struct Correction {
    pub(crate) mistake: Mistake,
    pub(crate) table: Table,
}

impl From<Mistake> for Correction {
    fn from(mistake: Mistake) -> Self {
        Self { mistake, table: Table::Empty }
    }
}

impl Correction {
    /// Whether it changes the numbers of a channel.
    pub(crate) fn touches(&self, channel: Channel) -> bool {
        use HitQuantity as H;
        let quantity = channel.item.quantity;
        let hit = hit_quantity(quantity);
        let is_cosine = matches!(quantity, Quantity::CosIncidence | Quantity::CosOffAxis | Quantity::CosView);
        let is_flux = matches!(quantity, Quantity::PencilFlux | Quantity::PixelFlux);
        match self.mistake {
            Mistake::RowsReversed
            | Mistake::ColumnsReversed
            | Mistake::Transposed
            | Mistake::Shifted { .. } => true,
            Mistake::MissWritten(_) | Mistake::MissAtMaximumRange => {
                !is_flux && quantity != Quantity::Visible
            }
            Mistake::FacesShifted(_) | Mistake::FacesReordered => quantity == Quantity::Face,
            Mistake::DepthForRange | Mistake::ParameterForRange => hit == Some(H::Range),
            Mistake::RangeForDepth | Mistake::ParameterForDepth => hit == Some(H::Depth),
            Mistake::Unit(_) => {
                matches!(hit, Some(H::Range | H::Depth | H::Point)) || quantity == Quantity::CameraDepth
            }
            Mistake::AxesYUp
            | Mistake::AxesYUpInverse
            | Mistake::Axes { of: Vectors::Both, .. }
            | Mistake::SensorFrame { of: Vectors::Both, .. } => matches!(hit, Some(H::Point | H::Normal)),
            Mistake::Axes { of: Vectors::Normals, .. }
            | Mistake::SensorFrame { of: Vectors::Normals, .. } => hit == Some(H::Normal),
            Mistake::Axes { of: Vectors::Points, .. }
            | Mistake::SensorFrame { of: Vectors::Points, .. }
            | Mistake::GlobalFrame
            | Mistake::PointsFromSensor
            | Mistake::PointsMoved(_)
            | Mistake::PointsRounded(_) => hit == Some(H::Point),
            Mistake::DistanceForView => quantity == Quantity::CameraDepth,
            Mistake::NormalsReversed | Mistake::NormalsNotUnit => hit == Some(H::Normal),
            Mistake::CosinesNegated | Mistake::AngleForCosine(_) => is_cosine,
            Mistake::CosinesExchanged(_) => is_cosine && channel.sensor != SensorId::Camera,
            Mistake::PixelRowsFromBottom | Mistake::PixelColumnsFromRight | Mistake::PixelsExchanged => {
                quantity == Quantity::Pixel
            }
            Mistake::OtherFluxModel | Mistake::AttenuationOn(_) | Mistake::FluxFactor(_) => is_flux,
            Mistake::Affine { of: Length::All, offset: 0.0, .. } => {
                matches!(hit, Some(H::Range | H::Depth | H::Point)) || quantity == Quantity::CameraDepth
            }
            // Depths in the camera are depths, too.
            Mistake::Rounded { of: Length::Depth | Length::All, .. }
            | Mistake::HalfPrecision(Length::Depth | Length::All)
            | Mistake::Inverse(Length::Depth | Length::All)
            | Mistake::Squared(Length::Depth | Length::All)
                if quantity == Quantity::CameraDepth =>
            {
                true
            }
            Mistake::Affine { of, .. }
            | Mistake::FromPlane(of)
            | Mistake::Rounded { of, .. }
            | Mistake::HalfPrecision(of)
            | Mistake::Inverse(of)
            | Mistake::Squared(of) => match of {
                Length::Range => hit == Some(H::Range),
                Length::Depth => hit == Some(H::Depth),
                Length::All => matches!(hit, Some(H::Range | H::Depth)),
            },
            Mistake::ZBuffer { .. } => hit == Some(H::Depth),
            Mistake::HoldsBeam(_) => channel.sensor != SensorId::Camera,
            Mistake::BeamFluxExchanged => channel.sensor == SensorId::Camera && is_flux,
            Mistake::VisibleReversed => quantity == Quantity::Visible,
            Mistake::NoShadowTest | Mistake::HitsVisible => {
                matches!(quantity, Quantity::Visible | Quantity::PencilFlux)
            }
            Mistake::Cut { .. } => true,
            _ => false,
        }
    }

    /// Whether it makes other lengths of lengths, by arithmetic.
    pub(crate) fn is_of_the_size_of_lengths(&self) -> bool {
        matches!(
            self.mistake,
            Mistake::Unit(_)
                | Mistake::Affine { .. }
                | Mistake::Inverse(_)
                | Mistake::Squared(_)
                | Mistake::FromPlane(_)
                | Mistake::DepthForRange
                | Mistake::ParameterForRange
                | Mistake::RangeForDepth
                | Mistake::ParameterForDepth
        )
    }

    /// Whether only one of the two can be made: they change the same convention.
    pub(crate) fn excludes(&self, other: &Self) -> bool {
        let kind = |mistake: &Mistake| match mistake {
            Mistake::MissWritten(_) | Mistake::MissAtMaximumRange => 1,
            Mistake::FacesShifted(_) | Mistake::FacesReordered => 2,
            Mistake::DepthForRange | Mistake::ParameterForRange | Mistake::FromPlane(Length::Range) => 3,
            Mistake::RangeForDepth | Mistake::ParameterForDepth | Mistake::FromPlane(Length::Depth) => 4,
            Mistake::VisibleReversed | Mistake::NoShadowTest | Mistake::HitsVisible => 12,
            Mistake::Unit(_) => 5,
            Mistake::AxesYUp
            | Mistake::AxesYUpInverse
            | Mistake::Axes { .. }
            | Mistake::SensorFrame { .. }
            | Mistake::PointsFromSensor
            | Mistake::PointsMoved(_)
            | Mistake::GlobalFrame => 6,
            Mistake::CosinesExchanged(_) => 7,
            Mistake::OtherFluxModel | Mistake::AttenuationOn(_) => 8,
            Mistake::CosinesNegated | Mistake::AngleForCosine(_) => 9,
            Mistake::Shifted { .. } => 10,
            Mistake::Cut { .. } => 11,
            // Laws of depths: one undoes another.
            Mistake::ZBuffer { .. }
            | Mistake::Inverse(Length::Depth | Length::All)
            | Mistake::Squared(Length::Depth | Length::All) => 13,
            _ => 0,
        };
        // A number that is fitted to lengths in another unit is that unit.
        let is_length = |mistake: &Mistake| matches!(mistake, Mistake::Unit(_) | Mistake::Affine { .. });
        // A depth as t is a depth times one number, and from the plane less one number: with a fitted line it is another line, and with a
        // z-buffer another z-buffer.
        let is_line = |mistake: &Mistake| {
            matches!(mistake, Mistake::Affine { of: Length::Depth, .. } | Mistake::ZBuffer { .. })
        };
        let is_of_depth = |mistake: &Mistake| {
            matches!(mistake, Mistake::ParameterForDepth | Mistake::FromPlane(Length::Depth))
        };
        let (a, b) = (&self.mistake, &other.mistake);
        kind(a) != 0 && kind(a) == kind(b)
            || is_length(a) && is_length(b)
            || is_line(a) && is_of_depth(b)
            || is_of_depth(a) && is_line(b)
    }

    /// Whether it says something of all lengths: then it must be true of each.
    pub(crate) fn is_of_all_lengths(&self) -> bool {
        matches!(
            self.mistake,
            Mistake::Affine { of: Length::All, .. }
                | Mistake::FromPlane(Length::All)
                | Mistake::Rounded { of: Length::All, .. }
                | Mistake::HalfPrecision(Length::All)
                | Mistake::Inverse(Length::All)
                | Mistake::Squared(Length::All)
        )
    }

    /// Whether it says something of points and of normals: without one of them it is said of the other alone.
    pub(crate) fn is_of_both_vectors(&self) -> bool {
        matches!(self.mistake, Mistake::SensorFrame { of: Vectors::Both, .. })
    }

    /// Whether it says something of what the rays hit, and so must be true of each of these channels: a row of lost hits is no shift of the
    /// faces alone, beside ranges that stand where they should.
    pub(crate) fn is_of_all_hits(&self) -> bool {
        matches!(self.mistake, Mistake::Shifted { .. })
    }

    /// The cell in which the ray of `place` stands; `None` if no cell has it.
    pub(crate) fn source(&self, case: Case<'_>, place: Place) -> Option<Place> {
        let Place { sensor, i, j } = place;
        let (width, height) = case.truth.scene().size(sensor)?;
        Some(match self.mistake {
            Mistake::RowsReversed => Place { j: height - 1 - j, ..place },
            Mistake::ColumnsReversed => Place { i: width - 1 - i, ..place },
            Mistake::Transposed => {
                let index = u64::from(i) * u64::from(height) + u64::from(j);
                let (i, j) = (index % u64::from(width), index / u64::from(width));
                Place { sensor, i: i as u32, j: j as u32 }
            }
            Mistake::Shifted { columns, rows } => Place {
                sensor,
                i: i.checked_add_signed(columns).filter(|i| *i < width)?,
                j: j.checked_add_signed(rows).filter(|j| *j < height)?,
            },
            _ => place,
        })
    }

    /// The value of a channel for the ray of `place`, which stands in the cell `source`.
    pub(crate) fn correct(
        &self,
        case: Case<'_>,
        channel: Channel,
        place: Place,
        source: Place,
        value: Value,
    ) -> Value {
        if let Mistake::MissWritten(_) | Mistake::MissAtMaximumRange = self.mistake {
            return if self.is_miss(case, source) { Value::Nothing } else { value };
        }
        if let Mistake::Rounded { .. }
        | Mistake::PointsRounded(_)
        | Mistake::HalfPrecision(_)
        | Mistake::ZBuffer { .. }
        | Mistake::Cut { .. }
        | Mistake::HoldsBeam(_)
        | Mistake::BeamFluxExchanged
        | Mistake::NoShadowTest
        | Mistake::HitsVisible
        | Mistake::VisibleReversed = self.mistake
        {
            return foretold(self.mistake, case, channel, place, value);
        }
        match value {
            Value::Nothing | Value::Flag(_) => value,
            Value::Number(number) => Value::Number(self.number(case, channel, place, number)),
            Value::Vector(vector) => Value::Vector(self.vector(case, channel, vector)),
            Value::Face(face) => self.face(face),
            Value::Pixel(pixel) => self.pixel(case, pixel),
        }
    }

    /// Whether the first number of a cell is the one that means "no hit".
    fn is_miss(&self, case: Case<'_>, source: Place) -> bool {
        let constant = match self.mistake {
            Mistake::MissWritten(constant) => constant,
            _ => case.truth.scene().max_range(source.sensor).unwrap_or(f64::INFINITY),
        };
        let map = case.recorded.answers.map(source.sensor);
        let speaker = HitQuantity::ALL.into_iter().find(|one| map.raster(*one).is_some());
        let value = speaker.and_then(|speaker| map.raster(speaker)?.at(source.i, source.j));
        // A file of single precision holds the constant rounded.
        value.is_some_and(|value| {
            value.components().iter().all(|one| *one == constant || *one == f64::from(constant as f32))
        })
    }

    fn number(&self, case: Case<'_>, channel: Channel, place: Place, number: f64) -> f64 {
        let scene = case.truth.scene();
        let length = || {
            let ray = scene.ray(place.sensor, place.i, place.j);
            ray.map_or(f64::NAN, |ray| ray.direction.length())
        };
        let axis = match place.sensor {
            SensorId::Camera => scene.camera().sensor.focal_length,
            SensorId::Beam(beam) => scene.beams()[beam].sensor.grid_distance,
        };
        match self.mistake {
            Mistake::DepthForRange => number * length() / axis,
            Mistake::ParameterForRange => number * length(),
            Mistake::RangeForDepth => number * axis / length(),
            Mistake::ParameterForDepth => number * axis,
            Mistake::Unit(unit) => unit.to_metres(number),
            Mistake::Affine { factor, offset, .. } => (number - offset) / factor,
            Mistake::FromPlane(_) if channel.item.quantity == Quantity::Range => number + length(),
            Mistake::FromPlane(_) => number + axis,
            Mistake::CosinesNegated => -number,
            Mistake::DistanceForView => {
                // The cosine of the angle off the camera's axis is the depth over the distance.
                let item = Item::from(Quantity::CosOffAxis);
                match (Channel { item, ..channel }).at(case.truth.answers(), place) {
                    Value::Number(cosine) => number * cosine,
                    _ => f64::NAN,
                }
            }
            Mistake::Inverse(_) => 1.0 / number,
            Mistake::Squared(_) => number.sqrt(),
            Mistake::AngleForCosine(unit) => unit.cosine(number),
            Mistake::CosinesExchanged(held) => {
                let quantities = [Quantity::CosIncidence, Quantity::CosOffAxis, Quantity::CosView];
                let Some(own) = quantities.iter().position(|one| *one == channel.item.quantity) else {
                    return number;
                };
                let held = Cosine::ALL.into_iter().position(|one| one == held[own]).unwrap_or(own);
                let exact = |which: usize| {
                    let item = Item::from(quantities[which]);
                    match (Channel { item, ..channel }).at(case.truth.answers(), place) {
                        Value::Number(exact) => exact,
                        _ => f64::NAN,
                    }
                };
                scaled(number, exact(own), exact(held))
            }
            Mistake::OtherFluxModel => {
                let of = |is_other_model: bool| {
                    let item = Item { is_other_model, ..channel.item };
                    match (Channel { item, ..channel }).at(case.truth.answers(), place) {
                        Value::Number(exact) => exact,
                        _ => f64::NAN,
                    }
                };
                let own = channel.item.is_other_model;
                scaled(number, of(own), of(!own))
            }
            Mistake::FluxFactor(factor) => number / factor,
            Mistake::AttenuationOn(_) => {
                let (Table::Flux(factors), Some(beam)) = (&self.table, channel.beam()) else { return number };
                let is_image = usize::from(channel.item.quantity == Quantity::PixelFlux);
                number
                    * factors[beam][is_image][usize::from(channel.item.is_other_model)].at(place.i, place.j)
            }
            _ => number,
        }
    }

    fn vector(&self, case: Case<'_>, channel: Channel, vector: DVec3) -> DVec3 {
        let scene = case.truth.scene();
        let is_point = channel.item.quantity == Quantity::Point;
        let stated = vector.to_array();
        let pose = || match channel.sensor {
            SensorId::Camera => scene.camera().scene_from_sensor,
            SensorId::Beam(beam) => scene.beams()[beam].scene_from_sensor,
        };
        let turned = |from: [usize; 3], sign: [i8; 3]| {
            DVec3::from_array(std::array::from_fn(|k| f64::from(sign[k]) * stated[from[k]]))
        };
        match self.mistake {
            Mistake::Unit(unit) => DVec3::from_array(stated.map(|one| unit.to_metres(one))),
            Mistake::Affine { factor, .. } => vector / factor,
            Mistake::AxesYUp => turned([0, 2, 1], [1, -1, 1]),
            Mistake::AxesYUpInverse => turned([0, 2, 1], [1, 1, -1]),
            Mistake::Axes { from, sign, .. } => turned(from, sign),
            Mistake::SensorFrame { axes, .. } => {
                let optical = DVec3::from_array(axes.to_optical(stated));
                if is_point { pose() * optical } else { pose().rotate(optical) }
            }
            Mistake::PointsFromSensor => vector + pose().position,
            Mistake::PointsMoved(by) => vector - DVec3::from_array(by),
            Mistake::GlobalFrame => vector - scene.mesh().origin(),
            Mistake::NormalsReversed => -vector,
            Mistake::NormalsNotUnit => vector / vector.length(),
            _ => vector,
        }
    }

    fn face(&self, face: FaceId) -> Value {
        match (&self.mistake, &self.table) {
            // One too large, 0 is no face.
            (Mistake::FacesShifted(by), _) => match i64::from(face.0) - i64::from(*by) {
                index @ 0..0xffff_ffff => Value::Face(FaceId(index as u32)),
                _ => Value::Nothing,
            },
            (Mistake::FacesReordered, Table::Faces(faces)) => {
                Value::Face(faces.get(&face.0).map_or(face, |own| FaceId(*own)))
            }
            _ => Value::Face(face),
        }
    }

    fn pixel(&self, case: Case<'_>, pixel: Pixel) -> Value {
        let (width, height) = case.truth.scene().size(SensorId::Camera).unwrap_or((1, 1));
        let pixel = match self.mistake {
            Mistake::PixelRowsFromBottom => {
                Pixel { j: (height - 1).checked_sub(pixel.j).unwrap_or(pixel.j), ..pixel }
            }
            Mistake::PixelColumnsFromRight => {
                Pixel { i: (width - 1).checked_sub(pixel.i).unwrap_or(pixel.i), ..pixel }
            }
            Mistake::PixelsExchanged => Pixel { i: pixel.j, j: pixel.i },
            _ => pixel,
        };
        // The judge sums light by pixels of the image alone.
        if pixel.i < width && pixel.j < height { Value::Pixel(pixel) } else { Value::Nothing }
    }
}

/// A number times own/held; without a ratio the number itself.
fn scaled(number: f64, own: f64, held: f64) -> f64 {
    if held == 0.0 || !held.is_finite() || !own.is_finite() { number } else { number * (own / held) }
}

/// The value of a channel for the ray of `place`, after some corrections. `None`: no cell holds that ray.
pub(crate) fn corrected(
    case: Case<'_>,
    channel: Channel,
    place: Place,
    corrections: &[&Correction],
) -> Option<Value> {
    let source = source_of(case, place, corrections)?;
    let stated = channel.at(&case.recorded.answers, source);
    Some(corrected_from(case, channel, place, (source, stated), corrections))
}

/// The cell in which the ray of `place` stands before some corrections; `None` if no cell has it.
fn source_of(case: Case<'_>, place: Place, corrections: &[&Correction]) -> Option<Place> {
    corrections.iter().try_fold(place, |source, one| one.source(case, source))
}

/// The same for a value that is stated in the cell `source`.
fn corrected_from(
    case: Case<'_>,
    channel: Channel,
    place: Place,
    (source, stated): (Place, Value),
    corrections: &[&Correction],
) -> Value {
    let mut value = stated;
    // A constant for "no hit" is one of the file's own numbers: it goes before any of them changes.
    let is_miss =
        |one: &Correction| matches!(one.mistake, Mistake::MissWritten(_) | Mistake::MissAtMaximumRange);
    for wanted in [true, false] {
        for one in corrections.iter().filter(|one| is_miss(one) == wanted && one.touches(channel)) {
            value = one.correct(case, channel, place, source, value);
        }
    }
    value
}

/// The least and the most that a number may have been, after some corrections, before its file rounded it: by so many of the units
/// in which the file has it. `None` without such a number, or where they do not enclose it, as the reciprocals of less and more than 0.
pub(crate) fn before_rounding(
    case: Case<'_>,
    channel: Channel,
    place: Place,
    corrections: &[&Correction],
    units: f64,
) -> Option<[f64; 2]> {
    let source = source_of(case, place, corrections)?;
    let Value::Number(stated) = channel.at(&case.recorded.answers, source) else { return None };
    let unit = case.recorded.storage.get(&(channel.sensor, channel.item))?.ulp(stated);
    let of = |number: f64| match corrected_from(
        case,
        channel,
        place,
        (source, Value::Number(number)),
        corrections,
    ) {
        Value::Number(number) if number.is_finite() => Some(number),
        _ => None,
    };
    let [a, here, b] = [of(stated - units * unit)?, of(stated)?, of(stated + units * unit)?];
    let [least, most] = [a.min(b), a.max(b)];
    (least..=most).contains(&here).then_some([least, most])
}

#[cfg(test)]
#[path = "../tests/unit/correction.rs"]
mod tests;
