//! Shadow map of the sun: ranges from a camera far off in the sun's direction. (L. Williams, "Casting curved shadows on
//! curved surfaces", SIGGRAPH 1978, with a bias that grows with the slope of the face)

use std::sync::Arc;

use glam::DVec3;
use raypencil_scene::{
    Atmosphere, Camera, FluxModel, Image, Lens, Maybe, Mesh, Mounted, Pose, Quantities, Renderer, Request,
    Scene, SceneError,
};
use raypencil_sensor::{PointSource, Sunlight};
use raypencil_tracer::Tracer;

/// Cells along either side of the shadow map. CHOICE: 2.4 cm per cell on 50 m.
const MAP_SIDE_CELLS: u32 = 2048;

/// Distance of the shadow camera from the centre of the ball that it covers, in radii of the ball. At 400 its rays
/// deviate from parallel by 2.5 mrad, less than half the sun's angular diameter on Mars (6 mrad).
const CAMERA_DISTANCE_RADII: f64 = 400.0;

/// Upper limit of a camera's range, metres, enforced by `scene`.
const MAX_CAMERA_RANGE_M: f64 = 1e7;

/// Largest radius of the ball, metres. Larger grounds get no shadows: a cell would be a kilometre.
const MAX_BALL_RADIUS_M: f64 = 1e6;

/// Upper limit of the slope in the bias: change of range over distance across the sun's rays.
const MAX_BIAS_SLOPE: f64 = 20.0;

/// Number of cells over which the slope adds to the bias.
const BIAS_CELLS: f64 = 2.0;

/// Constant part of the bias, metres, for rounding errors.
const BIAS_M: f64 = 1e-3;

/// Ranges seen from the sun's direction.
pub(crate) struct ShadowMap {
    scene_from_sensor: Pose,
    sensor_from_scene: Pose,
    camera: Camera,
    ranges: Image<Maybe<f64>>,
    /// Side of a cell at the ball's centre, metres.
    cell: f64,
}

impl ShadowMap {
    /// Map of everything within a ball of the scene frame. `None` if there is no direct sunlight, or if the ball is too
    /// large for a map.
    pub(crate) fn of_ball(
        mesh: &Arc<Mesh>,
        light: &Sunlight,
        (centre, radius): (DVec3, f64),
    ) -> Result<Option<Self>, SceneError> {
        (light.direct > 0.0 && radius <= MAX_BALL_RADIUS_M)
            .then(|| Self::new(mesh, light, centre, radius))
            .transpose()
    }

    fn new(mesh: &Arc<Mesh>, light: &Sunlight, centre: DVec3, radius: f64) -> Result<Self, SceneError> {
        let distance = (CAMERA_DISTANCE_RADII * radius).min(MAX_CAMERA_RANGE_M - radius);
        let towards_ground = Pose::from_axis_angle(DVec3::Z, light.azimuth + std::f64::consts::PI)
            * Pose::from_axis_angle(DVec3::Y, light.elevation)
            * Pose::VEHICLE_FROM_FORWARD_SENSOR;
        let scene_from_sensor = Pose { position: centre + light.direction() * distance, ..towards_ground };
        let pitch = 1e-5;
        let camera = Camera {
            width: MAP_SIDE_CELLS,
            height: MAP_SIDE_CELLS,
            pixel_pitch: [pitch; 2],
            // The ball fills the image.
            focal_length: 0.5 * f64::from(MAP_SIDE_CELLS) * pitch * (distance - radius) / radius,
            principal_point: [0.5 * f64::from(MAP_SIDE_CELLS); 2],
            aperture: 1e-3,
            lens: Lens::CLEAR,
            max_range: distance + radius,
        };
        Ok(Self {
            scene_from_sensor,
            sensor_from_scene: scene_from_sensor.inverse(),
            camera,
            ranges: ranges(mesh, camera, scene_from_sensor)?,
            cell: 2.0 * radius / f64::from(MAP_SIDE_CELLS),
        })
    }

