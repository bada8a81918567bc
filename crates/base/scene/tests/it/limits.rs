//! What is refused, and what is just accepted: each limit from its field's documentation.

use std::sync::Arc;

use glam::{DQuat, DVec3};
use raypencil_scene::{
    Atmosphere, Beam, Camera, Filter, FluxModel, Lens, Material, Mesh, Mounted, Pose, Profile, Scene,
    check_count, rig,
};

/// A value one part in a million beyond `limit`, away from `inside`.
fn beyond(limit: f64, inside: f64) -> f64 {
    let step = if limit == 0.0 { 1e-6 } else { 1e-6 * limit.abs() };
    if inside < limit { limit + step } else { limit - step }
}

/// Both limits are accepted; what lies beyond one is refused, and the message begins with the field's path.
#[track_caller]
fn holds_its_limits(path: &str, [low, high]: [f64; 2], refusal_of: impl Fn(f64) -> Option<String>) {
    for (limit, inside) in [(low, high), (high, low)] {
        assert_eq!(refusal_of(limit), None, "{path} = {limit}");
        let refusal =
            refusal_of(beyond(limit, inside)).unwrap_or_else(|| panic!("{path} beyond {limit} is accepted"));
        assert!(refusal.starts_with(&format!("{path} is ")), "{refusal}");
    }
    assert!(refusal_of(f64::NAN).is_some(), "{path} = NaN");
}

