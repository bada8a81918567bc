//! Answers as pictures: the ranges in the pattern's own raster, and the points seen from above.

use glam::DVec3;
use raypencil_report::{Anchor, Colour, ColourMap, Drawing, INK, Mark, SOFT, Scale};
use raypencil_scene::{NamedRaySet, Reading};

use crate::answers::Answers;

/// Width of a page, pixels.
const PAGE_PX: u32 = 1000;

/// Room to the left of a picture, pixels.
const LEFT_PX: f64 = 74.0;

/// Room to the right of a picture, pixels.
const RIGHT_PX: f64 = 26.0;

/// Room above a picture, pixels.
const TOP_PX: f64 = 36.0;

/// Room below a picture, for its axis and the scale, pixels.
const BOTTOM_PX: f64 = 96.0;

/// Maximum number of columns or rows of cells.
const MAX_CELLS: u64 = 900;

/// Colour of cells without a hit.
const MISS: Colour = [224, 226, 229];

/// Colour of cells in which what is hit is too near.
const TOO_NEAR: Colour = [46, 48, 56];

/// The ranges as a picture, for a set of two dimensions; `None` for others, and if nothing is hit.
///
/// A spinning head has a row for each channel, the highest elevation on top, and its firing sequences from left to right.
/// Other sets have the rows and columns of their shape. Of many rows or columns some are left out.
pub fn range_picture(answers: &Answers, set: &NamedRaySet) -> Option<Drawing> {
    let &[first, second] = set.shape.as_slice() else { return None };
    let scale = Scale::of_ranges(answers.hits().map(|hit| hit.range))?;
    let order = set.elevations_deg.as_ref().map(|elevations| {
        let mut order: Vec<usize> = (0..elevations.len()).collect();
        order.sort_by(|&a, &b| elevations[b].total_cmp(&elevations[a]));
        order
    });
    let (rows, columns) = if order.is_some() { (second, first) } else { (first, second) };
    let [down, across] = [rows, columns].map(|count| count.div_ceil(MAX_CELLS).max(1));
    let [shown_rows, shown_columns] = [rows.div_ceil(down), columns.div_ceil(across)];
    let middle = |index: u64, step: u64, count: u64| (index * step + step / 2).min(count - 1) as usize;
    let mut cells = Vec::with_capacity((shown_rows * shown_columns) as usize);
    for row in 0..shown_rows {
        for column in 0..shown_columns {
            let (i, j) = (middle(column, across, columns), middle(row, down, rows));
            let index = match &order {
                Some(order) => i * second as usize + order[j],
                None => j * second as usize + i,
            };
            let colour = match &answers.first[index] {
                Reading::Hit(hit) => ColourMap::Sequential.at(scale.fraction(hit.range)),
                Reading::TooNear => TOO_NEAR,
                Reading::Miss => MISS,
            };
            cells.push(Some(colour));
        }
    }
    let width = f64::from(PAGE_PX) - LEFT_PX - RIGHT_PX;
    // A spinning head has few channels: each gets several pixels. A raster keeps its proportions.
    let height = match order {
        Some(_) => (14.0 * rows as f64).clamp(160.0, 640.0),
        None => (width * rows as f64 / columns as f64).clamp(120.0, 760.0),
    };
    let mut page =
        Drawing::new(PAGE_PX, (TOP_PX + height + BOTTOM_PX) as u32, &format!("Ranges of {}", set.name));
    let at = [LEFT_PX, TOP_PX];
    page.text([LEFT_PX, 22.0], format!("{}: range of each ray", set.name), Anchor::Start, INK);
    page.marks.push(Mark::Cells { at, size: [width, height], columns: shown_columns as usize, cells });
    let (words, of_rows) = match (&order, &set.elevations_deg) {
        (Some(order), Some(elevations)) => {
            let degrees = |row: usize| format!("{:.1}°", elevations[order[row]]);
            ("firing sequence, in the order of time", [degrees(0), degrees(order.len() - 1)])
        }
        _ => ("column", ["row 0".to_string(), format!("row {}", rows - 1)]),
    };
    page.text([LEFT_PX - 6.0, TOP_PX + 12.0], &of_rows[0], Anchor::End, SOFT);
    page.text([LEFT_PX - 6.0, TOP_PX + height], &of_rows[1], Anchor::End, SOFT);
    if order.is_some() {
        page.text([LEFT_PX - 6.0, TOP_PX + 0.5 * height + 5.0], "elevation", Anchor::End, SOFT);
    }
    let below = TOP_PX + height + 18.0;
    page.text([LEFT_PX, below], "0", Anchor::Start, SOFT);
    page.text([LEFT_PX + 0.5 * width, below], words, Anchor::Middle, SOFT);
    page.text([LEFT_PX + width, below], (columns - 1).to_string(), Anchor::End, SOFT);
    let y = TOP_PX + height + 38.0;
    bar(&mut page, scale, "range, m", y);
    key(&mut page, [LEFT_PX + 610.0, y], MISS, "nothing is hit");
    if answers.too_near() > 0 {
        key(&mut page, [LEFT_PX + 760.0, y], TOO_NEAR, "too near");
    }
    Some(page)
}

