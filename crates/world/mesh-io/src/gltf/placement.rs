//! Numbers that place a node below its parent, in double precision. (glTF 2.0, §3.5.3)

use raypencil_files::Fault;
use serde::Deserialize;

/// Transform of a node as its JSON states it; absent parts are `None`.
#[derive(Deserialize)]
pub(super) struct Placement {
    /// Column by column. Most nodes have none, hence the box.
    pub(super) matrix: Option<Box<[f64; 16]>>,
    pub(super) translation: Option<[f64; 3]>,
    pub(super) rotation: Option<[f64; 4]>,
    pub(super) scale: Option<[f64; 3]>,
    extensions: Option<Box<Extensions>>,
}

/// Extensions of a node that place its mesh.
#[derive(Deserialize)]
struct Extensions {
    #[serde(rename = "EXT_mesh_gpu_instancing")]
    instancing: Option<Instancing>,
}

/// Instances of a node's mesh.
#[derive(Deserialize)]
pub(super) struct Instancing {
    pub(super) attributes: InstanceAttributes,
}

/// Accessors of where the instances stand, below their node.
#[derive(Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub(super) struct InstanceAttributes {
    pub(super) translation: Option<u32>,
    pub(super) rotation: Option<u32>,
    pub(super) scale: Option<u32>,
}

impl Placement {
    /// A translation, a rotation and a scale, each if it is given.
    pub(super) fn of_parts(
        translation: Option<[f64; 3]>,
        rotation: Option<[f64; 4]>,
        scale: Option<[f64; 3]>,
    ) -> Self {
        Self { matrix: None, translation, rotation, scale, extensions: None }
    }

    /// Where instances of the node's mesh stand; `None`: it is drawn once.
    pub(super) fn instancing(&self) -> Option<&Instancing> {
        self.extensions.as_ref()?.instancing.as_ref()
    }

    /// For each node the doubles nearest to the numbers of the text.
    ///
    /// The `gltf` crate rounds them to single precision. At a map coordinate of 4,500,000 m that would move the ground
    /// by up to a quarter of a metre.
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