/// A field's path, its limits, and how it is set.
type Limited<S> = (&'static str, [f64; 2], fn(&mut S, f64));

#[test]
fn limits_of_the_camera() {
    let refusal = |change: &dyn Fn(&mut Camera)| {
        let mut camera = rig::camera(4, 2, 0.0625, 0.5);
        change(&mut camera);
        camera.validate("camera").err().map(|error| error.to_string())
    };
    for (axis, name) in ["x", "y"].into_iter().enumerate() {
        holds_its_limits(&format!("camera.pixel_pitch.{name}"), [1e-8, 1e-1], |value| {
            refusal(&|camera| camera.pixel_pitch[axis] = value)
        });
        holds_its_limits(&format!("camera.principal_point.{name}"), [-1e6, 1e6], |value| {
            refusal(&|camera| camera.principal_point[axis] = value)
        });
    }
    let simple: [Limited<Camera>; 4] = [
        ("camera.focal_length", [1e-5, 1e2], |camera, value| camera.focal_length = value),
        ("camera.aperture", [1e-6, 1e1], |camera, value| camera.aperture = value),
        ("camera.lens.transmission", [0.0, 1.0], |camera, value| camera.lens.transmission = value),
        ("camera.max_range", [1e-3, 1e7], |camera, value| camera.max_range = value),
    ];
    for (path, limits, set) in simple {
        holds_its_limits(path, limits, |value| refusal(&|camera| set(camera, value)));
    }
    let filter = |centre, width, index| {
        let filter = Filter::Interference { centre, width, index };
        refusal(&|camera| camera.lens = Lens { filter, ..Lens::CLEAR })
    };
    holds_its_limits("camera.lens.filter.centre", [1e-8, 1e-3], |value| filter(value, 1e-8, 2.0));
    holds_its_limits("camera.lens.filter.width", [1e-12, 1e-3], |value| filter(8e-7, value, 2.0));
    holds_its_limits("camera.lens.filter.index", [1.0, 10.0], |value| filter(8e-7, 1e-8, value));
}

#[test]
fn limits_of_a_beam() {
    let refusal = |change: &dyn Fn(&mut Beam)| {
        let mut beam = rig::beam(4, 2, [0.0625, 0.004], 0.125);
        change(&mut beam);
        beam.validate("beam 0").err().map(|error| error.to_string())
    };
    let simple: [Limited<Beam>; 5] = [
        ("beam 0.thickness", [1e-6, 1e2], |beam, value| beam.thickness = value),
        ("beam 0.max_range", [1e-3, 1e7], |beam, value| beam.max_range = value),
        ("beam 0.power", [0.0, 1e6], |beam, value| beam.power = value),
        ("beam 0.wavelength", [1e-8, 1e-3], |beam, value| beam.wavelength = value),
        ("beam 0.profile.half_width", [1e-6, 1e3], |beam, value| {
            beam.profile = Profile::Gaussian { half_width: value };
        }),
    ];
    for (path, limits, set) in simple {
        holds_its_limits(path, limits, |value| refusal(&|beam| set(beam, value)));
    }
    holds_its_limits("beam 0.grid_distance", [1e-4, 1e2], |value| {
        refusal(&|beam| {
            beam.grid_distance = value;
            beam.half_width = value;
        })
    });
    // Half widths per metre of grid distance; at 1/8 m both products are exact or rounded as the check rounds them.
    holds_its_limits("beam 0.half_width", [0.125e-6, 0.125 * 1.146e3], |value| {
        refusal(&|beam| beam.half_width = value)
    });
}

#[test]
fn limits_of_a_raster() {
    // (columns, rows) and the field that is refused: 1 to 2^20 on each side, at most 2^26 cells.
    let cases = [
        ((1, 1), None),
        ((1 << 20, 64), None),
        ((64, 1 << 20), None),
        ((8192, 8192), None),
        ((0, 5), Some("camera.width is 0: expected 1 to 1048576")),
        ((5, 0), Some("camera.height is 0: expected 1 to 1048576")),
        (((1 << 20) + 1, 1), Some("camera.width is 1048577: expected 1 to 1048576")),
        ((1, (1 << 20) + 1), Some("camera.height is 1048577: expected 1 to 1048576")),
        ((8193, 8192), Some("camera.width x height is 8193 x 8192: expected at most 67108864 cells")),
    ];
    for ((width, height), expected) in cases {
        let refusal = Camera { width, height, ..rig::default_camera() }.validate("camera").err();
        assert_eq!(refusal.map(|error| error.to_string()).as_deref(), expected);
        let beam = Beam { columns: width, rows: height, ..rig::default_beam() };
        assert_eq!(beam.validate("camera").is_err(), expected.is_some(), "{width} x {height}");
    }
}

#[test]
fn limits_of_a_pose() {
    for axis in 0..3 {
        for sign in [-1.0, 1.0] {
            let pose = |coordinate: f64| {
                let mut position = [0.0; 3];
                position[axis] = sign * coordinate;
                Pose::from_position(DVec3::from_array(position)).validate("camera")
            };
            assert!(pose(1e7).is_ok());
            assert!(pose(1e7 + 1.0).is_err());
            assert!(pose(f64::INFINITY).is_err());
        }
    }
    // The length of the quaternion, in each of its four places and in all at once.
    for place in 0..4 {
        let pose = |length: f64| {
            let mut q = [0.0; 4];
            q[place] = -length;
            Pose { rotation: DQuat::from_array(q), ..Pose::IDENTITY }.validate("camera")
        };
        assert!(pose(1.001e-3).is_ok() && pose(0.999e3).is_ok());
        let refusal = pose(0.999e-3).unwrap_err().to_string();
        assert!(refusal.starts_with("camera.rotation is ("), "{refusal}");
        assert!(pose(1.001e3).is_err() && pose(f64::NAN).is_err());
    }
    // (c, c, c, c) has the length 2c.
    let even = |c: f64| Pose { rotation: DQuat::from_xyzw(c, c, c, c), ..Pose::IDENTITY }.validate("camera");
    assert!(even(0.4995e3).is_ok() && even(0.5005e3).is_err());
    assert!(even(0.5005e-3).is_ok() && even(0.4995e-3).is_err());
}

fn mesh_of(origin: DVec3, far: f32, reflectivity: f64) -> Result<Mesh, String> {
    let sand = Material { name: "sand".into(), reflectivity };
    let corners = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, far]];
    Mesh::new(origin, corners, vec![[0, 1, 2]], vec![0], vec![sand]).map_err(|error| error.to_string())
}

