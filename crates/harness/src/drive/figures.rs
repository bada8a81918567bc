//! Figures in the spirit of the paper's 11 to 16: the camera's view, the local map, the obstacle map, the navigator map.

use glam::{DVec2, DVec3};
use raypencil_rover::{GridPoint, Label, LocalMap, Vehicle};

use super::drawing::{Anchor, Colour, Drawing, INK, LETTERS, Mark, SOFT};
use super::job::DriveJob;
use super::run::DriveRun;
use super::view::{BEAM_COLOURS, View};
use crate::output::scale::Scale;

/// A figure, the name of its files and what it shows.
pub(super) struct Figure {
    pub stem: &'static str,
    pub caption: String,
    pub drawing: Drawing,
}

/// Side of a plot, pixels.
const PLOT: f64 = 560.0;
/// Around it: left, above, right, below.
const MARGIN: [f64; 4] = [64.0, 40.0, 180.0, 56.0];
const GRID: Colour = [216, 213, 206];

/// All of them. Without an obstacle map there are two.
pub(super) fn figures(job: &DriveJob, run: &DriveRun) -> Vec<Figure> {
    let caption = |stem, caption: String, drawing| Figure { stem, caption, drawing };
    let mut all = vec![
        caption(
            "camera-view",
            "What the camera sees at the end, stripes in the colours of their beams. (Figures 11 and 14)"
                .into(),
            camera_view(&run.last_view, job.plan.rig.beams.len()),
        ),
        caption(
            "local-map",
            format!(
                "The local terrain map at the end, {} m between its points; what is not known is open. (Figures 12 and 15)",
                job.plan.map.spacing
            ),
            relief(&run.map),
        ),
    ];
    if let Some((frame, obstacles, vectors)) = &run.obstacles {
        // Of a frame that is not the last, the map has gone on since.
        let when = if run.frames.len() as u64 == frame + 1 {
            "at the end".into()
        } else {
            format!("of frame {frame}")
        };
        let believed =
            run.frames.iter().find(|one| one.index == *frame).map_or(run.believed, |one| one.believed);
        // As far as the grid goes, wherever sectors end: figures of one drive have one scale.
        let unit = |point: DVec2| (point - obstacles.centre).normalize_or_zero();
        let reach: Vec<DVec2> = obstacles
            .sectors
            .iter()
            .map(|sector| obstacles.centre + unit(sector.point) * job.plan.grid.last)
            .collect();
        let mut top = Top::around(run, &reach, obstacles.centre);
        top.drawing.title = format!("Obstacle map {when}");
        top.vehicle(&job.plan.vehicle, obstacles.centre, believed.rotate(DVec3::X).truncate());
        let first = job.plan.grid.first;
        for sector in &obstacles.sectors {
            let near = obstacles.centre + unit(sector.point) * first.min(sector.radius);
            let ends = [near, sector.point];
            top.line(&ends, SOFT, 0.8);
        }
        for sector in &obstacles.sectors {
            top.dot(sector.point, colour(sector.label), 4.0);
        }
        top.labels();
        all.push(caption(
            "obstacle-map",
            format!("The obstacle map {when}: each sector up to where testing stopped, and why. (Figure 13)"),
            top.drawing,
        ));

        let mut top = Top::around(run, &reach, obstacles.centre);
        top.drawing.title = format!("Navigator map {when}");
        top.vehicle(&job.plan.vehicle, obstacles.centre, believed.rotate(DVec3::X).truncate());
        for vector in vectors {
            top.line(&[vector.from, vector.to], colour(vector.label), 2.5);
        }
        for vector in vectors {
            top.dot(vector.from, colour(vector.label), 2.0);
        }
        top.labels();
        all.push(caption(
            "navigator-map",
            format!("The navigator map {when}: a labelled vector from sector to sector. (Figure 16)"),
            top.drawing,
        ));
    }
    all
}

/// The colour of a label, in all figures.
fn colour(label: Label) -> Colour {
    match label {
        Label::Obstacle => [200, 40, 30],
        Label::Unknown => [208, 140, 0],
        Label::Visibility => [0, 104, 201],
    }
}

