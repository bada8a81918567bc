//! The paper's two scenes: pyramids on a plane, and about 256 triangular facets. (Paper, §9, figures 11 to 16)
//!
//! The paper prints neither; both are laid out afresh for the default rig. Standing at (0, 0) and looking
//! along +x, its sensors are at x = 0.3 m, and on level ground its stripes lie at x = 3.3 m (3.5 m wide)
//! and x = 5.25 m (6.2 m wide). The paper's drive ends there and starts 7.5 m before: the strip of x from
//! -9 to 1 m within 1.3 m of the x axis is left free of pyramids.

use glam::DVec3;
use raypencil_scene::Material;

use crate::Ground;
use crate::draws::{Draws, Purpose};

/// The names that [`builtin`] knows.
pub const BUILTIN_NAMES: &[&str] = &["pyramids", "facets"];

/// One of the paper's two scenes, all of one `reflectivity` (0 to 1), or `None` for an unknown name.
pub fn builtin(name: &str, reflectivity: f64) -> Option<Ground> {
    let materials = vec![Material { name: "ground".into(), reflectivity }];
    let empty = Ground { materials, ..Ground::default() };
    match name {
        "pyramids" => Some(pyramids(empty)),
        "facets" => Some(facets(empty)),
        _ => None,
    }
}

/// A square pyramid as the plane shows it, metres and radians.
struct Pyramid {
    x: f64,
    y: f64,
    /// Half the side of its base, at the level of the plane.
    half_side: f64,
    /// Of the apex above the plane.
    height: f64,
    /// About the vertical.
    turn: f64,
}

const fn pyramid(x: f64, y: f64, half_side: f64, height: f64, turn: f64) -> Pyramid {
    Pyramid { x, y, half_side, height, turn }
}

/// Where the pyramids stand. No coordinate is round, so that no vertex, edge or side lines up with a
/// sensor's axes or rays.
const PYRAMIDS: [Pyramid; 16] = [
    // Before the first stripe, tall: it cuts that stripe, and hides part of the second, which passes above
    // it (at x = 2.3 m the second sheet is 1.2 m high), from the camera 0.5 m below.
    pyramid(2.313, -0.827, 0.42, 1.03, 0.31),
    // Across the first stripe.
    pyramid(3.437, 0.563, 0.53, 0.62, 0.17),
    // Across the second stripe; the second and third of these run into one another.
    pyramid(5.149, 0.347, 0.37, 0.43, 0.52),
    pyramid(4.871, 1.437, 0.51, 0.81, 0.71),
    pyramid(5.613, 1.751, 0.47, 0.58, 0.23),
    pyramid(5.367, -1.271, 0.56, 1.17, 1.02),
    // Behind the stripes, in the camera's view.
    pyramid(7.931, -2.897, 0.88, 1.19, 0.37),
    pyramid(8.627, 1.093, 0.79, 0.94, 1.21),
    pyramid(6.743, 3.829, 0.57, 0.66, 0.83),
    pyramid(10.413, 4.387, 0.91, 1.08, 0.11),
    pyramid(11.719, -0.583, 0.73, 0.77, 0.64),
    // Beside the drive, within the stripes of the way there.
    pyramid(-4.877, 2.129, 0.47, 0.52, 0.44),
    pyramid(-2.693, -2.231, 0.63, 0.89, 1.33),
    pyramid(-1.579, 2.377, 0.58, 0.73, 0.27),
    pyramid(0.457, -2.619, 0.71, 0.97, 0.92),
    pyramid(1.283, 2.843, 0.49, 0.47, 0.58),
];

/// Sixteen square pyramids on a plane of 40 x 40 m.
///
/// CHOICE: the plane goes on under the pyramids, and each pyramid is a closed body of its own that reaches
/// 5 cm below the plane. Features are put on a ground in the same way in the paper (§3), two of them may
/// overlap, and neither ground nor body has an opening through which a back could be seen. Where they
/// cross there is no shared edge, which is what most scanned and modelled terrain looks like. The plane is
/// cut in 8 x 8 cells, so that stripes also run over shared edges of flat ground; the whole is turned a
/// little against the axes.
fn pyramids(mut ground: Ground) -> Ground {
    const CELLS: u32 = 8;
    const HALF_SIDE: f64 = 20.0;
    // The drive begins at x = -7.5 m and looks 20 m ahead: the plane's middle is between start and sight.
    const MIDDLE: DVec3 = DVec3::new(3.19, 0.43, 0.0);
    const TURN: f64 = 0.113;
    const SUNK: f64 = 0.05;

    let (sin, cos) = libm::sincos(TURN);
    let place = |column: u32, row: u32| {
        let step = 2.0 * HALF_SIDE / f64::from(CELLS);
        let (x, y) = (step * f64::from(column) - HALF_SIDE, step * f64::from(row) - HALF_SIDE);
        MIDDLE + DVec3::new(cos * x - sin * y, sin * x + cos * y, 0.0)
    };
    let mut falling = false;
    let alternate = || {
        falling = !falling;
        falling
    };
    ground.height_field(CELLS, CELLS, place, alternate, || 0);
    for Pyramid { x, y, half_side, height, turn } in PYRAMIDS {
        // The same flanks, continued below the plane.
        let deeper = (height + SUNK) / height;
        ground.pyramid(DVec3::new(x, y, -SUNK), half_side * deeper, height + SUNK, turn, 0);
    }
    ground
}

