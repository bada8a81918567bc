//! No face that a ray meets is left out, on rays and faces that are hard for f32; and most others are.

use raypencil_scene::{CastRay, Sides, Triangles};

use super::super::query_ray::QueryRay;
use super::super::{ExactCast, Tree};
use super::*;
use crate::splitmix::SplitMix64;

fn point(random: &mut SplitMix64) -> DVec3 {
    DVec3::new(random.part(), random.part(), random.part())
}

/// Triangles of this size anywhere in a cube of 2.
fn scattered(random: &mut SplitMix64, size: f64) -> Vec<[DVec3; 3]> {
    (0..300)
        .map(|_| {
            let at = point(random);
            [0; 3].map(|_| at + size * point(random))
        })
        .collect()
}

/// A square of 2 of small whole steps of 1/8, flat, but for a pit.
fn lattice() -> Vec<[DVec3; 3]> {
    let corner = |x: i32, y: i32| {
        let height = if (x - 8).abs() < 3 && (y - 8).abs() < 3 { -0.25 } else { 0.0 };
        DVec3::new(f64::from(x - 8) / 8.0, f64::from(y - 8) / 8.0, height)
    };
    (0..256)
        .flat_map(|k| {
            let (x, y) = (k % 16, k / 16);
            let [a, b, c, d] = [corner(x, y), corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1)];
            [[a, b, c], [a, c, d]]
        })
        .collect()
}

/// Slender faces, which f32 tips over.
fn slender(random: &mut SplitMix64) -> Vec<[DVec3; 3]> {
    (0..300)
        .map(|_| {
            let (a, b) = (point(random), point(random));
            [a, b, a.lerp(b, 0.3) + 1e-7 * point(random)]
        })
        .collect()
}

/// A ray at a point of a face: within it, on an edge, or at a corner, each to a few last digits of f32 or f64; from all around,
/// along an axis or nearly so, some with ends.
fn aimed(random: &mut SplitMix64, face: [DVec3; 3], far: f64) -> CastRay {
    let [a, b, c] = face;
    let along = 0.5 + 0.5 * random.part();
    let target = match random.below(4) {
        0 => (a + b + c) / 3.0,
        1 => a,
        _ => a.lerp(b, along),
    };
    let beside = [0.0, 1e-16, 1e-9, 1e-7, 1e-6][random.below(5) as usize];
    let target = target + beside * point(random);
    let direction = match random.below(4) {
        0 => DVec3::AXES[random.below(3) as usize] * if random.below(2) == 0 { 1.0 } else { -1.0 },
        1 => {
            let mut direction = point(random);
            direction[random.below(3) as usize] *= [1e-20, 1e-31, 1e-90, 1e-300][random.below(4) as usize];
            direction
        }
        _ => point(random),
    };
    let t = far * (1.0 + random.part());
    let ray = CastRay::new(target - direction * t, direction);
    match random.below(4) {
        // Their ends are where the face is, or at both sides of it.
        0 => CastRay { t_min: t, ..ray },
        1 => CastRay { t_max: t, ..ray },
        2 => CastRay { t_min: 0.999 * t, t_max: 1.001 * t, ..ray },
        _ => ray,
    }
}

