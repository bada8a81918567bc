//! Unit tests of `occlusion`: the tolerance, and the paper's claim about faces turned away.

use std::sync::Arc;

use super::*;
use glam::DVec3;
use raypencil_scene::{Beam, Camera, FaceId, Lens, Mesh, Mounted, Pose, Profile, Quantities, SensorId};
use raypencil_terrain::{BUILTIN_NAMES, RandomGround, builtin, height_at};

use crate::clusters::Clusters;
use crate::cylindrical::Cylindrical;
use crate::fixtures::{camera, mesh};
use crate::occluders::Facing;
use crate::perspective::Perspective;
use crate::points::{self, PixelGrid};
use crate::rounding::PointError;
use crate::tables::CameraTables;
use crate::{ScanlineOptions, Switches, bands};

/// Which stripe points of a rig are hidden if the faces of that `facing` occlude. It is the default rig with rasters
/// four times coarser and sheets 2 cm thick.
fn hidden_by(mesh: &Arc<Mesh>, facing: Facing) -> Vec<bool> {
    let z = height_at(mesh, 0.0, 0.0).expect("ground under the vehicle");
    let mount = |height: f64, pitch_down_deg: f64| {
        Pose::from_position(DVec3::new(0.3, 0.0, z + height) - mesh.origin())
            * Pose::from_axis_angle(DVec3::Y, pitch_down_deg.to_radians())
            * Pose::VEHICLE_FROM_FORWARD_SENSOR
    };
    let camera = Camera {
        width: 256,
        height: 256,
        pixel_pitch: [36e-6; 2],
        focal_length: 8e-3,
        principal_point: [128.0; 2],
        aperture: 2e-3,
        lens: Lens::CLEAR,
        max_range: 20.0,
    };
    let beam = Beam {
        columns: 256,
        rows: 4,
        thickness: 2e-2,
        grid_distance: 0.1,
        half_width: Beam::half_width_of(0.1, 60_f64.to_radians()),
        max_range: 20.0,
        power: 1.0,
        wavelength: 810e-9,
        profile: Profile::Paper,
    };
    let clusters = Clusters::new(mesh);
    let tables = CameraTables::new(&camera);
    let mounted = Mounted { scene_from_sensor: mount(1.5, 20.0), sensor: camera };
    let perspective = Perspective::new(&mounted, &tables);
    let pixels = PixelGrid::new(&camera);
    let mut stripes = Vec::new();
    for (height, down) in [(1.8, 31.0), (2.0, 22.0)] {
        let beam = Mounted { scene_from_sensor: mount(height, down), sensor: beam };
        let cylindrical = Cylindrical::new(&beam, Switches::EXACT);
        let sensor = SensorId::Beam(0);
        let ranges = Quantities::RANGE_MAP;
        let map = bands::render(
            mesh,
            &clusters,
            &cylindrical,
            sensor,
            (ranges, bands::MetSide::Fronts),
            ScanlineOptions::EXACT,
        );
        let hits = map.face.expect("asked for");
        stripes.extend(points::stripe_points(mesh, &cylindrical, &perspective, pixels, &hits));
    }
    let bins = Bins::new(pixels, stripes.iter().map(Option::as_ref));
    assert!(bins.points().len() > 500);
    hidden(&Occluders::new(mesh, &clusters, &perspective, facing, f64::INFINITY), &bins, true)
}

/// Hills, rocks, mushrooms, floating slabs and walls, all of them closed surfaces.
fn closed(seed: u64) -> RandomGround {
    RandomGround { slivers: 0, duplicate_faces: 0, zero_area_faces: 0, ..RandomGround::nasty(seed, 4000) }
}

#[test]
fn a_plane_contains_a_point_within_rounding() {
    // Edges of 3, 4 and 5 m in the plane z = 2, so |d| = 12 * 2 = 24. The farthest vertex, (0, 4, 2), is sqrt 20 m from
    // the camera.
    let ground = mesh(&[[[0.0, 0.0, 2.0], [3.0, 0.0, 2.0], [0.0, 4.0, 2.0]]]);
    let tables = CameraTables::new(&camera());
    let mounted = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: camera() };
    let perspective = Perspective::new(&mounted, &tables);
    let clusters = Clusters::new(&ground);
    let occluders = Occluders::new(&ground, &clusters, &perspective, Facing::Every, f64::INFINITY);
    let transformed = occluders.transformed(&clusters.all());
    let contained_at = |beyond: f64, error: PointError| {
        let mut answers = Vec::new();
        occluders.visit_face(
            FaceId(0),
            transformed.vertices_of(transformed.faces[0]),
            |_| true,
            |occluder| {
                // By this choice |d| (1/t - 1/t_P) / (1/t_P) = |d| beyond.
                let inverse_t = 0.5;
                let point = BinnedPoint {
                    on_spp: SppPoint { x: 0.0, y: 0.0 },
                    inverse_t: inverse_t / (1.0 + beyond),
                    distance: 3.0,
                    error,
                    face: FaceId(1),
                    index: 0,
                };
                answers.push(plane_contains(&occluders, occluder, &point, inverse_t));
            },
        );
        answers
    };
    let exact = PointError { along_pencil: DVec3::ZERO, any_direction: 0.0 };
    let bound = RELATIVE_ROUNDING * 20.0 * (20_f64.sqrt() + 3.0) / 24.0;
    assert_eq!(
        (contained_at(0.99 * bound, exact), contained_at(1.01 * bound, exact)),
        (vec![true], vec![false])
    );
    // The point's own error of 1e-9 m times |n| = 12 shifts the bound to 1e-9 * 12 / 24 = 5e-10.
    let inexact = PointError { along_pencil: DVec3::ZERO, any_direction: 1e-9 };
    assert_eq!((contained_at(4.99e-10, inexact), contained_at(5.01e-10, inexact)), (vec![true], vec![false]));
}

#[test]
fn faces_turned_away_suffice_on_closed_ground() {
    // §6: "a ray from the camera to a stripe is occluded by the terrain if the ray passes through a triangle on
    // the back side of the terrain." This is true if the ground is closed, camera and laser are outside of it, the
    // camera is on the front side of the hit face, and facing is judged from the camera's position. The ray then starts
    // outside and ends outside, at a front. So each time it enters a solid it must leave it through a back.
    let grounds = (0..6).map(|seed| closed(seed).build());
    let mut count = 0;
    for ground in grounds.chain(BUILTIN_NAMES.iter().map(|name| builtin(name, 0.25).unwrap())) {
        let mesh = Arc::new(ground.into_mesh().unwrap());
        let hidden = hidden_by(&mesh, Facing::Every);
        assert_eq!(hidden, hidden_by(&mesh, Facing::AwayFromCamera));
        count += hidden.iter().filter(|hidden| **hidden).count();
    }
    assert!(count > 300, "{count}");
}

#[test]
fn faces_turned_away_do_not_suffice_on_open_ground() {
    // The ground has loose slivers, half of which show the camera their front.
    let differs = |seed| {
        let mesh = Arc::new(RandomGround { slivers: 600, ..closed(seed) }.build().into_mesh().unwrap());
        hidden_by(&mesh, Facing::Every) != hidden_by(&mesh, Facing::AwayFromCamera)
    };
    assert!((0..6).any(differs));
}
