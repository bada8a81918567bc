//! Fewer faces: those near the ray, then delta debugging. (A. Zeller and R. Hildebrandt, "Simplifying and isolating
//! failure-inducing input", IEEE Transactions on Software Engineering 28, 2002: ddmin)

use crate::draft::Draft;
use crate::near::by_nearness;
use crate::trials::Trials;

/// From one try to the next, so many times as many faces: ten tries reach a quarter of a million.
const GROWTH: usize = 4;

/// Cuts coarsely: the fewest of the faces nearest the ray in question that show it, in powers of [`GROWTH`].
pub(super) fn coarse(trials: &mut Trials<'_>) {
    let Some(nearest) = by_nearness(trials.best()) else { return };
    trials.stage("faces near the ray");
    let mut count = 1;
    while count < nearest.len() && !trials.is_spent() {
        // In the order of the mesh: of ties the lowest index wins.
        let mut kept = nearest[..count].to_vec();
        kept.sort_unstable();
        if trials.keep(trials.best().with_faces(&kept)) {
            return;
        }
        count *= GROWTH;
    }
}

/// Keeps the faces nearest the ray in question, so many at most, if they show it.
pub(super) fn nearest(trials: &mut Trials<'_>, count: usize) {
    let Some(mut kept) = by_nearness(trials.best()).filter(|all| all.len() > count) else { return };
    kept.truncate(count);
    kept.sort_unstable();
    trials.keep(trials.best().with_faces(&kept));
}

/// ddmin over the faces: parts, then complements of parts, twice as fine whenever neither shows it.
pub(super) fn fewest(trials: &mut Trials<'_>) {
    trials.stage("fewer faces");
    let whole = trials.best().clone();
    let mut kept: Vec<u32> = (0..whole.mesh.faces().len() as u32).collect();
    let mut parts = 2;
    while kept.len() >= 2 && !trials.is_spent() {
        parts = parts.min(kept.len());
        if let Some(part) = smaller(trials, &whole, &kept, parts) {
            (kept, parts) = part;
        } else if parts < kept.len() {
            parts *= 2;
        } else {
            return;
        }
    }
}

/// The first part of `kept`, or else complement of a part, that shows it, and in how many parts to go on.
fn smaller(trials: &mut Trials<'_>, whole: &Draft, kept: &[u32], parts: usize) -> Option<(Vec<u32>, usize)> {
    let bounds = |part: usize| part * kept.len() / parts..(part + 1) * kept.len() / parts;
    for part in 0..parts {
        let part = kept[bounds(part)].to_vec();
        if trials.keep(whole.with_faces(&part)) {
            return Some((part, 2));
        }
    }
    // Of two parts each is the other's complement.
    for part in (0..parts).filter(|_| parts > 2) {
        let range = bounds(part);
        let complement = [&kept[..range.start], &kept[range.end..]].concat();
        if trials.keep(whole.with_faces(&complement)) {
            return Some((complement, (parts - 1).max(2)));
        }
    }
    None
}

/// Leaves out face after face until none can be: what remains is 1-minimal.
pub(super) fn single_removals(trials: &mut Trials<'_>) {
    let mut face = 0;
    let mut kept_since_removal = 0;
    while kept_since_removal < trials.best().mesh.faces().len() && !trials.is_spent() {
        let count = trials.best().mesh.faces().len();
        if count < 2 {
            return;
        }
        let others: Vec<u32> = (0..count as u32).filter(|&other| other as usize != face % count).collect();
        if trials.keep(trials.best().with_faces(&others)) {
            kept_since_removal = 0;
        } else {
            kept_since_removal += 1;
            face += 1;
        }
    }
}
