//! Does a comparison find what is wrong? Faults are planted in a naive third renderer, and each must show as
//! a defect against both renderers; without a fault the three agree.

use std::sync::Arc;

use glam::{DQuat, DVec3};
use proptest::prelude::*;
use raypencil_harness::{Class, SensorComparison, Side, compare};
use raypencil_scanline::Scanline;
use raypencil_scene::{
    Atmosphere, Beam, Camera, FluxModel, Frame, Lens, Material, Mesh, Mounted, Pose, Profile, Renderer,
    Request, Scene, SensorId,
};
use raypencil_terrain::{RandomGround, builtin};
use raypencil_tests::lattice;
use raypencil_tests::naive::{Fault, Naive};
use raypencil_tracer::Tracer;

/// Everything a test needs to plant a fault: where, and which sensors it must show on. On the other sensors
/// it must not show, for there the renderer is right.
struct Plant {
    name: &'static str,
    scene: Scene,
    shows: Shows,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Shows {
    CameraOnly,
    BeamsOnly,
    Everywhere,
}

impl Shows {
    fn on(self, sensor: SensorId) -> bool {
        match self {
            Self::CameraOnly => sensor == SensorId::Camera,
            Self::BeamsOnly => sensor != SensorId::Camera,
            Self::Everywhere => true,
        }
    }
}

/// A small scene on which a fault shows, and why it does.
fn plant(fault: Fault) -> Plant {
    use Shows::{BeamsOnly, CameraOnly, Everywhere};
    let (name, scene, shows) = match fault {
        // Rays move by half a cell or more, and everything is seen aslant: the sensors look down, the fans
        // spread, and the beams' rows start at different heights. So all ranges change.
        Fault::HalfCellShift | Fault::ColumnOffByOne | Fault::RowsBottomUp => {
            ("pyramids", pyramids(), Everywhere)
        }
        // Its pixels are 144 um x 180 um.
        Fault::PitchesSwapped => ("pyramids", pyramids(), CameraOnly),
        // Its principal point is (31.3, 24.8): rays move by a third and a fifth of a pixel.
        Fault::PrincipalPointRounded => ("pyramids", pyramids(), CameraOnly),
        // Its grid is 115 mm wide and 5 mm thick, 96 columns by 4 rows.
        Fault::FanAndThicknessSwapped | Fault::ColumnsCountedAsRows => ("pyramids", pyramids(), BeamsOnly),
        // Its fan is 60 degrees: 120 instead.
        Fault::GridOfWholeFan => ("pyramids", pyramids(), BeamsOnly),
        // Its row 0 keeps 1.9 mm above the plane of the normal axis; from the centre it would pass there at
        // the grid, 0.1 m away, and 30 times as high at 3 m.
        Fault::PencilsFromCentre => ("pyramids", pyramids(), BeamsOnly),
        // Its camera's axes are not the scene's.
        Fault::CameraPoseConjugated => ("pyramids", pyramids(), CameraOnly),
        // q.q = 9: directions come out nine times too long, so that t and the depth, t f_c, are a ninth, and
        // the SPP is nine times as far. The beams' rows start nine times as far apart.
        Fault::QuaternionTakenAsUnit => ("pyramids, long quaternions", on_pyramids(3.0), Everywhere),
        // Its origin is (1e6, -1e6, 0) m: the ground leaves the view.
        Fault::OriginTakenOffTwice => ("a ground 1400 km away", far_ground(), Everywhere),
        // 2^-24 of a distance of metres is 1e-7 m; the bound is some 1e-14 m.
        Fault::VerticesInSinglePrecision | Fault::DirectionsInSinglePrecision => {
            ("pyramids", pyramids(), Everywhere)
        }
        // The plate shows its back, behind which a ray must meet the wall.
        Fault::BackFacesKept => ("a plate turned away", before_wall(plate(true)), Everywhere),
        // In the lower right the ground, whose front the rays meet, would be missing.
        Fault::WindingOfOneQuadrant => ("pyramids", pyramids(), Everywhere),
        // The ramp has two corners beyond the SPP at 0.5 m and one before it, at 0.1 m.
        Fault::ClipCaseLost => ("a ramp through the SPP", before_wall(ramp()), Everywhere),
        // Every ray passes through a vertex, an edge or a diagonal of the wall. All numbers are dyadic, so
        // that side functions are exactly 0.
        Fault::EdgesExcluded => ("a wall whose edges the rays meet", lattice(), Everywhere),
        // Every ray passes within rounding of a vertex, an edge or a diagonal.
        Fault::EdgesReckonedApart => {
            ("a turned lattice whose edges the rays meet", lattice::turned(31), Everywhere)
        }
        // The rays of column 3 cross the plate's plane at x = 1/16 m, 2^-22 m beyond its right edge: that is
        // 2^-20 < 1e-6 of its width of 1/4 m. They must meet the wall.
        Fault::EdgesWidened => ("a plate beside the rays", before_wall(plate(false)), Everywhere),
        // |n.q| = (1/128 m)^2 f, f = g = 1/128 m: 2^-21 m^3 < 1e-6 m^3.
        Fault::SmallDeterminantsDropped => ("a wall of fine faces", fine_wall(), Everywhere),
        // The screen is a plate at half the distance of the SPP.
        Fault::HitsBeforePlane => ("a plate before the SPP", before_wall(screen()), Everywhere),
        // The wall is 2 m deep everywhere, but its range 2 / cos exceeds 2.1 m beyond 18 degrees.
        Fault::MaxRangeLimitsDepth => ("a wall cut by the range", range_cut_wall(), Everywhere),
        // A ray on a pyramid goes on to the plane, whose faces come first in the file and lie farther away.
        Fault::FirstInOrderWins | Fault::FarthestWins => ("pyramids", pyramids(), Everywhere),
        // No ray of these sensors runs along the axis (R = depth only there), no face has the area 1/2 m^2, no
        // sensor's axes are the scene's.
        Fault::DepthForRange
        | Fault::RangeFromPlane
        | Fault::NormalNotNormalised
        | Fault::NormalInSensorFrame
        | Fault::IncidenceAgainstAxis => ("pyramids", pyramids(), Everywhere),
        of_light => panic!("{of_light:?} is planted elsewhere"),
    };
    Plant { name, scene, shows }
}

// Scenes.

/// A mesh of one material in the scene frame.
fn mesh(vertices: Vec<[f32; 3]>, faces: Vec<[u32; 3]>) -> Arc<Mesh> {
    let materials = vec![Material { name: "ground".into(), reflectivity: 0.25 }];
    let face_materials = vec![0; faces.len()];
    Arc::new(Mesh::new(DVec3::ZERO, vertices, faces, face_materials, materials).expect("a mesh"))
}

fn scene(mesh: Arc<Mesh>, camera: Mounted<Camera>, beams: Vec<Mounted<Beam>>) -> Scene {
    let clear = Atmosphere { attenuation: 0.0 };
    Scene::new(mesh, camera, beams, clear, FluxModel::Radiometric).expect("a scene")
}

/// A small rig like the default one, at `position` and heading (radians), with quaternions `length` long.
fn rig(mesh: Arc<Mesh>, position: DVec3, heading: f64, length: f64) -> Scene {
    let pose = |height: f64, pitch_deg: f64| {
        let turned = Pose::from_axis_angle(DVec3::Z, heading)
            * Pose::from_axis_angle(DVec3::Y, pitch_deg.to_radians())
            * Pose::VEHICLE_FROM_FORWARD_SENSOR;
        let [x, y, z, w] = turned.rotation.to_array();
        let rotation = DQuat::from_xyzw(length * x, length * y, length * z, length * w);
        Pose { position: position + DVec3::new(0.3, 0.0, height), rotation }
    };
    let camera = Camera {
        width: 64,
        height: 48,
        pixel_pitch: [144e-6, 180e-6],
        focal_length: 8e-3,
        principal_point: [31.3, 24.8],
        aperture: 2e-3,
        lens: Lens::CLEAR,
        max_range: 20.0,
    };
    let beam = Beam {
        columns: 96,
        rows: 4,
        thickness: 5e-3,
        grid_distance: 0.1,
        half_width: Beam::half_width_of(0.1, 60.0_f64.to_radians()),
        max_range: 20.0,
        power: 1.0,
        wavelength: 810e-9,
        profile: Profile::Paper,
    };
    let camera = Mounted { scene_from_sensor: pose(1.5, 20.0), sensor: camera };
    let beams = [(1.8, 31.0), (2.0, 22.0)]
        .map(|(height, pitch_deg)| Mounted { scene_from_sensor: pose(height, pitch_deg), sensor: beam });
    scene(mesh, camera, beams.to_vec())
}

/// The built-in pyramids before a rig with quaternions of any length.
fn on_pyramids(length: f64) -> Scene {
    let ground = builtin("pyramids", 0.25).expect("a built-in name");
    rig(Arc::new(ground.into_mesh().expect("a mesh")), DVec3::ZERO, 0.0, length)
}

fn pyramids() -> Scene {
    on_pyramids(1.0)
}

fn facets() -> Scene {
    let ground = builtin("facets", 0.25).expect("a built-in name");
    rig(Arc::new(ground.into_mesh().expect("a mesh")), DVec3::ZERO, 0.2, 1.0)
}

/// Hills whose middle is at (1e6, -1e6, 0) m; the rig stands at the scene's origin, which is there.
fn far_ground() -> Scene {
    let offset = DVec3::new(1e6, -1e6, 0.0);
    let ground = RandomGround { offset, ..RandomGround::plain(3, 200, 24.0) }.build();
    let mesh = ground.into_mesh().expect("a mesh");
    assert!((mesh.origin() - offset).length() < 2.0);
    rig(Arc::new(mesh), DVec3::ZERO, 0.0, 1.0)
}

/// A camera and a beam in one place, looking along the scene's z: `size` cells across and down, their rays
/// `slope` apart in x / z, SPP at `plane` metres, `max_range` metres. The beam's rows are `step` metres apart.
fn along_z(mesh: Arc<Mesh>, size: u32, plane: f64, slope: f64, step: f64, max_range: f64) -> Scene {
    let middle = 0.5 * f64::from(size);
    let camera = Camera {
        width: size,
        height: size,
        pixel_pitch: [slope * plane; 2],
        focal_length: plane,
        principal_point: [middle; 2],
        aperture: 2e-3,
        lens: Lens::CLEAR,
        max_range,
    };
    let beam = Beam {
        columns: size,
        rows: size,
        thickness: f64::from(size) * step,
        grid_distance: plane,
        half_width: middle * slope * plane,
        max_range,
        power: 1.0,
        wavelength: 810e-9,
        profile: Profile::Paper,
    };
    let camera = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: camera };
    scene(mesh, camera, vec![Mounted { scene_from_sensor: Pose::IDENTITY, sensor: beam }])
}

