//! Zarr, version 3, to planes: stores whose chunks are plain bytes, as `render --format zarr` writes them. (Zarr core
//! specification 3.0)

use std::fs;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use serde_json::{Map, Value};

use crate::bytes;
use crate::error::{Fault, FileError};
use crate::limits::Limits;
use crate::npy::{header, raster_from_bytes};
use crate::values::Array;

/// Maximum size of a description, `zarr.json`: 1 MiB.
const MAX_DOCUMENT_BYTES: u64 = 1 << 20;

/// Name of the description of a group or an array.
const DOCUMENT: &str = "zarr.json";

/// The keys of a group's and of an array's description. (Zarr core specification 3.0, "Group metadata", "Array metadata";
/// `consolidated_metadata` copies the descriptions below a group, which are read where they are)
const GROUP_KEYS: [&str; 4] = ["zarr_format", "node_type", "attributes", "consolidated_metadata"];

const ARRAY_KEYS: [&str; 11] = [
    "zarr_format",
    "node_type",
    "shape",
    "data_type",
    "chunk_grid",
    "chunk_key_encoding",
    "fill_value",
    "codecs",
    "attributes",
    "storage_transformers",
    "dimension_names",
];

/// Names of the dimensions, in the order in which they are read. Other names say nothing of an order.
const DIMENSIONS: [&str; 3] = ["row", "column", "axis"];

/// An array of a store.
#[derive(Debug, Clone)]
pub struct ZarrArray {
    /// Folder of the array.
    pub path: PathBuf,
    /// Name of its group; empty if it is in none.
    pub group: String,
    /// Name of the array.
    pub name: String,
    /// Its numbers.
    pub array: Array,
}

/// Reads the arrays of a Zarr store, those of the store itself and of its groups: arrays of shape (rows, columns) or (rows,
/// columns, components). Arrays of another shape, such as coordinates, and deeper groups are left out.
///
/// # Errors
/// Names the folder, what was found and what was expected: another version, compressed chunks, a chunk that is not there, and
/// whatever a description says that would change the numbers: an extension that must be understood, a storage transformer, a scale
/// or an offset, dimensions in another order.
/// `limits.bytes` holds for all arrays together.
pub fn read_zarr(store: impl AsRef<Path>, limits: &Limits) -> Result<Vec<ZarrArray>, FileError> {
    let store = store.as_ref();
    let mut left = *limits;
    let mut arrays = Vec::new();
    if let Node::Array(_) = Node::read(store)? {
        let fault = Fault::new(DOCUMENT, "an array", "a group of arrays: name the folder above it");
        return Err(FileError::recording(store, fault));
    }
    for (name, path) in nodes(store)? {
        match Node::read(&path)? {
            Node::Array(document) => arrays.extend(read_array(&path, "", &name, &document, &mut left)?),
            Node::Group => {
                for (array, path) in nodes(&path)? {
                    if let Node::Array(document) = Node::read(&path)? {
                        arrays.extend(read_array(&path, &name, &array, &document, &mut left)?);
                    }
                }
            }
        }
    }
    Ok(arrays)
}

/// Whether a folder is a store or says so by its name.
pub(crate) fn is_zarr(folder: &Path) -> bool {
    let says_so = folder.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("zarr"));
    says_so || folder.join(DOCUMENT).is_file()
}

/// The groups and arrays in a folder, in the order of their names.
fn nodes(folder: &Path) -> Result<Vec<(String, PathBuf)>, FileError> {
    let refused = |error| FileError::io(folder, "read", error);
    let mut nodes = Vec::new();
    for entry in fs::read_dir(folder).map_err(refused)? {
        let path = entry.map_err(refused)?.path();
        if path.join(DOCUMENT).is_file() {
            nodes.push((path.file_name().unwrap_or_default().to_string_lossy().into_owned(), path));
        }
    }
    nodes.sort();
    Ok(nodes)
}

/// A description.
enum Node {
    Group,
    Array(Box<ArrayDocument>),
}

#[derive(Deserialize)]
struct NodeDocument {
    zarr_format: u64,
    node_type: String,
}

/// The keys of an array's description that are read. (Zarr core specification 3.0, "Array metadata")
#[derive(Deserialize)]
struct ArrayDocument {
    shape: Vec<u64>,
    data_type: Value,
    chunk_grid: Named<ChunkGrid>,
    chunk_key_encoding: Named<Option<Separator>>,
    codecs: Vec<Named<Option<Endian>>>,
    storage_transformers: Option<Vec<Value>>,
    dimension_names: Option<Vec<Option<String>>>,
    attributes: Option<Map<String, Value>>,
    /// All other keys.
    #[serde(flatten)]
    others: Map<String, Value>,
}

#[derive(Deserialize)]
struct Named<T> {
    name: String,
    #[serde(default = "Option::default")]
    configuration: Option<T>,
}

