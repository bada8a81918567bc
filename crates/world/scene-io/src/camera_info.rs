//! Calibrations of cameras as ROS has them: the file that calibrators write, and the message `sensor_msgs/CameraInfo` as
//! `ros2 topic echo` or `rostopic echo` prints it. Both are YAML.
//!
//! Source: ROS `sensor_msgs/CameraInfo` and `camera_calibration_parsers`. The matrix is K = (fx, 0, cx; 0, fy, cy; 0, 0, 1) and
//! the projection P = (fx', 0, cx', Tx; 0, fy', cy', Ty; 0, 0, 1, 0), in pixels; the middle of pixel (0, 0) is at (0, 0).

use serde::Deserialize;
use serde::de::{Deserializer, Error, IgnoredAny, MapAccess, SeqAccess, Visitor};
use serde_saphyr::{Location, Spanned};
use std::ops::Range;
use std::path::Path;

use crate::parse::source::Source;
use crate::scene_error::SceneIoError;

/// Maximum size of such a file, bytes: 1 MiB. A calibration has less than 2 kB; a recorded topic has many of them.
pub(crate) const MAX_CAMERA_INFO_BYTES: u64 = 1 << 20;

/// Most numbers that a calibration lists in one place: the fourteen coefficients of the longest model of distortion.
const MAX_NUMBERS: usize = 64;

/// Models of distortion that are a pinhole where their coefficients are zero; an empty name stands for none. Zeros of others, such
/// as `equidistant`, are a fisheye: r = f theta. (ROS `sensor_msgs/distortion_models`)
const PINHOLES: [&str; 3] = ["", "plumb_bob", "rational_polynomial"];

/// Numbers of a camera without distortion, as ROS has them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraInfo {
    /// Columns and rows of the image.
    pub size: [i64; 2],
    /// fx and fy, pixels.
    pub focal_length: [f64; 2],
    /// cx and cy, pixels from the *middle* of pixel (0, 0).
    pub principal_point: [f64; 2],
}

#[derive(Deserialize)]
struct InfoKeys {
    #[serde(alias = "width")]
    image_width: Spanned<i64>,
    #[serde(alias = "height")]
    image_height: Spanned<i64>,
    #[serde(alias = "k", alias = "K")]
    camera_matrix: Spanned<Numbers>,
    #[serde(default)]
    distortion_model: Option<Spanned<String>>,
    #[serde(default, alias = "d", alias = "D")]
    distortion_coefficients: Option<Spanned<Numbers>>,
    #[serde(default, alias = "r", alias = "R")]
    rectification_matrix: Option<Spanned<Numbers>>,
    #[serde(default, alias = "p", alias = "P")]
    projection_matrix: Option<Spanned<Numbers>>,
    #[serde(default)]
    binning_x: Option<Spanned<i64>>,
    #[serde(default)]
    binning_y: Option<Spanned<i64>>,
    #[serde(default)]
    roi: Option<Spanned<RegionKeys>>,
}

/// The part of the image that the camera sends. All zeros: the whole image.
#[derive(Deserialize)]
struct RegionKeys {
    #[serde(default)]
    x_offset: i64,
    #[serde(default)]
    y_offset: i64,
    #[serde(default)]
    width: i64,
    #[serde(default)]
    height: i64,
}

impl RegionKeys {
    /// Offsets in x and y, width and height, pixels.
    fn part(&self) -> [i64; 4] {
        [self.x_offset, self.y_offset, self.width, self.height]
    }
}

/// A list of numbers: alone, as messages have it, or as `data` of a matrix, as files have it.
#[derive(Clone, PartialEq)]
struct Numbers {
    data: Vec<f64>,
    /// `rows` and `cols` beside the data.
    stated: [Option<i64>; 2],
}

