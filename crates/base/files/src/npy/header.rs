//! Header of an NPY file: a Python dictionary of three keys. No other Python is understood.
//! (NumPy Enhancement Proposal 1; numpy.lib.format)

use crate::error::Fault;
use crate::shape::Shape;

#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Header {
    pub number: Number,
    pub big_endian: bool,
    pub fortran_order: bool,
    /// Any number of dimensions, the slowest first.
    pub shape: Vec<u64>,
}

impl Header {
    /// The shape as that of a raster.
    pub(super) fn raster(&self) -> Result<Shape, Fault> {
        match *self.shape.as_slice() {
            [rows, columns] => Ok(Shape { rows, columns, components: 1 }),
            [rows, columns, components] => Ok(Shape { rows, columns, components }),
            ref other => {
                let expected = "2 (rows, columns) or 3 (rows, columns, components)";
                Err(Fault::new("shape", format!("{} dimensions", other.len()), expected))
            }
        }
    }
}

/// Type of the numbers in an array.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Number {
    /// Real numbers of 2, 4 or 8 bytes.
    Real(usize),
    /// Unsigned integers of 1, 2, 4 or 8 bytes.
    Unsigned(usize),
    /// Signed integers of 1, 2, 4 or 8 bytes.
    Signed(usize),
    /// Truth values, a byte each.
    Bool,
}

impl Number {
    /// Size of one number, bytes.
    pub(super) fn bytes(self) -> usize {
        match self {
            Self::Real(bytes) | Self::Unsigned(bytes) | Self::Signed(bytes) => bytes,
            Self::Bool => 1,
        }
    }
}

/// First bytes of every NPY file.
const MAGIC: &[u8] = b"\x93NUMPY";

/// Types that are read, for messages.
const KNOWN_TYPES: &str = "f2, f4, f8, u1, u2, u4, u8, i1, i2, i4, i8 or b1";

/// Maximum length of the dictionary. NumPy's own have less than 200 bytes.
const MAX_HEADER_BYTES: usize = 1 << 16;

/// Splits a file into its header and its numbers.
pub(super) fn split(file: &[u8]) -> Result<(Header, &[u8]), Fault> {
    let cut =
        || Fault::new("header", format!("{} bytes", file.len()), "a complete header (is the file cut off?)");
    if !file.starts_with(MAGIC) {
        let found = format!("{:02x?}", &file[..file.len().min(6)]);
        return Err(Fault::new("first bytes", found, "the magic \"\\x93NUMPY\""));
    }
    let &[major, minor] = file.get(6..8).and_then(|version| version.first_chunk()).ok_or_else(cut)?;
    // The length has two bytes in version 1 and four later.
    let length = match (major, minor) {
        (1, 0) => file.get(8..10).map(|bytes| usize::from(u16::from_le_bytes([bytes[0], bytes[1]]))),
        (2 | 3, 0) => {
            file.get(8..12).map(|bytes| u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]) as usize)
        }
        _ => {
            return Err(Fault::new("header", format!("version {major}.{minor}"), "version 1.0, 2.0 or 3.0"));
        }
    };
    let length = length.ok_or_else(cut)?;
    let start = if major == 1 { 10 } else { 12 };
    if length > MAX_HEADER_BYTES {
        return Err(Fault::new(
            "header",
            format!("a length of {length}"),
            format!("at most {MAX_HEADER_BYTES} bytes"),
        ));
    }
    let text = file.get(start..start + length).ok_or_else(cut)?;
    Ok((Parser { text, at: 0 }.header()?, &file[start + length..]))
}

/// A value of the dictionary.
enum Value {
    Text(String),
    Truth(bool),
    Numbers(Vec<u64>),
}

/// Parser of the dictionary. Its values do not nest, so it needs no recursion.
struct Parser<'a> {
    text: &'a [u8],
    at: usize,
}

