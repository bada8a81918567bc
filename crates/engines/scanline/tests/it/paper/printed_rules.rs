//! `skip-rules = paper`: for each rule of §4, scenes in which the printed form changes nothing, and scenes in which it
//! loses or adds hits; or the reason why it can do neither.

use raypencil_scanline::Switches;
use raypencil_scene::FluxModel;
use raypencil_terrain::{BUILTIN_NAMES, RandomGround, builtin};

use super::scenes::{
    BEAM_EDGES, Face, SKIP_RULES, beam_map, camera_map, columns_hit, hits, range, render, render_unskipped,
    rig_on, same_maps, seen_by_beam, seen_by_both, seen_by_camera, square_beam, square_camera,
    towards_origin,
};

/// A maximum range beyond all vertices of the grounds here, metres: rule 3b skips nothing.
const RANGE_BEYOND_ALL_VERTICES_M: f64 = 1e3;

#[test]
fn rules_1a_3a_and_3c_lose_no_pixel() {
    // 1a and 3a: a face whose vertices are all in an open half-space lies in it. The half-spaces are z < f and those
    // beyond the planes through the projection centre and a border of the screen. None contains a point that a pixel
    // sees. 3c: the sides are straight. A screen that none of them meets is within the triangle, with its centre, or
    // apart from it. 1b: all rays start in one point, which sees every part of a face from one side. Only 3b can lose
    // a pixel, and here no vertex is too far.
    for seed in 0..6 {
        let scene = rig_on(RandomGround::nasty(seed, 2000).build(), 5e-3, RANGE_BEYOND_ALL_VERTICES_M);
        let exact = camera_map(&scene, Switches::EXACT);
        assert!(hits(&exact) > 10_000);
        assert_eq!(exact, camera_map(&scene, Switches::PAPER));
    }
    for name in BUILTIN_NAMES {
        let scene = rig_on(builtin(name, 0.25).unwrap(), 5e-3, RANGE_BEYOND_ALL_VERTICES_M);
        assert_eq!(camera_map(&scene, Switches::EXACT), camera_map(&scene, Switches::PAPER));
    }
}

#[test]
fn rules_3a_and_3c_skip_nothing_of_a_clipped_beam() {
    // A triangle that is clipped to the stripe has all its vertices in the screen: 3a and 3c do not apply, and no vertex
    // is too far for 3b. 1b is applied with and without skipping.
    for seed in 0..6 {
        let scene = rig_on(RandomGround::nasty(seed, 2000).build(), 0.08, RANGE_BEYOND_ALL_VERTICES_M);
        let paper = render(&scene, Switches::PAPER);
        assert!(hits(&paper.beams[0]) > 2000);
        assert!(same_maps(&paper, &render_unskipped(&scene, Switches::PAPER)));
    }
}

#[test]
fn rule_1a_skips_faces_in_front_of_the_spp_and_no_others() {
    // The SPP is at 1/128 m. A face at z = 1/256 m is skipped. A face with one vertex beyond the SPP, at (0, 0, 2), is
    // hit in the part beyond. Its plane contains the line y = 1, z = -1 and that vertex: y = (2 - z) / 3. On the axis,
    // y = 0, it is at z = 2.
    let near: Face = [[-1.0, -1.0, 0.00390625], [1.0, -1.0, 0.00390625], [0.0, 1.0, 0.00390625]];
    let across: Face = [[-4.0, 1.0, -1.0], [4.0, 1.0, -1.0], [0.0, 0.0, 2.0]];
    let scene = seen_by_camera(&[near, towards_origin(near)], square_camera(20.0));
    assert_eq!(hits(&camera_map(&scene, SKIP_RULES)), 0);
    let scene = seen_by_camera(&[towards_origin(across)], square_camera(20.0));
    let (exact, paper) = (camera_map(&scene, Switches::EXACT), camera_map(&scene, SKIP_RULES));
    assert_eq!(exact, paper);
    // Pixel (64, 64) looks along (1, 1, 128) / 128: z / 128 = (2 - z) / 3, z = 256 / 131.
    let z = 256.0 / 131.0;
    let length = (1.0_f64 + 2.0 / (128.0 * 128.0)).sqrt();
    assert!((range(&paper, 64, 64).unwrap() - z * length).abs() < 1e-12);
}

/// A beam of T = 1/16 m with four rows: y = -3/128, -1/128, 1/128, 3/128.
fn four_rows() -> raypencil_scene::Beam {
    square_beam(64, 4, 0.0625, 20.0)
}

