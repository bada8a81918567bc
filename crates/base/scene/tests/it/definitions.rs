//! The definitions by numbers that are worked out by hand: rays, rigs, rasters, tables of names.

use std::sync::Arc;

use glam::DVec3;
use raypencil_scene::{
    Atmosphere, FaceId, FluxModel, Hit, HitQuantity, HitRasterMut, HitValue, Image, Material, Maybe, Mesh,
    Mounted, Pixel, Place, Pose, Precision, Quantities, RenderOutput, Request, Return, Returns, Sampling,
    Scene, SensorId, SensorMap, Switches, UnknownSwitch, rig,
};

fn scene() -> Scene {
    let sand = Material { name: "sand".into(), reflectivity: 0.25 };
    let corners = vec![[-4.0, 1.0, -2.0], [8.0, -3.0, 0.5], [2.0, 5.0, -7.0]];
    let mesh =
        Mesh::new(DVec3::new(1000.0, 0.0, 0.0), corners, vec![[0, 1, 2]], vec![0], vec![sand]).unwrap();
    let mounted = |x, y, z| Pose { position: DVec3::new(x, y, z), ..Pose::VEHICLE_FROM_FORWARD_SENSOR };
    let camera =
        Mounted { scene_from_sensor: mounted(1.0, 2.0, 3.0), sensor: rig::camera(4, 2, 0.0625, 0.5) };
    let beam = |max_range| raypencil_scene::Beam { max_range, ..rig::beam(8, 2, [0.0625, 0.25], 0.125) };
    let beams = vec![
        Mounted { scene_from_sensor: mounted(0.0, 0.0, 4.0), sensor: beam(30.0) },
        Mounted { scene_from_sensor: mounted(5.0, 6.0, 7.0), sensor: beam(40.0) },
    ];
    Scene::new(Arc::new(mesh), camera, beams, Atmosphere { attenuation: 0.125 }, FluxModel::Eq1).unwrap()
}

#[test]
fn a_scene_gives_back_what_it_was_built_of() {
    let scene = scene();
    assert_eq!(scene.mesh().vertices(), [[-4.0, 1.0, -2.0], [8.0, -3.0, 0.5], [2.0, 5.0, -7.0]]);
    assert_eq!((scene.mesh().faces(), scene.mesh().face_materials()), (&[[0, 1, 2]][..], &[0][..]));
    assert_eq!(scene.mesh().materials()[0].name, "sand");
    assert_eq!(scene.mesh().origin(), DVec3::new(1000.0, 0.0, 0.0));
    assert_eq!(scene.mesh().zero_area_faces(), 0);
    assert_eq!(scene.mesh().bounds(), Some([DVec3::new(-4.0, -3.0, -7.0), DVec3::new(8.0, 5.0, 0.5)]));
    assert_eq!(Mesh::new(DVec3::ZERO, vec![], vec![], vec![], vec![]).unwrap().bounds(), None);
    assert_eq!(scene.camera().scene_from_sensor.position, DVec3::new(1.0, 2.0, 3.0));
    assert_eq!(scene.beams()[1].scene_from_sensor.position, DVec3::new(5.0, 6.0, 7.0));
    assert_eq!(scene.atmosphere().attenuation, 0.125);
    assert_eq!(scene.flux_model(), FluxModel::Eq1);
    let sensors: Vec<SensorId> = scene.sensors().collect();
    assert_eq!(sensors, [SensorId::Camera, SensorId::Beam(0), SensorId::Beam(1)]);
    assert_eq!(
        sensors.iter().map(|&id| scene.size(id).unwrap()).collect::<Vec<_>>(),
        [(4, 2), (8, 2), (8, 2)]
    );
    let ranges: Vec<f64> = sensors.iter().map(|&id| scene.max_range(id).unwrap()).collect();
    assert_eq!(ranges, [1e3, 30.0, 40.0]);
    assert_eq!((scene.size(SensorId::Beam(2)), scene.max_range(SensorId::Beam(2))), (None, None));
}

