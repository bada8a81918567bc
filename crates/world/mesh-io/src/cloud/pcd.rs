//! PCD 0.5 to 0.7: text, binary and compressed. (Point Cloud Library, "The PCD (Point Cloud Data) file format")

use glam::DVec4;
use raypencil_files::Fault;

use super::columns::{Cloud, CloudColumn, check_names, decimal, whole_decimal};
use super::lzf;
use super::packed::{PackedField, PackedKind, PackedPoints, check_fields};
use super::printed::{Printed, with_decimals};

/// Maximum number of fields.
const MAX_FIELDS: usize = 1024;

/// The versions that are read.
const VERSIONS: [f64; 3] = [0.5, 0.6, 0.7];

/// How far the length of the viewpoint's quaternion may be from 1. Tuned: three decimals of each part are enough.
const VIEWPOINT_SLACK: f64 = 0.001;

/// Maximum bytes of the header.
const MAX_HEADER_BYTES: usize = 1 << 20;

/// What the lines before the numbers say.
struct Header {
    fields: Vec<PackedField>,
    width: u64,
    height: u64,
    points: u64,
    data: String,
    /// Where the numbers begin, bytes, and the number of the line.
    start: usize,
    line: usize,
}

fn header(file: &[u8]) -> Result<Header, Fault> {
    let (mut names, mut sizes, mut kinds, mut counts) = (None, None, None, None);
    let (mut width, mut height, mut points) = (None, None, None);
    let (mut start, mut line) = (0, 0);
    loop {
        line += 1;
        let place = format!("line {line}");
        let rest = &file[start..file.len().min(MAX_HEADER_BYTES)];
        let Some(length) = rest.iter().position(|&byte| byte == b'\n') else {
            return Err(Fault::new(place, "the end of the header", "a line `DATA` (is this a PCD file?)"));
        };
        let text = String::from_utf8_lossy(&rest[..length]).into_owned();
        start += length + 1;
        let mut words = text.split_ascii_whitespace().map(str::to_string);
        let Some(key) = words.next() else { continue };
        let values: Vec<String> = words.collect();
        let whole = || match values.as_slice() {
            [value] => value.parse::<u64>().ok(),
            _ => None,
        };
        let one = |expected: &str| {
            whole()
                .ok_or_else(|| Fault::new(place.clone(), values.join(" "), format!("{key} and {expected}")))
        };
        match key.as_str() {
            key if key.starts_with('#') => {}
            "VERSION" if !is_version(&values) => {
                let found = format!("VERSION {}", values.join(" "));
                return Err(Fault::new(place, found, "VERSION 0.5, 0.6 or 0.7"));
            }
            "VIEWPOINT" if !is_pose(&values) => {
                let found = format!("VIEWPOINT {}", values.join(" "));
                let expected =
                    "VIEWPOINT, a position and a unit quaternion, seven numbers: 0 0 0 1 0 0 0 for none";
                return Err(Fault::new(place, found, expected));
            }
            "VERSION" | "VIEWPOINT" => {}
            "FIELDS" | "COLUMNS" => names = Some(values),
            "SIZE" => sizes = Some(values),
            "TYPE" => kinds = Some(values),
            "COUNT" => counts = Some(values),
            "WIDTH" => width = Some(one("a number of points")?),
            "HEIGHT" => height = Some(one("a number of rows")?),
            "POINTS" => points = Some(one("a number of points")?),
            "DATA" => {
                let known = ["ascii", "binary", "binary_compressed"];
                let data = match values.as_slice() {
                    [data] if known.contains(&data.as_str()) => data.clone(),
                    _ => {
                        return Err(Fault::new(
                            place,
                            values.join(" "),
                            "DATA and ascii, binary or binary_compressed",
                        ));
                    }
                };
                let missing =
                    |what: &str| Fault::new("header", format!("no {what}"), format!("a line `{what}`"));
                let names: Vec<String> = names.ok_or_else(|| missing("FIELDS"))?;
                let width = width.ok_or_else(|| missing("WIDTH"))?;
                let height = height.unwrap_or(1);
                let product = width.checked_mul(height);
                let points = points.or(product).ok_or_else(|| missing("POINTS"))?;
                if product != Some(points) {
                    let found = format!("{points} POINTS, {width} WIDTH, {height} HEIGHT");
                    return Err(Fault::new("header", found, "WIDTH times HEIGHT points"));
                }
                let fields = fields(names, sizes, kinds, counts)?;
                return Ok(Header { fields, width, height, points, data, start, line });
            }
            _ => {
                let expected = "VERSION, FIELDS, SIZE, TYPE, COUNT, WIDTH, HEIGHT, VIEWPOINT, POINTS or DATA";
                return Err(Fault::new(place, key, expected));
            }
        }
    }
}

