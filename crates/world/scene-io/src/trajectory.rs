//! Poses with their times from files of other programs: the format of the TUM RGB-D benchmark, CSV, and bags of ROS 2.

use std::fs::File;
use std::io::{BufReader, Read};
use std::ops::RangeInclusive;
use std::path::Path;

use glam::{DQuat, DVec3};
use raypencil_files::{Fault, FileError, Sha256Digest, bytes, file_sha256, heading_in_comment, sha256};
use raypencil_rosbag::{BagPose, PoseChoice, read_poses};
use raypencil_scene::Pose;
use raypencil_scene::pattern::TimedPose;

/// Maximum size of a file of poses: 256 MiB, some three million poses.
pub const MAX_TRAJECTORY_BYTES: u64 = 1 << 28;

/// Times of poses, seconds. Nanoseconds since 1970 are beyond it.
pub(crate) const TIME_S: RangeInclusive<f64> = -1e12..=1e12;

/// Coordinates of positions, metres.
const POSITION_M: RangeInclusive<f64> = -1e12..=1e12;

/// Deviation of a quaternion's length from 1 that rounding may leave: each of its four numbers, rounded to three decimals, is
/// off by up to 0.0005, and their vector by up to twice as much.
const MAX_LENGTH_ERROR: f64 = 1e-3;

/// The order of the numbers in a row.
const ORDER: &str = "timestamp tx ty tz qx qy qz qw: seconds, metres, a unit quaternion with its scalar last";

/// Reads the poses of a file: a row of eight numbers for each, `timestamp tx ty tz qx qy qz qw`, with blanks (TUM) or commas (CSV)
/// between them. Empty lines and lines that begin with `#` are passed over; a line of eight names before the first row must name
/// this order.
///
/// A pose is that of the moving frame in the fixed one: (tx, ty, tz) is its origin in metres, and the quaternion turns its axes
/// into those of the fixed frame. Quaternions stay as they are written.
///
/// ```
/// use raypencil_scene_io::poses_from_text;
///
/// let text = "# timestamp tx ty tz qx qy qz qw\n0.5 1 2 3 0 0 0 1\n0.6 1.5 2 3 0 0 0.7071 0.7071\n";
/// let poses = poses_from_text(text, "walk.tum".as_ref())?;
/// assert_eq!((poses.len(), poses[1].time_s, poses[1].pose.position.x), (2, 0.6, 1.5));
/// # Ok::<(), raypencil_files::FileError>(())
/// ```
///
/// # Errors
/// Names the line: not eight numbers, one that is not finite or out of its range, a quaternion that is no unit beyond rounding, a
/// time that is not later than that before it, columns in another order. A file without a pose.
pub fn poses_from_text(text: &str, file: &Path) -> Result<Vec<TimedPose>, FileError> {
    read(text).map_err(|fault| FileError::Array(fault.in_file(file)))
}

/// Reads the poses of a bag of ROS 2, the bytes of an MCAP file: those of `nav_msgs/Odometry`, `geometry_msgs/PoseStamped` or
/// `tf2_msgs/TFMessage`, of one topic and one pair of frames. Their times are those of the stamps.
///
/// # Errors
/// Names the message: as for [`poses_from_text`]. What is no MCAP file, or has no such messages or several series of them.
pub fn poses_from_bag(
    bytes: &[u8],
    choice: &PoseChoice<'_>,
    file: &Path,
) -> Result<Vec<TimedPose>, FileError> {
    of_bag(bytes, bytes.len() as u64, choice).map_err(|fault| FileError::Array(fault.in_file(file)))
}

fn of_bag(stream: impl Read, length: u64, choice: &PoseChoice<'_>) -> Result<Vec<TimedPose>, Fault> {
    let found = read_poses(stream, length, choice)?;
    let mut poses: Vec<TimedPose> = Vec::with_capacity(found.poses.len());
    for BagPose { message, time_s, position: [x, y, z], rotation: [qx, qy, qz, qw] } in found.poses {
        let row = [time_s, x, y, z, qx, qy, qz, qw];
        let refused =
            |(was, expected)| Fault::new(format!("message {message} of {}", found.topic), was, expected);
        poses.push(checked(row, poses.last()).map_err(refused)?);
    }
    Ok(poses)
}

