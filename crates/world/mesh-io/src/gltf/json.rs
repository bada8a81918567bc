//! JSON of a glTF file to the types of the crate `gltf`, after the checks that the crate lacks. (glTF 2.0, §5)

use gltf::json::Root;
use raypencil_files::Fault;
use serde::de::{Error, Unexpected, Visitor};
use serde::{Deserialize, Deserializer};

/// Version and extensions, by which the rest can be understood or not.
#[derive(Deserialize)]
struct Head {
    asset: HeadAsset,
    #[serde(default, rename = "extensionsRequired")]
    required: Vec<String>,
}

#[derive(Deserialize)]
struct HeadAsset {
    version: String,
    #[serde(rename = "minVersion")]
    min_version: Option<String>,
}

/// Extension by which vertices may be whole numbers.
pub(super) const QUANTIZATION: &str = "KHR_mesh_quantization";

/// Extension by which a node's mesh stands several times.
const INSTANCING: &str = "EXT_mesh_gpu_instancing";

/// Whether a file says that it uses an extension.
pub(super) fn is_used(root: &Root, extension: &str) -> bool {
    root.extensions_used.iter().chain(&root.extensions_required).any(|name| name == extension)
}

/// Maximum number of objects in the JSON. CHOICE: an object of two bytes takes half a kilobyte of memory, and a ground
/// has a few dozen to a few thousand objects.
const MAX_OBJECTS: usize = 1 << 19;

/// Parses the JSON. serde_json refuses nesting deeper than 128, and skips unknown keys without recursion.
pub(super) fn root(json: &[u8]) -> Result<Root, Fault> {
    let unfit = |error: serde_json::Error| Fault::new("JSON", error.to_string(), "a glTF 2.0 asset");
    // Braces inside texts are counted as well; they are few, and this is a limit of memory only.
    let objects = json.iter().filter(|&&byte| byte == b'{').count();
    if objects > MAX_OBJECTS {
        return Err(Fault::new("JSON", format!("{objects} objects"), format!("at most {MAX_OBJECTS}")));
    }
    let head: Head = serde_json::from_slice(json).map_err(unfit)?;
    let HeadAsset { version, min_version } = &head.asset;
    if !version.starts_with("2.") || min_version.as_ref().is_some_and(|least| least != "2.0") {
        let found = format!("version {version:?}, minVersion {min_version:?}");
        return Err(Fault::new("asset", found, "glTF 2.0"));
    }
    // Extensions of light, colour and descriptions move no vertex.
    let harmless = |name: &str| {
        ["KHR_materials_", "KHR_texture_", "EXT_texture_", "KHR_lights_", "KHR_xmp"]
            .iter()
            .any(|start| name.starts_with(start))
    };
    let is_known = |name: &str| [QUANTIZATION, INSTANCING].contains(&name) || harmless(name);
    if let Some(name) = head.required.iter().find(|name| !is_known(name)) {
        let expected = match name.contains("draco") || name.contains("meshopt") {
            true => {
                "plain buffers; `gltf-transform cp IN OUT` decompresses, and so does Blender's import and export"
            }
            false => {
                "plain buffers and nodes; extensions are known only for quantized meshes, instances, materials, textures \
                 and lights"
            }
        };
        return Err(Fault::new("extensionsRequired", format!("{name:?}"), expected));
    }
    let _: References = serde_json::from_slice(json).map_err(unfit)?;
    serde_json::from_slice(json).map_err(unfit)
}

/// Every index that is followed. The crate keeps only the lowest 32 bits of an index, so that 2^32 would mean 0.
/// Reading these types is the check; their contents are not used.
#[derive(Deserialize)]
#[allow(dead_code, reason = "checked by being read")]
struct References {
    scene: Option<Index>,
    #[serde(default)]
    scenes: Vec<SceneReferences>,
    #[serde(default)]
    nodes: Vec<NodeReferences>,
    #[serde(default)]
    meshes: Vec<MeshReferences>,
    #[serde(default)]
    accessors: Vec<AccessorReferences>,
    #[serde(default, rename = "bufferViews")]
    views: Vec<ViewReferences>,
}

#[derive(Deserialize)]
#[allow(dead_code, reason = "checked by being read")]
struct SceneReferences {
    #[serde(default)]
    nodes: Vec<Index>,
}

#[derive(Deserialize)]
#[allow(dead_code, reason = "checked by being read")]
struct NodeReferences {
    children: Option<Vec<Index>>,
    mesh: Option<Index>,
}

#[derive(Deserialize)]
#[allow(dead_code, reason = "checked by being read")]
struct MeshReferences {
    #[serde(default)]
    primitives: Vec<PrimitiveReferences>,
}

#[derive(Deserialize)]
#[allow(dead_code, reason = "checked by being read")]
struct PrimitiveReferences {
    attributes: Option<AttributeReferences>,
    indices: Option<Index>,
    material: Option<Index>,
}

#[derive(Deserialize)]
#[allow(dead_code, reason = "checked by being read")]
struct AttributeReferences {
    #[serde(rename = "POSITION")]
    position: Option<Index>,
}

#[derive(Deserialize)]
#[allow(dead_code, reason = "checked by being read")]
struct AccessorReferences {
    #[serde(rename = "bufferView")]
    view: Option<Index>,
    sparse: Option<SparseReferences>,
}

#[derive(Deserialize)]
#[allow(dead_code, reason = "checked by being read")]
struct SparseReferences {
    indices: Option<PartReferences>,
    values: Option<PartReferences>,
}

#[derive(Deserialize)]
#[allow(dead_code, reason = "checked by being read")]
struct PartReferences {
    #[serde(rename = "bufferView")]
    view: Option<Index>,
}

#[derive(Deserialize)]
#[allow(dead_code, reason = "checked by being read")]
struct ViewReferences {
    buffer: Option<Index>,
}

/// An index from 0 to 2^32 - 1; it is checked, not stored.
struct Index;

impl<'de> Deserialize<'de> for Index {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct IndexVisitor;
        impl Visitor<'_> for IndexVisitor {
            type Value = Index;

            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("an index below 2^32")
            }

            fn visit_u64<E: Error>(self, index: u64) -> Result<Index, E> {
                u32::try_from(index)
                    .map(|_| Index)
                    .map_err(|_| E::invalid_value(Unexpected::Unsigned(index), &self))
            }
        }
        deserializer.deserialize_u64(IndexVisitor)
    }
}
