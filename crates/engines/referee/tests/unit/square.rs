//! What is told of a whole square, against margins.

use std::ops::AddAssign;

use glam::DVec3;
use raypencil_scene::{CastRay, FaceId, Sides, Triangles};

use crate::cast::ExactCast;
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