impl Parser<'_> {
    fn header(mut self) -> Result<Header, Fault> {
        let (mut descr, mut fortran_order, mut shape) = (None, None, None);
        self.expect(b'{')?;
        while !self.take(b'}') {
            let key = self.string()?;
            self.expect(b':')?;
            if key == "descr" && self.peek() == Some(b'[') {
                return Err(Fault::new("descr", "a structured type", KNOWN_TYPES));
            }
            let twice = match (key.as_str(), self.value()?) {
                ("descr", Value::Text(text)) => descr.replace(text).is_some(),
                ("fortran_order", Value::Truth(truth)) => fortran_order.replace(truth).is_some(),
                ("shape", Value::Numbers(numbers)) => shape.replace(numbers).is_some(),
                _ => return Err(self.unfit("`descr`, `fortran_order` and `shape`, each of its type")),
            };
            if twice {
                return Err(self.unfit("each key once"));
            }
            if !self.take(b',') {
                self.expect(b'}')?;
                break;
            }
        }
        if self.peek().is_some() {
            return Err(self.unfit("nothing after the dictionary"));
        }
        let lacks = |key: &str| Fault::new("header", format!("no `{key}`"), "descr, fortran_order and shape");
        let (number, big_endian) = number(&descr.ok_or_else(|| lacks("descr"))?)?;
        let fortran_order = fortran_order.ok_or_else(|| lacks("fortran_order"))?;
        let shape = shape.ok_or_else(|| lacks("shape"))?;
        Ok(Header { number, big_endian, fortran_order, shape })
    }

    fn unfit(&self, expected: &str) -> Fault {
        Fault::new(format!("header, character {}", self.at), "something else", expected)
    }

    /// The next character that is no white space; it is not consumed.
    fn peek(&mut self) -> Option<u8> {
        while self.text.get(self.at)?.is_ascii_whitespace() {
            self.at += 1;
        }
        self.text.get(self.at).copied()
    }

    /// Consumes the next character if it is the `wanted` one.
    fn take(&mut self, wanted: u8) -> bool {
        let there = self.peek() == Some(wanted);
        self.at += usize::from(there);
        there
    }

    /// Consumes the next character, which must be the `wanted` one.
    fn expect(&mut self, wanted: u8) -> Result<(), Fault> {
        match self.take(wanted) {
            true => Ok(()),
            false => Err(self.unfit(&format!("`{}`", char::from(wanted)))),
        }
    }

    /// A text in quotes of either kind. Texts with escapes are refused.
    fn string(&mut self) -> Result<String, Fault> {
        let quote = self.peek().filter(|quote| b"'\"".contains(quote)).ok_or_else(|| self.unfit("a text"))?;
        let rest = &self.text[self.at + 1..];
        let end =
            rest.iter().position(|&byte| byte == quote).ok_or_else(|| self.unfit("a text that ends"))?;
        let text = &rest[..end];
        if text.len() > 64 || !text.iter().all(|byte| byte.is_ascii_graphic() && *byte != b'\\') {
            return Err(self.unfit("a short text in plain characters"));
        }
        self.at += end + 2;
        Ok(text.iter().copied().map(char::from).collect())
    }

    fn value(&mut self) -> Result<Value, Fault> {
        match self.peek() {
            Some(b'\'' | b'"') => Ok(Value::Text(self.string()?)),
            Some(b'(') => {
                self.at += 1;
                let mut numbers = Vec::new();
                while !self.take(b')') {
                    numbers.push(self.whole()?);
                    if !self.take(b',') {
                        self.expect(b')')?;
                        break;
                    }
                }
                Ok(Value::Numbers(numbers))
            }
            _ => {
                for (word, truth) in [("True", true), ("False", false)] {
                    if self.text[self.at..].starts_with(word.as_bytes()) {
                        self.at += word.len();
                        return Ok(Value::Truth(truth));
                    }
                }
                Err(self.unfit("a text, True, False or (numbers)"))
            }
        }
    }

    fn whole(&mut self) -> Result<u64, Fault> {
        let digits = self
            .peek()
            .map_or(0, |_| self.text[self.at..].iter().take_while(|byte| byte.is_ascii_digit()).count());
        let text = std::str::from_utf8(&self.text[self.at..self.at + digits]).unwrap_or("");
        let number = text.parse().map_err(|_| self.unfit("a whole number below 2^64"))?;
        self.at += digits;
        // Python 2 marked long integers by an L.
        self.take(b'L');
        Ok(number)
    }
}

/// Type of the numbers that `descr` names, and whether their most significant byte comes first.
fn number(descr: &str) -> Result<(Number, bool), Fault> {
    let refuse = |found: String| Err(Fault::new("descr", found, KNOWN_TYPES));
    let (order, kind) = descr.split_at(descr.chars().next().map_or(0, char::len_utf8));
    let number = match kind {
        "f2" => Number::Real(2),
        "f4" => Number::Real(4),
        "f8" => Number::Real(8),
        "u1" => Number::Unsigned(1),
        "u2" => Number::Unsigned(2),
        "u4" => Number::Unsigned(4),
        "u8" => Number::Unsigned(8),
        "i1" => Number::Signed(1),
        "i2" => Number::Signed(2),
        "i4" => Number::Signed(4),
        "i8" => Number::Signed(8),
        "b1" => Number::Bool,
        _ => {
            let what = match kind.chars().next() {
                Some('O') => " (Python objects, which are code to be run)",
                Some('c') => " (complex numbers)",
                Some('f') => " (real numbers of a width that not every machine has)",
                Some('V') => " (a structured type)",
                Some('S' | 'U' | 'a') => " (texts)",
                Some('M' | 'm') => " (dates or durations)",
                _ => "",
            };
            return refuse(format!("\"{descr}\"{what}"));
        }
    };
    match order {
        "<" => Ok((number, false)),
        ">" => Ok((number, true)),
        "|" if number.bytes() == 1 => Ok((number, false)),
        _ => refuse(format!("\"{descr}\", whose byte order is none of <, >, or | for single bytes")),
    }
}