impl<'de> Deserialize<'de> for Numbers {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ListOrMatrix;
        impl<'de> Visitor<'de> for ListOrMatrix {
            type Value = Numbers;

            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("a list of numbers, or a matrix with `data`")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Numbers, A::Error> {
                let mut numbers = Vec::new();
                while let Some(number) = list.next_element()? {
                    if numbers.len() == MAX_NUMBERS {
                        return Err(A::Error::custom(format!(
                            "more than {MAX_NUMBERS} numbers; expected those of a matrix of a camera"
                        )));
                    }
                    numbers.push(number);
                }
                Ok(Numbers { data: numbers, stated: [None; 2] })
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Numbers, A::Error> {
                let (mut numbers, mut stated) = (None, [None; 2]);
                while let Some(key) = map.next_key::<String>()? {
                    match key.as_str() {
                        "data" => numbers = Some(map.next_value::<Numbers>()?.data),
                        "rows" => stated[0] = Some(map.next_value()?),
                        "cols" => stated[1] = Some(map.next_value()?),
                        _ => {
                            map.next_value::<IgnoredAny>()?;
                        }
                    }
                }
                let data = numbers.ok_or_else(|| A::Error::missing_field("data"))?;
                Ok(Numbers { data, stated })
            }
        }
        deserializer.deserialize_any(ListOrMatrix)
    }
}

/// Reads the text of a calibration of ROS, a file of YAML or a message; `file` is its name in errors. `is_rectified`: that of
/// the camera's rectified images, which have no distortion, by the projection P; else that of its own images, by the matrix K.
///
/// # Errors
/// Names the file, the line and what was expected: a file that is none, a camera that is not calibrated, one with skew or
/// distortion or a model that is no pinhole at zeros, and one that sends a part of its image or merges its pixels.
///
/// ```
/// use raypencil_scene_io::camera_info_from_text;
///
/// let text = "width: 640\nheight: 480\nk: [600, 0, 319.5, 0, 600, 239.5, 0, 0, 1]\n";
/// let info = camera_info_from_text(text, "left.yaml".as_ref(), false)?;
/// // The middle of pixel (0, 0) is at (0, 0), so that this is the middle of 640 columns.
/// assert_eq!((info.size, info.principal_point), ([640, 480], [319.5, 239.5]));
/// # Ok::<(), raypencil_scene_io::SceneIoError>(())
/// ```
pub fn camera_info_from_text(
    text: &str,
    file: &Path,
    is_rectified: bool,
) -> Result<CameraInfo, SceneIoError> {
    let source = &Source::unchanged(file, text);
    let messages: Vec<InfoKeys> = serde_saphyr::from_multiple(source.text).map_err(|error| {
        let place = error.location().map_or(0..0, |location| span(source, &location));
        // The place stands before the message already.
        let words = error.without_snippet().to_string();
        let words = words.rsplit_once(" at line ").map_or(words.as_str(), |(words, _)| words);
        let words = words
            .replace("invalid floating point", "this is no number")
            .replace("invalid integer", "this is no whole number")
            .replace("missing field", "there is no")
            .replace("duplicate field ", "expected once, but found again: ")
            .replace("duplicate mapping key: ", "expected once, but found again: ")
            // What a program may set that uses the library.
            .replace(", set DuplicateKeyPolicy in Options if acceptable", "");
        source.error(place, format!("no calibration of a camera in YAML: {words}"))
    })?;
    let Some((keys, others)) = messages.split_first() else {
        return Err(source.error(0..0, "the file is empty; expected a calibration of a camera in YAML"));
    };
    // Of a recorded topic every message says the same, if the camera was not changed while it ran.
    if let Some(other) = others.iter().find(|other| other.without_places() != keys.without_places()) {
        let place = span(source, &other.camera_matrix.referenced);
        return Err(source.error(place, "another camera than that of the first message; expected one camera"));
    }
    keys.checked(source, is_rectified)
}

impl InfoKeys {
    /// All that it says, wherever that stands.
    fn without_places(&self) -> impl PartialEq {
        let numbers = |keys: &Option<Spanned<Numbers>>| keys.as_ref().map(|keys| keys.value.clone());
        let count = |key: &Option<Spanned<i64>>| key.as_ref().map(|key| key.value);
        let roi = self.roi.as_ref().map(|roi| roi.value.part());
        (
            [self.image_width.value, self.image_height.value],
            self.camera_matrix.value.clone(),
            self.distortion_model.as_ref().map(|model| model.value.clone()),
            numbers(&self.distortion_coefficients),
            [numbers(&self.rectification_matrix), numbers(&self.projection_matrix)],
            [count(&self.binning_x), count(&self.binning_y)],
            roi,
        )
    }

