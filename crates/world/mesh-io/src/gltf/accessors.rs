//! Typed numbers of accessors: vertex positions, indices, and where instances stand. (glTF 2.0, §3.6.2)

use gltf::json::accessor::{Accessor, ComponentType, Type};
use gltf::json::validation::Checked;
use gltf::json::{Index, Root};
use raypencil_files::Fault;
use serde_json::Value;

use crate::gltf::buffers::{Buffers, missing_reference};
use crate::gltf::elements::{Elements, place, whole};
use crate::gltf::json::{QUANTIZATION, is_used};

pub(super) fn accessor(root: &Root, index: Index<Accessor>) -> Result<&Accessor, Fault> {
    let index = index.value();
    root.accessors.get(index).ok_or_else(|| missing_reference(place(index), root.accessors.len()))
}

/// Vertex positions: VEC3 of F32, or of whole numbers where KHR_mesh_quantization is used; interleaved or not, all finite.
pub(super) fn positions(
    root: &Root,
    buffers: &mut Buffers<'_>,
    index: Index<Accessor>,
) -> Result<Vec<[f64; 3]>, Fault> {
    let expected = match is_used(root, QUANTIZATION) {
        true => "VEC3 of F32, or of I8, U8, I16 or U16",
        false => "VEC3 of F32; whole numbers need the extension KHR_mesh_quantization",
    };
    let takes = |component, _| {
        let is_quantized = matches!(
            component,
            ComponentType::I8 | ComponentType::U8 | ComponentType::I16 | ComponentType::U16
        );
        component == ComponentType::F32 || (is_quantized && is_used(root, QUANTIZATION))
    };
    let positions = vectors(root, buffers, index, ("POSITION", "vertex"), takes, expected)?;
    check_bounds(accessor(root, index)?, index.value(), &positions)?;
    Ok(positions)
}

/// Largest part of a box by which another one may lie beside it. Tuned: bounds of two digits, and those that a tool has not made anew after
/// it moved a vertex, are taken.
const BOUNDS_SLACK: f64 = 0.01;

/// Refuses positions that lie beside the bounds that their accessor states: then one of the two is of another mesh. Bounds that are a
/// little off change nothing, for they are not used.
fn check_bounds(accessor: &Accessor, index: usize, positions: &[[f64; 3]]) -> Result<(), Fault> {
    let stated = |value: &Option<Value>| -> Option<[f64; 3]> {
        let numbers: Vec<f64> = value.as_ref()?.as_array()?.iter().filter_map(Value::as_f64).collect();
        numbers.try_into().ok()
    };
    // Bounds of a normalised accessor are whole numbers, before they are divided. (§3.6.2.5)
    let (Some(low), Some(high), false) = (stated(&accessor.min), stated(&accessor.max), accessor.normalized)
    else {
        return Ok(());
    };
    let all = |axis: usize| positions.iter().map(move |position| position[axis]);
    let least: [f64; 3] = std::array::from_fn(|axis| all(axis).fold(f64::INFINITY, f64::min));
    let most: [f64; 3] = std::array::from_fn(|axis| all(axis).fold(f64::NEG_INFINITY, f64::max));
    let size = |low: [f64; 3], high: [f64; 3]| (0..3).map(|axis| high[axis] - low[axis]).fold(0.0, f64::max);
    let largest = [low, high, least, most].into_iter().flatten().map(f64::abs).fold(0.0, f64::max);
    let slack = BOUNDS_SLACK * size(low, high).max(size(least, most)) + f64::from(f32::EPSILON) * largest;
    let is_beside = |axis: usize| least[axis] > high[axis] + slack || most[axis] < low[axis] - slack;
    match (0..3).any(is_beside) {
        false => Ok(()),
        true => {
            let found = format!("positions in {least:?} to {most:?}, beside min {low:?} and max {high:?}");
            Err(Fault::new(place(index), found, "positions within min and max (§3.6.2.5)"))
        }
    }
}

/// Vectors of an instance's attribute: F32; of rotations, which have four numbers, also normalised I8 or I16.
pub(super) fn instance_vectors<const N: usize>(
    root: &Root,
    buffers: &mut Buffers<'_>,
    index: Index<Accessor>,
    name: &str,
) -> Result<Vec<[f64; N]>, Fault> {
    let expected = if N == 4 { "VEC4 of F32, or of normalized I8 or I16" } else { "VEC3 of F32" };
    let takes = |component, is_normalized| match component {
        ComponentType::F32 => true,
        ComponentType::I8 | ComponentType::I16 => N == 4 && is_normalized,
        _ => false,
    };
    vectors(root, buffers, index, (name, "instance"), takes, expected)
}

/// Weights of a skin: F32, or normalised U8 or U16.
pub(super) fn weights(
    root: &Root,
    buffers: &mut Buffers<'_>,
    index: Index<Accessor>,
) -> Result<Vec<[f64; 4]>, Fault> {
    let takes = |component, is_normalized| match component {
        ComponentType::F32 => true,
        ComponentType::U8 | ComponentType::U16 => is_normalized,
        _ => false,
    };
    vectors(root, buffers, index, ("WEIGHTS", "vertex"), takes, "VEC4 of F32, or of normalized U8 or U16")
}