/// Two hundred and fifty-six facets: 16 x 8 cells of 1.5 m, each corner moved at random by up to 0.3 m and
/// up or down by up to 0.6 m.
///
/// CHOICE: heights are independent from corner to corner, so that half of the facets are steeper than 20
/// degrees and they shadow each other as much as the paper reports of its second scene; towards (0, 0)
/// heights shrink to 5 %, so that a rover can stand there.
fn facets(mut ground: Ground) -> Ground {
    const COLUMNS: u32 = 16;
    const ROWS: u32 = 8;
    const CELL: f64 = 1.5;
    const CORNER: DVec3 = DVec3::new(-10.1, -6.1, 0.0);
    const JITTER: f64 = 0.2 * CELL;
    const RELIEF: f64 = 0.6;
    // Calm within the first of these distances from (0, 0), full relief from the second on, metres.
    const CALM: (f64, f64) = (0.9, 3.0);

    let mut draws = Draws::new(256, Purpose::Grid);
    let place = |column: u32, row: u32| {
        let grid = CORNER + DVec3::new(CELL * f64::from(column), CELL * f64::from(row), 0.0);
        let moved = grid + DVec3::new(draws.between(-JITTER, JITTER), draws.between(-JITTER, JITTER), 0.0);
        let share = ((moved.length() - CALM.0) / (CALM.1 - CALM.0)).clamp(0.0, 1.0);
        let relief = RELIEF * (0.05 + 0.95 * share * share * (3.0 - 2.0 * share));
        moved + DVec3::new(0.0, 0.0, draws.between(-relief, relief))
    };
    let mut diagonals = Draws::new(256, Purpose::Diagonals);
    ground.height_field(COLUMNS, ROWS, place, || diagonals.coin(), || 0);
    ground
}

#[cfg(test)]
mod tests {
    use raypencil_scene::Mesh;

    use super::*;
    use crate::ground::tests::{assert_closed_and_outward, normal};
    use crate::height_at;

    fn bounds(ground: &Ground) -> (DVec3, DVec3) {
        let low = ground.vertices.iter().fold(DVec3::INFINITY, |low, v| low.min(*v));
        let high = ground.vertices.iter().fold(DVec3::NEG_INFINITY, |high, v| high.max(*v));
        (low, high)
    }

    #[test]
    fn every_name_builds_a_mesh_without_zero_area_and_no_other_name_does() {
        for name in BUILTIN_NAMES {
            let ground = builtin(name, 0.3).unwrap();
            assert_eq!(ground.materials[0].reflectivity, 0.3);
            let mesh = ground.into_mesh().unwrap();
            assert_eq!(mesh.zero_area_faces(), 0);
            assert_eq!(mesh.origin(), DVec3::ZERO);
        }
        assert_eq!(builtin("Pyramids", 0.3), None);
    }

    #[test]
    fn pyramids_are_closed_bodies_on_a_plane() {
        let ground = builtin("pyramids", 0.25).unwrap();
        // 8 x 8 cells of two faces, 16 pyramids of four flanks and a base of two.
        assert_eq!(ground.faces.len(), 128 + 96);
        for &face in &ground.faces[..128] {
            let n = normal(&ground, face);
            assert!(n.x == 0.0 && n.y == 0.0 && n.z > 0.0);
        }
        for body in 0..16 {
            assert_closed_and_outward(&ground, 128 + 6 * body..128 + 6 * (body + 1));
        }
        // A square of 40 m turned by 0.113 rad: half of its width is 20 (cos + sin) = 22.13 m.
        let (low, high) = bounds(&ground);
        assert!((high.x - 3.19 - 22.13).abs() < 0.01 && (low.x - 3.19 + 22.13).abs() < 0.01);
        assert_eq!((low.z, high.z), (-0.05, -0.05 + (1.19 + 0.05)));
    }