    fn checked(&self, source: &Source, is_rectified: bool) -> Result<CameraInfo, SceneIoError> {
        let size = [self.image_width.value, self.image_height.value];
        for binning in [&self.binning_x, &self.binning_y].into_iter().flatten() {
            if !(0..=1).contains(&binning.value) {
                let message = format!("the camera merges {} pixels into one; expected 0 or 1", binning.value);
                return Err(source.error(span(source, &binning.referenced), message));
            }
        }
        if let Some(roi) = &self.roi {
            let part = roi.value.part();
            if part != [0; 4] && part != [0, 0, size[0], size[1]] {
                let message = format!(
                    "the camera sends a part of the image, `roi` {part:?}; expected the whole image, zeros"
                );
                return Err(source.error(span(source, &roi.referenced), message));
            }
        }
        self.check_shapes(source)?;
        let (numbers, name, place) = match (is_rectified, &self.projection_matrix) {
            (false, _) => (
                matrix(source, &self.camera_matrix, "camera matrix K", [3, 3])?,
                "camera matrix K",
                &self.camera_matrix.referenced,
            ),
            (true, Some(projection)) => {
                let rows = matrix(source, projection, "projection P", [3, 4])?;
                // Tx and Ty move a second camera beside the first; here the camera's position says where it is.
                let last = projection.value.data[11];
                if last != 0.0 {
                    let message = format!("the last number of the projection P is {last}; expected 0");
                    return Err(source.error(span(source, &projection.referenced), message));
                }
                (rows, "projection P", &projection.referenced)
            }
            (true, None) => {
                let message = "there is no `projection_matrix` (P); expected one, for the rectified images are those of P";
                return Err(source.error(span(source, &self.camera_matrix.referenced), message));
            }
        };
        let refuse = |message: String| source.error(span(source, place), message);
        let [[fx, skew, cx], [lower, fy, cy], bottom] = numbers;
        if fx == 0.0 && fy == 0.0 {
            return Err(refuse(format!(
                "the {name} is zero: the camera is not calibrated; expected fx and fy"
            )));
        }
        if skew != 0.0 || lower != 0.0 || bottom != [0.0, 0.0, 1.0] {
            return Err(refuse(format!(
                "the {name} is {numbers:?}; expected [fx, 0, cx], [0, fy, cy], [0, 0, 1]: a camera without skew"
            )));
        }
        if !is_rectified {
            self.check_pinhole(source)?;
        }
        Ok(CameraInfo { size, focal_length: [fx, fy], principal_point: [cx, cy] })
    }

    /// The camera's own images have no distortion: a model whose zeros are a pinhole, and zeros.
    fn check_pinhole(&self, source: &Source) -> Result<(), SceneIoError> {
        let model = self.distortion_model.as_ref();
        if let Some(model) = model.filter(|model| !PINHOLES.contains(&model.value.as_str())) {
            let message = format!(
                "the model of distortion is {:?}; expected plumb_bob or rational_polynomial, which are a pinhole where their \
                 coefficients are zero, or `camera_info_rectified = true` for the camera's rectified images",
                model.value
            );
            return Err(source.error(span(source, &model.referenced), message));
        }
        let Some(coefficients) = &self.distortion_coefficients else { return Ok(()) };
        let values = &coefficients.value.data;
        // Negative zero is zero; NaN is not.
        if values.iter().any(|&value| value != 0.0) {
            let message = format!(
                "the images are distorted, {} {values:?}; expected zeros, for distortion is not modelled, or \
                 `camera_info_rectified = true` for the camera's rectified images",
                model.map_or("", |model| &model.value)
            );
            return Err(source.error(span(source, &coefficients.referenced), message));
        }
        Ok(())
    }

