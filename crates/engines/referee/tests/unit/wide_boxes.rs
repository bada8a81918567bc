//! Unit tests of `wide_boxes`.

use raypencil_scene::FaceId;

use super::*;
use crate::trees::bvh::{Bvh, InBox};

/// A hierarchy of boxes around points that a counter scatters over `size` metres around `middle`.
fn scattered(count: u32, middle: DVec3, size: f64) -> Vec<Node> {
    let part = |k: u32, step: u32| f64::from(k.wrapping_mul(step) % 8192) / 8192.0 - 0.5;
    let boxes = (0..count).map(|k| {
        let at = middle + size * DVec3::new(part(k, 5003), part(k, 3571), part(k, 7919));
        Node { low: at, high: at + 0.01 * size * DVec3::splat(part(k, 1237).abs()), first: k, count: 1 }
    });
    joined(&boxes.collect::<Vec<_>>())
}

/// The hierarchy over leaves, in their order.
fn joined(leaves: &[Node]) -> Vec<Node> {
    fn fill(nodes: &mut Vec<Node>, at: usize, leaves: &[Node]) {
        if let [leaf] = leaves {
            nodes[at] = *leaf;
            return;
        }
        let first = nodes.len();
        nodes.extend([leaves[0]; 2]);
        let (lower, upper) = leaves.split_at(leaves.len() / 2);
        fill(nodes, first, lower);
        fill(nodes, first + 1, upper);
        let [a, b] = [nodes[first], nodes[first + 1]];
        nodes[at] = Node { low: a.low.min(b.low), high: a.high.max(b.high), first: first as u32, count: 0 };
    }
    let mut nodes = leaves[..1].to_vec();
    fill(&mut nodes, 0, leaves);
    nodes
}

/// The leaves that a walk comes to, with where it enters each.
fn walk(wide: &WideBoxes, bundle: &RayBundle) -> Vec<(u32, f32)> {
    let rays = wide.rays(bundle);
    let (mut leaves, mut waiting) = (Vec::new(), Vec::from_iter(wide.root()));
    while let Some(node) = waiting.pop() {
        match node.count {
            0 => wide.enter(node.first, &rays, &mut waiting),
            count => leaves.extend((node.first..node.first + count).map(|leaf| (leaf, node.entry))),
        }
    }
    leaves
}

#[test]
fn every_box_that_holds_a_point_of_a_ray_is_entered_before_it() {
    // Near the origin, and where an f32 has steps of metres.
    for (middle, size) in
        [(DVec3::ZERO, 10.0), (DVec3::new(3e7, -5e6, 1e6), 10.0), (DVec3::new(3.0, 4.0, 5.0), 1e6)]
    {
        let nodes = scattered(300, middle, size);
        let wide = WideBoxes::of(&nodes);
        let leaves: Vec<&Node> = nodes.iter().filter(|node| node.count > 0).collect();
        assert_eq!(leaves.len(), 300);
        let mut entered = 0;
        for (k, target) in leaves.iter().enumerate() {
            let from = leaves[(7 * k + 5) % leaves.len()].high + 0.1 * size;
            // Towards a corner: any error inward misses it. A third of the rays runs along an axis.
            let to = if k % 2 == 0 { target.low } else { target.high };
            let start = match k % 3 {
                0 => DVec3 { x: from.x, ..to },
                _ => from,
            };
            if start == to {
                continue;
            }
            let direction = (to - start).normalize();
            let range = (to - start).length();
            let bundle = RayBundle {
                origin: start,
                direction,
                max_range: 2.0 * range,
                start_radius: 0.0,
                spread: 0.0,
            };
            let found = walk(&wide, &bundle);
            let leaf = found.iter().find(|(leaf, _)| *leaf == target.first);
            let (_, entry) = leaf.unwrap_or_else(|| panic!("{middle} {size}: leaf {k} was lost"));
            // The corner itself is off the ray by the roundings of its direction.
            assert!(f64::from(*entry) <= range * (1.0 + 1e-12), "{entry} for {range}");
            // And not all boxes are entered.
            entered += found.len();
        }
        assert!(entered < 300 * 60, "{entered}");
    }
}

