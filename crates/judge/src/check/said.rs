//! What a recording says of one ray, and how far that is from exact values.

use glam::DVec3;

use crate::answers::BeamLight;
use crate::bounds::{Bounds, ReturnBounds};
use crate::class::{Item, Quantity};
use crate::recorded::Recorded;
use raypencil_files::Storage;
use raypencil_referee::{Format, RoundedReturn};
use raypencil_scene::{FaceId, FluxModel, Hit, Image, Maybe, Pixel, Sample, SensorId, SensorMap};

/// What is said of what a ray meets. `None`: nothing is said, or nothing is hit.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SaidHit {
    /// Whether it hits, if anything is said.
    pub(super) hit: Option<bool>,
    /// Whether faces are named at all.
    pub(super) names_faces: bool,
    pub(super) face: Option<FaceId>,
    pub(super) range: Option<f64>,
    depth: Option<f64>,
    cos_incidence: Option<f64>,
    point: Option<DVec3>,
    normal: Option<DVec3>,
}

/// How far one value is from the exact one.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Difference {
    pub(super) item: Item,
    /// In the unit of the quantity; of a vector its length.
    pub(super) error: f64,
    /// In units of the last place of the storage; of a vector the error of a part in that of the largest part.
    pub(super) ulps: f64,
    /// What the arithmetic and the storage explain.
    pub(super) bound: f64,
    /// Whether the storage is too coarse to hold the exact value as anything but 0, or half of itself.
    pub(super) is_lost: bool,
}

impl Difference {
    pub(super) fn is_within(&self) -> bool {
        // The same number is right whatever the bound; what is not a number is not.
        self.error == 0.0 || self.error <= self.bound
    }

    /// Of some parts of one quantity whose arithmetic may be off by `bound` in all.
    fn of(item: Item, storage: Storage, said: &[f64], exact: &[f64], bound: f64) -> Self {
        // The last place of the largest part: a part that is all but 0 has no last place to speak of.
        let place = storage.ulp(exact.iter().fold(0.0, |largest: f64, part| largest.max(part.abs())));
        let (mut squared, mut slack, mut ulps) = (0.0, 0.0, 0.0_f64);
        for (&said, &exact) in said.iter().zip(exact) {
            let off = (said - exact).abs();
            squared += off * off;
            // What is said was rounded once to be stored, the exact value once to f64.
            let stored = 0.5 * (storage.ulp(said) + Storage::F64.ulp(exact));
            slack += stored * stored;
            if off > 0.0 {
                ulps = ulps.max(off / place);
            }
        }
        // A square may vanish or overflow, a single part must not.
        let length = |squared: f64, only: f64| if said.len() == 1 { only } else { squared.sqrt() };
        let first = (said[0] - exact[0]).abs();
        let stored = 0.5 * (storage.ulp(said[0]) + Storage::F64.ulp(exact[0]));
        let largest = exact.iter().fold(0.0, |largest: f64, part| largest.max(part.abs()));
        Self {
            item,
            error: length(squared, first),
            ulps,
            bound: bound + length(slack, stored),
            is_lost: largest > 0.0 && 0.5 * storage.ulp(largest) >= largest,
        }
    }
}

fn at<T: Sample>(image: &Option<Image<Maybe<T>>>, i: u32, j: u32) -> Option<T> {
    image.as_ref().and_then(|image| image.at(i, j).get())
}

impl SaidHit {
    pub(super) fn of(map: &SensorMap, i: u32, j: u32) -> Self {
        let mut said = Self {
            hit: None,
            names_faces: map.face.is_some(),
            face: at(&map.face, i, j),
            range: at(&map.range, i, j),
            depth: at(&map.depth, i, j),
            cos_incidence: at(&map.cos_incidence, i, j),
            point: at(&map.point, i, j),
            normal: at(&map.normal, i, j),
        };
        let says = map.face.is_some()
            || map.range.is_some()
            || map.depth.is_some()
            || map.point.is_some()
            || map.normal.is_some()
            || map.cos_incidence.is_some();
        let hits = said.face.is_some()
            || said.range.is_some()
            || said.depth.is_some()
            || said.point.is_some()
            || said.normal.is_some()
            || said.cos_incidence.is_some();
        said.hit = says.then_some(hits);
        said
    }