/// Whether a version is one that is read.
fn is_version(values: &[String]) -> bool {
    match values {
        [value] => value.parse().is_ok_and(|version: f64| VERSIONS.contains(&version)),
        _ => false,
    }
}

/// Whether these are the numbers of a pose. The points are in the frame that is declared of them, whatever it says.
fn is_pose(values: &[String]) -> bool {
    let numbers: Vec<f64> = values.iter().filter_map(|value| value.parse().ok()).collect();
    let is_finite = numbers.iter().all(|number| number.is_finite());
    let is_unit = |rotation: &[f64]| (DVec4::from_slice(rotation).length() - 1.0).abs() <= VIEWPOINT_SLACK;
    values.len() == 7 && numbers.len() == 7 && is_finite && is_unit(&numbers[3..])
}

fn fields(
    names: Vec<String>,
    sizes: Option<Vec<String>>,
    kinds: Option<Vec<String>>,
    counts: Option<Vec<String>>,
) -> Result<Vec<PackedField>, Fault> {
    if names.len() > MAX_FIELDS {
        return Err(Fault::new("FIELDS", format!("{} names", names.len()), format!("at most {MAX_FIELDS}")));
    }
    check_names(&names)?;
    let ones = || names.iter().map(|_| "1".to_string()).collect::<Vec<_>>();
    let lists = [("SIZE", sizes), ("TYPE", kinds), ("COUNT", counts.or_else(|| Some(ones())))];
    let [sizes, kinds, counts] = lists.map(|(key, list)| {
        let list = list.unwrap_or_default();
        if list.len() == names.len() {
            return Ok(list);
        }
        Err(Fault::new(key, format!("{} words", list.len()), format!("{}, one for each field", names.len())))
    });
    let (sizes, kinds, counts) = (sizes?, kinds?, counts?);
    let mut fields: Vec<PackedField> = Vec::new();
    for (index, name) in names.into_iter().enumerate() {
        let size = sizes[index].parse().ok().filter(|size| [1, 2, 4, 8].contains(size));
        let kind = match kinds[index].as_str() {
            "I" => Some(PackedKind::Signed),
            "U" => Some(PackedKind::Unsigned),
            "F" => Some(PackedKind::Real),
            _ => None,
        };
        let is_type = |size: usize, kind: PackedKind| kind != PackedKind::Real || size >= 4;
        let (Some(size), Some(kind)) =
            (size, kind.filter(|kind| size.is_some_and(|size| is_type(size, *kind))))
        else {
            let found = format!("SIZE {}, TYPE {}", sizes[index], kinds[index]);
            let expected = "SIZE 1, 2, 4 or 8 and TYPE I, U or F, which has 4 or 8";
            return Err(Fault::new(format!("field `{name}`"), found, expected));
        };
        let Some(count) = counts[index].parse().ok().filter(|count| (1..=1 << 16).contains(count)) else {
            return Err(Fault::new(
                format!("field `{name}`"),
                format!("COUNT {}", counts[index]),
                "1 to 65536",
            ));
        };
        let offset = fields.last().map_or(0, |last| last.offset + last.bytes());
        fields.push(PackedField { name, offset, kind, size, count });
    }
    check_fields(&fields)?;
    Ok(fields)
}

