//! The mistakes in words.

use std::fmt;

use crate::mistake::{AngleUnit, Cosine, Leg, LengthUnit, Mistake};

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
                "points and normals are in glTF's axes (y up): the scene is z up, (x, y, z) = (gx, -gz, gy)",
            ),
            Self::AxesYUpInverse => f.write_str(
                "points and normals are in the axes (x, -z, y): the change from glTF's y up was made twice",
            ),
            Self::Axes { from, sign } => {
                f.write_str("points and normals are in other axes: the scene's (x, y, z) is their (")?;
                for k in 0..3 {
                    let comma = if k == 0 { "" } else { ", " };
                    let minus = if sign[k] < 0 { "-" } else { "" };
                    write!(f, "{comma}{minus}{}", ["x", "y", "z"][from[k].min(2)])?;
                }
                f.write_str(")")
            }
            Self::SensorFrame => {
                f.write_str("points and normals are in the sensor's frame: they belong in the scene frame")
            }
            Self::GlobalFrame => {
                f.write_str("points are in the global frame: the scene frame starts at the scene origin")
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
                write!(f, "the flux is {factor:.6} times the true one: a constant factor is wrong")
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
            Self::CornerRays { columns, rows } => {
                let side = if *columns < 0.0 { "left" } else { "right" };
                let end = if *rows < 0.0 { "top" } else { "bottom" };
                write!(f, "rays go through the {end} {side} corner of their cell: a ray goes through the middle")
            }
        }
    }
}
