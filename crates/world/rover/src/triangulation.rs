//! Triangulation: from a camera pixel to the point on a beam's edge plane that it sees. (Paper, §6 and §7)

use glam::DVec3;
use raypencil_scene::{Beam, Camera, Image, Maybe, Pose};

use crate::rig::{OnVehicle, Rig};
use crate::stripe::{EdgePoint, StripeLocation};

/// Plane of a light sheet on which measured image points lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SheetPlane {
    /// y = +T/2 in the beam frame, for edges: "the lower edge plane of the light beam" (§7).
    #[default]
    LowerEdge,
    /// y = 0, for centroids.
    Middle,
}

impl SheetPlane {
    /// Plane of the rows that an extraction measures.
    pub fn for_location(place: StripeLocation) -> Self {
        match place {
            StripeLocation::Pixel | StripeLocation::SubPixel => Self::LowerEdge,
            StripeLocation::Centroid => Self::Middle,
        }
    }
}

/// Triangulation with a camera and one plane of light, both fixed to the vehicle: an image point gives a point in
/// space.
///
/// ```
/// # use glam::DVec3;
/// # use raypencil_scene::{Beam, Camera, Lens, Profile};
/// # let camera = Camera {
/// #     width: 1024, height: 1024, pixel_pitch: [9e-6; 2], focal_length: 8e-3, principal_point: [512.0; 2],
/// #     aperture: 2e-3, lens: Lens::CLEAR, max_range: 20.0,
/// # };
/// # let half_width = Beam::half_width_of(0.1, 60.0_f64.to_radians());
/// # let beam = Beam {
/// #     columns: 1024, rows: 16, thickness: 5e-3, grid_distance: 0.1, half_width, max_range: 20.0, power: 1.0,
/// #     wavelength: 810e-9, profile: Profile::Paper,
/// # };
/// use raypencil_rover::{OnVehicle, Rig, SheetPlane, Triangulation};
///
/// // A camera 1.5 m up that looks 20 degrees down, and a beam 1.8 m up that points 31 degrees down.
/// let mount = |height, down: f64| Rig::mount(DVec3::new(0.0, 0.0, height), down.to_radians());
/// let rig = Rig {
///     camera: OnVehicle { vehicle_from_sensor: mount(1.5, 20.0), sensor: camera },
///     beams: vec![OnVehicle { vehicle_from_sensor: mount(1.8, 31.0), sensor: beam }],
/// };
/// let triangulation = Triangulation::new(&rig, 0, SheetPlane::Middle);
///
/// // The sheet's middle meets level ground 1.8 / tan 31 = 2.996 m ahead. The camera sees that point
/// // atan(1.5 / 2.996) = 26.6 degrees down: 6.6 degrees below its axis, 8 mm tan(6.6) / 9 um = 102.9 pixels.
/// let ahead = 1.8 / libm::tan(31.0_f64.to_radians());
/// let below_axis = libm::atan(1.5 / ahead) - 20.0_f64.to_radians();
/// let row = 512.0 + 8e-3 * libm::tan(below_axis) / 9e-6;
/// let point = triangulation.at(512.0, row).unwrap();
/// assert!((point - DVec3::new(ahead, 0.0, 0.0)).length() < 1e-9);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Triangulation {
    camera: OnVehicle<Camera>,
    beam: Beam,
    beam_from_camera: Pose,
    /// Coordinate y of the plane in the beam frame, metres.
    y: f64,
}

impl Triangulation {
    /// Triangulation on a plane of the beam with index `beam`.
    ///
    /// # Panics
    /// If the rig has no such beam.
    pub fn new(rig: &Rig, beam: usize, plane: SheetPlane) -> Self {
        let OnVehicle { vehicle_from_sensor, sensor } = rig.beams[beam];
        let y = match plane {
            SheetPlane::LowerEdge => 0.5 * sensor.thickness,
            SheetPlane::Middle => 0.0,
        };
        let beam_from_camera = vehicle_from_sensor.inverse() * rig.camera.vehicle_from_sensor;
        Self { camera: rig.camera, beam: sensor, beam_from_camera, y }
    }

