//! The build of the obvhs tree in bounded time for any input: small groups, joined by median splits.
//!
//! obvhs merges nearest neighbours along a space-filling curve (PLOC). Where boxes lie inside one another, each
//! box has the next smaller one for its nearest neighbour. Every pass then merges one pair, and the build is
//! quadratic: 143 s for 100,000 nested triangles. So the boxes are first split at the median along their longest
//! axis until at most [`MAX_GROUP_BOXES`] are left together; that takes n log n steps for any boxes. obvhs builds
//! each group, and the splits become the tree above. The worst case is then quadratic within a group only.
//!
//! The groups do not depend on one another, so threads build them side by side. Equal boxes of a group are built as one.

use std::ops::Range;
use std::time::Duration;

use glam::Vec3A;
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::builder::build_bvh2;
use obvhs::bvh2::node::Bvh2Node;
use rayon::prelude::*;

use crate::distinct::Distinct;

/// Maximum number of boxes that obvhs builds at once. Tuned: the worst group takes 15 ms, and traversal of
/// ordinary terrain is as fast as with one group.
const MAX_GROUP_BOXES: usize = 2048;

/// Index of a face that has no box. No mesh has so many faces.
const NO_FACE: u32 = u32::MAX;

/// A face with a box, and twice the centre of that box, which has the order of the centre.
#[derive(Debug, Clone, Copy)]
struct Member {
    centre: [f32; 3],
    face: u32,
}

impl Member {
    fn of(boxes: &[Aabb], face: u32) -> Self {
        let Aabb { min, max } = boxes[face as usize];
        Self { centre: (min + max).to_array(), face: if min.x <= max.x { face } else { NO_FACE } }
    }
}

/// The tree of one group of boxes.
pub(crate) struct Group {
    /// The root first. Leaves are ranges of `faces`.
    pub(crate) nodes: Vec<Bvh2Node>,
    /// Indices of faces in the order of the leaves.
    pub(crate) faces: Vec<u32>,
}

impl Group {
    /// The ranges of faces of all leaves below the root.
    pub(crate) fn leaves(&self) -> Vec<Range<u32>> {
        let (mut leaves, mut left) = (Vec::new(), vec![0]);
        while let Some(node) = left.pop() {
            let Bvh2Node { first_index, prim_count, .. } = self.nodes[node as usize];
            if prim_count > 0 {
                leaves.push(first_index..first_index + prim_count);
            } else {
                left.extend([first_index, first_index + 1]);
            }
        }
        leaves
    }
}

/// The trees of all groups, and the tree above them.
pub(crate) struct Forest {
    /// The root first; empty if there is no box. The leaf `k..k + 1` is the tree of group k.
    pub(crate) upper: Vec<Bvh2Node>,
    pub(crate) groups: Vec<Group>,
}

impl Forest {
    /// Builds the trees of `count` faces. `box_of` gives the box of a face; faces without one are left out. The result does
    /// not depend on the number of threads.
    pub(crate) fn build(count: usize, box_of: impl Fn(u32) -> Option<Aabb> + Sync) -> Self {
        let boxes = (0..count as u32).into_par_iter().map(|face| box_of(face).unwrap_or(Aabb::INVALID));
        let boxes: Vec<Aabb> = boxes.collect();
        let mut members: Vec<Member> =
            (0..count as u32).into_par_iter().map(|face| Member::of(&boxes, face)).collect();
        if members.par_iter().any(|member| member.face == NO_FACE) {
            members.retain(|member| member.face != NO_FACE);
        }
        let group = |members: &[Member]| build_group(&boxes, members);
        let groups: Vec<Group> = split(&mut members).into_par_iter().map(group).collect();
        let roots: Vec<Aabb> = groups.iter().map(|group| *group.nodes[0].aabb()).collect();
        let mut upper = Vec::with_capacity(2 * roots.len());
        if !roots.is_empty() {
            upper.push(Bvh2Node::default());
            join(&mut upper, 0, members.len(), &mut roots.into_iter().enumerate());
        }
        Self { upper, groups }
    }

    /// The same with leaves of up to `most` faces, wherever so few are below a node.
    pub(crate) fn with_leaves_of(mut self, most: usize) -> Self {
        self.groups.par_iter_mut().for_each(|group| {
            let mut faces = Vec::with_capacity(group.faces.len());
            gather(group, 0, most, &mut faces);
            group.faces = faces;
        });
        self
    }