/// Whether a file of poses is a bag, by its ending.
pub(crate) fn is_bag(file: &Path) -> bool {
    file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("mcap"))
}

/// Reads a file of poses, and its digest. A bag is read piece by piece, and may have any size.
pub(crate) fn read_trajectory(
    file: &Path,
    choice: &PoseChoice<'_>,
) -> Result<(Vec<TimedPose>, Sha256Digest), FileError> {
    if is_bag(file) {
        let failed = |error| FileError::io(file, "read", error);
        let stream = File::open(file).map_err(failed)?;
        let length = stream.metadata().map_err(failed)?.len();
        let poses = of_bag(BufReader::new(stream), length, choice);
        let poses = poses.map_err(|fault| FileError::Array(fault.in_file(file)))?;
        let (_, digest) = file_sha256(file).map_err(failed)?;
        return Ok((poses, digest));
    }
    let bytes =
        bytes::read_file(file, MAX_TRAJECTORY_BYTES).map_err(|error| FileError::io(file, "read", error))?;
    let text = std::str::from_utf8(&bytes).map_err(|error| {
        let place = format!("byte {}", error.valid_up_to());
        FileError::Array(Fault::new(place, "bytes that are no text", ORDER).in_file(file))
    })?;
    let poses = poses_from_text(text, file)?;
    Ok((poses, sha256(&bytes)))
}

fn read(text: &str) -> Result<Vec<TimedPose>, Fault> {
    let mut poses: Vec<TimedPose> = Vec::new();
    for (number, line) in (1..).zip(text.trim_start_matches('\u{feff}').lines()) {
        let comment = line.trim_start().strip_prefix('#');
        // In a comment a unit may stand behind a blank.
        let is_known = |name: &str| (0..8).any(|column| is_name(column, name));
        let in_comment = comment.and_then(|comment| heading_in_comment(comment, 8..=8, is_known));
        let fields: Vec<&str> = match &in_comment {
            Some(words) => words.iter().map(String::as_str).collect(),
            None => fields(comment.unwrap_or(line)),
        };
        let refuse =
            |found: String, expected: String| Err(Fault::new(format!("line {number}"), found, expected));
        let is_heading = fields.len() == 8 && fields.iter().all(|field| field.parse::<f64>().is_err());
        // Between rows stands the heading of a file that was joined to another; a remark of eight words may stand there as well.
        let is_part = |name: &&&str| (4..8).any(|column| is_name(column, name));
        let names_quaternion = || fields.iter().filter(is_part).count() >= 4;
        if is_heading && (poses.is_empty() || (comment.is_some() && names_quaternion())) {
            // Also behind a `#`: other formats have the scalar first, or nanoseconds, and say so there.
            if !fields.iter().enumerate().all(|(column, name)| is_name(column, name)) {
                return refuse(fields.join(" "), format!("columns in the order {ORDER}"));
            }
            continue;
        }
        if let Some(comment) = comment {
            if let Some(found) = other_order(comment) {
                return refuse(found, format!("columns in the order {ORDER}"));
            }
            continue;
        }
        if line.trim().is_empty() {
            continue;
        }
        if fields.len() != 8 {
            return refuse(format!("{} fields", fields.len()), format!("8: {ORDER}"));
        }
        let mut row = [0.0; 8];
        for (column, (field, number)) in fields.iter().zip(&mut row).enumerate() {
            *number = match field.parse::<f64>() {
                Ok(number) if number.is_finite() => number,
                _ => return refuse(format!("field {}: {field:?}", column + 1), "a finite number".into()),
            };
        }
        match checked(row, poses.last()) {
            Ok(pose) => poses.push(pose),
            Err((found, expected)) => return refuse(found, expected),
        }
    }
    if poses.is_empty() {
        return Err(Fault::new("file", "no pose", format!("rows of {ORDER}")));
    }
    Ok(poses)
}

