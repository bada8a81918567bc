//! The numbers of a scene in the units of scene files, a line or two for each part.

use glam::{DVec2, DVec3};
use raypencil_report::counted;
use raypencil_scene::{Beam, Camera, Pose, Profile};
use raypencil_scene_io::LoadedScene;
use serde_json::{Value, json};

/// Where a sensor of the vehicle looks.
struct Aim {
    /// Metres, in the frame of the vehicle.
    position: DVec3,
    /// Angle of the normal axis below the vehicle's horizontal plane, degrees.
    pitch_down_deg: f64,
    /// Angle of the normal axis to the left of the vehicle's forward axis, degrees.
    yaw_left_deg: f64,
    /// Turn about the normal axis, degrees, positive with the right side down.
    roll_right_deg: f64,
}

impl Aim {
    fn of(pose: &Pose) -> Self {
        // A sensor looks along its own z axis.
        let along = pose.rotate(DVec3::Z);
        // Its x is to the right and its y down; without roll x is level.
        let (right, down) = (pose.rotate(DVec3::X), pose.rotate(DVec3::Y));
        Self {
            position: pose.position,
            pitch_down_deg: libm::atan2(-along.z, along.truncate().length()).to_degrees(),
            yaw_left_deg: libm::atan2(along.y, along.x).to_degrees(),
            roll_right_deg: libm::atan2(-right.z, -down.z).to_degrees(),
        }
    }

    fn words(&self) -> String {
        format!(
            "at {} m, {} deg down, {} deg left, roll {} deg",
            triple(self.position),
            short(self.pitch_down_deg),
            short(self.yaw_left_deg),
            short(self.roll_right_deg)
        )
    }

    fn json(&self) -> Value {
        json!({
            "position_m": self.position.to_array(),
            "pitch_down_deg": self.pitch_down_deg,
            "yaw_left_deg": self.yaw_left_deg,
            "roll_right_deg": self.roll_right_deg,
        })
    }
}

/// A number with at most six digits after the point, without zeros at its end.
fn short(number: f64) -> String {
    let text = format!("{number:.6}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".into() } else { text.into() }
}

fn triple(v: DVec3) -> String {
    format!("({}, {}, {})", short(v.x), short(v.y), short(v.z))
}

/// Full fields of view of a camera across and down, degrees, about its principal point.
fn field_of_view_deg(camera: &Camera) -> [f64; 2] {
    [0, 1].map(|axis: usize| {
        let size = f64::from([camera.width, camera.height][axis]);
        let centre = camera.principal_point[axis];
        let angle = |pixels: f64| libm::atan(pixels * camera.pixel_pitch[axis] / camera.focal_length);
        (angle(centre) + angle(size - centre)).to_degrees()
    })
}

/// Focal length in pixels, across and down.
fn focal_px(camera: &Camera) -> [f64; 2] {
    camera.pixel_pitch.map(|pitch| camera.focal_length / pitch)
}

/// Full fan angle of a beam, degrees: `half_width` is the tangent's opposite side at the grid distance.
fn fan_deg(beam: &Beam) -> f64 {
    2.0 * libm::atan2(beam.half_width, beam.grid_distance).to_degrees()
}

fn profile_words(profile: Profile) -> String {
    match profile {
        Profile::Paper => "paper".into(),
        Profile::UniformAngle => "uniform_angle".into(),
        Profile::Gaussian { half_width } => {
            format!("gaussian of half width {} deg", short(half_width.to_degrees()))
        }
    }
}

fn camera_words(camera: &Camera) -> String {
    let [across, down] = field_of_view_deg(camera).map(short);
    let [fx, fy] = focal_px(camera).map(short);
    let [x, y] = camera.principal_point.map(short);
    // OpenCV and ROS count from the middle of the first pixel.
    let [cx, cy] = camera.principal_point.map(|at| short(at - 0.5));
    let [px, py] = camera.pixel_pitch.map(|pitch| short(1e6 * pitch));
    format!(
        "{} x {} pixels of {px} x {py} um, focal length {} mm: {across} x {down} deg\n          \
         fx {fx}, fy {fy}, cx {cx}, cy {cy} px, as OpenCV counts: {x}, {y} from the image's corner\n          \
         aperture {} mm; range {} m",
        camera.width,
        camera.height,
        short(1e3 * camera.focal_length),
        short(1e3 * camera.aperture),
        short(camera.max_range)
    )
}

fn beam_words(beam: &Beam) -> String {
    format!(
        "fan {} deg, {} mm thick, {} x {} pencils on a grid at {} mm\n          \
         {} W at {} nm, profile {}; range {} m",
        short(fan_deg(beam)),
        short(1e3 * beam.thickness),
        beam.columns,
        beam.rows,
        short(1e3 * beam.grid_distance),
        short(beam.power),
        short(1e9 * beam.wavelength),
        profile_words(beam.profile),
        short(beam.max_range)
    )
}