#[derive(Deserialize)]
struct ChunkGrid {
    chunk_shape: Vec<u64>,
}

#[derive(Deserialize)]
struct Separator {
    separator: Option<String>,
}

#[derive(Deserialize)]
struct Endian {
    endian: Option<String>,
}

impl Node {
    fn read(folder: &Path) -> Result<Self, FileError> {
        let path = folder.join(DOCUMENT);
        let refuse = |fault: Fault| FileError::recording(folder, fault);
        if !path.is_file() {
            let found = match folder.join(".zgroup").is_file() || folder.join(".zarray").is_file() {
                true => "a store of version 2",
                false => "no zarr.json",
            };
            return Err(refuse(Fault::new("Zarr store", found, "a store of version 3 that is complete")));
        }
        let text = bytes::read_file(&path, MAX_DOCUMENT_BYTES)
            .map_err(|error| FileError::io(&path, "read", error))?;
        let invalid = |error: serde_json::Error| {
            refuse(Fault::new(DOCUMENT, error.to_string(), "the description of Zarr 3.0"))
        };
        let NodeDocument { zarr_format, node_type } = serde_json::from_slice(&text).map_err(invalid)?;
        match (zarr_format, node_type.as_str()) {
            (3, "group") => {
                let keys = serde_json::from_slice(&text).map_err(invalid)?;
                understood(&keys, &GROUP_KEYS).map_err(refuse)?;
                check_attributes(keys.get("attributes").and_then(Value::as_object)).map_err(refuse)?;
                Ok(Self::Group)
            }
            (3, "array") => Ok(Self::Array(serde_json::from_slice(&text).map_err(invalid)?)),
            (3, other) => Err(refuse(Fault::new("node_type", format!("{other:?}"), "group or array"))),
            (other, _) => Err(refuse(Fault::new("zarr_format", other.to_string(), "3"))),
        }
    }
}

/// Refuses keys that are not known, but for extensions that say that they need not be understood. (Zarr core specification 3.0,
/// "Extension points")
fn understood(keys: &Map<String, Value>, known: &[&str]) -> Result<(), Fault> {
    let need_not = |value: &Value| value.get("must_understand") == Some(&Value::Bool(false));
    match keys.iter().find(|(key, value)| !known.contains(&key.as_str()) && !need_not(value)) {
        None => Ok(()),
        Some((key, value)) => {
            let expected = "no extension but those that say \"must_understand\": false";
            Err(Fault::new(format!("{DOCUMENT}, key {key:?}"), value.to_string(), expected))
        }
    }
}

impl ArrayDocument {
    /// That its numbers are those of its chunks, row by row.
    fn check_meaning(&self) -> Result<(), Fault> {
        understood(&self.others, &ARRAY_KEYS)?;
        if let Some([first, ..]) = self.storage_transformers.as_deref() {
            return Err(Fault::new("storage_transformers", first.to_string(), "none"));
        }
        check_fill_value(self.others.get("fill_value"))?;
        check_attributes(self.attributes.as_ref())?;
        // Older writers name dimensions there.
        let of_attributes =
            self.attributes.as_ref().and_then(|attributes| attributes.get("_ARRAY_DIMENSIONS"));
        let of_attributes = of_attributes
            .and_then(Value::as_array)
            .map(|names| names.iter().map(|name| name.as_str().map(String::from)).collect::<Vec<_>>());
        let named = [("dimension_names", &self.dimension_names), ("_ARRAY_DIMENSIONS", &of_attributes)];
        for (key, names) in named.into_iter().filter_map(|(key, names)| Some((key, names.as_deref()?))) {
            if names.len() != self.shape.len() {
                let expected = format!("{}, one for each length of shape", self.shape.len());
                return Err(Fault::new(key, format!("{} names", names.len()), expected));
            }
            for (place, name) in names.iter().enumerate() {
                let is = |own: &&str| name.as_deref().is_some_and(|name| name.eq_ignore_ascii_case(own));
                if DIMENSIONS.iter().position(is).is_some_and(|own| own != place) {
                    let names: Vec<&str> = names.iter().map(|name| name.as_deref().unwrap_or("?")).collect();
                    return Err(Fault::new(key, names.join(", "), DIMENSIONS.join(", ")));
                }
            }
        }
        Ok(())
    }
}