#[test]
fn a_spread_bundle_enters_what_its_outermost_rays_meet() {
    let nodes = scattered(300, DVec3::ZERO, 10.0);
    let wide = WideBoxes::of(&nodes);
    for target in nodes.iter().filter(|node| node.count > 0) {
        // From 20 m away, past the box by as much as the start and the spread allow.
        let (start_radius, spread) = (0.3, 0.02);
        let start = DVec3::new(-20.0, 1.0, 2.0);
        let range = (target.low - start).length();
        let towards = (target.low - start) / range;
        let beside = towards.any_orthonormal_vector();
        let origin = start + start_radius * beside;
        // Rotated by so much that the unit directions differ by the spread.
        let half = libm::asin(spread / 2.0);
        let direction = towards * libm::cos(2.0 * half) + beside * libm::sin(2.0 * half);
        let bundle = RayBundle { origin, direction, max_range: 100.0, start_radius, spread };
        let found = walk(&wide, &bundle);
        let (_, entry) = found.iter().find(|(leaf, _)| *leaf == target.first).expect("it is entered");
        assert!(f64::from(*entry) <= range, "{entry} for {range}");
        let narrow = RayBundle { start_radius: 0.0, spread: 0.0, ..bundle };
        assert!(walk(&wide, &narrow).len() <= found.len());
    }
}

#[test]
fn empty_and_single_boxes_are_walked() {
    let ahead = RayBundle {
        origin: DVec3::ZERO,
        direction: DVec3::X,
        max_range: 10.0,
        start_radius: 0.0,
        spread: 0.0,
    };
    assert!(walk(&WideBoxes::of(&[]), &ahead).is_empty());
    let leaf =
        |x: f64| Node { low: DVec3::splat(x), high: DVec3::new(x + 1.0, 1.0, 1.0), first: 3, count: 2 };
    let found = walk(&WideBoxes::of(&[leaf(0.0)]), &ahead);
    assert_eq!(found.iter().map(|(leaf, _)| *leaf).collect::<Vec<_>>(), [3, 4]);
    // Beyond the range, and beside the ray.
    assert!(walk(&WideBoxes::of(&[leaf(11.0)]), &ahead).is_empty());
    let up = RayBundle { direction: DVec3::Z, origin: DVec3::new(-0.5, 0.5, -3.0), ..ahead };
    assert!(walk(&WideBoxes::of(&[leaf(0.0)]), &up).is_empty());
}

/// Something at a place, as a hierarchy holds it.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Speck(u32, DVec3);

impl InBox for Speck {
    fn id(&self) -> FaceId {
        FaceId(self.0)
    }

    fn corners(&self) -> [DVec3; 3] {
        [self.1, self.1 + 0.01 * DVec3::X, self.1 + 0.01 * DVec3::Y]
    }

    fn middle(&self, axis: usize) -> f64 {
        self.1[axis]
    }
}

/// A hierarchy without nodes is as sharp as one with them, far from the origin, too: its boxes are relative to the middle of all. And it is
/// whole, if it is made of one piece and if it is made of four.
#[test]
fn a_hierarchy_for_walks_shows_what_one_with_nodes_shows() {
    let middle = DVec3::new(3e7, -5e6, 1e6);
    for (count, most) in [(300, 60), (10_000, 300)] {
        let specks: Vec<Speck> = scattered(count, middle, 10.0)
            .iter()
            .filter(|node| node.count > 0)
            .map(|node| Speck(node.first, node.low))
            .collect();
        let both = [Bvh::build(specks.clone()), Bvh::for_walks(specks.clone())];
        for speck in specks.iter().step_by(count as usize / 60) {
            let origin = middle - 20.0 * DVec3::X;
            let direction = (speck.1 - origin).normalize();
            let bundle = RayBundle { origin, direction, max_range: 100.0, start_radius: 0.001, spread: 0.0 };
            let [with, without] = both.each_ref().map(|bvh| {
                let mut shown = Vec::new();
                bvh.visit(&bundle, |speck| {
                    shown.push(speck.0);
                    bundle.max_range
                });
                shown.sort_unstable();
                shown
            });
            assert_eq!(with, without);
            assert!(with.contains(&speck.0) && with.len() < most, "{} of {count}", with.len());
        }
    }
}