/// The mesh and rays at it, moved and scaled.
fn moved_and_scaled(faces: &[[DVec3; 3]], by: DVec3, size: f64) -> (Triangles, Vec<[DVec3; 3]>) {
    let faces: Vec<_> = faces.iter().map(|face| face.map(|corner| (corner + by) * size)).collect();
    let vertices = faces.iter().flatten().map(DVec3::to_array).collect();
    let indices = (0..faces.len() as u32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    (Triangles::new(vertices, indices).expect("triangles"), faces)
}

#[test]
fn every_face_that_is_met_is_shown_and_few_others() {
    let mut random = SplitMix64(3);
    let families = [
        ("large", scattered(&mut random, 0.5), 0.3),
        ("small", scattered(&mut random, 0.02), 0.01),
        ("lattice", lattice(), 0.1),
        ("slender", slender(&mut random), 0.1),
    ];
    let places = [
        (DVec3::ZERO, 1.0),
        (DVec3::new(3e7, -5e6, 1e6), 1.0),
        (DVec3::ZERO, 1e28),
        (DVec3::ONE, 1e-40),
        (DVec3::ZERO, 1e-170),
    ];
    for (name, faces, most) in families {
        for (by, size) in places {
            let (mesh, faces) = moved_and_scaled(&faces, by, size);
            let cast = ExactCast::new(&mesh);
            let (tree, all) = (&cast.tree, cast.bvh().faces_below(0));
            let (mut shown, mut met, mut asked) = (0, 0, 0);
            for k in 0..2000 {
                let far = [0.5, 1.0, 30.0, 3e4][k % 4];
                let face = faces[random.below(faces.len() as u32) as usize];
                let unit = aimed(&mut random, face.map(|corner| corner / size), far);
                let ray = CastRay { origin: unit.origin * size, direction: unit.direction * size, ..unit };
                if ray.validate("ray").is_err() {
                    continue;
                }
                let Some(in_frame) = tree.wide.ray(&ray) else { continue };
                asked += 1;
                let mut ids = Vec::new();
                tree.wide.walk(mesh.vertices(), &in_frame, |face| {
                    ids.push(face.id);
                    Next::On
                });
                let query = QueryRay::new(&ray);
                for face in all {
                    if face.met_side(&query, Sides::Both).is_some() {
                        met += 1;
                        assert!(ids.contains(&face.id), "{name} of {size} at {by}: {face:?} by {ray:?}");
                    }
                }
                // From far away f32 can tell little.
                shown += if far < 10.0 { ids.len() } else { 0 };
            }
            assert!(asked > 1000 && met > 300, "{name} of {size} at {by}: {asked} rays, {met} faces met");
            let share = shown as f64 / (0.5 * asked as f64 * all.len() as f64);
            assert!(share < most, "{name} of {size} at {by}: {share} of all faces shown");
        }
    }
}

/// A ray that passes a face is shown it, unless it passes by more than the bound of the page.
#[test]
fn a_face_is_left_out_only_beyond_the_bound() {
    // In the frame half as large: E = 3/2. A ray straight down, beside the edge from c to a.
    let corners = vec![[-1.5, -1.5, 0.0], [1.5, -1.5, 0.0], [-1.5, 1.5, 0.0]];
    let tree = WideTree::of(&Triangles::new(corners, vec![[0, 1, 2]]).expect("a mesh"));
    let beside = |steps: f64| {
        let x = -0.75 - steps * f64::from(U);
        let ray = CastRay::new(2.0 * DVec3::new(x, 0.0, 0.25), DVec3::NEG_Z);
        tree.leaves[0].may_meet(&tree.ray(&ray).expect("a ray that is near"))
    };
    // d x a' is (-3/4, -x', 0) for the way x' beside the edge, so C = 3/4 and F = E x'. A is 7/4, and a little more for all roundings.
    let (u, a, c, e) = (f64::from(U), 1.75, 0.75, 1.5);
    let bound = (c + 2.0 * e + 32.0 * u * a) * (8.0 * u + 16.0 * u * e) + 48.0 * u * a * e;
    let steps = bound / e / u;
    assert_eq!([0.0, 0.5 * steps, steps - 1.0].map(|steps| beside(steps.floor())), [1; 3]);
    assert_eq!([1.01 * steps + 1.0, 2.0 * steps].map(|steps| beside(steps.ceil())), [0; 2]);
}

/// From far away the rounding of the origin counts, for a small face more than its edges do.
#[test]
fn a_small_face_far_away_is_left_out_only_beyond_the_bound() {
    // In the frame half as large: E = 2^-20. The large faces fill another leaf.
    let e = f64::from(16.0 * U);
    let mut corners = vec![[-e, -e, 0.0], [e, -e, 0.0], [-e, e, 0.0]];
    corners.extend([[1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 0.0, 0.0]]);
    let faces = [[[0, 1, 2]; LEAF_WIDTH], [[3, 4, 5]; LEAF_WIDTH]].concat();
    let tree = WideTree::of(&Triangles::new(corners, faces).expect("a mesh"));
    let leaf = tree.leaves.iter().find(|leaf| leaf.ids[0].0 < 4).expect("the leaf of the small faces");
    assert!(f64::from(leaf.longest) < 1.01 * e, "{}", leaf.longest);
    let beside = |way: f64| {
        let ray = CastRay::new(2.0 * DVec3::new(-0.5 * e - way, 0.0, 32768.0), DVec3::NEG_Z);
        leaf.may_meet(&tree.ray(&ray).expect("a ray that is near"))
    };
    // Here the largest part of d x a' is the way x' beside the edge: F = E x', and C = x'.
    let (u, a) = (f64::from(U), 32769.0);
    let of_c = 8.0 * u + 16.0 * u * e;
    let way = ((2.0 * e + 32.0 * u * a) * of_c + 48.0 * u * a * e) / (e - of_c);
    assert_eq!([0.0, 0.5 * way, 0.98 * way].map(beside), [15; 3]);
    assert_eq!([1.02 * way, 2.0 * way].map(beside), [0; 2]);
}

/// The ends of a ray in the frame lie beyond its own, by what the boxes' errors ask for.
#[test]
fn the_ends_of_a_ray_in_the_frame_have_room_for_rounding() {
    let mut random = SplitMix64(9);
    let mesh = moved_and_scaled(&lattice(), DVec3::ZERO, 3.0).0;
    let tree = WideTree::of(&mesh);
    let u = f64::from(U);
    for _ in 0..1000 {
        let t_min = 1.0 + random.unit();
        let ray = CastRay {
            t_min,
            t_max: t_min + random.unit(),
            ..CastRay::new(point(&mut random), point(&mut random))
        };
        let per_t = ray.direction.abs().max_element() * tree.frame.scale;
        let in_frame = tree.ray(&ray).expect("a ray that is near");
        let [near, far] = [f64::from(in_frame.near), f64::from(in_frame.far)];
        assert!(
            near > (1.0 - 20.0 * u) * ray.t_min * per_t && near < (1.0 - 12.0 * u) * ray.t_min * per_t,
            "{ray:?}"
        );
        assert!(
            far > (1.0 + 12.0 * u) * ray.t_max * per_t && far < (1.0 + 20.0 * u) * ray.t_max * per_t,
            "{ray:?}"
        );
    }
}

#[test]
fn every_face_is_in_a_leaf_whatever_their_number() {
    let mut random = SplitMix64(5);
    let all = moved_and_scaled(&scattered(&mut random, 0.1), DVec3::ZERO, 1.0).0;
    for count in (0..=70).chain([128, 129, 255, 256, 257, 260, 300]) {
        let faces = all.faces()[..count as usize].to_vec();
        let tree = WideTree::of(&Triangles::new(all.vertices().to_vec(), faces).expect("a mesh"));
        let mut found = Vec::new();
        let mut waiting: Vec<u32> = (!tree.nodes.is_empty()).then_some(0).into_iter().collect();
        let mut nodes = 0;
        while let Some(at) = waiting.pop() {
            let node = &tree.nodes[at as usize];
            nodes += 1;
            for lane in (0..WIDTH)
                .filter(|&lane| node.planes[0][lane / 4][lane % 4] <= node.planes[3][lane / 4][lane % 4])
            {
                match node.children[lane] {
                    leaf if leaf & LEAF != 0 => {
                        let leaf = &tree.leaves[(leaf & !LEAF) as usize];
                        let present = (0..LEAF_WIDTH).filter(|lane| leaf.present >> lane & 1 == 1);
                        found.extend(present.map(|lane| leaf.ids[lane].0));
                    }
                    node => waiting.push(node),
                }
            }
        }
        found.sort_unstable();
        assert_eq!(found, (0..count).collect::<Vec<_>>());
        assert_eq!((nodes, tree.leaves.len()), (tree.nodes.len(), (count as usize).div_ceil(LEAF_WIDTH)));
    }
}

#[test]
fn what_is_made_when_it_is_first_asked_for_may_be_asked_for_by_many_tasks_at_once() {
    // Each face twice, and so many that they are built on several threads.
    let mut random = SplitMix64(8);
    let mut faces = Vec::new();
    while faces.len() < 3 * 4096 {
        faces.extend(scattered(&mut random, 0.02));
    }
    let mesh = moved_and_scaled(&faces, DVec3::ZERO, 1.0).0;
    let twice = [mesh.faces(), mesh.faces()].concat();
    let mesh = Triangles::new(mesh.vertices().to_vec(), twice).expect("a mesh");
    let rays: Vec<CastRay> = (0..64)
        .map(|k| CastRay::new(DVec3::new(f64::from(k % 8) / 8.0, f64::from(k / 8) / 8.0, 1e7), DVec3::NEG_Z))
        .collect();
    for threads in [1, 2, 5] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        let cast = ExactCast::new(&mesh);
        let told: Vec<_> = pool.install(|| {
            use rayon::prelude::*;
            rays.par_iter()
                .map(|ray| (cast.first(ray, Sides::Both), cast.margins(ray, Sides::Both)))
                .collect()
        });
        let fresh = ExactCast::new(&mesh);
        let one_by_one: Vec<_> =
            rays.iter().map(|ray| (fresh.first(ray, Sides::Both), fresh.margins(ray, Sides::Both))).collect();
        assert_eq!(told, one_by_one);
        assert!(told.iter().filter(|(first, _)| first.len() > 1).count() > 10);
    }
}

