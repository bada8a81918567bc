//! TIFF files by hand, from the specification: any tags, strips or tiles, either byte order, either size of
//! offsets. (TIFF 6.0, section 2)

pub use Values::{Double, Long, Short, Text};
use std::path::{Path, PathBuf};

/// Values of a tag.
#[derive(Clone)]
pub enum Values {
    Short(Vec<u16>),
    Long(Vec<u32>),
    Double(Vec<f64>),
    Text(&'static str),
}

/// Compression of samples.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Codec {
    Plain,
    PackBits,
    Deflate,
    Lzw,
    Zstd,
}

/// A file under construction: 4 x 3 pixels of 0.5 m and 2 m whose tie point is at (10, 5), if nothing is changed.
#[derive(Clone)]
pub struct Tiff {
    pub is_big_endian: bool,
    pub is_big: bool,
    pub codec: Codec,
    pub size: [usize; 2],
    /// Pixels along the sides of a tile; rows of a strip if there is only one number.
    pub block: Vec<usize>,
    /// Bytes of each sample in the file's byte order, row by row from the north, with their SampleFormat and bits.
    pub samples: Vec<Vec<u8>>,
    pub format: [u16; 2],
    pub tags: Vec<(u16, Values)>,
    /// Blocks that get no bytes.
    pub absent: Vec<usize>,
    /// 2: differences along a row; 3: those of a row's bytes, highest bytes first.
    pub predictor: u16,
}

/// The sample of column `c` and row `r` of the plain file: 100 r + c + 0.5.
pub fn plain_sample(column: usize, row: usize) -> f64 {
    (100 * row + column) as f64 + 0.5
}

impl Tiff {
    pub fn plain() -> Self {
        let tags = vec![
            (33550, Double(vec![0.5, 2.0, 0.0])),
            (33922, Double(vec![0.0, 0.0, 0.0, 10.0, 5.0, 0.0])),
            (34735, Short(vec![1, 1, 0, 2, 1024, 0, 1, 1, 1025, 0, 1, 1])),
        ];
        Self {
            is_big_endian: false,
            is_big: false,
            codec: Codec::Plain,
            size: [4, 3],
            block: vec![2],
            samples: Vec::new(),
            format: [3, 32],
            tags,
            absent: Vec::new(),
            predictor: 1,
        }
        .with(plain_sample)
    }

    /// Replaces the samples, of the type that `format` says.
    pub fn with(mut self, sample: impl Fn(usize, usize) -> f64) -> Self {
        let order = |mut bytes: Vec<u8>| {
            if self.is_big_endian {
                bytes.reverse();
            }
            bytes
        };
        let bytes = |value: f64| {
            order(match self.format {
                [1, 8] => vec![value as u8],
                [2, 8] => (value as i8).to_le_bytes().to_vec(),
                [1, 16] => (value as u16).to_le_bytes().to_vec(),
                [2, 16] => (value as i16).to_le_bytes().to_vec(),
                [1, 32] => (value as u32).to_le_bytes().to_vec(),
                [2, 32] => (value as i32).to_le_bytes().to_vec(),
                [3, 32] => (value as f32).to_le_bytes().to_vec(),
                _ => value.to_le_bytes().to_vec(),
            })
        };
        let [width, height] = self.size;
        self.samples = (0..height)
            .flat_map(|row| (0..width).map(move |column| (column, row)))
            .map(|(column, row)| bytes(sample(column, row)))
            .collect();
        self
    }

    pub fn tag(mut self, tag: u16, values: Values) -> Self {
        self.tags.retain(|(other, _)| *other != tag);
        self.tags.push((tag, values));
        self
    }

    pub fn without(mut self, tag: u16) -> Self {
        self.tags.retain(|(other, _)| *other != tag);
        self
    }

