//! Transforms, axes and instances, by derived numbers.

use serde_json::{Value, json};

use super::*;

#[test]
fn y_up_becomes_z_up_and_identity_changes_no_number() {
    // (x, y, z) -> (x, -z, y), for numbers without a short decimal.
    let (mut json, _) = square();
    let numbers: Vec<f32> = (0..12).map(|i| f32::from_bits(0x3f12_3457 + 77_777 * i)).collect();
    let mut bin = reals(&numbers);
    bin.extend([0_u16, 1, 2, 0, 2, 3].iter().flat_map(|index| index.to_le_bytes()));
    let expected: Vec<[f32; 3]> = numbers.chunks(3).map(|v| [v[0], -v[2], v[1]]).collect();
    let bits =
        |vertices: &[[f32; 3]]| vertices.as_flattened().iter().map(|c| c.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(parse(&json, &bin).unwrap().vertices()), bits(&expected));
    // The same with explicit transforms that do nothing.
    json["nodes"] = json!([
        {"children": [1], "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]},
        {"children": [2], "translation": [0, 0, 0]},
        {"children": [3], "rotation": [0, 0, 0, 1], "scale": [1, 1, 1]},
        {"mesh": 0},
    ]);
    assert_eq!(bits(parse(&json, &bin).unwrap().vertices()), bits(&expected));
}

#[test]
fn faces_keep_their_order_and_look_up() {
    let mesh = changed(|_| {}).unwrap();
    assert_eq!(vertices(&mesh), [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]]);
    assert_eq!(mesh.faces(), [[0, 1, 2], [0, 2, 3]]);
    // No negative zeros.
    assert!(mesh.vertices().as_flattened().iter().all(|c| c.to_bits() != (-0.0_f32).to_bits()));
}

#[test]
fn a_quaternion_of_few_digits_turns_and_does_not_scale() {
    // As far from 1 as four normalised bytes may be; and what is further is no rotation.
    for (length, is_read) in [
        (126.0 / 127.0, true),
        (128.0 / 127.0, true),
        (0.707 * f64::sqrt(2.0), true),
        (0.99, false),
        (1.02, false),
    ] {
        let part = length / f64::sqrt(2.0);
        let found = changed(|json| json["nodes"][0]["rotation"] = json!([part, 0, 0, part]));
        assert_eq!(found.is_ok(), is_read, "{length}: {found:?}");
        // A quarter turn about x of a square of side 1, whatever the length.
        let Ok(mesh) = found else { continue };
        let [low, high] = mesh.bounds().unwrap();
        assert!(((high - low).max_element() - 1.0).abs() < 1e-6, "{length}");
    }
}

#[test]
fn translation_rotation_and_scale_apply_from_the_right() {
    // T R S: (1, 0, 0) is scaled by 2, rotated by 90 degrees about y (x -> -z), moved by (10, 20, 30):
    // (10, 20, 28), which is (10, -28, 20) globally. Halves under the root: the quaternion in f32 is a unit
    // only to 1e-8, which the division by its square repairs.
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let mesh = changed(|json| {
        json["nodes"][0] = json!({"mesh": 0, "translation": [10, 20, 30], "rotation": [0, half, 0, half], "scale": [2, 3, 4]});
    });
    let mesh = mesh.unwrap();
    assert_eq!(vertices(&mesh)[0], [10., -30., 20.]);
    assert_eq!(vertices(&mesh)[1], [10., -28., 20.]);
    // (0, 0, -1) -> (0, 0, -4) -> (-4, 0, 0) -> (6, 20, 30).
    assert_eq!(vertices(&mesh)[3], [6., -30., 20.]);
}

#[test]
fn hierarchies_compose_from_the_root() {
    // The parent's matrix (column by column) scales by 2 and moves by (100, 0, 0); the child moves by
    // (0, 5, 0) first: (1, 0, 0) -> (1, 5, 0) -> (102, 10, 0), globally (102, 0, 10).
    let mesh = changed(|json| {
        json["nodes"] = json!([
            {"matrix": [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 100, 0, 0, 1], "children": [1]},
            {"mesh": 0, "translation": [0, 5, 0]},
        ]);
    });
    assert_eq!(vertices(&mesh.unwrap())[1], [102., 0., 10.]);
}