#[test]
fn faces_without_area_are_counted_wherever_they_are() {
    let corners = vec![[1.0, 1.0, 0.0], [2.0, 1.0, 0.0], [3.0, 1.0, 0.0], [3.0, 2.0, 0.0]];
    let sand = Material { name: "sand".into(), reflectivity: 0.25 };
    // The first three corners lie on one line, in any order; the others do not.
    let faces = vec![[0, 1, 2], [1, 2, 0], [2, 1, 0], [0, 1, 3], [1, 2, 3]];
    let mesh = Mesh::new(DVec3::ZERO, corners, faces, vec![0; 5], vec![sand]).unwrap();
    assert_eq!(mesh.zero_area_faces(), 3);
}

#[test]
fn rays_of_a_scene() {
    // A sensor that looks forward has z along x, x along -y and y along -z (REP-103).
    let scene = scene();
    // Pixel (3, 0): ((3.5 - 2) / 16, (0.5 - 1) / 16, 1/2) on the sensor.
    let ray = scene.ray(SensorId::Camera, 3, 0).unwrap();
    assert_eq!(ray.origin, DVec3::new(1.0, 2.0, 3.0));
    assert_eq!(ray.direction, DVec3::new(0.5, -0.09375, 0.03125));
    // Pencil (7, 1): x = 3.5 / 16 on the grid, and it starts a quarter of T = 1/2 m below the middle.
    let ray = scene.ray(SensorId::Beam(1), 7, 1).unwrap();
    assert_eq!(ray.origin, DVec3::new(5.0, 6.0, 7.0 - 0.125));
    assert_eq!(ray.direction, DVec3::new(0.125, -0.21875, 0.0));
    // The first cell outside, in each direction.
    for (sensor, i, j) in [(SensorId::Camera, 4, 0), (SensorId::Camera, 0, 2), (SensorId::Beam(0), 8, 0)] {
        assert_eq!(scene.ray(sensor, i, j), None);
    }
    assert_eq!(scene.ray(SensorId::Beam(0), 0, 2), None);
    assert_eq!(scene.ray(SensorId::Beam(2), 0, 0), None);
}

#[test]
fn rows_of_a_beam_are_halves_of_its_pitch_apart_from_the_middle() {
    // Four rows over T = 2 m: y = T (2j + 1 - 4) / 8 = -3/4, -1/4, 1/4, 3/4 m.
    let beam = rig::beam(2, 4, [0.5, 0.5], 0.25);
    let rows: Vec<f64> = (0..4).map(|j| beam.origin(j).y).collect();
    assert_eq!(rows, [-0.75, -0.25, 0.25, 0.75]);
    // w = 0.5 * 2 * 0.5 m: x = w (2i + 1 - 2) / 2.
    assert_eq!((beam.thickness, beam.half_width), (2.0, 0.5));
    assert_eq!((beam.direction(0).x, beam.direction(1).x), (-0.25, 0.25));
}

#[test]
fn a_pose_turns_by_its_formula() {
    // q = (x 1, y 2, z 3, w 4), |q|^2 = 30, v = (1, 0, 0): u x v = (0, 3, -2), u x (u x v) = (-13, 2, 3),
    // and v + 2 (4 (0, 3, -2) + (-13, 2, 3)) / 30 = (1 - 26/30, 28/30, -10/30).
    let rotation = glam::DQuat::from_xyzw(1.0, 2.0, 3.0, 4.0);
    let pose = Pose { position: DVec3::new(7.0, 8.0, 9.0), rotation };
    let turned = DVec3::new(4.0, 28.0, -10.0) / 30.0;
    assert!((pose.rotate(DVec3::X) - turned).length() < 1e-15);
    assert!((pose * DVec3::X - DVec3::new(7.0, 8.0, 9.0) - turned).length() < 1e-14);
    assert!((pose.inverse() * (pose * DVec3::X) - DVec3::X).length() < 1e-14);
    let twice = pose * pose;
    assert!((twice * DVec3::X - pose * (pose * DVec3::X)).length() < 1e-13);
    // A quarter turn about z: (0, 0, sin 45, cos 45).
    let quarter = Pose::from_axis_angle(DVec3::Z, std::f64::consts::FRAC_PI_2).rotation;
    let half = 0.5_f64.sqrt();
    assert!((quarter - glam::DQuat::from_xyzw(0.0, 0.0, half, half)).length() < 1e-15);
}

