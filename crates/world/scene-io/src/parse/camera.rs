//! `[camera]`: its mount and its lens, and its image, in any of the ways in which people know size, pixels and focal length.

use serde::Deserialize;
use std::ops::{Range, RangeInclusive};
use std::path::Path;
use toml::Spanned;

use raypencil_files::{Sha256Digest, bytes, sha256};
use raypencil_scene::{Camera, Filter};

use crate::camera_info::{CameraInfo, MAX_CAMERA_INFO_BYTES, camera_info_from_text};
use crate::digest::NamedDigest;
use crate::parse::key::{Key, OneOrPair, span};
use crate::parse::rig::{MAX_RANGE_M, from_micrometres, from_millimetres, from_nanometres};
use crate::parse::source::Source;
use crate::plan::Mount;
use crate::scene_error::SceneIoError;

/// CHOICE: the effective index of common interference filters lies around 2.
const DEFAULT_FILTER_INDEX: f64 = 2.0;

/// Focal length, millimetres.
const FOCAL_MM: RangeInclusive<f64> = 0.01..=1e5;

/// Size of a pixel, micrometres.
const PITCH_UM: RangeInclusive<f64> = 0.01..=1e5;

/// Focal length in pixels.
const FOCAL_PX: RangeInclusive<f64> = 1e-3..=1e9;

/// Coordinate of the principal point, pixels.
const POINT_PX: RangeInclusive<f64> = -1e6..=1e6;

