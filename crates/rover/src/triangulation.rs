//! From a camera pixel to the point on a beam's edge plane that it sees. (Paper, §6 and §7)

use glam::DVec3;
use raypencil_scene::{Beam, Camera, Image, Maybe, Pose};

use crate::rig::{OnVehicle, Rig};
use crate::stripe::{EdgePoint, Place};

/// Which plane of a sheet of light an image point is thought to lie on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SheetPlane {
    /// y = +T/2 in the beam frame: "the lower edge plane of the light beam" (§7).
    #[default]
    LowerEdge,
    /// y = 0, for centroids.
    Middle,
}

impl SheetPlane {
    /// The plane that the extracted places lie on.
    pub fn of(place: Place) -> Self {
        match place {
            Place::Pixel | Place::SubPixel => Self::LowerEdge,
            Place::Centroid => Self::Middle,
        }
    }
}

/// A camera and one plane of light, both fixed to the vehicle: any image point gives a point of space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Triangulation {
    camera: OnVehicle<Camera>,
    beam: Beam,
    beam_from_camera: Pose,
    /// y of the plane in the beam frame, metres.
    y: f64,
}

impl Triangulation {
    /// The plane of one beam of the rig, which must have it.
    pub fn new(rig: &Rig, beam: usize, plane: SheetPlane) -> Self {
        let OnVehicle { vehicle_from_sensor, sensor } = rig.beams[beam];
        let y = match plane {
            SheetPlane::LowerEdge => 0.5 * sensor.thickness,
            SheetPlane::Middle => 0.0,
        };
        let beam_from_camera = vehicle_from_sensor.inverse() * rig.camera.vehicle_from_sensor;
        Self { camera: rig.camera, beam: sensor, beam_from_camera, y }
    }

    /// The point of the plane seen at image point (u, v), in pixels from the outer corner of pixel (0, 0): vehicle
    /// frame, metres. `None` where the beam cannot have lit what is seen there.
    pub fn at(&self, u: f64, v: f64) -> Option<DVec3> {
        let camera = &self.camera.sensor;
        let q_camera = DVec3::new(
            (u - camera.principal_point[0]) * camera.pixel_pitch[0],
            (v - camera.principal_point[1]) * camera.pixel_pitch[1],
            camera.focal_length,
        );
        let q = self.beam_from_camera.rotate(q_camera);
        let centre = self.beam_from_camera.position;
        // centre + t q lies on the plane; at t = 1 the ray crosses the image plane.
        let t = (self.y - centre.y) / q.y;
        if !(t >= 1.0 && t.is_finite()) {
            return None;
        }
        // Outside the fan there is no light, nor beyond its range; a pixel's own size is forgiven.
        let point = centre + q * t;
        let pixel = t * camera.pixel_pitch[0].max(camera.pixel_pitch[1]);
        let Beam { grid_distance: g, half_width: w, max_range, .. } = self.beam;
        let lit = point.z >= g
            && point.x.abs() <= point.z * w / g + pixel
            && libm::hypot(point.x, point.z) <= max_range + pixel;
        lit.then(|| self.camera.vehicle_from_sensor * (q_camera * t))
    }

    /// The point seen by the middle of pixel (i, j).
    pub fn at_pixel(&self, i: u32, j: u32) -> Option<DVec3> {
        self.at(f64::from(i) + 0.5, f64::from(j) + 0.5)
    }

    /// The largest distance, metres, between the point seen by the middle of pixel (i, j) and one seen anywhere
    /// else in it: its footprint on the plane, a quadrilateral, reaches furthest at a corner. `None` if a corner
    /// sees nothing lit.
    pub fn footprint(&self, i: u32, j: u32) -> Option<f64> {
        let middle = self.at_pixel(i, j)?;
        let (u, v) = (f64::from(i), f64::from(j));
        let mut largest: f64 = 0.0;
        for (u, v) in [(u, v), (u + 1.0, v), (u, v + 1.0), (u + 1.0, v + 1.0)] {
            largest = largest.max((self.at(u, v)? - middle).length());
        }
        Some(largest)
    }

    /// The points of a stripe's edges, in their order, at the places where they were measured: vehicle frame,
    /// metres.
    pub fn points(&self, edges: &[EdgePoint]) -> Vec<DVec3> {
        edges.iter().filter_map(|edge| self.of_edge(edge)).collect()
    }

    /// The point of one edge, at the place where it was measured: vehicle frame, metres.
    pub fn of_edge(&self, edge: &EdgePoint) -> Option<DVec3> {
        self.at(f64::from(edge.i) + 0.5, edge.row)
    }