#[test]
fn a_hierarchy_is_composed_in_double_precision() {
    // 2^24 + 1 is no f32: the sum of two translations is rounded only after the scene origin is taken off.
    let mesh = changed(|json| {
        json["nodes"] = json!([
            {"translation": [16_777_216, 0, 0], "children": [1]},
            {"mesh": 0, "translation": [0.25, 0, 0]},
        ]);
    });
    let mesh = mesh.unwrap();
    // The box is 2^24 + 0.25 .. + 1.25 in x: the origin is 2^24 + 1 (0.75 rounded) and -0 .. in y 0.5 -> 1.
    assert_eq!(mesh.origin().to_array(), [16_777_217.0, 1.0, 0.0]);
    assert_eq!(vertices(&mesh)[0], [-0.75, -1., 0.]);
    assert_eq!(vertices(&mesh)[1], [0.25, -1., 0.]);
}

/// Offsets as a map projection has them. None is a number of single precision: 0.25 m of the first is lost in it, and
/// 0.2 m of the second.
const MAP_M: [f64; 3] = [4_500_000.25, 4_500_000.3, -612_345.678];

/// Vertices of the square below `nodes`, in the global frame, if they are at these places of the file: each is its
/// single-precision position plus `at`, rounded once to double; from there the scene origin is taken off, and the rest
/// is rounded to single.
fn stands_at(nodes: Value, at: [f64; 3]) {
    let mesh = changed(|json| json["nodes"] = nodes.clone()).unwrap();
    let origin = mesh.origin().to_array();
    for (vertex, local) in mesh.vertices().iter().zip(SQUARE.chunks(3)) {
        let file: [f64; 3] = std::array::from_fn(|axis| f64::from(local[axis]) + at[axis]);
        let global = [file[0], -file[2], file[1]];
        let expected: [f32; 3] = std::array::from_fn(|axis| (global[axis] - origin[axis]) as f32);
        assert_eq!(vertex, &expected, "{nodes}");
        // The vertices are near the origin, where single precision tells micrometres apart.
        assert!(expected.iter().all(|offset| offset.abs() <= 2.0));
    }
}

