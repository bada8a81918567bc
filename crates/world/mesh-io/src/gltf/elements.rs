//! Storage of accessors: their elements in buffer views, plain or sparse. (glTF 2.0, §3.6.2)

use std::borrow::Cow;

use gltf::json::Root;
use gltf::json::accessor::sparse::Sparse;
use gltf::json::accessor::{Accessor, ComponentType};
use gltf::json::validation::Checked;
use raypencil_files::Fault;

use crate::gltf::buffers::Buffers;
use crate::gltf::json::is_used;

/// Maximum number of elements of an accessor that has no view: they are zeros that the file does not hold, so that a small file could
/// ask for much memory.
const MAX_ZEROS: u64 = 1 << 20;

/// Extensions that hold the bytes of an accessor elsewhere. Without them its zeros are no zeros.
const COMPRESSIONS: [&str; 3] =
    ["KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression"];

/// Place of an accessor in messages.
pub(super) fn place(index: usize) -> String {
    format!("accessor {index}")
}

/// Elements of an accessor, checked to lie within their buffer view.
pub(super) struct Elements<'a> {
    bytes: Cow<'a, [u8]>,
    start: usize,
    stride: usize,
    size: usize,
    pub(super) count: usize,
}

/// Where elements are stored.
struct Storage {
    view: usize,
    offset: u64,
    count: u64,
    /// Bytes of an element, and of each of its numbers.
    size: [usize; 2],
}

impl<'a> Elements<'a> {
    /// The elements of an accessor, of `size` bytes each, made of numbers of `component` bytes.
    pub(super) fn of(
        root: &Root,
        buffers: &'a mut Buffers<'_>,
        accessor: &Accessor,
        index: usize,
        [size, component]: [usize; 2],
    ) -> Result<Self, Fault> {
        let count = accessor.count.0;
        let base = accessor.buffer_view.map(|view| Storage {
            view: view.value(),
            offset: accessor.byte_offset.map_or(0, |offset| offset.0),
            count,
            size: [size, component],
        });
        match (base, &accessor.sparse) {
            (Some(base), None) => stored(root, buffers, &base, index),
            (base, sparse) => {
                let mut bytes = match base {
                    Some(base) => stored(root, buffers, &base, index)?.packed(),
                    None => zeros(root, index, count, size)?,
                };
                if let Some(sparse) = sparse {
                    replace(root, buffers, sparse, index, &mut bytes, [size, component])?;
                }
                Ok(Self { bytes: Cow::Owned(bytes), start: 0, stride: size, size, count: count as usize })
            }
        }
    }

    pub(super) fn bytes(&self, number: usize) -> &[u8] {
        let at = self.start + number * self.stride;
        &self.bytes[at..at + self.size]
    }

    /// Bytes of all elements, one after the other.
    fn packed(&self) -> Vec<u8> {
        (0..self.count).flat_map(|number| self.bytes(number)).copied().collect()
    }
}

/// Elements in a buffer view.
fn stored<'a>(
    root: &Root,
    buffers: &'a mut Buffers<'_>,
    storage: &Storage,
    index: usize,
) -> Result<Elements<'a>, Fault> {
    let &Storage { view: view_index, offset, count, size: [size, component] } = storage;
    let stride =
        root.buffer_views.get(view_index).and_then(|view| view.byte_stride).map_or(size, |stride| stride.0);
    if stride < size || stride > 252 {
        let found = format!("a stride of {stride} bytes in buffer view {view_index}");
        return Err(Fault::new(place(index), found, format!("{size} to 252")));
    }
    let view = buffers.view(view_index)?;
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
        let found = format!("numbers of {component} bytes from byte {start} of their buffer, {stride} apart");
        return Err(Fault::new(place(index), found, format!("multiples of {component}")));
    }
    // Both have been checked to be below the view's length.
    Ok(Elements { bytes: Cow::Borrowed(view), start: offset as usize, stride, size, count: count as usize })
}

/// Zeros, which an accessor without a view has.
fn zeros(root: &Root, index: usize, count: u64, size: usize) -> Result<Vec<u8>, Fault> {
    if let Some(name) = COMPRESSIONS.iter().find(|name| is_used(root, name)) {
        let found = format!("no buffer view, in a file with \"{name}\"");
        return Err(Fault::new(
            place(index),
            found,
            "a buffer view; `gltf-transform cp IN OUT` decompresses",
        ));
    }
    if !(1..=MAX_ZEROS).contains(&count) {
        let found = format!("{count} elements without a buffer view");
        return Err(Fault::new(place(index), found, format!("1 to {MAX_ZEROS}")));
    }
    Ok(vec![0; count as usize * size])
}

/// Replaces those elements that are stored on their own. (§3.6.2.3)
fn replace(
    root: &Root,
    buffers: &mut Buffers<'_>,
    sparse: &Sparse,
    index: usize,
    bytes: &mut [u8],
    [size, component]: [usize; 2],
) -> Result<(), Fault> {
    let wide = match sparse.indices.component_type {
        Checked::Valid(kind) => match kind.0 {
            ComponentType::U8 => 1,
            ComponentType::U16 => 2,
            ComponentType::U32 => 4,
            _ => 0,
        },
        Checked::Invalid => 0,
    };
    if wide == 0 {
        return Err(Fault::new(place(index), "sparse indices of another type", "U8, U16 or U32"));
    }
    let storage =
        |view: usize, offset: u64, size: [usize; 2]| Storage { view, offset, count: sparse.count.0, size };
    let (indices, values) = (&sparse.indices, &sparse.values);
    let count = bytes.len() / size;
    let replaced = stored(
        root,
        buffers,
        &storage(indices.buffer_view.value(), indices.byte_offset.0, [wide; 2]),
        index,
    )?;
    let mut places: Vec<usize> = Vec::with_capacity(replaced.count);
    for number in 0..replaced.count {
        let at = whole(replaced.bytes(number)) as usize;
        if at >= count || places.last().is_some_and(|&last| at <= last) {
            let found = format!("sparse index {number} is {at}");
            return Err(Fault::new(place(index), found, format!("indices below {count} that increase")));
        }
        places.push(at);
    }
    let values = stored(
        root,
        buffers,
        &storage(values.buffer_view.value(), values.byte_offset.0, [size, component]),
        index,
    )?;
    for (number, at) in places.into_iter().enumerate() {
        bytes[at * size..(at + 1) * size].copy_from_slice(values.bytes(number));
    }
    Ok(())
}

/// A whole number of one, two or four bytes.
pub(super) fn whole(bytes: &[u8]) -> u32 {
    // Little-endian; absent high bytes are zero.
    let mut word = [0; 4];
    word[..bytes.len()].copy_from_slice(bytes);
    u32::from_le_bytes(word)
}