/// Field of view, from edge to edge of the image, degrees.
const VIEW_DEG: RangeInclusive<f64> = 0.001..=179.9;

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct CameraKeys {
    position_m: Key<Vec<f64>>,
    pitch_down_deg: Key<f64>,
    yaw_left_deg: Key<f64>,
    roll_right_deg: Key<f64>,
    width_px: Key<i64>,
    height_px: Key<i64>,
    pixel_pitch_um: Key<OneOrPair>,
    focal_length_mm: Key<f64>,
    principal_point_px: Key<Vec<f64>>,
    field_of_view_deg: Key<OneOrPair>,
    intrinsics_px: Key<IntrinsicsKeys>,
    camera_info: Key<String>,
    camera_info_rectified: Key<bool>,
    aperture_mm: Key<f64>,
    transmission: Key<f64>,
    filter: Key<FilterKeys>,
    max_range_m: Key<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FilterKeys {
    centre_nm: Spanned<f64>,
    width_nm: Spanned<f64>,
    index: Key<f64>,
}

/// fx, fy, cx and cy as OpenCV and ROS have them: the middle of pixel (0, 0) is at (0, 0).
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct IntrinsicsKeys {
    fx: Spanned<f64>,
    fy: Key<f64>,
    cx: Key<f64>,
    cy: Key<f64>,
}

/// A camera described in pixels, as read from the keys or from a calibration.
struct Intrinsics {
    /// fx and fy, pixels.
    focal_length: [f64; 2],
    /// cx and cy, pixels from the middle of pixel (0, 0); `None`: the middle of the image.
    principal_point: [Option<f64>; 2],
}

impl Source<'_> {
    /// The camera; the result is the digest of its calibration if the keys name one.
    pub(super) fn camera(
        &self,
        keys: &CameraKeys,
        (mount, camera): &mut (Mount, Camera),
    ) -> Result<Option<NamedDigest>, SceneIoError> {
        let turns = [&keys.pitch_down_deg, &keys.yaw_left_deg, &keys.roll_right_deg];
        self.mount("camera", &keys.position_m, turns, mount)?;
        let digest = self.image(keys, camera)?;
        self.converted(
            &keys.aperture_mm,
            "camera.aperture_mm",
            &mut camera.aperture,
            1e-3..=1e4,
            "millimetres",
            from_millimetres,
        )?;
        let transmission = &mut camera.lens.transmission;
        self.number(&keys.transmission, "camera.transmission", transmission, 0.0..=1.0, "")?;
        if let Some(filter) = &keys.filter {
            camera.lens.filter = self.filter(filter.get_ref())?;
        }
        self.number(&keys.max_range_m, "camera.max_range_m", &mut camera.max_range, MAX_RANGE_M, "metres")?;
        Ok(digest)
    }

    fn filter(&self, keys: &FilterKeys) -> Result<Filter, SceneIoError> {
        let metres = |key: &Spanned<f64>, name: &str, range: RangeInclusive<f64>| {
            self.check(*key.get_ref(), key.span(), name, range, "nanometres")?;
            Ok::<_, SceneIoError>(from_nanometres(*key.get_ref()))
        };
        let centre = metres(&keys.centre_nm, "camera.filter.centre_nm", 10.0..=1e6)?;
        let width = metres(&keys.width_nm, "camera.filter.width_nm", 1e-3..=1e6)?;
        let mut index = DEFAULT_FILTER_INDEX;
        self.number(&keys.index, "camera.filter.index", &mut index, 1.0..=10.0, "")?;
        Ok(Filter::Interference { centre, width, index })
    }

    /// Size, pixels, focal length and principal point of the camera; the digest of the calibration if the keys name one.
    fn image(&self, keys: &CameraKeys, camera: &mut Camera) -> Result<Option<NamedDigest>, SceneIoError> {
        self.one_description(keys)?;
        let calibration = match &keys.camera_info {
            Some(key) => Some(
                self.camera_info(key, keys.camera_info_rectified.as_ref().is_some_and(|key| *key.get_ref()))?,
            ),
            None => None,
        };
        let sides = match &calibration {
            Some((info, _)) => {
                info.size.map(|side| Some(Spanned::new(span(&keys.camera_info).unwrap_or(0..0), side)))
            }
            None => [keys.width_px.clone(), keys.height_px.clone()],
        };
        let names = ["width_px", "height_px"];
        self.cells(
            "camera",
            [(names[0], &sides[0]), (names[1], &sides[1])],
            [&mut camera.width, &mut camera.height],
            "pixels",
        )?;
        if let Some(pitch) = &keys.pixel_pitch_um {
            for value in pitch.get_ref().pair() {
                self.check(value, pitch.span(), "camera.pixel_pitch_um", PITCH_UM, "micrometres")?;
            }
            camera.pixel_pitch = pitch.get_ref().pair().map(from_micrometres);
        }
        let focal = &mut camera.focal_length;
        self.converted(
            &keys.focal_length_mm,
            "camera.focal_length_mm",
            focal,
            FOCAL_MM,
            "millimetres",
            from_millimetres,
        )?;
        // The middle of the image, whatever its size.
        camera.principal_point = [camera.width, camera.height].map(|side| 0.5 * f64::from(side));
        if let Some(point) = &keys.principal_point_px {
            let numbers = self.list(point, "camera.principal_point_px", &[2], POINT_PX, "pixels")?;
            camera.principal_point = [numbers[0], numbers[1]];
        }
        if let Some(key) = &keys.field_of_view_deg {
            self.field_of_view(key, camera)?;
        }
        if let Some(key) = &keys.intrinsics_px {
            let IntrinsicsKeys { fx, fy, cx, cy } = key.get_ref();
            let focal_x = *fx.get_ref();
            self.check(focal_x, fx.span(), "camera.intrinsics_px.fx", FOCAL_PX, "pixels")?;
            let focal_y =
                self.optional(fy, "camera.intrinsics_px.fy", FOCAL_PX, "pixels")?.unwrap_or(focal_x);
            let principal_point = [
                self.optional(cx, "camera.intrinsics_px.cx", POINT_PX, "pixels")?,
                self.optional(cy, "camera.intrinsics_px.cy", POINT_PX, "pixels")?,
            ];
            let intrinsics = Intrinsics { focal_length: [focal_x, focal_y], principal_point };
            self.intrinsics(&intrinsics, "camera.intrinsics_px", key.span(), camera)?;
        }
        let (Some((info, digest)), Some(key)) = (calibration, &keys.camera_info) else { return Ok(None) };
        for (name, values, range) in
            [("fx and fy", info.focal_length, FOCAL_PX), ("cx and cy", info.principal_point, POINT_PX)]
        {
            for value in values {
                self.check(
                    value,
                    key.span(),
                    &format!("camera.camera_info: {name}"),
                    range.clone(),
                    "pixels",
                )?;
            }
        }
        let CameraInfo { focal_length, principal_point, .. } = info;
        let intrinsics = Intrinsics { focal_length, principal_point: principal_point.map(Some) };
        self.intrinsics(&intrinsics, "camera.camera_info", key.span(), camera)?;
        Ok(Some((key.get_ref().clone(), digest)))
    }

    /// Refuses two descriptions of one image, of which one would be lost.
    fn one_description(&self, keys: &CameraKeys) -> Result<(), SceneIoError> {
        let width = ("width_px", span(&keys.width_px));
        let height = ("height_px", span(&keys.height_px));
        let point = ("principal_point_px", span(&keys.principal_point_px));
        let focal = ("focal_length_mm", span(&keys.focal_length_mm));
        let view = ("field_of_view_deg", span(&keys.field_of_view_deg));
        let intrinsics = ("intrinsics_px", span(&keys.intrinsics_px));
        let calibration = ("camera_info", span(&keys.camera_info));
        let pitches = keys.pixel_pitch_um.as_ref().filter(|pitch| pitch.get_ref().y.is_some());
        let two_pitches = ("pixel_pitch_um = [x, y]", pitches.map(Spanned::span));
        let has_two_angles = keys.field_of_view_deg.as_ref().is_some_and(|view| view.get_ref().y.is_some());
        let rules = [
            (&calibration, vec![&focal, &view, &intrinsics, &width, &height, &point, &two_pitches]),
            (&intrinsics, vec![&focal, &view, &point, &two_pitches]),
            (&view, vec![&focal, &point]),
            (&view, if has_two_angles { vec![&two_pitches] } else { vec![] }),
        ];
        for ((name, given), others) in rules {
            if given.is_none() {
                continue;
            }
            if let Some((other, Some(place))) = others.into_iter().find(|(_, place)| place.is_some()) {
                let message = format!(
                    "`camera.{other}` is given beside `camera.{name}`, which says it already; expected one of them"
                );
                return Err(self.error(place.clone(), message));
            }
        }
        match (&keys.camera_info_rectified, &keys.camera_info) {
            (Some(key), None) => {
                let message =
                    "`camera.camera_info_rectified` is given; expected it only beside `camera_info`";
                Err(self.error(key.span(), message))
            }
            _ => Ok(()),
        }
    }

    /// Focal length from a field of view: `f = (w p_x / 2) / tan(across / 2)`, and with a second angle
    /// `p_y = (2 f / h) tan(down / 2)`. The principal point is the middle of the image.
    fn field_of_view(&self, key: &Spanned<OneOrPair>, camera: &mut Camera) -> Result<(), SceneIoError> {
        let OneOrPair { x: across, y: down } = *key.get_ref();
        let name = "camera.field_of_view_deg";
        for angle in [Some(across), down].into_iter().flatten() {
            self.check(angle, key.span(), name, VIEW_DEG, "degrees")?;
        }
        let half_tangent = |degrees: f64| libm::tan(0.5 * degrees.to_radians());
        camera.focal_length = 0.5 * f64::from(camera.width) * camera.pixel_pitch[0] / half_tangent(across);
        if let Some(down) = down {
            camera.pixel_pitch[1] = 2.0 * camera.focal_length * half_tangent(down) / f64::from(camera.height);
        }
        self.lengths(name, key.span(), camera)
    }

    /// Focal length, the height of a pixel and the principal point from numbers in pixels. The width of a pixel stays:
    /// `f = fx p_x`, `p_y = f / fy`. The principal point moves by half a pixel, to count from the corner of pixel (0, 0).
    fn intrinsics(
        &self,
        intrinsics: &Intrinsics,
        name: &str,
        place: Range<usize>,
        camera: &mut Camera,
    ) -> Result<(), SceneIoError> {
        let [fx, fy] = intrinsics.focal_length;
        camera.focal_length = fx * camera.pixel_pitch[0];
        // A quotient of a product would round twice, and square pixels would not be square.
        camera.pixel_pitch[1] = if fx == fy { camera.pixel_pitch[0] } else { camera.focal_length / fy };
        for (slot, point) in camera.principal_point.iter_mut().zip(intrinsics.principal_point) {
            if let Some(point) = point {
                *slot = point + 0.5;
            }
        }
        self.lengths(name, place, camera)
    }

    /// Checks what a description in angles or pixels came to in metres.
    fn lengths(&self, name: &str, place: Range<usize>, camera: &Camera) -> Result<(), SceneIoError> {
        let refuse = |what: &str, value: f64, range: RangeInclusive<f64>, unit: &str| {
            let message = format!(
                "`{name}` gives a {what} of {value} {unit} with pixels {} um wide; expected {} to {}: another \
                 `pixel_pitch_um`, perhaps",
                camera.pixel_pitch[0] * 1e6,
                range.start(),
                range.end()
            );
            Err(self.error(place.clone(), message))
        };
        let focal_mm = camera.focal_length * 1e3;
        if !FOCAL_MM.contains(&focal_mm) {
            return refuse("focal length", focal_mm, FOCAL_MM, "mm");
        }
        let pitch_um = camera.pixel_pitch[1] * 1e6;
        if !PITCH_UM.contains(&pitch_um) {
            return refuse("height of a pixel", pitch_um, PITCH_UM, "um");
        }
        Ok(())
    }

    /// The calibration that the key `camera_info` names, and the digest of its file.
    fn camera_info(
        &self,
        key: &Spanned<String>,
        is_rectified: bool,
    ) -> Result<(CameraInfo, Sha256Digest), SceneIoError> {
        let file = self.file.parent().unwrap_or(Path::new("")).join(key.get_ref());
        if !file.is_file() {
            let message = format!(
                "`camera.camera_info`: there is no file \"{}\"; expected a calibration of ROS as YAML, its path relative to \
                 the scene file",
                file.display()
            );
            return Err(self.error(key.span(), message));
        }
        let refused = |error| SceneIoError::io(&file, "read", error);
        let bytes = bytes::read_file(&file, MAX_CAMERA_INFO_BYTES).map_err(refused)?;
        let digest = sha256(&bytes);
        let text = String::from_utf8(bytes).map_err(|error| {
            refused(std::io::Error::new(std::io::ErrorKind::InvalidData, error.utf8_error()))
        })?;
        Ok((camera_info_from_text(&text, &file, is_rectified)?, digest))
    }
}
