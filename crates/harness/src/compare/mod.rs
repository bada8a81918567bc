//! Two frames of one scene, ray by ray: what agrees, and what each difference is.
//!
//! A ray is a cell of a sensor: a pencil or a pixel. Its class is the worst of its quantities', and the
//! classes of all rays add up to those compared. The referee rules on every ray whose two answers differ, and
//! on a sample of those that agree: two renderers may share a mistake.

mod pencil;
mod pixel;
mod ray;
mod single;

use std::collections::BTreeMap;
use std::fmt;

use rayon::prelude::*;
use raypencil_referee::Ruling;
use raypencil_scanline::Switches;
use raypencil_scene::{FluxModel, Frame, Image, Maybe, Resolution, Scene, SensorId, SensorMap};
use serde::{Deserialize, Serialize};

use crate::attribution::Attributions;
use crate::judge::{Judge, JudgeShare};
use pencil::PencilLight;
use pixel::PixelLight;
use ray::compare_ray;
pub use single::{First, class_at, first_of};

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
const CLASSES: usize = 6;

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
    Incidence,
    /// Whether the camera sees a pencil's hit.
    Visible,
    /// Where a pencil's hit lands on the camera's image.
    Pixel,
    /// r, distance of a pencil's hit from the projection centre along the camera's axis, metres.
    CameraDepth,
    /// cos(phi), of a pencil's hit as the camera sees it.
    OffAxis,
    /// cos(theta), of a pencil's hit towards the camera.
    Emission,
    /// What a pencil delivers, watts (`eq1`: W/m).
    PencilFlux,
    /// What a pixel receives of all beams, watts (`eq1`: W/m).
    PixelFlux,
}

/// How many quantities there are.
const QUANTITIES: usize = 14;

impl Quantity {
    /// All of them, in the order of reports.
    pub const ALL: [Self; QUANTITIES] = [
        Self::Hit,
        Self::Face,
        Self::Range,
        Self::Depth,
        Self::Point,
        Self::Normal,
        Self::Incidence,
        Self::Visible,
        Self::Pixel,
        Self::CameraDepth,
        Self::OffAxis,
        Self::Emission,
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
            | Self::Incidence
            | Self::Visible
            | Self::Pixel
            | Self::OffAxis
            | Self::Emission => "",
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
            | Self::Incidence => true,
            Self::Visible
            | Self::Pixel
            | Self::CameraDepth
            | Self::OffAxis
            | Self::Emission
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
            Self::Incidence => "incidence",
            Self::Visible => "visible",
            Self::Pixel => "pixel",
            Self::CameraDepth => "camera depth",
            Self::OffAxis => "cos(phi)",
            Self::Emission => "cos(theta)",
            Self::PencilFlux => "pencil flux",
            Self::PixelFlux => "pixel flux",
        })
    }
}

/// A ray, by its sensor and cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Place {
    /// Whose ray.
    pub sensor: SensorId,
    /// Column.
    pub i: u32,
    /// Row.
    pub j: u32,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let cell = if self.sensor == SensorId::Camera { "pixel" } else { "pencil" };
        write!(f, "{} {cell} {},{}", self.sensor, self.i, self.j)
    }
}

/// The largest of something, and where it was found first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Worst {
    /// The value.
    pub value: f64,
    /// The first place in reading order that has it.
    pub place: Place,
}

impl Worst {
    fn keep(slot: &mut Option<Self>, value: f64, place: Place) {
        // NaN counts as worst: a bound that is not a number bounds nothing.
        if slot.is_none_or(|worst| value > worst.value || (value.is_nan() && !worst.value.is_nan())) {
            *slot = Some(Self { value, place });
        }
    }
}

/// How one quantity fared over many rays.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Tally {
    /// Rays by class, in the order of [`Class`].
    pub by_class: [u64; CLASSES],
    /// Rays of which one side does not say it.
    pub not_compared: u64,
    /// The largest difference, in [`Quantity::unit`], over rays that hit the same face or tie.
    pub worst_error: Option<Worst>,
    /// The largest ratio of a difference to its bound.
    pub worst_ratio: Option<Worst>,
}

impl Tally {
    /// Rays in a class.
    pub fn of(&self, class: Class) -> u64 {
        self.by_class[class as usize]
    }

    /// Adds what is said of later rays.
    pub fn add(&mut self, later: &Self) {
        for (mine, theirs) in self.by_class.iter_mut().zip(later.by_class) {
            *mine += theirs;
        }
        self.not_compared += later.not_compared;
        for (mine, theirs) in
            [(&mut self.worst_error, later.worst_error), (&mut self.worst_ratio, later.worst_ratio)]
        {
            if let Some(worst) = theirs {
                Worst::keep(mine, worst.value, worst.place);
            }
        }
    }
}