/// A view from above: two axes of the page and the height, as signed axes of the mesh's frame.
pub(crate) struct View {
    right: DVec3,
    page_up: DVec3,
    up: DVec3,
}

impl View {
    /// The view along the axis of the mesh's frame that is nearest to `up`. Page and height are right-handed.
    pub(crate) fn along(up: DVec3) -> Self {
        let axis = up.abs().max_position();
        let sign = if up[axis] < 0.0 { -1.0 } else { 1.0 };
        // x is to the right unless it is the height.
        let right = if axis == 0 { DVec3::Y } else { DVec3::X };
        let up = DVec3::AXES[axis] * sign;
        Self { right, page_up: up.cross(right), up }
    }

    /// Its axes in the mesh's frame: to the right, up the page, upward.
    pub(crate) fn axes(&self) -> [[f64; 3]; 3] {
        [self.right, self.page_up, self.up].map(|axis| axis.to_array())
    }

    /// An axis of the view by its name: `x`, `-z`.
    fn name(axis: DVec3) -> String {
        let index = axis.abs().max_position();
        let sign = if axis[index] < 0.0 { "-" } else { "" };
        format!("{sign}{}", ["x", "y", "z"][index])
    }

    /// A point as numbers to the right, up the page, and of height.
    fn of(&self, point: DVec3) -> DVec3 {
        DVec3::new(self.right.dot(point), self.page_up.dot(point), self.up.dot(point))
    }
}