    /// The faces of all groups, and for each group the first of its own among them.
    pub(crate) fn faces(&self) -> (Vec<u32>, Vec<u32>) {
        let ends = self.groups.iter().scan(0, |end, group| {
            *end += group.faces.len() as u32;
            Some(*end)
        });
        let first = std::iter::once(0).chain(ends).take(self.groups.len()).collect();
        (self.groups.iter().flat_map(|group| &group.faces).copied().collect(), first)
    }
}

/// Splits until the groups are small, the halves on two threads if there are. The result does not depend on that.
fn split(members: &mut [Member]) -> Vec<&[Member]> {
    if members.len() <= MAX_GROUP_BOXES {
        return if members.is_empty() { vec![] } else { vec![members] };
    }
    let middle = members.len() / 2;
    split_at_median(members, middle);
    let (lower, upper) = members.split_at_mut(middle);
    let (mut lower, mut upper) = rayon::join(|| split(lower), || split(upper));
    lower.append(&mut upper);
    lower
}

/// Makes node `at` the root of the tree over the groups of `members` boxes, which are the next of `roots`. Halves as
/// [`split`] does. Returns the box around them.
fn join(
    nodes: &mut Vec<Bvh2Node>,
    at: usize,
    members: usize,
    roots: &mut impl Iterator<Item = (usize, Aabb)>,
) -> Aabb {
    if members <= MAX_GROUP_BOXES {
        let (group, bounds) = roots.next().expect("a root for every group");
        nodes[at] = Bvh2Node::new(bounds, 1, group as u32);
        return bounds;
    }
    // Children are neighbours.
    let first = nodes.len();
    nodes.extend([Bvh2Node::default(); 2]);
    let lower = join(nodes, first, members / 2, roots);
    let bounds = lower.union(&join(nodes, first + 1, members - members / 2, roots));
    nodes[at] = Bvh2Node::new(bounds, 0, first as u32);
    bounds
}

/// The tree of a small group, by obvhs alone.
fn build_group(boxes: &[Aabb], members: &[Member]) -> Group {
    let boxes = members.iter().map(|member| boxes[member.face as usize]).collect();
    // Many equal boxes would make the build quadratic.
    let distinct = Distinct::of(boxes);
    // The preset `fast` measured best between build time and rays per second.
    let mut tree = build_bvh2(&distinct.boxes, BvhBuildParams::fast_build(), &mut Duration::default());
    let mut faces = Vec::with_capacity(members.len());
    for leaf in tree.nodes.iter_mut().filter(|node| node.is_leaf()) {
        let boxes = leaf.first_index as usize..(leaf.first_index + leaf.prim_count) as usize;
        let first = faces.len();
        for &index in &tree.primitive_indices[boxes] {
            faces.extend(distinct.members(index as usize).iter().map(|&at| members[at as usize].face));
        }
        (leaf.first_index, leaf.prim_count) = (first as u32, (faces.len() - first) as u32);
    }
    Group { nodes: tree.nodes, faces }
}

/// Appends the faces below a node to `gathered`, and makes it a leaf if they are few.
fn gather(group: &mut Group, node: usize, most: usize, gathered: &mut Vec<u32>) {
    let Bvh2Node { first_index, prim_count, .. } = group.nodes[node];
    let (first, below) = (gathered.len(), first_index as usize);
    if prim_count > 0 {
        gathered.extend_from_slice(&group.faces[below..below + prim_count as usize]);
    } else {
        gather(group, below, most, gathered);
        gather(group, below + 1, most, gathered);
    }
    let count = gathered.len() - first;
    if prim_count > 0 || count <= most {
        (group.nodes[node].first_index, group.nodes[node].prim_count) = (first as u32, count as u32);
    }
}

/// Moves the `middle` boxes with the lowest centres to the front. The centres are compared along the axis on which they
/// spread most.
fn split_at_median(members: &mut [Member], middle: usize) {
    let centres = members.iter().map(|member| Vec3A::from_array(member.centre));
    let (low, high) = centres
        .fold((Vec3A::splat(f32::INFINITY), Vec3A::splat(f32::NEG_INFINITY)), |(low, high), centre| {
            (low.min(centre), high.max(centre))
        });
    let axis = (high - low).max_position();
    // Equal centres are ordered by face, so the halves have the same sizes in any case.
    members.select_nth_unstable_by(middle, |a, b| {
        a.centre[axis].total_cmp(&b.centre[axis]).then(a.face.cmp(&b.face))
    });
}

#[cfg(test)]
#[path = "../tests/unit/grouped_build.rs"]
mod tests;
