//! `beam-edges = paper`: where straight sides differ from the exact curves, by how much, and where they agree.

use raypencil_scanline::Switches;
use raypencil_scene::{Beam, FaceId};
use raypencil_terrain::RandomGround;

use super::scenes::{
    BEAM_EDGES, Face, beam_map, camera_map, columns_hit, differing, hits, range, render, render_unskipped,
    rig_on, same_maps, seen_by_beam, square_beam, towards_origin,
};

/// T = 5/64 m (78 mm), five rows at y = (2j - 4) T/10, the third at 0; column i at x/z = (2i - 1023) / 1024.
fn thick() -> Beam {
    square_beam(1024, 5, 0.078125, 20.0)
}

// y at which faces end, metres: half a thickness above and below the sheet. The plane z = 2 - (64/5) y is at z = 3 m and
// 1 m there. At the top of the sheet it is 1 m farther away than at its bottom.
const UPPER_Y_M: f32 = -0.078125;
const LOWER_Y_M: f32 = 0.078125;

/// A face in that plane, with a side from (-2.25, UPPER_Y_M, 3) to (1.75, LOWER_Y_M, 1). Its third corner, at y = 0,
/// z = 2, is far out at `x`. Its other sides are beyond the screen.
fn leaning_side(x: f32) -> Face {
    towards_origin([[-2.25, UPPER_Y_M, 3.0], [1.75, LOWER_Y_M, 1.0], [x, 0.0, 2.0]])
}

#[test]
fn a_leaning_side_is_off_by_64_columns() {
    // The sheet cuts the side at y = -T/2 in (-1.25, z = 2.5), x/z = -1/2, and at y = T/2 in (0.75, z = 1.5),
    // x/z = 1/2. In row 2, halfway, the side is at (-0.25, z = 2), x/z = -1/8, and the straight line at x/z = 0.
    // A column is 1/512 wide, so they are 64 columns apart. The first column from -128/1024 on has
    // 2i - 1023 >= -128: i = 448. The first from 0 on is i = 512.
    let scene = seen_by_beam(&[leaning_side(1000.0)], thick());
    let (exact, paper) = (beam_map(&scene, Switches::EXACT), beam_map(&scene, BEAM_EDGES));
    assert_eq!(columns_hit(&exact, 2), (448..1024).collect::<Vec<_>>());
    assert_eq!(columns_hit(&paper, 2), (512..1024).collect::<Vec<_>>());
    for j in 0..5 {
        // s runs from 0 at the top of the sheet to 1 at its bottom.
        let s = (f64::from(2 * j) - 4.0) / 10.0 + 0.5;
        let curve = (-1.25 + 2.0 * s) / (2.5 - s);
        let straight = -0.5 + s;
        // 2i - 1023 >= 1024 x/z.
        let first = |x_over_z: f64| ((1024.0 * x_over_z + 1023.0) / 2.0).ceil() as u32;
        assert_eq!(columns_hit(&exact, j).first(), Some(&first(curve)), "row {j}");
        assert_eq!(columns_hit(&paper, j).first(), Some(&first(straight)), "row {j}");
        // Where both hit, ranges are the plane's, to the bit.
        for i in columns_hit(&paper, j) {
            assert_eq!(range(&exact, i, j), range(&paper, i, j));
        }
    }
}

#[test]
fn a_pencil_between_line_and_curve_hits_the_plane_of_the_face() {
    // The same side with the face on its left. The straight line adds columns 448 to 511 in row 2, at the range of
    // the plane, which row 2 meets at z = 2 everywhere.
    let scene = seen_by_beam(&[leaning_side(-1000.0)], thick());
    let (exact, paper) = (beam_map(&scene, Switches::EXACT), beam_map(&scene, BEAM_EDGES));
    assert_eq!(columns_hit(&exact, 2), (0..448).collect::<Vec<_>>());
    assert_eq!(columns_hit(&paper, 2), (0..512).collect::<Vec<_>>());
    let x_over_z = (2.0 * 500.0 - 1023.0) / 1024.0;
    let expected = 2.0 * (1.0_f64 + x_over_z * x_over_z).sqrt();
    assert!((range(&paper, 500, 2).unwrap() - expected).abs() < 1e-12);
}

#[test]
fn two_faces_agree_on_the_line_between_them() {
    // Both faces of that side: every pencil hits one of them, with straight and with exact sides.
    let scene = seen_by_beam(&[leaning_side(-1000.0), leaning_side(1000.0)], thick());
    for (switches, first_of_second) in [(Switches::EXACT, 448), (BEAM_EDGES, 512)] {
        let map = beam_map(&scene, switches);
        assert_eq!(hits(&map), 5 * 1024);
        let faces = map.face.as_ref().unwrap();
        let first = (0..1024).find(|&i| faces.at(i, 2).get() == Some(FaceId(1)));
        assert_eq!(first, Some(first_of_second));
    }
}