/// A square wall at depth `z` around the axis, of cells x cells squares of two faces, its front to the
/// sensors: vertices and faces.
fn wall(z: f32, half_side: f32, cells: u32) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    let at = |k: u32| 2.0 * half_side * k as f32 / cells as f32 - half_side;
    let vertices = (0..=cells).flat_map(|v| (0..=cells).map(move |u| [at(u), at(v), z])).collect();
    let squares = (0..cells).flat_map(|v| (0..cells).map(move |u| v * (cells + 1) + u));
    let faces = squares.flat_map(|a| {
        let (b, c, d) = (a + cells + 1, a + cells + 2, a + 1);
        [[a, b, c], [a, c, d]]
    });
    (vertices, faces.collect())
}

/// One face before a wall at 2 m. The 5 x 5 rays of each sensor cross z = 1 m at multiples of 1/16 m, from
/// -1/8 to 1/8 m (the beam's rows at multiples of 1/8 m); the SPP is at 1/2 m.
fn before_wall(face: [[f32; 3]; 3]) -> Scene {
    let (mut vertices, mut faces) = wall(2.0, 4.0, 1);
    let first = vertices.len() as u32;
    vertices.extend(face);
    faces.push([first, first + 1, first + 2]);
    along_z(mesh(vertices, faces), 5, 0.5, 1.0 / 16.0, 1.0 / 8.0, 100.0)
}

