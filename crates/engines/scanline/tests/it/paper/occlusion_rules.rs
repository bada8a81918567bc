//! §6 as printed: for each of its switches, scenes in which it changes nothing, and scenes in which it is wrong.
//!
//! The camera is at the origin and looks along z. Its pixel (i, j) begins at x/z = (i - 64)/64. Pencil 0 of the beams
//! runs at x/z = -3/4.

use raypencil_scanline::{Fidelity, Switches};
use raypencil_scene::{Beam, FluxModel, Scene};
use raypencil_terrain::{RandomGround, builtin};

use super::scenes::{
    EXTENT, FACING, Face, PLACE, render, rig_on, seen_by_both, square_beam, towards_origin, visible_pencils,
};

fn wall(z: f32) -> Face {
    towards_origin([[-40.0, -40.0, z], [40.0, -40.0, z], [0.0, 40.0, z]])
}

fn back_of([a, b, c]: Face) -> Face {
    [a, c, b]
}

fn beam() -> Beam {
    square_beam(4, 1, 5e-3, 20.0)
}

/// Faces in front of a wall at z = 2. Pencil 0 of a beam at x = 3 hits the wall at (3/2, 0, 2).
fn before_wall(faces: &[Face]) -> Scene {
    let mut all = vec![wall(2.0)];
    all.extend(faces);
    seen_by_both(&all, &[([3.0, 0.0, 0.0], beam())], FluxModel::Radiometric)
}

/// The faces of a tetrahedron, their fronts outwards.
fn tetrahedron(p: [[f32; 3]; 4]) -> [Face; 4] {
    let [a, b, c, d] = p;
    let v = |p: [f32; 3]| glam::Vec3::from(p).as_dvec3();
    let inwards = (v(b) - v(a)).cross(v(c) - v(a)).dot(v(d) - v(a)) > 0.0;
    let faces = [[a, b, c], [a, d, b], [b, d, c], [c, d, a]];
    if inwards { faces.map(back_of) } else { faces }
}

#[test]
fn facing_changes_nothing_where_backs_lean_away_from_the_axis_too() {
    // The camera's ray to (3/2, 0, 2), x = 3/4 z, passes through the body. It enters through the front at z = 1 and
    // leaves through one of the faces that meet at (3/4, 0, 3/2), all of which have n.z > 0.
    let body = tetrahedron([[0.0, -0.5, 1.0], [1.5, -0.5, 1.0], [0.75, 1.0, 1.0], [0.75, 0.0, 1.5]]);
    let scene = before_wall(&body);
    assert!(!visible_pencils(&scene, Switches::EXACT)[0]);
    assert!(!visible_pencils(&scene, FACING)[0]);
}

#[test]
fn facing_loses_a_shadow_off_the_axis() {
    // The ray x = 3/4 z enters a wedge in the plane z = 0.9 and leaves it in the plane x = 0.65 + z/4, at z = 1.3. The
    // outward normal of that plane is along (4, 0, -1). The ray sees its back, 4 (3/4) - 1 = 2 > 0; the axis does not,
    // -1 < 0. No other back is on the ray.
    let body = tetrahedron([[0.875, -0.5, 0.9], [0.875, 0.5, 0.9], [-0.2, 0.0, 0.9], [1.1, 0.0, 1.8]]);
    let scene = before_wall(&body);
    assert!(!visible_pencils(&scene, Switches::EXACT)[0]);
    assert!(visible_pencils(&scene, FACING)[0]);
    // So it is at the pixel's centre: by the camera's position there is a shadow, by its axis there is none.
    assert!(!visible_pencils(&scene, PLACE)[0]);
    assert!(visible_pencils(&scene, FACING.union(PLACE))[0]);
}

#[test]
fn facing_and_extent_only_ever_lose_shadows() {
    let mut lost = [0; 2];
    for seed in 0..6 {
        let scene = rig_on(RandomGround::nasty(seed, 2000).build(), 0.02, 20.0);
        let exact = visible_pencils(&scene, Switches::EXACT);
        for (lost, switches) in lost.iter_mut().zip([FACING, EXTENT]) {
            for (exact, paper) in exact.iter().zip(visible_pencils(&scene, switches)) {
                assert!(paper || !exact);
                *lost += usize::from(paper && !exact);
            }
        }
    }
    // `facing` loses at least the shadows of loose slivers that show their front.
    assert!(lost[0] > 0, "{lost:?}");
}

/// An upper beam whose pencils all hit a rock at z = 1, a lower beam whose pencil 0 hits a wall at (-1, 1/4, 4), and
/// more faces.
fn rock_and_wall(faces: &[Face]) -> Scene {
    let rock: Face = towards_origin([[-9.0, -1.1, 1.0], [9.0, -1.1, 1.0], [0.0, -0.8, 1.0]]);
    let mut all = vec![wall(4.0), rock];
    all.extend(faces);
    let beams = [([0.0, -1.0, 0.0], beam()), ([2.0, 0.25, 0.0], beam())];
    seen_by_both(&all, &beams, FluxModel::Radiometric)
}