    /// How far the values are from those of an exact hit.
    pub(super) fn differences(
        &self,
        recorded: &Recorded,
        sensor: SensorId,
        exact: &Hit,
        bounds: &Bounds,
    ) -> Vec<Difference> {
        let mut found = Vec::with_capacity(5);
        let mut enter = |quantity: Quantity, said: &[f64], exact: &[f64], bound: f64| {
            let storage = recorded.storage_of(sensor, quantity.into());
            found.push(Difference::of(quantity.into(), storage, said, exact, bound));
        };
        if let Some(range) = self.range {
            enter(Quantity::Range, &[range], &[exact.range], bounds.range);
        }
        if let Some(depth) = self.depth {
            enter(Quantity::Depth, &[depth], &[exact.depth], bounds.range);
        }
        if let Some(point) = self.point {
            enter(Quantity::Point, &point.to_array(), &exact.point.to_array(), bounds.point);
        }
        if let Some(normal) = self.normal {
            enter(Quantity::Normal, &normal.to_array(), &exact.normal.to_array(), bounds.normal);
        }
        if let Some(cos_incidence) = self.cos_incidence {
            enter(Quantity::CosIncidence, &[cos_incidence], &[exact.cos_incidence], bounds.cos_incidence);
        }
        found
    }
}

/// What is said of what comes back of a pencil.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SaidBack {
    pub(super) visible: Option<bool>,
    /// `Some(None)`: it lands on no pixel.
    pub(super) pixel: Option<Option<Pixel>>,
    depth: Option<f64>,
    cos_off_axis: Option<f64>,
    cos_view: Option<f64>,
    /// By the scene's model, and by the other.
    pub(super) flux: [Option<f64>; 2],
}

impl SaidBack {
    pub(super) fn of(light: &BeamLight, i: u32, j: u32) -> Self {
        let returns = &light.returns;
        let flux = |image: &Option<Image<f64>>| image.as_ref().map(|image| image.at(i, j));
        Self {
            visible: returns.visible.as_ref().map(|image| image.at(i, j)),
            pixel: returns.pixel.as_ref().map(|image| image.at(i, j).get()),
            depth: at(&returns.depth, i, j),
            cos_off_axis: at(&returns.cos_off_axis, i, j),
            cos_view: at(&returns.cos_view, i, j),
            flux: [flux(&returns.flux), flux(&light.other_flux)],
        }
    }

    /// The values that a hit has, and whether they are said.
    pub(super) fn values(&self) -> [(Quantity, bool); 3] {
        [
            (Quantity::CameraDepth, self.depth.is_some()),
            (Quantity::CosOffAxis, self.cos_off_axis.is_some()),
            (Quantity::CosView, self.cos_view.is_some()),
        ]
    }

    /// Whether anything is said that tells which pixels the beam lights.
    pub(super) fn tells_light(light: &BeamLight) -> bool {
        light.returns.pixel.is_some() && (light.returns.flux.is_some() || light.other_flux.is_some())
    }

    /// How far the values are from the exact ones. `bounds`: by the scene's model, and by the other.
    pub(super) fn differences(
        &self,
        recorded: &Recorded,
        sensor: SensorId,
        exact: &RoundedReturn,
        model: FluxModel,
        bounds: [&ReturnBounds; 2],
    ) -> Vec<Difference> {
        let mut found = Vec::with_capacity(5);
        let values = exact.in_format(Format::Double, model);
        let mut enter = |item: Item, said: Option<f64>, exact: f64, bound: f64| {
            if let Some(said) = said {
                let storage = recorded.storage_of(sensor, item);
                let difference = Difference::of(item, storage, &[said], &[exact], bound);
                // No flux at all is exactly 0.
                let is_nothing = item.quantity == Quantity::PencilFlux && exact == 0.0;
                found.push(if is_nothing { Difference { bound: 0.0, ..difference } } else { difference });
            }
        };
        enter(Quantity::CameraDepth.into(), self.depth, values.depth, bounds[0].depth);
        enter(Quantity::CosOffAxis.into(), self.cos_off_axis, values.cos_off_axis, bounds[0].cos_off_axis);
        enter(Quantity::CosView.into(), self.cos_view, values.cos_view, bounds[0].cos_view);
        for (k, is_other_model) in [false, true].into_iter().enumerate() {
            let flux =
                exact.in_format(Format::Double, if is_other_model { model.other() } else { model }).flux;
            let bound = flux_bound(bounds[k], flux);
            let item = Item { is_other_model, ..Quantity::PencilFlux.into() };
            enter(item, self.flux[k], flux, bound);
        }
        found
    }
}

/// How far a flux may be off. Nothing is exactly 0.
pub(crate) fn flux_bound(bounds: &ReturnBounds, flux: f64) -> f64 {
    if flux == 0.0 { 0.0 } else { bounds.flux * flux + bounds.least_flux }
}

impl Recorded {
    /// How a quantity is stored, f64 if that is not said.
    pub(crate) fn storage_of(&self, sensor: SensorId, item: Item) -> Storage {
        self.storage.get(&(sensor, item)).copied().unwrap_or(Storage::F64)
    }
}