/// What a comment that is no heading of eight names says of columns in another order, or of times in another unit: all four parts of the
/// quaternion stand in it, the scalar first, or beside nanoseconds.
fn other_order(comment: &str) -> Option<String> {
    let words: Vec<String> = comment
        .split(|c: char| !(c.is_alphanumeric() || c == '_'))
        .filter(|word| !word.is_empty())
        .map(str::to_lowercase)
        .collect();
    let place = |part: &str| {
        let names = [format!("q{part}"), format!("q_{part}")];
        words.iter().position(|word| names.contains(word))
    };
    let [x, y, z, w] = ["x", "y", "z", "w"].map(place);
    let (Some(x), Some(y), Some(z), Some(w)) = (x, y, z, w) else { return None };
    let is_in_order = x < y && y < z && z < w;
    let has_other_unit = words.iter().any(|word| {
        ["ns", "ms", "us", "nanoseconds", "milliseconds", "microseconds"].contains(&word.as_str())
    });
    (!is_in_order || has_other_unit).then(|| comment.trim().to_string())
}

/// A pose of eight numbers after the pose `before`; what is wrong with it, and what is expected.
fn checked(row: [f64; 8], before: Option<&TimedPose>) -> Result<TimedPose, (String, String)> {
    let [time_s, x, y, z, qx, qy, qz, qw] = row;
    if !TIME_S.contains(&time_s) {
        return Err((format!("a time of {time_s}"), format!("-1e12 to 1e12 seconds, as {ORDER}")));
    }
    if let Some(before) = before.filter(|before| time_s <= before.time_s) {
        let expected = format!("more than {} seconds, the time before it", before.time_s);
        return Err((format!("a time of {time_s}"), expected));
    }
    if let Some(far) = [x, y, z].into_iter().find(|coordinate| !POSITION_M.contains(coordinate)) {
        return Err((format!("a coordinate of {far}"), "-1e12 to 1e12 metres".into()));
    }
    let rotation = DQuat::from_xyzw(qx, qy, qz, qw);
    let length = rotation.length();
    if !((length - 1.0).abs() <= MAX_LENGTH_ERROR) {
        let found = format!("a quaternion of length {length}");
        return Err((found, format!("1 to within {MAX_LENGTH_ERROR}, which rounding leaves: {ORDER}")));
    }
    Ok(TimedPose { time_s, pose: Pose { position: DVec3::new(x, y, z), rotation } })
}

/// The fields of a row: between commas, if there is one, else between blanks.
fn fields(row: &str) -> Vec<&str> {
    match row.contains(',') {
        true => row.split(',').map(str::trim).collect(),
        false => row.split_whitespace().collect(),
    }
}

