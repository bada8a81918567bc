//! How high the terrain stands above a point of the plane: what wheels and a rover's start need.

use glam::{DVec2, DVec3};
use raypencil_scene::Mesh;

/// Highest point of the terrain above the global point (x, y), global z in metres, from faces whose normal
/// points up; `None` where there is no such face. Triangles are closed: edges and vertices belong to them.
///
/// Under an overhang this is the overhang's upper surface. Vertical faces and undersides do not count, nor
/// do faces without area. A point over an edge that two faces share is never missed: see the source.
///
/// Goes through all faces: for a few points; [`crate::HeightIndex`] is for many.
pub fn height_at(mesh: &Mesh, x: f64, y: f64) -> Option<f64> {
    let origin = mesh.origin();
    let point = DVec2::new(x - origin.x, y - origin.y);
    let vertices = mesh.vertices();
    let mut highest: Option<f64> = None;
    for face in mesh.faces() {
        let corners = face.map(|v| {
            let [x, y, z] = vertices[v as usize];
            DVec3::new(f64::from(x), f64::from(y), f64::from(z))
        });
        if let Some(z) = height_of(corners, point) {
            highest = Some(highest.map_or(z, |top| top.max(z)));
        }
    }
    highest.map(|z| origin.z + z)
}

/// Height of one closed triangle above a point, all in the scene frame.
pub(crate) fn height_of([a, b, c]: [DVec3; 3], point: DVec2) -> Option<f64> {
    // Reject faces that do not look up.
    if !((b - a).perp_dot_xy(c - a) > 0.0) {
        return None;
    }
    // The corners seen from the point: one rounding each, the same in every face that shares the corner.
    let [p, q, r] = [a, b, c].map(|corner| corner.truncate() - point);
    // Twice the areas of the triangles that the point cuts the face into, each opposite its corner. Products
    // are rounded monotonically, so the difference of two has the sign that the exact one has, or is zero;
    // and it is antisymmetric, so the neighbour across an edge finds the opposite sign. Zero counts as
    // inside: hence no crack between faces.
    let [of_a, of_b, of_c] = [q.perp_dot(r), r.perp_dot(p), p.perp_dot(q)];
    if !(of_a >= 0.0 && of_b >= 0.0 && of_c >= 0.0) {
        return None;
    }
    // All three are zero only if the face is thinner than an f64 can tell from here: no height to give.
    let whole = of_a + of_b + of_c;
    if whole == 0.0 {
        return None;
    }
    Some(a.z + ((b.z - a.z) * of_b + (c.z - a.z) * of_c) / whole)
}

/// The z component of a cross product.
trait PerpDotXy {
    fn perp_dot_xy(self, other: Self) -> f64;
}

impl PerpDotXy for DVec3 {
    fn perp_dot_xy(self, other: Self) -> f64 {
        self.x * other.y - self.y * other.x
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::{Ground, RandomGround};
    use raypencil_scene::Material;

    fn bare() -> Ground {
        Ground {
            materials: vec![Material { name: "ground".into(), reflectivity: 0.25 }],
            ..Ground::default()
        }
    }

    /// A square of 20 m, tilted so that z = 0.5 x.
    fn ramp() -> Ground {
        let mut ground = bare();
        let place = |column, row| {
            let (x, y) = (20.0 * f64::from(column) - 10.0, 20.0 * f64::from(row) - 10.0);
            DVec3::new(x, y, 0.5 * x)
        };
        ground.height_field(1, 1, place, || false, || 0);
        ground
    }

    #[test]
    fn a_plane_inside_on_its_border_and_outside() {
        let mesh = ramp().into_mesh().unwrap();
        // z = x / 2; (2, 2) lies on the shared diagonal.
        assert_eq!(height_at(&mesh, 3.0, 1.0), Some(1.5));
        assert_eq!(height_at(&mesh, 2.0, 2.0), Some(1.0));
        // A vertex, and a point of the border.
        assert_eq!(height_at(&mesh, 10.0, 10.0), Some(5.0));
        assert_eq!(height_at(&mesh, -10.0, 0.0), Some(-5.0));
        assert_eq!(height_at(&mesh, 10.000_001, 0.0), None);
        assert_eq!(height_at(&mesh, f64::NAN, 0.0), None);
    }

    #[test]
    fn the_flank_of_a_pyramid() {
        // Half side 2 m, height 1 m, not turned: the flank towards +x falls from 1 m at x = 0 to 0 m at
        // x = 2, so at (0.5, 0.25) it stands at 1 * (1 - 0.5 / 2) = 0.75 m. The base, 0 m, looks down.
        let mut ground = bare();
        ground.pyramid(DVec3::ZERO, 2.0, 1.0, 0.0, 0);
        let mesh = ground.into_mesh().unwrap();
        assert_eq!(height_at(&mesh, 0.5, 0.25), Some(0.75));
        assert_eq!(height_at(&mesh, 0.0, 0.0), Some(1.0));
        // The ridge between two flanks: (1, 1) is half way down, 0.5 m.
        assert_eq!(height_at(&mesh, 1.0, 1.0), Some(0.5));
        assert_eq!(height_at(&mesh, 2.5, 0.0), None);
    }

    #[test]
    fn an_overhang_gives_its_upper_surface() {
        // A slab from 1.0 to 1.2 m above the ramp's 0.5 x at x = 1.
        let mut ground = ramp();
        ground.solid_box(DVec3::new(1.0, 1.0, 1.1), [DVec3::X * 0.5, DVec3::Y * 0.5, DVec3::Z * 0.1], 0);
        let mesh = ground.into_mesh().unwrap();
        // 1.2 is not an f32: the stored number is the nearest one.
        assert_eq!(height_at(&mesh, 1.0, 1.0), Some(f64::from(1.2_f32)));
        assert_eq!(height_at(&mesh, 1.75, 1.0), Some(0.875));
    }

    #[test]
    fn far_ground_keeps_its_precision() {
        // Shifted by a million metres, the scene origin moves along: offsets of 10 m in f32 are good to
        // 2^-21 m each, and the slope is 1/2, so 1e-6 m is never exceeded.
        let offset = DVec3::new(1e6, -1e6, 250_000.125);
        let mut ground = ramp();
        for vertex in &mut ground.vertices {
            *vertex += offset;
        }
        let mesh = ground.into_mesh().unwrap();
        for (x, y) in [(0.3, 0.7), (-9.9, 9.9), (3.3, -2.2)] {
            let z = height_at(&mesh, offset.x + x, offset.y + y).unwrap();
            assert!((z - (offset.z + 0.5 * x)).abs() < 1e-6, "{z}");
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..Default::default() })]

        /// Points on shared edges and vertices, as near as an f64 can be, never fall through.
        #[test]
        fn no_crack_between_faces(seed: u64, along in 0.0..=1.0) {
            let mesh = RandomGround::plain(seed, 60, 10.0).build().into_mesh().unwrap();
            let corner = |v: u32| DVec3::from_array(mesh.vertices()[v as usize].map(f64::from));
            for &[a, b, _] in mesh.faces() {
                let [p, q] = [corner(a), corner(b)];
                let middle: DVec3 = p + (q - p) * along;
                // The border is straight but rounded: only the inside is held to have no gap.
                if middle.truncate().abs().max_element() > 4.999 {
                    continue;
                }
                let z = height_at(&mesh, middle.x, middle.y);
                prop_assert!(z.is_some_and(|z| (z - middle.z).abs() < 1e-9), "{z:?} at {middle}");
            }
        }
    }
}
