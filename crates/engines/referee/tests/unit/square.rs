//! What is told of a whole square, against margins.

use std::ops::AddAssign;

use glam::DVec3;
use raypencil_scene::{CastRay, FaceId, Sides, Triangles};

use super::Square;
use crate::cast::ExactCast;
use crate::cast::triangle::Triangle;
use crate::soup::soup;
use crate::splitmix::SplitMix64;

/// A ray to a place of one of the faces, or beside it.
fn ray_at(mesh: &Triangles, random: &mut SplitMix64) -> CastRay {
    let from = DVec3::from_array([0; 3].map(|_| 3.0 * random.part()));
    let face = mesh.corners(FaceId(random.below(18)));
    let weight = 0.5 + 0.6 * random.part();
    let to = face[0] + (face[1] - face[0]) * weight + (face[2] - face[0]) * (0.5 * (1.0 - weight));
    CastRay::new(from, to - from)
}

#[test]
fn a_square_is_steady_up_to_the_margin_and_no_farther() {
    let mut random = SplitMix64(6);
    let (mut hits, mut misses, mut far_less) = (0, 0, 0);
    for _ in 0..100 {
        let mesh = soup(&mut random);
        let cast = ExactCast::new(&mesh);
        for sides in [Sides::Both, Sides::Fronts] {
            let endless = ray_at(&mesh, &mut random);
            let ray = match random.below(3) {
                0 => endless,
                1 => CastRay { t_max: 1.0 + 0.5 * random.part(), ..endless },
                _ => CastRay { t_blind: 1.0 + 0.5 * random.part(), ..endless },
            };
            let margin = cast.margins(&ray, sides).face;
            // The margin's own displacement lies in this square.
            let past_it = (1.0 + 1e-9) * margin.hi;
            assert!(past_it > 1e9 || !cast.is_steady(&ray, sides, past_it), "{ray:?} {margin:?}");
            if margin.lo > 1e-9 && cast.is_steady(&ray, sides, 0.1 * margin.lo) {
                let is_hit = !cast.first(&ray, sides).is_empty();
                (if is_hit { &mut hits } else { &mut misses }).add_assign(1);
            } else {
                far_less += 1;
            }
        }
    }
    assert!(hits > 60 && misses > 20 && far_less < 20, "{hits} {misses} {far_less}");
}

/// Where an interval has nothing to lose, the square is held from both sides: all three edges of this face are 1/4 away.
#[test]
fn a_square_is_as_large_as_it_says() {
    let mesh =
        Triangles::new(vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], vec![[0, 1, 2]]).expect("a mesh");
    let ray = CastRay::new(DVec3::new(0.25, 0.25, 1.0), DVec3::NEG_Z);
    let is_steady = |most: f64| ExactCast::new(&mesh).is_steady(&ray, Sides::Both, most);
    assert!(is_steady(0.25 - 1e-12));
    assert!(!is_steady(0.25));
}

/// A ray begins at its start itself: a square whose least t is there is steady, and one whose least t is before it is not.
#[test]
fn a_square_may_begin_at_the_start_of_its_ray() {
    let mesh =
        Triangles::new(vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], vec![[0, 1, 2]]).expect("a mesh");
    let cast = ExactCast::new(&mesh);
    let ray = CastRay::new(DVec3::new(0.25, 0.25, 1.0), DVec3::NEG_Z);
    let least = Square::new(&ray, 0.125).t(&Triangle::of(&mesh, FaceId(0))).low;
    let is_steady = |t_min: f64| cast.is_steady(&CastRay { t_min, ..ray }, Sides::Both, 0.125);
    assert!(least < 1.0 && is_steady(least));
    // All rays meet the face at t = 1, but intervals do not tell.
    assert!(!is_steady(least.next_up()));
}

/// A face that only the corner of the square reaches is looked at, in whatever direction the corner is.
#[test]
fn the_corners_of_a_square_are_looked_at() {
    let mut random = SplitMix64(7);
    for _ in 0..200 {
        let direction = DVec3::from_array([0; 3].map(|_| random.part()));
        let ray = CastRay::new(DVec3::ZERO, direction);
        let [u, v] = ray.across();
        // Eight small faces beside the ray in each of four places, one of them near.
        let mut corners = Vec::new();
        for at in [0.3 * (u + v), 50.0 * (u + v), 50.0 * (u - v), 50.0 * (v - u)] {
            for k in 0..8 {
                let at = at + direction * (1.0 + f64::from(k) / 100.0);
                corners.extend([at, at + 0.001 * u, at + 0.001 * v].map(|corner| corner.to_array()));
            }
        }
        let faces = (0..32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
        let mesh = Triangles::new(corners, faces).expect("a mesh");
        let is_steady = |most: f64| ExactCast::new(&mesh).is_steady(&ray, Sides::Both, most);
        assert!(is_steady(0.1), "{direction}");
        assert!(!is_steady(0.301), "{direction}");
    }
}

/// A face beside the ray is listed from the displacement that leads to it, whichever way that is: to the left, below, or along both
/// vectors.
#[test]
fn a_face_is_near_from_its_distance_on() {
    let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let ray = CastRay::new(DVec3::new(0.25, 0.25, 1.0), DVec3::NEG_Z);
    for (beyond, [a, b]) in
        [([-1.0, 0.5, 0.0], [2, 0]), ([0.5, -1.0, 0.0], [0, 1]), ([1.0, 1.0, 0.0], [1, 2])]
    {
        let corners = [&corners[..], &[beyond]].concat();
        let mesh = Triangles::new(corners, vec![[0, 1, 2], [b, a, 3]]).expect("a mesh");
        let near = |most: f64| ExactCast::new(&mesh).faces_near(&ray, Sides::Both, most);
        assert_eq!(near(0.25 - 1e-12), [FaceId(0)], "{beyond:?}");
        assert_eq!(near(0.25), [FaceId(0), FaceId(1)], "{beyond:?}");
    }
}

/// What a moved ray meets is among the faces near the ray, and few others are.
#[test]
fn no_face_that_a_moved_ray_meets_is_left_out() {
    let mut random = SplitMix64(9);
    let (mut met, mut near, mut beside) = (0, 0, 0);
    for _ in 0..100 {
        let mesh = soup(&mut random);
        let cast = ExactCast::new(&mesh);
        for sides in [Sides::Both, Sides::Fronts] {
            let endless = ray_at(&mesh, &mut random);
            let ray = if random.below(2) == 0 { endless } else { CastRay { t_max: 1.0, ..endless } };
            let most = 0.2;
            let listed = cast.faces_near(&ray, sides, most);
            assert!(listed.is_sorted_by(|a, b| a < b), "{listed:?}");
            near += listed.len();
            let mut seen = Vec::new();
            for _ in 0..40 {
                let by = [0; 2].map(|_| most * random.part());
                seen.extend(cast.first_moved(&ray, sides, by));
            }
            seen.sort_unstable();
            seen.dedup();
            met += seen.len();
            beside += usize::from(seen.len() > 1);
            for face in seen {
                assert!(listed.contains(&face), "{face:?} of {listed:?} for {ray:?}");
            }
        }
    }
    // The others lie behind what the rays meet first, or beside them.
    assert!(met > 150 && beside > 30 && near < 6 * met, "{met} {beside} {near}");
}
