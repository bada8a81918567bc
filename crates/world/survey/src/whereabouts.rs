//! Where everything stands: poses, fields of view and bounds in the global frame, as numbers and as lines of text.

use glam::DVec3;
use raypencil_report::{count as thousands, counted, number};
use raypencil_scene::{Camera, Pose, Scene, SensorId};
use serde::Serialize;

/// Position and attitude in the global frame (x forward at heading 0, y left, z up).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Attitude {
    /// Position, metres.
    pub position_m: [f64; 3],
    /// Angle of the view to the left of the global x axis, seen from above, degrees.
    pub heading_deg: f64,
    /// Angle of the view below the horizon, degrees.
    pub pitch_down_deg: f64,
    /// Turn about the view to the right, degrees.
    pub roll_right_deg: f64,
}

/// Where a sensor stands, and what it sees.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SensorPlace {
    /// The sensor.
    #[serde(serialize_with = "sensor_name")]
    pub sensor: SensorId,
    /// Its pose.
    #[serde(flatten)]
    pub attitude: Attitude,
    /// Field of view across and down, degrees. A beam is a plane fan: it has 0 down.
    pub field_of_view_deg: [f64; 2],
    /// Maximum range along the ray, metres.
    pub max_range_m: f64,
}

/// Where the vehicle, the sensors and the terrain are.
///
/// ```
/// use std::sync::Arc;
///
/// use glam::DVec3;
/// use raypencil_scene::{Atmosphere, FluxModel, Scene, rig};
/// use raypencil_survey::Whereabouts;
///
/// let mesh = raypencil_terrain::builtin("pyramids", 0.25).expect("a built-in name").into_mesh()?;
/// let (camera, beams) = rig::default_rig(32, DVec3::new(1.0, 2.0, 0.0), std::f64::consts::FRAC_PI_2);
/// let air = Atmosphere { attenuation: 0.0 };
/// let scene = Scene::new(Arc::new(mesh), camera, beams, air, FluxModel::Radiometric)?;
/// let whereabouts = Whereabouts::of(&scene, None);
/// // The camera is 0.3 m ahead of the vehicle, which looks along y, and looks down by 20 degrees.
/// let line = &whereabouts.lines()[0];
/// assert!(line.starts_with("camera at (1.00, 2.30, 1.50) m, heading 90.0°, pitch down 20.0°, roll 0.0°; sees "));
/// assert!(line.ends_with("sees 59.9° x 59.9°, to 20.0 m"));
/// # Ok::<(), raypencil_scene::SceneError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Whereabouts {
    /// The vehicle; null if the scene has none.
    pub vehicle: Option<Attitude>,
    /// The sensors, the camera first.
    pub sensors: Vec<SensorPlace>,
    /// Smallest and largest coordinates of the terrain, metres; null without vertices.
    pub terrain_bounds_m: Option<[[f64; 3]; 2]>,
    /// Vertices of the terrain that moved when they were stored as `f32` offsets.
    pub rounded_vertices: RoundedVertices,
}

/// How storing a terrain as `f32` offsets moved its vertices.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct RoundedVertices {
    /// Number of vertices that moved.
    pub count: usize,
    /// Number of all vertices.
    pub of: usize,
    /// Largest distance along an axis by which one moved, metres.
    pub largest_m: f64,
}

/// Shortest horizontal part of a unit vector that has a heading: shorter, the view is straight up or down.
const MIN_HORIZONTAL: f64 = 1e-9;

impl Attitude {
    /// The attitude of a vehicle (x forward, y left, z up) with this pose in the global frame. Straight up or down, the
    /// heading is that of the vehicle's back or top, and the roll is 0.
    pub fn of_vehicle(pose: &Pose) -> Self {
        let [forward, left, up] = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| pose.rotate(axis));
        let horizontal = libm::hypot(forward.x, forward.y);
        let has_heading = horizontal > MIN_HORIZONTAL;
        let toward = if has_heading { forward } else { up * -forward.z.signum() };
        let roll = if has_heading { libm::atan2(left.z, up.z) } else { 0.0 };
        Self {
            position_m: pose.position.to_array(),
            heading_deg: libm::atan2(toward.y, toward.x).to_degrees(),
            pitch_down_deg: libm::atan2(-forward.z, horizontal).to_degrees(),
            roll_right_deg: roll.to_degrees(),
        }
    }

    /// The attitude of a sensor (z forward, x right, y down) with this pose in the global frame.
    pub fn of_sensor(pose: &Pose) -> Self {
        Self::of_vehicle(&(*pose * Pose::VEHICLE_FROM_FORWARD_SENSOR.inverse()))
    }

    /// Position and angles in a line.
    fn words(&self) -> String {
        let [x, y, z] = self.position_m.map(|metres| rounded(metres, 2));
        let angles = [self.heading_deg, self.pitch_down_deg, self.roll_right_deg];
        let [heading, pitch, roll] = angles.map(|degrees| rounded(degrees, 1));
        format!("at ({x}, {y}, {z}) m, heading {heading}°, pitch down {pitch}°, roll {roll}°")
    }
}