/// A face whose front looks up (-y), in the plane y = `at_origin` + `slope` z from z = 1 to 9. At z = 2 it is 14 m wide;
/// the fan is 4 m wide there.
fn floor(at_origin: f32, slope: f32) -> Face {
    let y = |z: f32| at_origin + slope * z;
    // n = (16, 0, 0) x (8, 8 slope, 8) = (0, -128, 128 slope).
    [[-8.0, y(1.0), 1.0], [8.0, y(1.0), 1.0], [0.0, y(9.0), 9.0]]
}

#[test]
fn rule_1b_is_right_where_all_rows_see_one_side() {
    // A wall across the stripe, and its back.
    let wall: Face = towards_origin([[-40.0, -40.0, 2.0], [40.0, -40.0, 2.0], [0.0, 40.0, 2.0]]);
    let back = [wall[0], wall[2], wall[1]];
    for (face, count) in [(wall, 4 * 64), (back, 0)] {
        let scene = seen_by_beam(&[face], four_rows());
        let exact = beam_map(&scene, Switches::EXACT);
        assert_eq!(hits(&exact), count);
        assert_eq!(exact, beam_map(&scene, SKIP_RULES));
    }
}

#[test]
fn rule_1b_loses_a_row_that_sees_the_front_where_the_middle_sees_the_back() {
    // Ground that rises as y = -2/128 - z/256. At the focal axis it is at -2/128: below row 0's origin at
    // -3/128, above those of the others and above (0, 0, 0). So row 0 sees its front, at z = 256 (3 - 2)/128 = 2.
    // The other rows see its back, and the paper's one decision is "back".
    let scene = seen_by_beam(&[floor(-2.0 / 128.0, -1.0 / 256.0)], four_rows());
    let exact = beam_map(&scene, Switches::EXACT);
    assert_eq!((columns_hit(&exact, 0).len(), hits(&exact)), (64, 64));
    // Pencil (32, 0) runs at x/z = 1/64.
    assert!((range(&exact, 32, 0).unwrap() - 2.0 * (1.0_f64 + 1.0 / 4096.0).sqrt()).abs() < 1e-12);
    assert_eq!(hits(&beam_map(&scene, SKIP_RULES)), 0);
    assert_eq!(hits(&beam_map(&scene, Switches::PAPER)), 0);
}

#[test]
fn rule_1b_adds_a_row_that_sees_the_back_where_the_middle_sees_the_front() {
    // Ground that falls as y = 2/128 + z/256. At the focal axis it is at 2/128: below (0, 0, 0), so the
    // decision is "front", but above row 3's origin at 3/128, which is under the ground and meets it from
    // below, at z = 256 (3 - 2)/128 = 2.
    let scene = seen_by_beam(&[floor(2.0 / 128.0, 1.0 / 256.0)], four_rows());
    assert_eq!(hits(&beam_map(&scene, Switches::EXACT)), 0);
    for switches in [SKIP_RULES, Switches::PAPER] {
        let paper = beam_map(&scene, switches);
        assert_eq!((columns_hit(&paper, 3).len(), hits(&paper)), (64, 64));
        let length = (1.0_f64 + 1.0 / 4096.0).sqrt();
        assert!((range(&paper, 32, 3).unwrap() - 2.0 * length).abs() < 1e-12);
        // n = (0, -128, 1/2), q = (1/64, 0, 1) g: cos(psi) = -n.q / (|n| |q|) < 0.
        let cosine = -0.5 / (128.0_f64 * 128.0 + 0.25).sqrt() / length;
        let cos_incidence = paper.cos_incidence.as_ref().unwrap().at(32, 3).get().unwrap();
        assert!((cos_incidence - cosine).abs() < 1e-12, "{cos_incidence} {cosine}");
    }
}

