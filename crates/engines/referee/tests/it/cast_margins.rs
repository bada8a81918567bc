//! How far any ray may be moved sideways: closed forms by hand, and rays that look for a change within the margin.

use glam::DVec3;
use proptest::prelude::*;
use raypencil_referee::{Displacement, ExactCast, Margin};
use raypencil_scene::{CastRay, FaceId, Reading, Sides, Triangles};

/// A ray straight down. Across it, u is y and v is x.
fn down(x: f64, y: f64, z: f64) -> CastRay {
    CastRay::new(DVec3::new(x, y, z), DVec3::NEG_Z)
}

fn mesh(vertices: &[[f64; 3]], faces: &[[u32; 3]]) -> Triangles {
    Triangles::new(vertices.to_vec(), faces.to_vec()).unwrap()
}

/// The margin is this number, but for a few units in the last place of both ends.
#[track_caller]
fn assert_is(margin: Margin, expected: f64) {
    let close = 1e-11 * expected;
    assert!(margin.lo <= expected && margin.lo >= expected - close, "{margin:?} is not {expected}");
    assert!(margin.hi >= expected && margin.hi <= expected * 1.001 + 1e-300, "{margin:?} is not {expected}");
}

const SQUARE: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];

#[test]
fn a_step_ends_the_surface_and_an_edge_between_two_faces_does_not() {
    // A square at 0 and beside it, from x = 1 to 3, one at -1: seen from above, a step at x = 1.
    let lower = [[1.0, -1.0, -1.0], [3.0, -1.0, -1.0], [3.0, 2.0, -1.0], [1.0, 2.0, -1.0]];
    let vertices: Vec<_> = SQUARE.into_iter().chain(lower).collect();
    let mesh = mesh(&vertices, &[[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]]);
    let cast = ExactCast::new(&mesh);
    let margins = cast.margins(&down(0.875, 0.5, 4.0), Sides::Both);
    // The step is 1/8 away. The diagonal, x = y, is 3/16 away: 3/8 over two.
    assert_is(margins.face, 0.125);
    assert_is(margins.surface, 0.125);
    let margins = cast.margins(&down(0.625, 0.5, 4.0), Sides::Both);
    assert_is(margins.face, 0.0625);
    assert_is(margins.surface, 0.375);
    // From the lower square the step is an edge of the upper face that hides it.
    let margins = cast.margins(&down(1.5, 0.5, 4.0), Sides::Both);
    assert_is(margins.surface, 0.5);
    // A miss: 1/4 from the lower square's border. Both margins are the same.
    let margins = cast.margins(&down(3.25, 0.5, 4.0), Sides::Both);
    assert_is(margins.face, 0.25);
    assert_eq!(margins.face, margins.surface);
    // Through the diagonal: any displacement changes the faces.
    let margins = cast.margins(&down(0.5, 0.5, 4.0), Sides::Both);
    assert!(margins.face.lo == 0.0 && margins.face.hi < 1e-15, "{margins:?}");
    assert_is(margins.surface, 0.5);
    // On the border: any displacement makes a miss, or not; the surface ends here.
    let margins = cast.margins(&down(0.25, 0.0, 4.0), Sides::Both);
    assert!(margins.surface.lo == 0.0 && margins.surface.hi < 1e-15, "{margins:?}");
}

/// The witness of a step is hardly past it: 2^-40 of the margin along the border, on either side of its nearest place, and a 16th of that
/// beyond.
#[test]
fn a_witness_is_close_behind_the_border() {
    let square = mesh(&SQUARE, &[[0, 1, 2], [0, 2, 3]]);
    let cast = ExactCast::new(&square);
    // The border y = 0 is nearest, and the first part of a displacement is along y.
    let margin = cast.margins(&down(0.5, 0.25, 4.0), Sides::Both).surface;
    let by = margin.witness.expect("a witness");
    let along = 0.25 / (1u64 << 40) as f64;
    assert_eq!(by.dx, -0.25 - along / 16.0);
    assert!((by.dy.abs() / along - 1.0).abs() < 1e-12, "{by:?}");
    // A hole of three sides, whose side x = 1/4 is nearest and shorter than that. Beyond its far end no ray is in the hole; a 16th of
    // the way along, and a 256th beyond, it is.
    let short = 1.0 / (1u64 << 44) as f64;
    let outer = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]];
    let hole = [[0.25, -0.5 * short, 0.0], [0.25, 0.5 * short, 0.0], [0.25 + short, 0.0, 0.0]];
    let vertices: Vec<_> = outer.into_iter().chain(hole).collect();
    let around = [[0, 1, 4], [4, 1, 6], [6, 1, 2], [6, 2, 5], [5, 2, 3], [5, 3, 4], [4, 3, 0]];
    let holed = mesh(&vertices, &around);
    let margin = ExactCast::new(&holed).margins(&down(0.0, 0.0, 4.0), Sides::Both).surface;
    let by = margin.witness.expect("a witness");
    assert_eq!((by.dx.abs(), by.dy), (0.4375 * short, 0.25 + short / 256.0), "{by:?}");
}