pub(super) fn read(file: &[u8], keeps: impl Fn(&str) -> bool) -> Result<Cloud, Fault> {
    let header = header(file)?;
    let body = &file[header.start..];
    let keeps_name = &keeps;
    let keeps = |field: &PackedField| field.is_kept() && keeps_name(&field.name);
    let columns = match header.data.as_str() {
        "ascii" => of_text(&header, body, keeps)?,
        _ if is_of_text(&header, body) => {
            let place = format!("line {}", header.line);
            let found = format!("DATA {}, before rows of numbers as text", header.data);
            return Err(Fault::new(place, found, "DATA ascii, or the bytes of the numbers"));
        }
        "binary" => {
            let point_step: usize = header.fields.iter().map(PackedField::bytes).sum();
            let data = of_size(&header, body, point_step as u64)?;
            let row_step = point_step * header.width as usize;
            let size = [header.width, header.height];
            let fields = &header.fields;
            let points = PackedPoints { fields, size, point_step, row_step, is_big_endian: false, data };
            points.cloud(keeps_name)?.columns
        }
        _ => {
            let stride: usize = header.fields.iter().map(PackedField::bytes).sum();
            let word = |at: usize| -> Option<u64> {
                Some(u64::from(u32::from_le_bytes(body.get(at..at + 4)?.try_into().ok()?)))
            };
            let (Some(packed), Some(length)) = (word(0), word(4)) else {
                return Err(Fault::new(
                    "data",
                    format!("{} bytes", body.len()),
                    "two sizes of 4 bytes, then as many",
                ));
            };
            let claimed = header.points.checked_mul(stride as u64);
            if claimed != Some(length) {
                let found = format!("{length} bytes, uncompressed");
                return Err(Fault::new(
                    "data",
                    found,
                    format!("{stride} for each of {} points", header.points),
                ));
            }
            let Some(packed) = usize::try_from(packed).ok().and_then(|packed| body.get(8..8 + packed)) else {
                let found = format!("{} bytes after the sizes", body.len() - 8);
                return Err(Fault::new(
                    "data",
                    found,
                    format!("{packed} compressed bytes (is the file cut off?)"),
                ));
            };
            check_end(&body[8 + packed.len()..])?;
            let bytes = lzf::inflated(packed, length)?;
            // Field by field, all points of each.
            let mut start = 0;
            let mut columns = Vec::new();
            for field in &header.fields {
                let end = start + field.bytes() * header.points as usize;
                if keeps(field) {
                    columns.push(CloudColumn {
                        name: field.name.clone(),
                        storage: field.storage(),
                        values: bytes[start..end]
                            .chunks_exact(field.size)
                            .map(|bytes| field.number(bytes, false))
                            .collect(),
                    });
                }
                start = end;
            }
            columns
        }
    };
    Ok(Cloud { width: header.width, height: header.height, columns })
}

/// Whether the bytes after the header begin with a row of numbers as text, one for each number of a point.
fn is_of_text(header: &Header, body: &[u8]) -> bool {
    let mut lines = body[..body.len().min(MAX_HEADER_BYTES)].split(|&byte| byte == b'\n');
    let first = lines.find(|line| !line.trim_ascii().is_empty());
    let Some(Ok(first)) = first.map(std::str::from_utf8) else { return false };
    let width: usize = header.fields.iter().map(|field| field.count).sum();
    let words = || first.split_ascii_whitespace();
    words().count() == width && words().all(|word| word.parse::<f64>().is_ok())
}

/// The bytes of all points, after it is known that they are there.
fn of_size<'a>(header: &Header, body: &'a [u8], stride: u64) -> Result<&'a [u8], Fault> {
    let claimed = header.points.checked_mul(stride);
    match claimed.and_then(|claimed| usize::try_from(claimed).ok()).and_then(|claimed| body.get(..claimed)) {
        Some(bytes) => {
            check_end(&body[bytes.len()..])?;
            Ok(bytes)
        }
        None => {
            let found = format!("{} bytes", body.len());
            let expected = format!("{stride} for each of {} points (is the file cut off?)", header.points);
            Err(Fault::new("data", found, expected))
        }
    }
}

