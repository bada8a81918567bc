//! Unit tests of `bins`: order, look-up, and the pixels that a face touches.

use glam::DVec3;
use raypencil_scene::{Camera, Pixel};

use super::*;
use crate::fixtures::camera;
use crate::points::ImagePoint;

/// A camera of 8 x 8 pixels, each 1 m wide on the SPP, with the principal point in the middle.
fn pixels() -> PixelGrid {
    PixelGrid::new(&Camera { pixel_pitch: [1.0; 2], ..camera() })
}

/// A point at the centre of pixel (i, j), at t = 2 + i.
fn point(i: u32, j: u32) -> StripePoint {
    let at = SppPoint { x: f64::from(i) - 3.5, y: f64::from(j) - 3.5 };
    StripePoint {
        face: FaceId(0),
        range: 1.0,
        cos_psi: 1.0,
        cos_theta: 1.0,
        depth: 1.0,
        distance: 1.0,
        cos_phi: 1.0,
        sin_squared_phi: 0.0,
        image: Some(ImagePoint { pixel: Pixel { i, j }, on_spp: at, inverse_t: 1.0 / f64::from(2 + i) }),
        error: PointError { along_pencil: DVec3::ZERO, any_direction: 0.0 },
    }
}

/// Points in all pixels of columns 2 to 5 and rows 3 to 6, two of them in (4, 4), the last row first. Then three that
/// are not binned: a point off the image, a point on a back, and a pencil without a hit.
fn points() -> Vec<Option<StripePoint>> {
    let cells = (3..7).rev().flat_map(|j| (2..6).map(move |i| (i, j)));
    let mut points: Vec<_> = cells.map(|(i, j)| Some(point(i, j))).collect();
    points.push(Some(point(4, 4)));
    points.push(Some(StripePoint { image: None, ..point(0, 0) }));
    points.push(Some(StripePoint { cos_theta: 0.0, ..point(0, 0) }));
    points.push(None);
    points
}

/// The pixels that contain some points.
fn cells(bins: &Bins, points: std::ops::Range<usize>) -> Vec<[i64; 2]> {
    bins.points()[points].iter().map(|point| pixels().cell(point.on_spp)).collect()
}

#[test]
fn points_are_sorted_by_pixel_and_keep_their_order_in_it() {
    let points = points();
    let bins = Bins::new(pixels(), points.iter().map(Option::as_ref));
    let mut expected: Vec<[i64; 2]> = (3..7).flat_map(|j| (2..6).map(move |i| [i, j])).collect();
    expected.insert(6, [4, 4]);
    assert_eq!(cells(&bins, 0..bins.points().len()), expected);
    let of_pixel: Vec<u32> = bins.points()[6..8].iter().map(|point| point.index).collect();
    // The last row was given first, so row 4 is the third one given and (4, 4) has the index 10. The second point of
    // that pixel has the index 16.
    assert_eq!(of_pixel, [10, 16]);
    let nothing = Bins::new(pixels(), points[17..].iter().map(Option::as_ref));
    assert!(nothing.points().is_empty());
    assert_eq!(nothing.in_row(3, 0..8), 0..0);
}

#[test]
fn the_points_of_a_row_are_found() {
    let points = points();
    let bins = Bins::new(pixels(), points.iter().map(Option::as_ref));
    assert_eq!(cells(&bins, bins.in_row(4, 3..5)), [[3, 4], [4, 4], [4, 4]]);
    assert_eq!(cells(&bins, bins.in_row(6, 0..8)), [[2, 6], [3, 6], [4, 6], [5, 6]]);
    assert_eq!(cells(&bins, bins.in_row(3, 5..6)), [[5, 3]]);
    for (row, columns) in [(2, 0..8), (7, 0..8), (4, 0..2), (4, 6..8), (4, 3..3)] {
        assert!(bins.in_row(row, columns.clone()).is_empty(), "{row} {columns:?}");
    }
}

#[test]
fn a_face_is_tested_in_the_pixels_that_it_touches() {
    let points = points();
    let bins = Bins::new(pixels(), points.iter().map(Option::as_ref));
    let rows_touched = |low: [f64; 2], high: [f64; 2], nearest: f64| -> Vec<[i64; 2]> {
        let [low, high] = [low, high].map(|[x, y]| SppPoint { x, y });
        let rows = bins.rows_touched(&ProjectedBounds { low, high, max_inverse_t: nearest });
        rows.flat_map(|rows_touched| cells(&bins, rows_touched.points)).collect()
    };
    // x from -0.9 to 0.1: columns 3 and 4; y from -0.5 to 1.5: rows 3 to 5.
    let some = [[3, 3], [4, 3], [3, 4], [4, 4], [4, 4], [3, 5], [4, 5]];
    assert_eq!(rows_touched([-0.9, -0.5], [0.1, 1.5], 1.0), some);
    // Bounds that contain all points.
    assert_eq!(rows_touched([-9.0, -9.0], [9.0, 9.0], 1.0).len(), 17);
    // Bounds beside all points.
    for (low, high) in [
        ([-4.0, -4.0], [-2.1, 4.0]),
        ([2.1, -4.0], [4.0, 4.0]),
        ([-4.0, -4.0], [4.0, -1.1]),
        ([-4.0, 3.1], [4.0, 4.0]),
    ] {
        assert_eq!(rows_touched(low, high, 1.0), [[0; 2]; 0]);
    }
    // The deepest point of each row is at 1/t = 1/7. A face that is nowhere nearer hides no point.
    assert_eq!(rows_touched([-0.9, -0.5], [0.1, 1.5], 1.0 / 7.0), [[0; 2]; 0]);
    assert_eq!(rows_touched([-0.9, -0.5], [0.1, 1.5], 1.01 / 7.0), some);
}

/// A straight side between two points.
#[derive(Clone, Copy)]
struct Straight(SppPoint, SppPoint);

impl ProjectedLine for Straight {
    fn x_at(&self, y: f64) -> f64 {
        let Self(a, b) = *self;
        a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y)
    }
}

#[test]
fn a_face_that_leans_across_many_rows_is_tested_in_few_pixels_of_each() {
    let points = points();
    let bins = Bins::new(pixels(), points.iter().map(Option::as_ref));
    // A sliver along the diagonal: in the row of centres y it is at x = y + 0.2 to y + 0.4.
    let corners = [[-3.8, -4.0], [4.2, 4.0], [-3.4, -3.6]].map(|[x, y]| SppPoint { x, y });
    let [a, b, c] = corners;
    let triangle = SplitTriangle::new(corners, [Straight(a, b), Straight(b, c), Straight(c, a)]);
    let (low, high) = (SppPoint { x: -3.8, y: -4.0 }, SppPoint { x: 4.2, y: 4.0 });
    let found: Vec<[i64; 2]> = bins
        .rows_touched(&ProjectedBounds { low, high, max_inverse_t: 1.0 })
        .flat_map(|rows_touched| cells(&bins, bins.narrow(rows_touched, &triangle)))
        .collect();
    // In row j, y = j - 3.5: x is from j - 3.3 to j - 3.1, which is in column j alone.
    assert_eq!(found, [[3, 3], [4, 4], [4, 4], [5, 5]]);
}