/// Refuses an array without a value for what was never written, and one whose value is none. (Zarr core specification 3.0, "Fill value")
fn check_fill_value(value: Option<&Value>) -> Result<(), Fault> {
    let is_hex = |text: &str| {
        text.strip_prefix("0x").is_some_and(|digits| digits.chars().all(|digit| digit.is_ascii_hexdigit()))
    };
    let is_number = |text: &str| ["NaN", "Infinity", "-Infinity"].contains(&text) || is_hex(text);
    let found = match value {
        Some(Value::Number(_) | Value::Bool(_)) => return Ok(()),
        Some(Value::String(text)) if is_number(text) => return Ok(()),
        Some(other) => other.to_string(),
        None => "not there".into(),
    };
    Err(Fault::new("fill_value", found, "a number, true or false, \"NaN\", \"Infinity\" or \"-Infinity\""))
}

/// Refuses attributes by which others read other numbers: xarray, and whoever reads by the CF conventions, multiplies and adds.
fn check_attributes(attributes: Option<&Map<String, Value>>) -> Result<(), Fault> {
    for (key, neutral) in [("scale_factor", 1.0), ("add_offset", 0.0)] {
        let value = attributes.and_then(|attributes| attributes.get(key));
        if let Some(value) = value.filter(|value| value.as_f64() != Some(neutral)) {
            let expected = format!("{neutral} or none: write the numbers as they are meant");
            return Err(Fault::new(format!("attributes, {key}"), value.to_string(), expected));
        }
    }
    Ok(())
}

/// An array; `None` if it has another shape than maps have.
fn read_array(
    path: &Path,
    group: &str,
    name: &str,
    document: &ArrayDocument,
    left: &mut Limits,
) -> Result<Option<ZarrArray>, FileError> {
    if !matches!(document.shape.len(), 2 | 3) {
        return Ok(None);
    }
    let refuse = |fault: Fault| FileError::recording(path, fault);
    document.check_meaning().map_err(refuse)?;
    let numbers = Chunks::of(document).and_then(|chunks| chunks.npy(path, left)).map_err(refuse)?;
    left.bytes = left.bytes.saturating_sub(numbers.len() as u64);
    let array = raster_from_bytes(&numbers, &Limits::default()).map_err(refuse)?;
    let whole = |array| ZarrArray { path: path.into(), group: group.into(), name: name.into(), array };
    Ok(array.map(whole))
}

/// How an array lies in files.
struct Chunks<'a> {
    /// Type as NPY names it, and its size in bytes.
    kind: (String, u64),
    shape: &'a [u64],
    chunk: &'a [u64],
    separator: &'a str,
}

impl<'a> Chunks<'a> {
    fn of(document: &'a ArrayDocument) -> Result<Self, Fault> {
        let codecs: Vec<&str> = document.codecs.iter().map(|codec| codec.name.as_str()).collect();
        let [bytes] = document.codecs.as_slice() else {
            let expected = "bytes alone: write the store without compression";
            return Err(Fault::new("codecs", codecs.join(", "), expected));
        };
        if bytes.name != "bytes" {
            return Err(Fault::new("codecs", codecs.join(", "), "bytes"));
        }
        let endian =
            bytes.configuration.as_ref().and_then(Option::as_ref).and_then(|it| it.endian.as_deref());
        let name = document.data_type.as_str().unwrap_or_default();
        let kind = match name {
            "bool" => Some("b1"),
            "int8" => Some("i1"),
            "int16" => Some("i2"),
            "int32" => Some("i4"),
            "int64" => Some("i8"),
            "uint8" => Some("u1"),
            "uint16" => Some("u2"),
            "uint32" => Some("u4"),
            "uint64" => Some("u8"),
            "float16" => Some("f2"),
            "float32" => Some("f4"),
            "float64" => Some("f8"),
            _ => None,
        };
        let Some(kind) = kind else {
            let expected = "bool, an integer of 8 to 64 bits or a float of 16 to 64";
            return Err(Fault::new("data_type", document.data_type.to_string(), expected));
        };
        let size = u64::from(kind.as_bytes()[1] - b'0');
        let order = match endian {
            Some("little") => "<",
            Some("big") => ">",
            // Of a single byte there is no order to tell.
            None if size == 1 => "|",
            None => return Err(Fault::new("codecs, endian", "not there", "little or big")),
            Some(other) => return Err(Fault::new("codecs, endian", format!("{other:?}"), "little or big")),
        };
        let grid = (document.chunk_grid.name.as_str(), document.chunk_grid.configuration.as_ref());
        let ("regular", Some(ChunkGrid { chunk_shape: chunk })) = grid else {
            return Err(Fault::new("chunk_grid", format!("{:?}", grid.0), "regular"));
        };
        if chunk.len() != document.shape.len() || chunk.contains(&0) {
            return Err(Fault::new(
                "chunk_shape",
                format!("{chunk:?}"),
                format!("one for {:?}", document.shape),
            ));
        }
        let encoding = &document.chunk_key_encoding;
        let separator = encoding.configuration.as_ref().and_then(Option::as_ref);
        let separator = separator.and_then(|it| it.separator.as_deref()).unwrap_or("/");
        if encoding.name != "default" || !matches!(separator, "/" | ".") {
            let found = format!("{:?} with {separator:?}", encoding.name);
            return Err(Fault::new("chunk_key_encoding", found, "default, with / or ."));
        }
        let order = if size == 1 { "|" } else { order };
        Ok(Self { kind: (format!("{order}{kind}"), size), shape: &document.shape, chunk, separator })
    }

