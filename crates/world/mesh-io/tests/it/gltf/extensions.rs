//! What tools of the web write: quantized vertices, sparse accessors, instances, skins and shapes that move nothing.

use raypencil_mesh_io::triangles_from_bytes;
use serde_json::{Value, json};

use super::*;

/// The square with other positions, and more behind them: bytes of further buffer views.
fn with_bytes(positions: &[u8], more: &[&[u8]], change: impl FnOnce(&mut Value)) -> (Value, Vec<u8>) {
    let (mut json, old) = square();
    // Indices first: positions may have any length.
    let mut bin = old[48..].to_vec();
    json["bufferViews"] =
        json!([{"buffer": 0, "byteOffset": 12}, {"buffer": 0, "byteOffset": 0, "byteLength": 12}]);
    json["bufferViews"][0]["byteLength"] = json!(positions.len());
    bin.extend(positions);
    for bytes in more {
        bin.resize(bin.len().next_multiple_of(4), 0);
        let view = json!({"buffer": 0, "byteOffset": bin.len(), "byteLength": bytes.len()});
        json["bufferViews"].as_array_mut().unwrap().push(view);
        bin.extend(*bytes);
    }
    json["buffers"] = json!([{"byteLength": bin.len()}]);
    change(&mut json);
    (json, bin)
}

/// The triangles of a file in double precision, or the message.
fn exact((json, bin): (Value, Vec<u8>)) -> Result<Vec<[f64; 3]>, String> {
    let mesh = triangles_from_bytes(&glb(&json, &bin), Path::new("test.glb"));
    mesh.map(|mesh| mesh.vertices().to_vec()).map_err(|error| error.to_string())
}

fn exactly_refused(file: (Value, Vec<u8>), message: &str) {
    assert_eq!(exact(file).expect_err(message), format!("test.glb: {message}"));
}

#[test]
fn quantized_vertices_are_fractions_rounded_once() {
    // Each type with the number that stands for 1, and numbers at both ends; vertices lie 4 numbers apart, as the extension asks.
    let kinds: [(u32, usize, f64, [i64; 3]); 4] = [
        (5120, 1, 127.0, [-128, 127, 3]),
        (5121, 1, 255.0, [0, 255, 7]),
        (5122, 2, 32767.0, [-32768, 32767, 11]),
        (5123, 2, 65535.0, [0, 65535, 10_923]),
    ];
    for (component, size, most, numbers) in kinds {
        for normalized in [false, true] {
            let vertex: Vec<u8> = numbers.iter().flat_map(|n| n.to_le_bytes()[..size].to_vec()).collect();
            let padded: Vec<u8> = vertex.iter().copied().chain(vec![0; size]).collect();
            let file = |used: bool| {
                with_bytes(&padded.repeat(4), &[], |json| {
                    json["accessors"][0]["componentType"] = json!(component);
                    json["accessors"][0]["normalized"] = json!(normalized);
                    json["bufferViews"][0]["byteStride"] = json!(4 * size);
                    if used {
                        json["extensionsUsed"] = json!(["KHR_mesh_quantization"]);
                        json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
                    }
                })
            };
            // The specification's -128 and -32768 are -1 as well. A quotient of two whole numbers is rounded once.
            let value = |n: i64| if normalized { (n as f64 / most).max(-1.0) } else { n as f64 };
            let expected = [value(numbers[0]), value(numbers[1]), value(numbers[2])];
            assert_eq!(exact(file(true)).unwrap()[3], expected, "{component}, {normalized}");
            // Without the extension nobody may mean that.
            let error = exact(file(false)).unwrap_err();
            assert!(error.contains("whole numbers need the extension KHR_mesh_quantization"), "{error}");
        }
    }
    // A quantized mesh is brought to its size by its node, also as terrain.
    let (json, bin) = with_bytes(&[0, 0, 0, 0, 127, 0, 0, 0, 127, 0, 129, 0, 0, 0, 129, 0], &[], |json| {
        json["accessors"][0]["componentType"] = json!(5120);
        json["accessors"][0]["normalized"] = json!(true);
        json["bufferViews"][0]["byteStride"] = json!(4);
        json["nodes"][0]["scale"] = json!([2, 2, 2]);
        json["extensionsUsed"] = json!(["KHR_mesh_quantization"]);
    });
    let mesh = parse(&json, &bin).unwrap();
    assert_eq!(vertices(&mesh), [[0., 0., 0.], [2., 0., 0.], [2., 2., 0.], [0., 2., 0.]]);
    // Where only normals are whole numbers, positions are plain, and the name alone does no harm.
    assert!(changed(|json| json["extensionsRequired"] = json!(["KHR_mesh_quantization"])).is_ok());
}

