use glam::DVec3;

use raypencil_scene::{FaceId, Image, Maybe, Pixel, Returns, SensorMap};

/// What one side says comes back of a pencil.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Back {
    pub(crate) visible: Option<bool>,
    /// `Some(None)`: it lands on no pixel.
    pub(crate) pixel: Option<Option<Pixel>>,
    pub(crate) depth: Option<f64>,
    pub(crate) cos_off_axis: Option<f64>,
    pub(crate) cos_view: Option<f64>,
    pub(crate) flux: Option<f64>,
}

impl Back {
    pub(crate) fn of(returns: &Returns, i: u32, j: u32) -> Self {
        Self {
            visible: returns.visible.as_ref().map(|image| image.at(i, j)),
            pixel: returns.pixel.as_ref().map(|image| image.at(i, j).get()),
            depth: returns.depth.as_ref().and_then(|image| image.at(i, j).get()),
            cos_off_axis: returns.cos_off_axis.as_ref().and_then(|image| image.at(i, j).get()),
            cos_view: returns.cos_view.as_ref().and_then(|image| image.at(i, j).get()),
            flux: returns.flux.as_ref().map(|image| image.at(i, j)),
        }
    }
}

/// What one side says of one ray.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Answer {
    pub(super) hit: bool,
    pub(super) range: Option<f64>,
    pub(crate) depth: Option<f64>,
    pub(super) face: Option<FaceId>,
    pub(super) point: Option<DVec3>,
    pub(crate) normal: Option<DVec3>,
    pub(super) cos_incidence: Option<f64>,
}

impl Answer {
    pub(crate) fn of(map: &SensorMap, i: u32, j: u32) -> Self {
        fn at<T: raypencil_scene::Sample>(image: &Option<Image<Maybe<T>>>, i: u32, j: u32) -> Option<T> {
            image.as_ref().and_then(|image| image.at(i, j).get())
        }
        let (range, face) = (at(&map.range, i, j), at(&map.face, i, j));
        Self {
            hit: range.is_some() || face.is_some(),
            range,
            depth: at(&map.depth, i, j),
            face,
            point: at(&map.point, i, j),
            normal: at(&map.normal, i, j),
            cos_incidence: at(&map.cos_incidence, i, j),
        }
    }
}
