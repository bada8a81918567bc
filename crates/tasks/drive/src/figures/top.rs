//! Figures 13 and 16: the obstacle map and the navigator map from above, over the elevations of the local map.

use glam::{DVec2, DVec3};
use raypencil_report::{Anchor, Colour, Drawing, INK, Mark, SOFT, Scale, Tick, axis_from_offset, draw_axes};
use raypencil_rover::{GridPoint, Label, LabelledVector, ObstacleMap, Vehicle};

use crate::figures::elevation_key::draw_elevation_key;
use crate::figures::figure::{Figure, MARGINS_PX, PLOT_SIDE_PX};
use crate::figures::known_extent::{KnownExtent, stride};
use crate::job::DriveJob;
use crate::labels::label_word;
use crate::run::DriveRun;

/// Maximum number of the map's cells along either side.
const MAX_CELLS_ACROSS: i64 = 1000;

/// Both figures of the last obstacle map; none if the drive made no obstacle map.
pub(super) fn map_figures(job: &DriveJob, run: &DriveRun) -> Vec<Figure> {
    let Some((frame, obstacles, vectors)) = &run.obstacles else { return Vec::new() };
    // The elevations below are those at the end; the obstacle map may be of an earlier frame.
    let when = if run.frames.len() as u64 == frame + 1 {
        "at the end".to_string()
    } else {
        format!("of frame {frame}")
    };
    let believed = run.frames.iter().find(|one| one.index == *frame).map_or(run.believed, |one| one.believed);
    let forward = believed.rotate(DVec3::X).truncate();
    let page = |title: &str| {
        // The figure covers the whole grid, wherever sectors end, so that all figures of a drive have one scale.
        let ends = obstacles.sectors.iter().map(|sector| sector.point);
        let reach: Vec<DVec2> = ends
            .map(|end| obstacles.centre + direction(obstacles, end) * job.plan.grid.last)
            .chain(vectors.iter().flat_map(|vector| [vector.from, vector.to]))
            .collect();
        let mut top = TopView::around(run, &reach, obstacles.centre, format!("{title} {when}"));
        top.draw_vehicle(&job.plan.vehicle, obstacles.centre, forward);
        top
    };
    vec![
        Figure {
            stem: "obstacle-map",
            caption: format!(
                "The obstacle map {when}: each sector up to where testing stopped, and why. (Figure 13)"
            ),
            drawing: obstacle_figure(page("Obstacle map"), obstacles, job.plan.grid.first),
        },
        Figure {
            stem: "navigator-map",
            caption: format!(
                "The navigator map {when}: a labelled vector from sector to sector. (Figure 16)"
            ),
            drawing: navigator_figure(page("Navigator map"), vectors),
        },
    ]
}

/// Unit vector from the middle of an obstacle map to a point.
fn direction(obstacles: &ObstacleMap, point: DVec2) -> DVec2 {
    (point - obstacles.centre).normalize_or_zero()
}

/// Draws each sector from the first radius, metres, to its end, in the colour of its label.
fn obstacle_figure(mut top: TopView, obstacles: &ObstacleMap, first: f64) -> Drawing {
    for sector in &obstacles.sectors {
        let near = obstacles.centre + direction(obstacles, sector.point) * first.min(sector.radius);
        top.line(&[near, sector.point], label_colour(sector.label), 1.3);
    }
    for sector in &obstacles.sectors {
        top.dot(sector.point, label_colour(sector.label), 4.0);
    }
    top.drawing
}

/// Draws each vector in the colour of its label.
fn navigator_figure(mut top: TopView, vectors: &[LabelledVector]) -> Drawing {
    for vector in vectors {
        top.line(&[vector.from, vector.to], label_colour(vector.label), 2.5);
    }
    for end in vectors.iter().flat_map(|vector| [(vector.from, vector.label), (vector.to, vector.label)]) {
        top.dot(end.0, label_colour(end.1), 2.5);
    }
    top.drawing
}

fn label_colour(label: Label) -> Colour {
    match label {
        Label::Obstacle => [200, 40, 30],
        Label::Unknown => [208, 140, 0],
        Label::Visibility => [0, 104, 201],
    }
}

/// View from above, with x to the right and y upwards, over the map's elevations in grey.
struct TopView {
    drawing: Drawing,
    /// Global x and y of the lower left corner, metres.
    low: DVec2,
    pixels_per_metre: f64,
    /// Height of the plot, pixels.
    height: f64,
}

