//! Two frames of one scene, ray by ray: what agrees, and what each difference is.
//!
//! A ray is a cell of a sensor: a pencil or a pixel. Its class is the worst of its quantities', and the
//! classes of all rays add up to those compared. The referee rules on every ray whose two answers differ, and
//! on a sample of those that agree: two renderers may share a mistake.

use std::collections::BTreeMap;
use std::fmt;

use glam::DVec3;
use rayon::prelude::*;
use raypencil_referee::Ruling;
use raypencil_scanline::Switches;
use raypencil_scene::{FaceId, Frame, Image, Maybe, Resolution, Scene, SensorId, SensorMap};
use serde::Serialize;

use crate::attribution::{Attributions, Cause};
use crate::bounds::Bounds;
use crate::judge::{Judge, JudgeShare};

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
    /// The referee's budget ran out. Its arithmetic is exact and has none, so this stays 0.
    Undecided,
    /// Anything else.
    Defect,
}

/// How many classes there are.
const CLASSES: usize = 6;

/// What is compared of each ray.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
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
    /// The cosine of incidence.
    Incidence,
}

impl Quantity {
    /// All of them, in the order of reports.
    pub const ALL: [Self; 7] =
        [Self::Hit, Self::Face, Self::Range, Self::Depth, Self::Point, Self::Normal, Self::Incidence];

    /// Unit of its error, empty for a pure number.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Range | Self::Depth | Self::Point => "m",
            Self::Hit | Self::Face | Self::Normal | Self::Incidence => "",
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
        })
    }
}

/// A ray, by its sensor and cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
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
    /// The largest error of a range, metres, over rays that hit in truth and hit another face.
    pub worst_range: Option<Worst>,
}

