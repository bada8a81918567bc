//! The mistakes in words.

use std::fmt;

use crate::mistake::{
    AngleUnit, Cosine, CutBy, FrameAxes, Held, Leg, Length, LengthUnit, Mistake, Turn, Vectors,
};

/// The mistake as a clause that follows "if", and the rule that it breaks.
impl fmt::Display for Mistake {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::RowsReversed => f.write_str("rows are reversed: row 0 is the top row"),
            Self::ColumnsReversed => f.write_str("columns are reversed: column 0 is the left column"),
            Self::Transposed => f.write_str("cells are stored column by column: arrays are (rows, columns)"),
            Self::Shifted { columns, rows } => {
                let by = |count: i32, way: [&str; 2], one: &str| {
                    let plural = if count.abs() == 1 { "" } else { "s" };
                    format!("{} {one}{plural} {}", count.abs(), way[usize::from(count > 0)])
                };
                let (across, down) = (by(*columns, ["left", "right"], "column"), by(*rows, ["up", "down"], "row"));
                let moved = match (columns, rows) {
                    (_, 0) => across,
                    (0, _) => down,
                    _ => format!("{across} and {down}"),
                };
                write!(f, "cells are shifted by {moved}: cell (i, j) holds the ray of column i, row j")
            }
            Self::MissWritten(value) => write!(
                f,
                "{value} means \"no hit\": a length is +Inf there, other numbers are NaN (or declare --miss {value})"
            ),
            Self::MissAtMaximumRange => {
                f.write_str("the maximum range means \"no hit\": a length is +Inf there, other numbers are NaN")
            }
            Self::FacesShifted(by) => {
                write!(f, "face indices are {} too {}: the first face is 0", by.abs(), match by {
                    1.. => "large",
                    _ => "small",
                })
            }
            Self::FacesReordered => f.write_str(
                "faces are numbered in an order of their own: face.I counts the faces of terrain.glb in their order",
            ),
            Self::DepthForRange => {
                f.write_str("range.T holds the depth: range is the distance along the ray")
            }
            Self::ParameterForRange => {
                f.write_str("range.T holds t: the range is t |q|, since the direction q is no unit vector")
            }
            Self::RangeForDepth => {
                f.write_str("depth.Z holds the range: depth is the distance along the sensor's normal axis")
            }
            Self::ParameterForDepth => {
                f.write_str("depth.Z holds t: the depth is t f_c (camera) or t g (beam)")
            }
            Self::Unit(unit) => {
                let name = match unit {
                    LengthUnit::Millimetres => "millimetres",
                    LengthUnit::Centimetres => "centimetres",
                    LengthUnit::Kilometres => "kilometres",
                    LengthUnit::Feet => "feet",
                };
                write!(f, "lengths are in {name}: the unit is the metre")
            }
            Self::AxesYUp => f.write_str(
                "the axes are glTF's (y up): the scene is z up, (x, y, z) = (gx, -gz, gy)",
            ),
            Self::AxesYUpInverse => f.write_str(
                "the axes are (x, -z, y): the change from glTF's y up was made twice",
            ),
            Self::Axes { of, from, sign } => {
                write!(f, "{} are in other axes: the scene's (x, y, z) is their (", vectors(*of))?;
                for k in 0..3 {
                    let comma = if k == 0 { "" } else { ", " };
                    let minus = if sign[k] < 0 { "-" } else { "" };
                    write!(f, "{comma}{minus}{}", ["x", "y", "z"][from[k].min(2)])?;
                }
                f.write_str(")")
            }
            Self::SensorFrame { of, axes } => {
                let axes = match axes {
                    FrameAxes::Optical => "",
                    FrameAxes::OpenGl => ", in OpenGL's axes (x right, y up, z back)",
                    FrameAxes::Body => ", in the axes x ahead, y left, z up",
                };
                write!(f, "{} are in the sensor's frame{axes}: they belong in the scene frame", vectors(*of))
            }
            Self::PointsRounded(quantum) => {
                write!(f, "the components of points are rounded to multiples of {}", metres(*quantum))
            }
            Self::DistanceForView => {
                f.write_str("view.Z holds the distance from the camera: it is the depth along the camera's axis")
            }
            Self::PointsFromSensor => {
                f.write_str("points are counted from the sensor: they are counted from the scene's origin")
            }
            Self::PointsMoved(by) => {
                write!(f, "points are off by {} m: they are counted from the scene's origin", three(*by))
            }
            Self::GlobalFrame => {
                f.write_str("points are in the global frame: the scene frame starts at the scene origin")
            }
            Self::Inverse(of) => {
                let (subject, verb) = subject(*of);
                write!(f, "{subject} {verb} 1 over the true length")
            }
            Self::Squared(of) => {
                let (subject, verb) = subject(*of);
                write!(f, "{subject} {verb} the square of the true length")
            }
            Self::ZBuffer { low, low_at, one_at } => {
                let at = |depth: f64| if depth.is_finite() { metres(depth) } else { "infinity".to_string() };
                write!(
                    f,
                    "depth.Z holds numbers of a z-buffer, {low} at {} and 1 at {}: depth is in metres",
                    at(*low_at),
                    at(*one_at)
                )
            }
            Self::HoldsBeam(beam) => write!(f, "the rays are those of beam-{beam}: beams are in the scene's order"),
            Self::BeamFluxExchanged => {
                f.write_str("flux.beam0 and flux.beam1 are exchanged: beams are in the scene's order")
            }
            Self::VisibleReversed => {
                f.write_str("visible.V is 0 where it should be 1, and 1 where it should be 0: 1 means that the camera sees the hit")
            }
            Self::NoShadowTest => f.write_str(
                "no face hides a hit from the camera: what lies between them hides it (a shadow test is missing)",
            ),
            Self::HitsVisible => {
                f.write_str("every hit is called visible: a hit may be hidden, turned away, or beside the image")
            }
            Self::FluxOfWrongPencils => {
                f.write_str("the pencils of the beams were right: the flux is the sum of what they state")
            }
            Self::NormalsReversed => f.write_str("normals point inward: a normal points to the outside"),
            Self::NormalsNotUnit => f.write_str("normals are not unit vectors: a normal has the length 1"),
            Self::CosinesNegated => f.write_str(
                "cosines have the wrong sign: the ray is reversed before its angle with the normal is taken",
            ),
            Self::AngleForCosine(unit) => {
                let name = match unit {
                    AngleUnit::Radians => "radians",
                    AngleUnit::Degrees => "degrees",
                };
                write!(f, "angles in {name} stand in place of their cosines: incidence.V and its like are cosines")
            }
            Self::CosinesExchanged(held) => {
                let mut parts = Vec::new();
                for (own, held) in Cosine::ALL.into_iter().zip(held) {
                    if own != *held {
                        parts.push(format!("{} holds {}", own.channel(), held.angle()));
                    }
                }
                write!(f, "{}: the angles are exchanged", parts.join(", "))
            }
            Self::PixelRowsFromBottom => {
                f.write_str("pixel.J counts rows from the bottom: row 0 is the top row")
            }
            Self::PixelColumnsFromRight => {
                f.write_str("pixel.I counts columns from the right: column 0 is the left column")
            }
            Self::PixelsExchanged => {
                f.write_str("pixel.I and pixel.J are exchanged: pixel.I is the column")
            }
            Self::OtherFluxModel => {
                f.write_str("the flux is that of the other model: flux.V and flux.beamN follow the scene's model")
            }
            Self::AttenuationOn(Leg::Out) => f.write_str(
                "the air attenuates the light on its way out alone: it also attenuates on the way to the camera",
            ),
            Self::AttenuationOn(Leg::Back) => f.write_str(
                "the air attenuates the light on its way to the camera alone: it also attenuates on the way out",
            ),
            Self::AttenuationOn(Leg::Neither) => {
                f.write_str("the air does not attenuate the light: the scene has an attenuation")
            }
            Self::FluxFactor(factor) => {
                write!(f, "the flux is {} times the true one: a constant factor is wrong", short(*factor))
            }
            Self::SinglePrecision => {
                f.write_str("the arithmetic is of single precision: declare --arithmetic f32")
            }
            Self::BacksHit => f.write_str("rays hit the backs of faces: a hit has n.q < 0"),
            Self::NearPlaneIgnored => {
                f.write_str("rays hit faces before the sensor's plane: a hit has t >= 1")
            }
            Self::MaximumRangeIgnored => {
                f.write_str("rays hit faces beyond the maximum range: such a ray hits nothing")
            }
            Self::MaximumRangeAsDepth => {
                f.write_str("the maximum range limits the depth: it limits the range, along the ray")
            }
            Self::NearLimit(t) => write!(f, "a hit needs t >= {}: a hit has t >= 1", short(*t)),
            Self::EdgesOpen => {
                f.write_str("rays that meet an edge exactly pass it: a face's edges belong to the face")
            }
            Self::CornerRays { columns, rows } if columns.abs() == 0.5 && rows.abs() == 0.5 => {
                let side = if *columns < 0.0 { "left" } else { "right" };
                let end = if *rows < 0.0 { "top" } else { "bottom" };
                write!(f, "rays go through the {end} {side} corner of their cell: a ray goes through the middle")
            }
            Self::CornerRays { columns, rows } => {
                let across = part(*columns, "columns", ["left", "right"]);
                let down = part(*rows, "rows", ["up", "down"]);
                let both: Vec<String> = [across, down].into_iter().flatten().collect();
                write!(f, "rays are {} off: a ray goes through the middle of its cell", both.join(" and "))
            }
            Self::Affine { of, factor: 1.0, offset } => {
                let way = if *offset > 0.0 { "long" } else { "short" };
                let (subject, verb) = subject(*of);
                write!(f, "{subject} {verb} {} too {way}", metres(offset.abs()))
            }
            Self::Affine { of, factor, offset } => {
                let (subject, verb) = subject(*of);
                write!(f, "{subject} {verb} {} times the true length", short(*factor))?;
                match offset {
                    0.0 => Ok(()),
                    more if *more > 0.0 => write!(f, " plus {}", metres(*more)),
                    less => write!(f, " less {}", metres(-*less)),
                }
            }
            Self::FromPlane(of) => {
                let (subject, verb) = subject(*of);
                let verb = if verb == "is" { "begins" } else { "begin" };
                write!(f, "{subject} {verb} at the sensor's plane: lengths begin at the ray's origin")
            }
            Self::Rounded { of, quantum, down } => {
                let (subject, verb) = subject(*of);
                let down = if *down { " down" } else { "" };
                write!(f, "{subject} {verb} rounded{down} to multiples of {}", metres(*quantum))
            }
            Self::HalfPrecision(of) => {
                let (subject, verb) = subject(*of);
                write!(f, "{subject} {verb} rounded to half precision, 11 bits: single precision has 24")
            }
            Self::Cut { by, is_above, at, lines, held } => cut(f, *by, *is_above, *at, *lines, *held),
            Self::PrincipalPoint { stated, truth } => {
                let one = |name: &str, k: usize| {
                    (stated[k] != truth[k])
                        .then(|| format!("{name} is {} in place of {} px", short(stated[k]), short(truth[k])))
                };
                let both: Vec<String> = [one("cx", 0), one("cy", 1)].into_iter().flatten().collect();
                f.write_str(&both.join(" and "))
            }
            Self::FocalLength { stated, truth } => write!(
                f,
                "the focal length is {} in place of {} mm",
                short(1e3 * stated),
                short(1e3 * truth)
            ),
            Self::PixelPitch { stated, truth } => {
                let microns = |pitch: &[f64; 2]| pitch.map(|one| short(1e6 * one)).join(" x ");
                write!(f, "the pixel pitch is {} in place of {} micrometres", microns(stated), microns(truth))
            }
            Self::Thickness { stated, truth } => write!(
                f,
                "the beam's thickness is {} in place of {} mm",
                short(1e3 * stated),
                short(1e3 * truth)
            ),
            Self::PoseInverted => {
                f.write_str("the sensor's pose is inverted: it takes points of the sensor's frame to the scene's")
            }
            Self::QuaternionOrder => {
                f.write_str("the sensor's rotation is read as (w, x, y, z): its four numbers are (x, y, z, w)")
            }
            Self::Fan { stated, truth } => {
                write!(f, "the fan is {} in place of {} degrees", short(*stated), short(*truth))
            }
            Self::Turned { about, degrees } => {
                let by = short(degrees.abs());
                match about {
                    Turn::Pitch if *degrees > 0.0 => write!(f, "the sensor looks {by} degrees too far down"),
                    Turn::Pitch => write!(f, "the sensor looks {by} degrees too far up"),
                    Turn::Yaw if *degrees > 0.0 => write!(f, "the sensor looks {by} degrees too far to the right"),
                    Turn::Yaw => write!(f, "the sensor looks {by} degrees too far to the left"),
                    Turn::Roll if *degrees > 0.0 => write!(f, "the sensor is rolled {by} degrees clockwise"),
                    Turn::Roll => write!(f, "the sensor is rolled {by} degrees counter-clockwise"),
                }
            }
            Self::Moved(by) => write!(f, "the sensor stands {} m too far in x, y, z of the scene", three(*by)),
            Self::Posed { degrees, metres } if *metres == [0.0; 3] => {
                write!(f, "the sensor is turned by {} degrees about its x, y, z axes", three(*degrees))
            }
            Self::Posed { degrees, metres } => write!(
                f,
                "the sensor is turned by {} degrees about its x, y, z axes and stands {} m too far in x, y, z of the scene",
                three(*degrees),
                three(*metres)
            ),
        }
    }
}

