//! The ray of each point.

use std::collections::HashMap;

use glam::DVec3;
use raypencil_files::Fault;
use raypencil_mesh_io::{Cloud, CloudColumn};
use raypencil_scene::CastRay;

use super::file::BagPlace;
use crate::pack::scan::Scan;

/// Greatest share of the points, in a hundred, that may belong to no ray. Tuned: more say that the points were laid on the wrong rays.
const MAX_STRAY_PERCENT: usize = 1;

/// How much nearer the nearest ray of a point must be than the next one, as a factor. Tuned: at 3 a point that stands a quarter of
/// the way from its ray to the next is still told.
const NEARER: f64 = 3.0;

/// Returns that a sensor tells of a pulse, at most: that of the LAS format, 1.4. More points for one ray have wrong fields.
const MAX_RETURNS: usize = 15;

/// Fields that have the number of a return: this project's own, and that of the LAS format.
pub(super) const NUMBERS_OF_RETURNS: [&str; 2] = ["return", "return_number"];

/// Cells along each axis of the grid in which rays are looked up by their direction, at most.
const MAX_CELLS: i32 = 1024;

/// Words for points that are laid on rays by their direction.
pub(super) const BY_DIRECTION: &str = "by direction";

/// In which order points lie in their file.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Order {
    /// A row of points is one channel, and not one firing sequence.
    pub(super) is_of_channels: bool,
    /// The rows run from the last to the first; the points of each row do.
    pub(super) backwards: [bool; 2],
}

/// The points of a cloud on the rays of a pack.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Assigned {
    /// For each ray the index of its point.
    pub(super) point_of: Vec<Option<usize>>,
    /// Points of no ray, or of one that has another.
    pub(super) strays: Vec<usize>,
    /// Of the rays, or beams, that have more points than places: how many each has too many.
    pub(super) crowded: HashMap<usize, usize>,
    /// How it was found, in words.
    pub(super) by: &'static str,
}

/// What is asked of a pack of rays.
pub(super) struct Asked<'a> {
    /// Dimensions of the rays, or of beams that have several places each.
    pub(super) shape: &'a [u64],
    pub(super) rays: &'a [CastRay],
    pub(super) scan: Option<&'a Scan>,
    /// Places of each beam: 1, or one for each return that may be told. They follow each other in `rays`.
    pub(super) places: usize,
    /// Number of the return of each place, by which points are told; NaN for a place without one. Empty where rays stand for themselves.
    pub(super) numbers: &'a [f64],
    /// The bag of the cloud; `None`: it has a file of its own.
    pub(super) bag: Option<&'a BagPlace>,
}