/// Numbers of f32 on either side, beyond what a number near 0 may be off by.
#[test]
fn numbers_below_and_above_have_room_for_rounding() {
    for x in [0.0_f64, 1e-30, -1e-30, 1e-18, 0.1, -0.7, 1.0, 60_000.1] {
        let room = (0.5 * f64::from(WIDENED)).max(x.abs() * f64::from(U));
        assert!(f64::from(down(x)) <= x - room && f64::from(up(x)) >= x + room, "{x}");
    }
}

#[test]
fn a_walk_ends_where_its_visitor_says() {
    let (mesh, _) = moved_and_scaled(&lattice(), DVec3::ZERO, 1.0);
    let above = moved_and_scaled(&lattice(), DVec3::new(0.0, 0.0, 1.0), 1.0).0;
    let vertices = [mesh.vertices(), above.vertices()].concat();
    let count = mesh.vertices().len() as u32;
    let faces = mesh.faces().iter().copied().chain(above.faces().iter().map(|face| face.map(|v| v + count)));
    let both = Triangles::new(vertices, faces.collect()).expect("triangles");
    let tree = Tree::of(&both);
    let ray = CastRay::new(DVec3::new(0.3, 0.7, 3.0), DVec3::new(0.01, 0.01, -1.0));
    let in_frame = tree.wide.ray(&ray).expect("a ray that is near");
    let seen = |next: fn() -> Next| {
        let mut seen = Vec::new();
        tree.wide.walk(both.vertices(), &in_frame, |face| {
            seen.push(face.id.0);
            next()
        });
        seen
    };
    // The upper one first, at t = 2; the lower one at t = 3.
    let all = seen(|| Next::On);
    assert!(all.iter().any(|&id| id < 512) && all[0] >= 512, "{all:?}");
    assert!(seen(|| Next::UpTo(2.0)).iter().all(|&id| id >= 512));
    assert_eq!(seen(|| Next::UpTo(3.0)), all);
    assert_eq!(seen(|| Next::Stop).len(), 1);
}