    /// The table of all pixels.
    pub fn table(&self) -> TriangulationTable {
        let Camera { width, height, .. } = self.camera.sensor;
        let mut points = Image::filled(width, height, Maybe::NONE);
        for j in 0..height {
            for i in 0..width {
                points.set(i, j, self.at_pixel(i, j).into());
            }
        }
        TriangulationTable { points }
    }
}

/// "A table holds the local vehicle coordinates of the edge plane point seen by any given camera pixel, i.e. the
/// point where a ray passing through the camera pixel intersects the lower edge plane of the light beam." (§7)
///
/// It holds for one configuration of camera and beam: panned sensors need another. "Tables must be regenerated at
/// every camera and beam configuration." (§8)
#[derive(Debug, Clone, PartialEq)]
pub struct TriangulationTable {
    points: Image<Maybe<DVec3>>,
}

impl TriangulationTable {
    /// The point seen by pixel (i, j), vehicle frame, metres.
    pub fn at_pixel(&self, i: u32, j: u32) -> Option<DVec3> {
        self.points.at(i, j).get()
    }

    /// The points of a stripe's edge pixels, in their order, vehicle frame, metres.
    pub fn points(&self, edges: &[EdgePoint]) -> Vec<DVec3> {
        edges.iter().filter_map(|edge| self.at_pixel(edge.i, edge.j)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rig::Pan;
    use crate::rig::tests::default_rig;

    /// Where a point of the vehicle frame lands on the image: the pinhole's own equation.
    fn project(rig: &Rig, point: DVec3) -> (f64, f64) {
        let p = rig.camera.vehicle_from_sensor.inverse() * point;
        let camera = &rig.camera.sensor;
        let along = |axis: usize, x: f64| {
            camera.principal_point[axis] + camera.focal_length * x / p.z / camera.pixel_pitch[axis]
        };
        (along(0, p.x), along(1, p.y))
    }

    /// Points of a beam's lower edge plane, laid out in the beam frame, that the camera sees.
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
                    // Where it really lands: the same point again.
                    let again = triangulation.at(u, v).expect("a lit point");
                    assert!((again - point).length() < 1e-9, "{again} for {point}");
                    // From the middle of its pixel: within the footprint.
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
        // From a pixel's middle to its point and back: the point lies on y = T/2 of the beam, and lands on the
        // middle of the pixel. 1e-9 m at up to 20 m is 1e-9 / 20 * 8e-3 / 9e-6 = 4e-8 pixels.
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
        // Beam 0: 1.8 m up, 31 degrees down. Its lower edge plane runs 2.5 mm below the axis plane, measured at
        // right angles: it meets the ground (1.8 - 0.0025 / cos 31) / tan 31 ahead of the beam.
        let rig = default_rig();
        let down = 31.0_f64.to_radians();
        let ahead = (1.8 - 0.0025 / libm::cos(down)) / libm::tan(down);
        let (u, v) = project(&rig, DVec3::new(0.3 + ahead, 0.0, 0.0));
        let point = Triangulation::new(&rig, 0, SheetPlane::LowerEdge).at(u, v).unwrap();
        assert!((point - DVec3::new(0.3 + ahead, 0.0, 0.0)).length() < 1e-9);
        // The camera's ray comes from below the sheet: it meets the middle plane later, below the ground.
        let middle = Triangulation::new(&rig, 0, SheetPlane::Middle).at(u, v).unwrap();
        assert!(middle.z < 0.0 && middle.x > point.x);
    }

    #[test]
    fn what_the_beam_cannot_light_is_no_point() {
        let rig = default_rig();
        let triangulation = Triangulation::new(&rig, 0, SheetPlane::LowerEdge);
        // The plane falls 31 degrees, 11 more than the camera's axis, and is above the camera: below its vanishing line
        // at row 512 + 8 mm tan 11 / 9 um = 684.8 the camera looks under it for ever.
        assert!(triangulation.at(512.0, 684.0).is_none() && triangulation.at(512.0, 700.0).is_none());
        assert!(triangulation.at(512.0, 650.0).is_some());
        // Near the image's right border low down, beyond the fan.
        let mut narrow = rig.clone();
        narrow.beams[0].sensor.half_width = 0.01;
        let triangulation = Triangulation::new(&narrow, 0, SheetPlane::LowerEdge);
        let (u, v) = project(&rig, DVec3::new(3.29, 0.0, 0.0));
        assert!(triangulation.at(u, v).is_some() && triangulation.at(u + 400.0, v).is_none());
    }
}
