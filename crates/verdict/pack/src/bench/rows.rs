//! Rows of faces before a bench beam: each row of pencils meets one clause of the contract at its boundary.
//!
//! A bench beam has dyadic numbers: pencil (i, j) starts at (0, y_j, 0), y_j = s (2 j + 1 - rows) / 8, and runs along
//! (s (i - 32) / 32, 0, s / 2), so that at the depth z it is at x = z (i - 32) / 16. Each of its faces lies within s / 8
//! of one y_j, and every coordinate below is dyadic (for the turned bench, a multiple of 25). So rays run *exactly*
//! through edges and vertices.
//!
//! Limits (t = 1, the maximum range) are met along the axis of the level bench alone: there x = 0, and every length and
//! area is a power of two, so that t and R are exact in whatever order, and with whatever length of the direction, a
//! renderer computes them. An honest renderer does not fail there by rounding.

use glam::DVec3;

use crate::bench::faces::{Side, Triangle, halves, showing, turned};

/// Columns of a bench beam. The middle one, 32, runs along the normal axis.
pub(super) const COLUMNS: u32 = 65;

/// What stands before one row of pencils.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Row {
    /// A groove along y whose bottom is at the depth 4 s, exactly the maximum range, on the middle ray. Every ray beside
    /// it meets the groove nearer: only a renderer that excludes the maximum range sees nothing there, and no displaced
    /// ray excuses it.
    GrooveAtMaximumRange,
    /// A wall that the maximum range cuts: its oblique rays are longer than its depth.
    WallCutByMaximumRange,
    /// A plate on the SPP before a wall; one ray meets the plate, at t = 1.
    PlateOnPlane,
    /// A plate before the SPP, and a wall.
    PlateBeforePlane,
    /// A plate that shows its back, and a wall.
    PlateTurnedAway,
    /// A triangle with one corner before the SPP.
    RampThroughPlane,
    /// A wall of small squares with a vertex on each ray.
    Vertices,
    /// The same with a horizontal edge through each ray.
    HorizontalEdges,
    /// The same with a vertical edge through each ray.
    VerticalEdges,
    /// The same with a diagonal through each ray.
    Diagonals,
    /// A roof whose ridge the middle ray meets.
    Ridge,
    /// A plate of which every face is there twice, and no wall behind.
    DoubledPlate,
    /// Lines in place of faces, each on a ray, and a wall.
    FacesWithoutArea,
    /// Plates of a square millimetre, each on a ray, and a wall.
    SmallPlates,
    /// A plate that ends 2^-26 m beside a ray, and a wall.
    PlateBesideRay,
}