#[test]
fn many_faces_in_one_place_have_the_margins_of_one() {
    // Copies of a face, also begun at another corner and turned over.
    let copies: Vec<[u32; 3]> =
        (0..300).map(|k| [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1]][k % 4]).collect();
    let (one, many) = (mesh(&SQUARE, &copies[..1]), mesh(&SQUARE, &copies));
    let ray = down(0.625, 0.25, 4.0);
    let [alone, among] = [&one, &many].map(|mesh| ExactCast::new(mesh).margins(&ray, Sides::Both));
    assert_is(alone.face, 0.1875);
    assert_is(among.face, 0.1875);
    assert_is(among.surface, 0.1875);
    // One of them in another plane, met at the same point: any displacement tells them apart.
    let tilted: Vec<[f64; 3]> =
        SQUARE.into_iter().chain([[0.25, 0.25, -1.0], [1.0, 0.25, 1.0], [0.625, 1.0, 0.0]]).collect();
    let crossing: Vec<[u32; 3]> = copies.iter().copied().chain([[4, 5, 6]]).collect();
    let margins = ExactCast::new(&mesh(&tilted, &crossing)).margins(&ray, Sides::Both);
    assert!(margins.face.lo == 0.0, "{margins:?}");
}

#[test]
fn a_slanted_face_that_comes_too_near_ends_both_margins() {
    // The plane z = x, of one large triangle, seen from z = 4: t = 4 - x. A sensor that is blind before t = 3 measures up to x = 1.
    let corners = [[-64.0, -64.0, -64.0], [192.0, -64.0, 192.0], [-64.0, 192.0, -64.0]];
    let plane = mesh(&corners, &[[0, 1, 2]]);
    let cast = ExactCast::new(&plane);
    let at = |x: f64| cast.margins(&CastRay { t_blind: 3.0, ..down(x, 0.0, 4.0) }, Sides::Both);
    for (x, expected) in [(0.25, 0.75), (1.5, 0.5)] {
        let margins = at(x);
        assert_is(margins.face, expected);
        assert_is(margins.surface, expected);
        // The witness is on the other side.
        let by = margins.face.witness.expect("a witness");
        assert_eq!(x + by.dy > 1.0, x < 1.0, "{margins:?}");
    }
    // At exactly t = 3 it is measured, and the smallest displacement makes it too near.
    assert!(at(1.0).face.lo == 0.0 && at(1.0).face.hi < 1e-12, "{:?}", at(1.0));
    // Without a shortest range nothing changes up to where the plane passes the start of the ray, at x = 4.
    assert_is(cast.margins(&down(0.25, 0.0, 4.0), Sides::Both).face, 3.75);
}

#[test]
fn faces_that_cross_where_they_are_met_are_told_apart_by_a_size_that_f64_can_tell() {
    // Two planes through the line x = 15/8, z = 0, which sink to one side each.
    let vertices = [
        [-2.125, -9.0, -4.0],
        [5.875, -9.0, 4.0],
        [1.875, 9.0, 0.0],
        [-2.125, -9.0, 4.0],
        [5.875, -9.0, -4.0],
    ];
    let crossed = mesh(&vertices, &[[0, 1, 2], [3, 4, 2]]);
    let cast = ExactCast::new(&crossed);
    let ray = down(1.875, -4.0, 5.0);
    assert_eq!(cast.first(&ray, Sides::Both).len(), 2);
    let margin = cast.margins(&ray, Sides::Both).face;
    // 2^-52 of the largest coordinate.
    let smallest = 9.0 * f64::EPSILON;
    assert!(margin.lo == 0.0 && smallest <= margin.hi && margin.hi <= 2.0 * smallest, "{margin:?}");
}

#[test]
fn margins_are_capped_at_the_diagonal_of_the_box() {
    // A square of side 2^20 met in its middle, and one far away.
    let square = SQUARE.map(|v| v.map(|x| x * 1_048_576.0));
    let large = mesh(&square, &[[0, 1, 2], [0, 2, 3]]);
    let diagonal = 1_048_576.0 * 2.0_f64.sqrt();
    let far = ExactCast::new(&large).margins(&down(1e8, 0.0, 1.0), Sides::Both);
    assert_eq!((far.face.lo, far.face.hi, far.face.witness), (diagonal, diagonal, None));
    assert_eq!(far.surface, far.face);
    let empty = mesh(&[], &[]);
    let nothing = ExactCast::new(&empty).margins(&down(0.0, 0.0, 1.0), Sides::Both);
    assert_eq!((nothing.face.lo, nothing.surface.hi), (0.0, 0.0));
}

