//! Images against the sheets of light on the ground, and stripes against the images.

use std::collections::BTreeMap;

use super::driven::{CLEAN, Driven};
use super::geometry::{Pose, minus, times};
use super::ground::{
    FOCAL, PITCH, PRINCIPAL, SCAN, SIZE, THICKNESS, ahead_and_left, frames, hit, panned, sensors, true_pose,
};
use super::readers::{npy, png16};

/// Frame, step of the scan (-1: none) and beam of every image, in the order in which they were taken.
fn exposures() -> Vec<(u64, i64, usize)> {
    let of_frame = |frame: u64| {
        let steps = if frame == 0 { 0..i64::from(SCAN.1) } else { -1..0 };
        steps.flat_map(move |step| [0, 1].map(|beam| (frame, step, beam)))
    };
    (0..frames()).flat_map(of_frame).collect()
}

fn stem((frame, step, beam): (u64, i64, usize)) -> String {
    let scan = if step < 0 { String::new() } else { format!("-scan{step:03}") };
    format!("images/{frame:06}{scan}-beam{beam}")
}

/// The image of an exposure as its array has it: rows from the top.
fn image(of: &Driven, exposure: (u64, i64, usize)) -> Vec<f64> {
    let array = npy(&of.recorded(&format!("{}.npy", stem(exposure))));
    assert_eq!((array.shape, array.kind.as_str()), (vec![SIZE[1], SIZE[0]], "<u2"));
    array.values
}

/// Direction in the camera of an image point: z ahead, x to the right, y down.
pub(crate) fn ray(column: f64, row: f64) -> [f64; 3] {
    [(column - PRINCIPAL[0]) * PITCH[0] / FOCAL, (row - PRINCIPAL[1]) * PITCH[1] / FOCAL, 1.0]
}

/// The camera and a beam in an exposure, where they truly are.
struct Looking {
    camera: Pose,
    beam: Pose,
}

impl Looking {
    fn at((frame, step, beam): (u64, i64, usize)) -> Self {
        let (vehicle, sensors) = (true_pose(frame), sensors());
        let [camera, beam] = [0, 1 + beam].map(|index: usize| vehicle.then(&panned(&sensors[index], step)));
        Self { camera, beam }
    }

    /// The ground at an image point: global, and whether it is the plane.
    fn ground(&self, column: f64, row: f64) -> Option<([f64; 3], bool)> {
        let direction = self.camera.direction(ray(column, row));
        let (to, is_plane) = hit(self.camera.position, direction)?;
        let point: [f64; 3] = std::array::from_fn(|axis| self.camera.position[axis] + to * direction[axis]);
        Some((point, is_plane))
    }

    /// The same in the beam's frame: y is the distance from the middle of the sheet, downwards.
    fn in_beam(&self, point: [f64; 3]) -> [f64; 3] {
        self.beam.inverse().point(point)
    }

    /// Whether the beam lights a point of the ground in its sheet: within its fan of 30 degrees to either side and its
    /// range, by a margin, and with nothing before it.
    fn is_lit(&self, point: [f64; 3]) -> bool {
        let [x, _, z] = self.in_beam(point);
        // Rays start on the focal axis, at the point's own height in the sheet.
        let [_, y, _] = self.in_beam(point);
        let from = self.beam.point([0.0, y, 0.0]);
        let to = minus(point, from);
        let first = hit(from, to).map_or(f64::INFINITY, |(to, _)| to);
        x.abs() < 0.98 * z / 3.0_f64.sqrt() && z > 0.1 && libm::hypot(x, z) < 19.0 && first > 0.999
    }
}

