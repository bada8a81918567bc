//! Point clouds, byte by byte.

use glam::DVec3;
use raypencil_cast::{Questions, cast, write_pcd};
use raypencil_scene::{CastRay, NamedRaySet, RaySet, Sides, Silent, Triangles};

/// The ring of each point of a set with this shape, as its PCD file gives it.
fn rings(shape: &[u64]) -> Vec<u16> {
    let count: u64 = shape.iter().product();
    let plate = vec![[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [0.0, 9.0, 0.0]];
    let mesh = Triangles::new(plate, vec![[0, 1, 2]]).expect("a plate");
    let rays: Vec<CastRay> =
        (0..count).map(|k| CastRay::new(DVec3::new(k as f64 / 64.0, 0.0, 1.0), DVec3::NEG_Z)).collect();
    let answers = cast(&mesh, &rays, Sides::Both, Questions::default(), &Silent);
    let set = NamedRaySet {
        name: "rays".into(),
        shape: shape.to_vec(),
        set: RaySet::new(rays, Sides::Both).expect("rays"),
        times: None,
        weights: None,
        elevations_deg: None,
        up: DVec3::Z,
    };
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("cloud.pcd");
    write_pcd(&path, &answers, &set).expect("a file");
    let bytes = std::fs::read(path).expect("the file");
    let text = b"DATA binary\n";
    let start =
        bytes.windows(text.len()).position(|at| at == text).expect("the end of the header") + text.len();
    // x, y, z of 4 bytes each, `ring` of 2, `time` of 8, `range` of 4.
    let points: Vec<&[u8]> = bytes[start..].chunks(12 + 2 + 8 + 4).collect();
    points.iter().map(|point| u16::from_le_bytes([point[12], point[13]])).collect()
}

#[test]
fn the_ring_is_the_index_in_the_second_dimension() {
    assert_eq!(rings(&[4]), [0; 4]);
    assert_eq!(rings(&[2, 3]), [0, 1, 2, 0, 1, 2]);
    // Of a third dimension four rays each are in one ring.
    let of_two_steps = [0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2].repeat(2);
    assert_eq!(rings(&[2, 3, 4]), of_two_steps);
    let of_five = (0..3).flat_map(|ring| [ring; 10]).collect::<Vec<u16>>();
    assert_eq!(rings(&[1, 3, 2, 5]), of_five);
}