/// The faces before a row of pencils whose origins are at `y`, on a bench of scale `s`, metres.
pub(super) fn faces_of(row: Row, y: f64, s: f64) -> Vec<Triangle> {
    let half = s / 16.0;
    // A vertical strip between two points (x, z) of the plane y = const, its front to the sensor.
    let strip = |from: [f64; 2], to: [f64; 2]| {
        let at = |[x, z]: [f64; 2], y: f64| DVec3::new(x, y, z);
        let corners = [at(from, y - half), at(from, y + half), at(to, y + half), at(to, y - half)];
        halves(corners).map(|one| showing(Side::Front, one, DVec3::new(0.0, y, 0.0)))
    };
    // Where the ray of a column is at depth z, columns counted from the middle.
    let x_at = |column: f64, z: f64| z * column / 16.0;
    let wall = |z: f64, reach: f64| strip([-reach, z], [reach, z]);
    let plate = |columns: [f64; 2], z: f64| strip([x_at(columns[0], z), z], [x_at(columns[1], z), z]);
    let backdrop = wall(3.0 * s, 2.0 * s);
    match row {
        // The point at depth 4 s - |x| along a ray of slope m = x / z has R = 4 s sqrt(1 + m^2) / (1 + |m|) <= 4 s.
        Row::GrooveAtMaximumRange => {
            [strip([0.0, 4.0 * s], [-s, 3.0 * s]), strip([0.0, 4.0 * s], [s, 3.0 * s])].concat()
        }
        Row::WallCutByMaximumRange => wall(3.0 * s, 8.0 * s).to_vec(),
        Row::PlateOnPlane => [strip([-s / 128.0, s / 2.0], [s / 128.0, s / 2.0]), backdrop].concat(),
        Row::PlateBeforePlane => [plate([4.5, 12.5], s / 4.0), backdrop].concat(),
        Row::PlateTurnedAway => {
            let away = plate([-12.5, -4.5], s).map(|one| showing(Side::Back, one, DVec3::new(0.0, y, 0.0)));
            [away, backdrop].concat()
        }
        Row::RampThroughPlane => {
            let ramp = [
                DVec3::new(0.0, y - half, s / 4.0),
                DVec3::new(-s / 2.0, y + half, 1.5 * s),
                DVec3::new(s / 2.0, y + half, 1.5 * s),
            ];
            vec![showing(Side::Front, ramp, DVec3::new(0.0, y, 0.0))]
        }
        Row::Vertices => squares(y, s, 0.0, &[-1.0, 0.0, 1.0]),
        Row::HorizontalEdges => squares(y, s, 0.5, &[-1.0, 0.0, 1.0]),
        Row::VerticalEdges => squares(y, s, 0.0, &[-1.0, 1.0]),
        Row::Diagonals => squares(y, s, 0.5, &[-1.0, 1.0]),
        Row::Ridge => [strip([0.0, 2.0 * s], [-s, 2.5 * s]), strip([0.0, 2.0 * s], [s, 2.5 * s])].concat(),
        Row::DoubledPlate => {
            let plate = plate([-8.5, 8.5], 2.0 * s);
            [plate, plate].concat()
        }
        Row::FacesWithoutArea => {
            let line = |column: f64| {
                let at = |y: f64| DVec3::new(x_at(column, s), y, s);
                [at(y - half), at(y), at(y + half)]
            };
            [-2.0, -1.0, 0.0, 1.0, 2.0].map(line).into_iter().chain(backdrop).collect()
        }
        Row::SmallPlates => {
            // |n.q| of a right triangle with legs of 2^-10 m is 2^-21, less than 1e-6.
            let small = |column: f64| {
                let (x, leg) = (x_at(column, s), s / 1024.0);
                let at = |dx: f64, dy: f64| DVec3::new(x + dx * leg, y + dy * leg, s);
                let corners = [at(-0.25, -0.25), at(-0.25, 0.75), at(0.75, 0.75), at(0.75, -0.25)];
                halves(corners).map(|one| showing(Side::Front, one, DVec3::new(0.0, y, 0.0)))
            };
            [-4.0, -2.0, 0.0, 2.0, 4.0].into_iter().flat_map(small).chain(backdrop).collect()
        }
        Row::PlateBesideRay => {
            let gap = s / f64::from(1 << 26);
            [strip([-gap, s], [-s / 4.0, s]), backdrop].concat()
        }
    }
}

/// A wall at the depth 2 s of squares between the x of the rays, moved by `shift` of a square, and the lines y + s k / 16
/// for each k of `lines`. The first corner of its faces and the direction of their diagonals vary, so that each edge of a face
/// meets each edge of a neighbour.
fn squares(y: f64, s: f64, shift: f64, lines: &[f64]) -> Vec<Triangle> {
    let z = 2.0 * s;
    let at = |k: i32, line: f64| DVec3::new(z * (f64::from(k) + shift) / 16.0, y + s / 16.0 * line, z);
    let mut faces = Vec::new();
    for k in -13..13_i32 {
        for pair in lines.windows(2) {
            let [a, b, c, d] = [at(k, pair[0]), at(k, pair[1]), at(k + 1, pair[1]), at(k + 1, pair[0])];
            let number = faces.len();
            let cut =
                if (number / 2).is_multiple_of(2) { halves([a, b, c, d]) } else { halves([b, c, d, a]) };
            for (of_square, one) in cut.into_iter().enumerate() {
                let face = showing(Side::Front, one, DVec3::new(0.0, y, 0.0));
                faces.push(turned(face, (number / 3 + 2 * of_square) % 3));
            }
        }
    }
    faces
}
