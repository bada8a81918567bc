//! Instances of a node's mesh by the extension EXT_mesh_gpu_instancing.

use glam::DAffine3;
use gltf::json::{Accessor, Index, Root};
use raypencil_files::Fault;

use crate::gltf::accessors::instance_vectors;
use crate::gltf::buffers::Buffers;
use crate::gltf::placement::{Instancing, Placement};
use crate::gltf::transform::local;

/// Transform of each instance to its node's axes. `place` is the node in messages.
pub(super) fn instances(
    root: &Root,
    buffers: &mut Buffers<'_>,
    Instancing { attributes }: &Instancing,
    place: &str,
) -> Result<Vec<DAffine3>, Fault> {
    let index = |accessor: u32| Index::<Accessor>::new(accessor);
    let translation: Option<Vec<[f64; 3]>> = attributes
        .translation
        .map(|accessor| instance_vectors(root, buffers, index(accessor), "TRANSLATION"))
        .transpose()?;
    let rotation: Option<Vec<[f64; 4]>> = attributes
        .rotation
        .map(|accessor| instance_vectors(root, buffers, index(accessor), "ROTATION"))
        .transpose()?;
    let scale: Option<Vec<[f64; 3]>> = attributes
        .scale
        .map(|accessor| instance_vectors(root, buffers, index(accessor), "SCALE"))
        .transpose()?;
    let counts: Vec<usize> =
        [translation.as_ref().map(Vec::len), rotation.as_ref().map(Vec::len), scale.as_ref().map(Vec::len)]
            .into_iter()
            .flatten()
            .collect();
    let (Some(&count), true) = (counts.first(), counts.windows(2).all(|pair| pair[0] == pair[1])) else {
        let found = format!("EXT_mesh_gpu_instancing with {counts:?} translations, rotations or scales");
        return Err(Fault::new(place, found, "at least one of these, and as many of each"));
    };
    let instance = |number: usize| {
        let placement = Placement::of_parts(
            translation.as_ref().map(|all| all[number]),
            rotation.as_ref().map(|all| all[number]),
            scale.as_ref().map(|all| all[number]),
        );
        let place = format!("{place}, instance {number}");
        Ok(local(&placement, &place)?.unwrap_or(DAffine3::IDENTITY))
    };
    (0..count).map(instance).collect()
}
