//! Each rule on a scene that deserves its warning, and on one that does not.

use std::sync::Arc;

use glam::DVec3;
use raypencil_scene::{Atmosphere, Camera, FluxModel, Material, Mesh, Pose, Scene, SensorId, rig};
use raypencil_survey::{
    Facing, SensorHits, TerrainShape, Warning, WarningCode, facings, few_hits, mostly_backs, no_hits,
    principal_point_off_centre, principal_point_outside, terrain_on_its_side, terrain_too_large,
    vehicle_above_ground, vehicle_below_ground, warnings,
};

/// The pyramids: 40 m wide, their tops about 1 m high.
fn pyramids() -> Mesh {
    raypencil_terrain::builtin("pyramids", 0.25).expect("a built-in name").into_mesh().expect("a mesh")
}

/// A mesh with each vertex (global) and each face changed.
fn changed(mesh: &Mesh, vertex: impl Fn(DVec3) -> DVec3, face: impl Fn([u32; 3]) -> [u32; 3]) -> Mesh {
    let global = |v: &[f32; 3]| vertex(DVec3::from_array(v.map(f64::from)) + mesh.origin());
    let vertices: Vec<DVec3> = mesh.vertices().iter().map(global).collect();
    let faces = mesh.faces().iter().map(|&corners| face(corners)).collect();
    Mesh::from_global(&vertices, faces, mesh.face_materials().to_vec(), mesh.materials().to_vec())
        .expect("a mesh")
}

/// A strip of ground along x, of two triangles per square of `side` metres, faces up.
fn strip(squares: u32, side: f64) -> Mesh {
    let vertices: Vec<DVec3> =
        (0..=squares).flat_map(|k| [0.0, 1.0].map(|y| DVec3::new(f64::from(k), y, 0.0) * side)).collect();
    let faces = (0..squares).flat_map(|k| {
        let [a, b, c, d] = [2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1];
        [[a, b, c], [a, c, d]]
    });
    let faces: Vec<_> = faces.collect();
    let (kinds, sand) = (vec![0; faces.len()], Material { name: "sand".into(), reflectivity: 0.25 });
    Mesh::from_global(&vertices, faces, kinds, vec![sand]).expect("a mesh")
}

fn scene_at(mesh: Mesh, position: DVec3) -> Scene {
    let (camera, beams) = rig::default_rig(32, position, 0.0);
    Scene::new(Arc::new(mesh), camera, beams, Atmosphere { attenuation: 0.0 }, FluxModel::Radiometric)
        .expect("a scene")
}

fn codes(warnings: &[Warning]) -> Vec<(WarningCode, Option<SensorId>)> {
    warnings.iter().map(|warning| (warning.code, warning.sensor)).collect()
}

#[test]
fn the_built_in_scenes_deserve_none() {
    for name in raypencil_terrain::BUILTIN_NAMES {
        let mesh = raypencil_terrain::builtin(name, 0.25).unwrap().into_mesh().unwrap();
        let scene = scene_at(mesh, DVec3::ZERO);
        assert_eq!(warnings(&scene, Some(&Pose::IDENTITY), None), [], "{name}");
    }
}

#[test]
fn hits_are_counted_and_few_are_told_from_none() {
    let of = |hits| SensorHits { sensor: SensorId::Beam(1), rays: 20_000, hits };
    let said = |hits| (no_hits(of(hits)).map(|w| w.code), few_hits(of(hits)).map(|w| w.code));
    assert_eq!(said(0), (Some(WarningCode::NoHits), None));
    // One per cent of 20,000 rays are 200.
    assert_eq!(said(1), (None, Some(WarningCode::FewHits)));
    assert_eq!(said(199), (None, Some(WarningCode::FewHits)));
    assert_eq!(said(200), (None, None));
    let warning = few_hits(of(150)).unwrap();
    assert_eq!(warning.to_string(), "beam-1: only 150 of its 20,000 rays hit the terrain, 0.750 %.");
}

#[test]
fn a_small_target_gives_few_hits_on_each_sensor_that_misses_it() {
    // A square of 0.6 m lies on the axis of the camera: 1.5 m below it and 1.5 / tan(20 deg) = 4.12 m ahead. There a
    // pixel of 0.288 mm / 8 mm = 0.036 is 0.036 * 4.39 m = 0.16 m wide and 0.16 m / sin(20 deg) = 0.46 m deep: the square has
    // 2 rows of 4 pixels, 8 of 1024. Beam 0 meets the ground at 1.8 / tan(31 deg) = 3.0 m, beam 1 at
    // 2 / tan(22 deg) = 4.95 m, both beside it.
    let place = DVec3::new(0.3 + 4.12 - 0.3, -0.3, 0.0);
    let target = changed(&strip(1, 0.6), |v| v + place, |face| face);
    let scene = scene_at(target, DVec3::ZERO);
    assert_eq!(SensorHits::of_scene(&scene)[0].hits, 8);
    let found = codes(&warnings(&scene, None, None));
    assert_eq!(
        found,
        [
            (WarningCode::FewHits, Some(SensorId::Camera)),
            (WarningCode::NoHits, Some(SensorId::Beam(0))),
            (WarningCode::NoHits, Some(SensorId::Beam(1)))
        ]
    );
}

