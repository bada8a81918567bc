//! Heights on planes, pyramids and overhangs, far away, and along shared edges.

use proptest::prelude::*;

use super::*;
use crate::{Ground, RandomGround};
use raypencil_scene::Material;

fn bare() -> Ground {
    Ground { materials: vec![Material { name: "ground".into(), reflectivity: 0.25 }], ..Ground::default() }
}

/// A square of 20 m on the plane z = x / 2.
fn ramp() -> Ground {
    let mut ground = bare();
    let place = |column, row| {
        let (x, y) = (20.0 * f64::from(column) - 10.0, 20.0 * f64::from(row) - 10.0);
        DVec3::new(x, y, 0.5 * x)
    };
    ground.add_height_field(1, 1, place, || false, || 0);
    ground
}

#[test]
fn a_plane_inside_on_its_border_and_outside() {
    let mesh = ramp().into_mesh().unwrap();
    // z = x / 2; (2, 2) lies on the shared diagonal.
    assert_eq!(height_at(&mesh, 3.0, 1.0), Some(1.5));
    assert_eq!(height_at(&mesh, 2.0, 2.0), Some(1.0));
    // A vertex, and a point on the border.
    assert_eq!(height_at(&mesh, 10.0, 10.0), Some(5.0));
    assert_eq!(height_at(&mesh, -10.0, 0.0), Some(-5.0));
    assert_eq!(height_at(&mesh, 10.000_001, 0.0), None);
    assert_eq!(height_at(&mesh, f64::NAN, 0.0), None);
}

#[test]
fn the_flank_of_a_pyramid() {
    // Half side 2 m, height 1 m, not rotated. The flank towards +x falls from 1 m at x = 0 to 0 m at x = 2, so at
    // (0.5, 0.25) it stands at 1 - 0.5 / 2 = 0.75 m. The base, at 0 m, looks down.
    let mut ground = bare();
    ground.add_pyramid(DVec3::ZERO, 2.0, 1.0, 0.0, 0);
    let mesh = ground.into_mesh().unwrap();
    assert_eq!(height_at(&mesh, 0.5, 0.25), Some(0.75));
    assert_eq!(height_at(&mesh, 0.0, 0.0), Some(1.0));
    // The ridge between two flanks: (1, 1) is half way down, at 0.5 m.
    assert_eq!(height_at(&mesh, 1.0, 1.0), Some(0.5));
    assert_eq!(height_at(&mesh, 2.5, 0.0), None);
}

#[test]
fn an_overhang_gives_its_upper_surface() {
    // A slab from 1.0 to 1.2 m, above the ramp's z = 0.5 at x = 1.
    let mut ground = ramp();
    ground.add_box(DVec3::new(1.0, 1.0, 1.1), [DVec3::X * 0.5, DVec3::Y * 0.5, DVec3::Z * 0.1], 0);
    let mesh = ground.into_mesh().unwrap();
    // 1.2 is not an f32: the stored number is the nearest one.
    assert_eq!(height_at(&mesh, 1.0, 1.0), Some(f64::from(1.2_f32)));
    assert_eq!(height_at(&mesh, 1.75, 1.0), Some(0.875));
}

#[test]
fn far_ground_keeps_its_precision() {
    // The scene origin moves along with a shift of a million metres. Offsets of 10 m in f32 are good to 2^-21 m
    // each, and the slope is 1/2, so the error stays below 1e-6 m.
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

    /// Points on shared edges and vertices, within f64 rounding, never fall between the faces.
    #[test]
    fn no_crack_between_faces(seed: u64, along in 0.0..=1.0) {
        let mesh = RandomGround::plain(seed, 60, 10.0).build().into_mesh().unwrap();
        let corner = |v: u32| DVec3::from_array(mesh.vertices()[v as usize].map(f64::from));
        for &[a, b, _] in mesh.faces() {
            let [p, q] = [corner(a), corner(b)];
            let middle: DVec3 = p + (q - p) * along;
            // The border is straight but rounded: only the inside must have no gap.
            if middle.truncate().abs().max_element() > 4.999 {
                continue;
            }
            let z = height_at(&mesh, middle.x, middle.y);
            prop_assert!(z.is_some_and(|z| (z - middle.z).abs() < 1e-9), "{z:?} at {middle}");
        }
    }
}
