//! Unit tests of `wide_tree`.

use super::*;

/// Boxes of 1 m on a square grid.
fn grid(count: u32) -> Vec<Aabb> {
    let corner = |k: u32| Vec3A::new((k % 64) as f32, (k / 64) as f32, (k * 37 % 11) as f32);
    (0..count).map(|k| Aabb::new(corner(k), corner(k) + 1.0)).collect()
}

/// Every face that a walk shows, in the order of the walk.
#[derive(Default)]
struct Shown(Vec<usize>);

impl Visitor for Shown {
    fn leaf(&mut self, entries: std::ops::Range<usize>, _: &mut f32) -> Next {
        self.0.extend(entries);
        Next::On
    }
}

/// The faces that a walk through the tree of some boxes shows.
fn faces_of(boxes: &[Aabb], walk: impl FnOnce(&WideTree, &mut Vec<Waiting>, &mut Shown)) -> Vec<u32> {
    let forest = Forest::build(boxes.len(), |face| Some(boxes[face as usize]));
    let (faces, first_faces) = forest.faces();
    let tree = WideTree::collapse(&forest, &first_faces);
    let mut shown = Shown::default();
    let mut stack = tree.stack();
    let capacity = stack.capacity();
    walk(&tree, &mut stack, &mut shown);
    assert_eq!(stack.capacity(), capacity, "the stack was too small");
    shown.0.into_iter().map(|at| faces[at]).collect()
}

fn walk(boxes: &[Aabb], bundle: &Bundle) -> Vec<u32> {
    let mut bundle = *bundle;
    faces_of(boxes, |tree, stack, shown| tree.walk(stack, &mut bundle, shown))
}

/// The faces that a walk of one ray shows.
fn walk_ray(boxes: &[Aabb], ray: &Ray) -> Vec<u32> {
    faces_of(boxes, |tree, stack, shown| tree.walk_ray(stack, ray, shown))
}

#[test]
fn a_walk_without_limits_shows_every_face_once() {
    // Rays in all directions, so that no axis limits them.
    let everywhere = Bundle { origin: [0.0; 3], inverse: [None; 3], far: f32::MAX };
    for count in [0, 1, 2, 7, 8, 9, 100, 2048, 2049, 5000, 20_000] {
        let mut faces = walk(&grid(count), &everywhere);
        faces.sort_unstable();
        assert!(faces.into_iter().eq(0..count), "{count}");
    }
}

#[test]
fn a_walk_shows_the_faces_whose_boxes_the_rays_meet_and_few_others() {
    let boxes = grid(4096);
    // Up from below the box 20, 30, a little to all sides.
    let aslant = [Some([20.0_f32, 30.0]), Some([-30.0, -20.0]), Some([1.0, 1.01])];
    let bundle = Bundle { origin: [20.0, 31.0, -1.0], inverse: aslant, far: 100.0 };
    let faces = walk(&boxes, &bundle);
    let meets = |face: &u32| {
        // A dozen rays of the bundle, in double precision.
        let Aabb { min, max } = boxes[*face as usize];
        (0..12).any(|k| {
            let part = f64::from(k) / 11.0;
            let inverse =
                aslant.map(|ends| ends.map(|[a, b]| f64::from(a) + part * f64::from(b - a)).unwrap());
            let (mut enter, mut leave) = (0.0_f64, 100.0_f64);
            for axis in 0..3 {
                let ends =
                    [min[axis], max[axis]].map(|end| f64::from(end - bundle.origin[axis]) * inverse[axis]);
                enter = enter.max(ends[0].min(ends[1]));
                leave = leave.min(ends[0].max(ends[1]));
            }
            enter <= leave
        })
    };
    let met: Vec<u32> = (0..4096).filter(meets).collect();
    assert!(!met.is_empty() && met.iter().all(|face| faces.contains(face)), "{met:?} of {faces:?}");
    assert!(faces.len() < 64, "{} faces", faces.len());
}

