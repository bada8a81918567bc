//! Wrong counts, offsets and references.

use serde_json::json;

use super::changes::set;
use crate::malformed::case::Case;

/// 4e12: more than any file holds, but too few to overflow a 64-bit product.
const TRILLIONS: u64 = 4_000_000_000_000;

pub(super) fn cases() -> Vec<Case> {
    let mut cases = vec![
        set("count-negative", "a negative count", "/accessors/0/count", json!(-4), "JSON"),
        set("count-real", "a count of 4.5", "/accessors/0/count", json!(4.5), "JSON"),
        set("count-text", "a count in quotes", "/accessors/0/count", json!("4"), "JSON"),
        set("count-0", "no vertices", "/accessors/0/count", json!(0), "accessor 0"),
        set("count-5", "one vertex too many", "/accessors/0/count", json!(5), "accessor 0"),
        set(
            "index-count-5",
            "a number of corners that is not a multiple of 3",
            "/accessors/1/count",
            json!(5),
            "accessor 1",
        ),
        set(
            "no-view-trillions",
            "4e12 zeros without a buffer view",
            "/accessors/0",
            json!({"componentType": 5126, "count": TRILLIONS, "type": "VEC3"}),
            "4000000000000",
        ),
        set(
            "sparse-trillions",
            "a sparse accessor of 4e12 entries",
            "/accessors/0",
            json!({
                "componentType": 5126, "count": 4, "type": "VEC3", "sparse": {
                    "count": TRILLIONS, "indices": {"bufferView": 1, "componentType": 5125}, "values": {"bufferView": 0}}
            }),
            "accessor 0",
        ),
        set("index-trillions", "4e12 indices", "/accessors/1/count", json!(TRILLIONS * 3), "faces"),
        set(
            "offset-top",
            "an accessor offset of 2^64 - 4",
            "/accessors/0/byteOffset",
            json!(u64::MAX - 3),
            "accessor 0",
        ),
        set(
            "view-top",
            "a view whose end is beyond 2^64",
            "/bufferViews/0/byteOffset",
            json!(u64::MAX - 3),
            "buffer view 0",
        ),
        set(
            "view-long",
            "a view longer than its buffer",
            "/bufferViews/0/byteLength",
            json!(61),
            "buffer view 0",
        ),
        set("view-negative", "a negative offset", "/bufferViews/0/byteOffset", json!(-4), "JSON"),
        set("buffer-long", "a buffer longer than its chunk", "/buffers/0/byteLength", json!(61), "buffer 0"),
        set("buffer-huge", "a buffer of 2^63 bytes", "/buffers/0/byteLength", json!(1_u64 << 63), "buffer 0"),
        set("beyond-2-64", "a length of 1e30", "/buffers/0/byteLength", json!(1e30), "JSON"),
        set("mesh-missing", "a reference to a missing mesh", "/nodes/0/mesh", json!(1), "mesh 1"),
        set(
            "accessor-missing",
            "a reference to a missing accessor",
            "/meshes/0/primitives/0/indices",
            json!(2),
            "accessor 2",
        ),
        set(
            "index-2-32",
            "an accessor beyond 2^32",
            "/meshes/0/primitives/0/indices",
            json!(1_u64 << 32),
            "JSON",
        ),
        set(
            "index-wraps",
            "a mesh of index 2^32, which 32 bits truncate to 0",
            "/nodes/0/mesh",
            json!(1_u64 << 32),
            "JSON",
        ),
        set(
            "child-wraps",
            "a root of index 2^32, which 32 bits truncate to 0",
            "/scenes/0/nodes",
            json!([1_u64 << 32]),
            "JSON",
        ),
        set(
            "view-missing",
            "a reference to a missing buffer view",
            "/accessors/0/bufferView",
            json!(7),
            "buffer view 7",
        ),
        set(
            "buffer-missing",
            "a reference to a missing buffer",
            "/bufferViews/0/buffer",
            json!(u32::MAX),
            "buffer 4294967295",
        ),
        set(
            "material-missing",
            "a reference to a missing material",
            "/meshes/0/primitives/0/material",
            json!(3),
            "material 3",
        ),
    ];
    for (name, count) in [("2-53", (1_u64 << 53) + 1), ("trillions", TRILLIONS), ("2-64", u64::MAX)] {
        cases.push(set(
            &format!("count-{name}"),
            "an enormous count",
            "/accessors/0/count",
            json!(count),
            "vertices",
        ));
    }
    cases
}