impl Whereabouts {
    /// The whereabouts of a scene; `vehicle` is the vehicle's pose in the global frame.
    pub fn of(scene: &Scene, vehicle: Option<&Pose>) -> Self {
        let origin = scene.mesh().origin();
        let place = |sensor| {
            let (pose, field_of_view_deg) = match sensor {
                SensorId::Camera => {
                    let camera = scene.camera();
                    (camera.scene_from_sensor, camera_view(&camera.sensor))
                }
                SensorId::Beam(index) => {
                    let beam = &scene.beams()[index];
                    let half_fan = libm::atan2(beam.sensor.half_width, beam.sensor.grid_distance);
                    (beam.scene_from_sensor, [2.0 * half_fan.to_degrees(), 0.0])
                }
            };
            let global_from_sensor = Pose { position: pose.position + origin, ..pose };
            SensorPlace {
                sensor,
                attitude: Attitude::of_sensor(&global_from_sensor),
                field_of_view_deg,
                max_range_m: scene.max_range(sensor).unwrap_or_default(),
            }
        };
        Self {
            vehicle: vehicle.map(Attitude::of_vehicle),
            sensors: scene.sensors().map(place).collect(),
            terrain_bounds_m: scene
                .mesh()
                .bounds()
                .map(|bounds| bounds.map(|corner| (corner + origin).to_array())),
            rounded_vertices: RoundedVertices {
                count: scene.mesh().rounding().vertices,
                of: scene.mesh().vertices().len(),
                largest_m: scene.mesh().rounding().largest,
            },
        }
    }

    /// The vehicle in a line; a scene without one says so.
    pub fn vehicle_line(&self) -> String {
        self.vehicle
            .map_or("no vehicle: sensors alone".into(), |vehicle| format!("vehicle {}", vehicle.words()))
    }

    /// The terrain's bounds in a line.
    pub fn terrain_line(&self) -> String {
        let Some([low, high]) = self.terrain_bounds_m else { return "terrain without vertices".into() };
        let span = |axis: usize| format!("{} to {}", rounded(low[axis], 2), rounded(high[axis], 2));
        format!("terrain x {}, y {}, z {} m", span(0), span(1), span(2))
    }

    /// How many vertices the `f32` offsets of a scene round, and by how much, in a line.
    pub fn rounding_line(&self) -> String {
        let RoundedVertices { count, of, largest_m } = self.rounded_vertices;
        let all = counted(of as u64, "vertex", "vertices");
        match count {
            0 => format!("{all}, none of them rounded"),
            _ => {
                let largest = format!("{largest_m:.1e}");
                format!("{all}, {} rounded to f32 offsets, by {largest} m at most", thousands(count as u64))
            }
        }
    }

    /// A line for each sensor.
    pub fn lines(&self) -> Vec<String> {
        let line = |place: &SensorPlace| {
            let [across, down] = place.field_of_view_deg.map(|degrees| rounded(degrees, 1));
            let view = match place.sensor {
                SensorId::Camera => format!("{across}° x {down}°"),
                SensorId::Beam(_) => format!("a fan of {across}°"),
            };
            let range = number(place.max_range_m);
            format!("{} {}; sees {view}, to {range} m", place.sensor, place.attitude.words())
        };
        self.sensors.iter().map(line).collect()
    }
}

/// Angles between the outer edges of the image, across and down, degrees.
fn camera_view(camera: &Camera) -> [f64; 2] {
    let sides = [camera.width, camera.height].map(f64::from);
    [0, 1].map(|axis| {
        let angle = |pixels: f64| libm::atan2(pixels * camera.pixel_pitch[axis], camera.focal_length);
        let centre = camera.principal_point[axis];
        (angle(sides[axis] - centre) + angle(centre)).to_degrees()
    })
}

/// A number with so many decimals, and never a minus zero.
fn rounded(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let is_zero = text.trim_start_matches('-').chars().all(|letter| "0.".contains(letter));
    if is_zero { text.trim_start_matches('-').to_string() } else { text }
}

fn sensor_name<S: serde::Serializer>(sensor: &SensorId, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(&sensor.to_string())
}