#[test]
fn limits_of_a_mesh() {
    for sign in [-1.0, 1.0] {
        assert!(mesh_of(DVec3::ZERO, sign * 1e7, 0.5).is_ok());
        // The next number of f32 is 1 m farther.
        let refusal = mesh_of(DVec3::ZERO, sign * 10_000_001.0, 0.5).unwrap_err();
        assert!(refusal.starts_with("mesh.vertices[2] is (0, 1, "), "{refusal}");
        assert!(mesh_of(DVec3::new(0.0, f64::from(sign) * 1e12, 0.0), 0.0, 0.5).is_ok());
        let refusal = mesh_of(DVec3::new(0.0, f64::from(sign) * 1.001e12, 0.0), 0.0, 0.5).unwrap_err();
        assert!(refusal.starts_with("mesh.origin is "), "{refusal}");
    }
    assert!(mesh_of(DVec3::new(f64::NAN, 0.0, 0.0), 0.0, 0.5).is_err());
    assert!(mesh_of(DVec3::ZERO, 0.0, 0.0).is_ok() && mesh_of(DVec3::ZERO, 0.0, 1.0).is_ok());
    assert!(mesh_of(DVec3::ZERO, 0.0, -0.001).is_err() && mesh_of(DVec3::ZERO, 0.0, 1.001).is_err());
}

#[test]
fn limits_of_a_scene() {
    let scene = |beams: usize, attenuation: f64| {
        let (camera, mounted) = rig::default_rig(64, DVec3::ZERO, 0.0);
        let beams = vec![mounted[0]; beams];
        let mesh = Arc::new(mesh_of(DVec3::ZERO, 0.0, 0.5).unwrap());
        Scene::new(mesh, camera, beams, Atmosphere { attenuation }, FluxModel::Eq1)
            .err()
            .map(|error| error.to_string())
    };
    assert_eq!(scene(64, 0.0), None);
    assert_eq!(scene(65, 0.0).as_deref(), Some("beams is 65: expected at most 64"));
    holds_its_limits("atmosphere.attenuation", [0.0, 1e3], |value| scene(2, value));
}

#[test]
fn a_scene_refuses_the_pose_and_numbers_of_each_sensor() {
    let (camera, beams) = rig::default_rig(64, DVec3::ZERO, 0.0);
    let refusal = |camera: Mounted<Camera>, beams: Vec<Mounted<Beam>>| {
        let mesh = Arc::new(mesh_of(DVec3::ZERO, 0.0, 0.5).unwrap());
        let scene = Scene::new(mesh, camera, beams, Atmosphere { attenuation: 0.0 }, FluxModel::Radiometric);
        scene.unwrap_err().field
    };
    let nowhere = Pose::from_position(DVec3::new(f64::NAN, 0.0, 0.0));
    assert_eq!(refusal(Mounted { scene_from_sensor: nowhere, ..camera }, beams.clone()), "camera.position");
    let mut blind = camera;
    blind.sensor.aperture = 0.0;
    assert_eq!(refusal(blind, beams.clone()), "camera.aperture");
    let mut lost = beams.clone();
    lost[1].scene_from_sensor = nowhere;
    assert_eq!(refusal(camera, lost), "beam 1.position");
    let mut dark = beams;
    dark[1].sensor.power = -1.0;
    assert_eq!(refusal(camera, dark), "beam 1.power");
}

#[test]
fn a_count_is_refused_beyond_its_limits() {
    let refusal = |count| check_count(|| "steps".into(), count, 2, 5).err().map(|error| error.to_string());
    assert_eq!([2, 5].map(refusal), [None, None]);
    assert_eq!(refusal(1).as_deref(), Some("steps is 1: expected 2 to 5"));
    assert_eq!(refusal(6).as_deref(), Some("steps is 6: expected 2 to 5"));
}