/// Vectors of N numbers, whose components `takes` allows by their type and by whether they are normalised.
fn vectors<const N: usize>(
    root: &Root,
    buffers: &mut Buffers<'_>,
    index: Index<Accessor>,
    (name, each): (&str, &str),
    takes: impl Fn(ComponentType, bool) -> bool,
    expected: &str,
) -> Result<Vec<[f64; N]>, Fault> {
    let accessor = accessor(root, index)?;
    let index = index.value();
    let (component, shape) = kind(accessor);
    let wanted = if N == 4 { Type::Vec4 } else { Type::Vec3 };
    let component = match component.filter(|&component| takes(component, accessor.normalized)) {
        Some(component) if shape == Some(wanted) => component,
        _ => {
            let found = format!("{name} of {}", kind_name(component, shape));
            return Err(Fault::new(place(index), found, expected));
        }
    };
    let size = component.size();
    let elements = Elements::of(root, buffers, accessor, index, [N * size, size])?;
    let mut vectors = Vec::with_capacity(elements.count);
    for number in 0..elements.count {
        let bytes = elements.bytes(number);
        let vector: [f64; N] = std::array::from_fn(|axis| {
            real(&bytes[axis * size..(axis + 1) * size], component, accessor.normalized)
        });
        if !vector.iter().all(|part| part.is_finite()) {
            let words: Vec<String> = vector.iter().map(f64::to_string).collect();
            let found = format!("{each} {number} is ({})", words.join(", "));
            return Err(Fault::new(place(index), found, "finite numbers"));
        }
        vectors.push(vector);
    }
    Ok(vectors)
}

/// A number of an accessor. A normalised one is a fraction of two whole numbers, rounded once. (glTF 2.0, §3.6.2.2 and §3.11)
fn real(bytes: &[u8], component: ComponentType, is_normalized: bool) -> f64 {
    let fraction = |number: f64, most: f64| if is_normalized { (number / most).max(-1.0) } else { number };
    match (component, bytes) {
        (ComponentType::I8, &[byte]) => fraction(f64::from(byte as i8), 127.0),
        (ComponentType::U8, &[byte]) => fraction(f64::from(byte), 255.0),
        (ComponentType::I16, &[low, high]) => fraction(f64::from(i16::from_le_bytes([low, high])), 32767.0),
        (ComponentType::U16, &[low, high]) => fraction(f64::from(u16::from_le_bytes([low, high])), 65535.0),
        (ComponentType::F32, &[a, b, c, d]) => f64::from(f32::from_le_bytes([a, b, c, d])),
        // Refused before: it is no type of a vector.
        _ => f64::NAN,
    }
}

/// Vertex indices: SCALAR of U8, U16 or U32, each below `vertices`.
pub(super) fn indices(
    root: &Root,
    buffers: &mut Buffers<'_>,
    index: Index<Accessor>,
    vertices: usize,
) -> Result<Vec<u32>, Fault> {
    let accessor = accessor(root, index)?;
    let index = index.value();
    let (component, shape) = kind(accessor);
    let size = match (component, shape) {
        (Some(ComponentType::U8), Some(Type::Scalar)) => 1,
        (Some(ComponentType::U16), Some(Type::Scalar)) => 2,
        (Some(ComponentType::U32), Some(Type::Scalar)) => 4,
        _ => {
            let found = format!("indices of {}", kind_name(component, shape));
            return Err(Fault::new(place(index), found, "SCALAR of U8, U16 or U32"));
        }
    };
    let elements = Elements::of(root, buffers, accessor, index, [size, size])?;
    let mut indices = Vec::with_capacity(elements.count);
    for number in 0..elements.count {
        let vertex = whole(elements.bytes(number));
        if vertex as usize >= vertices {
            let found = format!("index {number} is {vertex}");
            return Err(Fault::new(place(index), found, format!("a vertex below {vertices}")));
        }
        indices.push(vertex);
    }
    Ok(indices)
}

/// Component type and shape of an accessor; `None` where they are unknown.
fn kind(accessor: &Accessor) -> (Option<ComponentType>, Option<Type>) {
    let component = match accessor.component_type {
        Checked::Valid(component) => Some(component.0),
        Checked::Invalid => None,
    };
    let shape = match accessor.type_ {
        Checked::Valid(shape) => Some(shape),
        Checked::Invalid => None,
    };
    (component, shape)
}

fn kind_name(component: Option<ComponentType>, shape: Option<Type>) -> String {
    let shape = shape.map_or("an unknown type".to_string(), |shape| format!("{shape:?}").to_uppercase());
    let component = component.map_or("unknown components".to_string(), |component| format!("{component:?}"));
    format!("{shape} of {component}")
}
