//! The nearest hit with its ties, and whether anything is hit.

use std::cmp::Ordering;

use raypencil_scene::{CastRay, FaceId, Sides};

use super::query_ray::QueryRay;
use super::triangle::Triangle;
use super::{ExactCast, bundle};
use crate::bvh::Traversal;

impl ExactCast<'_> {
    /// The faces met at the smallest t, in ascending order: several if they are met at exactly the same t, none if the
    /// ray meets nothing.
    pub fn first(&self, ray: &CastRay, sides: Sides) -> Vec<FaceId> {
        self.nearest(ray, sides).iter().map(|face| face.id).collect()
    }

    /// Whether the ray meets anything.
    pub fn any(&self, ray: &CastRay, sides: Sides) -> bool {
        let (query, bundle) = (QueryRay::new(ray), bundle(ray));
        let mut walk = Traversal::new(&self.bvh, &bundle);
        while let Some(leaf) = walk.next_leaf(bundle.max_range) {
            if leaf.iter().any(|face| face.met_side(&query, sides).is_some()) {
                return true;
            }
        }
        false
    }

    /// The nearest faces, in ascending order.
    pub(super) fn nearest(&self, ray: &CastRay, sides: Sides) -> Vec<&Triangle> {
        let (query, bundle) = (QueryRay::new(ray), bundle(ray));
        let mut nearest: Vec<&Triangle> = Vec::new();
        self.bvh.visit(&bundle, |face| {
            if face.met_side(&query, sides).is_some() {
                match nearest.first().map(|kept| face.compare(kept, &query)) {
                    None | Some(Ordering::Less) => nearest = vec![face],
                    Some(Ordering::Equal) => nearest.push(face),
                    Some(Ordering::Greater) => {}
                }
            }
            // From here on only faces up to the nearest matter.
            nearest.first().map_or(bundle.max_range, |kept| kept.farthest_range(&query, bundle.max_range))
        });
        nearest.sort_by_key(|face| face.id);
        nearest
    }
}
