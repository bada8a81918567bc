//! Figures 12 and 15: the relief of the local map as a wire frame, seen from behind and above.

use glam::DVec3;
use raypencil_report::{Anchor, Colour, Drawing, INK, SOFT, Scale, axis_from_offset, widest};
use raypencil_rover::{ElevationMap, GridPoint};

use crate::figures::elevation_key::draw_elevation_key;
use crate::figures::known_extent::{KnownExtent, stride};

/// Maximum number of cells along either side; smaller cells could not be distinguished.
const MAX_CELLS_ACROSS: i64 = 240;

/// Azimuth of the viewpoint, from behind the map to its right, radians.
const VIEW_AZIMUTH_RAD: f64 = 0.45;

/// Elevation of the viewpoint above the horizon, radians.
const VIEW_ELEVATION_RAD: f64 = 0.65;

/// Width and height of the page, pixels.
const PAGE_SIZE_PX: [u32; 2] = [960, 640];

/// Middle of the relief on the page, pixels.
const RELIEF_CENTRE_PX: [f64; 2] = [430.0, 300.0];

/// Largest width and height of the relief, pixels.
const RELIEF_MAX_SIZE_PX: [f64; 2] = [740.0, 530.0];

const CELL_BORDER_COLOUR: Colour = [126, 108, 92];

/// Colour of the grid below the relief.
const GRID_COLOUR: Colour = [220, 217, 210];

/// Colour of the lowest ground, in full light.
const LOWEST_COLOUR: [f64; 3] = [214.0, 178.0, 146.0];

/// Colour of the highest ground, in full light.
const HIGHEST_COLOUR: [f64; 3] = [255.0, 250.0, 232.0];

/// Parallel projection from the viewpoint: sine and cosine of its azimuth and elevation.
struct ParallelProjection {
    azimuth: (f64, f64),
    elevation: (f64, f64),
}

impl ParallelProjection {
    fn new() -> Self {
        Self { azimuth: libm::sincos(VIEW_AZIMUTH_RAD), elevation: libm::sincos(VIEW_ELEVATION_RAD) }
    }

    /// Coordinates of a point to the right, up, and away from the viewpoint, metres. The map's x points away and its y
    /// to the left.
    fn project(&self, p: DVec3) -> DVec3 {
        let ((sin_a, cos_a), (sin_e, cos_e)) = (self.azimuth, self.elevation);
        let (away, right) = (p.x * cos_a + p.y * sin_a, p.x * sin_a - p.y * cos_a);
        DVec3::new(right, away * sin_e + p.z * cos_e, away)
    }
}

/// Colour at a fraction of the elevations' scale, in light from 0 to 1.
fn tint(fraction: f64, light: f64) -> Colour {
    let (low, high) = (LOWEST_COLOUR, HIGHEST_COLOUR);
    [0, 1, 2].map(|part| (light * (low[part] + fraction * (high[part] - low[part]))).clamp(0.0, 255.0) as u8)
}

