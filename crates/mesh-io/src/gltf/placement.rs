//! Numbers that place a node below its parent, in single or in double precision. (glTF 2.0, §3.5.3)

use gltf::json::scene::Node;
use raypencil_files::Fault;
use serde::Deserialize;

/// Transform of a node as its JSON states it; absent parts are `None`.
#[derive(Clone, Default, Deserialize)]
pub(super) struct Placement {
    /// Column by column. Most nodes have none, hence the box.
    pub(super) matrix: Option<Box<[f64; 16]>>,
    pub(super) translation: Option<[f64; 3]>,
    pub(super) rotation: Option<[f64; 4]>,
    pub(super) scale: Option<[f64; 3]>,
}

impl Placement {
    /// The numbers rounded to single precision: terrain has always been read so.
    pub(super) fn rounded(node: &Node) -> Self {
        Self {
            matrix: node.matrix.map(|matrix| Box::new(matrix.map(f64::from))),
            translation: node.translation.map(|translation| translation.map(f64::from)),
            rotation: node.rotation.map(|rotation| rotation.0.map(f64::from)),
            scale: node.scale.map(|scale| scale.map(f64::from)),
        }
    }

    /// For each node the doubles nearest to the numbers of the text. The `gltf` crate rounds them to single precision.
    pub(super) fn of_nodes(json: &[u8]) -> Result<Vec<Self>, Fault> {
        #[derive(Deserialize)]
        struct Placed {
            #[serde(default)]
            nodes: Vec<Placement>,
        }
        let unfit = |error: serde_json::Error| Fault::new("JSON", error.to_string(), "a glTF 2.0 asset");
        Ok(serde_json::from_slice::<Placed>(json).map_err(unfit)?.nodes)
    }
}