/// The points from above, coloured by their height; `None` if nothing is hit. Above is the axis of the mesh's frame that is
/// nearest to the set's up direction.
pub fn top_picture(answers: &Answers, set: &NamedRaySet) -> Option<Drawing> {
    const SIDE: usize = 900;
    const SIDE_PX: f64 = SIDE as f64;
    let view = View::along(set.up());
    let points = || answers.hits().map(|hit| view.of(hit.point));
    let scale = Scale::of(points().map(|point| point.z))?;
    let origin = view.of(set.set.rays().first()?.origin);
    let (low, high) = points().fold((origin, origin), |(low, high), point| (low.min(point), high.max(point)));
    let centre = 0.5 * low + 0.5 * high;
    let span = (high - low).truncate().max_element() * 1.04;
    let span = if span > 0.0 && span.is_finite() { span } else { 1.0 };
    let place = |point: DVec3| {
        let along = |offset: f64| ((0.5 + offset / span) * SIDE_PX).clamp(0.0, SIDE_PX - 1.0);
        [along(point.x - centre.x), along(centre.y - point.y)]
    };
    let mut cells: Vec<Option<Colour>> = vec![None; SIDE * SIDE];
    for point in points() {
        let colour = ColourMap::Sequential.at(scale.fraction(point.z));
        let [x, y] = place(point).map(|along| along as usize);
        // Two by two pixels, so that a single point is seen.
        for (x, y) in [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)] {
            if x < SIDE && y < SIDE {
                cells[y * SIDE + x] = Some(colour);
            }
        }
    }
    let height = TOP_PX + SIDE_PX + BOTTOM_PX;
    let mut page = Drawing::new(PAGE_PX, height as u32, &format!("Points of {} from above", set.name));
    page.text([LEFT_PX, 22.0], format!("{}: points from above", set.name), Anchor::Start, INK);
    let at = [LEFT_PX, TOP_PX];
    let frame = [[0.0, 0.0], [SIDE_PX, 0.0], [SIDE_PX, SIDE_PX], [0.0, SIDE_PX], [0.0, 0.0]];
    page.line(frame.map(|[x, y]| [x + at[0], y + at[1]]).to_vec(), SOFT, 1.0);
    page.marks.push(Mark::Cells { at, size: [SIDE_PX, SIDE_PX], columns: SIDE, cells });
    // The sensor, at its first pose.
    let [x, y] = place(origin);
    cross(&mut page, [x + at[0], y + at[1]]);
    for (axis, middle) in [(0, centre.x), (1, centre.y)] {
        for tick in Scale::linear(middle - 0.5 * span, middle + 0.5 * span).ticks(8) {
            let along = tick.at * SIDE_PX;
            if axis == 0 {
                let below = at[1] + SIDE_PX;
                page.line(vec![[at[0] + along, below], [at[0] + along, below + 5.0]], SOFT, 1.0);
                page.text([at[0] + along, below + 19.0], tick.label, Anchor::Middle, SOFT);
            } else {
                let up = at[1] + SIDE_PX - along;
                page.line(vec![[at[0] - 5.0, up], [at[0], up]], SOFT, 1.0);
                page.text([at[0] - 8.0, up + 4.0], tick.label, Anchor::End, SOFT);
            }
        }
    }
    page.text(
        [LEFT_PX + SIDE_PX, 22.0],
        format!("{} to the right, {} up the page, m", View::name(view.right), View::name(view.page_up)),
        Anchor::End,
        SOFT,
    );
    bar(&mut page, scale, &format!("height {}, m", View::name(view.up)), TOP_PX + SIDE_PX + 42.0);
    let (x, y) = (LEFT_PX + 700.0, TOP_PX + SIDE_PX + 49.0);
    cross(&mut page, [x, y]);
    page.text([x + 14.0, y + 5.0], "origin of the first ray", Anchor::Start, SOFT);
    Some(page)
}

/// A cross that marks the sensor.
fn cross(page: &mut Drawing, [x, y]: [f64; 2]) {
    page.line(vec![[x - 8.0, y], [x + 8.0, y]], INK, 2.0);
    page.line(vec![[x, y - 8.0], [x, y + 8.0]], INK, 2.0);
}

/// A scale of colours with its ticks and its label.
fn bar(page: &mut Drawing, scale: Scale, label: &str, y: f64) {
    const STEPS: usize = 256;
    const BAR_PX: f64 = 480.0;
    let colours = (0..STEPS).map(|k| Some(ColourMap::Sequential.at(k as f64 / (STEPS - 1) as f64)));
    page.marks.push(Mark::Cells {
        at: [LEFT_PX, y],
        size: [BAR_PX, 14.0],
        columns: STEPS,
        cells: colours.collect(),
    });
    for tick in scale.ticks(8) {
        let x = LEFT_PX + tick.at * BAR_PX;
        page.line(vec![[x, y + 14.0], [x, y + 19.0]], SOFT, 1.0);
        page.text([x, y + 33.0], tick.label, Anchor::Middle, SOFT);
    }
    page.text([LEFT_PX + BAR_PX + 16.0, y + 12.0], label, Anchor::Start, INK);
}

/// A colour that is beside the scale, and what it means.
fn key(page: &mut Drawing, [x, y]: [f64; 2], colour: Colour, words: &str) {
    let corners = vec![[x, y], [x + 14.0, y], [x + 14.0, y + 14.0], [x, y + 14.0]];
    page.polygon(corners, colour, None);
    page.text([x + 20.0, y + 12.0], words, Anchor::Start, SOFT);
}

#[cfg(test)]
#[path = "../tests/unit/range_picture.rs"]
mod tests;