/// Whether the camera sees the points of the lower beam's pencils.
fn lower_visible(scene: &Scene, switches: Switches) -> [bool; 4] {
    visible_pencils(scene, switches)[4..8].try_into().unwrap()
}

#[test]
fn extent_loses_the_shadow_on_a_point_beyond_the_upper_beams() {
    // A blind at z = 3 that reaches down to y = 0.22 and shows the camera its back. It is above the lower beam, and
    // blocks the camera's ray to (-1, 1/4, 4), which is at y = 3/16 there. All its vertices are past the upper beam's
    // extent of 1 m.
    let blind = |z: f32| -> Face { [[9.0, 0.22, 3.0], [-9.0, 0.22, 3.0], [0.0, -9.0, z]] };
    let scene = rock_and_wall(&[blind(3.0)]);
    let depths = render(&scene, Switches::EXACT).returns[0].depth.clone().unwrap();
    assert!(depths.cells().iter().all(|depth| (depth.get().unwrap() - 1.0).abs() < 1e-12));
    for (switches, visible) in
        [(Switches::EXACT, false), (EXTENT, true), (PLACE, false), (EXTENT.union(PLACE), true)]
    {
        assert_eq!(lower_visible(&scene, switches)[0], visible, "{switches}");
    }
    // A blind with a vertex at 1 m is "not past" the extent, and occludes.
    assert!(!lower_visible(&rock_and_wall(&[blind(1.0)]), EXTENT)[0]);
    assert!(lower_visible(&rock_and_wall(&[blind(1.01)]), EXTENT)[0]);
}

#[test]
fn the_extent_is_that_of_the_highest_beam_and_of_the_later_of_equals() {
    let blind: Face = [[9.0, 0.22, 3.0], [-9.0, 0.22, 3.0], [0.0, -9.0, 3.0]];
    let rock: Face = towards_origin([[-9.0, -1.1, 1.0], [9.0, -1.1, 1.0], [0.0, -0.8, 1.0]]);
    let (upper, lower) = (([0.0, -1.0, 0.0], beam()), ([2.0, 0.25, 0.0], beam()));
    let scene = |beams: &[([f64; 3], Beam)], rock: &[Face]| {
        let faces = [&[wall(4.0), blind], rock].concat();
        seen_by_both(&faces, beams, FluxModel::Radiometric)
    };
    let first_of = |scene: &Scene, beam: usize| visible_pencils(scene, EXTENT)[4 * beam];
    // In either order the upper beam's extent of 1 m counts.
    assert!(first_of(&scene(&[upper, lower], &[rock]), 1));
    assert!(first_of(&scene(&[lower, upper], &[rock]), 0));
    // Alone, the lower beam is the upper one: its extent is 4 m.
    assert!(!first_of(&scene(&[lower], &[rock]), 0));
    // Nor is the shadow lost if the upper beam's extent is 4 m too, or if it hits nothing, which culls nothing.
    assert!(!first_of(&scene(&[upper, lower], &[]), 1));
    let short = Beam { max_range: 0.5, ..beam() };
    assert!(!first_of(&scene(&[(upper.0, short), lower], &[rock]), 1));
    // Of two beams at one height the later one counts. One of them passes beside the rock and reaches the wall.
    let beside = ([15.0, -1.0, 0.0], beam());
    assert!(first_of(&scene(&[beside, upper, lower], &[rock]), 2));
    assert!(!first_of(&scene(&[upper, beside, lower], &[rock]), 2));
}

#[test]
fn extent_changes_nothing_where_the_upper_beam_reaches_beyond_the_lower() {
    for name in ["pyramids", "facets"] {
        let scene = rig_on(builtin(name, 0.25).unwrap(), 5e-3, 20.0);
        let (exact, paper) = (render(&scene, Switches::EXACT), render(&scene, EXTENT));
        assert!(exact.returns == paper.returns && exact.flux == paper.flux);
    }
}

/// Pencil 0 hits (193/128, 0, 2). On the image that is at 64 + 64 (193/256) = 112.25: in pixel 112, whose centre is at
/// 112.5.
fn beside_centre(faces: &[Face]) -> Scene {
    let mut all = vec![wall(2.0)];
    all.extend(faces);
    seen_by_both(&all, &[([3.0 + 1.0 / 128.0, 0.0, 0.0], beam())], FluxModel::Radiometric)
}

