//! Faces that lie in the place of another.
//!
//! Two faces whose corners have the same coordinates in the same turn are met by the same rays, at the same t, from the same side. So of any
//! displaced ray the set of nearest faces has both or neither, and the nearest t is the same without one of them. A margin says when that set
//! or that t changes, so it is the margin of the mesh with one face in each place. Thousands of copies would else be looked at
//! for each of their own borders.

use std::collections::HashSet;

/// Which faces are copies of an earlier one; empty if no face is. `vertices` has for each vertex the first with the same coordinates.
pub(super) fn copies(faces: &[[u32; 3]], vertices: &[u32]) -> Vec<bool> {
    let mut places = HashSet::with_capacity(faces.len());
    let mut is_first = |face: &[u32; 3]| {
        let mut corners = face.map(|vertex| vertices[vertex as usize]);
        // A turn of the corners changes nothing, another order shows the other side.
        let least = (0..3).min_by_key(|&k| corners[k]).unwrap_or(0);
        corners.rotate_left(least);
        places.insert(corners)
    };
    let copies: Vec<bool> = faces.iter().map(|face| !is_first(face)).collect();
    if copies.contains(&true) { copies } else { Vec::new() }
}
