//! Another program's arrays.

use std::path::Path;

use glam::DVec3;
use raypencil_files::{Fault, FileError, Limits, Numbers, Storage, read_npy_numbers};
use raypencil_rosbag::CloudChoice;
use raypencil_scene::{FaceId, Side};

use crate::cloud::CloudFrame;
use crate::comparison::{CastValue, Stated, StoredErrors};
use crate::pack::clouds::bag_within;
use crate::pack::unread::unread;

/// What a candidate declares of its point cloud.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct CloudConventions<'a> {
    /// The frame of its points.
    pub frame: CloudFrame,
    /// Which cloud of a bag it is.
    pub choice: CloudChoice<'a>,
}

/// What a candidate declares of its arrays.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct CandidateConventions<'a> {
    /// A number that means "no hit" in `face` where nothing else says that the ray hits (`hit`, a distance, or without distances a point), in `t` and `range`
    /// where neither a face nor, without faces, `hit` or the other distance says so, and in all other values of rays that miss; of a cloud in all three
    /// coordinates. Files of fewer digits hold it rounded. NaN and +Inf, and faces of -1 or 4294967295, always mean "no hit". -Inf in
    /// `t` and `range` says that what is hit is too near, unless it is this number.
    pub miss: Option<f64>,
    /// Leave out `face.npy`.
    pub ignores_faces: bool,
    /// Of a point cloud.
    pub cloud: CloudConventions<'a>,
}

impl CandidateConventions<'_> {
    /// Whether a number, which storing may have moved by `error`, is the one that means "no hit".
    pub(super) fn means_miss(&self, number: f64, error: f64) -> bool {
        self.miss.is_some_and(|miss| number == miss || (number - miss).abs() <= error)
    }
}

/// Reads what a folder has of `face.npy`, `t.npy`, `range.npy`, `hit.npy`, `side.npy`, `point.npy`, `normal.npy`, `barycentric.npy`
/// and `cos_incidence.npy`, in any type, of the rays' shape or flat.
///
/// # Errors
/// An array that cannot be read or has another shape; a folder that does not say which rays hit, or that is none.
pub fn read_candidate(
    folder: &Path,
    shape: &[u64],
    conventions: CandidateConventions<'_>,
) -> Result<Stated, FileError> {
    refuse_file(folder)?;
    let reader = Reader { folder, shape, count: shape.iter().product() };
    let vectors = |name: &str| -> Result<Stored<DVec3>, FileError> {
        let (numbers, errors, how) = reader.numbers(name, &[3])?;
        Ok((numbers.map(|numbers| numbers.chunks_exact(3).map(DVec3::from_slice).collect()), errors, how))
    };
    let ((t, of_t, t_how), (range, of_range, range_how)) =
        (reader.numbers("t", &[])?, reader.numbers("range", &[])?);
    let (point, of_point, point_how) = vectors("point")?;
    let (normal, of_normal, normal_how) = vectors("normal")?;
    let (barycentric, of_barycentric, barycentric_how) = vectors("barycentric")?;
    let (cos_incidence, of_cos_incidence, cos_incidence_how) = reader.numbers("cos_incidence", &[])?;
    let (sides, of_side, _) = reader.numbers("side", &[])?;
    let how = [
        (CastValue::T, t_how),
        (CastValue::Range, range_how),
        (CastValue::Point, point_how),
        (CastValue::Normal, normal_how),
        (CastValue::Barycentric, barycentric_how),
        (CastValue::CosIncidence, cos_incidence_how),
    ];
    let coarse = how.into_iter().filter_map(|(value, how)| Some((value, how?.coarse_words()?))).collect();
    let side = |(ray, number): (usize, &f64)| match *number {
        1.0 => Ok(Some(Side::Front)),
        -1.0 => Ok(Some(Side::Back)),
        number if number == 0.0 || number.is_nan() => Ok(None),
        number if conventions.means_miss(number, error_of(&of_side, ray)) => Ok(None),
        number => {
            let expected = "1 for a front, -1 for a back, 0 or NaN where nothing is hit";
            Err(reader.fault("side", format!("cell {ray}"), short(number), expected))
        }
    };
    let side = sides.as_ref().map(|numbers| numbers.iter().enumerate().map(side).collect()).transpose()?;
    let stored = StoredErrors {
        t: of_t,
        range: of_range,
        point: of_point,
        normal: of_normal,
        barycentric: of_barycentric,
        cos_incidence: of_cos_incidence,
        coarse,
    };
    let hit = reader.hits()?;
    let mut stated =
        Stated { face: None, t, range, hit, side, point, normal, barycentric, cos_incidence, stored };
    let means_miss = |number, error| conventions.means_miss(number, error);
    if !conventions.ignores_faces {
        stated.face = reader.faces(&stated, means_miss)?;
    }
    if stated.face.is_none() && stated.t.is_none() && stated.range.is_none() && stated.hit.is_none() {
        let expected =
            "face.npy, t.npy, range.npy or hit.npy; without one of them it is not said which rays hit";
        let found = match bag_within(folder) {
            Some(bag) => format!("none of them, but a bag: give {bag}"),
            None => match &unread(folder)[..] {
                [] => "none of them".to_string(),
                others => format!("none of them, but {}", others.join(", ")),
            },
        };
        let fault = Fault::new("folder", found, expected);
        return Err(FileError::Array(fault.in_file(folder)));
    }
    stated.without_distances(means_miss);
    stated.without_values(means_miss);
    // A side is a number of its own before it is one.
    for (ray, number) in sides.iter().flatten().enumerate() {
        if !stated.speaks(ray).1 && conventions.means_miss(*number, error_of(&of_side, ray)) {
            stated.side.iter_mut().for_each(|sides| sides[ray] = None);
        }
    }
    Ok(stated)
}

