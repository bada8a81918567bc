//! The edges of a face, their ends in the one order that both faces of an edge find. (§4, 4a)

use crate::clip::Edge;
use crate::spp::widen;
use crate::transformation::Transformation;
use crate::vertices::SensorVertex;

/// The edge of a face from vertex k to `next`.
#[inline]
pub(crate) fn edge<T: Transformation>(
    transformation: &T,
    vertices: &[&SensorVertex; 3],
    k: usize,
    next: usize,
) -> Edge<T::Line> {
    let (from, to) = (vertices[k], vertices[next]);
    let reversed = precedes(&to.in_scene, &from.in_scene);
    let (first, second) = if reversed { (to, from) } else { (from, to) };
    // Formed in the scene frame, where it is exact, and then rotated.
    let along = widen(second.in_scene) - widen(first.in_scene);
    let along = transformation.sensor_from_scene().in_sensor_axes(along);
    let (first, second) = (first.position, second.position);
    Edge { first, second, reversed, line: transformation.project_edge(first, second, along) }
}

/// All three edges of a face: the k-th joins vertex k to k + 1.
pub(crate) fn edges<T: Transformation>(
    transformation: &T,
    vertices: &[&SensorVertex; 3],
) -> [Edge<T::Line>; 3] {
    [(0, 1), (1, 2), (2, 0)].map(|(k, next)| edge(transformation, vertices, k, next))
}

/// The scene's order of vertex *positions*: lexicographic, with -0 equal to +0. By position, not by index, so that
/// meshes without shared indices are watertight too.
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
    fn ends_are_ordered_by_position() {
        assert!(precedes(&[0.0, 1.0, 5.0], &[0.0, 2.0, 0.0]));
        assert!(!precedes(&[0.0, 2.0, 0.0], &[0.0, 1.0, 5.0]));
        // -0 and +0 are one position.
        assert!(!precedes(&[-0.0, 1.0, 2.0], &[0.0, 1.0, 2.0]));
        assert!(!precedes(&[0.0, 1.0, 2.0], &[-0.0, 1.0, 2.0]));
    }
}