/// A triangle at 1 m whose right edge is 2^-22 m short of x = 1/16 m.
fn plate(turned_away: bool) -> [[f32; 3]; 3] {
    const RIGHT: f32 = 1.0 / 16.0 - 1.0 / 4_194_304.0;
    let [a, b, c] = [[RIGHT, -0.125, 1.0], [RIGHT - 0.25, 0.0, 1.0], [RIGHT, 0.125, 1.0]];
    if turned_away { [a, c, b] } else { [a, b, c] }
}

/// A triangle that falls away from a corner 0.1 m before the sensor, behind the SPP, to 1.5 m. On the axis it
/// is 0.8 m away: y = -0.3 + 0.6 (z - 0.1) / 1.4 is 0 there.
fn ramp() -> [[f32; 3]; 3] {
    [[0.0, -0.3, 0.1], [-1.0, 0.3, 1.5], [1.0, 0.3, 1.5]]
}

/// A triangle around the axis at 1/4 m.
fn screen() -> [[f32; 3]; 3] {
    [[-0.3, -0.1, 0.25], [0.03, 0.3, 0.25], [0.27, -0.1, 0.25]]
}

/// A wall at 2 m with vertices 1/4 m apart; the 5 x 5 rays cross it at multiples of 1/8 m.
fn lattice() -> Scene {
    let (vertices, faces) = wall(2.0, 0.5, 4);
    along_z(mesh(vertices, faces), 5, 0.5, 1.0 / 16.0, 1.0 / 8.0, 100.0)
}