#[test]
fn a_hit_that_rule_1b_adds_returns_flux_except_by_equation_1() {
    // The same ground. The camera stands at the beam's origin and sees the front. Row 3 hits it from below at z = 2,
    // y = 3/128, which is in image row 64 + 64 (3/256) = 64.75; and cos(theta) > 0.
    let faces = [floor(2.0 / 128.0, 1.0 / 256.0)];
    for (model, delivers) in [(FluxModel::Radiometric, true), (FluxModel::Eq1, false)] {
        let scene = seen_by_both(&faces, &[([0.0; 3], four_rows())], model);
        let frame = render(&scene, SKIP_RULES);
        assert!(frame.beams[0].cos_incidence.as_ref().unwrap().at(32, 3).get().unwrap() < 0.0);
        let returns = &frame.returns[0];
        assert!(returns.cos_view.as_ref().unwrap().at(32, 3).get().unwrap() > 0.0);
        assert!(returns.visible.as_ref().unwrap().at(32, 3));
        assert_eq!(returns.pixel.as_ref().unwrap().at(32, 3).get().map(|pixel| pixel.j), Some(64));
        // Equation (1) has the factor cos(psi) < 0, and power is not negative. The other model has no such factor.
        let flux = returns.flux.as_ref().unwrap().at(32, 3);
        assert_eq!((flux > 0.0, flux == 0.0), (delivers, !delivers));
    }
}

#[test]
fn rule_3b_loses_pixels_nearer_than_all_vertices() {
    // A wall at z = 10 m. Its vertices are at ranges sqrt(100 + 64 + 64) = 15.1 m, twice, and
    // sqrt(100 + 64) = 12.8 m; the pixels around the axis at 10 m.
    let wall = towards_origin([[-8.0, -8.0, 10.0], [8.0, -8.0, 10.0], [0.0, 8.0, 10.0]]);
    let at =
        |max_range: f64, switches| camera_map(&seen_by_camera(&[wall], square_camera(max_range)), switches);
    // A maximum range of 12 m: x^2 + y^2 <= 44 is in range, within the lower and the two slanting sides.
    let pixel = |i: u32| 10.0 * (f64::from(i) + 0.5 - 64.0) / 64.0;
    let in_range = |i: u32, j: u32| {
        let (x, y) = (pixel(i), pixel(j));
        x * x + y * y <= 44.0 && y >= -8.0 && 2.0 * x.abs() <= 8.0 - y
    };
    let count = (0..128).flat_map(|j| (0..128).map(move |i| (i, j))).filter(|&(i, j)| in_range(i, j)).count();
    let exact = at(12.0, Switches::EXACT);
    assert_eq!(hits(&exact), count);
    assert!(count > 2000 && range(&exact, 64, 64).is_some_and(|range| range < 10.01));
    assert_eq!(hits(&at(12.0, SKIP_RULES)), 0);
    // With 13 m one vertex is in range, with 9 m nothing is: the rule changes nothing.
    for max_range in [13.0, 9.0] {
        assert_eq!(at(max_range, Switches::EXACT), at(max_range, SKIP_RULES));
    }
}

#[test]
fn rule_3b_loses_the_whole_stripe_on_a_wall() {
    // A wall at z = 10 m, wider and higher than the sheet, whose maximum range is 12 m. Pencils at
    // x/z = k/64, k odd, meet it at R = 10 sqrt(1 + (k/64)^2): within 12 m for |k| <= 64 sqrt(0.44) = 42.5,
    // 42 of the 64 columns.
    let wall = towards_origin([[-40.0, -40.0, 10.0], [40.0, -40.0, 10.0], [0.0, 40.0, 10.0]]);
    let scene = seen_by_beam(&[wall], square_beam(64, 4, 0.0625, 12.0));
    assert_eq!(hits(&beam_map(&scene, Switches::EXACT)), 4 * 42);
    assert_eq!(hits(&beam_map(&scene, BEAM_EDGES)), 4 * 42);
    // The wall's own vertices are not in the screen: the rule does not apply.
    assert_eq!(hits(&beam_map(&scene, SKIP_RULES)), 4 * 42);
    // Clipped to the stripe it is a rectangle with vertices at |x| = z. All are in the screen, at a range of 14.1 m.
    assert_eq!(hits(&beam_map(&scene, Switches::PAPER)), 0);
    // With a maximum range of 15 m they are in range, and nothing is lost.
    let scene = seen_by_beam(&[wall], square_beam(64, 4, 0.0625, 15.0));
    assert_eq!(beam_map(&scene, Switches::EXACT), beam_map(&scene, Switches::PAPER));
}

/// A face from (-z, -8, z) and (0, -8, z) at z = `top` down to (5, 8, 1).
fn leaning(top: f32) -> Face {
    towards_origin([[-top, -8.0, top], [0.0, -8.0, top], [5.0, 8.0, 1.0]])
}

