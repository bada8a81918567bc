//! Figures 13 and 16: the obstacle map and the navigator map from above, over the elevations of the local map.

use glam::{DVec2, DVec3};

use crate::figures::axes::{axes, elevations};
use crate::figures::{Figure, MARGIN, PLOT, colour, known, stride, word};
use crate::job::DriveJob;
use crate::run::DriveRun;
use raypencil_report::{Anchor, Colour, Drawing, INK, Mark, SOFT, Scale, Tick};
use raypencil_rover::{GridPoint, Label, LabelledVector, ObstacleMap, Vehicle};

/// Cells of the map, along either side.
const MOST_CELLS: i64 = 1000;

/// Both figures of the last obstacle map; none if there was none.
pub(super) fn maps(job: &DriveJob, run: &DriveRun) -> Vec<Figure> {
    let Some((frame, obstacles, vectors)) = &run.obstacles else { return Vec::new() };
    // Of a frame that is not the last, the map has gone on since.
    let when = if run.frames.len() as u64 == frame + 1 {
        "at the end".to_string()
    } else {
        format!("of frame {frame}")
    };
    let believed = run.frames.iter().find(|one| one.index == *frame).map_or(run.believed, |one| one.believed);
    let forward = believed.rotate(DVec3::X).truncate();
    let page = |title: &str| {
        // As far as the grid goes, wherever sectors end: figures of one drive have one scale.
        let ends = obstacles.sectors.iter().map(|sector| sector.point);
        let reach: Vec<DVec2> = ends
            .map(|end| obstacles.centre + away(obstacles, end) * job.plan.grid.last)
            .chain(vectors.iter().flat_map(|vector| [vector.from, vector.to]))
            .collect();
        let mut top = Top::around(run, &reach, obstacles.centre, format!("{title} {when}"));
        top.vehicle(&job.plan.vehicle, obstacles.centre, forward);
        top
    };
    vec![
        Figure {
            stem: "obstacle-map",
            caption: format!(
                "The obstacle map {when}: each sector up to where testing stopped, and why. (Figure 13)"
            ),
            drawing: obstacle_map(page("Obstacle map"), obstacles, job.plan.grid.first),
        },
        Figure {
            stem: "navigator-map",
            caption: format!(
                "The navigator map {when}: a labelled vector from sector to sector. (Figure 16)"
            ),
            drawing: navigator_map(page("Navigator map"), vectors),
        },
    ]
}

/// The direction of a place from the middle of an obstacle map.
fn away(obstacles: &ObstacleMap, place: DVec2) -> DVec2 {
    (place - obstacles.centre).normalize_or_zero()
}

/// Each sector from the first radius to its end, in the colour of its label.
fn obstacle_map(mut top: Top, obstacles: &ObstacleMap, first: f64) -> Drawing {
    for sector in &obstacles.sectors {
        let near = obstacles.centre + away(obstacles, sector.point) * first.min(sector.radius);
        top.line(&[near, sector.point], colour(sector.label), 1.3);
    }
    for sector in &obstacles.sectors {
        top.dot(sector.point, colour(sector.label), 4.0);
    }
    top.drawing
}

fn navigator_map(mut top: Top, vectors: &[LabelledVector]) -> Drawing {
    for vector in vectors {
        top.line(&[vector.from, vector.to], colour(vector.label), 2.5);
    }
    for end in vectors.iter().flat_map(|vector| [(vector.from, vector.label), (vector.to, vector.label)]) {
        top.dot(end.0, colour(end.1), 2.5);
    }
    top.drawing
}

/// A view from above, x to the right, y upwards, the map's elevations in grey.
struct Top {
    drawing: Drawing,
    low: DVec2,
    share: f64,
    height: f64,
}