impl TopView {
    /// View of all `points` and of the vehicle at `centre`, with margins, axes and keys.
    fn around(run: &DriveRun, points: &[DVec2], centre: DVec2, title: String) -> Self {
        let near = [centre - DVec2::splat(1.2), centre + DVec2::splat(1.2)];
        let [low, high] = points.iter().fold(near, |[low, high], &point| {
            [low.min(point - DVec2::splat(0.6)), high.max(point + DVec2::splat(0.6))]
        });
        let pixels_per_metre = PLOT_SIDE_PX / (high - low).max_element();
        let size = (high - low) * pixels_per_metre;
        let [left, above, right, below] = MARGINS_PX;
        let (width, height) = ((left + size.x + right).ceil(), (above + size.y + below).ceil());
        let drawing = Drawing::new(width as u32, height as u32, &title);
        let mut top = Self { drawing, low, pixels_per_metre, height: size.y };
        let [lowest, highest] = KnownExtent::of(&run.map).map_or([0.0; 2], |extent| extent.elevations);
        let elevations = Scale::linear(lowest, highest);
        top.draw_ground(run, low, high, elevations);

        let (corner, opposite) = (top.page(DVec2::new(low.x, high.y)), top.page(DVec2::new(high.x, low.y)));
        let rim = vec![corner, [opposite[0], corner[1]], opposite, [corner[0], opposite[1]], corner];
        top.drawing.line(rim, SOFT, 1.0);
        let (columns, across) = axis_from_offset("x", "m", [low.x, high.x], 7);
        let (rows, upwards) = axis_from_offset("y", "m", [low.y, high.y], 7);
        let rows = rows.into_iter().map(|tick| Tick { at: 1.0 - tick.at, ..tick }).collect();
        draw_axes(&mut top.drawing, corner, size.to_array(), columns, rows, [&across, &upwards]);
        let x = left + size.x + 14.0;
        top.draw_label_key(x);
        draw_elevation_key(&mut top.drawing, [x, above + 104.0], elevations, grey);
        top.drawing.text([x, above + 290.0], "white: unknown", Anchor::Start, SOFT);
        top
    }

    /// Draws the known cells that lie wholly between `low` and `high`, global x and y in metres.
    fn draw_ground(&mut self, run: &DriveRun, low: DVec2, high: DVec2, scale: Scale) {
        let map = &run.map;
        let (first, last) = (map.nearest(low), map.nearest(high));
        let first = GridPoint { i: first.i + 1, j: first.j + 1 };
        let last = GridPoint { i: last.i - 1, j: last.j - 1 };
        let (mut cells, half) = (Vec::new(), DVec2::splat(0.5 * map.size().spacing));
        // Fine maps are subsampled; on a coarse map no point may fall inside.
        let step = stride(first, last, MAX_CELLS_ACROSS);
        let across = (last.i - first.i).max(-step) / step + 1;
        for j in (0..=(last.j - first.j).max(-step) / step).rev() {
            for i in 0..across {
                let point = GridPoint { i: first.i + i * step, j: first.j + j * step };
                cells.push(map.elevation(point).map(|z| grey(scale.fraction(z))));
            }
        }
        let (corner, opposite) = (map.place(first) - half, map.place(last) + half);
        let at = self.page(DVec2::new(corner.x, opposite.y));
        let end = self.page(DVec2::new(opposite.x, corner.y));
        if !cells.is_empty() {
            let size = [end[0] - at[0], end[1] - at[1]];
            self.drawing.marks.push(Mark::Cells { at, size, columns: across as usize, cells });
        }
    }

    /// Position on the page, pixels, of global x and y.
    fn page(&self, p: DVec2) -> [f64; 2] {
        let [left, above, ..] = MARGINS_PX;
        let q = (p - self.low) * self.pixels_per_metre;
        [left + q.x, above + self.height - q.y]
    }

    fn line(&mut self, points: &[DVec2], colour: Colour, width: f64) {
        let points = points.iter().map(|&point| self.page(point)).collect();
        self.drawing.line(points, colour, width);
    }

    /// Draws a square of this half side, pixels.
    fn dot(&mut self, point: DVec2, colour: Colour, half: f64) {
        let [x, y] = self.page(point);
        let corners =
            vec![[x - half, y - half], [x + half, y - half], [x + half, y + half], [x - half, y + half]];
        self.drawing.polygon(corners, colour, None);
    }

    /// Draws the vehicle from above: its body, and its wheels, which are visible through it.
    fn draw_vehicle(&mut self, vehicle: &Vehicle, centre: DVec2, forward: DVec2) {
        let (forward, left) = (forward.normalize_or_zero(), forward.normalize_or_zero().perp());
        let rectangle = |middle: DVec2, long: f64, wide: f64| {
            [(1.0, 1.0), (1.0, -1.0), (-1.0, -1.0), (-1.0, 1.0)]
                .map(|(x, y)| middle + forward * (0.5 * x * long) + left * (0.5 * y * wide))
        };
        let mut parts = vec![(rectangle(centre, vehicle.wheelbase, 0.6 * vehicle.track), [250, 250, 248])];
        for (x, y) in [(0.5, 0.5), (0.5, -0.5), (-0.5, 0.5), (-0.5, -0.5)] {
            let hub = centre + forward * (x * vehicle.wheelbase) + left * (y * vehicle.track);
            parts.push((rectangle(hub, 2.0 * vehicle.wheel_radius, vehicle.wheel_width), [70, 74, 80]));
        }
        for (corners, fill) in parts {
            let points = corners.iter().map(|&corner| self.page(corner)).collect();
            self.drawing.polygon(points, fill, Some(INK));
        }
        self.line(&[centre, centre + forward * (0.5 * vehicle.wheelbase)], INK, 1.5);
    }

    fn draw_label_key(&mut self, x: f64) {
        for (line, label) in [Label::Obstacle, Label::Unknown, Label::Visibility].into_iter().enumerate() {
            let y = MARGINS_PX[1] + 14.0 + 20.0 * line as f64;
            self.drawing.line(vec![[x, y], [x + 18.0, y]], label_colour(label), 4.0);
            let words = if label == Label::Visibility { "visibility limit" } else { label_word(label) };
            self.drawing.text([x + 26.0, y + 4.0], words, Anchor::Start, INK);
        }
    }
}

/// Grey at a fraction of the elevations' scale; never white, the colour of unknown cells.
fn grey(fraction: f64) -> Colour {
    [(164.0 + 76.0 * fraction) as u8; 3]
}