/// Whether a name stands for a column: any name for a time in seconds, and names that end in the right letters.
fn is_name(column: usize, name: &str) -> bool {
    // A unit behind the name: `x_m`, `p_x [m]`, `time_s`.
    let name = name.to_lowercase();
    let (name, unit) = match name.split_once(['[', '(']) {
        Some((name, unit)) => (name.trim(), unit.trim_end_matches([']', ')'])),
        None => name
            .rsplit_once('_')
            .filter(|(_, unit)| matches!(*unit, "s" | "m" | "ns" | "ms" | "us" | "mm"))
            .unwrap_or((&name, "")),
    };
    match column {
        0 => name.starts_with('t') && matches!(unit, "" | "s" | "sec"),
        1..=3 => {
            name.ends_with(["x", "y", "z"][column - 1]) && !name.starts_with('q') && matches!(unit, "" | "m")
        }
        _ => name.ends_with(["x", "y", "z", "w"][column - 4]) && name.starts_with(['q', 'o', 'r']),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refusal(text: &str) -> String {
        poses_from_text(text, Path::new("p.tum")).expect_err(text).to_string()
    }

    const ROW: &str = "1 2 3 4 0 0 0 1\n";

    #[test]
    fn headings_between_rows_must_name_it_too() {
        let joined = |heading: &str| {
            format!("# timestamp tx ty tz qx qy qz qw\n{ROW}{heading}\n{}", ROW.replacen('1', "2", 1))
        };
        for heading in [
            "# timestamp tx ty tz qx qy qz qw",
            "#t x y z qx qy qz qw",
            "# we stop here to wait for the rover",
        ] {
            let poses = poses_from_text(&joined(heading), Path::new("p")).expect(heading);
            assert_eq!(poses.len(), 2, "{heading}");
        }
        for heading in [
            "# timestamp tx ty tz qw qx qy qz",
            "#timestamp [ns] x y z qx qy qz qw",
            "# qx qy qz qw x y z t",
            "# t [s], x [m], y [m], z [m], qw, qx, qy, qz",
        ] {
            let message = refusal(&joined(heading));
            assert!(
                message.contains("line 3") && message.contains("columns in the order timestamp"),
                "{message}"
            );
        }
    }

    #[test]
    fn headings_must_name_the_order() {
        for heading in [
            "# timestamp tx ty tz qx qy qz qw",
            "time_s,x_m,y_m,z_m,qx,qy,qz,qw",
            "\u{feff}t,p_x [m],p_y [m],p_z [m],q_x [],q_y [],q_z [],q_w []",
            "# ground truth trajectory",
            "#timestamp [s],x,y,z,ox,oy,oz,ow",
            "# t [s] x [m] y [m] z [m] qx qy qz qw",
            "# columns: timestamp tx ty tz qx qy qz qw",
        ] {
            let rows =
                format!("{heading}\n\n{}", ROW.replace(' ', if heading.contains(',') { "," } else { "\t" }));
            assert_eq!(
                poses_from_text(&rows, Path::new("p")).map(|poses| poses.len()).unwrap_or(0),
                1,
                "{heading}"
            );
        }
        for heading in [
            "# timestamp tx ty tz qw qx qy qz",
            "#timestamp [ns],p_x,p_y,p_z,q_x,q_y,q_z,q_w",
            "# timestamp [ns] x y z qx qy qz qw",
            "# columns: timestamp tx ty tz qw qx qy qz",
            "# time in nanoseconds, position, and the quaternion as q_x q_y q_z q_w",
            "# time in microseconds, position, and the quaternion as q_x q_y q_z q_w",
            "time_s,x_mm,y_mm,z_mm,qx,qy,qz,qw",
            "time,qx,qy,qz,qw,x,y,z",
        ] {
            let message = refusal(&format!("{heading}\n{ROW}"));
            assert!(
                message.contains("line 1: ") && message.contains("columns in the order timestamp"),
                "{message}"
            );
        }
    }

    #[test]
    fn wrong_rows_are_told_with_their_line() {
        for (rows, words) in [
            ("1 2 3 4 0 0 0", "line 2: 7 fields; expected 8: timestamp tx ty tz qx qy qz qw"),
            ("1 2 3 4 0 0 0 1 5", "line 2: 9 fields"),
            ("1 2 x 4 0 0 0 1", "line 2: field 3: \"x\"; expected a finite number"),
            ("1 2 3 nan 0 0 0 1", "line 2: field 4: \"nan\""),
            ("0 2 3 4 0 0 0 1", "line 2: a time of 0; expected more than 0 seconds, the time before it"),
            ("1403636579758555392 2 3 4 0 0 0 1", "expected -1e12 to 1e12 seconds"),
            ("1 2 3 1e13 0 0 0 1", "a coordinate of 10000000000000"),
            (
                "1 2 3 4 0 0 0.5 0.5",
                "line 2: a quaternion of length 0.7071067811865476; expected 1 to within 0.001",
            ),
            ("1 2 3 4 0 0 0 1.0011", "a quaternion of length 1.0011"),
            ("1 2 3 4 0 0 0 0", "a quaternion of length 0"),
        ] {
            let message = refusal(&format!("0 0 0 0 0 0 0 1\n{rows}\n"));
            assert!(message.contains(words), "{message}");
        }
        assert!(refusal("# nothing\n").contains("file: no pose; expected rows of timestamp"));
        // Rounded to three decimals: 0.707^2 + 0.707^2 = 0.99970.
        assert!(poses_from_text("0 0 0 0 0 0 0.707 0.707", Path::new("p")).is_ok());
    }
}