#[test]
fn hits_of_a_render_take_the_place_of_traced_ones() {
    let scene = scene_at(pyramids(), DVec3::ZERO);
    let mut hits = SensorHits::of_scene(&scene);
    assert_eq!(hits.iter().map(|of| of.rays).collect::<Vec<_>>(), [32 * 32, 32 * 2, 32 * 2]);
    assert!(hits.iter().all(|of| of.hits > 0));
    hits[2].hits = 0;
    let found = codes(&warnings(&scene, None, Some(&hits)));
    assert_eq!(found, [(WarningCode::NoHits, Some(SensorId::Beam(1)))]);
}

#[test]
fn pixels_of_the_largest_size_are_all_looked_at() {
    // 512 columns in a sample of 128 would be four times as large, beyond the limit of 0.1 m.
    let scene = scene_at(pyramids(), DVec3::ZERO);
    let mut camera = *scene.camera();
    (camera.sensor.width, camera.sensor.height) = (512, 16);
    (camera.sensor.pixel_pitch, camera.sensor.principal_point) = ([0.1; 2], [256.0, 8.0]);
    let air = Atmosphere { attenuation: 0.0 };
    let scene = Scene::new(scene.mesh().clone(), camera, Vec::new(), air, FluxModel::Radiometric).unwrap();
    assert_eq!(facings(&scene)[0].rays, 512 * 16);
}

#[test]
fn reversed_faces_are_met_from_behind() {
    let reversed = changed(&pyramids(), |v| v, |[a, b, c]| [a, c, b]);
    let scene = scene_at(reversed, DVec3::ZERO);
    for facing in facings(&scene) {
        assert!(facing.fronts == 0 && facing.backs > 0, "{facing:?}");
    }
    let found = codes(&warnings(&scene, None, None));
    for sensor in [SensorId::Camera, SensorId::Beam(0), SensorId::Beam(1)] {
        assert!(found.contains(&(WarningCode::BacksFirst, Some(sensor))), "{found:?}");
    }
    // Half and half is no warning, one back more is.
    let of = |backs| mostly_backs(Facing { sensor: SensorId::Camera, rays: 900, fronts: 100, backs });
    assert_eq!((of(100), of(101).map(|warning| warning.code)), (None, Some(WarningCode::BacksFirst)));
    assert_eq!(mostly_backs(Facing { sensor: SensorId::Camera, rays: 900, fronts: 0, backs: 0 }), None);
}

#[test]
fn a_back_behind_a_front_is_not_met_first() {
    // A ceiling's back below the ground does not count, the same back above the ground does.
    let with_sheet = |z: f64| {
        let ground = strip(1, 40.0);
        let vertices = ground.vertices().len() as u32;
        let mut corners: Vec<DVec3> =
            ground.vertices().iter().map(|v| DVec3::from_array(v.map(f64::from))).collect();
        corners.extend(corners.clone().iter().map(|v| *v + DVec3::new(0.0, 0.0, z)));
        let mut faces = ground.faces().to_vec();
        faces.extend(ground.faces().iter().map(|[a, b, c]| [a + vertices, c + vertices, b + vertices]));
        let kinds = vec![0; faces.len()];
        let mesh = Mesh::from_global(&corners, faces, kinds, ground.materials().to_vec()).unwrap();
        facings(&scene_at(mesh, DVec3::new(10.0, 20.0, 0.0)))[0]
    };
    let (below, above) = (with_sheet(-0.5), with_sheet(0.5));
    assert!(below.fronts > 100 && below.backs == 0, "{below:?}");
    assert!(above.backs > 100 && above.fronts == 0, "{above:?}");
}

#[test]
fn a_ground_with_z_up_in_a_y_up_file_stands_on_its_side() {
    // The loader of glTF takes (x, y, z) to (x, -z, y).
    let turned = |mesh: &Mesh| changed(mesh, |v| DVec3::new(v.x, -v.z, v.y), |face| face);
    let on_its_side = |mesh: &Mesh| terrain_on_its_side(&TerrainShape::of(mesh).unwrap());
    for name in raypencil_terrain::BUILTIN_NAMES {
        let mesh = raypencil_terrain::builtin(name, 0.25).unwrap().into_mesh().unwrap();
        assert_eq!(on_its_side(&mesh), None, "{name}");
        assert_eq!(on_its_side(&turned(&mesh)).unwrap().code, WarningCode::TerrainOnItsSide, "{name}");
        // Reversed faces do not hide it.
        let reversed = changed(&turned(&mesh), |v| v, |[a, b, c]| [a, c, b]);
        assert!(on_its_side(&reversed).is_some(), "{name}");
    }
    // A wall across the way of the vehicle is a target: it faces along x.
    let wall = changed(&strip(4, 1.0), |v| DVec3::new(5.0, v.y, v.x), |face| face);
    assert_eq!(on_its_side(&wall), None);
    // A ramp of 3 m height on 1 m width is steep, but it faces more up and sideways than along y.
    let stairs = changed(&strip(3, 1.0), |v| DVec3::new(v.x, v.y, v.x), |face| face);
    assert_eq!(on_its_side(&stairs), None);
}