#[test]
fn the_ends_of_the_ray_cut_faces_off() {
    // A ramp z = x from 0 to 8. From above at z = 10, t = 10 - x.
    let ramp =
        mesh(&[[0.0, 0.0, 0.0], [8.0, 0.0, 8.0], [8.0, 8.0, 8.0], [0.0, 8.0, 0.0]], &[[0, 1, 2], [0, 2, 3]]);
    let cast = ExactCast::new(&ramp);
    let ray = down(4.0, 3.0, 10.0);
    assert_is(cast.margins(&ray, Sides::Both).surface, 3.0);
    // It ends at t = 6.25: at x = 3.75 the ramp is beyond its end.
    let ended = CastRay { t_max: 6.25, ..ray };
    assert_is(cast.margins(&ended, Sides::Both).surface, 0.25);
    assert_is(cast.margins(&ended, Sides::Both).face, 0.25);
    // It starts at t = 5.875: at x = 4.125 the ramp is before its start.
    let started = CastRay { t_min: 5.875, ..ray };
    assert_is(cast.margins(&started, Sides::Both).surface, 0.125);
    // Exactly at its end: the least displacement makes a miss.
    let touched = cast.margins(&CastRay { t_max: 6.0, ..ray }, Sides::Both);
    assert!(touched.surface.lo == 0.0 && touched.surface.hi < 1e-14, "{touched:?}");
    // A corner that only touches the start is a hit of one ray; a fan around it in both directions is a surface.
    let corner = mesh(&[[0.0, 0.0, 0.0], [2.0, -1.0, 2.0], [2.0, 1.0, 2.0]], &[[0, 1, 2]]);
    let touched = CastRay { t_min: 4.0, ..down(0.0, 0.0, 4.0) };
    let margins = ExactCast::new(&corner).margins(&touched, Sides::Both);
    assert!(margins.face.lo == 0.0 && margins.face.hi < 1e-14, "{margins:?}");
    assert!(margins.surface.lo == 0.0 && margins.surface.hi < 1e-14, "{margins:?}");
    let beside = CastRay { t_min: 4.0, ..down(-0.25, 0.125, 4.0) };
    assert_is(ExactCast::new(&corner).margins(&beside, Sides::Both).surface, 0.25);
    // Hidden below a square, it is not seen.
    let hidden = mesh(
        &[
            [0.0, 0.0, 0.0],
            [2.0, -1.0, -2.0],
            [2.0, 1.0, -2.0],
            [-4.0, -4.0, 1.0],
            [4.0, -4.0, 1.0],
            [0.0, 4.0, 1.0],
        ],
        &[[0, 1, 2], [3, 4, 5]],
    );
    let ended = CastRay { t_max: 4.0, ..down(0.25, 0.125, 4.0) };
    assert_is(ExactCast::new(&hidden).margins(&ended, Sides::Both).surface, 1.125);
    // A direction of another length: t is another, the margin is the same.
    let power = libm::scalbn(1.0, 60);
    let long = CastRay { direction: ray.direction / power, t_max: 6.25 * power, ..ray };
    assert_is(cast.margins(&long, Sides::Both).surface, 0.25);
}

/// In the middle of a large surface all faces of a node, and those behind their edges, show one side. There is no border, but an end of the
/// ray makes one.
#[test]
fn an_end_of_the_ray_cuts_faces_off_where_all_around_show_the_same_side() {
    let (mut vertices, mut faces) = (Vec::new(), Vec::new());
    for x in 0..17 {
        vertices.extend((0..17).map(|y| [f64::from(x), f64::from(y), f64::from(x)]));
    }
    for x in 0..16 {
        for corner in (0..16).map(|y| 17 * x + y) {
            faces.extend([[corner, corner + 17, corner + 18], [corner, corner + 18, corner + 1]]);
        }
    }
    let ramp = mesh(&vertices, &faces);
    let cast = ExactCast::new(&ramp);
    for sides in [Sides::Fronts, Sides::Both] {
        // From above at z = 20, t = 20 - x, so that it ends at x = 8.
        let ended = CastRay { t_max: 12.0, ..down(8.25, 8.25, 20.0) };
        assert_is(cast.margins(&ended, sides).surface, 0.25);
        let started = CastRay { t_min: 12.0, ..down(7.625, 8.25, 20.0) };
        assert_is(cast.margins(&started, sides).surface, 0.375);
    }
}