/// The word of a label, in all files.
pub(super) fn word(label: Label) -> &'static str {
    match label {
        Label::Obstacle => "obstacle",
        Label::Unknown => "unknown",
        Label::Visibility => "visibility",
    }
}

fn camera_view(view: &View, beams: usize) -> Drawing {
    let share = PLOT / f64::from(view.width.max(view.height));
    let [width, height] = [view.width, view.height].map(|side| share * f64::from(side));
    let [left, above, right, below] = MARGIN;
    let page = [left + width + right, above + height + below].map(|side| side.ceil() as u32);
    let mut drawing = Drawing::new(page[0], page[1], "Camera view with stripes");
    drawing.marks.push(Mark::Cells {
        at: [left, above],
        size: [width, height],
        columns: view.width as usize,
        cells: view.pixels.iter().map(|&pixel| Some(pixel)).collect(),
    });
    let [columns, rows] = view.camera.map(|side| Scale::linear(0.0, f64::from(side)).ticks(6));
    for tick in columns {
        let x = left + tick.at * width;
        drawing.line(vec![[x, above + height], [x, above + height + 5.0]], SOFT, 1.0);
        drawing.text([x, above + height + 19.0], tick.label, Anchor::Middle, SOFT);
    }
    for tick in rows {
        let y = above + tick.at * height;
        drawing.line(vec![[left - 5.0, y], [left, y]], SOFT, 1.0);
        drawing.text([left - 8.0, y + 0.35 * LETTERS], tick.label, Anchor::End, SOFT);
    }
    drawing.text([left + 0.5 * width, above + height + 40.0], "pixel column", Anchor::Middle, INK);
    drawing.text([6.0, above - 12.0], "pixel row", Anchor::Start, INK);
    for beam in 0..beams {
        let y = above + 14.0 + 20.0 * beam as f64;
        let x = left + width + 14.0;
        drawing.line(vec![[x, y], [x + 22.0, y]], BEAM_COLOURS[beam % BEAM_COLOURS.len()], 3.0);
        drawing.text([x + 30.0, y + 4.0], format!("beam {beam}"), Anchor::Start, INK);
    }
    drawing
}

/// The least and the greatest known elevation, and the grid points that hold all that is known.
fn known(map: &LocalMap) -> Option<([f64; 2], [GridPoint; 2])> {
    let mut found: Option<([f64; 2], [GridPoint; 2])> = None;
    for point in map.points() {
        let Some(z) = map.elevation(point) else { continue };
        let (heights, [low, high]) = found.get_or_insert(([z, z], [point, point]));
        *heights = [heights[0].min(z), heights[1].max(z)];
        *low = GridPoint { i: low.i.min(point.i), j: low.j.min(point.j) };
        *high = GridPoint { i: high.i.max(point.i), j: high.j.max(point.j) };
    }
    found
}

/// Lines of a relief's net, along either side; more cannot be told apart.
const MOST_ACROSS: i64 = 240;
/// Cells of a map from above, along either side.
const MOST_CELLS: i64 = 1000;

/// From how many grid points one is drawn, so that there are at most so many along either side.
fn stride(low: GridPoint, high: GridPoint, most: i64) -> i64 {
    let longest = (high.i - low.i).max(high.j - low.j).max(0);
    longest / most + 1
}

/// Where the relief is looked at from: so far to the right of behind, and so far above the horizon, radians.
const ASIDE: f64 = 0.45;
const ABOVE: f64 = 0.65;