/// A wall at 1/4 m of squares of 1/128 m; the 15 x 15 rays cross it 1/128 m apart, within 7/128 m of its
/// middle, and its border is at 8/128 m.
fn fine_wall() -> Scene {
    let (vertices, faces) = wall(0.25, 1.0 / 16.0, 16);
    along_z(mesh(vertices, faces), 15, 1.0 / 128.0, 1.0 / 32.0, 1.0 / 128.0, 100.0)
}

/// A wall at 2 m before sensors that see 2.1 m far, 24 degrees to either side: tan = 7/16.
fn range_cut_wall() -> Scene {
    let (vertices, faces) = wall(2.0, 4.0, 1);
    along_z(mesh(vertices, faces), 15, 0.5, 1.0 / 16.0, 1.0 / 8.0, 2.1)
}

// Comparisons.

/// What both renderers make of a scene, to compare others with.
struct Judges<'a> {
    scene: &'a Scene,
    frames: [(&'static str, Frame); 2],
}

impl<'a> Judges<'a> {
    fn of(scene: &'a Scene) -> Self {
        let render = |renderer: &dyn Renderer| renderer.render(scene, &Request::MAPS);
        Self {
            scene,
            frames: [("scanline", render(&Scanline::default())), ("tracer", render(&Tracer::new()))],
        }
    }

    /// The naive renderer compared with each of them.
    fn compare(&self, naive: Naive) -> [(&'static str, Vec<SensorComparison>); 2] {
        let frame = naive.render(self.scene, &Request::MAPS);
        let resolution = naive.resolution();
        [0, 1].map(|index| {
            let (name, judge) = &self.frames[index];
            let a = Side { name, frame: judge, resolution, attributions: None };
            let b = Side { name: naive.name(), frame: &frame, resolution, attributions: None };
            (*name, compare(self.scene, a, b))
        })
    }

    /// What is wrong with a naive renderer without a fault: nothing, unless a message says so.
    fn agree(&self) -> Result<(), String> {
        for (judge, sensors) in self.compare(Naive::default()) {
            for sensor in &sensors {
                let cells = self.scene.size(sensor.sensor).map_or(0, |(w, h)| u64::from(w) * u64::from(h));
                if sensor.compared != cells || sensor.of(Class::Defect) != 0 {
                    return Err(format!(
                        "{} of {cells} compared with {judge}, {} defects, the first {:?}",
                        sensor.compared,
                        sensor.of(Class::Defect),
                        sensor.defects.first()
                    ));
                }
            }
        }
        Ok(())
    }

    /// How many rays of each sensor hit.
    fn hits(&self) -> Vec<usize> {
        let (_, frame) = &self.frames[1];
        let ranges = frame.maps().map(|map| map.range.as_ref().expect("ranges were asked for"));
        ranges.map(|range| range.cells().iter().filter(|cell| cell.get().is_some()).count()).collect()
    }
}

#[test]
fn every_planted_fault_is_found_where_it_is() {
    println!("{:<28} {:<34} {:<7} {:>8} {:>8}", "fault", "scene", "sensor", "scanline", "tracer");
    let mut wrong = Vec::new();
    for fault in Fault::ALL.into_iter().filter(|fault| !fault.is_of_light()) {
        let Plant { name, scene, shows } = plant(fault);
        let judges = Judges::of(&scene);
        if let Err(message) = judges.agree() {
            wrong.push(format!("{name}, without a fault: {message}"));
        }
        let [(_, scanline), (_, tracer)] = judges.compare(Naive { fault: Some(fault) });
        for (scanline, tracer) in scanline.iter().zip(&tracer) {
            let sensor = scanline.sensor;
            let defects = [scanline, tracer].map(|comparison| comparison.of(Class::Defect));
            let [by_scanline, by_tracer] = defects;
            let fault = format!("{fault:?}");
            let row = sensor.to_string();
            println!("{fault:<28} {name:<34} {row:<7} {by_scanline:>8} {by_tracer:>8}");
            if defects.iter().any(|&count| (count > 0) != shows.on(sensor)) {
                wrong.push(format!("{fault} on {name}: {defects:?} defects on {sensor}, shows {shows:?}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn faults_cost_the_rays_that_arithmetic_says() {
    let cases = [
        // All rays pass through edges.
        (Fault::EdgesExcluded, 25, 25),
        // All faces are too small.
        (Fault::SmallDeterminantsDropped, 225, 225),
        // Column 3, where |y| <= 1/8 m at z = 1 m: all five rows of the camera, 1/16 m apart, and three of the
        // beam, 1/8 m apart.
        (Fault::EdgesWidened, 5, 3),
        // Rays have slopes k/16 and l/16, k and l from -7 to 7 (a beam's l is 0). R > 2.1 m where
        // 4 (1 + (k^2 + l^2) / 256) > 4.41, k^2 + l^2 > 26.24. Of 15^2 lattice points 89 lie within the
        // circle of radius sqrt 26; and |k| > 5 in 4 columns of 15 pencils.
        (Fault::MaxRangeLimitsDepth, 225 - 89, 60),
    ];
    for (fault, camera, beam) in cases {
        let Plant { scene, .. } = plant(fault);
        for (judge, sensors) in Judges::of(&scene).compare(Naive { fault: Some(fault) }) {
            let defects: Vec<u64> = sensors.iter().map(|sensor| sensor.of(Class::Defect)).collect();
            assert_eq!(defects, [camera, beam], "{fault:?} against {judge}");
        }
    }
}

#[test]
fn every_fault_is_listed_once() {
    for (index, fault) in Fault::ALL.iter().enumerate() {
        assert_eq!(*fault as usize, index, "{fault:?}");
    }
}

#[test]
fn without_a_fault_nothing_is_found_on_the_built_in_grounds() {
    for (name, scene) in [("pyramids", pyramids()), ("facets", facets())] {
        let judges = Judges::of(&scene);
        assert_eq!(judges.agree(), Ok(()), "{name}");
        // Not by seeing nothing: each sensor hits with half of its rays.
        let cells = scene.sensors().filter_map(|sensor| scene.size(sensor)).map(|(w, h)| (w * h) as usize);
        for (hits, cells) in judges.hits().into_iter().zip(cells) {
            assert!(2 * hits > cells, "{name}: {hits} of {cells} hit");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, failure_persistence: None, ..ProptestConfig::default() })]

    // Grounds with slivers, copied faces, walls and overhangs; a rig that stands at most 0.8 m above or below
    // the ground, heads anywhere, and has quaternions that are no units.
    #[test]
    fn without_a_fault_nothing_is_found_on_random_grounds(
        seed in any::<u64>(),
        faces in 50usize..400,
        heading in -3.2..3.2,
        length in 0.5..2.0,
    ) {
        let mesh = RandomGround::nasty(seed, faces).build().into_mesh().expect("a mesh");
        let scene = rig(Arc::new(mesh), DVec3::ZERO, heading, length);
        let judges = Judges::of(&scene);
        prop_assert_eq!(judges.agree(), Ok(()));
        prop_assert!(judges.hits().iter().sum::<usize>() > 0);
    }
}
