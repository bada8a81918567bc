//! Figures 12 and 15: the local map as a net, seen from behind and above.

use glam::DVec3;

use crate::figures::axes::elevations;
use crate::figures::{known, stride};
use raypencil_report::{Anchor, Colour, Drawing, INK, SOFT, Scale};
use raypencil_rover::{ElevationMap, GridPoint};

/// Lines of the net, along either side; more cannot be told apart.
const MOST_ACROSS: i64 = 240;

/// Where it is looked at from: so far to the right of behind, and so far above the horizon, radians.
const ASIDE: f64 = 0.45;

const ABOVE: f64 = 0.65;

/// The page, and what of it the net may take: its middle and its size, pixels.
const PAGE: [u32; 2] = [960, 640];

const MIDDLE: [f64; 2] = [430.0, 300.0];

const ROOM: [f64; 2] = [740.0, 530.0];

/// Of the net, and of the grid that lies below it.
const NET: Colour = [126, 108, 92];

const GRID: Colour = [220, 217, 210];

/// Lowest and highest ground.
const LOW: [f64; 3] = [214.0, 178.0, 146.0];

const HIGH: [f64; 3] = [255.0, 250.0, 232.0];

/// Directions on the page: the view from `ASIDE` and `ABOVE`.
struct Eye {
    aside: (f64, f64),
    above: (f64, f64),
}

impl Eye {
    fn new() -> Self {
        Self { aside: libm::sincos(ASIDE), above: libm::sincos(ABOVE) }
    }

    /// To the right, up, and away from the eye. x of the map goes away, its y to the left.
    fn turned(&self, p: DVec3) -> DVec3 {
        let ((sin_a, cos_a), (sin_e, cos_e)) = (self.aside, self.above);
        let (away, right) = (p.x * cos_a + p.y * sin_a, p.x * sin_a - p.y * cos_a);
        DVec3::new(right, away * sin_e + p.z * cos_e, away)
    }
}

/// The colour of a place between the lowest and the highest ground, in light from 0 to 1.
fn tint(place: f64, light: f64) -> Colour {
    [0, 1, 2].map(|part| (light * (LOW[part] + place * (HIGH[part] - LOW[part]))).clamp(0.0, 255.0) as u8)
}

/// Cells between four known points, far ones first; all others are open.
pub(super) fn relief(map: &ElevationMap) -> Drawing {
    let mut drawing = Drawing::new(PAGE[0], PAGE[1], "Local terrain map");
    let Some(([lowest, highest], [low, high])) = known(map) else {
        drawing.text(MIDDLE, "nothing is known", Anchor::Middle, SOFT);
        return drawing;
    };
    let eye = Eye::new();
    let corner = |i: i64, j: i64, z: f64| map.place(GridPoint { i, j }).extend(z);
    let base = [(low.i, low.j), (high.i, low.j), (high.i, high.j), (low.i, high.j)];
    let ends = base.iter().flat_map(|&(i, j)| [lowest, highest].map(|z| eye.turned(corner(i, j, z))));
    let none = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (least, most) = ends.fold(none, |(least, most), end| (least.min(end), most.max(end)));
    let span = (most - least).max(DVec3::splat(1e-9));
    let share = (ROOM[0] / span.x).min(ROOM[1] / span.y);
    let middle = 0.5 * (least + most);
    let page = |p: DVec3| {
        let q = eye.turned(p) - middle;
        [MIDDLE[0] + share * q.x, MIDDLE[1] - share * q.y]
    };

    let (from, to) = (map.place(low), map.place(high));
    rim(&mut drawing, from.extend(lowest), to.extend(lowest), page);

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
    cells.sort_by(|p, q| eye.turned(q[0]).z.total_cmp(&eye.turned(p[0]).z));
    let scale = Scale::linear(lowest, highest);
    let sun = DVec3::new(-0.5, 0.35, 0.8).normalize();
    for [a, b, c, d] in cells {
        let light = 0.55 + 0.45 * (c - a).cross(d - b).normalize_or_zero().dot(sun).max(0.0);
        let fill = tint(scale.fraction(0.25 * (a.z + b.z + c.z + d.z)), light);
        drawing.polygon([a, b, c, d].map(page).to_vec(), fill, Some(NET));
    }
    // As flat ground has them in that light.
    elevations(&mut drawing, [850.0, 40.0], scale, |place| tint(place, 0.55 + 0.45 * sun.z));
    drawing
}

/// The rectangle that holds what is known, on its lowest level: a grid, and metres along the two sides that are nearest.
fn rim(drawing: &mut Drawing, from: DVec3, to: DVec3, page: impl Fn(DVec3) -> [f64; 2]) {
    let along_x = |share: f64, y: f64| page(DVec3::new(from.x + share * (to.x - from.x), y, from.z));
    let along_y = |share: f64, x: f64| page(DVec3::new(x, from.y + share * (to.y - from.y), from.z));
    let (columns, rows) = (Scale::linear(from.x, to.x).ticks(8), Scale::linear(from.y, to.y).ticks(8));
    for tick in &columns {
        drawing.line(vec![along_x(tick.at, from.y), along_x(tick.at, to.y)], GRID, 0.6);
    }
    for tick in &rows {
        drawing.line(vec![along_y(tick.at, from.x), along_y(tick.at, to.x)], GRID, 0.6);
    }
    let corners = [(0.0, from.y), (1.0, from.y), (1.0, to.y), (0.0, to.y), (0.0, from.y)];
    drawing.line(corners.map(|(share, y)| along_x(share, y)).to_vec(), SOFT, 0.8);

    // A tick goes on along the grid's line, over the rim.
    let beyond = |inner: [f64; 2], outer: [f64; 2], length: f64| {
        let (dx, dy) = (outer[0] - inner[0], outer[1] - inner[1]);
        let share = length / libm::hypot(dx, dy).max(1e-9);
        [outer[0] + share * dx, outer[1] + share * dy]
    };
    for tick in columns {
        let (inner, outer) = (along_x(tick.at, to.y), along_x(tick.at, from.y));
        drawing.line(vec![outer, beyond(inner, outer, 6.0)], SOFT, 1.0);
        let [x, y] = beyond(inner, outer, 12.0);
        drawing.text([x - 2.0, y + 6.0], tick.label, Anchor::Start, SOFT);
    }
    for tick in rows {
        let (inner, outer) = (along_y(tick.at, to.x), along_y(tick.at, from.x));
        drawing.line(vec![outer, beyond(inner, outer, 6.0)], SOFT, 1.0);
        let [x, y] = beyond(inner, outer, 12.0);
        drawing.text([x, y + 9.0], tick.label, Anchor::Middle, SOFT);
    }
    // Each name along its side.
    let turn = |a: [f64; 2], b: [f64; 2]| libm::atan2(b[1] - a[1], b[0] - a[0]).to_degrees();
    let (near, far) = (along_x(0.0, from.y), along_x(1.0, from.y));
    let [x, y] = beyond(along_x(0.5, to.y), along_x(0.5, from.y), 56.0);
    drawing.turned_text([x, y], "x, m", Anchor::Middle, INK, turn(near, far));
    let (left, right) = (along_y(1.0, from.x), along_y(0.0, from.x));
    let [x, y] = beyond(along_y(0.5, to.x), along_y(0.5, from.x), 48.0);
    drawing.turned_text([x, y], "y, m", Anchor::Middle, INK, turn(left, right));
}
