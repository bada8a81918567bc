//! Header of a PLY file: the elements of the file, and the type of each of their numbers.

use raypencil_files::Fault;

use crate::triangles::text::{quoted, words};

/// Maximum number of elements. Files have two to five.
const MAX_ELEMENTS: usize = 256;

/// Maximum number of properties of an element. Clouds of Gaussians have some sixty.
const MAX_PROPERTIES: usize = 1024;

/// How the numbers after the header are written.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Format {
    Text,
    LittleEndian,
    BigEndian,
}

/// Type of a number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Number {
    /// Signed integer of so many bytes.
    Signed(usize),
    /// Unsigned integer of so many bytes.
    Unsigned(usize),
    /// Real number of 4 or 8 bytes.
    Real(usize),
}

impl Number {
    /// Size in a binary file, bytes.
    pub(super) fn bytes(self) -> usize {
        match self {
            Self::Signed(bytes) | Self::Unsigned(bytes) | Self::Real(bytes) => bytes,
        }
    }

    /// Its old name, which most files have.
    pub(super) fn type_name(self) -> &'static str {
        match self {
            Self::Signed(1) => "char",
            Self::Signed(2) => "short",
            Self::Signed(_) => "int",
            Self::Unsigned(1) => "uchar",
            Self::Unsigned(2) => "ushort",
            Self::Unsigned(_) => "uint",
            Self::Real(4) => "float",
            Self::Real(_) => "double",
        }
    }
}

/// A number of each row of an element, or a list of them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Property<'a> {
    pub(super) name: &'a [u8],
    pub(super) number: Number,
    /// Type of the length of a list; `None` for a single number.
    pub(super) length: Option<Number>,
}

/// Rows of one kind: the vertices, the faces, or others.
#[derive(Debug, PartialEq)]
pub(super) struct Element<'a> {
    pub(super) name: &'a [u8],
    /// Number of rows, as the header claims.
    pub(super) count: u64,
    pub(super) properties: Vec<Property<'a>>,
}

#[derive(Debug, PartialEq)]
pub(super) struct Header<'a> {
    pub(super) format: Format,
    pub(super) elements: Vec<Element<'a>>,
    pub(super) bytes: usize,
    pub(super) lines: usize,
}

pub(super) fn read(file: &[u8]) -> Result<Header<'_>, Fault> {
    // Lines end as the first one does. Otherwise the first byte of a binary file could be taken for the rest of a line.
    let end = if file.get(3) == Some(&b'\r') && file.get(4) != Some(&b'\n') { b'\r' } else { b'\n' };
    let (mut format, mut elements) = (None, Vec::<Element>::new());
    let (mut bytes, mut lines) = (0, 0);
    loop {
        lines += 1;
        let place = || format!("line {lines}");
        let rest = &file[bytes..];
        // The last line has to end, or the numbers after it would start anywhere.
        let Some(length) = rest.iter().position(|&byte| byte == end) else {
            let found = format!("{} bytes without the end of a line", rest.len());
            return Err(Fault::new(place(), found, "`end_header` (is the file cut off?)"));
        };
        bytes += length + 1;
        let line = &rest[..length];
        let unfit = |expected: &str| Fault::new(place(), quoted(Some(line.trim_ascii())), expected);
        let mut words = words(line);
        match (lines, words.next()) {
            (1, Some(b"ply")) if words.next().is_none() => {}
            (1, _) => return Err(unfit("`ply`")),
            (_, Some(b"comment" | b"obj_info")) => {}
            (_, Some(b"format")) => {
                let known = match (words.next(), words.next()) {
                    (Some(b"ascii"), Some(b"1.0")) => Some(Format::Text),
                    (Some(b"binary_little_endian"), Some(b"1.0")) => Some(Format::LittleEndian),
                    (Some(b"binary_big_endian"), Some(b"1.0")) => Some(Format::BigEndian),
                    _ => None,
                };
                let expected = "once `format` with ascii, binary_little_endian or binary_big_endian, and 1.0";
                let known = known.filter(|_| format.is_none() && words.next().is_none());
                format = Some(known.ok_or_else(|| unfit(expected))?);
            }
            (_, Some(b"element")) => {
                let element = words
                    .next()
                    .zip(words.next().and_then(|count| std::str::from_utf8(count).ok()?.parse().ok()));
                let (Some((name, count)), None) = (element, words.next()) else {
                    return Err(unfit("`element`, a name and a number of rows"));
                };
                if elements.iter().any(|element| element.name == name) {
                    return Err(unfit("each element once"));
                }
                if elements.len() == MAX_ELEMENTS {
                    let found = format!("more than {MAX_ELEMENTS} elements");
                    return Err(Fault::new(place(), found, format!("at most {MAX_ELEMENTS}")));
                }
                elements.push(Element { name, count, properties: Vec::new() });
            }
            (_, Some(b"property")) => {
                let expected = "`property`, a type and a name, or `property list`, two types and a name";
                let property = property(&mut words).filter(|_| words.next().is_none());
                let property = property.ok_or_else(|| unfit(expected))?;
                let element =
                    elements.last_mut().ok_or_else(|| unfit("an `element` before its properties"))?;
                if element.properties.iter().any(|other| other.name == property.name) {
                    return Err(unfit("each property of an element once"));
                }
                if element.properties.len() == MAX_PROPERTIES {
                    let found = format!("more than {MAX_PROPERTIES} properties");
                    return Err(Fault::new(place(), found, format!("at most {MAX_PROPERTIES}")));
                }
                element.properties.push(property);
            }
            (_, Some(b"end_header")) => break,
            _ => return Err(unfit("format, comment, obj_info, element, property or end_header")),
        }
    }
    let format = format.ok_or_else(|| Fault::new("header", "no `format`", "a line with the format"))?;
    Ok(Header { format, elements, bytes, lines })
}

/// A property from the words of its line after the first.
fn property<'a>(words: &mut impl Iterator<Item = &'a [u8]>) -> Option<Property<'a>> {
    let kind = words.next()?;
    let (length, number) = match kind {
        // The length of a list is no real number.
        b"list" => {
            (Some(number(words.next()?)?).filter(|length| !matches!(length, Number::Real(_))), words.next()?)
        }
        _ => (None, kind),
    };
    if kind == b"list" && length.is_none() {
        return None;
    }
    Some(Property { length, number: self::number(number)?, name: words.next()? })
}

/// A type by its name, old or new.
fn number(name: &[u8]) -> Option<Number> {
    Some(match name {
        b"char" | b"int8" => Number::Signed(1),
        b"short" | b"int16" => Number::Signed(2),
        b"int" | b"int32" => Number::Signed(4),
        b"uchar" | b"uint8" => Number::Unsigned(1),
        b"ushort" | b"uint16" => Number::Unsigned(2),
        b"uint" | b"uint32" => Number::Unsigned(4),
        b"float" | b"float32" => Number::Real(4),
        b"double" | b"float64" => Number::Real(8),
        _ => return None,
    })
}
