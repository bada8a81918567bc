//! Node hierarchy: the nodes that are drawn, in their order, each with its transform. (glTF 2.0, §3.5)

use glam::DAffine3;
use gltf::json::Root;
use raypencil_files::Fault;

use crate::gltf::buffers::{Buffers, missing_reference};
use crate::gltf::instances::instances;
use crate::gltf::placement::Placement;
use crate::gltf::transform::local;

/// Maximum depth of the hierarchy, levels. At this depth even a scale of 2 in each level overflows.
const MAX_DEPTH: usize = 1024;

/// A node that is drawn, with its transform.
pub(super) struct PlacedNode {
    /// Index of the node.
    pub node: usize,
    /// Transform from the node's own axes to those of the file (y up).
    pub file_from_node: DAffine3,
    /// Whether it is an instance of a node that stands several times.
    pub is_instance: bool,
}

pub(super) fn node_place(root: &Root, index: usize) -> String {
    match root.nodes.get(index).and_then(|node| node.name.as_ref()) {
        Some(name) => format!("node {index} {:?}", name.chars().take(80).collect::<String>()),
        None => format!("node {index}"),
    }
}

/// All nodes below the roots: a node before its children, children in the order of the file. A node with instances is there once
/// for each of them.
///
/// `json` is the text of `root`: transforms are read from it again, in double precision.
pub(super) fn placed_nodes(
    root: &Root,
    json: &[u8],
    buffers: &mut Buffers<'_>,
) -> Result<Vec<PlacedNode>, Fault> {
    // As many as `root` has nodes: both are read from the same list.
    let placements = Placement::of_nodes(json)?;
    let parents = parents(root)?;
    let mut stack: Vec<(usize, DAffine3, usize)> = Vec::new();
    for &index in roots(root, &parents)?.iter().rev() {
        stack.push((index, DAffine3::IDENTITY, 1));
    }
    let mut placed = Vec::new();
    while let Some((index, file_from_parent, depth)) = stack.pop() {
        if depth > MAX_DEPTH {
            let found = format!("{depth} levels deep");
            return Err(Fault::new(node_place(root, index), found, format!("at most {MAX_DEPTH} levels")));
        }
        // Every index is that of a node: roots and children have been checked.
        let node = &root.nodes[index];
        let parent_from_node = local(&placements[index], &node_place(root, index))?;
        let file_from_node = match parent_from_node {
            Some(transform) => file_from_parent * transform,
            None => file_from_parent,
        };
        // Instances are of the node's mesh; its children stand once.
        match placements[index].instancing().filter(|_| node.mesh.is_some()) {
            None => placed.push(PlacedNode { node: index, file_from_node, is_instance: false }),
            Some(instancing) => {
                let stand = instances(root, buffers, instancing, &node_place(root, index))?;
                placed.extend(stand.into_iter().map(|node_from_instance| PlacedNode {
                    node: index,
                    file_from_node: file_from_node * node_from_instance,
                    is_instance: true,
                }));
            }
        }
        for child in node.children.iter().flatten().rev() {
            stack.push((child.value(), file_from_node, depth + 1));
        }
    }
    Ok(placed)
}

/// Parent of each node. A node with two parents is refused, and so is a cycle.
fn parents(root: &Root) -> Result<Vec<Option<usize>>, Fault> {
    let mut parents = vec![None; root.nodes.len()];
    for (index, node) in root.nodes.iter().enumerate() {
        for child in node.children.iter().flatten() {
            let child = child.value();
            let slot = parents.get_mut(child).ok_or_else(|| {
                let found = format!("child {child}");
                Fault::new(node_place(root, index), found, format!("an index below {}", root.nodes.len()))
            })?;
            if let Some(first) = slot.replace(index) {
                let found = format!("a child of node {first} and of node {index}");
                return Err(Fault::new(node_place(root, child), found, "at most one parent"));
            }
        }
    }
    // Each node has at most one parent, so it is in or below a cycle exactly if it is not below a node without a
    // parent.
    let mut below = vec![false; parents.len()];
    let mut stack: Vec<usize> = (0..parents.len()).filter(|&index| parents[index].is_none()).collect();
    while let Some(index) = stack.pop() {
        below[index] = true;
        stack.extend(root.nodes[index].children.iter().flatten().map(|child| child.value()));
    }
    match below.iter().position(|below| !below) {
        None => Ok(parents),
        Some(index) => Err(Fault::new(node_place(root, index), "in or below a cycle of nodes", "a tree")),
    }
}

/// Roots of the default scene; without it the roots of all scenes, each once; without any scene all nodes that have no
/// parent.
fn roots(root: &Root, parents: &[Option<usize>]) -> Result<Vec<usize>, Fault> {
    let scenes = match root.scene {
        Some(index) => {
            let index = index.value();
            let count = root.scenes.len();
            vec![(
                index,
                root.scenes.get(index).ok_or_else(|| missing_reference(format!("scene {index}"), count))?,
            )]
        }
        None => root.scenes.iter().enumerate().collect(),
    };
    if scenes.is_empty() {
        return Ok((0..parents.len()).filter(|&index| parents[index].is_none()).collect());
    }
    let mut seen = vec![false; parents.len()];
    let mut roots = Vec::new();
    for (scene_index, scene) in scenes {
        for node in &scene.nodes {
            let node = node.value();
            let scene = format!("scene {scene_index}");
            match parents.get(node) {
                None => {
                    let found = format!("root node {node}");
                    return Err(Fault::new(scene, found, format!("an index below {}", parents.len())));
                }
                // As a root it would be drawn without its parent's transform.
                Some(Some(parent)) => {
                    let found = format!("root node {node}, a child of node {parent}");
                    return Err(Fault::new(scene, found, "roots without a parent"));
                }
                Some(None) if seen[node] => {}
                Some(None) => {
                    seen[node] = true;
                    roots.push(node);
                }
            }
        }
    }
    Ok(roots)
}