impl Asked<'_> {
    /// The channels, if rays have one each.
    pub(super) fn channels(&self) -> Option<usize> {
        match self.shape {
            [_, channels] => Some(*channels as usize),
            _ => None,
        }
    }

    /// By order: one point for each ray.
    pub(super) fn by_order(&self, cloud: &Cloud, is_point: &[bool], order: Order) -> Option<Assigned> {
        if cloud.len() != self.rays.len() {
            return None;
        }
        if order == Order::default() {
            if self.places > 1 && number_of_return(cloud).is_some() {
                let beam = |point: usize| Some(point / self.places);
                return Some(self.of_beams(
                    cloud,
                    is_point,
                    beam,
                    "by the order of the points and the numbers of returns",
                ));
            }
            return Some(self.collected(is_point, Some, "by the order of the points"));
        }
        let channels = self.channels().filter(|_| self.places == 1)?;
        let sequences = self.rays.len().checked_div(channels)?;
        let (rows, columns) =
            if order.is_of_channels { (channels, sequences) } else { (sequences, channels) };
        let ray = |point: usize| {
            let turned = |at: usize, of: usize, backwards: bool| if backwards { of - 1 - at } else { at };
            let row = turned(point / columns, rows, order.backwards[0]);
            let column = turned(point % columns, columns, order.backwards[1]);
            Some(if order.is_of_channels { column * channels + row } else { row * channels + column })
        };
        let words = match order.is_of_channels {
            true => "by the order of the points, a row for each channel",
            false => "by the order of the points",
        };
        Some(self.collected(is_point, ray, words))
    }

    /// Whether the rows of an organised cloud are channels, and not firing sequences; `None` if their numbers are the same.
    pub(super) fn has_rows_of_channels(&self, cloud: &Cloud) -> Option<bool> {
        let Some(channels) = self.channels().filter(|_| self.places == 1) else { return Some(false) };
        let has_channels = cloud.height > 1 && cloud.height as usize == channels;
        if has_channels && cloud.width as usize == channels { None } else { Some(has_channels) }
    }

    /// By direction: rays and points in the sensor's frame, the ray that is nearest in angle. The rays of a beam's returns lie near each
    /// other: there the number of the return tells which one it is.
    pub(super) fn by_direction(
        &self,
        rays: &[(DVec3, DVec3)],
        points: &[DVec3],
        (cloud, is_point): (&Cloud, &[bool]),
    ) -> Assigned {
        let cells = (libm::sqrt(rays.len() as f64) as i32).clamp(1, MAX_CELLS);
        let cell = |direction: DVec3| {
            direction.to_array().map(|part| libm::floor(part * f64::from(cells) / 2.0) as i32)
        };
        let mut grid: HashMap<[i32; 3], Vec<usize>> = HashMap::new();
        for (index, (_, direction)) in rays.iter().enumerate() {
            grid.entry(cell(*direction)).or_default().push(index);
        }
        let beam = |point: usize| {
            let place = points[point];
            let [x, y, z] = cell(place.normalize_or_zero());
            let (mut best, mut next) = ((f64::INFINITY, usize::MAX), f64::INFINITY);
            for k in 0..27 {
                let around = [x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1];
                for &index in grid.get(&around).into_iter().flatten() {
                    let (origin, direction) = rays[index];
                    let from = place - origin;
                    let angle = libm::atan2(from.cross(direction).length(), from.dot(direction));
                    let beam = index / self.places;
                    if beam == best.1 {
                        best.0 = best.0.min(angle);
                    } else if angle < best.0 {
                        (next, best) = (best.0, (angle, beam));
                    } else if angle < next {
                        next = angle;
                    }
                }
            }
            (best.0 * NEARER <= next && best.0.is_finite()).then_some(best.1)
        };
        self.of_beams(cloud, is_point, beam, BY_DIRECTION)
    }

    fn collected(
        &self,
        is_point: &[bool],
        ray: impl Fn(usize) -> Option<usize>,
        by: &'static str,
    ) -> Assigned {
        let mut assigned = Assigned::none(self.rays.len(), by);
        // What is no point takes the places that are left.
        for pass in [true, false] {
            for point in (0..is_point.len()).filter(|&point| is_point[point] == pass) {
                let index = ray(point);
                match index.map(|index| &mut assigned.point_of[index]) {
                    Some(place @ None) => *place = Some(point),
                    _ if pass => {
                        index.into_iter().for_each(|index| *assigned.crowded.entry(index).or_default() += 1);
                        assigned.strays.push(point);
                    }
                    _ => {}
                }
            }
        }
        assigned
    }

    /// Points on the places of their beams: by the numbers of their returns, where the file has them, else one after the other.
    pub(super) fn of_beams(
        &self,
        cloud: &Cloud,
        is_point: &[bool],
        beam: impl Fn(usize) -> Option<usize>,
        by: &'static str,
    ) -> Assigned {
        if self.places == 1 {
            return self.collected(is_point, beam, by);
        }
        let numbers = number_of_return(cloud);
        let mut assigned = Assigned::none(self.rays.len(), by);
        let mut others = Vec::new();
        for point in (0..is_point.len()).filter(|&point| is_point[point]) {
            let Some(beam) = beam(point) else {
                assigned.strays.push(point);
                continue;
            };
            let has_number =
                |&place: &usize| numbers.is_some_and(|of| of.values[point] == self.numbers[place]);
            match self.places_of(beam).find(has_number).map(|place| &mut assigned.point_of[place]) {
                Some(place @ None) => *place = Some(point),
                _ => others.push((beam, point)),
            }
        }
        // A number that no place has tells nothing; and what is no point takes the places that are left.
        let none = (0..is_point.len()).filter(|&point| !is_point[point]);
        others.extend(none.filter_map(|point| Some((beam(point)?, point))));
        for (beam, point) in others {
            let free = self.places_of(beam).find(|&place| assigned.point_of[place].is_none());
            match free.map(|place| &mut assigned.point_of[place]) {
                Some(place) => *place = Some(point),
                None if is_point[point] => {
                    *assigned.crowded.entry(beam).or_default() += 1;
                    assigned.strays.push(point);
                }
                None => {}
            }
        }
        assigned.strays.sort_unstable();
        assigned
    }

    fn places_of(&self, beam: usize) -> std::ops::Range<usize> {
        beam * self.places..(beam + 1) * self.places
    }
}