    #[test]
    fn pyramids_stand_where_they_are_listed_and_leave_the_drive_free() {
        let mesh = builtin("pyramids", 0.25).unwrap().into_mesh().unwrap();
        for Pyramid { x, y, height, .. } in PYRAMIDS {
            // The apex, rounded to f32 (under 1e-6 m), on flanks no steeper than 3 : 1.
            let z = height_at(&mesh, x, y).unwrap();
            assert!((z - height).abs() < 5e-6, "{z} at {x}, {y}");
        }
        for step in 0..=100 {
            let x = -9.0 + 0.1 * f64::from(step);
            for y in [-1.3, -0.65, 0.0, 0.65, 1.3] {
                assert_eq!(height_at(&mesh, x, y), Some(0.0), "at {x}, {y}");
            }
        }
    }

    /// Whether the straight line from above (0.3, 0) at `height` to the level point (x, y, 0) clears the
    /// terrain: in steps of a 400th, coarse but enough for pyramids.
    fn is_clear(mesh: &Mesh, height: f64, x: f64, y: f64) -> bool {
        let from = DVec3::new(0.3, 0.0, height);
        (1..400).map(|step| from.lerp(DVec3::new(x, y, 0.0), f64::from(step) / 400.0)).all(|point| {
            let ground = height_at(mesh, point.x, point.y).unwrap();
            ground < point.z
        })
    }

    #[test]
    fn pyramids_cut_shadow_and_hide_the_stripes() {
        let mesh = builtin("pyramids", 0.25).unwrap().into_mesh().unwrap();
        // Points of the two stripes on level ground, every 5 cm: lit if the way from the beam is clear and
        // no pyramid stands there; hidden if lit, but the way from the camera, 1.5 m up, is not clear.
        let count = |height: f64, x: f64, half_width: f64| {
            let (mut lit, mut hidden, mut all) = (0, 0, 0);
            for step in 0..=(half_width / 0.025) as i32 {
                let y = 0.05 * f64::from(step) - half_width;
                all += 1;
                if height_at(&mesh, x, y) == Some(0.0) && is_clear(&mesh, height, x, y) {
                    lit += 1;
                    hidden += i32::from(!is_clear(&mesh, 1.5, x, y));
                }
            }
            (all, lit, hidden)
        };
        let (all, lit, _) = count(1.8, 3.296, 1.73);
        assert!(lit > all / 3 && lit < all * 3 / 4, "first stripe: {lit} of {all} lit");
        let (all, lit, hidden) = count(2.0, 5.250, 2.86);
        assert!(lit > all / 3 && lit < all * 3 / 4, "second stripe: {lit} of {all} lit");
        assert!(hidden > all / 20, "second stripe: {hidden} of {all} lit but hidden");
    }

    #[test]
    fn facets_are_256_faces_that_look_up() {
        let ground = builtin("facets", 0.25).unwrap();
        assert_eq!((ground.faces.len(), ground.vertices.len()), (256, 17 * 9));
        assert!(ground.faces.iter().all(|&face| normal(&ground, face).z > 0.0));
        let (low, high) = bounds(&ground);
        assert!(low.x > -10.4 && high.x < 14.2 && low.y > -6.4 && high.y < 6.2);
        assert!(low.z > -0.6 && low.z < -0.5 && high.z < 0.6 && high.z > 0.5);
        // At least half of them are steeper than 20 degrees, tan 20 = 0.364.
        let steep = |n: DVec3| n.truncate().length() > 0.364 * n.z;
        assert!(ground.faces.iter().filter(|&&face| steep(normal(&ground, face))).count() >= 128);
    }

    #[test]
    fn a_rover_can_stand_on_the_facets() {
        let mesh = builtin("facets", 0.25).unwrap().into_mesh().unwrap();
        // Within half a metre of (0, 0) the ground stays within 10 cm: 5 % of 0.6 m at corners within
        // 0.9 m, rising over at most one cell of 1.5 m beyond.
        let z = height_at(&mesh, 0.0, 0.0).unwrap();
        assert!(z.abs() < 0.1, "{z}");
        for (x, y) in [(0.5, 0.0), (-0.5, 0.0), (0.0, 0.5), (0.0, -0.5)] {
            let near = height_at(&mesh, x, y).unwrap();
            assert!((near - z).abs() < 0.1, "{near} against {z}");
        }
    }

    #[test]
    fn nothing_lies_on_the_axes_of_the_sensors() {
        // The rig looks along +x from (0.3, 0): no vertex within 1 mm of that vertical plane, or of the one
        // across it through the sensors.
        for name in BUILTIN_NAMES {
            for v in builtin(name, 0.25).unwrap().vertices {
                assert!(v.y.abs() > 1e-3 && (v.x - 0.3).abs() > 1e-3, "{name}: {v}");
            }
        }
    }
}
