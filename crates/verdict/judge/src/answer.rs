//! What a side states of one ray's hit and of one pencil's return. A side is a renderer or a recording.

use raypencil_scene::{FaceId, HitQuantity, HitValue, Image, Maybe, Pixel, Returns, Sample, SensorMap};

fn at<T: Sample>(image: &Option<Image<Maybe<T>>>, i: u32, j: u32) -> Option<T> {
    image.as_ref().and_then(|image| image.at(i, j).get())
}

/// One ray's hit as a side states it. A value is `None` if its channel is absent or the ray misses.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StatedHit<'m> {
    map: &'m SensorMap,
    i: u32,
    j: u32,
    pub(crate) face: Option<FaceId>,
    /// Distance along the ray, metres.
    pub(crate) range: Option<f64>,
}

impl<'m> StatedHit<'m> {
    /// The answer to ray (i, j) of a map.
    pub(crate) fn of(map: &'m SensorMap, i: u32, j: u32) -> Self {
        Self { map, i, j, face: at(&map.face, i, j), range: at(&map.range, i, j) }
    }

    pub(crate) fn value(&self, quantity: HitQuantity) -> Option<HitValue> {
        self.map.raster(quantity)?.at(self.i, self.j)
    }

    /// Whether the map has a channel of faces.
    pub(crate) fn names_faces(&self) -> bool {
        self.map.face.is_some()
    }

    /// Whether a renderer's ray hits: by its range or its face.
    pub(crate) fn hits(&self) -> bool {
        self.range.is_some() || self.face.is_some()
    }

    /// Whether a recording's ray hits, by any of its values; `None` if the recording has no channel.
    pub(crate) fn hits_by_any_value(&self) -> Option<bool> {
        let has_channels =
            self.names_faces() || HitQuantity::ALL.into_iter().any(|one| self.map.raster(one).is_some());
        let hits =
            || self.face.is_some() || HitQuantity::ALL.into_iter().any(|one| self.value(one).is_some());
        has_channels.then(hits)
    }
}

/// One pencil's return to the camera as a side states it. A value is `None` if its channel is absent, or if the
/// pencil has none.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StatedReturn {
    pub(crate) visible: Option<bool>,
    /// `Some(None)`: the hit lands on no pixel.
    pub(crate) pixel: Option<Option<Pixel>>,
    pub(crate) depth: Option<f64>,
    pub(crate) cos_off_axis: Option<f64>,
    pub(crate) cos_view: Option<f64>,
    /// Flux by the scene's model and by the other, watts (`eq1`: W/m).
    pub(crate) flux: [Option<f64>; 2],
}

impl StatedReturn {
    /// The answer to pencil (i, j) of a beam. `other_flux`: the beam's flux by the model that is not the scene's.
    pub(crate) fn of(returns: &Returns, other_flux: Option<&Image<f64>>, i: u32, j: u32) -> Self {
        Self {
            visible: returns.visible.as_ref().map(|image| image.at(i, j)),
            pixel: returns.pixel.as_ref().map(|image| image.at(i, j).get()),
            depth: at(&returns.depth, i, j),
            cos_off_axis: at(&returns.cos_off_axis, i, j),
            cos_view: at(&returns.cos_view, i, j),
            flux: [returns.flux.as_ref(), other_flux].map(|image| image.map(|image| image.at(i, j))),
        }
    }
}