#[test]
fn a_walk_of_one_ray_shows_the_faces_whose_boxes_it_meets_and_few_others() {
    let boxes = grid(4096);
    let mut met_by_all = 0;
    for k in 0..600_u32 {
        let part = |step: u32| ((k + 1) * step % 1021) as f32 / 1021.0;
        let origin = Vec3A::new(64.0 * part(577), 64.0 * part(331), 40.0 * part(197) - 15.0);
        // Along each axis both ways, within a plane, and aslant.
        let mut direction = Vec3A::new(part(409) - 0.5, part(719) - 0.5, part(887) - 0.5);
        if k % 4 == 0 {
            direction[(k / 4 % 3) as usize] = 0.0;
        } else if k % 4 == 1 {
            direction = Vec3A::AXES[(k / 4 % 3) as usize] * if k % 8 == 1 { 1.0 } else { -1.0 };
        }
        let ray = Ray::new(origin, direction.normalize(), 0.0, if k % 3 == 0 { 9.0 } else { 100.0 });
        let faces = walk_ray(&boxes, &ray);
        let meets = |face: &u32| {
            let Aabb { min, max } = boxes[*face as usize];
            let (a, b) = ((min - ray.origin) * ray.inv_direction, (max - ray.origin) * ray.inv_direction);
            a.min(b).max_element().max(0.0) <= a.max(b).min_element().min(ray.tmax)
        };
        let met: Vec<u32> = (0..4096).filter(meets).collect();
        assert!(met.iter().all(|face| faces.contains(face)), "{ray:?}: {met:?} of {faces:?}");
        assert!(faces.len() <= 4 * met.len() + 64, "{ray:?}: {} faces for {}", faces.len(), met.len());
        met_by_all += met.len();
    }
    assert!(met_by_all > 300, "{met_by_all}");
}

#[test]
fn boxes_in_one_place_are_shown_with_all_their_faces() {
    // Three groups and more, each of them a single leaf; and no face at all.
    let ray = Ray::new(Vec3A::new(0.5, 0.5, 9.0), Vec3A::NEG_Z, 0.0, 100.0);
    let mut faces = walk_ray(&[Aabb::new(Vec3A::ZERO, Vec3A::ONE); 6000], &ray);
    faces.sort_unstable();
    assert!(faces.into_iter().eq(0..6000));
    assert!(walk_ray(&[], &ray).is_empty());
}

/// Boxes half a metre high, one above the other, from z = 0 on.
fn tower(count: u32) -> Vec<Aabb> {
    let at = |k: u32| Vec3A::new(0.0, 0.0, k as f32);
    (0..count).map(|k| Aabb::new(at(k), at(k) + Vec3A::new(1.0, 1.0, 0.5))).collect()
}

/// Which way a walk goes: for many rays, for one, and a step at a time.
#[derive(Debug, Clone, Copy)]
enum By {
    Bundle,
    Ray,
    Steps,
}

/// The leaves that a ray is shown that ends at `limit` once it has met one, each by its faces.
fn leaves_up_to(boxes: &[Aabb], ray: &Ray, limit: f32, by: By) -> Vec<Vec<u32>> {
    struct Limited(Vec<std::ops::Range<usize>>, f32);
    impl Visitor for Limited {
        fn leaf(&mut self, entries: std::ops::Range<usize>, far: &mut f32) -> Next {
            self.0.push(entries);
            *far = self.1;
            Next::On
        }
    }
    let mut limited = Limited(vec![], limit);
    let mut faces = faces_of(boxes, |tree, stack, shown| {
        match by {
            By::Bundle => {
                let inverse = ray.inv_direction.to_array().map(|inverse| Some([inverse; 2]));
                let mut bundle = Bundle { origin: ray.origin.to_array(), inverse, far: ray.tmax };
                tree.walk(stack, &mut bundle, &mut limited);
            }
            By::Ray => tree.walk_ray(stack, ray, &mut limited),
            By::Steps => {
                let mut steps = Steps::default();
                steps.begin(tree, ray);
                loop {
                    match steps.at() {
                        At::End => break,
                        At::Node => steps.enter(tree),
                        At::Leaf(entries) => {
                            limited.leaf(entries, &mut 0.0);
                            steps.end_at(limit);
                            steps.go_on();
                        }
                    }
                }
            }
        }
        shown.0 = limited.0.iter().cloned().flatten().collect();
    })
    .into_iter();
    limited.0.iter().map(|entries| faces.by_ref().take(entries.len()).collect()).collect()
}

