//! The node hierarchy: which nodes are drawn, in which order, and where each stands. (glTF 2.0, §3.5)

use glam::{DAffine3, DMat3, DVec3};
use gltf::json::Root;
use gltf::json::scene::Node;

use crate::gltf::buffers::missing;
use raypencil_files::Fault;
use raypencil_scene::Pose;

/// Deeper than any hierarchy that means something: at this depth even harmless scales overflow.
const DEEPEST: usize = 1024;

/// A node that is drawn.
pub(crate) struct Placed {
    /// Index of the node.
    pub node: usize,
    /// From the node's own axes to the file's (y up).
    pub file_from_node: DAffine3,
}

/// The place of a node in messages.
pub(super) fn place(root: &Root, index: usize) -> String {
    match root.nodes.get(index).and_then(|node| node.name.as_ref()) {
        Some(name) => format!("node {index} {:?}", name.chars().take(80).collect::<String>()),
        None => format!("node {index}"),
    }
}

/// All nodes below the roots: a node before its children, children in their order.
pub(super) fn placed(root: &Root) -> Result<Vec<Placed>, Fault> {
    let parents = parents(root)?;
    let mut stack: Vec<(usize, DAffine3, usize)> = Vec::new();
    for &index in roots(root, &parents)?.iter().rev() {
        stack.push((index, DAffine3::IDENTITY, 1));
    }
    let mut placed = Vec::new();
    while let Some((index, file_from_parent, depth)) = stack.pop() {
        if depth > DEEPEST {
            let found = format!("{depth} levels deep");
            return Err(Fault::new(place(root, index), found, format!("at most {DEEPEST} levels")));
        }
        // Every index here is that of a node: the roots and children were checked.
        let node = &root.nodes[index];
        let parent_from_node = local(node, &place(root, index))?;
        let file_from_node = match parent_from_node {
            Some(transform) => file_from_parent * transform,
            None => file_from_parent,
        };
        placed.push(Placed { node: index, file_from_node });
        for child in node.children.iter().flatten().rev() {
            stack.push((child.value(), file_from_node, depth + 1));
        }
    }
    Ok(placed)
}

/// The one parent of each node. A node with two is refused, and so is a cycle.
fn parents(root: &Root) -> Result<Vec<Option<usize>>, Fault> {
    let mut parents = vec![None; root.nodes.len()];
    for (index, node) in root.nodes.iter().enumerate() {
        for child in node.children.iter().flatten() {
            let child = child.value();
            let slot = parents.get_mut(child).ok_or_else(|| {
                let found = format!("child {child}");
                Fault::new(place(root, index), found, format!("an index below {}", root.nodes.len()))
            })?;
            if let Some(first) = slot.replace(index) {
                let found = format!("a child of node {first} and of node {index}");
                return Err(Fault::new(place(root, child), found, "at most one parent"));
            }
        }
    }
    // With one parent each, a node is in or below a cycle exactly when it is not below a node without one.
    let mut below = vec![false; parents.len()];
    let mut stack: Vec<usize> = (0..parents.len()).filter(|&index| parents[index].is_none()).collect();
    while let Some(index) = stack.pop() {
        below[index] = true;
        stack.extend(root.nodes[index].children.iter().flatten().map(|child| child.value()));
    }
    match below.iter().position(|below| !below) {
        None => Ok(parents),
        Some(index) => Err(Fault::new(place(root, index), "in or below a cycle of nodes", "a tree")),
    }
}

/// The roots of the default scene; without one those of all scenes, each once; without any scene all nodes
/// that have no parent.
fn roots(root: &Root, parents: &[Option<usize>]) -> Result<Vec<usize>, Fault> {
    let scenes = match root.scene {
        Some(index) => {
            let index = index.value();
            let count = root.scenes.len();
            vec![(index, root.scenes.get(index).ok_or_else(|| missing(format!("scene {index}"), count))?)]
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
                // Drawn as a root it would stand elsewhere than its parent says.
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

/// A node's own transform, `None` if it has none: then vertices pass through untouched.
fn local(node: &Node, place: &str) -> Result<Option<DAffine3>, Fault> {
    let wide = |v: [f32; 3]| DVec3::new(f64::from(v[0]), f64::from(v[1]), f64::from(v[2]));
    let finite = |name: &str, numbers: &[f32]| match numbers.iter().all(|number| number.is_finite()) {
        true => Ok(()),
        false => Err(Fault::new(place, format!("{name} {numbers:?}"), "finite numbers")),
    };
    let has_parts = node.translation.is_some() || node.rotation.is_some() || node.scale.is_some();
    if let Some(matrix) = node.matrix {
        if has_parts {
            return Err(Fault::new(
                place,
                "a matrix beside translation, rotation or scale",
                "one or the other",
            ));
        }
        finite("matrix", &matrix)?;
        // Column by column; the last row is that of an affine map.
        let [a, b, c, d]: [[f32; 4]; 4] =
            std::array::from_fn(|column| std::array::from_fn(|row| matrix[4 * column + row]));
        if [a[3], b[3], c[3], d[3]] != [0.0, 0.0, 0.0, 1.0] {
            let found = format!("a matrix with the last row {:?}", [a[3], b[3], c[3], d[3]]);
            return Err(Fault::new(place, found, "[0, 0, 0, 1]"));
        }
        let column = |c: [f32; 4]| wide([c[0], c[1], c[2]]);
        let linear = DMat3::from_cols(column(a), column(b), column(c));
        return Ok(Some(DAffine3 { matrix3: linear, translation: column(d) }));
    }
    if !has_parts {
        return Ok(None);
    }
    let translation = node.translation.unwrap_or_default();
    let scale = node.scale.unwrap_or([1.0; 3]);
    let rotation = node.rotation.map_or([0.0, 0.0, 0.0, 1.0], |rotation| rotation.0);
    finite("translation", &translation)?;
    finite("scale", &scale)?;
    finite("rotation", &rotation)?;
    let [x, y, z, w] = rotation.map(f64::from);
    let norm_squared = x * x + y * y + z * z + w * w;
    // In single precision a unit quaternion is one to about 1e-7; the rest is for sloppy writers.
    if !(0.9..=1.1).contains(&norm_squared) {
        let found = format!("rotation {rotation:?}");
        return Err(Fault::new(place, found, "a unit quaternion"));
    }
    // `rotate` divides by the square of the length, so that what is left of it does not scale the ground.
    let turn = Pose { rotation: glam::DQuat::from_xyzw(x, y, z, w), ..Pose::IDENTITY };
    let scale = wide(scale);
    let linear = DMat3::from_cols(
        turn.rotate(DVec3::X) * scale.x,
        turn.rotate(DVec3::Y) * scale.y,
        turn.rotate(DVec3::Z) * scale.z,
    );
    Ok(Some(DAffine3 { matrix3: linear, translation: wide(translation) }))
}