impl Top {
    fn around(run: &DriveRun, points: &[DVec2], centre: DVec2, title: String) -> Self {
        let near = [centre - DVec2::splat(1.2), centre + DVec2::splat(1.2)];
        let [low, high] = points.iter().fold(near, |[low, high], &point| {
            [low.min(point - DVec2::splat(0.6)), high.max(point + DVec2::splat(0.6))]
        });
        let share = PLOT / (high - low).max_element();
        let size = (high - low) * share;
        let [left, above, right, below] = MARGIN;
        let (width, height) = ((left + size.x + right).ceil(), (above + size.y + below).ceil());
        let drawing = Drawing::new(width as u32, height as u32, &title);
        let mut top = Self { drawing, low, share, height: size.y };
        let heights = known(&run.map).map_or([0.0; 2], |(heights, _)| heights);
        let scale = Scale::linear(heights[0], heights[1]);
        top.ground(run, low, high, scale);

        let (corner, opposite) = (top.page(DVec2::new(low.x, high.y)), top.page(DVec2::new(high.x, low.y)));
        let rim = vec![corner, [opposite[0], corner[1]], opposite, [corner[0], opposite[1]], corner];
        top.drawing.line(rim, SOFT, 1.0);
        let columns = Scale::linear(low.x, high.x).ticks(7);
        let rows = Scale::linear(low.y, high.y).ticks(7).into_iter();
        let rows = rows.map(|tick| Tick { at: 1.0 - tick.at, ..tick }).collect();
        axes(&mut top.drawing, corner, size.to_array(), columns, rows, ["x, m", "y, m"]);
        let x = left + size.x + 14.0;
        top.labels(x);
        elevations(&mut top.drawing, [x, above + 104.0], scale, grey);
        top.drawing.text([x, above + 290.0], "white: unknown", Anchor::Start, SOFT);
        top
    }

    /// What is known of the ground, in whole cells within the frame.
    fn ground(&mut self, run: &DriveRun, low: DVec2, high: DVec2, scale: Scale) {
        let map = &run.map;
        let (first, last) = (map.nearest(low), map.nearest(high));
        let first = GridPoint { i: first.i + 1, j: first.j + 1 };
        let last = GridPoint { i: last.i - 1, j: last.j - 1 };
        let (mut cells, half) = (Vec::new(), DVec2::splat(0.5 * map.size().spacing));
        // Of a fine map some points stand for all; of a coarse one none may be within.
        let each = stride(first, last, MOST_CELLS);
        let across = (last.i - first.i).max(-each) / each + 1;
        for j in (0..=(last.j - first.j).max(-each) / each).rev() {
            for i in 0..across {
                let point = GridPoint { i: first.i + i * each, j: first.j + j * each };
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

    fn page(&self, p: DVec2) -> [f64; 2] {
        let [left, above, ..] = MARGIN;
        let q = (p - self.low) * self.share;
        [left + q.x, above + self.height - q.y]
    }

    fn line(&mut self, points: &[DVec2], colour: Colour, width: f64) {
        let points = points.iter().map(|&point| self.page(point)).collect();
        self.drawing.line(points, colour, width);
    }

    /// A square of that half side, pixels.
    fn dot(&mut self, place: DVec2, colour: Colour, half: f64) {
        let [x, y] = self.page(place);
        let corners =
            vec![[x - half, y - half], [x + half, y - half], [x + half, y + half], [x - half, y + half]];
        self.drawing.polygon(corners, colour, None);
    }

    /// The vehicle from above: its body, and its wheels, seen through it.
    fn vehicle(&mut self, vehicle: &Vehicle, centre: DVec2, forward: DVec2) {
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

    /// What the colours of labels mean.
    fn labels(&mut self, x: f64) {
        for (line, label) in [Label::Obstacle, Label::Unknown, Label::Visibility].into_iter().enumerate() {
            let y = MARGIN[1] + 14.0 + 20.0 * line as f64;
            self.drawing.line(vec![[x, y], [x + 18.0, y]], colour(label), 4.0);
            let words = if label == Label::Visibility { "visibility limit" } else { word(label) };
            self.drawing.text([x + 26.0, y + 4.0], words, Anchor::Start, INK);
        }
    }
}

/// The grey of a place between the lowest and the highest ground; never white, which is unknown.
fn grey(place: f64) -> Colour {
    [(164.0 + 76.0 * place) as u8; 3]
}
