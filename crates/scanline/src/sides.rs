//! The sides of a face, their ends in the one order that both faces sharing a side find. (§4, 4a)

use crate::clip::Edge;
use crate::raster::Transformation;
use crate::vertices::{Vertex, widen};

/// The side of a face from corner k to the next; `stored` are the face's corners in the scene, `seen` in the
/// sensor's frame.
#[inline]
pub(crate) fn edge<T: Transformation>(
    transformation: &T,
    stored: &[[f32; 3]; 3],
    seen: &[&Vertex; 3],
    k: usize,
    next: usize,
) -> Edge<T::Line> {
    let reversed = precedes(&stored[next], &stored[k]);
    let (first, second) = if reversed { (next, k) } else { (k, next) };
    // Formed in the scene frame, where it is exact, and only then turned.
    let along = widen(stored[second]) - widen(stored[first]);
    let along = transformation.sensor_from_scene().turn(along);
    let (first, second) = (seen[first].position, seen[second].position);
    Edge { first, second, reversed, line: transformation.line(first, second, along) }
}

/// All three: the k-th joins corner k to k + 1.
pub(crate) fn edges<T: Transformation>(
    transformation: &T,
    stored: &[[f32; 3]; 3],
    seen: &[&Vertex; 3],
) -> [Edge<T::Line>; 3] {
    [(0, 1), (1, 2), (2, 0)].map(|(k, next)| edge(transformation, stored, seen, k, next))
}

/// The scene's order of vertex *positions*: lexicographic, -0 equal to +0. By position, not by index, so
/// that meshes without shared indices are watertight too.
#[inline]
fn precedes(a: &[f32; 3], b: &[f32; 3]) -> bool {
    for k in 0..3 {
        if a[k] != b[k] {
            return a[k] < b[k];
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_order_of_ends_is_by_position() {
        assert!(precedes(&[0.0, 1.0, 5.0], &[0.0, 2.0, 0.0]));
        assert!(!precedes(&[0.0, 2.0, 0.0], &[0.0, 1.0, 5.0]));
        // -0 and +0 are one position.
        assert!(!precedes(&[-0.0, 1.0, 2.0], &[0.0, 1.0, 2.0]));
        assert!(!precedes(&[0.0, 1.0, 2.0], &[-0.0, 1.0, 2.0]));
    }
}