#[test]
fn sparse_elements_replace_those_below_them() {
    let values = reals(&[5.0, 6.0, 7.0, -1.0, -2.0, -3.0]);
    let square_bytes = reals(&SQUARE);
    let file = |component: u32, indices: &[u8], base: bool| {
        with_bytes(&square_bytes, &[indices, &values], |json| {
            json["accessors"][0]["sparse"] = json!({
                "count": 2,
                "indices": {"bufferView": 2, "componentType": component},
                "values": {"bufferView": 3},
            });
            if !base {
                json["accessors"][0].as_object_mut().unwrap().remove("bufferView");
            }
        })
    };
    let corner = |k: usize| [0, 1, 2].map(|axis| f64::from(SQUARE[3 * k + axis]));
    for (component, indices) in
        [(5121, vec![1, 3]), (5123, vec![1, 0, 3, 0]), (5125, vec![1, 0, 0, 0, 3, 0, 0, 0])]
    {
        let found = exact(file(component, &indices, true)).unwrap();
        assert_eq!(found, [corner(0), [5.0, 6.0, 7.0], corner(2), [-1.0, -2.0, -3.0]]);
        // Without a view the others are zeros.
        let found = exact(file(component, &indices, false)).unwrap();
        assert_eq!(found, [[0.0; 3], [5.0, 6.0, 7.0], [0.0; 3], [-1.0, -2.0, -3.0]]);
    }
    exactly_refused(
        file(5121, &[3, 1], true),
        "accessor 0: sparse index 1 is 1; expected indices below 4 that increase",
    );
    exactly_refused(
        file(5121, &[1, 1], true),
        "accessor 0: sparse index 1 is 1; expected indices below 4 that increase",
    );
    exactly_refused(
        file(5121, &[1, 4], true),
        "accessor 0: sparse index 1 is 4; expected indices below 4 that increase",
    );
    exactly_refused(
        file(5126, &[0; 8], true),
        "accessor 0: sparse indices of another type; expected U8, U16 or U32",
    );
}

#[test]
fn zeros_that_are_stored_elsewhere_are_no_zeros() {
    let without_view = |change: fn(&mut Value)| {
        changed(move |json| {
            json["accessors"][0].as_object_mut().unwrap().remove("bufferView");
            change(json);
        })
    };
    assert_eq!(vertices(&without_view(|_| {}).unwrap()), [[0.0; 3]; 4]);
    refused(
        without_view(|json| json["extensionsUsed"] = json!(["KHR_draco_mesh_compression"])),
        "accessor 0: no buffer view, in a file with \"KHR_draco_mesh_compression\"; expected a buffer view; \
         `gltf-transform cp IN OUT` decompresses",
    );
    refused(
        without_view(|json| json["accessors"][0]["count"] = json!(1_048_577)),
        "accessor 0: 1048577 elements without a buffer view; expected 1 to 1048576",
    );
}