/// What one set of the paper's approximations did to a sensor's rays.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ApproximationTally {
    /// Rays.
    pub rays: u64,
    /// Those that hit in truth, and miss.
    pub lost: u64,
    /// Those that miss in truth, and hit.
    pub added: u64,
    /// By how much it changed the flux of pencils, each difference taken positive, watts (`eq1`: W/m).
    pub flux_changed: f64,
    /// The largest error of a range, metres, over rays that hit in truth and hit another face.
    pub worst_range: Option<Worst>,
}

impl ApproximationTally {
    /// Adds what is said of later rays.
    pub fn add(&mut self, later: &Self) {
        self.rays += later.rays;
        self.lost += later.lost;
        self.added += later.added;
        self.flux_changed += later.flux_changed;
        if let Some(worst) = later.worst_range {
            Worst::keep(&mut self.worst_range, worst.value, worst.place);
        }
    }
}

/// The tallies of each set of approximations that caused a difference.
pub type ApproximationTallies = BTreeMap<Switches, ApproximationTally>;

/// A ray on which the two sides differ beyond doubt.
#[derive(Debug, Clone, PartialEq)]
pub struct Defect {
    /// Which ray.
    pub place: Place,
    /// The quantity that is worst.
    pub quantity: Quantity,
    /// What each side says, in words.
    pub what: String,
}

/// The comparison of one sensor's maps.
#[derive(Debug, Clone)]
pub struct SensorComparison {
    /// Whose maps.
    pub sensor: SensorId,
    /// Rays compared at least by hit or miss.
    pub compared: u64,
    /// Rays whose maps one side does not have at all.
    pub not_compared: u64,
    /// Rays by class, in the order of [`Class`]; they add up to `compared`.
    pub by_class: [u64; CLASSES],
    /// Rays that the referee ruled on.
    pub judged: u64,
    /// Rays of [`Class::Approximation`] by cause; they add up to that class.
    pub approximations: ApproximationTallies,
    /// Each quantity by itself.
    pub quantities: Vec<(Quantity, Tally)>,
    /// The first defects, in reading order.
    pub defects: Vec<Defect>,
    /// Difference of the ranges, metres: `b - a`, where both hit.
    pub range_difference: Option<Image<Maybe<f64>>>,
}

impl SensorComparison {
    /// Rays in a class.
    pub fn of(&self, class: Class) -> u64 {
        self.by_class[class as usize]
    }
}

/// How many defects a comparison describes; all are counted.
const DEFECTS_DESCRIBED: usize = 100;

/// One side of a comparison.
#[derive(Debug, Clone, Copy)]
pub struct Side<'a> {
    /// The renderer's name.
    pub name: &'a str,
    /// What it rendered.
    pub frame: &'a Frame,
    /// How finely it computes.
    pub resolution: Resolution,
    /// The causes of its errors, if it follows the paper into some.
    pub attributions: Option<&'a Attributions>,
}

/// Compares two frames of `scene`, sensor by sensor, with a judge of its own.
pub fn compare(scene: &Scene, a: Side<'_>, b: Side<'_>) -> Vec<SensorComparison> {
    compare_judged(&Judge::new(scene, JudgeShare::Sample), a, b)
}

/// Compares two frames of the judge's scene, sensor by sensor, the camera first.
pub fn compare_judged(judge: &Judge<'_>, a: Side<'_>, b: Side<'_>) -> Vec<SensorComparison> {
    let (beams, light) = compare_beams(judge, a, b);
    let (camera, _) = compare_sensor(judge, SensorId::Camera, a, b, &light);
    std::iter::once(camera).chain(beams).collect()
}

/// The beams, which come first: a pixel's flux is judged by the pencils that contribute to it.
fn compare_beams<'f>(
    judge: &Judge<'_>,
    a: Side<'f>,
    b: Side<'f>,
) -> (Vec<SensorComparison>, Vec<PixelLight<'f>>) {
    let mut light = Vec::new();
    let mut beams = Vec::new();
    for index in 0..judge.scene().beams().len() {
        let (comparison, pencils) = compare_sensor(judge, SensorId::Beam(index), a, b, &[]);
        beams.push(comparison);
        light.extend(light_of(judge, index, [a, b], pencils));
    }
    (beams, light)
}