#[test]
fn the_default_rig_in_numbers() {
    let (camera, beams) = rig::default_rig(1, DVec3::ZERO, 0.0);
    assert_eq!(camera.sensor, rig::default_camera());
    assert_eq!(beams[0].sensor, rig::default_beam());
    assert_eq!(camera.sensor.principal_point, [512.0, 512.0]);
    assert_eq!(camera.sensor.pixel_pitch, [9e-6, 9e-6]);
    assert_eq!((camera.sensor.focal_length, camera.sensor.max_range), (8e-3, 20.0));
    // tan 30 degrees = 1 / sqrt 3.
    assert!((beams[0].sensor.half_width - 0.1 / 3.0_f64.sqrt()).abs() < 1e-16);

    // Four times coarser, the image covers the same angle; the beams keep 16 / 4 rows.
    let (coarse, beams) = rig::default_rig(4, DVec3::new(10.0, 20.0, 0.5), std::f64::consts::FRAC_PI_2);
    assert_eq!((coarse.sensor.width, coarse.sensor.height), (256, 256));
    assert_eq!(coarse.sensor.pixel_pitch, [36e-6, 36e-6]);
    assert_eq!((coarse.sensor.focal_length, coarse.sensor.max_range), (8e-3, 20.0));
    assert_eq!((beams[1].sensor.columns, beams[1].sensor.rows, beams[1].sensor.max_range), (256, 4, 20.0));
    // A vehicle that is turned to the left by 90 degrees has its mounts 0.3 m along y.
    let expected = DVec3::new(10.0, 20.3, 2.0);
    assert!((coarse.scene_from_sensor.position - expected).length() < 1e-14);
    // Its camera looks along y and 20 degrees down.
    let (sin, cos) = libm::sincos(20.0_f64.to_radians());
    assert!((coarse.scene_from_sensor.rotate(DVec3::Z) - DVec3::new(0.0, cos, -sin)).length() < 1e-15);
    let heights: Vec<f64> = beams.iter().map(|beam| beam.scene_from_sensor.position.z).collect();
    assert_eq!(heights, [2.3, 2.5]);
    // At a scale of 16 a beam keeps two rows.
    assert_eq!(rig::default_rig(16, DVec3::ZERO, 0.0).1[0].sensor.rows, 2);
}

#[test]
fn the_rig_of_one_sensor_in_numbers() {
    let camera = rig::camera(6, 4, 0.25, 2.0);
    assert_eq!((camera.principal_point, camera.pixel_pitch), ([3.0, 2.0], [0.25, 0.25]));
    assert_eq!((camera.aperture, camera.max_range), (2e-3, 1e3));
    let mounted = rig::pitched(DVec3::new(1.0, 2.0, 3.0), 0.5, "sensor");
    assert_eq!((mounted.scene_from_sensor.position, mounted.sensor), (DVec3::new(1.0, 2.0, 3.0), "sensor"));
    let forward = mounted.scene_from_sensor.rotate(DVec3::Z);
    assert!((forward - DVec3::new(libm::cos(0.5), 0.0, -libm::sin(0.5))).length() < 1e-15);
}

#[test]
fn cells_of_an_image() {
    let mut image = Image::filled(3, 2, 0);
    assert_eq!((image.width(), image.height(), image.cells().len()), (3, 2, 6));
    for j in 0..2 {
        for i in 0..3 {
            image.set(i, j, 10 * j + i);
        }
    }
    assert_eq!(image.cells(), [0, 1, 2, 10, 11, 12]);
    assert_eq!((image.at(0, 1), image.at(2, 0)), (10, 2));
    image.cells_mut()[4] = 99;
    assert_eq!(image.at(1, 1), 99);
    for (i, j) in [(3, 0), (0, 2)] {
        assert!(std::panic::catch_unwind(|| image.at(i, j)).is_err());
        assert!(std::panic::catch_unwind(|| image.clone().set(i, j, 0)).is_err());
    }
}

#[test]
fn nothing_is_told_from_every_value() {
    assert_eq!(Maybe::some(FaceId(0)).get(), Some(FaceId(0)));
    assert_eq!(Maybe::<FaceId>::NONE.get(), None);
    assert_eq!(Maybe::some(DVec3::Y).get(), Some(DVec3::Y));
    assert_eq!(Maybe::<DVec3>::NONE.get(), None);
    let pixel = Pixel { i: 0, j: 7 };
    assert_eq!(Maybe::some(pixel).get(), Some(pixel));
    assert_eq!(Maybe::<Pixel>::NONE.get(), None);
    // NaN means nothing, and nothing equals nothing.
    assert_eq!(Maybe::<f64>::NONE, Maybe::NONE);
    assert_ne!(Maybe::some(1.0), Maybe::NONE);
    assert_ne!(Maybe::some(1.0), Maybe::some(2.0));
    assert_eq!(Maybe::from(Some(2.0)), Maybe::some(2.0));
    assert_eq!(Maybe::<f64>::from(None), Maybe::NONE);
}