/// A number with at most fifteen significant digits: one fewer than a double keeps, so that a change of its unit does not show.
/// A number that was found has few digits already. With fewer than these, 1.0000000000001 would read as 1.
fn short(number: f64) -> String {
    let rounded: f64 = format!("{number:.14e}").parse().unwrap_or(number);
    format!("{rounded}")
}

/// A number of a file, as people write it: one that single precision holds has no more digits than that.
fn constant(number: f64) -> String {
    let single = number as f32;
    if f64::from(single) == number { single.to_string() } else { short(number) }
}

fn metres(number: f64) -> String {
    format!("{} m", short(number))
}

fn three(numbers: [f64; 3]) -> String {
    format!("({})", numbers.map(short).join(", "))
}

/// An offset in words; `None` if there is none.
fn part(offset: f64, unit: &str, [less, more]: [&str; 2]) -> Option<String> {
    (offset != 0.0)
        .then(|| format!("{} {unit} {}", short(offset.abs()), if offset < 0.0 { less } else { more }))
}

fn vectors(of: Vectors) -> &'static str {
    match of {
        Vectors::Points => "points",
        Vectors::Normals => "normals",
        Vectors::Both => "points and normals",
    }
}

/// A length and its verb.
fn subject(of: Length) -> (&'static str, &'static str) {
    match of {
        Length::Range => ("range.T", "is"),
        Length::Depth => ("depth.Z", "is"),
        Length::All => ("lengths", "are"),
    }
}