/// The condition of an end is 0 all over a face that lies in it, and ends it nowhere: the diagonal of a square there is as
/// little a jump as elsewhere.
#[test]
fn a_surface_that_lies_in_an_end_of_the_ray_ends_at_its_border_alone() {
    let square =
        mesh(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]], &[[0, 1, 2], [0, 2, 3]]);
    let cast = ExactCast::new(&square);
    for (x, y, expected) in [(0.5, 0.25, 0.25), (0.5, 0.5, 0.5), (0.125, 0.75, 0.125)] {
        let ray = down(x, y, 8.0);
        for ended in [CastRay { t_max: 8.0, ..ray }, CastRay { t_min: 8.0, ..ray }] {
            for sides in [Sides::Both, Sides::Fronts] {
                let margins = cast.margins(&ended, sides);
                assert_is(margins.surface, expected);
                let by = margins.surface.witness.expect("a witness").to_array();
                assert!(cast.first_moved(&ended, sides, by).is_empty(), "{margins:?}");
            }
        }
    }
}

/// Another face enters a hundred billionth before the nearest one ends. That is no event of its own, but what is proven is the
/// smaller size.
#[test]
fn a_face_that_enters_a_little_before_the_nearest_ends_lowers_the_proven_size() {
    let (end, start) = (0.5, 0.5 * (1.0 - 1e-11));
    let both = mesh(
        &[
            [-9.0, -9.0, 0.0],
            [end, -9.0, 0.0],
            [end, 9.0, 0.0],
            [start, -9.0, 1.0],
            [9.0, -9.0, 1.0],
            [start, 9.0, 1.0],
        ],
        &[[0, 1, 2], [3, 4, 5]],
    );
    let cast = ExactCast::new(&both);
    let ray = down(0.0, 0.0, 4.0);
    assert_eq!(cast.first_moved(&ray, Sides::Both, [0.0, start * ray.across()[1].x]), [FaceId(1)]);
    let Margin { lo, hi, .. } = cast.margins(&ray, Sides::Both).face;
    assert!(lo <= start && start <= hi, "{lo} {hi}");
    assert!(hi - lo < 1e-10);
}

#[test]
fn a_hidden_border_is_no_jump_and_a_crossing_is_none_either() {
    // Below a large square, seen from above, lies a small one: its border is hidden. Two slopes cross in a valley
    // without a common edge: there t does not jump.
    let large = [[-8.0, -8.0, 1.0], [8.0, -8.0, 1.0], [8.0, 8.0, 1.0], [-8.0, 8.0, 1.0]];
    let vertices: Vec<_> = SQUARE.into_iter().chain(large).collect();
    let hidden = mesh(&vertices, &[[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]]);
    assert_is(ExactCast::new(&hidden).margins(&down(0.5, 0.25, 4.0), Sides::Both).surface, 7.5);
    // From below the small one hides the large: its border is 1/4 away.
    let up = CastRay { direction: DVec3::Z, ..down(0.5, 0.25, -4.0) };
    assert_is(ExactCast::new(&hidden).margins(&up, Sides::Both).surface, 0.25);
    // Both are seen from behind then: fronts only, and there is nothing within the box.
    assert!(!ExactCast::new(&hidden).any(&up, Sides::Fronts));
    // z = x and z = -x, each from x = -4 to 4 and y = -4 to 4: seen from above, the nearer is |x|, a valley.
    let crossing = mesh(
        &[
            [-4.0, -4.0, -4.0],
            [4.0, -4.0, 4.0],
            [4.0, 4.0, 4.0],
            [-4.0, 4.0, -4.0],
            [-4.0, -4.0, 4.0],
            [4.0, -4.0, -4.0],
            [4.0, 4.0, -4.0],
            [-4.0, 4.0, 4.0],
        ],
        &[[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]],
    );
    let margins = ExactCast::new(&crossing).margins(&down(0.25, 1.0, 8.0), Sides::Both);
    assert_is(margins.face, 0.25);
    assert_is(margins.surface, 3.0);
}

/// A surface of unit cells that rises by 1 from 0 to 1 and by 1/4 per cell from there: z at a whole x from -8 to 8.
fn bend(x: i32) -> f64 {
    let x = f64::from(x);
    if x <= 1.0 { x } else { 1.0 + (x - 1.0) / 4.0 }
}

