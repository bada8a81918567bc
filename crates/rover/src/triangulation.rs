//! From a camera pixel to the point on a beam's edge plane that it sees. (Paper, §6 and §7)

use glam::DVec3;
use raypencil_scene::{Beam, Camera, Image, Maybe, Pose};

use crate::rig::{OnVehicle, Rig};
use crate::stripe::{EdgePoint, StripeLocation};

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
    pub fn for_location(place: StripeLocation) -> Self {
        match place {
            StripeLocation::Pixel | StripeLocation::SubPixel => Self::LowerEdge,
            StripeLocation::Centroid => Self::Middle,
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
        edges.iter().filter_map(|edge| self.at_edge(edge)).collect()
    }

    /// The point of one edge, at the place where it was measured: vehicle frame, metres.
    pub fn at_edge(&self, edge: &EdgePoint) -> Option<DVec3> {
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