    /// Whether the sun shines on a point of a face with this unit normal, both in the scene frame. A point outside the
    /// map counts as sunlit.
    ///
    /// A point is in shadow if something in its cell is nearer to the sun by more than the bias: the change of range
    /// over two cells along the face, and 1 mm.
    pub(crate) fn is_sunlit(&self, point: DVec3, normal: DVec3) -> bool {
        let image = PointSource::project(&self.camera, self.sensor_from_scene * point, 0.0);
        let is_inside = |at: f64| (0.0..f64::from(MAP_SIDE_CELLS)).contains(&at);
        if !(is_inside(image.x) && is_inside(image.y)) {
            return true;
        }
        let to_sun = self.scene_from_sensor.position - point;
        let range = to_sun.length();
        let facing = normal.dot(to_sun) / range;
        let slope = ((1.0 - facing * facing).max(0.0).sqrt() / facing.abs().max(1e-9)).min(MAX_BIAS_SLOPE);
        let nearest = self.ranges.at(image.x as u32, image.y as u32).get();
        nearest.is_none_or(|nearest| nearest >= range - (BIAS_CELLS * self.cell * slope + BIAS_M))
    }
}

/// Range map of the ground from a camera at `scene_from_sensor`.
fn ranges(
    mesh: &Arc<Mesh>,
    camera: Camera,
    scene_from_sensor: Pose,
) -> Result<Image<Maybe<f64>>, SceneError> {
    let mounted = Mounted { scene_from_sensor, sensor: camera };
    let scene = Scene::new(
        Arc::clone(mesh),
        mounted,
        Vec::new(),
        Atmosphere { attenuation: 0.0 },
        FluxModel::Radiometric,
    )?;
    let quantities = Quantities::RANGE_MAP;
    let request = Request { beams: false, returns: false, quantities, ..Request::EVERYTHING };
    let map = Tracer::new().render(&scene, &request).camera.expect("the camera's map was requested");
    Ok(map.range.expect("ranges were requested"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wall_casts_its_shadow_behind_it() {
        // 100 m of flat ground, and a wall 1 m high at x = 0, from y = -5 to y = 5 m, which faces the sun.
        let place = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
        let ground = [
            place(-50.0, -50.0, 0.0),
            place(50.0, -50.0, 0.0),
            place(50.0, 50.0, 0.0),
            place(-50.0, 50.0, 0.0),
        ];
        let wall = [place(0.0, -5.0, 0.0), place(0.0, 5.0, 0.0), place(0.0, 5.0, 1.0), place(0.0, -5.0, 1.0)];
        let vertices = [ground, wall].concat();
        let faces = vec![[0, 1, 2], [0, 2, 3], [4, 6, 5], [4, 7, 6]];
        let mesh = crate::common::mesh(&vertices, faces);
        // The sun is behind the vehicle, 45 degrees high: the shadow is 1 m long.
        let light = Sunlight::mars(45.0_f64.to_radians(), 180.0_f64.to_radians(), 0.5);
        let centre = -mesh.origin();
        let shadows = ShadowMap::new(&mesh, &light, centre, 30.0).unwrap();
        let lit = |x: f64, y: f64, z: f64| shadows.is_sunlit(place(x, y, z) - mesh.origin(), DVec3::Z);
        assert!(!lit(0.2, 0.0, 0.0) && !lit(0.9, 4.8, 0.0), "behind the wall");
        assert!(lit(1.1, 0.0, 0.0) && lit(0.5, 5.2, 0.0) && lit(-0.3, 0.0, 0.0), "beside it");
        // The side of the wall that faces the sun.
        assert!(shadows.is_sunlit(place(0.0, 0.0, 0.5) - mesh.origin(), -DVec3::X));
        // Outside the map there are no shadows.
        assert!(lit(45.0, 0.0, 0.0));
    }
}