#[test]
fn a_thin_sheet_covers_the_same_columns() {
    // The same face cut by a sheet of 5/1024 m (4.9 mm). Within the sheet the side moves by 1/16 m in z and by 1/8 m in
    // x: its ends are at x = -0.25 -+ 1/16, z = 2 +- 1/32. The middle of the straight line is at
    // (-0.3125/2.03125 - 0.1875/1.96875) / 2 = -0.124543, that of the curve at -0.125: 0.23 columns apart. The nearest
    // column centres of the middle row are half a column from -0.125, so both cover the same columns.
    let scene = seen_by_beam(&[leaning_side(1000.0)], Beam { thickness: 5.0 / 1024.0, ..thick() });
    let (exact, paper) = (beam_map(&scene, Switches::EXACT), beam_map(&scene, BEAM_EDGES));
    assert_eq!(columns_hit(&exact, 2), columns_hit(&paper, 2));
}

#[test]
fn vertical_and_horizontal_lines_stay_lines() {
    // One side in the plane x/z = -1/2, one along a row (y = LOWER_Y_M, beyond the sheet), the third beyond the
    // screen: straight line and curve are the same.
    let vertical = towards_origin([[-1.5, UPPER_Y_M, 3.0], [-0.5, LOWER_Y_M, 1.0], [1000.0, LOWER_Y_M, 1.0]]);
    // A horizontal side within the sheet, at y = 1/64, from which the face reaches up; its slanting sides
    // are beyond the screen.
    let z = 1.8; // 2 - (64/5) / 64
    let horizontal = towards_origin([[-1000.0, 0.015625, z], [1000.0, 0.015625, z], [0.0, UPPER_Y_M, 3.0]]);
    // A face at one z: all its sides are straight.
    let upright = towards_origin([[-1.0, UPPER_Y_M, 2.0], [0.3, LOWER_Y_M, 2.0], [1.1, UPPER_Y_M, 2.0]]);
    for face in [vertical, horizontal, upright] {
        let scene = seen_by_beam(&[face], thick());
        let exact = beam_map(&scene, Switches::EXACT);
        assert!(hits(&exact) > 1000);
        assert_eq!(exact, beam_map(&scene, BEAM_EDGES));
    }
}

#[test]
fn clipping_at_the_grid_plane_leaves_what_is_beyond() {
    // Figure 9, one vertex behind and two behind. The plane z = 1/8 + 64 (1/100 - y) crosses the grid plane at
    // y = 0.01. The rows at -0.03125, -0.015625 and 0 meet it beyond the grid plane, those below do not.
    let z = |y: f32| 0.125 + 64.0 * (0.01 - y);
    let two_behind: Face = [[-900.0, 0.05, z(0.05)], [900.0, 0.05, z(0.05)], [0.0, -9.0, z(-9.0)]];
    let one_behind: Face = [[-900.0, -0.05, z(-0.05)], [900.0, -0.05, z(-0.05)], [0.0, 0.9, z(0.9)]];
    for face in [two_behind, one_behind] {
        let scene = seen_by_beam(&[towards_origin(face)], thick());
        let (exact, paper) = (beam_map(&scene, Switches::EXACT), beam_map(&scene, BEAM_EDGES));
        assert_eq!(hits(&exact), 3 * 1024);
        assert_eq!(exact, paper);
    }
}

#[test]
fn skipping_unseen_faces_changes_no_map() {
    for seed in 0..4 {
        let scene = rig_on(RandomGround::nasty(seed, 2000).build(), 0.08, 9.0);
        for switches in [Switches::EXACT, BEAM_EDGES] {
            assert!(same_maps(&render(&scene, switches), &render_unskipped(&scene, switches)));
        }
    }
}

#[test]
fn beam_edges_do_not_change_the_cameras_map() {
    let scene = rig_on(RandomGround::nasty(3, 2000).build(), 0.08, 20.0);
    assert_eq!(camera_map(&scene, Switches::EXACT), camera_map(&scene, BEAM_EDGES));
}

#[test]
fn ground_has_no_cracks() {
    // On a height field every pencil has a hit in both forms, however thick the sheet: a shared side is one line. The
    // paper's claim holds on gentle ground: its faces are small, and a few pencils in a thousand get another face,
    // even at T = 80 mm.
    for seed in 0..4 {
        let scene = rig_on(RandomGround::plain(seed, 4000, 40.0).build(), 0.08, 100.0);
        let (exact, paper) = (render(&scene, Switches::EXACT), render(&scene, BEAM_EDGES));
        for (exact, paper) in exact.beams.iter().zip(&paper.beams) {
            assert_eq!((hits(exact), hits(paper)), (512 * 8, 512 * 8));
            assert!((1..20).contains(&differing(exact, paper)));
        }
    }
}
