//! Triangulation against the projection of a pinhole camera.

use glam::DVec3;
use raypencil_rover::{OnVehicle, Pan, Rig, SheetPlane, Triangulation};

use super::common;

fn default_rig() -> Rig {
    common::rig(1024, 16)
}

/// Image point (u, v) of a point of the vehicle frame, by the projection of a pinhole camera.
fn project(rig: &Rig, point: DVec3) -> (f64, f64) {
    let p = rig.camera.vehicle_from_sensor.inverse() * point;
    let camera = &rig.camera.sensor;
    let along = |axis: usize, x: f64| {
        camera.principal_point[axis] + camera.focal_length * x / p.z / camera.pixel_pitch[axis]
    };
    (along(0, p.x), along(1, p.y))
}

/// Points of a beam's lower edge plane that the camera sees, in the vehicle frame. They form a grid in the beam frame.
fn edge_points(rig: &Rig, beam: usize) -> Vec<DVec3> {
    let OnVehicle { vehicle_from_sensor, sensor } = rig.beams[beam];
    let mut points = Vec::new();
    for row in 0..60 {
        let z = 1.0 + 0.173 * f64::from(row);
        for column in -20..=20 {
            let x = z * 0.0281 * f64::from(column);
            let point = vehicle_from_sensor * DVec3::new(x, 0.5 * sensor.thickness, z);
            let (u, v) = project(rig, point);
            if (0.0..1024.0).contains(&u) && (0.0..1024.0).contains(&v) {
                points.push(point);
            }
        }
    }
    points
}

#[test]
fn triangulation_closes() {
    for pan in [Pan::default(), Pan { camera: 0.3, beams: 0.5 }, Pan { camera: 0.0, beams: -0.1 }] {
        let rig = default_rig().panned(pan);
        for beam in 0..2 {
            let triangulation = Triangulation::new(&rig, beam, SheetPlane::LowerEdge);
            let points = edge_points(&rig, beam);
            assert!(points.len() > 500, "{} points", points.len());
            for point in points {
                let (u, v) = project(&rig, point);
                // Its exact image point gives the same point again.
                let again = triangulation.at(u, v).expect("a lit point");
                assert!((again - point).length() < 1e-9, "{again} for {point}");
                // The middle of its pixel gives a point within the footprint.
                let (i, j) = (u as u32, v as u32);
                if let Some(footprint) = triangulation.footprint(i, j) {
                    let nearest = triangulation.at_pixel(i, j).expect("a lit pixel");
                    assert!((nearest - point).length() <= footprint + 1e-9);
                }
            }
        }
    }
}

#[test]
fn pixel_centres_close_to_a_nanometre() {
    // The point of a pixel's middle lies on y = T/2 of the beam, and its image is the middle of the pixel. 1e-9 m at up
    // to 20 m is 1e-9 / 20 * 8e-3 / 9e-6 = 4e-8 pixels.
    let rig = default_rig();
    for beam in 0..2 {
        let table = Triangulation::new(&rig, beam, SheetPlane::LowerEdge).table();
        let beam_from_vehicle = rig.beams[beam].vehicle_from_sensor.inverse();
        let mut seen = 0;
        for j in (0..1024).step_by(7) {
            for i in (0..1024).step_by(7) {
                let Some(point) = table.at_pixel(i, j) else { continue };
                seen += 1;
                assert!(((beam_from_vehicle * point).y - 2.5e-3).abs() < 1e-9);
                let (u, v) = project(&rig, point);
                assert!((u - f64::from(i) - 0.5).abs() < 4e-8 && (v - f64::from(j) - 0.5).abs() < 4e-8);
            }
        }
        assert!(seen > 3000, "{seen} pixels see the plane");
    }
}

#[test]
fn a_stripe_on_level_ground_is_where_the_plane_meets_it() {
    // Beam 0 is 1.8 m up and points 31 degrees down. Its lower edge plane is parallel to its middle plane, 2.5 mm
    // below: it meets the ground (1.8 - 0.0025 / cos 31) / tan 31 ahead of the beam.
    let rig = default_rig();
    let down = 31.0_f64.to_radians();
    let ahead = (1.8 - 0.0025 / libm::cos(down)) / libm::tan(down);
    let (u, v) = project(&rig, DVec3::new(0.3 + ahead, 0.0, 0.0));
    let point = Triangulation::new(&rig, 0, SheetPlane::LowerEdge).at(u, v).unwrap();
    assert!((point - DVec3::new(0.3 + ahead, 0.0, 0.0)).length() < 1e-9);
    // The camera's ray comes from below the sheet and meets the middle plane beyond the edge plane, below the ground.
    let middle = Triangulation::new(&rig, 0, SheetPlane::Middle).at(u, v).unwrap();
    assert!(middle.z < 0.0 && middle.x > point.x);
}

#[test]
fn the_range_of_a_beam_is_measured_along_its_rays() {
    // Two points of the plane at z = 4.5 m in the beam frame: straight ahead at a range of 4.5 m, and 2.4 m to the right
    // (28 degrees, inside the fan) at sqrt(4.5^2 + 2.4^2) = 5.1 m. A beam that ends at 5 m lights the first alone.
    let mut rig = default_rig();
    rig.beams[0].sensor.max_range = 5.0;
    let triangulation = Triangulation::new(&rig, 0, SheetPlane::LowerEdge);
    let OnVehicle { vehicle_from_sensor, sensor } = rig.beams[0];
    let seen = |x: f64| {
        let (u, v) = project(&rig, vehicle_from_sensor * DVec3::new(x, 0.5 * sensor.thickness, 4.5));
        triangulation.at(u, v).is_some()
    };
    assert!(seen(0.0) && !seen(2.4));
}

#[test]
fn pixels_that_see_no_lit_point_give_none() {
    let rig = default_rig();
    let triangulation = Triangulation::new(&rig, 0, SheetPlane::LowerEdge);
    // The plane descends by 31 degrees, 11 more than the camera's axis, and is above the camera. Its vanishing line is
    // at row 512 + 8 mm tan 11 / 9 um = 684.8: rays below that row do not meet it.
    assert!(triangulation.at(512.0, 684.0).is_none() && triangulation.at(512.0, 700.0).is_none());
    assert!(triangulation.at(512.0, 650.0).is_some());
    // A point near the image's right border is beyond the narrow fan.
    let mut narrow = rig.clone();
    narrow.beams[0].sensor.half_width = 0.01;
    let triangulation = Triangulation::new(&narrow, 0, SheetPlane::LowerEdge);
    let (u, v) = project(&rig, DVec3::new(3.29, 0.0, 0.0));
    assert!(triangulation.at(u, v).is_some() && triangulation.at(u + 400.0, v).is_none());
}