    /// The array as the contents of an NPY file. Sizes are compared with those of the files before memory is asked for.
    fn npy(&self, path: &Path, limits: &Limits) -> Result<Vec<u8>, Fault> {
        let Self { kind: (kind, size), shape, chunk, separator } = self;
        let product = |lengths: &[u64]| lengths.iter().map(|&length| u128::from(length)).product::<u128>();
        let (cells, of_chunk) = (product(shape), product(chunk));
        let refuse = |found: String, expected: String| Err(Fault::new("shape", found, expected));
        // Chunks reach over the border of the array, but not over more than it has.
        let most = u128::from(limits.cells) * 4;
        if cells == 0
            || cells > most
            || of_chunk > most
            || cells * u128::from(*size) > u128::from(limits.bytes)
        {
            let expected = format!("1 to {most} numbers, at most {} bytes", limits.bytes);
            return refuse(format!("{shape:?} in chunks of {chunk:?}"), expected);
        }
        let counts: Vec<u64> = shape.iter().zip(chunk.iter()).map(|(all, one)| all.div_ceil(*one)).collect();
        let bytes_of_chunk = of_chunk as u64 * size;
        let indices = |number: u64| -> Vec<u64> {
            let mut rest = number;
            let mut indices: Vec<u64> = counts
                .iter()
                .rev()
                .map(|count| {
                    let index = rest % count;
                    rest /= count;
                    index
                })
                .collect();
            indices.reverse();
            indices
        };
        let file = |indices: &[u64]| {
            let key: Vec<String> = indices.iter().map(u64::to_string).collect();
            ["c".to_string()].into_iter().chain(key).collect::<Vec<_>>().join(separator)
        };
        let total = product(&counts) as u64;
        for number in 0..total {
            let name = file(&indices(number));
            match fs::metadata(path.join(&name)) {
                Ok(found) if found.is_file() && found.len() == bytes_of_chunk => {}
                Ok(found) => {
                    let expected = format!("the {bytes_of_chunk} of its shape");
                    return Err(Fault::new(
                        format!("chunk {name}"),
                        format!("{} bytes", found.len()),
                        expected,
                    ));
                }
                // A writer may leave out chunks that hold nothing but the value for "nothing".
                Err(_) => {
                    let expected = "a file for every chunk: write the empty ones, too";
                    return Err(Fault::new(format!("chunk {name}"), "not there", expected));
                }
            }
        }
        let lengths: Vec<String> = shape.iter().map(u64::to_string).collect();
        let mut npy = header(kind, &format!("({})", lengths.join(", ")));
        let start = npy.len();
        npy.resize(start + cells as usize * *size as usize, 0);
        for number in 0..total {
            let indices = indices(number);
            let name = file(&indices);
            let cells = bytes::read_file(&path.join(&name), bytes_of_chunk)
                .map_err(|error| Fault::new(format!("chunk {name}"), error.to_string(), "a file to read"))?;
            if cells.len() as u64 != bytes_of_chunk {
                let expected = format!("the {bytes_of_chunk} of its shape");
                return Err(Fault::new(format!("chunk {name}"), format!("{} bytes", cells.len()), expected));
            }
            self.place(&cells, &indices, &mut npy[start..]);
        }
        Ok(npy)
    }

    /// Copies the runs of a chunk to their places in the array.
    fn place(&self, cells: &[u8], indices: &[u64], array: &mut [u8]) {
        let Self { kind: (_, size), shape, chunk, .. } = self;
        let last = shape.len() - 1;
        let begin: Vec<u64> =
            indices.iter().zip(chunk.iter()).map(|(index, length)| index * length).collect();
        let run = chunk[last].min(shape[last] - begin[last]);
        for row in 0..chunk[..last].iter().product::<u64>() {
            // The place of this run along each dimension but the last.
            let (mut rest, mut stride, mut at) = (row, shape[last], begin[last]);
            let mut is_inside = true;
            for dimension in (0..last).rev() {
                let place = begin[dimension] + rest % chunk[dimension];
                rest /= chunk[dimension];
                is_inside &= place < shape[dimension];
                at += place * stride;
                stride *= shape[dimension];
            }
            if is_inside {
                let (from, to, bytes) =
                    ((row * chunk[last] * size) as usize, (at * size) as usize, (run * size) as usize);
                array[to..to + bytes].copy_from_slice(&cells[from..from + bytes]);
            }
        }
    }
}
