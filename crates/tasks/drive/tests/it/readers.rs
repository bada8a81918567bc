//! Readers of tables, arrays and pictures, each from the description of its format alone.

use std::collections::BTreeMap;
use std::path::Path;

/// Array of numbers; the last axis runs fastest.
pub(crate) struct Array {
    pub shape: Vec<usize>,
    /// `<f8`, `|u1`, `<u2` or `<i4`.
    pub kind: String,
    pub values: Vec<f64>,
}

impl Array {
    /// Row `row` of a table, or of an image.
    pub(crate) fn row(&self, row: usize) -> &[f64] {
        let columns = self.shape[1];
        &self.values[row * columns..][..columns]
    }
}

/// NPY, version 1 to 3: the magic, two numbers of the version, the length of the header, the header, the numbers.
pub(crate) fn npy(path: &Path) -> Array {
    let bytes = std::fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    assert_eq!(&bytes[..6], b"\x93NUMPY", "{}", path.display());
    let (length, from) = match bytes[6] {
        1 => (usize::from(u16::from_le_bytes([bytes[8], bytes[9]])), 10),
        _ => (u32::from_le_bytes(bytes[8..12].try_into().unwrap()) as usize, 12),
    };
    let header = std::str::from_utf8(&bytes[from..from + length]).unwrap();
    assert!(header.contains("'fortran_order': False"), "{header}");
    let kind = header.split("'descr': '").nth(1).unwrap().split('\'').next().unwrap().to_string();
    let shape = header.split('(').nth(1).unwrap().split(')').next().unwrap();
    let shape: Vec<usize> = shape
        .split(',')
        .map(str::trim)
        .filter(|side| !side.is_empty())
        .map(|side| side.parse().unwrap())
        .collect();
    let data = &bytes[from + length..];
    let values: Vec<f64> = match kind.as_str() {
        "<f8" => data.chunks_exact(8).map(|b| f64::from_le_bytes(b.try_into().unwrap())).collect(),
        "<i4" => data.chunks_exact(4).map(|b| i32::from_le_bytes(b.try_into().unwrap()).into()).collect(),
        "<u2" => data.chunks_exact(2).map(|b| u16::from_le_bytes(b.try_into().unwrap()).into()).collect(),
        "|u1" => data.iter().map(|&b| b.into()).collect(),
        other => panic!("{}: numbers of {other}", path.display()),
    };
    assert_eq!(values.len(), shape.iter().product::<usize>(), "{}", path.display());
    Array { shape, kind, values }
}

/// Rows of a CSV file by the names in its first line. `end`: the end of each line.
pub(crate) fn csv(path: &Path, end: &str) -> Vec<BTreeMap<String, String>> {
    let text = std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let mut lines = text.strip_suffix(end).expect("a last line with an end").split(end);
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let row = |line: &str| {
        let fields: Vec<&str> = line.split(',').collect();
        assert_eq!(fields.len(), names.len(), "{line}");
        names.iter().zip(fields).map(|(name, field)| (name.to_string(), field.to_string())).collect()
    };
    lines.map(row).collect()
}

/// Number in a row of a table.
pub(crate) fn number(row: &BTreeMap<String, String>, name: &str) -> f64 {
    let field = row.get(name).unwrap_or_else(|| panic!("no column {name} in {row:?}"));
    field.parse().unwrap_or_else(|_| panic!("{name} is {field}"))
}

/// Numbers in columns of these names.
pub(crate) fn numbers<const N: usize>(row: &BTreeMap<String, String>, names: [&str; N]) -> [f64; N] {
    names.map(|name| number(row, name))
}

/// PNG of 16 bits of grey: columns, rows and numbers, the top row first.
pub(crate) fn png16(path: &Path) -> (usize, usize, Vec<f64>) {
    let file = std::io::BufReader::new(std::fs::File::open(path).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    assert_eq!((info.color_type, info.bit_depth), (png::ColorType::Grayscale, png::BitDepth::Sixteen));
    let values = bytes.chunks_exact(2).map(|pair| u16::from_be_bytes([pair[0], pair[1]]).into());
    (info.width as usize, info.height as usize, values.collect())
}

/// Binary PGM of 8 bits: columns, rows and numbers, the top row first.
pub(crate) fn pgm(path: &Path) -> (usize, usize, Vec<u8>) {
    let bytes = std::fs::read(path).unwrap();
    let mut lines = bytes.splitn(4, |&byte| byte == b'\n');
    let mut line = || lines.next().unwrap();
    assert_eq!(line(), b"P5");
    let size = String::from_utf8(line().to_vec()).unwrap();
    let size: Vec<usize> = size.split(' ').map(|side| side.parse().unwrap()).collect();
    assert_eq!(line(), b"255");
    let pixels = line().to_vec();
    assert_eq!(pixels.len(), size[0] * size[1]);
    (size[0], size[1], pixels)
}

/// The number behind a key of a simple YAML file, or the numbers of a list.
pub(crate) fn yaml(text: &str, key: &str) -> Vec<f64> {
    let line = text.lines().find_map(|line| line.strip_prefix(&format!("{key}: ")));
    let line = line.unwrap_or_else(|| panic!("no {key} in {text}"));
    let list = line.trim_start_matches('[').trim_end_matches(']');
    list.split(", ").map(|number| number.parse().unwrap()).collect()
}

/// Bytes of a message in CDR, little endian: each number at a multiple of its own size.
pub(crate) struct Cdr<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Cdr<'a> {
    pub(crate) fn new(message: &'a [u8]) -> Self {
        assert_eq!(message[..2], [0, 1], "plain CDR, little endian");
        Self { bytes: &message[4..], at: 0 }
    }

    fn take<const N: usize>(&mut self) -> [u8; N] {
        self.at = self.at.next_multiple_of(N);
        let bytes = self.bytes[self.at..self.at + N].try_into().unwrap();
        self.at += N;
        bytes
    }

    pub(crate) fn byte(&mut self) -> u8 {
        self.take::<1>()[0]
    }

    pub(crate) fn whole(&mut self) -> u32 {
        u32::from_le_bytes(self.take())
    }

    pub(crate) fn single(&mut self) -> f32 {
        f32::from_le_bytes(self.take())
    }

    pub(crate) fn real(&mut self) -> f64 {
        f64::from_le_bytes(self.take())
    }

    pub(crate) fn reals(&mut self, count: usize) -> Vec<f64> {
        (0..count).map(|_| self.real()).collect()
    }

    /// A sequence of bytes.
    pub(crate) fn sequence(&mut self) -> &'a [u8] {
        let count = self.whole() as usize;
        let bytes = &self.bytes[self.at..self.at + count];
        self.at += count;
        bytes
    }

    pub(crate) fn text(&mut self) -> String {
        let bytes = self.sequence();
        String::from_utf8(bytes.strip_suffix(b"\0").expect("a text ends in 0").to_vec()).unwrap()
    }

    /// `std_msgs/Header`: seconds, and the frame of reference.
    pub(crate) fn header(&mut self) -> (f64, String) {
        let (seconds, nanoseconds) = (self.whole(), self.whole());
        (f64::from(seconds) + 1e-9 * f64::from(nanoseconds), self.text())
    }

    /// Whether all of the message was read.
    pub(crate) fn is_at_the_end(&self) -> bool {
        self.at == self.bytes.len()
    }
}