/// The scene in words, with units. Sensors are placed in the frame of the vehicle: x forward, y left, z up.
pub fn scene_words(loaded: &LoadedScene) -> String {
    let scene = &loaded.scene;
    let mesh = scene.mesh();
    let mut text = format!("scene     {}, SHA-256 {}\n", loaded.name, loaded.scene_sha256);
    let [low, high] = mesh.bounds().unwrap_or_default().map(|corner| corner + mesh.origin());
    text += &format!(
        "ground    {}; x {} to {}, y {} to {}, z {} to {} m\n",
        counted(mesh.faces().len() as u64, "face", "faces"),
        short(low.x),
        short(high.x),
        short(low.y),
        short(high.y),
        short(low.z),
        short(high.z)
    );
    for material in mesh.materials() {
        text += &format!("          {:?}: reflectivity {}\n", material.name, short(material.reflectivity));
    }
    match loaded.standing_vehicle() {
        Some(vehicle) => {
            let ahead = vehicle.rotate(DVec3::X);
            let heading = libm::atan2(ahead.y, ahead.x).to_degrees();
            text += &format!(
                "vehicle   at {} m of the global frame, heading {} deg\n",
                triple(vehicle.position),
                short(heading)
            );
        }
        None => text += "vehicle   none: the sensors are placed in the scene's own frame\n",
    }
    let rig = loaded.rig();
    text += &format!("camera    {}\n", Aim::of(&rig.camera.vehicle_from_sensor).words());
    text += &format!("          {}\n", camera_words(&rig.camera.sensor));
    for (index, beam) in rig.beams.iter().enumerate() {
        text += &format!("beam {index:<4} {}\n", Aim::of(&beam.vehicle_from_sensor).words());
        text += &format!("          {}\n", beam_words(&beam.sensor));
    }
    text += &format!(
        "air       attenuation {} 1/m; flux model {}\n",
        short(scene.atmosphere().attenuation),
        scene.flux_model().word()
    );
    text
}

/// The same for programs.
pub fn scene_json(loaded: &LoadedScene) -> Value {
    let scene = &loaded.scene;
    let mesh = scene.mesh();
    let [low, high] = mesh.bounds().unwrap_or_default().map(|corner| (corner + mesh.origin()).to_array());
    let rig = loaded.rig();
    let camera = &rig.camera.sensor;
    let heading = |vehicle: Pose| {
        let ahead: DVec2 = vehicle.rotate(DVec3::X).truncate();
        libm::atan2(ahead.y, ahead.x).to_degrees()
    };
    json!({
        "name": loaded.name,
        "sha256": loaded.scene_sha256,
        "ground": { "faces": mesh.faces().len(), "low_m": low, "high_m": high },
        "vehicle": loaded.standing_vehicle().map(|vehicle| json!({
            "position_m": vehicle.position.to_array(), "heading_deg": heading(vehicle),
        })),
        "camera": {
            "aim": Aim::of(&rig.camera.vehicle_from_sensor).json(),
            "width_px": camera.width,
            "height_px": camera.height,
            "fx_fy_px": focal_px(camera),
            "cx_cy_px": camera.principal_point.map(|at| at - 0.5),
            "principal_point_px": camera.principal_point,
            "field_of_view_deg": field_of_view_deg(camera),
            "max_range_m": camera.max_range,
        },
        "beams": rig.beams.iter().map(|beam| json!({
            "aim": Aim::of(&beam.vehicle_from_sensor).json(),
            "columns": beam.sensor.columns,
            "rows": beam.sensor.rows,
            "fan_deg": fan_deg(&beam.sensor),
            "thickness_mm": 1e3 * beam.sensor.thickness,
            "power_w": beam.sensor.power,
            "max_range_m": beam.sensor.max_range,
        })).collect::<Vec<_>>(),
    })
}

#[cfg(test)]
mod tests {
    use raypencil_scene_io::{Overrides, load};

    use super::*;

    #[test]
    fn the_default_scene_has_the_numbers_of_its_file() {
        let words = scene_words(&load("pyramids", &Overrides::default()).unwrap());
        for line in [
            "vehicle   at (0, 0, 0) m of the global frame, heading 0 deg",
            "camera    at (0.3, 0, 1.5) m, 20 deg down, 0 deg left, roll 0 deg",
            // 2 atan(512 x 9 um / 8 mm) = 59.88 deg; 8 mm / 9 um = 888.89 pixels.
            "1024 x 1024 pixels of 9 x 9 um, focal length 8 mm: 59.88",
            "fx 888.888889, fy 888.888889, cx 511.5, cy 511.5 px, as OpenCV counts: 512, 512 from the image's corner",
            "aperture 2 mm; range 20 m",
            "beam 0    at (0.3, 0, 1.8) m, 31 deg down, 0 deg left",
            "beam 1    at (0.3, 0, 2) m, 22 deg down, 0 deg left",
            "fan 60 deg, 5 mm thick, 1024 x 16 pencils on a grid at 100 mm",
            "1 W at 810 nm, profile paper; range 20 m",
            "air       attenuation 0 1/m; flux model radiometric",
        ] {
            assert!(words.contains(line), "{line} is not in\n{words}");
        }
    }

    #[test]
    fn a_turned_rig_on_a_turned_vehicle_keeps_its_own_angles() {
        let text = "version = 1\n[vehicle]\nposition_m = [1, -2]\nheading_deg = 40\n[camera]\nposition_m = [0.3, 0.2, \
                    1.5]\npitch_down_deg = 25\nyaw_left_deg = -10\nroll_right_deg = 7\nwidth_px = 100\nheight_px = 50\npixel_pitch_um = [9, \
                    12]\nprincipal_point_px = [40, 30]\n";
        let loaded = raypencil_scene_io::load_text(text, "turned").unwrap();
        let words = scene_words(&loaded);
        assert!(words.contains("heading 40 deg"), "{words}");
        assert!(
            words.contains("camera    at (0.3, 0.2, 1.5) m, 25 deg down, -10 deg left, roll 7 deg"),
            "{words}"
        );
        assert!(words.contains("cx 39.5, cy 29.5 px, as OpenCV counts: 40, 30 from"), "{words}");
        let json = scene_json(&loaded);
        let down = json["camera"]["aim"]["pitch_down_deg"].as_f64().unwrap();
        assert!((down - 25.0).abs() < 1e-9, "{down}");
        assert_eq!(json["camera"]["cx_cy_px"], json!([39.5, 29.5]));
    }
}