#[test]
fn a_border_that_comes_out_of_a_surface_is_a_jump_from_there() {
    // Seen from above, a plate at z = 1/2 is below the surface where x > 1/2, and above it where x < 1/2. Its border at
    // y = 1 jumps only there: 5/2 in x from a ray at x = 3. All in the eight positions of a square.
    for position in 0..8 {
        let placed = |[x, y, z]: [f64; 3]| {
            let [x, y] = if position & 1 == 0 { [x, y] } else { [-x, y] };
            let [x, y] = if position & 2 == 0 { [x, y] } else { [x, -y] };
            if position & 4 == 0 { [x, y, z] } else { [y, x, z] }
        };
        let ray = |x: f64, y: f64| {
            let [x, y, z] = placed([x, y, 8.0]);
            down(x, y, z)
        };
        let ground =
            (0..17 * 17).map(|k| placed([f64::from(k % 17 - 8), f64::from(k / 17 - 8), bend(k % 17 - 8)]));
        let cells = (0..17 * 16_u32).filter(|k| k % 17 != 16);
        let cells = cells.flat_map(|k| [[k, k + 1, k + 18], [k, k + 18, k + 17]]);
        // The far end of the border: many cells beyond the place where it comes out, in the same cell, or in the next.
        for end in [-4.0, 0.25, -0.75] {
            let plate = [[7.0, 1.0, 0.5], [7.0, 3.0, 0.5], [end, 3.0, 0.5], [end, 1.0, 0.5]].map(placed);
            let vertices: Vec<[f64; 3]> = ground.clone().chain(plate).collect();
            let first = 17 * 17;
            let plate = [[first, first + 1, first + 2], [first, first + 2, first + 3]];
            let faces: Vec<[u32; 3]> = cells.clone().chain(plate).collect();
            let mesh = mesh(&vertices, &faces);
            let cast = ExactCast::new(&mesh);
            assert_is(cast.margins(&ray(3.0, 0.125), Sides::Both).surface, 2.5);
            // The border is hidden by the surface and by nothing before the start of the ray: where the surface is above
            // z = 1, for x > 1, it is not there, and the ray meets the plate or goes on.
            let started = CastRay { t_min: 7.0, ..ray(3.0, 0.125) };
            assert_is(cast.margins(&started, Sides::Both).surface, 0.875);
            let started = CastRay { t_min: 7.0, ..ray(0.75, 0.125) };
            assert_is(cast.margins(&started, Sides::Both).surface, 0.25);
        }
    }
}

#[test]
fn an_edge_that_only_touches_the_start_of_the_ray_is_a_line_of_jumps() {
    // A valley whose bottom, from (0, -2) to (0, 2), is exactly where the ray starts: its sides are before the start.
    // Below lies a floor. So the rays that meet the bottom meet nothing else of the valley.
    let vertices = [
        [0.0, -2.0, 0.0],
        [0.0, 2.0, 0.0],
        [2.0, 0.0, 1.0],
        [-2.0, 0.0, 1.0],
        [-8.0, -8.0, -1.0],
        [8.0, -8.0, -1.0],
        [0.0, 8.0, -1.0],
    ];
    let valley = mesh(&vertices, &[[0, 2, 1], [0, 1, 3], [4, 5, 6]]);
    let ray = CastRay { t_min: 4.0, ..down(0.25, 0.5, 4.0) };
    assert_is(ExactCast::new(&valley).margins(&ray, Sides::Both).surface, 0.25);
}

#[test]
fn a_corner_that_only_touches_the_start_of_the_ray_is_a_jump() {
    // All of a triangle but its lowest corner is before the start. The ray through this corner meets it there, and all rays beside it
    // meet the floor behind it, or nothing.
    let corner = [[0.0, 0.0, 0.0], [2.0, 1.0, 1.0], [1.0, 2.0, 1.0]];
    let floor = [[-8.0, -8.0, -1.0], [8.0, -8.0, -1.0], [0.0, 8.0, -1.0]];
    let vertices: Vec<[f64; 3]> = corner.into_iter().chain(floor).collect();
    let above_a_floor = mesh(&vertices, &[[0, 1, 2], [3, 4, 5]]);
    let ray = CastRay { t_min: 4.0, ..down(-0.25, 0.125, 4.0) };
    assert_is(ExactCast::new(&above_a_floor).margins(&ray, Sides::Both).surface, 0.25);
    // What is met before it hides it.
    let plate = floor.map(|[x, y, _]| [x, y, 0.5]);
    let vertices: Vec<[f64; 3]> = vertices.into_iter().chain(plate).collect();
    let hidden = mesh(&vertices, &[[0, 1, 2], [3, 4, 5], [6, 7, 8]]);
    let ray = CastRay { t_min: 3.0, ..down(-0.25, 0.125, 4.0) };
    assert!(ExactCast::new(&hidden).margins(&ray, Sides::Both).surface.lo > 0.25);
}