#[test]
fn instances_stand_where_their_numbers_say() {
    let places = reals(&[10.0, 0.0, 0.0, 0.0, 20.0, 0.0]);
    // A quarter turn about y, normalised, and none: (0, 1, 0, 1) / sqrt 2 needs no more digits than its squared length repairs.
    let turns: Vec<u8> =
        [0, 23170, 0, 23170, 0, 0, 0, 32767_i16].iter().flat_map(|n| n.to_le_bytes()).collect();
    let sizes = reals(&[1.0, 1.0, 1.0, 3.0, 3.0, 3.0]);
    let file = |attributes: Value, change: fn(&mut Value)| {
        with_bytes(&reals(&SQUARE), &[&places, &turns, &sizes], |json| {
            let accessors = json["accessors"].as_array_mut().unwrap();
            accessors.push(json!({"bufferView": 2, "componentType": 5126, "count": 2, "type": "VEC3"}));
            accessors.push(
                json!({"bufferView": 3, "componentType": 5122, "normalized": true, "count": 2, "type": "VEC4"}),
            );
            accessors.push(json!({"bufferView": 4, "componentType": 5126, "count": 2, "type": "VEC3"}));
            json["extensionsUsed"] = json!(["EXT_mesh_gpu_instancing"]);
            json["extensionsRequired"] = json!(["EXT_mesh_gpu_instancing"]);
            json["nodes"][0]["extensions"] = json!({"EXT_mesh_gpu_instancing": {"attributes": attributes}});
            change(json);
        })
    };
    // The corner (1, 0, 0) of each, in the axes of the file.
    let corners = |file: (Value, Vec<u8>)| -> Vec<[f64; 3]> {
        exact(file).unwrap().chunks(4).map(|square| square[1]).collect()
    };
    let moved = corners(file(json!({"TRANSLATION": 2}), |_| {}));
    assert_eq!(moved, [[11.0, 0.0, 0.0], [1.0, 20.0, 0.0]]);
    let all = json!({"TRANSLATION": 2, "ROTATION": 3, "SCALE": 4});
    // Turned about y, x becomes -z.
    assert_eq!(corners(file(all.clone(), |_| {})), [[10.0, 0.0, -1.0], [3.0, 20.0, 0.0]]);
    // Below its node; the node's child stands once.
    let found = exact(file(json!({"TRANSLATION": 2}), |json| {
        json["nodes"][0]["translation"] = json!([100, 0, 0]);
        json["nodes"][0]["children"] = json!([1]);
        json["nodes"].as_array_mut().unwrap().push(json!({"mesh": 0}));
    }))
    .unwrap();
    let corners: Vec<_> = found.chunks(4).map(|square| square[1]).collect();
    assert_eq!(corners, [[111.0, 0.0, 0.0], [101.0, 20.0, 0.0], [101.0, 0.0, 0.0]]);
    exactly_refused(
        file(json!({}), |_| {}),
        "node 0 \"ground\": EXT_mesh_gpu_instancing with [] translations, rotations or scales; expected at least one of \
         these, and as many of each",
    );
    exactly_refused(
        file(all, |json| json["accessors"][4]["count"] = json!(1)),
        "node 0 \"ground\": EXT_mesh_gpu_instancing with [2, 2, 1] translations, rotations or scales; expected at least \
         one of these, and as many of each",
    );
    exactly_refused(
        file(json!({"ROTATION": 2}), |_| {}),
        "accessor 2: ROTATION of VEC3 of F32; expected VEC4 of F32, or of normalized I8 or I16",
    );
    exactly_refused(
        file(json!({"SCALE": 3}), |_| {}),
        "accessor 3: SCALE of VEC4 of I16; expected VEC3 of F32",
    );
}

#[test]
fn skins_and_shapes_without_weight_move_nothing() {
    let file = |weights: [f32; 4]| {
        with_bytes(&reals(&SQUARE), &[&reals(&weights.repeat(4))], |json| {
            let weights = json!({"bufferView": 2, "componentType": 5126, "count": 4, "type": "VEC4"});
            json["accessors"].as_array_mut().unwrap().push(weights);
            json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] = json!(2);
            json["nodes"][0]["skin"] = json!(0);
        })
    };
    assert_eq!(exact(file([0.0; 4])).unwrap()[2], [1.0, 0.0, -1.0]);
    exactly_refused(
        file([0.0, 0.0, 0.0, 1.0]),
        "node 0 \"ground\": a skin that moves vertices; expected a rigid mesh: bake the pose into it (in Blender: apply the \
         armature, then export)",
    );
    // A skin for which no vertex has weights.
    assert!(changed(|json| json["nodes"][0]["skin"] = json!(0)).is_ok());
    assert!(changed(|json| json["meshes"][0]["weights"] = json!([0, 0])).is_ok());
    // A node's weights stand for those of its mesh.
    let both = |mesh: Value, node: Value| {
        changed(move |json| {
            json["meshes"][0]["weights"] = mesh;
            json["nodes"][0]["weights"] = node;
        })
    };
    assert!(both(json!([0.5]), json!([0])).is_ok());
    assert!(both(json!([0]), json!([0.5])).is_err());
}

#[test]
fn weights_of_a_skin_may_be_normalised_whole_numbers() {
    let file = |component: u32, is_normalized: bool, weights: &[u8]| {
        with_bytes(&reals(&SQUARE), &[weights], |json| {
            let weights = json!({"bufferView": 2, "componentType": component, "count": 4, "type": "VEC4",
                "normalized": is_normalized});
            json["accessors"].as_array_mut().unwrap().push(weights);
            json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] = json!(2);
            json["nodes"][0]["skin"] = json!(0);
        })
    };
    for (component, name, size) in [(5121, "U8", 1), (5123, "U16", 2)] {
        let mut weights = vec![0; 16 * size];
        assert_eq!(exact(file(component, true, &weights)).unwrap().len(), 4, "{name}");
        exactly_refused(
            file(component, false, &weights),
            &format!(
                "accessor 2: WEIGHTS of VEC4 of {name}; expected VEC4 of F32, or of normalized U8 or U16"
            ),
        );
        // The least weight that there is.
        weights[15 * size] = 1;
        let error = exact(file(component, true, &weights)).unwrap_err();
        assert!(error.contains("a skin that moves vertices"), "{error}");
    }
    exactly_refused(
        file(5120, true, &[0; 16]),
        "accessor 2: WEIGHTS of VEC4 of I8; expected VEC4 of F32, or of normalized U8 or U16",
    );
}