#[test]
fn rule_3c_loses_faces_with_curved_sides() {
    // The vertices are at x/z = -1, 0 and 5, y = -8, -8 and 8. Straight sides between them pass the sheet,
    // y = 0, at x/z = (-1 + 5) / 2 = 2 and 2.5, beyond the screen, which ends at 1. But the upper vertices are at z = 7
    // and the lower one at z = 1. The plane y = 0 cuts the sides halfway in space: x/z = (-7 + 5) / (7 + 1) = -1/4 and
    // (0 + 5) / 8 = 5/8.
    let beam = square_beam(64, 2, 0.0625, 20.0);
    let scene = seen_by_beam(&[leaning(7.0)], beam);
    let exact = beam_map(&scene, Switches::EXACT);
    // Column i is at x/z = (2i - 63) / 64: those from -15/64 to 39/64, i = 24 to 51. (The rows are 1/64 m
    // above and below the middle, which moves the sides by less than 1/8 column.)
    for j in 0..2 {
        assert_eq!(columns_hit(&exact, j), (24..=51).collect::<Vec<_>>());
    }
    assert_eq!(hits(&beam_map(&scene, SKIP_RULES)), 0);
    // Clipped to the stripe first, the face has its vertices in the screen.
    assert_eq!(exact.face, beam_map(&scene, Switches::PAPER).face);
}

#[test]
fn rule_3c_is_right_where_sides_are_straight_or_the_centre_is_within() {
    let beam = square_beam(64, 2, 0.0625, 20.0);
    // All vertices at z = 1: the sides are straight and pass beyond the screen, so the face is not seen.
    let scene = seen_by_beam(&[leaning(1.0)], beam);
    let exact = beam_map(&scene, Switches::EXACT);
    assert_eq!(hits(&exact), 0);
    assert_eq!(exact, beam_map(&scene, SKIP_RULES));
    // No vertex or side meets the screen, but its centre is in the triangle: the face is seen everywhere.
    let around = towards_origin([[-40.0, -40.0, 2.0], [40.0, -40.0, 2.0], [0.0, 40.0, 2.0]]);
    let scene = seen_by_beam(&[around], beam);
    let exact = beam_map(&scene, Switches::EXACT);
    assert_eq!(hits(&exact), 2 * 64);
    assert_eq!(exact, beam_map(&scene, SKIP_RULES));
}

#[test]
fn rule_3a_is_right_for_curved_sides_too() {
    // Left of the screen is the half-space x < -z. A face with three vertices at x/z = -1.1 and beyond, however far apart
    // in z, has no point in the screen. A face with one vertex at x/z = -0.5 may have. The same holds for y above and
    // below the sheet.
    let beam = square_beam(64, 2, 0.0625, 20.0);
    let left: Face = [[-1.1, -8.0, 1.0], [-9.9, 8.0, 9.0], [-30.0, 8.0, 20.0]];
    let above: Face = [[-4.0, -0.04, 1.0], [4.0, -0.04, 1.0], [0.0, -0.5, 9.0]];
    for face in [left, above] {
        for face in [face, [face[0], face[2], face[1]]] {
            let scene = seen_by_beam(&[face], beam);
            let exact = beam_map(&scene, Switches::EXACT);
            assert_eq!(hits(&exact), 0);
            assert_eq!(exact, beam_map(&scene, SKIP_RULES));
        }
    }
    let reaches_in = towards_origin([[-0.5, -8.0, 1.0], [-4.5, 8.0, 9.0], [-30.0, 8.0, 20.0]]);
    let scene = seen_by_beam(&[reaches_in], beam);
    let exact = beam_map(&scene, Switches::EXACT);
    assert!(hits(&exact) > 0);
    assert_eq!(exact, beam_map(&scene, SKIP_RULES));
}

#[test]
fn rule_3c_loses_part_of_a_stripe_on_the_papers_own_facets() {
    // A known limit of the printed rule where faces are not clipped to the stripe. The facets are metres large. The
    // straight lines between their vertices miss the screen of a 5 mm sheet where the curves meet it. The loss is by rule
    // 3c: without rules 3 nothing is lost, 3a is right, and nothing is too far for 3b. The paper, which clips, loses
    // nothing.
    let scene = rig_on(builtin("facets", 0.25).unwrap(), 5e-3, RANGE_BEYOND_ALL_VERTICES_M);
    let exact = render(&scene, Switches::EXACT);
    let printed = render(&scene, SKIP_RULES);
    assert!(hits(&printed.beams[0]) < hits(&exact.beams[0]));
    assert!(same_maps(&exact, &render_unskipped(&scene, SKIP_RULES)));
    assert!(same_maps(&exact, &render(&scene, Switches::PAPER)));
}