/// The field that has the number of a point's return.
pub(super) fn number_of_return(cloud: &Cloud) -> Option<&CloudColumn> {
    NUMBERS_OF_RETURNS.into_iter().find_map(|name| cloud.column(name))
}

impl Assigned {
    /// So many rays without a point.
    fn none(rays: usize, by: &'static str) -> Self {
        Self { point_of: vec![None; rays], strays: Vec::new(), crowded: HashMap::new(), by }
    }

    /// Whether so few points belong to no ray that the others can be judged.
    pub(super) fn is_clear(&self, points: usize) -> bool {
        self.strays.len() * 100 <= points * MAX_STRAY_PERCENT
    }

    /// Whether nearly all points have these numbers of returns, one for each place.
    pub(super) fn has_numbers(
        &self,
        numbers: &[f64],
        (column, is_point): (&CloudColumn, &[bool]),
        points: usize,
    ) -> bool {
        let placed = self.point_of.iter().zip(numbers);
        let others = placed.filter(|(point, number)| {
            point.is_some_and(|point| is_point[point] && column.values[point] != **number)
        });
        others.count() * 100 <= points * MAX_STRAY_PERCENT
    }

    /// Whether another rule lays so few of these points otherwise.
    pub(super) fn is_like(&self, other: &Self, points: usize) -> bool {
        let otherwise = self.point_of.iter().zip(&other.point_of).filter(|(a, b)| a.is_some() && a != b);
        otherwise.count() * 100 <= points * MAX_STRAY_PERCENT
    }
}

/// Why points cannot be laid on rays, where nearly each of them has a ray: they are too many for their rays. `None`: that is not why.
pub(super) fn too_many(assigned: &Assigned, points: usize, places: usize) -> Option<Fault> {
    let crowding: usize = assigned.crowded.values().sum();
    let of_no_ray = assigned.strays.len() - crowding;
    let most = places + assigned.crowded.values().max()?;
    if of_no_ray * 100 > points * MAX_STRAY_PERCENT || most > MAX_RETURNS {
        return None;
    }
    let (of, expected) = match places {
        1 => ("ray that has a point", "one point for each ray: this pack asks for one return".to_string()),
        _ => (
            "beam that has its points",
            format!("at most {places} points for each beam: this pack asks for so many returns"),
        ),
    };
    let found = format!(
        "{crowding} of {points} points are of a {of} already, up to {most} points for one, {}",
        assigned.by
    );
    Some(Fault::new("points", found, expected))
}

/// What fields can do to lay points on rays.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum OfFields {
    /// The pack has no times of its rays, or not such that they tell rays apart.
    NotOfPack,
    /// The file does not have them.
    NotOfFile,
    /// Both have them, and they are not the same.
    Others,
}

/// Why points cannot be laid on rays. `fields` is what fields can do, and `of_fields` what those of the file have, in words.
pub(super) fn unclear(strays: usize, points: usize, (fields, of_fields): (OfFields, &str)) -> Fault {
    let by_order = "one point for each ray in their order, NaN where there is none";
    let expected = match fields {
        OfFields::NotOfPack => {
            format!(
                "{by_order}: this pack has no times that tell its rays apart, so fields of the points cannot"
            )
        }
        OfFields::NotOfFile => format!("the fields `ring` (or `channel`) and `time`, or {by_order}"),
        OfFields::Others => {
            format!(
                "the fields `ring` (or `channel`) and `time` to be those of the pack's rays, or {by_order}"
            )
        }
    };
    Fault::new(
        "points",
        format!("{strays} of {points} points belong to no ray that is known, or share one{of_fields}"),
        expected,
    )
}
