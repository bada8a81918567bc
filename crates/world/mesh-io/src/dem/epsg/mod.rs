//! What the codes of EPSG say about the axes of a coordinate system: all codes of EPSG v11.022.
//!
//! The EPSG Geodetic Parameter Dataset is owned by IOGP.

mod compound;
mod projected;
mod vertical;

use self::compound::COMPOUND;
use self::projected::{REVERSED, UNITS};
use self::vertical::VERTICAL;
use super::unit::{HeightUnit, LengthUnit};

/// A vertical coordinate system.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Vertical {
    /// Unit, and whether the axis points down; `None`: the code is of GeoTIFF 1.0, which gives it no unit.
    pub unit: Option<HeightUnit>,
    pub name: &'static str,
}

/// Unit of a projected coordinate system; `None`: no such code.
pub(super) fn projected(code: u16) -> Option<LengthUnit> {
    let (unit, _) = UNITS.iter().find(|(_, runs)| is_in(runs, code))?;
    LengthUnit::of_code(*unit)
}

/// Whether the axes of a projected coordinate system point west or south.
pub(super) fn is_reversed(code: u16) -> bool {
    is_in(REVERSED, code)
}

/// The codes of the projected and the vertical part of a compound coordinate system; `None`: no such code.
pub(super) fn compound(code: u16) -> Option<[u16; 2]> {
    let parts = COMPOUND.chunks_exact(3).find(|parts| parts[0] == code)?;
    Some([parts[1], parts[2]])
}

/// A vertical coordinate system; `None`: no such code.
pub(super) fn vertical(code: u16) -> Option<Vertical> {
    // Datums by the codes of GeoTIFF 1.0, section 6.3.4, all of them of heights. No code of EPSG is among them.
    match code {
        5001..=5033 => return Some(Vertical { unit: None, name: "height above the ellipsoid" }),
        5101 => return Some(Vertical { unit: None, name: "Newlyn height" }),
        5102 => return Some(Vertical { unit: None, name: "NGVD29 height" }),
        5103 => return Some(Vertical { unit: None, name: "NAVD88 height" }),
        5104 => return Some(Vertical { unit: None, name: "Yellow Sea 1956 height" }),
        5105 => return Some(Vertical { unit: None, name: "Baltic Sea height" }),
        5106 => return Some(Vertical { unit: None, name: "Caspian Sea height" }),
        _ => {}
    }
    let &(_, unit, is_depth, name) = VERTICAL.iter().find(|(known, ..)| *known == code)?;
    let unit = LengthUnit::of_code(unit)?;
    Some(Vertical { unit: Some(HeightUnit { unit, is_depth }), name })
}

/// Whether a code lies in one of the runs, which are given by their first and last codes.
fn is_in(runs: &[u16], code: u16) -> bool {
    runs.chunks_exact(2).any(|run| (run[0]..=run[1]).contains(&code))
}

#[cfg(test)]
#[path = "../../../tests/unit/epsg.rs"]
mod tests;