#[test]
fn a_surface_without_shared_vertices_is_still_one() {
    // One long edge on the left side, two short ones on the right: the three meet without a gap at x = 0.
    let vertices = [
        [-2.0, 0.0, 0.0],
        [0.0, -2.0, 0.0],
        [0.0, 2.0, 0.0],
        [0.0, -2.0, 0.0],
        [2.0, 0.0, 0.0],
        [0.0, 0.0, 0.0],
        [0.0, 0.0, 0.0],
        [2.0, 0.0, 0.0],
        [0.0, 2.0, 0.0],
    ];
    let kite = mesh(&vertices, &[[0, 1, 2], [3, 4, 5], [6, 7, 8]]);
    let margins = ExactCast::new(&kite).margins(&down(-0.25, 0.5, 4.0), Sides::Both);
    assert_is(margins.face, 0.25);
    // To |x| + |y| = 2: 5/4 over two.
    assert_is(margins.surface, 0.625);
    // With the lower right triangle moved away, the part of the border below y = 0 is a jump, at (0, 0).
    let mut apart = vertices;
    for vertex in &mut apart[3..6] {
        vertex[2] = -1.0;
    }
    let apart = mesh(&apart, &[[0, 1, 2], [3, 4, 5], [6, 7, 8]]);
    assert_is(ExactCast::new(&apart).margins(&down(-0.25, 0.5, 4.0), Sides::Both).surface, 0.5);
}

#[test]
fn margins_have_no_scale() {
    // The step of the first test, from what has squares below f64 to kilometres, and 2^-45 from it.
    for exponent in [-560, -60, -20, 0, 10, 40] {
        let scale = libm::scalbn(1.0, exponent);
        for offset in [0.125, libm::scalbn(1.0, -45)] {
            let square = mesh(&SQUARE.map(|v| v.map(|x| x * scale)), &[[0, 1, 2], [0, 2, 3]]);
            let ray = down((1.0 - offset) * scale, 0.5 * scale, scale);
            let margins = ExactCast::new(&square).margins(&ray, Sides::Fronts);
            assert_is(margins.surface, offset * scale);
            assert_is(margins.face, offset * scale);
        }
    }
    // Far from 0, too: the numbers are exact all the same.
    let moved = mesh(&SQUARE.map(|[x, y, z]| [x + 1e6, y - 3e6, z + 1e6]), &[[0, 1, 2], [0, 2, 3]]);
    let ray = down(1e6 + 0.75, 0.5 - 3e6, 1e6 + 1.0);
    assert_is(ExactCast::new(&moved).margins(&ray, Sides::Fronts).surface, 0.25);
}

/// The nearest t of the ray moved sideways; infinite for a miss.
fn moved_t(cast: &ExactCast<'_>, ray: &CastRay, by: [f64; 2]) -> f64 {
    let [u, v] = ray.across();
    let moved = CastRay { origin: ray.origin + u * by[0] + v * by[1], ..*ray };
    cast.first_values(&moved, Sides::Both).map_or(f64::INFINITY, |hit| hit.t.double)
}

/// Whether the nearest hit of the ray moved sideways is too near, exactly: what is met first from `t_blind` on is another face.
fn moved_is_too_near(cast: &ExactCast<'_>, ray: &CastRay, by: [f64; 2]) -> bool {
    let from_there = CastRay { t_min: ray.t_min.max(ray.t_blind), ..*ray };
    ray.t_blind > 0.0
        && cast.first_moved(ray, Sides::Both, by) != cast.first_moved(&from_there, Sides::Both, by)
}

fn size(by: [f64; 2]) -> f64 {
    by[0].abs().max(by[1].abs())
}

/// The places to which the ray must be moved to go through these points.
fn flat(ray: &CastRay, point: DVec3) -> [f64; 2] {
    let [u, v] = ray.across();
    let (from, d) = (point - ray.origin, ray.direction);
    let scale = u.dot(v.cross(d));
    [from.dot(v.cross(d)) / scale, from.dot(d.cross(u)) / scale]
}

/// Whether t jumps at an edge within a hundredth of a place, as a place where an edge comes out of a face.
fn jumps_near(cast: &ExactCast<'_>, ray: &CastRay, mesh: &Triangles, near: [f64; 2]) -> bool {
    (0..mesh.faces().len() as u32).any(|face| {
        let corners = mesh.corners(FaceId(face)).map(|corner| flat(ray, corner));
        (0..3).any(|k| {
            let (p, q) = (corners[k], corners[(k + 1) % 3]);
            let across = [q[1] - p[1], p[0] - q[0]].map(|part| part * 1e-10);
            (0..1024).any(|step| {
                let s = f64::from(step) / 1024.0;
                let at = [p[0] + s * (q[0] - p[0]), p[1] + s * (q[1] - p[1])];
                let is_near = size([at[0] - near[0], at[1] - near[1]]) < 0.01;
                is_near && {
                    let beside = [1.0, -1.0].map(|side| [at[0] + side * across[0], at[1] + side * across[1]]);
                    let [one, other] = beside.map(|by| moved_t(cast, ray, by));
                    one != other && !((one - other).abs() < 1e-7)
                }
            })
        })
    })
}

fn whole(size: i32) -> impl Strategy<Value = [i32; 3]> {
    [-size..=size, -size..=size, -size..=size]
}