#[test]
fn a_ground_in_millimetres_is_too_large() {
    let too_large = |mesh: &Mesh| terrain_too_large(&TerrainShape::of(mesh).unwrap(), 20.0);
    let times_1000 = changed(&pyramids(), |v| v * 1e3, |face| face);
    assert_eq!(too_large(&times_1000).unwrap().code, WarningCode::TerrainTooLarge);
    assert_eq!(too_large(&pyramids()), None);
    // 2 km of ground with posts 1 m apart, and 900 m of coarse ground, are just grounds.
    assert_eq!(too_large(&strip(2000, 1.0)), None);
    assert_eq!(too_large(&strip(9, 100.0)), None);
    // Posts 5 m apart are an elevation model, not millimetres: nobody is asked for its unit.
    let said = |spacing: f64| too_large(&strip((2000.0 / spacing) as u32, spacing)).unwrap().to_string();
    assert!(!said(5.0).contains("millimetres") && said(5.0).contains("detail"), "{}", said(5.0));
    assert!(said(100.0).contains("millimetres"), "{}", said(100.0));
    // The same coarse ground over 1.1 km is not; sensors that see 1 km have all the detail they need.
    assert!(too_large(&strip(11, 100.0)).is_some());
    assert_eq!(terrain_too_large(&TerrainShape::of(&strip(11, 100.0)).unwrap(), 1e3), None);
}

#[test]
fn a_vehicle_in_the_air_or_in_the_ground_is_told() {
    // An apex of the pyramids is 1.03 m high at (2.313, -0.827).
    let mesh = pyramids();
    let said = |z: f64| {
        let vehicle = Pose::from_position(DVec3::new(2.313, -0.827, z));
        [vehicle_above_ground(&mesh, &vehicle), vehicle_below_ground(&mesh, &vehicle)]
            .map(|found| found.map(|warning| warning.sentence))
    };
    let at = |words: &str| Some(format!("the vehicle is {words} the ground at its place."));
    assert_eq!(said(1.03), [None, None]);
    assert_eq!(said(1.37), [None, None]);
    assert_eq!(said(1.43), [at("0.40 m above"), None]);
    assert_eq!(said(0.69), [None, None]);
    assert_eq!(said(0.0), [None, at("1.03 m below")]);
    // Where there is no ground, there is no height above it.
    let nowhere = Pose::from_position(DVec3::new(300.0, 0.0, 5.0));
    assert_eq!((vehicle_above_ground(&mesh, &nowhere), vehicle_below_ground(&mesh, &nowhere)), (None, None));
}

#[test]
fn a_principal_point_that_was_left_behind_is_told() {
    let said = |width, height, principal_point| {
        let camera = Camera { width, height, principal_point, ..rig::default_camera() };
        let both = [principal_point_outside(&camera), principal_point_off_centre(&camera)];
        both.into_iter().flatten().map(|warning| warning.code).collect::<Vec<_>>()
    };
    let (outside, off_centre) = (WarningCode::PrincipalPointOutside, WarningCode::PrincipalPointOffCentre);
    assert_eq!(said(1024, 1024, [512.0, 512.0]), []);
    assert_eq!(said(640, 480, [320.0, 240.0]), []);
    // The middle of the default image in larger and in smaller images.
    assert_eq!(said(1280, 1024, [512.0, 512.0]), [off_centre]);
    assert_eq!(said(640, 480, [512.0, 512.0]), [outside]);
    // A real lens: off by 5 % of the side. Then off by a quarter and a little.
    assert_eq!(said(640, 480, [352.0, 240.0]), []);
    assert_eq!(said(640, 480, [320.0, 361.0]), [off_centre]);
    assert_eq!(said(640, 480, [-0.5, 240.0]), [outside]);
    assert_eq!(said(640, 480, [320.0, 480.5]), [outside]);
}

#[test]
fn codes_are_words_of_their_own_and_warnings_are_json() {
    let mut words: Vec<&str> = WarningCode::ALL.iter().map(|code| code.word()).collect();
    words.sort_unstable();
    words.dedup();
    assert_eq!(words.len(), WarningCode::ALL.len());
    let warning = Warning::of_sensor(WarningCode::NoHits, SensorId::Beam(3), "none");
    let json = serde_json::to_value(&warning).unwrap();
    assert_eq!(json, serde_json::json!({ "code": "no_hits", "sensor": "beam-3", "sentence": "none" }));
    let json = serde_json::to_value(Warning::of_scene(WarningCode::TerrainTooLarge, "large")).unwrap();
    assert_eq!(json["sensor"], serde_json::Value::Null);
}
