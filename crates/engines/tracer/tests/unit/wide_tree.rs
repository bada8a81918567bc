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
