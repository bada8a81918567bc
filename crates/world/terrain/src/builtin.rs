//! The paper's two scenes: pyramids on a plane, and 256 triangular facets. (Paper, §9, figures 11 to 16)
//!
//! CHOICE: the paper does not print their coordinates, so both are laid out for the default rig. Its sensors look
//! along +x from x = 0.3 m. On level ground its stripes lie at x = 3.3 m (3.5 m wide) and x = 5.25 m (6.2 m
//! wide). The paper's drive ends at (0, 0) and starts 7.5 m before: the strip of x from -9 to 1 m within 1.3 m of
//! the x axis stays free of pyramids.

use glam::DVec3;
use raypencil_scene::Material;

use crate::Ground;
use crate::random_stream::{RandomStream, StreamPurpose};

/// Names that [`builtin`] accepts.
pub const BUILTIN_NAMES: &[&str] = &["pyramids", "facets"];

/// Ground by its name, in one material of this `reflectivity` (0 to 1); `None` for an unknown name.
///
/// ```
/// use raypencil_terrain::{builtin, height_at};
///
/// let pyramids = builtin("pyramids", 0.25).expect("a built-in name");
/// // A plane of 8 x 8 cells of two faces, and 16 pyramids of four flanks and a base of two faces.
/// assert_eq!(pyramids.faces.len(), 2 * 8 * 8 + 16 * 6);
/// // The rover stands at (0, 0), on the plane z = 0.
/// assert_eq!(height_at(&pyramids.into_mesh()?, 0.0, 0.0), Some(0.0));
///
/// // 16 x 8 cells of two facets.
/// assert_eq!(builtin("facets", 0.25).expect("a built-in name").faces.len(), 256);
/// # Ok::<(), raypencil_scene::SceneError>(())
/// ```
pub fn builtin(name: &str, reflectivity: f64) -> Option<Ground> {
    let materials = vec![Material { name: "ground".into(), reflectivity }];
    let empty = Ground { materials, ..Ground::default() };
    match name {
        "pyramids" => Some(pyramids(empty)),
        "facets" => Some(facets(empty)),
        _ => None,
    }
}

/// Square pyramid on the plane, metres and radians.
struct Pyramid {
    x: f64,
    y: f64,
    /// Half the side of its base at the level of the plane.
    half_side: f64,
    /// Height of the apex above the plane.
    height: f64,
    /// Rotation about the vertical.
    rotation: f64,
}

const fn pyramid(x: f64, y: f64, half_side: f64, height: f64, rotation: f64) -> Pyramid {
    Pyramid { x, y, half_side, height, rotation }
}

/// Positions and sizes of the pyramids. No coordinate is round: no vertex, edge or side lines up with a sensor's
/// axes or rays.
const PYRAMIDS: [Pyramid; 16] = [
    // A tall one before the first stripe: it cuts that stripe. It also hides part of the second stripe from the
    // camera, which is 0.5 m below the second beam (at x = 2.3 m that sheet is 1.2 m high).
    pyramid(2.313, -0.827, 0.42, 1.03, 0.31),
    // Across the first stripe.
    pyramid(3.437, 0.563, 0.53, 0.62, 0.17),
    // Across the second stripe; the second and third of these overlap.
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
    // Beside the drive, within reach of the stripes on the way.
    pyramid(-4.877, 2.129, 0.47, 0.52, 0.44),
    pyramid(-2.693, -2.231, 0.63, 0.89, 1.33),
    pyramid(-1.579, 2.377, 0.58, 0.73, 0.27),
    pyramid(0.457, -2.619, 0.71, 0.97, 0.92),
    pyramid(1.283, 2.843, 0.49, 0.47, 0.58),
];