/// Drawing of all cells whose four corners are known, far ones first. All other cells are open.
pub(super) fn relief(map: &ElevationMap) -> Drawing {
    let mut drawing = Drawing::new(PAGE_SIZE_PX[0], PAGE_SIZE_PX[1], "Local terrain map");
    let Some(KnownExtent { elevations: [lowest, highest], corners: [low, high] }) = KnownExtent::of(map)
    else {
        drawing.text(RELIEF_CENTRE_PX, "nothing is known", Anchor::Middle, SOFT);
        return drawing;
    };
    let projection = ParallelProjection::new();
    let corner = |i: i64, j: i64, z: f64| map.place(GridPoint { i, j }).extend(z);
    let base = [(low.i, low.j), (high.i, low.j), (high.i, high.j), (low.i, high.j)];
    let ends = base.iter().flat_map(|&(i, j)| [lowest, highest].map(|z| projection.project(corner(i, j, z))));
    let none = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (least, most) = ends.fold(none, |(least, most), end| (least.min(end), most.max(end)));
    let span = (most - least).max(DVec3::splat(1e-9));
    let share = (RELIEF_MAX_SIZE_PX[0] / span.x).min(RELIEF_MAX_SIZE_PX[1] / span.y);
    let middle = 0.5 * (least + most);
    let page = |p: DVec3| {
        let q = projection.project(p) - middle;
        [RELIEF_CENTRE_PX[0] + share * q.x, RELIEF_CENTRE_PX[1] - share * q.y]
    };

    let (from, to) = (map.place(low), map.place(high));
    draw_base(&mut drawing, from.extend(lowest), to.extend(lowest), page);

    let mut cells = Vec::new();
    let step = stride(low, high, MAX_CELLS_ACROSS);
    for j in (low.j..high.j).step_by(step as usize) {
        for i in (low.i..high.i).step_by(step as usize) {
            let four = [(i, j), (i + step, j), (i + step, j + step), (i, j + step)];
            let corners = four.map(|(i, j)| Some(corner(i, j, map.elevation(GridPoint { i, j })?)));
            if let [Some(a), Some(b), Some(c), Some(d)] = corners {
                cells.push([a, b, c, d]);
            }
        }
    }
    cells.sort_by(|p, q| projection.project(q[0]).z.total_cmp(&projection.project(p[0]).z));
    let scale = Scale::linear(lowest, highest);
    let sun = DVec3::new(-0.5, 0.35, 0.8).normalize();
    for [a, b, c, d] in cells {
        let light = 0.55 + 0.45 * (c - a).cross(d - b).normalize_or_zero().dot(sun).max(0.0);
        let fill = tint(scale.fraction(0.25 * (a.z + b.z + c.z + d.z)), light);
        drawing.polygon([a, b, c, d].map(page).to_vec(), fill, Some(CELL_BORDER_COLOUR));
    }
    // The key shows the colours of flat ground in that light.
    draw_elevation_key(&mut drawing, [850.0, 40.0], scale, |fraction| tint(fraction, 0.55 + 0.45 * sun.z));
    drawing
}

/// Draws the rectangle around the known cells at the level of the lowest one: a grid, and metres along its two nearest
/// sides.
fn draw_base(drawing: &mut Drawing, from: DVec3, to: DVec3, page: impl Fn(DVec3) -> [f64; 2]) {
    let along_x = |share: f64, y: f64| page(DVec3::new(from.x + share * (to.x - from.x), y, from.z));
    let along_y = |share: f64, x: f64| page(DVec3::new(x, from.y + share * (to.y - from.y), from.z));
    let (columns, name_of_x) = axis_from_offset("x", "m", [from.x, to.x], 8);
    let (rows, name_of_y) = axis_from_offset("y", "m", [from.y, to.y], 8);
    // The labels of x run away from their side: its name stands beyond them.
    let beyond_labels = 26.0 + widest(&columns).max(30.0);
    for tick in &columns {
        drawing.line(vec![along_x(tick.at, from.y), along_x(tick.at, to.y)], GRID_COLOUR, 0.6);
    }
    for tick in &rows {
        drawing.line(vec![along_y(tick.at, from.x), along_y(tick.at, to.x)], GRID_COLOUR, 0.6);
    }
    let corners = [(0.0, from.y), (1.0, from.y), (1.0, to.y), (0.0, to.y), (0.0, from.y)];
    drawing.line(corners.map(|(share, y)| along_x(share, y)).to_vec(), SOFT, 0.8);

    // A tick extends the grid's line beyond the rectangle.
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
    // The name of each axis runs along its side.
    let turn = |a: [f64; 2], b: [f64; 2]| libm::atan2(b[1] - a[1], b[0] - a[0]).to_degrees();
    let (near, far) = (along_x(0.0, from.y), along_x(1.0, from.y));
    let [x, y] = beyond(along_x(0.5, to.y), along_x(0.5, from.y), beyond_labels);
    drawing.turned_text([x, y], name_of_x, Anchor::Middle, INK, turn(near, far));
    let (left, right) = (along_y(1.0, from.x), along_y(0.0, from.x));
    let [x, y] = beyond(along_y(0.5, to.x), along_y(0.5, from.x), 48.0);
    drawing.turned_text([x, y], name_of_y, Anchor::Middle, INK, turn(left, right));
}
