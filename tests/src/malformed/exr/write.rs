//! An OpenEXR writer without checks. (OpenEXR file layout, openexr.com)

// Compressions by their number in the file.
pub(super) const NONE: u8 = 0;
pub(super) const RLE: u8 = 1;
pub(super) const ZIP: u8 = 3;
pub(super) const PIZ: u8 = 4;
pub(super) const B44: u8 = 6;

/// A file of scan lines: a header, an offset table and blocks. Any part may be wrong.
#[derive(Clone)]
pub(super) struct Exr {
    pub(super) version: [u8; 4],
    /// Name, type and value of each attribute.
    pub(super) attributes: Vec<(String, String, Vec<u8>)>,
    /// First line and data of each block.
    pub(super) blocks: Vec<(i32, Vec<u8>)>,
    /// An offset table in place of the correct one.
    pub(super) offsets: Option<Vec<u64>>,
}

/// Integers as the file stores them.
pub(super) fn words(numbers: &[i32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

/// A list of channels: names, types (0 uint, 1 half, 2 float) and sampling steps.
pub(super) fn channels(list: &[(&str, i32, i32)]) -> Vec<u8> {
    let mut bytes = Vec::new();
    for (name, kind, step) in list {
        bytes.extend(name.as_bytes());
        bytes.push(0);
        bytes.extend(words(&[*kind, 0, *step, *step]));
    }
    bytes.push(0);
    bytes
}

impl Exr {
    /// A file of one channel of real numbers, without blocks.
    pub(super) fn new(columns: i32, rows: i32, compression: u8) -> Self {
        let window = words(&[0, 0, columns - 1, rows - 1]);
        let attribute = |name: &str, kind: &str, value: Vec<u8>| (name.to_string(), kind.to_string(), value);
        let attributes = vec![
            attribute("channels", "chlist", channels(&[("range.T", 2, 1)])),
            attribute("compression", "compression", vec![compression]),
            attribute("dataWindow", "box2i", window.clone()),
            attribute("displayWindow", "box2i", window),
            attribute("lineOrder", "lineOrder", vec![0]),
            attribute("pixelAspectRatio", "float", 1_f32.to_le_bytes().to_vec()),
            attribute("screenWindowCenter", "v2f", vec![0; 8]),
            attribute("screenWindowWidth", "float", 1_f32.to_le_bytes().to_vec()),
        ];
        Self { version: [2, 0, 0, 0], attributes, blocks: Vec::new(), offsets: None }
    }

    /// A well-formed file of 4 x 2 zeros, uncompressed.
    pub(super) fn small() -> Self {
        Self::new(4, 2, NONE).block(0, vec![0; 16]).block(1, vec![0; 16])
    }

    /// Adds a block.
    pub(super) fn block(mut self, line: i32, data: Vec<u8>) -> Self {
        self.blocks.push((line, data));
        self
    }

    /// Changes the value of an attribute.
    pub(super) fn with(mut self, name: &str, value: Vec<u8>) -> Self {
        if let Some(known) = self.attributes.iter_mut().find(|known| known.0 == name) {
            known.2 = value;
        }
        self
    }

    /// Adds an attribute.
    pub(super) fn more(mut self, name: &str, kind: &str, value: Vec<u8>) -> Self {
        self.attributes.push((name.into(), kind.into(), value));
        self
    }

    /// Removes an attribute.
    pub(super) fn without(mut self, name: &str) -> Self {
        self.attributes.retain(|known| known.0 != name);
        self
    }

    /// Sets both windows.
    pub(super) fn windows(self, numbers: [i32; 4]) -> Self {
        self.with("dataWindow", words(&numbers)).with("displayWindow", words(&numbers))
    }

    /// Replaces the offset table.
    pub(super) fn offsets(mut self, offsets: &[u64]) -> Self {
        self.offsets = Some(offsets.to_vec());
        self
    }

    /// The bytes of the header.
    pub(super) fn header(&self) -> Vec<u8> {
        let mut bytes = vec![0x76, 0x2f, 0x31, 0x01];
        bytes.extend(self.version);
        for (name, kind, value) in &self.attributes {
            bytes.extend([name.as_bytes(), b"\0", kind.as_bytes(), b"\0"].concat());
            bytes.extend((value.len() as i32).to_le_bytes());
            bytes.extend(value);
        }
        bytes.push(0);
        bytes
    }

    /// The bytes of the file.
    pub(super) fn bytes(&self) -> Vec<u8> {
        let mut bytes = self.header();
        let mut at = (bytes.len() + 8 * self.blocks.len()) as u64;
        let mut table = Vec::new();
        for (_, data) in &self.blocks {
            table.push(at);
            at += 8 + data.len() as u64;
        }
        bytes.extend(self.offsets.as_ref().unwrap_or(&table).iter().flat_map(|offset| offset.to_le_bytes()));
        for (line, data) in &self.blocks {
            bytes.extend(words(&[*line, data.len() as i32]));
            bytes.extend(data);
        }
        bytes
    }
}