    /// What `rows` and `cols` say of a list, where they stand beside it, is true of it.
    fn check_shapes(&self, source: &Source) -> Result<(), SceneIoError> {
        let matrices = [
            (Some(&self.camera_matrix), "camera matrix K", [3, 3]),
            (self.rectification_matrix.as_ref(), "rectification R", [3, 3]),
            (self.projection_matrix.as_ref(), "projection P", [3, 4]),
        ];
        let refuse = |numbers: &Spanned<Numbers>, name: &str, expected: String| {
            let Numbers { data, stated } = &numbers.value;
            let [rows, cols] = stated.map(|length| length.map_or("?".into(), |length| length.to_string()));
            let message =
                format!("the {name} says {rows} x {cols} and has {} numbers; {expected}", data.len());
            source.error(span(source, &numbers.referenced), message)
        };
        for (numbers, name, expected) in matrices {
            let Some(numbers) = numbers else { continue };
            let Numbers { data, stated } = &numbers.value;
            let is_stated = *stated != [None; 2];
            let is_as_expected =
                stated.iter().zip(expected).all(|(one, length)| one.is_none_or(|one| one == length));
            if is_stated && !(is_as_expected && data.len() as i64 == expected[0] * expected[1]) {
                return Err(refuse(
                    numbers,
                    name,
                    format!("expected {} rows of {}", expected[0], expected[1]),
                ));
            }
        }
        let Some(coefficients) = &self.distortion_coefficients else { return Ok(()) };
        let Numbers { data, stated } = &coefficients.value;
        let [Some(rows), Some(cols)] = *stated else { return Ok(()) };
        if rows.checked_mul(cols) != Some(data.len() as i64) {
            return Err(refuse(coefficients, "list of coefficients", "expected as many as it says".into()));
        }
        Ok(())
    }
}

/// The first three columns of a matrix that is listed row by row.
fn matrix(
    source: &Source,
    numbers: &Spanned<Numbers>,
    name: &str,
    [rows, columns]: [usize; 2],
) -> Result<[[f64; 3]; 3], SceneIoError> {
    let values = &numbers.value.data;
    if values.len() != rows * columns {
        let message = format!("the {name} has {} numbers; expected {rows} rows of {columns}", values.len());
        return Err(source.error(span(source, &numbers.referenced), message));
    }
    Ok([0, 1, 2].map(|row| [0, 1, 2].map(|column| values[row * columns + column])))
}