#[test]
fn light_lies_where_a_sheet_meets_the_ground_and_nowhere_else() {
    let (mut lit, mut astray, mut expected, mut missing) = (0_usize, Vec::new(), 0_usize, Vec::new());
    let mut on_the_rock = 0;
    for exposure in exposures() {
        let (image, looking) = (image(&CLEAN, exposure), Looking::at(exposure));
        for column in 0..SIZE[0] {
            let middle = column as f64 + 0.5;
            // Distance from the sheet at the borders of all pixels of the column.
            let sheet: Vec<Option<f64>> = (0..=SIZE[1])
                .map(|row| looking.ground(middle, row as f64).map(|(point, _)| looking.in_beam(point)[1]))
                .collect();
            let meets = |rows: std::ops::RangeInclusive<usize>| {
                let inside = sheet[rows].iter().flatten();
                let (low, high) = inside
                    .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &y| (y.min(low), y.max(high)));
                low <= 0.5 * THICKNESS && high >= -0.5 * THICKNESS
            };
            for row in 0..SIZE[1] {
                let value = image[row * SIZE[0] + column];
                if value > 0.0 {
                    lit += 1;
                    // The sheet has a width, and a pencil lights one pixel: one pixel more to either side.
                    if !meets(row.saturating_sub(1)..=(row + 2).min(SIZE[1])) {
                        astray.push((exposure, column, row));
                    }
                }
                // The middle of the sheet crosses this pixel.
                let crosses =
                    matches!((sheet[row], sheet[row + 1]), (Some(a), Some(b)) if a < 0.0 && b >= 0.0);
                let at = looking.ground(middle, row as f64 + 0.5).filter(|_| crosses);
                if let Some((point, is_plane)) = at {
                    // Farther off, the pixel sees two surfaces, and the sheet crosses none of them.
                    let is_near = looking.in_beam(point)[1].abs() < 0.05;
                    if is_near && looking.is_lit(point) {
                        expected += 1;
                        let near = row.saturating_sub(1)..=(row + 1).min(SIZE[1] - 1);
                        if !near.clone().any(|row| image[row * SIZE[0] + column] > 0.0) {
                            missing.push((exposure, column, row));
                        }
                        let [u, v, _] = ahead_and_left(point);
                        on_the_rock += usize::from(!is_plane && u < 4.5 && v > 0.4);
                    }
                }
            }
        }
    }
    assert!(lit > 10_000 && expected > 5_000 && on_the_rock > 300, "{lit} {expected} {on_the_rock}");
    // Tuned: at edges of the blocks a pixel sees both sides, and its middle only one.
    assert!(astray.len() * 100 < lit, "{} of {lit}: {:?}", astray.len(), &astray[..10]);
    assert!(missing.len() * 200 < expected, "{} of {expected}: {:?}", missing.len(), &missing[..10]);
}

#[test]
fn pictures_are_the_arrays() {
    for exposure in exposures() {
        let (columns, rows, numbers) = png16(&CLEAN.recorded(&format!("{}.png", stem(exposure))));
        assert_eq!([columns, rows], SIZE);
        assert_eq!(numbers, image(&CLEAN, exposure), "{exposure:?}");
    }
    let files = std::fs::read_dir(CLEAN.recorded("images")).unwrap().count();
    assert_eq!(files, 2 * exposures().len());
}

#[test]
fn stripes_are_the_centroids_of_what_is_lit() {
    let setup = CLEAN.json("recording/setup.json");
    assert_eq!((&setup["extraction"]["place"], &setup["images"]["unit"]), (&"centroid".into(), &"DN".into()));
    let threshold = setup["extraction"]["threshold"].as_f64().unwrap();
    let mut recorded: BTreeMap<(u64, i64, usize), Vec<[f64; 2]>> = BTreeMap::new();
    let stripes = npy(&CLEAN.recorded("stripes.npy"));
    let mut order = Vec::new();
    for line in 0..stripes.shape[0] {
        let row = stripes.row(line);
        let exposure = (row[0] as u64, row[1] as i64, row[2] as usize);
        order.push(exposure);
        recorded.entry(exposure).or_default().push([row[3], row[4]]);
    }
    order.dedup();
    let all: Vec<_> = exposures().into_iter().filter(|exposure| recorded.contains_key(exposure)).collect();
    assert_eq!(order, all, "exposure after exposure");
    for exposure in exposures() {
        let image = image(&CLEAN, exposure);
        let mut expected = Vec::new();
        for column in 0..SIZE[0] {
            let (mut light, mut moment) = (0.0, 0.0);
            for row in 0..SIZE[1] {
                let value = image[row * SIZE[0] + column];
                if value >= threshold {
                    light += value;
                    moment += value * (row as f64 + 0.5);
                } else if light > 0.0 {
                    expected.push([column as f64, moment / light]);
                    (light, moment) = (0.0, 0.0);
                }
            }
        }
        // In row-major order of the image.
        expected.sort_by(|a, b| (a[1].floor(), a[0]).partial_cmp(&(b[1].floor(), b[0])).unwrap());
        let given = recorded.get(&exposure).map_or(&[][..], Vec::as_slice);
        assert_eq!(given.len(), expected.len(), "{exposure:?}");
        for (given, expected) in given.iter().zip(&expected) {
            let [column, row] = [0, 1].map(|axis| given[axis] - expected[axis]);
            assert!(column == 0.0 && row.abs() < 1e-9, "{exposure:?}: {given:?} for {expected:?}");
        }
    }
}

/// The point where an image point's ray meets the middle of a beam's sheet, vehicle frame.
pub(crate) fn triangulated(step: i64, beam: usize, column: f64, row: f64) -> [f64; 3] {
    let sensors = sensors();
    let [camera, beam] = [0, 1 + beam].map(|index: usize| panned(&sensors[index], step));
    let beam_from_camera = beam.inverse().then(&camera);
    let (from, along) = (beam_from_camera.position, beam_from_camera.direction(ray(column, row)));
    // y = 0 in the beam's frame.
    camera.point(times(ray(column, row), -from[1] / along[1]))
}