#[test]
fn a_translation_keeps_its_decimals_at_map_coordinates() {
    let [x, y, z] = MAP_M;
    stands_at(json!([{"mesh": 0, "translation": MAP_M}]), MAP_M);
    stands_at(json!([{"mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, y, z, 1]}]), MAP_M);
}

#[test]
fn nested_translations_add_in_double_precision() {
    // Half of a map coordinate twice: the sum of two equal doubles is exact.
    let [x, y, z] = MAP_M.map(|part| 0.5 * part);
    stands_at(
        json!([
            {"translation": [x, y, z], "children": [1]},
            {"matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, y, z, 1], "children": [2]},
            {"mesh": 0},
        ]),
        MAP_M,
    );
    // A map coordinate taken off again: what is left is exact, and single precision would leave nothing of it.
    stands_at(
        json!([
            {"translation": [4_500_000.25, 0, -4_500_000.125], "children": [1]},
            {"mesh": 0, "translation": [-4_500_000, 0, 4_500_000]},
        ]),
        [0.25, 0.0, -0.125],
    );
}

#[test]
fn scales_and_turns_keep_their_decimals() {
    // Millimetres at a map coordinate: 0.001 times 4,500,000,250. The factor of single precision is off by 4.7e-8,
    // which is 0.2 m there.
    let mesh = changed(|json| {
        json["nodes"] = json!([
            {"scale": [0.001, 0.001, 0.001], "children": [1]},
            {"translation": [4_500_000_250.0, 0, 0], "mesh": 0},
        ]);
    })
    .unwrap();
    let x = |vertex: usize| mesh.origin().x + f64::from(mesh.vertices()[vertex][0]);
    assert!((x(0) - 4_500_000.25).abs() < 1e-6 && (x(1) - 4_500_000.251).abs() < 1e-6, "{} {}", x(0), x(1));

    // (3, 4) / 5 is the turn by a cosine of -7/25 and a sine of 24/25 about y: x of 4,500,000 goes to
    // (-1,260,000, 0, -4,320,000). 0.6 and 0.8 in single precision are off by 4e-8 and 1.5e-8.
    let mesh = changed(|json| {
        json["nodes"] = json!([
            {"rotation": [0, 0.8, 0, 0.6], "children": [1]},
            {"translation": [4_500_000, 0, 0], "mesh": 0},
        ]);
    })
    .unwrap();
    let corner: [f64; 3] =
        std::array::from_fn(|axis| mesh.origin()[axis] + f64::from(mesh.vertices()[0][axis]));
    for (found, expected) in corner.into_iter().zip([-1_260_000.0, 4_320_000.0, 0.0]) {
        // A few roundings of doubles near 4.5e6, at 5e-10 each.
        assert!((found - expected).abs() < 1e-8, "{corner:?}");
    }
}

#[test]
fn instances_stand_side_by_side_in_document_order() {
    let mesh = changed(|json| {
        json["nodes"] = json!([
            {"children": [3, 1], "mesh": 0},
            {"mesh": 0, "translation": [1, 0, 0]},
            {"mesh": 0, "translation": [9, 0, 0]},
            {"mesh": 0, "translation": [3, 0, 0]},
        ]);
        json["scenes"] = json!([{"nodes": [2, 0]}]);
    });
    let mesh = mesh.unwrap();
    // Node 2 first, then 0, then its children in their order: 3, 1.
    let first_corners: Vec<f32> = mesh.faces().iter().map(|f| mesh.vertices()[f[0] as usize][0]).collect();
    assert_eq!(first_corners, [9., 9., 0., 0., 3., 3., 1., 1.]);
    assert_eq!(mesh.vertices().len(), 16);
}

#[test]
fn mirrors_keep_the_outside_out() {
    for scale in [[-1, 1, 1], [1, 1, -1], [-1, -1, -1], [-1, 1, -1]] {
        let mesh = changed(|json| json["nodes"][0]["scale"] = json!(scale)).unwrap();
        let [a, b, c] = mesh.faces()[0].map(|v| mesh.vertices()[v as usize]);
        // z of (b - a) x (c - a): the square still looks up, unless y was mirrored an odd number of times
        // along with an odd number of the others: an upside-down square looks down.
        let z = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        let expected = if scale[1] < 0 { -1.0 } else { 1.0 };
        assert_eq!(z, expected, "{scale:?}");
    }
    // Mirrored twice, by parent and child, it is not mirrored.
    let twice = changed(|json| {
        json["nodes"] = json!([{"scale": [-1, 1, 1], "children": [1]}, {"mesh": 0, "scale": [-1, 1, 1]}]);
    });
    assert_eq!(twice.unwrap().faces()[0], [0, 1, 2]);
}

#[test]
fn invalid_transforms_are_refused() {
    let node = |key: &'static str, value: Value| changed(move |json| json["nodes"][0][key] = value);
    let perspective = json!([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0.5, 0, 0, 0, 1]);
    refused(
        node("matrix", perspective),
        "node 0 \"ground\": a matrix with the last row [0.0, 0.0, 0.5, 1.0]; expected [0, 0, 0, 1]",
    );
    // Too large for single precision: refused as JSON, before it could become an infinity.
    let error = node("translation", json!([1e39, 0, 0])).unwrap_err();
    assert!(error.starts_with("test.glb: JSON: number out of range at line 1 column"), "{error}");
    refused(
        node("rotation", json!([0, 0, 0, 0])),
        "node 0 \"ground\": rotation [0.0, 0.0, 0.0, 0.0]; expected a unit quaternion",
    );
    refused(
        node("weights", json!([0, 0.5])),
        "node 0 \"ground\": morph weights; expected weights of 0: bake the shape into the mesh (in Blender: Apply All Shape Keys)",
    );
    assert!(node("weights", json!([0, 0])).is_ok());
    let both = changed(|json| {
        json["nodes"][0]["matrix"] = json!([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);
        json["nodes"][0]["scale"] = json!([1, 1, 1]);
    });
    refused(
        both,
        "node 0 \"ground\": a matrix beside translation, rotation or scale; expected one or the other",
    );
}
