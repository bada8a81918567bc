//! Accessors, typed numbers in buffer views: vertex positions and indices. (glTF 2.0, §3.6.2)

use gltf::json::accessor::{Accessor, ComponentType, Type};
use gltf::json::validation::Checked;
use gltf::json::{Index, Root};
use raypencil_files::Fault;

use crate::gltf::buffers::{Buffers, missing_reference};

/// The accessor at `index`.
pub(super) fn accessor(root: &Root, index: Index<Accessor>) -> Result<&Accessor, Fault> {
    let index = index.value();
    root.accessors.get(index).ok_or_else(|| missing_reference(place(index), root.accessors.len()))
}

/// Place of an accessor in messages.
fn place(index: usize) -> String {
    format!("accessor {index}")
}

/// Vertex positions: VEC3 of F32, interleaved or not, all finite.
pub(super) fn positions(
    root: &Root,
    buffers: &mut Buffers<'_>,
    index: Index<Accessor>,
) -> Result<Vec<[f32; 3]>, Fault> {
    let accessor = accessor(root, index)?;
    let index = index.value();
    let (component, shape) = kind(accessor);
    if (component, shape) != (Some(ComponentType::F32), Some(Type::Vec3)) {
        let found = format!("POSITION of {}", kind_name(component, shape));
        return Err(Fault::new(place(index), found, "VEC3 of F32"));
    }
    let elements = Elements::of(root, buffers, accessor, index, [12, 4])?;
    let mut vertices = Vec::with_capacity(elements.count);
    for number in 0..elements.count {
        let bytes = elements.bytes(number);
        let part = |axis: usize| {
            let at = 4 * axis;
            f32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]])
        };
        let vertex = [part(0), part(1), part(2)];
        if !vertex.iter().all(|coordinate| coordinate.is_finite()) {
            let [x, y, z] = vertex;
            let found = format!("vertex {number} is ({x}, {y}, {z})");
            return Err(Fault::new(place(index), found, "three finite numbers"));
        }
        vertices.push(vertex);
    }
    Ok(vertices)
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
        // Little-endian; absent high bytes are zero.
        let mut word = [0; 4];
        word[..size].copy_from_slice(elements.bytes(number));
        let vertex = u32::from_le_bytes(word);
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

/// Component type and shape for messages.
fn kind_name(component: Option<ComponentType>, shape: Option<Type>) -> String {
    let shape = shape.map_or("an unknown type".to_string(), |shape| format!("{shape:?}").to_uppercase());
    let component = component.map_or("unknown components".to_string(), |component| format!("{component:?}"));
    format!("{shape} of {component}")
}

/// Elements of an accessor, checked to lie within their buffer view.
struct Elements<'a> {
    view: &'a [u8],
    start: usize,
    stride: usize,
    size: usize,
    count: usize,
}

impl<'a> Elements<'a> {
    /// The elements of `size` bytes each, made of numbers of `component` bytes.
    fn of(
        root: &Root,
        buffers: &'a mut Buffers<'_>,
        accessor: &Accessor,
        index: usize,
        [size, component]: [usize; 2],
    ) -> Result<Self, Fault> {
        // CHOICE: sparse accessors are refused. They serve morph targets, which a terrain does not have.
        if accessor.sparse.is_some() {
            return Err(Fault::new(place(index), "sparse storage", "plain storage: sparse is not supported"));
        }
        let Some(view_index) = accessor.buffer_view else {
            return Err(Fault::new(place(index), "no buffer view", "a buffer view with its data"));
        };
        let view_index = view_index.value();
        let stride = root
            .buffer_views
            .get(view_index)
            .and_then(|view| view.byte_stride)
            .map_or(size, |stride| stride.0);
        if stride < size || stride > 252 {
            let found = format!("a stride of {stride} bytes in buffer view {view_index}");
            return Err(Fault::new(place(index), found, format!("{size} to 252")));
        }
        let view = buffers.view(view_index)?;
        let (count, offset) = (accessor.count.0, accessor.byte_offset.map_or(0, |offset| offset.0));
        // The last element need not be followed by the rest of its stride.
        let end = (u128::from(count).saturating_sub(1)) * stride as u128 + size as u128 + u128::from(offset);
        if count == 0 || end > view.len() as u128 {
            let found = format!("{count} elements of {size} bytes, {stride} apart, from byte {offset}");
            let expected = format!("1 or more within buffer view {view_index} of {} bytes", view.len());
            return Err(Fault::new(place(index), found, expected));
        }
        // An unaligned number would overlap two others, so the file cannot mean what it claims. (§3.6.2.4)
        let view_offset =
            root.buffer_views.get(view_index).and_then(|view| view.byte_offset).map_or(0, |at| at.0);
        let start = u128::from(view_offset) + u128::from(offset);
        if !start.is_multiple_of(component as u128) || !stride.is_multiple_of(component) {
            let found =
                format!("numbers of {component} bytes from byte {start} of their buffer, {stride} apart");
            return Err(Fault::new(place(index), found, format!("multiples of {component}")));
        }
        // Both have been checked to be below the view's length.
        Ok(Self { view, start: offset as usize, stride, size, count: count as usize })
    }

    /// Bytes of one element.
    fn bytes(&self, number: usize) -> &[u8] {
        let at = self.start + number * self.stride;
        &self.view[at..at + self.size]
    }
}
