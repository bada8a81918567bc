//! Pixels on which two sides agree: nearly all of them, entered without the questions that a difference asks.
//!
//! A pixel is entered here if both sides state the same face with all values, all within their bounds, or no hit; if it
//! gets no light; and if the referee is not asked about it. What is entered is what `compare_ray` would enter, to the bit:
//! a test compares the two. Every other pixel is left to it.

use glam::DVec3;
use raypencil_scene::{FaceId, HitQuantity, Image, Maybe, Place, SensorMap};

use crate::bounds::FaceShape;
use crate::class::Class;
use crate::compare::pixel::BeamImages;
use crate::compare::ray::ComparedRays;
use crate::compare::side::Side;
use crate::difference::Difference;
use crate::judge::Judge;
use crate::quantity::Quantity;

/// The rasters of a map that has all quantities.
#[derive(Debug, Clone, Copy)]
struct Rasters<'m> {
    face: &'m Image<Maybe<FaceId>>,
    range: &'m Image<Maybe<f64>>,
    depth: &'m Image<Maybe<f64>>,
    cos_incidence: &'m Image<Maybe<f64>>,
    point: &'m Image<Maybe<DVec3>>,
    normal: &'m Image<Maybe<DVec3>>,
}

impl<'m> Rasters<'m> {
    fn of(map: &'m SensorMap) -> Option<Self> {
        Some(Self {
            face: map.face.as_ref()?,
            range: map.range.as_ref()?,
            depth: map.depth.as_ref()?,
            cos_incidence: map.cos_incidence.as_ref()?,
            point: map.point.as_ref()?,
            normal: map.normal.as_ref()?,
        })
    }
}

/// The pixels of two maps that have all quantities.
pub(super) struct AgreeingPixels<'c> {
    judge: &'c Judge<'c>,
    maps: [Rasters<'c>; 2],
    sides: [Side<'c>; 2],
    light: &'c [BeamImages<'c>],
    /// The face of the pixel before, and its shape: neighbours often share it.
    last: Option<(FaceId, FaceShape)>,
}

impl<'c> AgreeingPixels<'c> {
    /// `None` if a map leaves out a quantity, or a beam its image.
    pub(super) fn new(
        judge: &'c Judge<'c>,
        (map_a, a): (&'c SensorMap, Side<'c>),
        (map_b, b): (&'c SensorMap, Side<'c>),
        light: &'c [BeamImages<'c>],
    ) -> Option<Self> {
        let maps = [Rasters::of(map_a)?, Rasters::of(map_b)?];
        let has_all_images = light.len() == judge.scene().beams().len();
        has_all_images.then_some(Self { judge, maps, sides: [a, b], light, last: None })
    }

    /// Enters the pixel, if it is one of these. Whether it is.
    pub(super) fn enter(&mut self, place: Place, rays: &mut ComparedRays) -> bool {
        let Place { i, j, .. } = place;
        if self.judge.samples(place) || !self.light.iter().all(|images| images.are_dark(i, j)) {
            return false;
        }
        // A first error of 0 is entered with its place.
        let is_first = |quantity: Quantity| {
            rays.result.items.get(quantity.into()).is_none_or(|tally| tally.worst_error.is_none())
        };
        if !self.light.is_empty() && is_first(Quantity::PixelFlux) {
            return false;
        }
        let [a, b] = self.maps;
        let range_difference = match (a.face.at(i, j).get(), b.face.at(i, j).get()) {
            (None, None) if a.range.at(i, j) == Maybe::NONE && b.range.at(i, j) == Maybe::NONE => Maybe::NONE,
            (Some(face), Some(other)) if face == other => {
                let Some(differences) = self.differences(place, face) else { return false };
                if !differences.iter().all(Difference::is_within) {
                    return false;
                }
                for difference in differences {
                    let tally = rays.result.tally(difference.item);
                    tally.enter(&difference, place, None);
                    tally.by_class[Class::Agree as usize] += 1;
                }
                rays.result.tally(Quantity::Face.into()).by_class[Class::Agree as usize] += 1;
                let [of_a, of_b] = [a, b].map(|map| map.range.at(i, j).get());
                of_a.zip(of_b).map(|(a, b)| b - a).into()
            }
            _ => return false,
        };
        rays.range_differences.push(range_difference);
        rays.result.tally(Quantity::Hit.into()).by_class[Class::Agree as usize] += 1;
        if !self.light.is_empty() {
            rays.result.tally(Quantity::PixelFlux.into()).by_class[Class::Agree as usize] += 1;
        }
        rays.result.by_class[Class::Agree as usize] += 1;
        true
    }

    /// The differences of all values of a pixel whose sides both name `face`; `None` if a side leaves one out, or if the
    /// mesh has no such face.
    fn differences(&mut self, Place { sensor, i, j }: Place, face: FaceId) -> Option<[Difference; 5]> {
        let scene = self.judge.scene();
        let shape = match self.last {
            Some((last, shape)) if last == face => shape,
            _ if (face.0 as usize) < scene.mesh().faces().len() => FaceShape::of(scene.mesh(), face),
            _ => return None,
        };
        self.last = Some((face, shape));
        let met = shape.met_by(&scene.ray(sensor, i, j)?);
        let [a, b] = self.maps;
        let [range_a, range_b] = [a.range.at(i, j).get()?, b.range.at(i, j).get()?];
        let [side_a, side_b] = self.sides;
        let bounds = met.bounds(range_a, side_a.precision).plus(&met.bounds(range_b, side_b.precision));
        let scalar = |a: &Image<Maybe<f64>>, b: &Image<Maybe<f64>>| {
            Some((a.at(i, j).get()? - b.at(i, j).get()?).abs())
        };
        let vector = |a: &Image<Maybe<DVec3>>, b: &Image<Maybe<DVec3>>| {
            let d = (a.at(i, j).get()? - b.at(i, j).get()?).abs();
            Some((d.x * d.x + d.y * d.y + d.z * d.z).sqrt())
        };
        let difference = |quantity: HitQuantity, error: f64| {
            Difference::computed(Quantity::from(quantity), error, Some(bounds.of_quantity(quantity)))
        };
        Some([
            difference(HitQuantity::Range, (range_a - range_b).abs()),
            difference(HitQuantity::Depth, scalar(a.depth, b.depth)?),
            difference(HitQuantity::CosIncidence, scalar(a.cos_incidence, b.cos_incidence)?),
            difference(HitQuantity::Point, vector(a.point, b.point)?),
            difference(HitQuantity::Normal, vector(a.normal, b.normal)?),
        ])
    }
}

#[cfg(test)]
#[path = "../../tests/unit/agreeing.rs"]
mod tests;