    /// Point of the plane that is seen at image point (u, v), in the vehicle frame, metres. (u, v) is in pixels from
    /// the outer corner of pixel (0, 0). `None` if the beam cannot light that point.
    pub fn at(&self, u: f64, v: f64) -> Option<DVec3> {
        let camera = &self.camera.sensor;
        let q_camera = DVec3::new(
            (u - camera.principal_point[0]) * camera.pixel_pitch[0],
            (v - camera.principal_point[1]) * camera.pixel_pitch[1],
            camera.focal_length,
        );
        let q = self.beam_from_camera.rotate(q_camera);
        let centre = self.beam_from_camera.position;
        // centre + t q is the point on the plane; at t = 1 the ray crosses the image plane.
        let t = (self.y - centre.y) / q.y;
        if !(t >= 1.0 && t.is_finite()) {
            return None;
        }
        // The beam lights points inside its fan and its range. The tolerance is the size of the pixel at that distance.
        let point = centre + q * t;
        let pixel = t * camera.pixel_pitch[0].max(camera.pixel_pitch[1]);
        let Beam { grid_distance: g, half_width: w, max_range, .. } = self.beam;
        let lit = point.z >= g
            && point.x.abs() <= point.z * w / g + pixel
            && libm::hypot(point.x, point.z) <= max_range + pixel;
        lit.then(|| self.camera.vehicle_from_sensor * (q_camera * t))
    }

    /// Point seen by the middle of pixel (i, j), in the vehicle frame, metres.
    pub fn at_pixel(&self, i: u32, j: u32) -> Option<DVec3> {
        self.at(f64::from(i) + 0.5, f64::from(j) + 0.5)
    }

    /// Radius of the footprint of pixel (i, j) on the plane, metres: the largest distance from the point seen by its
    /// middle to one seen elsewhere in the pixel. The footprint is a quadrilateral, so that a corner is farthest.
    /// `None` if the beam cannot light the point of a corner.
    pub fn footprint(&self, i: u32, j: u32) -> Option<f64> {
        let middle = self.at_pixel(i, j)?;
        let (u, v) = (f64::from(i), f64::from(j));
        let mut largest: f64 = 0.0;
        for (u, v) in [(u, v), (u + 1.0, v), (u, v + 1.0), (u + 1.0, v + 1.0)] {
            largest = largest.max((self.at(u, v)? - middle).length());
        }
        Some(largest)
    }

    /// Point of one edge at its measured row: vehicle frame, metres.
    pub fn at_edge(&self, edge: &EdgePoint) -> Option<DVec3> {
        self.at(f64::from(edge.i) + 0.5, edge.row)
    }

    /// Error of the elevation of an edge's point if its row is off by `rows` pixels: metres, in the vehicle frame. The
    /// larger of both ways. `None` if the beam cannot light the point.
    pub fn elevation_error(&self, edge: &EdgePoint, rows: f64) -> Option<f64> {
        let u = f64::from(edge.i) + 0.5;
        let middle = self.at(u, edge.row)?.z;
        let off = |row: f64| self.at(u, row).map(|point| (point.z - middle).abs());
        // Past the end of the fan's range there is no point: the other way says as much.
        let ways = [off(edge.row - rows), off(edge.row + rows)];
        ways.into_iter().flatten().reduce(f64::max)
    }

    /// Table of the points of all pixels.
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

/// Table of the points seen by all pixels. "A table holds the local vehicle coordinates of the edge plane point seen by
/// any given camera pixel, i.e. the point where a ray passing through the camera pixel intersects the lower edge plane
/// of the light beam." (§7)
///
/// A table is valid for one configuration of camera and beam: panned sensors need another one. "Tables must be
/// regenerated at every camera and beam configuration." (§8)
#[derive(Debug, Clone, PartialEq)]
pub struct TriangulationTable {
    points: Image<Maybe<DVec3>>,
}

impl TriangulationTable {
    /// Point seen by the middle of pixel (i, j), in the vehicle frame, metres.
    pub fn at_pixel(&self, i: u32, j: u32) -> Option<DVec3> {
        self.points.at(i, j).get()
    }
}