/// The light of a beam on the image, if both sides have an image of it and pencils to judge that by.
fn light_of<'f>(
    judge: &Judge<'_>,
    beam: usize,
    sides: [Side<'f>; 2],
    pencils: Vec<PencilLight>,
) -> Option<PixelLight<'f>> {
    let tells_pencils = sides.iter().all(|side| {
        let returns = side.frame.returns.get(beam);
        returns.is_some_and(|returns| returns.pixel.is_some() && returns.flux.is_some())
    });
    let [of_a, of_b] = sides.map(|side| side.frame.flux.get(beam));
    let images = [of_a?, of_b?];
    let [a, b] = sides.map(|side| side.resolution.unit_roundoff);
    tells_pencils.then(|| PixelLight::new(judge.scene(), images, pencils, a.max(b)))
}

fn compare_sensor(
    judge: &Judge<'_>,
    sensor: SensorId,
    a: Side<'_>,
    b: Side<'_>,
    light: &[PixelLight<'_>],
) -> (SensorComparison, Vec<PencilLight>) {
    if let (Some(of_a), Some(of_b)) = (a.frame.map(sensor), b.frame.map(sensor))
        && says_hit(of_a)
        && says_hit(of_b)
    {
        return compare_maps(judge, sensor, (of_a, a), (of_b, b), light);
    }
    let (width, height) = judge.scene().size(sensor).expect("a sensor of this scene");
    let not_compared = u64::from(width) * u64::from(height);
    let tally = |quantity: Quantity| {
        let not_compared = if quantity.is_of(sensor) { not_compared } else { 0 };
        (quantity, Tally { not_compared, ..Tally::default() })
    };
    let comparison = SensorComparison {
        sensor,
        compared: 0,
        not_compared,
        by_class: [0; CLASSES],
        judged: 0,
        approximations: BTreeMap::new(),
        quantities: Quantity::ALL.map(tally).to_vec(),
        defects: Vec::new(),
        range_difference: None,
    };
    (comparison, Vec::new())
}

/// Whether a map says of each ray if it hits.
fn says_hit(map: &SensorMap) -> bool {
    map.range.is_some() || map.face.is_some()
}

/// One row's or one sensor's results while they are gathered.
#[derive(Default)]
struct Gathered {
    by_class: [u64; CLASSES],
    judged: u64,
    approximations: ApproximationTallies,
    tallies: [Tally; QUANTITIES],
    /// What pencils deliver that either side says it sees.
    light: Vec<PencilLight>,
    defects: Vec<Defect>,
    differences: Vec<Maybe<f64>>,
}

fn compare_maps(
    judge: &Judge<'_>,
    sensor: SensorId,
    (map_a, a): (&SensorMap, Side<'_>),
    (map_b, b): (&SensorMap, Side<'_>),
    light: &[PixelLight<'_>],
) -> (SensorComparison, Vec<PencilLight>) {
    let (width, height) = judge.scene().size(sensor).expect("a sensor of this scene");
    // Rows in parallel, added up in their order: the result does not depend on threads.
    let rows: Vec<Gathered> = (0..height)
        .into_par_iter()
        .map(|j| {
            let mut row = Gathered::default();
            for i in 0..width {
                compare_ray(judge, Place { sensor, i, j }, (map_a, a), (map_b, b), light, &mut row);
            }
            row
        })
        .collect();
    let mut all = Gathered::default();
    for row in rows {
        for (mine, theirs) in all.by_class.iter_mut().zip(row.by_class) {
            *mine += theirs;
        }
        all.judged += row.judged;
        for (cause, tally) in row.approximations {
            all.approximations.entry(cause).or_default().add(&tally);
        }
        for (mine, theirs) in all.tallies.iter_mut().zip(&row.tallies) {
            mine.add(theirs);
        }
        let room = DEFECTS_DESCRIBED.saturating_sub(all.defects.len());
        all.defects.extend(row.defects.into_iter().take(room));
        all.differences.extend(row.differences);
        all.light.extend(row.light);
    }
    let comparison = SensorComparison {
        sensor,
        compared: u64::from(width) * u64::from(height),
        not_compared: 0,
        by_class: all.by_class,
        judged: all.judged,
        approximations: all.approximations,
        quantities: Quantity::ALL.into_iter().zip(all.tallies).collect(),
        defects: all.defects,
        range_difference: Some(Image::from_cells(width, height, all.differences)),
    };
    (comparison, all.light)
}

impl Class {
    /// What a ruling makes of an answer; `has_cause`: if an approximation of the paper explains it.
    pub(crate) fn of(ruling: Ruling, has_cause: bool) -> Self {
        match ruling {
            Ruling::Exact => Self::Agree,
            Ruling::Tie => Self::Tie,
            Ruling::Rounding(_) => Self::Rounding,
            Ruling::Wrong if has_cause => Self::Approximation,
            Ruling::Wrong => Self::Defect,
        }
    }
}