/// Cells between four known points as a net seen from behind and above, far ones first; all others are open.
fn relief(map: &LocalMap) -> Drawing {
    let mut drawing = Drawing::new(900, 640, "Local terrain map");
    let Some(([lowest, highest], [low, high])) = known(map) else {
        drawing.text([450.0, 320.0], "nothing is known", Anchor::Middle, SOFT);
        return drawing;
    };
    let ((sin_a, cos_a), (sin_e, cos_e)) = (libm::sincos(ASIDE), libm::sincos(ABOVE));
    // x goes away from whoever looks, y to the left.
    let turned = |p: DVec3| {
        let (away, right) = (p.x * cos_a + p.y * sin_a, p.x * sin_a - p.y * cos_a);
        (right, away * sin_e + p.z * cos_e, away)
    };
    let corner = |i: i64, j: i64, z: f64| map.place(GridPoint { i, j }).extend(z);
    let base = [(low.i, low.j), (high.i, low.j), (high.i, high.j), (low.i, high.j)];
    let ends = base.iter().flat_map(|&(i, j)| [lowest, highest].map(|z| turned(corner(i, j, z))));
    let (mut least, mut most) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for (right, up, _) in ends {
        least = [least[0].min(right), least[1].min(up)];
        most = [most[0].max(right), most[1].max(up)];
    }
    let span = |axis: usize| (most[axis] - least[axis]).max(1e-9);
    let share = (760.0 / span(0)).min(500.0 / span(1));
    let offset = [450.0 - 0.5 * share * span(0), 300.0 + 0.5 * share * span(1)];
    let page = |p: DVec3| {
        let (right, up, _) = turned(p);
        [offset[0] + share * (right - least[0]), offset[1] - share * (up - least[1])]
    };

    let mut rim: Vec<_> = base.iter().map(|&(i, j)| page(corner(i, j, lowest))).collect();
    rim.push(rim[0]);
    drawing.line(rim, GRID, 1.0);
    let mut cells = Vec::new();
    let each = stride(low, high, MOST_ACROSS);
    for j in (low.j..high.j).step_by(each as usize) {
        for i in (low.i..high.i).step_by(each as usize) {
            let four = [(i, j), (i + each, j), (i + each, j + each), (i, j + each)];
            let corners = four.map(|(i, j)| Some(corner(i, j, map.elevation(GridPoint { i, j })?)));
            if let [Some(a), Some(b), Some(c), Some(d)] = corners {
                cells.push([a, b, c, d]);
            }
        }
    }
    cells.sort_by(|p, q| turned(q[0]).2.total_cmp(&turned(p[0]).2));
    let light = DVec3::new(-0.5, 0.35, 0.8).normalize();
    for [a, b, c, d] in cells {
        let grey = 0.5 + 0.5 * (c - a).cross(d - b).normalize_or_zero().dot(light).max(0.0);
        let fill = [1.0, 0.96, 0.9].map(|part| (255.0 * (grey * part).clamp(0.0, 1.0)) as u8);
        drawing.polygon([a, b, c, d].map(page).to_vec(), fill, Some([120, 112, 104]));
    }
    // Metres along the two sides that are nearest.
    let (from, to) = (map.place(low), map.place(high));
    for tick in Scale::linear(from.x, to.x).ticks(8) {
        let at = page(DVec3::new(from.x + tick.at * (to.x - from.x), from.y, lowest));
        drawing.text([at[0] + 6.0, at[1] + 14.0], tick.label, Anchor::Start, SOFT);
    }
    for tick in Scale::linear(from.y, to.y).ticks(6) {
        let at = page(DVec3::new(from.x, from.y + tick.at * (to.y - from.y), lowest));
        drawing.text([at[0] - 4.0, at[1] + 16.0], tick.label, Anchor::End, SOFT);
    }
    let words = format!(
        "x to the back, y to the left, metres; elevations {lowest:.2} to {highest:.2} m, drawn to scale"
    );
    drawing.text([450.0, 620.0], words, Anchor::Middle, INK);
    drawing
}

/// A view from above, x to the right, y upwards, the map's elevations in grey.
struct Top {
    drawing: Drawing,
    low: DVec2,
    share: f64,
    height: f64,
}

