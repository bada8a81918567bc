//! One ray, for triangles and for boxes.

use glam::{DVec3, Vec3A};

use crate::wide_tree::Bundle;

/// One ray, prepared for many triangle tests.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TracedRay {
    /// Start of the ray, scene frame, metres.
    pub(crate) origin: DVec3,
    /// Vector from the origin to the SPP, scene frame, metres.
    pub(crate) direction: DVec3,
    /// |direction|: metres per unit of t.
    pub(crate) metres_per_t: f64,
    /// The two shorter axes of the direction, then the longest. The first two are ordered so that a face whose
    /// front the ray meets runs counter-clockwise in them: see `triangle`.
    pub(crate) axes: [usize; 3],
}

impl TracedRay {
    pub(crate) fn new(origin: DVec3, direction: DVec3) -> Self {
        let axes = Self::axes_of(direction);
        Self { origin, direction, metres_per_t: direction.length(), axes }
    }

    /// The axes of a ray along `direction`, as in [`TracedRay::axes`].
    #[inline(always)]
    pub(crate) fn axes_of(direction: DVec3) -> [usize; 3] {
        let size = direction.abs();
        let longest = if size.x >= size.y && size.x >= size.z {
            0
        } else if size.y >= size.z {
            1
        } else {
            2
        };
        let (next, last) = ((longest + 1) % 3, (longest + 2) % 3);
        // Seen along +z, with x to the right, y runs down; seen along -z it runs up.
        if direction[longest] < 0.0 { [next, last, longest] } else { [last, next, longest] }
    }

    /// The ray for the boxes: f32, with a unit direction, so that its t is the range in metres. It ends at `max_range`.
    pub(crate) fn bundle(&self, max_range: f32) -> Bundle {
        let unit = self.direction / self.metres_per_t;
        let narrow = |v: DVec3| Vec3A::new(v.x as f32, v.y as f32, v.z as f32);
        Bundle::new(narrow(self.origin), narrow(unit), narrow(unit), max_range)
    }
}