/// Refuses a file in place of a folder, and says what it is.
fn refuse_file(path: &Path) -> Result<(), FileError> {
    if std::fs::metadata(path).map_err(|error| FileError::io(path, "read", error))?.is_dir() {
        return Ok(());
    }
    let found = match path.extension().map(|ending| ending.to_string_lossy().to_lowercase()) {
        Some(ending) if ending == "npy" => "one array".to_string(),
        Some(ending) => format!("a file that ends in .{ending}"),
        None => "a file without an ending".to_string(),
    };
    let expected =
        "a folder with face.npy, t.npy, range.npy or hit.npy, or a point cloud: .pcd, .ply or .mcap";
    Err(FileError::Array(Fault::new("candidate", found, expected).in_file(path)))
}

/// A number in few letters.
fn short(number: f64) -> String {
    let size = number.abs();
    let is_plain = !size.is_finite() || size == 0.0 || (1e-5..1e15).contains(&size);
    if is_plain { number.to_string() } else { format!("{number:e}") }
}

/// Values, how far storing may have moved each of them, and the type in which they are stored.
type Stored<T> = (Option<Vec<T>>, Option<Vec<f64>>, Option<Storage>);

/// How far storing may have moved the value of a ray.
fn error_of(errors: &Option<Vec<f64>>, ray: usize) -> f64 {
    errors.as_ref().map_or(0.0, |errors| errors[ray])
}

/// How far storing may have moved the parts of each value: half a unit in the last place of the largest. `None`: numbers of double
/// precision and whole numbers are what was computed.
fn errors_of_storing(array: &Numbers, parts: usize) -> Option<Vec<f64>> {
    let half_unit = |value: &f64| if value.is_finite() { 0.5 * array.storage.ulp(*value) } else { 0.0 };
    match array.storage {
        Storage::F64 | Storage::Whole => None,
        _ => {
            let largest = |parts: &[f64]| parts.iter().map(half_unit).fold(0.0, f64::max);
            Some(array.values.chunks_exact(parts).map(largest).collect())
        }
    }
}

