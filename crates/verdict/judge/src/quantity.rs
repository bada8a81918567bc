//! Quantities that are judged of each ray, and their names in reports and files.

use serde::{Deserialize, Serialize};
use std::fmt;

use raypencil_scene::{FluxModel, HitQuantity, SensorId};

/// The quantities of a pencil's return.
pub(crate) const RETURN_QUANTITIES: [Quantity; 6] = [
    Quantity::Visible,
    Quantity::Pixel,
    Quantity::CameraDepth,
    Quantity::CosOffAxis,
    Quantity::CosView,
    Quantity::PencilFlux,
];

/// What is judged of each ray.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Whether there is a hit.
    Hit,
    /// Which face is hit.
    Face,
    /// Distance along the ray, metres.
    Range,
    /// Distance along the sensor's normal axis, metres.
    Depth,
    /// The point, metres.
    Point,
    /// The unit normal.
    Normal,
    /// Cosine of incidence, cos(psi).
    #[serde(rename = "incidence")]
    CosIncidence,
    /// Whether the camera sees a pencil's hit.
    Visible,
    /// The camera's pixel in which a pencil's hit lands.
    Pixel,
    /// r, distance of a pencil's hit from the projection centre along the camera's axis, metres.
    CameraDepth,
    /// cos(phi), phi being the angle between the camera's axis and the line to a pencil's hit.
    #[serde(rename = "off_axis")]
    CosOffAxis,
    /// cos(theta), theta being the angle between the normal at a pencil's hit and the line to the camera.
    #[serde(rename = "emission")]
    CosView,
    /// Flux that a pencil delivers, watts (`eq1`: W/m).
    PencilFlux,
    /// Flux that a pixel receives, watts (`eq1`: W/m). `compare`: from all beams; `check`: from one.
    PixelFlux,
}

impl Quantity {
    /// All quantities, in the order of reports.
    pub const ALL: [Self; 14] = [
        Self::Hit,
        Self::Face,
        Self::Range,
        Self::Depth,
        Self::Point,
        Self::Normal,
        Self::CosIncidence,
        Self::Visible,
        Self::Pixel,
        Self::CameraDepth,
        Self::CosOffAxis,
        Self::CosView,
        Self::PencilFlux,
        Self::PixelFlux,
    ];

    /// Unit of the quantity's error; empty for a pure number.
    pub fn unit(self, model: FluxModel) -> &'static str {
        match self {
            Self::Range | Self::Depth | Self::Point | Self::CameraDepth => "m",
            Self::PencilFlux | Self::PixelFlux => match model {
                FluxModel::Radiometric => "W",
                FluxModel::Eq1 => "W/m",
            },
            Self::Hit
            | Self::Face
            | Self::Normal
            | Self::CosIncidence
            | Self::Visible
            | Self::Pixel
            | Self::CosOffAxis
            | Self::CosView => "",
        }
    }

    /// Whether rays of this sensor have the quantity.
    pub fn is_of(self, sensor: SensorId) -> bool {
        match self {
            Self::Hit
            | Self::Face
            | Self::Range
            | Self::Depth
            | Self::Point
            | Self::Normal
            | Self::CosIncidence => true,
            Self::Visible
            | Self::Pixel
            | Self::CameraDepth
            | Self::CosOffAxis
            | Self::CosView
            | Self::PencilFlux => sensor != SensorId::Camera,
            Self::PixelFlux => sensor == SensorId::Camera,
        }
    }
}

impl From<HitQuantity> for Quantity {
    fn from(quantity: HitQuantity) -> Self {
        match quantity {
            HitQuantity::Range => Self::Range,
            HitQuantity::Depth => Self::Depth,
            HitQuantity::Point => Self::Point,
            HitQuantity::Normal => Self::Normal,
            HitQuantity::CosIncidence => Self::CosIncidence,
        }
    }
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Hit => "hit/miss",
            Self::Face => "face",
            Self::Range => "range",
            Self::Depth => "depth",
            Self::Point => "point",
            Self::Normal => "normal",
            Self::CosIncidence => "incidence",
            Self::Visible => "visible",
            Self::Pixel => "pixel",
            Self::CameraDepth => "camera depth",
            Self::CosOffAxis => "cos(phi)",
            Self::CosView => "cos(theta)",
            Self::PencilFlux => "pencil flux",
            Self::PixelFlux => "pixel flux",
        })
    }
}

/// A quantity; for a flux, also the beam and the model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Item {
    /// The quantity.
    pub quantity: Quantity,
    /// The beam of a flux on the image; `None` for every other quantity, and for the flux of all beams.
    pub beam: Option<u32>,
    /// Whether it is a flux by the model that is not the scene's.
    pub is_other_model: bool,
}

impl Item {
    /// Whether it is a quantity alone, without a beam and by the scene's model.
    #[inline]
    pub(crate) fn is_plain(self) -> bool {
        self.beam.is_none() && !self.is_other_model
    }

    /// The flux of one beam on the image, by the scene's model.
    pub fn of_image(beam: usize) -> Self {
        Self { beam: Some(beam as u32), ..Quantity::PixelFlux.into() }
    }

    /// The flux of pencils, by the scene's model or by the other.
    pub(crate) fn pencil_flux(is_other_model: bool) -> Self {
        Self { is_other_model, ..Quantity::PencilFlux.into() }
    }
}

impl From<Quantity> for Item {
    fn from(quantity: Quantity) -> Self {
        Self { quantity, beam: None, is_other_model: false }
    }
}

/// Name of an item for people, with its beam and with the model if that is not the scene's.
pub fn name_of(item: Item) -> String {
    let beam = item.beam.map_or(String::new(), |beam| format!(", beam {beam}"));
    let model = if item.is_other_model { " (other model)" } else { "" };
    format!("{}{beam}{model}", item.quantity)
}

/// Unit of an item's error; empty for a pure number.
pub fn unit_of(scene_model: FluxModel, item: Item) -> &'static str {
    item.quantity.unit(if item.is_other_model { scene_model.other() } else { scene_model })
}

/// Name of an item for programs, as in `summary.json`: `range`, `pencil_flux.eq1`, `pixel_flux.beam0`.
pub fn key_of(scene_model: FluxModel, item: Item) -> String {
    let name = serde_json::to_value(item.quantity).ok();
    let name = name.as_ref().and_then(|name| name.as_str()).unwrap_or_default().to_string();
    let beam = item.beam.map_or(String::new(), |beam| format!(".beam{beam}"));
    let model = if item.is_other_model { format!(".{}", scene_model.other().word()) } else { String::new() };
    format!("{name}{beam}{model}")
}