    /// Bytes of a row of a block before compression.
    fn row(&self, cells: &[Vec<u8>]) -> Vec<u8> {
        let size = usize::from(self.format[1] / 8);
        let big = |bytes: &[u8]| {
            if self.is_big_endian { bytes.to_vec() } else { bytes.iter().rev().copied().collect() }
        };
        match self.predictor {
            // Differences of samples as whole numbers of their size, which wrap.
            2 => {
                let number =
                    |bytes: &[u8]| big(bytes).iter().fold(0_u64, |n, &byte| n << 8 | u64::from(byte));
                let mut last = 0;
                let mut row = Vec::new();
                for cell in cells {
                    let next = number(cell);
                    let mut bytes = next.wrapping_sub(last).to_be_bytes()[8 - size..].to_vec();
                    if !self.is_big_endian {
                        bytes.reverse();
                    }
                    row.extend(bytes);
                    last = next;
                }
                row
            }
            // All first bytes of the row, then all second ones; differences of bytes. (TIFF technical note 3)
            3 => {
                let planes: Vec<u8> =
                    (0..size).flat_map(|byte| cells.iter().map(move |cell| big(cell)[byte])).collect();
                let before = std::iter::once(&0).chain(&planes);
                planes.iter().zip(before).map(|(byte, before)| byte.wrapping_sub(*before)).collect()
            }
            _ => cells.concat(),
        }
    }

    fn blocks(&self) -> Vec<Vec<u8>> {
        let [width, height] = self.size;
        let (across, down, is_tiled) = match self.block[..] {
            [rows] => (width, rows, false),
            [across, down] => (across, down, true),
            _ => panic!("one number or two"),
        };
        let padding = vec![0; usize::from(self.format[1] / 8)];
        let mut blocks = Vec::new();
        for y in (0..height).step_by(down) {
            for x in (0..width).step_by(across) {
                let rows = if is_tiled { y..y + down } else { y..(y + down).min(height) };
                let cell = |column: usize, row: usize| match column < width && row < height {
                    true => self.samples[row * width + column].clone(),
                    false => padding.clone(),
                };
                let row = |row: usize| {
                    self.row(&(x..x + across).map(|column| cell(column, row)).collect::<Vec<_>>())
                };
                blocks.push(self.codec.encode(&rows.flat_map(row).collect::<Vec<_>>()));
            }
        }
        self.absent.iter().for_each(|&index| blocks[index].clear());
        blocks
    }

    pub fn bytes(&self) -> Vec<u8> {
        let word = |value: u64, size: usize| match self.is_big_endian {
            true => value.to_be_bytes()[8 - size..].to_vec(),
            false => value.to_le_bytes()[..size].to_vec(),
        };
        let wide = if self.is_big { 8 } else { 4 };
        let blocks = self.blocks();
        let mut file = if self.is_big_endian { b"MM".to_vec() } else { b"II".to_vec() };
        match self.is_big {
            true => file.extend([word(43, 2), word(8, 2), word(0, 2)].concat()),
            false => file.extend(word(42, 2)),
        }
        // The directory follows the samples; its place is written last.
        let pointer = file.len();
        file.extend(word(0, wide));
        let (mut offsets, mut counts) = (Vec::new(), Vec::new());
        for block in &blocks {
            offsets.push(if block.is_empty() { 0 } else { file.len() as u32 });
            counts.push(block.len() as u32);
            file.extend(block);
        }
        let codec = match self.codec {
            Codec::Plain => 1,
            Codec::PackBits => 32773,
            Codec::Deflate => 8,
            Codec::Lzw => 5,
            Codec::Zstd => 50000,
        };
        let own = [
            (256, Short(vec![self.size[0] as u16])),
            (257, Short(vec![self.size[1] as u16])),
            (258, Short(vec![self.format[1]])),
            (259, Short(vec![codec])),
            (262, Short(vec![1])),
            (277, Short(vec![1])),
            (317, Short(vec![self.predictor])),
            (339, Short(vec![self.format[0]])),
        ];
        let layout = match self.block[..] {
            [rows] => vec![(278, Short(vec![rows as u16])), (273, Long(offsets)), (279, Long(counts))],
            _ => vec![
                (322, Short(vec![self.block[0] as u16])),
                (323, Short(vec![self.block[1] as u16])),
                (324, Long(offsets)),
                (325, Long(counts)),
            ],
        };
        let mut tags: Vec<(u16, Values)> = own.into_iter().chain(layout).collect();
        for (tag, values) in &self.tags {
            tags.retain(|(other, _)| other != tag);
            tags.push((*tag, values.clone()));
        }
        tags.sort_by_key(|(tag, _)| *tag);
        let mut directory = word(tags.len() as u64, if self.is_big { 8 } else { 2 });
        for (tag, values) in tags {
            let (kind, count, bytes) = match values {
                Short(values) => (3, values.len(), values.iter().flat_map(|&v| word(v.into(), 2)).collect()),
                Long(values) => (4, values.len(), values.iter().flat_map(|&v| word(v.into(), 4)).collect()),
                Double(values) => {
                    (12, values.len(), values.iter().flat_map(|v| word(v.to_bits(), 8)).collect())
                }
                Text(text) => (2, text.len() + 1, [text.as_bytes(), &[0]].concat()),
            };
            directory.extend([word(tag.into(), 2), word(kind, 2), word(count as u64, wide)].concat());
            let mut bytes: Vec<u8> = bytes;
            if bytes.len() <= wide {
                bytes.resize(wide, 0);
                directory.extend(bytes);
            } else {
                directory.extend(word(file.len() as u64, wide));
                file.extend(bytes);
            }
        }
        directory.extend(word(0, wide));
        let at = word(file.len() as u64, wide);
        file[pointer..pointer + wide].copy_from_slice(&at);
        file.extend(directory);
        file
    }