/// Sixteen square pyramids on a plane of 40 x 40 m.
///
/// CHOICE: the plane continues under the pyramids, and each pyramid is a closed body that reaches 5 cm below the
/// plane. The paper puts features on a ground in the same way (§3). Two bodies may overlap, and there is no
/// opening through which a back could be seen. Where bodies cross there is no shared edge, as in most scanned and
/// modelled terrain. The plane has 8 x 8 cells, so that stripes also cross shared edges of flat ground. It is
/// turned a little against the axes.
fn pyramids(mut ground: Ground) -> Ground {
    const CELLS: u32 = 8;
    const HALF_SIDE_M: f64 = 20.0;
    // The drive begins at x = -7.5 m and the camera looks 20 m ahead: the plane's centre lies between the two.
    const CENTRE_M: DVec3 = DVec3::new(3.19, 0.43, 0.0);
    const ROTATION_RAD: f64 = 0.113;
    const DEPTH_BELOW_PLANE_M: f64 = 0.05;

    let (sin, cos) = libm::sincos(ROTATION_RAD);
    let place = |column: u32, row: u32| {
        let step = 2.0 * HALF_SIDE_M / f64::from(CELLS);
        let (x, y) = (step * f64::from(column) - HALF_SIDE_M, step * f64::from(row) - HALF_SIDE_M);
        CENTRE_M + DVec3::new(cos * x - sin * y, sin * x + cos * y, 0.0)
    };
    let mut falling = false;
    let alternate = || {
        falling = !falling;
        falling
    };
    ground.add_height_field(CELLS, CELLS, place, alternate, || 0);
    for Pyramid { x, y, half_side, height, rotation } in PYRAMIDS {
        // The flanks continue below the plane with the same slope.
        let deeper = (height + DEPTH_BELOW_PLANE_M) / height;
        ground.add_pyramid(
            DVec3::new(x, y, -DEPTH_BELOW_PLANE_M),
            half_side * deeper,
            height + DEPTH_BELOW_PLANE_M,
            rotation,
            0,
        );
    }
    ground
}

/// 256 facets: 16 x 8 cells of 1.5 m. Each corner moves at random by up to 0.3 m sideways and up to 0.6 m up or
/// down.
///
/// CHOICE: heights are independent from corner to corner. Half of the facets are steeper than 20 degrees, and
/// they shadow each other as much as the paper reports of its second scene. Towards (0, 0) heights shrink to 5 %,
/// so that a rover can stand there.
fn facets(mut ground: Ground) -> Ground {
    const COLUMNS: u32 = 16;
    const ROWS: u32 = 8;
    const CELL_M: f64 = 1.5;
    const CORNER_M: DVec3 = DVec3::new(-10.1, -6.1, 0.0);
    const MAX_SHIFT_M: f64 = 0.2 * CELL_M;
    const MAX_HEIGHT_M: f64 = 0.6;
    // Distances from (0, 0), metres: up to the first the relief is 5 %, from the second on it is full.
    const CALM_RADII_M: (f64, f64) = (0.9, 3.0);

    let mut random = RandomStream::new(256, StreamPurpose::Grid);
    let place = |column: u32, row: u32| {
        let grid = CORNER_M + DVec3::new(CELL_M * f64::from(column), CELL_M * f64::from(row), 0.0);
        let moved = grid
            + DVec3::new(
                random.between(-MAX_SHIFT_M, MAX_SHIFT_M),
                random.between(-MAX_SHIFT_M, MAX_SHIFT_M),
                0.0,
            );
        let share = ((moved.length() - CALM_RADII_M.0) / (CALM_RADII_M.1 - CALM_RADII_M.0)).clamp(0.0, 1.0);
        let relief = MAX_HEIGHT_M * (0.05 + 0.95 * share * share * (3.0 - 2.0 * share));
        moved + DVec3::new(0.0, 0.0, random.between(-relief, relief))
    };
    let mut diagonals = RandomStream::new(256, StreamPurpose::Diagonals);
    ground.add_height_field(COLUMNS, ROWS, place, || diagonals.coin(), || 0);
    ground
}

#[cfg(test)]
#[path = "../tests/unit/builtin.rs"]
mod tests;