/// Refuses bytes behind the points: header and numbers then do not belong together. The Point Cloud Library up to 1.8 leaves zeros there, as
/// it makes a file longer than its numbers.
fn check_end(surplus: &[u8]) -> Result<(), Fault> {
    match surplus.iter().all(|&byte| byte == 0) {
        true => Ok(()),
        false => {
            let found = format!("{} bytes after the last point", surplus.len());
            Err(Fault::new("data", found, "the end of the file, or zeros"))
        }
    }
}

fn of_text(
    header: &Header,
    body: &[u8],
    keeps: impl Fn(&PackedField) -> bool,
) -> Result<Vec<CloudColumn>, Fault> {
    let is_text = |byte: u8| byte.is_ascii_graphic() || byte.is_ascii_whitespace();
    if let Some(at) = body.iter().position(|&byte| !is_text(byte)) {
        let lines = body[..at].iter().filter(|&&byte| byte == b'\n').count();
        let place = format!("line {}", header.line + 1 + lines);
        let expected = "numbers as text, as `DATA ascii` says (is it DATA binary?)";
        return Err(Fault::new(place, "bytes that are no text", expected));
    }
    let width: usize = header.fields.iter().map(|field| field.count).sum();
    // A digit and a blank, or the end of the line, for each number.
    let least = (2 * width as u64).checked_mul(header.points);
    if least.is_none_or(|least| least > body.len() as u64 + 1) {
        let found = format!("{} bytes", body.len());
        return Err(Fault::new(
            "data",
            found,
            format!("{width} numbers for each of {} points", header.points),
        ));
    }
    let mut columns: Vec<(CloudColumn, Vec<Printed>)> = Vec::new();
    for field in header.fields.iter().filter(|field| keeps(field)) {
        let values = Vec::with_capacity(header.points as usize);
        columns
            .push((CloudColumn { name: field.name.clone(), storage: field.storage(), values }, Vec::new()));
    }
    let mut rows = 0;
    for (index, text) in body.split(|&byte| byte == b'\n').enumerate() {
        let text = String::from_utf8_lossy(text);
        let words: Vec<&str> = text.split_ascii_whitespace().collect();
        if words.is_empty() {
            continue;
        }
        let place = || format!("line {}", header.line + 1 + index);
        if rows == header.points {
            return Err(Fault::new(place(), "a line after the last point", format!("{rows} points")));
        }
        if words.len() != width {
            return Err(Fault::new(place(), format!("{} numbers", words.len()), format!("{width} numbers")));
        }
        let (mut at, mut kept) = (0, columns.iter_mut());
        for field in &header.fields {
            if keeps(field)
                && let Some((column, of_text)) = kept.next()
            {
                let number = match field.kind {
                    PackedKind::Real => decimal(words[at], field.size == 4),
                    PackedKind::Signed => whole_decimal(words[at], true, field.size),
                    PackedKind::Unsigned => whole_decimal(words[at], false, field.size),
                };
                let Some(number) = number else {
                    let kind = match field.kind {
                        PackedKind::Real => "decimal number, or nan,",
                        _ => "whole number",
                    };
                    let place = format!("{}, field `{}`", place(), field.name);
                    let expected = format!("a {kind} that its type holds ({} bytes)", field.size);
                    return Err(Fault::new(place, format!("{:?}", words[at]), expected));
                };
                column.values.push(number);
                of_text.push(Printed::of(words[at]));
            }
            at += field.count;
        }
        rows += 1;
    }
    if rows != header.points {
        return Err(Fault::new(
            "data",
            format!("{rows} lines"),
            format!("{}, one for each point", header.points),
        ));
    }
    Ok(with_decimals(columns))
}