const HIT: Hit = Hit {
    face: FaceId(5),
    range: 2.0,
    point: DVec3::new(1.0, 2.0, 3.0),
    normal: DVec3::Z,
    depth: 1.5,
    cos_incidence: 0.5,
};

#[test]
fn a_hit_is_read_where_it_was_written() {
    let mut map = SensorMap::empty(SensorId::Beam(1), 3, 2, Quantities::ALL);
    assert_eq!((map.sensor, map.width, map.height, map.cell_count()), (SensorId::Beam(1), 3, 2, 6));
    assert_eq!(map.hit(2, 1), None);
    let mut rows = map.rows_mut();
    assert_eq!(rows.iter().map(|row| row.j).collect::<Vec<_>>(), [0, 1]);
    rows[1].put(2, &HIT);
    assert_eq!(map.hit(2, 1), Some(HIT));
    for (i, j) in [(0, 0), (1, 0), (2, 0), (0, 1), (1, 1)] {
        assert_eq!(map.hit(i, j), None);
    }
    for quantity in HitQuantity::ALL {
        let raster = map.raster(quantity).unwrap();
        assert_eq!((raster.at(2, 1), raster.at(1, 1)), (Some(HIT.value(quantity)), None));
        match map.raster_mut(quantity) {
            HitRasterMut::Scalar(raster) => *raster = None,
            HitRasterMut::Vector(raster) => *raster = None,
        }
        // One quantity less, and there is no whole hit.
        assert!(map.raster(quantity).is_none() && map.hit(2, 1).is_none());
    }

    let mut map = SensorMap::empty(SensorId::Camera, 3, 2, Quantities::RANGE_MAP);
    map.rows_mut()[0].put(1, &HIT);
    assert_eq!(map.range.as_ref().unwrap().at(1, 0).get(), Some(2.0));
    assert_eq!(map.face.as_ref().unwrap().at(1, 0).get(), Some(FaceId(5)));
    assert!(
        map.depth.is_none() && map.point.is_none() && map.normal.is_none() && map.cos_incidence.is_none()
    );
}

#[test]
fn values_of_a_hit() {
    let values = HitQuantity::ALL.map(|quantity| HIT.value(quantity));
    let [range, depth, point, normal, cosine] = values;
    assert_eq!((range.scalar(), range.vector()), (Some(2.0), None));
    assert_eq!((depth, cosine), (HitValue::Scalar(1.5), HitValue::Scalar(0.5)));
    assert_eq!((point.scalar(), point.vector()), (None, Some(DVec3::new(1.0, 2.0, 3.0))));
    assert_eq!(normal, HitValue::Vector(DVec3::Z));
    assert_eq!((range.components(), point.components()), (&[2.0][..], &[1.0, 2.0, 3.0][..]));

    let channels: [&[&str]; 5] =
        [&["range.T"], &["depth.Z"], &["P.X", "P.Y", "P.Z"], &["N.X", "N.Y", "N.Z"], &["incidence.V"]];
    assert_eq!(HitQuantity::ALL.map(HitQuantity::channels), channels);
    assert_eq!(HitQuantity::ALL.map(HitQuantity::unit), ["m", "m", "m", "1", "1"]);
    assert_eq!(HitQuantity::ALL.map(HitQuantity::is_length), [true, true, false, false, false]);
    assert_eq!(HitQuantity::ALL.map(HitQuantity::is_vector), [false, false, true, true, false]);
    assert_eq!(HitQuantity::ALL.map(HitQuantity::is_of_point), [true, true, true, false, false]);
    assert_eq!(HitQuantity::COUNT, 5);
}

