//! The paper's two scenes: shapes, places, shadows, and room for the rover.

use raypencil_scene::Mesh;

use super::*;
use crate::ground::tests::{assert_closed_and_outward, normal};
use crate::height_at;

fn bounds(ground: &Ground) -> (DVec3, DVec3) {
    let low = ground.vertices.iter().fold(DVec3::INFINITY, |low, v| low.min(*v));
    let high = ground.vertices.iter().fold(DVec3::NEG_INFINITY, |high, v| high.max(*v));
    (low, high)
}

#[test]
fn every_name_builds_a_mesh_without_zero_area_and_no_other_name_does() {
    for name in BUILTIN_NAMES {
        let ground = builtin(name, 0.3).unwrap();
        assert_eq!(ground.materials[0].reflectivity, 0.3);
        let mesh = ground.into_mesh().unwrap();
        assert_eq!(mesh.zero_area_faces(), 0);
        assert_eq!(mesh.origin(), DVec3::ZERO);
    }
    assert_eq!(builtin("Pyramids", 0.3), None);
}

#[test]
fn pyramids_are_closed_bodies_on_a_plane() {
    let ground = builtin("pyramids", 0.25).unwrap();
    // 8 x 8 cells of two faces, 16 pyramids of four flanks and a base of two.
    assert_eq!(ground.faces.len(), 128 + 96);
    for &face in &ground.faces[..128] {
        let n = normal(&ground, face);
        assert!(n.x == 0.0 && n.y == 0.0 && n.z > 0.0);
    }
    for body in 0..16 {
        assert_closed_and_outward(&ground, 128 + 6 * body..128 + 6 * (body + 1));
    }
    // A square of 40 m turned by 0.113 rad: half of its width is 20 (cos + sin) = 22.13 m.
    let (low, high) = bounds(&ground);
    assert!((high.x - 3.19 - 22.13).abs() < 0.01 && (low.x - 3.19 + 22.13).abs() < 0.01);
    assert_eq!((low.z, high.z), (-0.05, -0.05 + (1.19 + 0.05)));
}

#[test]
fn pyramids_stand_where_they_are_listed_and_leave_the_drive_free() {
    let mesh = builtin("pyramids", 0.25).unwrap().into_mesh().unwrap();
    for Pyramid { x, y, height, .. } in PYRAMIDS {
        // The apex is rounded to f32 (below 1e-6 m), on flanks no steeper than 3 : 1.
        let z = height_at(&mesh, x, y).unwrap();
        assert!((z - height).abs() < 5e-6, "{z} at {x}, {y}");
    }
    for step in 0..=100 {
        let x = -9.0 + 0.1 * f64::from(step);
        for y in [-1.3, -0.65, 0.0, 0.65, 1.3] {
            assert_eq!(height_at(&mesh, x, y), Some(0.0), "at {x}, {y}");
        }
    }
}

/// Whether the straight line from above (0.3, 0) at `height` to the level point (x, y, 0) clears the terrain:
/// tested at 400 steps, which is enough for pyramids.
fn is_clear(mesh: &Mesh, height: f64, x: f64, y: f64) -> bool {
    let from = DVec3::new(0.3, 0.0, height);
    (1..400).map(|step| from.lerp(DVec3::new(x, y, 0.0), f64::from(step) / 400.0)).all(|point| {
        let ground = height_at(mesh, point.x, point.y).unwrap();
        ground < point.z
    })
}

#[test]
fn pyramids_cut_shadow_and_hide_the_stripes() {
    let mesh = builtin("pyramids", 0.25).unwrap().into_mesh().unwrap();
    // Points of the two stripes on level ground, every 5 cm. A point is lit if the line from the beam is clear
    // and no pyramid stands there. It is hidden if it is lit but the line from the camera, 1.5 m up, is not
    // clear.
    let count = |height: f64, x: f64, half_width: f64| {
        let (mut lit, mut hidden, mut all) = (0, 0, 0);
        for step in 0..=(half_width / 0.025) as i32 {
            let y = 0.05 * f64::from(step) - half_width;
            all += 1;
            if height_at(&mesh, x, y) == Some(0.0) && is_clear(&mesh, height, x, y) {
                lit += 1;
                hidden += i32::from(!is_clear(&mesh, 1.5, x, y));
            }
        }
        (all, lit, hidden)
    };
    let (all, lit, _) = count(1.8, 3.296, 1.73);
    assert!(lit > all / 3 && lit < all * 3 / 4, "first stripe: {lit} of {all} lit");
    let (all, lit, hidden) = count(2.0, 5.250, 2.86);
    assert!(lit > all / 3 && lit < all * 3 / 4, "second stripe: {lit} of {all} lit");
    assert!(hidden > all / 20, "second stripe: {hidden} of {all} lit but hidden");
}

#[test]
fn facets_are_256_faces_that_look_up() {
    let ground = builtin("facets", 0.25).unwrap();
    assert_eq!((ground.faces.len(), ground.vertices.len()), (256, 17 * 9));
    assert!(ground.faces.iter().all(|&face| normal(&ground, face).z > 0.0));
    let (low, high) = bounds(&ground);
    assert!(low.x > -10.4 && high.x < 14.2 && low.y > -6.4 && high.y < 6.2);
    assert!(low.z > -0.6 && low.z < -0.5 && high.z < 0.6 && high.z > 0.5);
    // At least half of them are steeper than 20 degrees, tan 20 = 0.364.
    let steep = |n: DVec3| n.truncate().length() > 0.364 * n.z;
    assert!(ground.faces.iter().filter(|&&face| steep(normal(&ground, face))).count() >= 128);
}

#[test]
fn a_rover_can_stand_on_the_facets() {
    let mesh = builtin("facets", 0.25).unwrap().into_mesh().unwrap();
    // Within half a metre of (0, 0) the ground stays within 10 cm: corners within 0.9 m have 5 % of 0.6 m, and
    // the ground rises over at most one cell of 1.5 m beyond.
    let z = height_at(&mesh, 0.0, 0.0).unwrap();
    assert!(z.abs() < 0.1, "{z}");
    for (x, y) in [(0.5, 0.0), (-0.5, 0.0), (0.0, 0.5), (0.0, -0.5)] {
        let near = height_at(&mesh, x, y).unwrap();
        assert!((near - z).abs() < 0.1, "{near} against {z}");
    }
}

#[test]
fn nothing_lies_on_the_axes_of_the_sensors() {
    // The rig looks along +x from (0.3, 0). No vertex lies within 1 mm of that vertical plane, or of the plane
    // across it through the sensors.
    for name in BUILTIN_NAMES {
        for v in builtin(name, 0.25).unwrap().vertices {
            assert!(v.y.abs() > 1e-3 && (v.x - 0.3).abs() > 1e-3, "{name}: {v}");
        }
    }
}