impl ApproximationTally {
    /// Adds what is said of later rays.
    pub fn add(&mut self, later: &Self) {
        self.rays += later.rays;
        self.lost += later.lost;
        self.added += later.added;
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

/// Compares two frames of the judge's scene, sensor by sensor.
pub fn compare_judged(judge: &Judge<'_>, a: Side<'_>, b: Side<'_>) -> Vec<SensorComparison> {
    let scene = judge.scene();
    scene
        .sensors()
        .map(|sensor| match (a.frame.map(sensor), b.frame.map(sensor)) {
            (Some(of_a), Some(of_b)) if says_hit(of_a) && says_hit(of_b) => {
                compare_maps(judge, sensor, (of_a, a), (of_b, b))
            }
            _ => {
                let (width, height) = scene.size(sensor).expect("a sensor of this scene");
                let not_compared = u64::from(width) * u64::from(height);
                let tally = Tally { not_compared, ..Tally::default() };
                SensorComparison {
                    sensor,
                    compared: 0,
                    not_compared,
                    by_class: [0; CLASSES],
                    judged: 0,
                    approximations: BTreeMap::new(),
                    quantities: Quantity::ALL.map(|quantity| (quantity, tally.clone())).to_vec(),
                    defects: Vec::new(),
                    range_difference: None,
                }
            }
        })
        .collect()
}

/// Whether a map says of each ray if it hits.
fn says_hit(map: &SensorMap) -> bool {
    map.range.is_some() || map.face.is_some()
}

/// What one side says of one ray.
#[derive(Debug, Clone, Copy)]
struct Answer {
    hit: bool,
    range: Option<f64>,
    depth: Option<f64>,
    face: Option<FaceId>,
    point: Option<DVec3>,
    normal: Option<DVec3>,
    incidence: Option<f64>,
}

impl Answer {
    fn of(map: &SensorMap, i: u32, j: u32) -> Self {
        fn at<T: raypencil_scene::Sample>(image: &Option<Image<Maybe<T>>>, i: u32, j: u32) -> Option<T> {
            image.as_ref().and_then(|image| image.at(i, j).get())
        }
        let (range, face) = (at(&map.range, i, j), at(&map.face, i, j));
        Self {
            hit: range.is_some() || face.is_some(),
            range,
            depth: at(&map.depth, i, j),
            face,
            point: at(&map.point, i, j),
            normal: at(&map.normal, i, j),
            incidence: at(&map.incidence, i, j),
        }
    }
}

/// One row's or one sensor's results while they are gathered.
#[derive(Default)]
struct Gathered {
    by_class: [u64; CLASSES],
    judged: u64,
    approximations: ApproximationTallies,
    tallies: [Tally; 7],
    defects: Vec<Defect>,
    differences: Vec<Maybe<f64>>,
}

fn compare_maps(
    judge: &Judge<'_>,
    sensor: SensorId,
    (map_a, a): (&SensorMap, Side<'_>),
    (map_b, b): (&SensorMap, Side<'_>),
) -> SensorComparison {
    let (width, height) = judge.scene().size(sensor).expect("a sensor of this scene");
    // Rows in parallel, added up in their order: the result does not depend on threads.
    let rows: Vec<Gathered> = (0..height)
        .into_par_iter()
        .map(|j| {
            let mut row = Gathered::default();
            for i in 0..width {
                compare_ray(judge, Place { sensor, i, j }, (map_a, a), (map_b, b), &mut row);
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
    }
    SensorComparison {
        sensor,
        compared: u64::from(width) * u64::from(height),
        not_compared: 0,
        by_class: all.by_class,
        judged: all.judged,
        approximations: all.approximations,
        quantities: Quantity::ALL.into_iter().zip(all.tallies).collect(),
        defects: all.defects,
        range_difference: Some(Image::from_cells(width, height, all.differences)),
    }
}

/// Compares one ray and enters it into `row`.
fn compare_ray(
    judge: &Judge<'_>,
    place: Place,
    (map_a, a): (&SensorMap, Side<'_>),
    (map_b, b): (&SensorMap, Side<'_>),
    row: &mut Gathered,
) {
    let Place { sensor, i, j } = place;
    let (of_a, of_b) = (Answer::of(map_a, i, j), Answer::of(map_b, i, j));
    let mut worst = (Class::Agree, Quantity::Hit);
    let mut enter = |quantity: Quantity, class: Class| {
        row.tallies[quantity as usize].by_class[class as usize] += 1;
        if class > worst.0 {
            worst = (class, quantity);
        }
    };

    row.differences.push(of_a.range.zip(of_b.range).map(|(a, b)| b - a).into());
    let same_face = of_a.face.zip(of_b.face).map(|(x, y)| x == y);
    let differ = of_a.hit != of_b.hit || same_face == Some(false);

    // What the referee says of both answers, if it is asked and they can be named.
    let named = |answer: &Answer| !answer.hit || answer.face.is_some();
    let ruled = (named(&of_a) && named(&of_b) && (differ || judge.samples(place))).then(|| {
        row.judged += 1;
        let class_of = |answer: &Answer, side: Side<'_>| {
            let ruling = judge.rule(place, answer.face, answer.range, side.resolution);
            Class::of(ruling, side.attributions.and_then(|causes| causes.cause(place)))
        };
        class_of(&of_a, a).max(class_of(&of_b, b))
    });
    // Answers that cannot be named can only be compared by being the same.
    let answers = ruled.unwrap_or(if differ { Class::Defect } else { Class::Agree });
    let both_hit = of_a.hit && of_b.hit;
    enter(Quantity::Hit, if both_hit { Class::Agree } else { answers });

    if both_hit {
        let scene = judge.scene();
        let ray = scene.ray(sensor, i, j).expect("a cell of this sensor");
        // Without faces or ranges there is nothing to derive a bound from: only exactness agrees.
        let mesh = scene.mesh();
        let known = |answer: &Answer| answer.face.filter(|face| (face.0 as usize) < mesh.faces().len());
        let bounds = |answer: &Answer, other: &Answer, resolution| {
            let face = known(answer).or(known(other));
            let range = answer.range.or(other.range);
            face.zip(range).map(|(face, range)| Bounds::of(mesh, face, &ray, range, resolution))
        };
        let bounds = bounds(&of_a, &of_b, a.resolution)
            .zip(bounds(&of_b, &of_a, b.resolution))
            .map(|(of_a, of_b)| of_a.plus(&of_b));
        let within = |difference: f64, bound: Option<f64>| match bound {
            Some(bound) => difference <= bound,
            None => difference == 0.0,
        };
        let mut values: [Option<(Quantity, f64, Option<f64>)>; 5] = [
            of_a.range
                .zip(of_b.range)
                .map(|(x, y)| (Quantity::Range, (x - y).abs(), bounds.map(|bounds| bounds.range))),
            of_a.depth
                .zip(of_b.depth)
                .map(|(x, y)| (Quantity::Depth, (x - y).abs(), bounds.map(|bounds| bounds.range))),
            of_a.point
                .zip(of_b.point)
                .map(|(x, y)| (Quantity::Point, (x - y).length(), bounds.map(|bounds| bounds.point))),
            of_a.normal
                .zip(of_b.normal)
                .map(|(x, y)| (Quantity::Normal, (x - y).length(), bounds.map(|bounds| bounds.normal))),
            of_a.incidence
                .zip(of_b.incidence)
                .map(|(x, y)| (Quantity::Incidence, (x - y).abs(), bounds.map(|bounds| bounds.incidence))),
        ];

        if same_face.is_some() {
            enter(Quantity::Face, answers);
        }
        if same_face == Some(false) {
            // Two faces at one point have the same range, and each its own normal. The values of two faces
            // at different points have nothing to do with each other.
            (values[3], values[4]) = (None, None);
            if answers != Class::Tie {
                values = [None; 5];
            }
        }
        for (quantity, difference, bound) in values.into_iter().flatten() {
            enter(quantity, if within(difference, bound) { Class::Agree } else { Class::Defect });
        }
        for (quantity, difference, bound) in values.into_iter().flatten() {
            let tally = &mut row.tallies[quantity as usize];
            Worst::keep(&mut tally.worst_error, difference, place);
            if let Some(bound) = bound {
                // 0 / 0 is no error at all.
                let ratio = if difference == 0.0 { 0.0 } else { difference / bound };
                Worst::keep(&mut tally.worst_ratio, ratio, place);
            }
        }
    }
    for quantity in Quantity::ALL {
        let missing = match quantity {
            Quantity::Hit => false,
            Quantity::Face => map_a.face.is_none() || map_b.face.is_none(),
            Quantity::Range => map_a.range.is_none() || map_b.range.is_none(),
            Quantity::Depth => map_a.depth.is_none() || map_b.depth.is_none(),
            Quantity::Point => map_a.point.is_none() || map_b.point.is_none(),
            Quantity::Normal => map_a.normal.is_none() || map_b.normal.is_none(),
            Quantity::Incidence => map_a.incidence.is_none() || map_b.incidence.is_none(),
        };
        row.tallies[quantity as usize].not_compared += u64::from(missing);
    }

    let (class, quantity) = worst;
    row.by_class[class as usize] += 1;
    if class == Class::Approximation {
        let mut causes = Switches::EXACT;
        let mut tally = ApproximationTally { rays: 1, ..ApproximationTally::default() };
        for (answer, side) in [(&of_a, a), (&of_b, b)] {
            let Some(cause) = side.attributions.and_then(|causes| causes.cause(place)) else { continue };
            causes = causes.union(cause.switches);
            tally.enter(answer, cause, place);
        }
        row.approximations.entry(causes).or_default().add(&tally);
    }
    if class == Class::Defect && row.defects.len() < DEFECTS_DESCRIBED {
        let what = format!("{}: {}; {}: {}", a.name, describe(&of_a), b.name, describe(&of_b));
        row.defects.push(Defect { place, quantity, what });
    }
}

impl Class {
    /// What a ruling makes of a ray, and of its cause if it has one.
    pub(crate) fn of(ruling: Ruling, cause: Option<&Cause>) -> Self {
        match ruling {
            Ruling::Exact => Self::Agree,
            Ruling::Tie => Self::Tie,
            Ruling::Rounding(_) => Self::Rounding,
            Ruling::Wrong if cause.is_some() => Self::Approximation,
            Ruling::Wrong => Self::Defect,
        }
    }
}

impl ApproximationTally {
    /// Enters one side's error.
    fn enter(&mut self, answer: &Answer, cause: &Cause, place: Place) {
        match (answer.hit, cause.restored_range) {
            (false, Some(_)) => self.lost = 1,
            (true, None) => self.added = 1,
            _ => {}
        }
        if let (Some(range), Some(restored)) = (answer.range, cause.restored_range) {
            Worst::keep(&mut self.worst_range, (range - restored).abs(), place);
        }
    }
}

/// One side's answer in words.
fn describe(answer: &Answer) -> String {
    if !answer.hit {
        return "no hit".into();
    }
    let face = answer.face.map_or("a face".into(), |face| format!("face {}", face.0));
    let range = answer.range.map_or("unknown range".into(), |range| format!("range {range} m"));
    format!("{face} at {range}")
}
