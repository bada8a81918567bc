//! Fewer faces: first those near the ray, then delta debugging. (A. Zeller and R. Hildebrandt, "Simplifying and
//! isolating failure-inducing input", IEEE Transactions on Software Engineering 28, 2002: ddmin)

use crate::nearest_faces::faces_by_distance;
use crate::reducer::Reducer;
use crate::reduction::Reduction;

/// Factor between the numbers of faces of two tries. The tenth try has 4^9 faces, a quarter of a million.
const GROWTH: usize = 4;

/// Keeps the faces nearest the ray in question: 1, then [`GROWTH`] times as many, until the scene is interesting.
pub(super) fn keep_near_ray(reducer: &mut Reducer<'_>) {
    let Some(nearest) = faces_by_distance(reducer.best()) else { return };
    reducer.stage("faces near the ray");
    let mut count = 1;
    while count < nearest.len() && !reducer.is_spent() {
        // In the order of the mesh, since of tied faces the lowest index wins.
        let mut kept = nearest[..count].to_vec();
        kept.sort_unstable();
        if reducer.try_variant(reducer.best().with_faces(&kept)) {
            return;
        }
        count *= GROWTH;
    }
}

/// Keeps the `count` faces nearest the ray in question, if the scene is interesting then.
pub(super) fn keep_nearest(reducer: &mut Reducer<'_>, count: usize) {
    let Some(mut kept) = faces_by_distance(reducer.best()).filter(|all| all.len() > count) else { return };
    kept.truncate(count);
    kept.sort_unstable();
    reducer.try_variant(reducer.best().with_faces(&kept));
}

/// ddmin over the faces: tries parts, then complements of parts. If none is interesting, it doubles the number of
/// parts.
pub(super) fn ddmin(reducer: &mut Reducer<'_>) {
    reducer.stage("fewer faces");
    let whole = reducer.best().clone();
    let mut kept: Vec<u32> = (0..whole.mesh.faces().len() as u32).collect();
    let mut parts = 2;
    while kept.len() >= 2 && !reducer.is_spent() {
        parts = parts.min(kept.len());
        if let Some(part) = smaller_part(reducer, &whole, &kept, parts) {
            (kept, parts) = part;
        } else if parts < kept.len() {
            parts *= 2;
        } else {
            return;
        }
    }
}

/// The first interesting part of `kept`, or else the first interesting complement of a part, and the number of parts to
/// go on with.
fn smaller_part(
    reducer: &mut Reducer<'_>,
    whole: &Reduction,
    kept: &[u32],
    parts: usize,
) -> Option<(Vec<u32>, usize)> {
    let bounds = |part: usize| part * kept.len() / parts..(part + 1) * kept.len() / parts;
    for part in 0..parts {
        let part = kept[bounds(part)].to_vec();
        if reducer.try_variant(whole.with_faces(&part)) {
            return Some((part, 2));
        }
    }
    // With two parts, each is the other's complement.
    for part in (0..parts).filter(|_| parts > 2) {
        let range = bounds(part);
        let complement = [&kept[..range.start], &kept[range.end..]].concat();
        if reducer.try_variant(whole.with_faces(&complement)) {
            return Some((complement, (parts - 1).max(2)));
        }
    }
    None
}

/// Removes single faces until no face can be removed. The result is 1-minimal.
pub(super) fn remove_single_faces(reducer: &mut Reducer<'_>) {
    let mut face = 0;
    let mut kept_since_removal = 0;
    while kept_since_removal < reducer.best().mesh.faces().len() && !reducer.is_spent() {
        let count = reducer.best().mesh.faces().len();
        if count < 2 {
            return;
        }
        let others: Vec<u32> = (0..count as u32).filter(|&other| other as usize != face % count).collect();
        if reducer.try_variant(reducer.best().with_faces(&others)) {
            kept_since_removal = 0;
        } else {
            kept_since_removal += 1;
            face += 1;
        }
    }
}