#[test]
fn a_walk_goes_from_the_nearest_leaf_to_the_farthest_that_still_counts() {
    let boxes = tower(100);
    let at = Vec3A::new(0.5, 0.5, 0.0);
    // Up from 2 m below the lowest, and down from 2 m above the highest.
    let up = Ray::new(at - 2.0 * Vec3A::Z, Vec3A::Z, 0.0, 500.0);
    let down = Ray::new(at + 101.5 * Vec3A::Z, Vec3A::NEG_Z, 0.0, 500.0);
    for (ray, by) in
        [up, down].into_iter().flat_map(|ray| [By::Bundle, By::Ray, By::Steps].map(|by| (ray, by)))
    {
        let near = |leaf: &Vec<u32>| {
            let begin =
                |&face: &u32| if ray.direction.z > 0.0 { face as f32 + 2.0 } else { 101.0 - face as f32 };
            leaf.iter().map(begin).fold(f32::MAX, f32::min)
        };
        let all = leaves_up_to(&boxes, &ray, 500.0, by);
        assert!(all.is_sorted_by(|one, next| near(one) < near(next)), "{by:?}: {all:?}");
        assert_eq!(all.iter().map(Vec::len).sum::<usize>(), 100);
        // A leaf that begins at the end itself counts: a face in it may be as near, and have the lower index.
        for last in [0, 1, 7, 8, 9, all.len() - 1] {
            let limit = near(&all[last]);
            assert_eq!(leaves_up_to(&boxes, &ray, limit, by), all[..=last], "{by:?} up to {limit}");
            // The first is shown before anything ends the ray.
            let before = leaves_up_to(&boxes, &ray, limit.next_down(), by);
            assert_eq!(before, all[..last.max(1)], "{by:?} up to less than {limit}");
        }
    }
}

#[test]
fn the_three_walks_of_a_ray_show_the_same_faces_in_the_same_order() {
    let boxes = grid(4096);
    for k in 0..300_u32 {
        let part = |step: u32| ((k + 1) * step % 1021) as f32 / 1021.0;
        let origin = Vec3A::new(64.0 * part(577), 64.0 * part(331), 40.0 * part(197) - 15.0);
        let direction = Vec3A::new(part(409) - 0.5, part(719) - 0.5, part(887) - 0.5);
        let ray = Ray::new(origin, direction.normalize(), 0.0, 100.0);
        let [bundle, one, steps] =
            [By::Bundle, By::Ray, By::Steps].map(|by| leaves_up_to(&boxes, &ray, 60.0, by));
        assert!(one == bundle && one == steps, "{ray:?}: {one:?}, {bundle:?}, {steps:?}");
    }
}

#[test]
fn an_axis_along_which_a_ray_stays_limits_no_bundle() {
    let of = |least: f32, greatest: f32| {
        Bundle::new(Vec3A::ZERO, Vec3A::new(least, 0.5, 0.5), Vec3A::new(greatest, 1.0, 1.0), 9.0).inverse[0]
    };
    assert_eq!((of(0.25, 0.5), of(-0.5, -0.25)), (Some([2.0, 4.0]), Some([-4.0, -2.0])));
    assert_eq!([of(0.0, 0.5), of(-0.5, 0.0), of(-0.5, 0.5), of(0.0, 0.0)], [None; 4]);
}

/// Eight boxes a node, as long as there are so many: fewer nodes are fewer steps of a walk.
#[test]
fn a_node_takes_up_to_eight_boxes_and_a_stack_those_of_each_depth() {
    let tree_of = |boxes: &[Aabb]| {
        let forest = Forest::build(boxes.len(), |face| Some(boxes[face as usize]));
        WideTree::collapse(&forest, &forest.faces().1)
    };
    // The node above the one group, and the group's own; of boxes without a size too.
    let points: Vec<Aabb> = (0..8).map(|k| Aabb::new(Vec3A::X * k as f32, Vec3A::X * k as f32)).collect();
    for boxes in [tower(1), tower(2), tower(8), points] {
        let tree = tree_of(&boxes);
        assert_eq!((tree.node_count(), tree.stack_size), (2, 17), "{boxes:?}");
    }
    // Nine: eight, one of them a node of two.
    assert_eq!((tree_of(&tower(9)).node_count(), tree_of(&tower(9)).stack_size), (3, 25));
    assert_eq!((tree_of(&[]).node_count(), tree_of(&[]).stack_size), (0, 0));
}

#[test]
fn a_ray_that_goes_nowhere_has_no_step_left_of_the_one_before() {
    let boxes = tower(100);
    let up = Ray::new(Vec3A::new(0.5, 0.5, -2.0), Vec3A::Z, 0.0, 500.0);
    faces_of(&boxes, |tree, _, _| {
        let mut steps = Steps::default();
        steps.begin(tree, &up);
        assert!(matches!(steps.at(), At::Node));
        steps.begin_nowhere();
        assert!(matches!(steps.at(), At::End));
    });
}
