use serde::Deserialize;
use serde::Serialize;
use std::fmt;

use raypencil_referee::Ruling;
use raypencil_scene::{FluxModel, SensorId};

/// A quantity's name; of a flux by the other model, with it.
pub fn name_of(item: Item) -> String {
    let beam = item.beam.map_or(String::new(), |beam| format!(", beam {beam}"));
    let model = if item.is_other_model { " (other model)" } else { "" };
    format!("{}{beam}{model}", item.quantity)
}

/// The unit of a quantity's error.
pub fn unit_of(truth_model: FluxModel, item: Item) -> &'static str {
    item.quantity.unit(if item.is_other_model { truth_model.other() } else { truth_model })
}

/// A quantity's name for programs, as in `summary.json`; of a flux by the other model, with that, and of an
/// image with its beam: `pencil_flux.eq1`, `pixel_flux.beam0`.
pub fn key_of(truth_model: FluxModel, item: Item) -> String {
    let name = serde_json::to_value(item.quantity).ok();
    let name = name.as_ref().and_then(|name| name.as_str()).unwrap_or_default().to_string();
    let beam = item.beam.map_or(String::new(), |beam| format!(".beam{beam}"));
    let model = if item.is_other_model { format!(".{}", truth_model.other().word()) } else { String::new() };
    format!("{name}{beam}{model}")
}

/// What a difference is. In ascending order of badness.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Class {
    /// The same face, or none on either side; every value within its bound.
    Agree,
    /// Each side names one of several faces that are met at exactly the same point.
    Tie,
    /// Not the exact answer, but that of a ray displaced by no more than the renderer's resolution.
    Rounding,
    /// One side follows the paper into error, for a cause that the referee confirms.
    Approximation,
    /// The referee's budget ran out. Verdicts are exact and have none, so this stays 0 here; a flux by transcendental
    /// functions may lie on a midpoint as far as thousands of bits tell (`check`).
    Undecided,
    /// Anything else.
    Defect,
}

/// How many classes there are.
pub(crate) const CLASSES: usize = 6;

/// What is compared of each ray.
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
    /// The cosine of incidence, cos(psi).
    #[serde(rename = "incidence")]
    CosIncidence,
    /// Whether the camera sees a pencil's hit.
    Visible,
    /// Where a pencil's hit lands on the camera's image.
    Pixel,
    /// r, distance of a pencil's hit from the projection centre along the camera's axis, metres.
    CameraDepth,
    /// cos(phi), of a pencil's hit as the camera sees it.
    #[serde(rename = "off_axis")]
    CosOffAxis,
    /// cos(theta), of a pencil's hit towards the camera.
    #[serde(rename = "emission")]
    CosView,
    /// What a pencil delivers, watts (`eq1`: W/m).
    PencilFlux,
    /// What a pixel receives of all beams, watts (`eq1`: W/m).
    PixelFlux,
}

/// How many quantities there are.
pub(crate) const QUANTITIES: usize = 14;

impl Quantity {
    /// All of them, in the order of reports.
    pub const ALL: [Self; QUANTITIES] = [
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

    /// Unit of its error, empty for a pure number.
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

    /// Whether rays of this sensor have it.
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

impl Class {
    /// What a ruling makes of an answer; `has_cause`: if an approximation of the paper explains it.
    pub fn of(ruling: Ruling, has_cause: bool) -> Self {
        match ruling {
            Ruling::Exact => Self::Agree,
            Ruling::Tie => Self::Tie,
            Ruling::Rounding(_) => Self::Rounding,
            Ruling::Wrong if has_cause => Self::Approximation,
            Ruling::Wrong => Self::Defect,
        }
    }
}

/// A quantity; a flux by the scene's model or by the other one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Item {
    /// The quantity.
    pub quantity: Quantity,
    /// Of a flux on the image, which beam's.
    pub beam: Option<u32>,
    /// Whether it is a flux by the model that is not the scene's.
    pub is_other_model: bool,
}

impl From<Quantity> for Item {
    fn from(quantity: Quantity) -> Self {
        Self { quantity, beam: None, is_other_model: false }
    }
}
