//! Unit tests of `printed_occlusion`: `place = paper` and `extent = paper`.

use glam::DVec3;
use raypencil_scene::{FaceId, Pixel, Pose};

use super::*;
use crate::clusters::Clusters;
use crate::fixtures::{beam, camera, mesh};
use crate::occluders::Facing;
use crate::perspective::Perspective;
use crate::points::{ImagePoint, PixelGrid};
use crate::rounding::PointError;
use crate::spp::SppPoint;
use crate::tables::CameraTables;

fn point(depth: f64) -> Option<StripePoint> {
    Some(StripePoint {
        face: FaceId(0),
        range: 1.0,
        cos_psi: 1.0,
        cos_theta: 1.0,
        depth,
        distance: 1.0,
        cos_phi: 1.0,
        sin_squared_phi: 0.0,
        image: None,
        error: PointError { along_pencil: DVec3::ZERO, any_direction: 0.0 },
    })
}

#[test]
fn a_face_deeper_than_a_point_may_be_nearer_at_the_centre_of_its_pixel() {
    // The point is at (0.24, 0.24) on the SPP, in pixel (4, 4), whose centre is (0.125, 0.125). At z = 2 its range is
    // 2.112 m. At the centre the range of a wall at z = 2.05 is 2.082 m, and of one at z = 2.1 it is 2.133 m.
    let (x, z) = (0.24_f64, 2.0);
    let distance = z * (1.0 + 2.0 * x * x).sqrt();
    let image = ImagePoint { pixel: Pixel { i: 4, j: 4 }, on_spp: SppPoint { x, y: x }, inverse_t: 1.0 / z };
    let point = StripePoint { distance, image: Some(image), ..point(z).unwrap() };
    let tables = CameraTables::new(&camera());
    let mounted = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: camera() };
    let perspective = Perspective::new(&mounted, &tables);
    let bins = Bins::new(PixelGrid::new(&camera()), [Some(&point)].into_iter());
    for (wall, is_hidden) in [(2.05, true), (2.1, false)] {
        let ground = mesh(&[[[-9.0, -9.0, wall], [9.0, -9.0, wall], [0.0, 9.0, wall]]]);
        let clusters = Clusters::new(&ground);
        let occluders = Occluders::new(&ground, &clusters, &perspective, Facing::Every, f64::INFINITY);
        for skip_unseen in [true, false] {
            assert_eq!(hidden_at_centres(&occluders, &bins, skip_unseen), [is_hidden], "{wall}");
        }
    }
}

#[test]
fn the_upper_beam_is_the_highest_and_the_last_of_equals() {
    let camera_from_scene = SensorFromScene::from_pose(&Pose::IDENTITY);
    let at = |position: DVec3| Mounted { scene_from_sensor: Pose::from_position(position), sensor: beam() };
    let extent = |beams: [DVec3; 2]| {
        let stripes = [vec![point(3.0), None, point(5.0), point(4.0)], vec![point(7.0), point(6.0)]];
        upper_extent(&camera_from_scene, &beams.map(at), &stripes)
    };
    // The camera's y axis points down.
    let (low, high) = (DVec3::new(0.0, 1.0, 0.0), DVec3::new(0.0, -1.0, 0.0));
    assert_eq!((extent([high, low]), extent([low, high]), extent([low, low])), (5.0, 7.0, 7.0));
    // Heights of +0 and -0 are equal. In the camera's frame y of the first is -0 - 0 - 0, and of the second +0.
    let (plus, minus) = (DVec3::new(-1.0, -0.0, -1.0), DVec3::new(1.0, 0.0, 1.0));
    assert_eq!((extent([plus, minus]), extent([minus, plus])), (7.0, 7.0));
    // Without a hit the extent is infinite.
    let nothing = [vec![None], vec![point(6.0)]];
    assert_eq!(upper_extent(&camera_from_scene, &[at(high), at(low)], &nothing), f64::INFINITY);
}