/// Number of displaced rays that look for a change within each margin: `RAYPENCIL_CAST_CASES=20000` draws a million
/// and more.
fn cases() -> u32 {
    std::env::var("RAYPENCIL_CAST_CASES").map_or(400, |text| text.parse().expect("a number of cases"))
}

/// Displaced rays that aim at places on the edges, where changes are, find none within the margins of a ray; the
/// witnesses show one.
fn no_change_within_the_margins(
    mesh: &Triangles,
    ray: CastRay,
    fractions: &[(f64, f64, f64)],
) -> Result<(), TestCaseError> {
    let cast = ExactCast::new(mesh);
    let (vertices, faces) = (mesh.vertices(), mesh.faces());
    let margins = cast.margins(&ray, Sides::Both);
    let (face, surface) = (margins.face, margins.surface);
    prop_assert!(face.lo <= face.hi && surface.lo <= surface.hi, "{margins:?}");
    prop_assert!(face.lo <= surface.hi, "{margins:?}");
    for margin in [face, surface] {
        prop_assert!(margin.hi <= 1.02 * margin.lo + 1e-14, "{margins:?}");
    }
    let answer = |by: [f64; 2]| (cast.first_moved(&ray, Sides::Both, by), moved_is_too_near(&cast, &ray, by));
    let own = answer([0.0; 2]);
    prop_assert_eq!(own.1, cast.reading(&ray, Sides::Both) == Reading::TooNear);
    let first_t = moved_t(&cast, &ray, [0.0; 2]);
    if let Some(witness) = face.witness {
        prop_assert!(answer(witness.to_array()) != own, "{margins:?}");
    }
    // A witness of the surface is just beyond a jump: nearby t differs, however near.
    // An end of the ray that touches a corner leaves a single place, which no rounded ray finds.
    let t_of =
        |v: &[f64; 3]| (DVec3::from(*v) - ray.origin).dot(ray.direction) / ray.direction.length_squared();
    let is_touched = vertices
        .iter()
        .any(|v| [ray.t_min, ray.t_max, ray.t_blind].iter().any(|end| (t_of(v) - end).abs() < 1e-9));
    if let Some(at) = surface.witness.map(Displacement::to_array).filter(|_| !own.0.is_empty() && !is_touched)
    {
        let step = 1e-7 * (1.0 + size(at));
        // Places all round, for the jump may be in a narrow wedge.
        let round = (0..128).map(|k| {
            let along = f64::from(k % 32) / 16.0 - 1.0;
            [[along, 1.0], [along, -1.0], [1.0, along], [-1.0, along]][k as usize / 32]
        });
        let round = round.map(|s| [at[0] + s[0] * step, at[1] + s[1] * step]);
        let comes_or_goes = round.clone().any(|by| moved_is_too_near(&cast, &ray, by) != own.1);
        let t: Vec<f64> = round.map(|by| moved_t(&cast, &ray, by)).collect();
        let (least, most) = t.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), t| (a.min(*t), b.max(*t)));
        // Where an edge comes out of another face, its jumps begin with 0: they are farther along the edge.
        let sees_a_jump = most - least > 1e-6 || most == f64::INFINITY && least < most;
        prop_assert!(
            sees_a_jump || comes_or_goes || jumps_near(&cast, &ray, mesh, at),
            "{ray:?} {margins:?} {t:?}"
        );
    }
    for &(s, x, y) in fractions {
        for triangle in faces {
            for k in 0..3 {
                let corner = |k: usize| DVec3::from(vertices[triangle[k % 3] as usize]);
                let (p, q) = (flat(&ray, corner(k)), flat(&ray, corner(k + 1)));
                // Now and then a corner itself.
                let s = if s < 0.1 { 0.0 } else { s };
                let at = [p[0] + s * (q[0] - p[0]), p[1] + s * (q[1] - p[1])];
                if size(at) < face.lo * (1.0 - 1e-9) {
                    prop_assert_eq!(answer(at), own.clone(), "{:?} {:?}", ray, at);
                }
                // Two rays on both sides of the edge.
                let step = 1e-9;
                let beside = [[at[0] + x * step, at[1] + y * step], [at[0] - x * step, at[1] - y * step]];
                if size(at) < surface.lo - 1e-8 && !is_touched {
                    let [one, other] = beside.map(|by| moved_t(&cast, &ray, by));
                    // The steepest slope of the lattice: at most 6^2 * 2 in a face whose n.d is 1 at least.
                    prop_assert!(
                        one == other || (one - other).abs() < 1e-5,
                        "{ray:?} {at:?} {one} {other} {margins:?}"
                    );
                    prop_assert_eq!(one.is_finite(), first_t.is_finite());
                    prop_assert_eq!(moved_is_too_near(&cast, &ray, at), own.1, "{:?} {:?}", ray, at);
                }
            }
        }
        let at = [x * face.lo, y * face.lo];
        if size(at) < face.lo * (1.0 - 1e-9) {
            prop_assert_eq!(answer(at), own.clone());
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(), ..ProptestConfig::default() })]

    /// On a lattice of few points, seen along whole numbers, all is as degenerate as can be. Displaced rays aim at
    /// places on the edges, where changes are.
    #[test]
    fn no_displaced_ray_within_the_margin_finds_a_change(
        vertices in prop::collection::vec(whole(3), 3..9),
        corners in prop::collection::vec([0_usize..9, 0_usize..9, 0_usize..9], 1..14),
        rays in prop::collection::vec((whole(8), whole(3), 0_u32..6), 6),
        fractions in prop::collection::vec((0.0_f64..1.0, -1.0_f64..1.0, -1.0_f64..1.0), 16),
    ) {
        let faces: Vec<[u32; 3]> =
            corners.iter().map(|corners| corners.map(|k| (k % vertices.len()) as u32)).collect();
        let vertices: Vec<[f64; 3]> = vertices.iter().map(|v| v.map(f64::from)).collect();
        let mesh = mesh(&vertices, &faces);
        for (origin, direction, ends) in rays {
            if direction == [0; 3] {
                continue;
            }
            let origin = DVec3::from(origin.map(|x| f64::from(x) / 2.0));
            let ray = CastRay::new(origin, DVec3::from(direction.map(f64::from)));
            let ray = match ends {
                0 => CastRay { t_max: 1.0, ..ray },
                1 => CastRay { t_min: 0.5, t_max: 2.0, ..ray },
                // A sensor that is blind half-way to what is met mostly.
                2 => CastRay { t_blind: 1.0, ..ray },
                3 => CastRay { t_blind: 1.25, t_max: 2.0, ..ray },
                _ => ray,
            };
            no_change_within_the_margins(&mesh, ray, &fractions)?;
        }
    }

    /// A ground of hills, seen at a low angle: borders lie hidden behind many faces of one surface. A plate comes out of
    /// it anywhere.
    #[test]
    fn no_displaced_ray_over_hills_finds_a_change(
        heights in prop::collection::vec(-2_i32..=2, 64),
        origin in [0_i32..15, 0_i32..15],
        direction in [1_i32..=6, -2_i32..=2, -2_i32..=-1],
        start in 0_u32..5,
        plate in [whole(8), whole(8), whole(8)],
        fractions in prop::collection::vec((0.0_f64..1.0, -1.0_f64..1.0, -1.0_f64..1.0), 12),
    ) {
        let vertex = |k: usize| [(k % 8) as f64, (k / 8) as f64, f64::from(heights[k])];
        let cell = |k: u32| [[k, k + 1, k + 9], [k, k + 9, k + 8]];
        let cells = (0..56).filter(|k| k % 8 != 7);
        let plate = plate.map(|v| [f64::from(v[0].abs()), f64::from(v[1].abs()), f64::from(v[2]) / 4.0]);
        let faces: Vec<[u32; 3]> = cells.flat_map(cell).chain([[64, 65, 66]]).collect();
        let vertices: Vec<[f64; 3]> = (0..64).map(vertex).chain(plate).collect();
        let place = DVec3::new(f64::from(origin[0]) / 2.0 - 2.0, f64::from(origin[1]) / 2.0, 0.25);
        let direction = DVec3::from(direction.map(f64::from));
        // From outside, or from among the hills, or from a start that cuts them.
        let ray = match start {
            0 => CastRay::new(place - direction * 4.0, direction),
            1 => CastRay::new(place, direction),
            2 => CastRay { t_blind: 4.0, ..CastRay::new(place - direction * 4.0, direction) },
            3 => CastRay { t_blind: 4.625, ..CastRay::new(place - direction * 4.0, direction) },
            _ => CastRay { t_min: 4.0, ..CastRay::new(place - direction * 4.0, direction) },
        };
        no_change_within_the_margins(&mesh(&vertices, &faces), ray, &fractions)?;
    }
}

#[test]
fn the_witness_of_a_needle_is_inside_it() {
    // A needle 2^-40 wide and 1 long, a quarter beside the ray.
    let width = libm::scalbn(1.0, -40);
    let needle = mesh(&[[0.25, 0.0, 0.0], [1.25, 0.0, 0.0], [1.25, width, 0.0]], &[[0, 1, 2]]);
    let cast = ExactCast::new(&needle);
    let ray = down(0.0, 0.0, 1.0);
    let margins = cast.margins(&ray, Sides::Both);
    let witness = margins.face.witness.expect("a witness");
    assert_eq!(cast.first_moved(&ray, Sides::Both, witness.to_array()), [FaceId(0)]);
    assert!(margins.face.lo <= 0.25 && margins.face.hi < 0.5, "{margins:?}");
}