#[test]
fn a_return_is_read_where_it_was_written() {
    let pixel = Pixel { i: 3, j: 4 };
    let back = Return {
        visible: true,
        pixel: Some(pixel),
        depth: -2.0,
        cos_off_axis: 0.75,
        cos_view: -0.5,
        flux: 1e-9,
    };
    let mut returns = Returns::empty(3, 2);
    assert_eq!((returns.columns, returns.rows), (3, 2));
    assert_eq!(returns.flux.as_ref().unwrap().cells(), [0.0; 6]);
    assert_eq!(returns.visible.as_ref().unwrap().cells(), [false; 6]);
    returns.put(1, 1, &back);
    assert_eq!(returns.visible.as_ref().unwrap().cells(), [false, false, false, false, true, false]);
    assert_eq!(returns.pixel.as_ref().unwrap().at(1, 1).get(), Some(pixel));
    assert_eq!(returns.depth.as_ref().unwrap().at(1, 1).get(), Some(-2.0));
    assert_eq!(returns.cos_off_axis.as_ref().unwrap().at(1, 1).get(), Some(0.75));
    assert_eq!(returns.cos_view.as_ref().unwrap().at(1, 1).get(), Some(-0.5));
    assert_eq!(returns.flux.as_ref().unwrap().at(1, 1), 1e-9);
    assert_eq!(returns.depth.as_ref().unwrap().at(0, 1).get(), None);

    let mut none = Returns::unsupported(3, 2);
    none.put(1, 1, &back);
    assert_eq!(none, Returns::unsupported(3, 2));
    assert_eq!((none.columns, none.rows, none.flux), (3, 2, None));
}

#[test]
fn maps_of_an_output() {
    let map = |sensor| SensorMap::empty(sensor, 1, 1, Quantities::NONE);
    let ids = [SensorId::Camera, SensorId::Beam(0), SensorId::Beam(1)];
    let [camera, first, second] = ids.map(map);
    let output = RenderOutput {
        camera: Some(camera),
        beams: vec![first, second],
        returns: vec![],
        flux: vec![],
        stages: vec![],
    };
    for id in ids {
        assert_eq!(output.map(id).unwrap().sensor, id);
    }
    assert!(output.map(SensorId::Beam(2)).is_none());
    assert_eq!(output.maps().map(|map| map.sensor).collect::<Vec<_>>(), ids);
}

#[test]
fn requests_ask_for_what_they_say() {
    let parts = |request: Request| (request.camera, request.beams, request.returns, request.quantities);
    assert_eq!(parts(Request::EVERYTHING), (true, true, true, Quantities::ALL));
    assert_eq!(parts(Request::MAPS), (true, true, false, Quantities::ALL));
    assert_eq!(parts(Request::FLUX), (false, false, true, Quantities::NONE));
    assert_eq!(Request::FLUX.sampling, Sampling::Centres);
}

#[test]
fn words_and_constants() {
    assert_eq!(Place { sensor: SensorId::Camera, i: 412, j: 300 }.to_string(), "camera pixel 412,300");
    assert_eq!(FluxModel::Eq1.word(), "eq1");
    assert_eq!((Switches::EXACT.count(), Switches::PAPER.count()), (0, 5));
    assert_eq!(FluxModel::Eq1.other(), FluxModel::Radiometric);
    assert_eq!(
        UnknownSwitch("facings".into()).to_string(),
        "no switch is called \"facings\"; there are beam-edges, skip-rules, facing, extent, place"
    );
    // Half a unit in the last place of 1: 53 and 24 bits.
    assert_eq!(Precision::F64.unit_roundoff, 1.0 / 9_007_199_254_740_992.0);
    assert_eq!(Precision::F32.unit_roundoff, 1.0 / 16_777_216.0);
}

#[test]
fn a_jittered_offset_is_a_word_of_philox_in_a_cell() {
    // Key and counter 0: the words 0x6627e8d5 and 0xe169c58d (known answers of Random123), each over 2^32, from the
    // middle of its step, minus a half.
    let [x, y] = Sampling::Jittered { seed: 0 }.offset(0, 0, 0);
    let expected = |word: u32| (f64::from(word) + 0.5) / 4_294_967_296.0 - 0.5;
    assert_eq!([x, y], [expected(0x6627_e8d5), expected(0xe169_c58d)]);
    // The upper half of the seed is the second word of the key.
    let jittered = Sampling::Jittered { seed: 0x299f_31d0_a409_3822 };
    let [x, y, _, _] = raypencil_scene::philox([3, 4, 2, 0], [0xa409_3822, 0x299f_31d0]);
    assert_eq!(jittered.offset(2, 3, 4), [expected(x), expected(y)]);
}