    pub fn write(&self, folder: &Path) -> PathBuf {
        let path = folder.join("dem.tif");
        std::fs::write(&path, self.bytes()).unwrap();
        path
    }
}

impl Codec {
    /// A valid stream, not a short one.
    fn encode(self, bytes: &[u8]) -> Vec<u8> {
        match self {
            Self::Plain => bytes.to_vec(),
            // Runs of literals: their length less one, then the bytes. (TIFF 6.0, section 9)
            Self::PackBits => bytes
                .chunks(128)
                .flat_map(|run| std::iter::once(run.len() as u8 - 1).chain(run.iter().copied()))
                .collect(),
            // A frame with a window of 128 KiB, of raw blocks; the lowest bit marks the last. (RFC 8878, section 3.1.1)
            Self::Zstd => {
                let mut stream = vec![0x28, 0xb5, 0x2f, 0xfd, 0, 7 << 3];
                let mut chunks = bytes.chunks(1 << 16).peekable();
                while let Some(chunk) = chunks.next() {
                    let header = (chunk.len() as u32) << 3 | u32::from(chunks.peek().is_none());
                    stream.extend(&header.to_le_bytes()[..3]);
                    stream.extend(chunk);
                }
                stream
            }
            // A zlib stream of stored blocks. (RFC 1950, RFC 1951 section 3.2.4)
            Self::Deflate => {
                let mut stream = vec![0x78, 0x01];
                let mut chunks = bytes.chunks(65535).peekable();
                while let Some(chunk) = chunks.next() {
                    stream.push(u8::from(chunks.peek().is_none()));
                    stream.extend((chunk.len() as u16).to_le_bytes());
                    stream.extend((!(chunk.len() as u16)).to_le_bytes());
                    stream.extend(chunk);
                }
                let (a, b) = bytes.iter().fold((1_u32, 0_u32), |(a, b), &byte| {
                    let a = (a + u32::from(byte)) % 65521;
                    (a, (b + a) % 65521)
                });
                stream.extend((b << 16 | a).to_be_bytes());
                stream
            }
            // Codes of nine bits: clear, 200 bytes, clear, ..., end. Before 511 codes none is longer. (Section 13)
            Self::Lzw => {
                let mut codes = Vec::new();
                for chunk in bytes.chunks(200) {
                    codes.push(256);
                    codes.extend(chunk.iter().map(|&byte| u16::from(byte)));
                }
                codes.push(257);
                let bits: Vec<bool> =
                    codes.iter().flat_map(|code| (0..9).rev().map(move |bit| code >> bit & 1 == 1)).collect();
                bits.chunks(8)
                    .map(|byte| {
                        byte.iter()
                            .enumerate()
                            .fold(0, |sum, (place, &bit)| sum | u8::from(bit) << (7 - place))
                    })
                    .collect()
            }
        }
    }
}