#[test]
fn place_errs_between_a_pixels_centre_and_the_point() {
    // A blade at z = 1 that shows the camera its back. Its side at x = (112.375 - 64)/64 passes between the point and the
    // pixel's centre.
    let side = 48.375 / 64.0;
    let beyond_side = back_of(towards_origin([[side, -9.0, 1.0], [side, 9.0, 1.0], [9.0, 0.0, 1.0]]));
    let before_side = back_of(towards_origin([[side, -9.0, 1.0], [side, 9.0, 1.0], [-9.0, 0.0, 1.0]]));
    for (blade, exact, paper) in [(beyond_side, true, false), (before_side, false, true)] {
        let scene = beside_centre(&[blade]);
        assert_eq!(
            (visible_pencils(&scene, Switches::EXACT)[0], visible_pencils(&scene, PLACE)[0]),
            (exact, paper)
        );
    }
}

#[test]
fn place_changes_nothing_away_from_outlines() {
    // No blade, and a blade that covers the whole pixel.
    let cover = back_of(towards_origin([[0.5, -9.0, 1.0], [0.5, 9.0, 1.0], [9.0, 0.0, 1.0]]));
    for (faces, visible) in [(&[][..], true), (&[cover][..], false)] {
        let scene = beside_centre(faces);
        assert_eq!(
            (visible_pencils(&scene, Switches::EXACT)[0], visible_pencils(&scene, PLACE)[0]),
            (visible, visible)
        );
    }
    // On the paper's pyramids few of thousands of pencils are on an outline.
    let scene = rig_on(builtin("pyramids", 0.25).unwrap(), 5e-3, 20.0);
    let (exact, paper) = (visible_pencils(&scene, Switches::EXACT), visible_pencils(&scene, PLACE));
    let differing = exact.iter().zip(&paper).filter(|(a, b)| a != b).count();
    let hidden = exact.iter().filter(|visible| !**visible).count();
    assert!(0 < differing && 20 * differing < hidden, "{differing} {hidden}");
}

#[test]
fn place_loses_the_shadow_of_a_face_that_shows_its_front() {
    // There is no back behind the face: the ground is not closed. The face ends at x = 1, so it does not block the
    // pencil, which is at x = 2.26 there.
    let front = towards_origin([[0.5, -9.0, 1.0], [0.5, 9.0, 1.0], [1.0, 0.0, 1.0]]);
    let scene = beside_centre(&[front]);
    assert_eq!(
        (visible_pencils(&scene, Switches::EXACT)[0], visible_pencils(&scene, PLACE)[0]),
        (false, true)
    );
}

#[test]
fn no_switch_hides_a_stripe_by_the_front_that_it_is_on() {
    // A wall that leans by 45 degrees. Within a pixel its depth changes by far more than rounding: in one half of the
    // pixel it is nearer than at the centre, in the other half farther. Its front is seen, and n.z < 0.
    let leaning = towards_origin([[-40.0, -40.0, 42.0], [40.0, -40.0, -38.0], [0.0, 40.0, 2.0]]);
    for at in 0..8 {
        let beams = [([1.0 + f64::from(at) / 300.0, 0.0, 0.0], beam())];
        let scene = seen_by_both(&[leaning], &beams, FluxModel::Radiometric);
        for switches in Switches::subsets().filter(|switches| switches.skip_rules == Fidelity::Exact) {
            let frame = render(&scene, switches);
            let returns = &frame.returns[0];
            for i in 0..4 {
                let on_image = returns.pixel.as_ref().unwrap().at(i, 0).get().is_some();
                let visible = returns.visible.as_ref().unwrap().at(i, 0);
                assert_eq!(visible, on_image, "{at} {i} {switches}");
            }
        }
    }
}

#[test]
fn a_front_off_the_axis_that_leans_away_from_it_hides_its_own_stripe() {
    // The plane x = z/4 + 1/2, its front towards -x: n is along (-4, 0, 1). By the camera's axis it is turned away,
    // n.z > 0; yet rays with x > z/4 see its front. As printed it occludes at the centres of pixels. There it is nearer
    // than the points to the right of the centre, about every second one.
    let face = towards_origin([[0.625, -8.0, 0.5], [0.625, 8.0, 0.5], [4.5, 0.0, 16.0]]);
    // Pencils along x/z = 3/4, from x = 0.1 and less, hit it at z = 0.8 m and beyond, where x/z is at most
    // 1/4 + 1/(2 z). Pencils along x/z = 1/4 never hit it.
    let beams: Vec<_> = (0..32).map(|k| ([0.1 - f64::from(k) / 300.0, 0.01, 0.0], beam())).collect();
    let scene = seen_by_both(&[face], &beams, FluxModel::Radiometric);
    let count = |switches| visible_pencils(&scene, switches).iter().filter(|visible| **visible).count();
    let both = FACING.union(PLACE);
    assert!(count(Switches::EXACT) >= 32);
    assert_eq!(count(FACING), count(Switches::EXACT));
    assert_eq!(count(PLACE), count(Switches::EXACT));
    let lost = count(Switches::EXACT) - count(both);
    assert!((8..=24).contains(&lost), "{lost}");
}