/// What is lost beyond a number.
fn cut(
    f: &mut fmt::Formatter<'_>,
    by: CutBy,
    is_above: bool,
    at: f64,
    lines: u32,
    held: Held,
) -> fmt::Result {
    let line = match by {
        CutBy::Row => Some("row"),
        CutBy::Column => Some("column"),
        CutBy::Range | CutBy::Depth | CutBy::RangeOrDepth => None,
    };
    if let Some(line) = line {
        let end = if is_above { "last" } else { "first" };
        let (what, verb) = match lines {
            1 => (format!("the {end} {line}"), ["says", "holds", "repeats", "is"]),
            many => (format!("the {end} {many} {line}s"), ["say", "hold", "repeat", "are"]),
        };
        return match held {
            Held::NoHit => write!(f, "{what} {} \"no hit\" where something is hit", verb[0]),
            Held::Constant(number) => write!(f, "{what} {} {} everywhere", verb[1], constant(number)),
            Held::Neighbour => write!(f, "{what} {} the {line} beside", verb[2]),
            Held::Anything => write!(f, "{what} {} wrong, and nothing else", verb[3]),
        };
    }
    let beyond = match (by, is_above) {
        (CutBy::Depth, true) => "deeper than",
        (CutBy::Depth, false) => "less deep than",
        (_, true) => "beyond",
        (_, false) => "nearer than",
    };
    match held {
        Held::Constant(number) => {
            write!(f, "hits {beyond} {} have the length {} m", metres(at), constant(number))
        }
        _ if by == CutBy::RangeOrDepth => {
            write!(f, "hits {beyond} a range of {}, or a depth that goes with it, are lost", metres(at))
        }
        _ => write!(f, "hits {beyond} {} are lost", metres(at)),
    }
}