#[test]
fn rays_from_far_away_have_the_same_answers() {
    let mut random = SplitMix64(8);
    let (mesh, faces) = moved_and_scaled(&lattice(), DVec3::ZERO, 1.0);
    let cast = ExactCast::new(&mesh);
    let (mut near, mut distant, mut hits) = (0, 0, 0);
    let mut all = Vec::new();
    for k in 0..400 {
        let far = [1e2, 1e4, 1e6, 1e12][k % 4];
        let face = faces[random.below(512) as usize];
        let ray = aimed(&mut random, face, far);
        match cast.tree.wide.ray(&ray) {
            Some(_) => near += 1,
            None => distant += 1,
        }
        let query = QueryRay::new(&ray);
        let met: Vec<&Triangle> = cast
            .bvh()
            .faces_below(0)
            .iter()
            .filter(|face| face.met_side(&query, Sides::Both).is_some())
            .collect();
        let first = met.iter().min_by(|a, b| a.compare(b, &query));
        let mut ties: Vec<_> = met
            .iter()
            .filter(|face| first.is_some_and(|first| face.compare(first, &query).is_eq()))
            .collect();
        ties.sort_by_key(|face| face.id);
        let ties: Vec<FaceId> = ties.iter().map(|face| face.id).collect();
        hits += usize::from(!ties.is_empty());
        assert_eq!(cast.first(&ray, Sides::Both), ties, "{ray:?}");
        assert_eq!(cast.any(&ray, Sides::Both), !ties.is_empty(), "{ray:?}");
        all.push((ray, ties));
        assert_eq!(
            cast.all(&ray, Sides::Both).iter().map(|group| group.faces.len()).sum::<usize>(),
            met.len()
        );
    }
    // Together they have the same, whatever their number.
    for count in [0, 1, TOGETHER - 1, TOGETHER, TOGETHER + 1, all.len()] {
        let rays: Vec<CastRay> = all[..count].iter().map(|(ray, _)| *ray).collect();
        let expected =
            all[..count].iter().map(|(_, ties)| ties.first().map(|face| (*face, ties.len() as u32)));
        let expected: Vec<Option<(FaceId, u32)>> = expected.collect();
        let mut found = vec![Vec::new(); count];
        cast.first_meetings(&rays, Sides::Both, |index, read, _| {
            found[index].push(read.hit().map(|(meeting, ties)| (meeting.face(), *ties)));
        });
        let once: Vec<_> = expected.iter().map(|expected| vec![*expected]).collect();
        assert_eq!(found, once);
        let is_met: Vec<bool> = expected.iter().map(Option::is_some).collect();
        assert_eq!(cast.any_of(&rays, Sides::Both), is_met);
        for sides in [Sides::Both, Sides::Fronts] {
            let mut found = vec![Vec::new(); count];
            cast.all_of_each(&rays, sides, |index, groups| found[index].push(groups));
            let one_by_one: Vec<_> = rays.iter().map(|ray| vec![cast.all(ray, sides)]).collect();
            assert_eq!(found, one_by_one);
        }
    }
    assert!(near > 100 && distant > 100 && hits > 100, "{near} near, {distant} far away, {hits} hits");
}