struct Reader<'a> {
    folder: &'a Path,
    shape: &'a [u64],
    count: u64,
}

impl Reader<'_> {
    /// The faces, where `means_miss` says that a number stands for no hit if nothing else says that the ray hits.
    fn faces(
        &self,
        beside: &Stated,
        means_miss: impl Fn(f64, f64) -> bool + Copy,
    ) -> Result<Option<Vec<Option<FaceId>>>, FileError> {
        // Single precision rounds 4294967295 to 4294967296, which is no face either.
        let none = [-1.0, f64::from(u32::MAX), f64::from(u32::MAX as f32)];
        let (numbers, errors, _) = self.numbers("face", &[])?;
        let face = |(ray, number): (usize, f64)| match number {
            number if !number.is_finite() || none.contains(&number) => Ok(None),
            number
                if means_miss(number, error_of(&errors, ray))
                    && !beside.hits_beside_face(ray, means_miss) =>
            {
                Ok(None)
            }
            // Half of the distance to the next number of the type: beyond it, neighbouring faces have the same number.
            number if error_of(&errors, ray) > 0.5 => {
                let expected =
                    "a number that its type tells from its neighbours: store faces as whole numbers";
                Err(self.fault("face", format!("cell {ray}"), number.to_string(), expected))
            }
            number if number.fract() == 0.0 && (0.0..f64::from(u32::MAX)).contains(&number) => {
                Ok(Some(FaceId(number as u32)))
            }
            number => {
                let expected = "0 or a larger whole number; -1 or 4294967295 for no hit";
                Err(self.fault("face", format!("cell {ray}"), number.to_string(), expected))
            }
        };
        numbers
            .map(|numbers| numbers.into_iter().enumerate().map(face).collect::<Result<Vec<_>, _>>())
            .transpose()
    }

    /// The truth values: which rays hit.
    fn hits(&self) -> Result<Option<Vec<bool>>, FileError> {
        let hit = |(ray, number): (usize, f64)| match number {
            1.0 => Ok(true),
            0.0 => Ok(false),
            _ => {
                let expected = "1 where the ray hits, 0 where it does not";
                Err(self.fault("hit", format!("cell {ray}"), number.to_string(), expected))
            }
        };
        let (numbers, ..) = self.numbers("hit", &[])?;
        numbers
            .map(|numbers| numbers.into_iter().enumerate().map(hit).collect::<Result<Vec<_>, _>>())
            .transpose()
    }

    fn fault(
        &self,
        name: &str,
        place: impl Into<String>,
        found: impl Into<String>,
        expected: impl Into<String>,
    ) -> FileError {
        let path = self.folder.join(format!("{name}.npy"));
        FileError::Array(Fault::new(place, found, expected).in_file(&path))
    }

    /// The numbers of an array, if the folder has it, whose shape is that of the rays and then `last`; beside them how far storing may
    /// have moved those of each ray, and their type.
    fn numbers(&self, name: &str, last: &[u64]) -> Result<Stored<f64>, FileError> {
        let path = self.folder.join(format!("{name}.npy"));
        // A link that leads nowhere is a fault, and no array that was left out.
        if path.symlink_metadata().is_err() {
            return Ok((None, None, None));
        }
        let array = read_npy_numbers(&path, &Limits::default())?;
        let of_rays: Vec<u64> = self.shape.iter().chain(last).copied().collect();
        let flat: Vec<u64> = [self.count].iter().chain(last).copied().collect();
        if array.shape != of_rays && array.shape != flat {
            let expected = format!("{of_rays:?}, or flat {flat:?}");
            return Err(self.fault(name, "shape", format!("{:?}", array.shape), expected));
        }
        let errors = errors_of_storing(&array, last.iter().product::<u64>() as usize);
        Ok((Some(array.values), errors, Some(array.storage)))
    }
}
