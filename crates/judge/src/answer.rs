//! What a side states of one ray's hit and of one pencil's return. A side is a renderer or a recording.

use raypencil_scene::{FaceId, HitQuantity, HitValue, Image, Maybe, Pixel, Returns, Sample, SensorMap};

fn at<T: Sample>(image: &Option<Image<Maybe<T>>>, i: u32, j: u32) -> Option<T> {
    image.as_ref().and_then(|image| image.at(i, j).get())
}

/// One ray's hit as a side states it. A value is `None` if its channel is absent or the ray misses.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StatedHit {
    /// Whether the map has any channel.
    has_channels: bool,
    /// Whether the map has a channel of faces.
    pub(crate) names_faces: bool,
    pub(crate) face: Option<FaceId>,
    /// In the order of [`HitQuantity::ALL`].
    values: [Option<HitValue>; HitQuantity::COUNT],
}

impl StatedHit {
    /// The answer to ray (i, j) of a map.
    pub(crate) fn of(map: &SensorMap, i: u32, j: u32) -> Self {
        let names_faces = map.face.is_some();
        let mut has_channels = names_faces;
        let values = HitQuantity::ALL.map(|quantity| {
            let raster = map.raster(quantity);
            has_channels |= raster.is_some();
            raster.and_then(|raster| raster.at(i, j))
        });
        Self { has_channels, names_faces, face: at(&map.face, i, j), values }
    }

    /// The value of a quantity.
    pub(crate) fn value(&self, quantity: HitQuantity) -> Option<HitValue> {
        self.values[quantity as usize]
    }

    /// The range, metres.
    pub(crate) fn range(&self) -> Option<f64> {
        self.value(HitQuantity::Range)?.scalar()
    }

    /// Whether a renderer's ray hits: by its range or its face.
    pub(crate) fn hits(&self) -> bool {
        self.range().is_some() || self.face.is_some()
    }

    /// Whether a recording's ray hits, by any of its values; `None` if the recording has no channel.
    pub(crate) fn hits_by_any_value(&self) -> Option<bool> {
        self.has_channels.then_some(self.face.is_some() || self.values.iter().any(Option::is_some))
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