impl Top {
    fn around(run: &DriveRun, points: &[DVec2], centre: DVec2) -> Self {
        let near = [centre - DVec2::splat(1.2), centre + DVec2::splat(1.2)];
        let [low, high] = points.iter().fold(near, |[low, high], &point| {
            [low.min(point - DVec2::splat(0.6)), high.max(point + DVec2::splat(0.6))]
        });
        let share = PLOT / (high - low).max_element();
        let size = (high - low) * share;
        let [left, above, right, below] = MARGIN;
        let (width, height) = ((left + size.x + right).ceil(), (above + size.y + below).ceil());
        let mut top =
            Self { drawing: Drawing::new(width as u32, height as u32, ""), low, share, height: size.y };

        let map = &run.map;
        let heights = known(map).map_or([0.0; 2], |(heights, _)| heights);
        // Whole cells within the frame.
        let (first, last) = (map.nearest(low), map.nearest(high));
        let first = GridPoint { i: first.i + 1, j: first.j + 1 };
        let last = GridPoint { i: last.i - 1, j: last.j - 1 };
        let scale = Scale::linear(heights[0], heights[1]);
        let grey = |z: f64| [(150.0 + 100.0 * scale.fraction(z)) as u8; 3];
        let (mut cells, half) = (Vec::new(), DVec2::splat(0.5 * map.size().spacing));
        // Of a fine map some points stand for all; of a coarse one none may be within.
        let each = stride(first, last, MOST_CELLS);
        let across = (last.i - first.i).max(-each) / each + 1;
        for j in (0..=(last.j - first.j).max(-each) / each).rev() {
            for i in 0..across {
                let point = GridPoint { i: first.i + i * each, j: first.j + j * each };
                cells.push(map.elevation(point).map(grey));
            }
        }
        let (corner, opposite) = (map.place(first) - half, map.place(last) + half);
        let (a, b) = (top.page(DVec2::new(corner.x, opposite.y)), top.page(DVec2::new(opposite.x, corner.y)));
        if !cells.is_empty() {
            let size = [b[0] - a[0], b[1] - a[1]];
            top.drawing.marks.push(Mark::Cells { at: a, size, columns: across as usize, cells });
        }
        top.axes(low, high);
        let x = left + size.x + 14.0;
        let words = [
            "elevation, m",
            &format!("{:.2} bright", heights[1]),
            &format!("{:.2} dark", heights[0]),
            "white: unknown",
        ];
        for (line, words) in words.iter().enumerate() {
            let y = above + 110.0 + 18.0 * line as f64;
            top.drawing.text([x, y], *words, Anchor::Start, SOFT);
        }
        top
    }

    fn page(&self, p: DVec2) -> [f64; 2] {
        let [left, above, ..] = MARGIN;
        let q = (p - self.low) * self.share;
        [left + q.x, above + self.height - q.y]
    }

    /// The frame, and metres along it.
    fn axes(&mut self, low: DVec2, high: DVec2) {
        let (a, b) = (self.page(low), self.page(high));
        self.drawing.line(vec![a, [b[0], a[1]], b, [a[0], b[1]], a], SOFT, 1.0);
        for tick in Scale::linear(low.x, high.x).ticks(7) {
            let x = a[0] + tick.at * (b[0] - a[0]);
            self.drawing.line(vec![[x, a[1]], [x, a[1] + 5.0]], SOFT, 1.0);
            self.drawing.text([x, a[1] + 19.0], tick.label, Anchor::Middle, SOFT);
        }
        for tick in Scale::linear(low.y, high.y).ticks(7) {
            let y = a[1] + tick.at * (b[1] - a[1]);
            self.drawing.line(vec![[a[0] - 5.0, y], [a[0], y]], SOFT, 1.0);
            self.drawing.text([a[0] - 8.0, y + 0.35 * LETTERS], tick.label, Anchor::End, SOFT);
        }
        self.drawing.text([0.5 * (a[0] + b[0]), a[1] + 40.0], "x, m", Anchor::Middle, INK);
        self.drawing.text([6.0, b[1] - 12.0], "y, m", Anchor::Start, INK);
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
    fn labels(&mut self) {
        let x = f64::from(self.drawing.width) - MARGIN[2] + 14.0;
        for (line, label) in [Label::Obstacle, Label::Unknown, Label::Visibility].into_iter().enumerate() {
            let y = MARGIN[1] + 14.0 + 20.0 * line as f64;
            self.drawing.line(vec![[x, y], [x + 18.0, y]], colour(label), 4.0);
            let words = if label == Label::Visibility { "visibility limit" } else { word(label) };
            self.drawing.text([x + 26.0, y + 4.0], words, Anchor::Start, INK);
        }
    }
}