/// Bytes of the text at a place, for which the reader counts characters.
fn span(source: &Source, location: &Location) -> Range<usize> {
    let characters = location.span().offset() as usize;
    let start = source.text.char_indices().nth(characters).map_or(source.text.len(), |(at, _)| at);
    let end = source.text[start..].chars().next().map_or(start, |first| start + first.len_utf8());
    start..end
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str, is_rectified: bool) -> Result<CameraInfo, String> {
        camera_info_from_text(text, Path::new("left.yaml"), is_rectified).map_err(|error| error.to_string())
    }

    /// The file of a calibrator.
    const FILE: &str = "image_width: 640\nimage_height: 480\ncamera_name: left\n\
        camera_matrix:\n  rows: 3\n  cols: 3\n  data: [600, 0, 319.5, 0, 610.5, 239.5, 0, 0, 1]\n\
        distortion_model: plumb_bob\n\
        distortion_coefficients:\n  rows: 1\n  cols: 5\n  data: [-0.25, 0.0625, 0, 0, 0]\n\
        rectification_matrix:\n  rows: 3\n  cols: 3\n  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]\n\
        projection_matrix:\n  rows: 3\n  cols: 4\n  data: [580, 0, 320, -58, 0, 590, 240, 0, 0, 0, 1, 0]\n";

    /// The message, as it is printed.
    const MESSAGE: &str = "header:\n  stamp:\n    sec: 12\n    nanosec: 5\n  frame_id: left\nheight: 480\nwidth: 640\n\
        distortion_model: plumb_bob\nd:\n- 0.0\n- 0.0\n- 0.0\n- 0.0\n- 0.0\nk:\n- 600.0\n- 0.0\n- 319.5\n- 0.0\n- 610.5\n\
        - 239.5\n- 0.0\n- 0.0\n- 1.0\nr: [1, 0, 0, 0, 1, 0, 0, 0, 1]\np: [580, 0, 320, -58, 0, 590, 240, 0, 0, 0, 1, 0]\n\
        binning_x: 0\nbinning_y: 0\nroi:\n  x_offset: 0\n  y_offset: 0\n  height: 0\n  width: 0\n  do_rectify: false\n---\n";

    #[test]
    fn file_and_message_say_the_same() {
        let own =
            CameraInfo { size: [640, 480], focal_length: [600.0, 610.5], principal_point: [319.5, 239.5] };
        let rectified =
            CameraInfo { size: [640, 480], focal_length: [580.0, 590.0], principal_point: [320.0, 240.0] };
        assert_eq!(read(MESSAGE, false), Ok(own));
        assert_eq!(read(MESSAGE, true), Ok(rectified));
        assert_eq!(read(FILE, true), Ok(rectified));
        assert_eq!(read(&FILE.replace("[-0.25, 0.0625, 0, 0, 0]", "[0, -0.0, 0, 0, 0]"), false), Ok(own));
        // ROS 1 writes the matrices in capitals; a recorded topic has the message many times.
        let ros1 = MESSAGE.replace("\nd:", "\nD:").replace("\nk:", "\nK:").replace("\np:", "\nP:");
        assert_eq!(read(&ros1.repeat(3), false), Ok(own));
    }

    #[test]
    fn what_is_no_pinhole_of_the_whole_image_is_refused_with_its_line() {
        let message = |from: &str, to: &str| {
            assert!(MESSAGE.contains(from), "{from}");
            read(&MESSAGE.replace(from, to), false).unwrap_err()
        };
        for (error, words) in [
            (
                read(FILE, false).unwrap_err(),
                "left.yaml:10:3: the images are distorted, plumb_bob [-0.25, 0.0625, ",
            ),
            (
                message("- 0.0\n- 319.5", "- 0.5\n- 319.5"),
                "expected [fx, 0, cx], [0, fy, cy], [0, 0, 1]: a camera without skew",
            ),
            (
                message("- 600.0\n- 0.0\n- 319.5\n- 0.0\n- 610.5", "- 0.0\n- 0.0\n- 319.5\n- 0.0\n- 0.0"),
                "the camera is not calibrated",
            ),
            (message("- 600.0\n", ""), "the camera matrix K has 8 numbers; expected 3 rows of 3"),
            (message("binning_x: 0", "binning_x: 2"), "the camera merges 2 pixels into one; expected 0 or 1"),
            (
                message("x_offset: 0", "x_offset: 8"),
                "left.yaml:30:3: the camera sends a part of the image, `roi` [8, 0, 0, 0]",
            ),
            (
                message("- 600.0\n", "- north\n"),
                "left.yaml:16:3: no calibration of a camera in YAML: this is no number",
            ),
            (
                message("width: 640\n", "width: 640\nimage_width: 320\n"),
                "no calibration of a camera in YAML: expected once, but found again: `image_width`",
            ),
            (
                message("width: 640\n", "width: 640\nwidth: 320\n"),
                "no calibration of a camera in YAML: expected once, but found again: width",
            ),
            (message("width: 640\n", ""), "no calibration of a camera in YAML: there is no `image_width`"),
            (message("- 1.0\nr:", "- 2.0\nr:"), "a camera without skew"),
            (read("", false).unwrap_err(), "the file is empty"),
            (read("k: [", false).unwrap_err(), "no calibration of a camera in YAML"),
            (
                read(&format!("{MESSAGE}{}", MESSAGE.replace("319.5", "320.5")), false).unwrap_err(),
                "another camera than that of the first message",
            ),
            (
                read(&FILE.replace("projection_matrix", "p_matrix"), true).unwrap_err(),
                "there is no `projection_matrix` (P)",
            ),
            (
                read(&FILE.replace("0, 0, 1, 0]", "0, 0, 1, -0.5]"), true).unwrap_err(),
                "left.yaml:18:3: the last number of the projection P is -0.5; expected 0",
            ),
            (
                read(&MESSAGE.replace("d:\n- 0.0", &format!("d:\n{}", "- 0.0\n".repeat(64))), false)
                    .unwrap_err(),
                "more than 64 numbers",
            ),
        ] {
            assert!(error.contains(words), "{error} has no {words:?}");
        }
    }

    /// Parts that name others, ten times each on ten floors: a small file that would become 10^10 numbers.
    #[test]
    fn a_file_that_repeats_itself_takes_no_more_than_it_may() {
        let mut bomb = String::from("a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n");
        for floor in 1..10 {
            let names = format!("*a{}, ", floor - 1).repeat(10);
            bomb += &format!("a{floor}: &a{floor} [{names}]\n");
        }
        let error = read(&(bomb + MESSAGE), false).unwrap_err();
        assert!(error.contains("no calibration of a camera in YAML: "), "{error}");
    }
}
