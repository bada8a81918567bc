//! Channels of a recording, cell by cell, whatever they hold.

use glam::DVec3;
use raypencil_judge::{Answers, Item, Quantity, Recorded};
use raypencil_scene::{
    FaceId, HitQuantity, HitRasterMut, HitValue, Image, Maybe, Pixel, Place, Sample, SensorId,
};

/// What one cell of a channel holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Value {
    /// No hit, or no pixel.
    Nothing,
    Face(FaceId),
    Number(f64),
    Vector(DVec3),
    Flag(bool),
    Pixel(Pixel),
}

impl Value {
    fn of<T: Sample>(cell: Maybe<T>, wrap: impl Fn(T) -> Self) -> Self {
        cell.get().map_or(Self::Nothing, wrap)
    }
}

/// One channel: a quantity of a sensor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Channel {
    pub(crate) sensor: SensorId,
    pub(crate) item: Item,
}

/// The channels that a recording has of some sensors, in their order.
pub(crate) fn channels_of(recorded: &Recorded, sensors: &[SensorId]) -> Vec<Channel> {
    let all = recorded.storage.keys().map(|&(sensor, item)| Channel { sensor, item });
    all.filter(|channel| sensors.contains(&channel.sensor)).collect()
}

/// The quantity of a hit that is a number or a vector.
pub(crate) fn hit_quantity(quantity: Quantity) -> Option<HitQuantity> {
    HitQuantity::ALL.into_iter().find(|one| Quantity::from(*one) == quantity)
}

impl Channel {
    /// Whether it says what a ray hits.
    pub(crate) fn is_of_hit(self) -> bool {
        self.item.quantity == Quantity::Face || hit_quantity(self.item.quantity).is_some()
    }

    /// The beam of a flux or a return.
    pub(crate) fn beam(self) -> Option<usize> {
        match (self.sensor, self.item.beam) {
            (_, Some(beam)) => Some(beam as usize),
            (SensorId::Beam(beam), None) => Some(beam),
            (SensorId::Camera, None) => None,
        }
    }

    /// What a cell of it holds.
    pub(crate) fn at(self, answers: &Answers, place: Place) -> Value {
        let Place { i, j, .. } = place;
        let map = answers.map(self.sensor);
        if self.item.quantity == Quantity::Face {
            return map.face.as_ref().map_or(Value::Nothing, |image| Value::of(image.at(i, j), Value::Face));
        }
        if let Some(quantity) = hit_quantity(self.item.quantity) {
            return match map.raster(quantity).and_then(|raster| raster.at(i, j)) {
                None => Value::Nothing,
                Some(HitValue::Scalar(number)) => Value::Number(number),
                Some(HitValue::Vector(vector)) => Value::Vector(vector),
            };
        }
        let Some(light) = self.beam().and_then(|beam| answers.light.get(beam)) else { return Value::Nothing };
        let returns = &light.returns;
        let number = |image: &Option<Image<Maybe<f64>>>| {
            image.as_ref().map_or(Value::Nothing, |image| Value::of(image.at(i, j), Value::Number))
        };
        let plain = |image: &Option<Image<f64>>| {
            image.as_ref().map_or(Value::Nothing, |image| Value::Number(image.at(i, j)))
        };
        match (self.item.quantity, self.item.is_other_model) {
            (Quantity::Visible, _) => {
                returns.visible.as_ref().map_or(Value::Nothing, |image| Value::Flag(image.at(i, j)))
            }
            (Quantity::Pixel, _) => {
                returns.pixel.as_ref().map_or(Value::Nothing, |image| Value::of(image.at(i, j), Value::Pixel))
            }
            (Quantity::CameraDepth, _) => number(&returns.depth),
            (Quantity::CosOffAxis, _) => number(&returns.cos_off_axis),
            (Quantity::CosView, _) => number(&returns.cos_view),
            (Quantity::PencilFlux, false) => plain(&returns.flux),
            (Quantity::PencilFlux, true) => plain(&light.other_flux),
            (Quantity::PixelFlux, false) => plain(&light.image),
            (Quantity::PixelFlux, true) => plain(&light.other_image),
            _ => Value::Nothing,
        }
    }

    /// Replaces all cells, which are given row by row.
    pub(crate) fn replace(self, answers: &mut Answers, (width, height): (u32, u32), cells: &[Value]) {
        fn image<T: Copy>(
            (width, height): (u32, u32),
            cells: &[Value],
            take: impl Fn(Value) -> T,
        ) -> Option<Image<T>> {
            Some(Image::from_cells(width, height, cells.iter().map(|cell| take(*cell)).collect()))
        }
        let size = (width, height);
        let number = |value: Value| match value {
            Value::Number(number) => Maybe::from(Some(number).filter(|number| !number.is_nan())),
            _ => Maybe::NONE,
        };
        let plain = |value: Value| if let Value::Number(number) = value { number } else { 0.0 };
        let vector = |value: Value| match value {
            Value::Vector(vector) => Maybe::from(Some(vector).filter(|vector| vector.is_finite())),
            _ => Maybe::NONE,
        };
        let map_index = match self.sensor {
            SensorId::Camera => 0,
            SensorId::Beam(beam) => beam + 1,
        };
        if self.item.quantity == Quantity::Face {
            answers.maps[map_index].face = image(size, cells, |value| match value {
                Value::Face(face) => Maybe::from(Some(face).filter(|face| !face.is_nothing())),
                _ => Maybe::NONE,
            });
            return;
        }
        if let Some(quantity) = hit_quantity(self.item.quantity) {
            match answers.maps[map_index].raster_mut(quantity) {
                HitRasterMut::Scalar(raster) => *raster = image(size, cells, number),
                HitRasterMut::Vector(raster) => *raster = image(size, cells, vector),
            }
            return;
        }
        let Some(light) = self.beam().and_then(|beam| answers.light.get_mut(beam)) else { return };
        match (self.item.quantity, self.item.is_other_model) {
            (Quantity::Visible, _) => {
                light.returns.visible = image(size, cells, |value| value == Value::Flag(true));
            }
            (Quantity::Pixel, _) => {
                light.returns.pixel = image(size, cells, |value| match value {
                    Value::Pixel(pixel) => Maybe::from(Some(pixel)),
                    _ => Maybe::NONE,
                });
            }
            (Quantity::CameraDepth, _) => light.returns.depth = image(size, cells, number),
            (Quantity::CosOffAxis, _) => light.returns.cos_off_axis = image(size, cells, number),
            (Quantity::CosView, _) => light.returns.cos_view = image(size, cells, number),
            (Quantity::PencilFlux, false) => light.returns.flux = image(size, cells, plain),
            (Quantity::PencilFlux, true) => light.other_flux = image(size, cells, plain),
            (Quantity::PixelFlux, false) => light.image = image(size, cells, plain),
            (Quantity::PixelFlux, true) => light.other_image = image(size, cells, plain),
            _ => {}
        }
    }
}
