//! Where each ray of a page stands: which rows and columns, and what these are.

use glam::DVec3;
use raypencil_explorer::{RasterAxes, RasterAxis};
use raypencil_scene::pattern::Mounting;
use raypencil_scene::{CastRay, NamedRaySet};

use crate::cloud::ranks;

/// What a page knows of a sensor's scan beyond its rays.
#[derive(Debug, Clone, Copy)]
pub struct PageScan<'a> {
    /// Its name.
    pub name: &'a str,
    /// Time at which each ray is fired, seconds.
    pub times: Option<&'a [f64]>,
    /// Elevations of the channels of a spinning head along the second dimension, degrees.
    pub elevations_deg: Option<&'a [f64]>,
    /// Where the sensor stands in the mesh's frame.
    pub mounting: &'a Mounting,
}

impl<'a> PageScan<'a> {
    /// What a set knows.
    pub fn of(set: &'a NamedRaySet) -> Self {
        Self {
            name: &set.name,
            times: set.times.as_deref(),
            elevations_deg: set.elevations_deg.as_deref(),
            mounting: &set.mounting,
        }
    }

    /// Direction of a ray in the sensor's own frame when it is fired.
    fn direction(&self, index: usize, ray: &CastRay) -> DVec3 {
        let pose = self.times.and_then(|times| self.mounting.at(times[index]));
        pose.unwrap_or_else(|| self.mounting.first()).inverse().rotate(ray.direction)
    }

    /// Rank of each channel by its elevation, the lowest is 0.
    pub(crate) fn rings(&self) -> Option<Vec<u64>> {
        self.elevations_deg.map(ranks)
    }
}

/// Channels, the highest first.
fn by_elevation(elevations: &[f64]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..elevations.len()).collect();
    order.sort_by(|&a, &b| elevations[b].total_cmp(&elevations[a]));
    order
}

/// Where each ray stands on the page.
pub(crate) struct Layout {
    pub(crate) name: String,
    pub(crate) width: u32,
    pub(crate) height: u32,
    /// The ray of each cell; `None` behind the last one.
    pub(crate) rays: Vec<Option<usize>>,
    pub(crate) words: String,
    /// What columns and rows are, for a spinning head.
    pub(crate) axes: Option<RasterAxes>,
}

impl Layout {
    pub(crate) fn of(shape: &[u64], rays: &[CastRay], scan: Option<&PageScan<'_>>) -> Self {
        let name = scan.map_or("rays", |scan| scan.name).to_string();
        let of_head = scan.and_then(|scan| Some((shape, scan, scan.elevations_deg?)));
        if let Some((&[firings, channels], scan, elevations)) = of_head {
            let order = by_elevation(elevations);
            let of_rows = order.iter().flat_map(|channel| {
                (0..firings as usize).map(move |firing| Some(firing * channels as usize + channel))
            });
            return Self {
                name,
                width: firings as u32,
                height: channels as u32,
                rays: of_rows.collect(),
                words: "A row for each channel, the highest elevation on top: ring 0 is the lowest row. A column for each firing \
                        sequence, in the order of time; its azimuth counts from the sensor's x axis to the left."
                    .into(),
                axes: Some(RasterAxes {
                    columns: RasterAxis {
                        name: "azimuth".into(),
                        unit: "°".into(),
                        at: azimuths_deg(scan, rays, firings as usize, channels as usize),
                        turns: true,
                    },
                    rows: RasterAxis {
                        name: "elevation".into(),
                        unit: "°".into(),
                        at: order.iter().map(|&channel| elevations[channel]).collect(),
                        turns: false,
                    },
                }),
            };
        }
        let all: u64 = shape.iter().product();
        let (width, words) = match shape {
            [] | [_] => {
                let side = (1..).find(|side: &u64| side * side >= all).unwrap_or(1).max(1);
                (side, "The rays in their order, row by row.")
            }
            [_, rest @ ..] => (
                rest.iter().product::<u64>().max(1),
                "A row for each index of the first dimension; the others follow each other along it.",
            ),
        };
        let height = all.div_ceil(width).max(1);
        let rays = (0..(width * height) as usize).map(|ray| (ray < all as usize).then_some(ray));
        Self {
            name,
            width: width as u32,
            height: height as u32,
            rays: rays.collect(),
            words: words.into(),
            axes: None,
        }
    }

    /// The same with at most `most` cells. A cell then stands for neighbouring rays: for the one of the highest rank; of equals
    /// for the one in their middle.
    pub(crate) fn thinned(self, most: usize, rank: impl Fn(usize) -> u8) -> Self {
        let (width, height) = (self.width as usize, self.height as usize);
        if width * height <= most.max(1) {
            return self;
        }
        let share = (width * height).div_ceil(most.max(1));
        // A head's channels stay apart: only sequences are joined. Of a raster rows and columns are joined alike.
        let down = match self.axes {
            Some(_) if height <= most => 1,
            _ => (1..=height).find(|down| down * down >= share).unwrap_or(height),
        };
        let across =
            (1..=width).find(|across| width.div_ceil(*across) * height.div_ceil(down) <= most.max(1));
        let across = across.unwrap_or(width);
        let [columns, rows] = [width.div_ceil(across), height.div_ceil(down)];
        let middle = |index: usize, step: usize, count: usize| (index * step + step / 2).min(count - 1);
        let of_cell = |cell: usize| {
            let [i, j] = [cell % columns, cell / columns];
            let at = |x: usize, y: usize| self.rays[y * width + x];
            let mut chosen = at(middle(i, across, width), middle(j, down, height));
            for y in j * down..((j + 1) * down).min(height) {
                for x in i * across..((i + 1) * across).min(width) {
                    let is_worse = |ray: usize| chosen.is_none_or(|chosen| rank(ray) > rank(chosen));
                    chosen = at(x, y).filter(|ray| is_worse(*ray)).or(chosen);
                }
            }
            chosen
        };
        let rays = (0..columns * rows).map(of_cell).collect();
        let some = |axis: &RasterAxis, step: usize, count: usize| RasterAxis {
            at: (0..count.div_ceil(step)).map(|index| axis.at[middle(index, step, count)]).collect(),
            ..axis.clone()
        };
        let axes = self.axes.as_ref().map(|axes| RasterAxes {
            columns: some(&axes.columns, across, width),
            rows: some(&axes.rows, down, height),
        });
        let words = format!(
            "{} Each cell stands for {across} x {down} rays: the one that is worst, or that in their middle.",
            self.words
        );
        Self { width: columns as u32, height: rows as u32, rays, words, axes, name: self.name }
    }
}

/// Azimuth of each firing sequence, degrees, without jumps of a whole turn: that of the first channel that does not look straight
/// up or down.
fn azimuths_deg(scan: &PageScan<'_>, rays: &[CastRay], firings: usize, channels: usize) -> Vec<f64> {
    let direction = |index: usize| scan.direction(index, &rays[index]);
    let is_level = |channel: &usize| {
        let v = direction(*channel);
        v.x * v.x + v.y * v.y > 1e-6 * v.length_squared()
    };
    let channel = (0..channels).find(is_level).unwrap_or(0);
    let mut before: Option<f64> = None;
    let azimuth = |firing: usize| {
        let v = direction(firing * channels + channel);
        let azimuth = libm::atan2(v.y, v.x).to_degrees();
        let near = before.map_or(azimuth, |before| azimuth - 360.0 * ((azimuth - before) / 360.0).round());
        before = Some(near);
        near
    };
    (0..firings).map(azimuth).collect()
}