#[test]
fn rays_that_follow_each_other_walk_one_by_one_and_have_the_same_answers() {
    let (mesh, _) = moved_and_scaled(&lattice(), DVec3::ZERO, 1.0);
    let cast = ExactCast::new(&mesh);
    // Row by row from one place, through corners, along edges and past the border.
    let of_camera = |k: u32| {
        let (row, column) = (f64::from(k / 40), f64::from(k % 40));
        CastRay::new(DVec3::new(0.25, 0.5, 2.0), DVec3::new(column / 16.0 - 1.3125, row / 16.0 - 1.5, -2.0))
    };
    let rays: Vec<CastRay> = (0..1600).map(of_camera).collect();
    // The same rays, neighbours far apart.
    let order: Vec<usize> = (0..rays.len()).map(|k| k * 607 % rays.len()).collect();
    let scattered: Vec<CastRay> = order.iter().map(|&k| rays[k]).collect();
    assert_eq!((how_many_together(&rays), how_many_together(&scattered)), (1, TOGETHER));
    // Most are more than three of four.
    let three_of_four = [&rays[..4], &rays[600..601]].concat();
    assert_eq!((how_many_together(&three_of_four), how_many_together(&[])), (TOGETHER, TOGETHER));
    let of = |rays: &[CastRay]| {
        let mut all = vec![None; rays.len()];
        cast.first_meetings(rays, Sides::Both, |index, read, decided_by| {
            let hit = read.hit().map(|(meeting, ties)| (meeting.face(), *ties, meeting.t()));
            all[index] = Some((hit, decided_by));
        });
        all
    };
    let (all, of_scattered) = (of(&rays), of(&scattered));
    let (any, any_of_scattered) = (cast.any_of(&rays, Sides::Both), cast.any_of(&scattered, Sides::Both));
    for (k, &from) in order.iter().enumerate() {
        assert_eq!((of_scattered[k], any_of_scattered[k]), (all[from], any[from]), "{:?}", rays[from]);
    }
    let hits = any.iter().filter(|&&any| any).count();
    assert!(hits > 800 && hits < 1500 && all.iter().all(Option::is_some), "{hits} hits");
}

/// Which ray looked at a face, one after the other.
struct InTurns {
    rays: Vec<FrameRay>,
    looks: Vec<usize>,
}

impl Rays for InTurns {
    fn begin(&mut self, _: usize) -> Option<FrameRay> {
        self.rays.pop()
    }

    fn see(&mut self, place: usize, _: &Triangle) -> Next {
        self.looks.push(place);
        Next::On
    }

    fn end(&mut self, _: usize) {}
}

/// While one ray waits for memory, the other goes on: each enters one leaf a turn.
#[test]
fn rays_that_walk_together_take_turns() {
    let (mesh, _) = moved_and_scaled(&lattice(), DVec3::ZERO, 1.0);
    let tree = WideTree::of(&mesh);
    // Along the diagonal, closely over the ground, so that each of the two passes many leaves.
    let ray = CastRay::new(DVec3::new(-2.0, -2.0, 0.01), DVec3::new(1.0, 1.0, -0.004));
    let ray = tree.ray(&ray).expect("a ray that is near");
    let mut rays = InTurns { rays: vec![ray; 2], looks: Vec::new() };
    tree.walk_together(mesh.vertices(), &mut rays, 2);
    let changes = rays.looks.windows(2).filter(|two| two[0] != two[1]).count();
    let of_first = rays.looks.iter().filter(|&&place| place == 0).count();
    assert_eq!(2 * of_first, rays.looks.len());
    assert!(changes > 6, "{changes} of {:?}", rays.looks);
    // The first ray here passes beside all, and another takes its place: that begins after the second one, a turn later.
    let beside = CastRay::new(DVec3::new(-2.0, -2.0, 4.0), DVec3::X);
    let beside = tree.ray(&beside).expect("a ray that is near");
    let mut rays = InTurns { rays: vec![ray, ray, beside], looks: Vec::new() };
    tree.walk_together(mesh.vertices(), &mut rays, 2);
    assert_eq!(rays.looks.first(), Some(&1), "{:?}", rays.looks);
}
