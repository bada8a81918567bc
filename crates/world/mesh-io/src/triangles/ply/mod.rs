//! PLY to triangles: the elements `vertex` and `face`. (Greg Turk, "The PLY Polygon File Format", 1994)
//!
//! Other elements and properties are skipped.

mod header;
mod numbers;

use raypencil_files::Fault;

use crate::cloud::{CloudColumn, CloudStorage, Printed, with_decimals};
use crate::triangles::parts::{Parts, coordinate};
use header::{Element, Format, Header, Number, Property};
use numbers::{Binary, Numbers, Text};

/// Elements that are told of a file without faces, at most.
const MAX_TOLD_ELEMENTS: usize = 6;

/// Reads the vertices and the faces of a file.
pub(super) fn read(file: &[u8]) -> Result<Parts, Fault> {
    let header = header::read(file)?;
    match header.format {
        Format::Text => rows(&header, Text::new(&file[header.bytes..], header.lines)),
        Format::LittleEndian => rows(&header, Binary::new(file, header.bytes, false)),
        Format::BigEndian => rows(&header, Binary::new(file, header.bytes, true)),
    }
}

/// Reads the rows of all elements.
fn rows(header: &Header<'_>, mut numbers: impl Numbers) -> Result<Parts, Fault> {
    check_counts(header, &numbers)?;
    let find = |name: &[u8]| header.elements.iter().find(|element| element.name == name);
    let Some(vertices) = find(b"vertex") else {
        return Err(Fault::new("header", "no element `vertex`", "an element `vertex` with x, y and z"));
    };
    // Beside faces, too: whoever skipped strips would read a part of the mesh.
    if find(b"tristrips").is_some_and(|strips| strips.count > 0 || find(b"face").is_none()) {
        return Err(Fault::new(
            "header",
            "element `tristrips`",
            "an element `face`: strips are not supported",
        ));
    }
    let mut parts = Parts::default();
    let told = |element: &Element<'_>| {
        format!(
            "{} of element `{}`",
            element.count,
            element.name[..element.name.len().min(80)].escape_ascii()
        )
    };
    let all: Vec<String> = header.elements.iter().take(MAX_TOLD_ELEMENTS).map(told).collect();
    parts.others = format!("it has {}", all.join(", "));
    for element in &header.elements {
        match element.name {
            b"vertex" => read_vertices(element, &mut numbers, &mut parts)?,
            b"face" => read_faces(element, vertices.count, &mut numbers, &mut parts)?,
            _ => skip_rows(element, &mut numbers)?,
        }
    }
    // CHOICE: surplus rows are refused as well. Header and numbers then do not belong together. In a binary file every
    // "\n" may have become "\r\n" on its way.
    numbers.finish()?;
    Ok(parts)
}

/// Reads those properties of the vertices that `keeps` names, as the fields of a cloud. Other elements are skipped.
pub(crate) fn cloud(file: &[u8], keeps: impl Fn(&str) -> bool) -> Result<Vec<CloudColumn>, Fault> {
    let header = header::read(file)?;
    match header.format {
        Format::Text => columns(&header, Text::new(&file[header.bytes..], header.lines), keeps),
        Format::LittleEndian => columns(&header, Binary::new(file, header.bytes, false), keeps),
        Format::BigEndian => columns(&header, Binary::new(file, header.bytes, true), keeps),
    }
}

fn columns(
    header: &Header<'_>,
    mut numbers: impl Numbers,
    keeps: impl Fn(&str) -> bool,
) -> Result<Vec<CloudColumn>, Fault> {
    check_counts(header, &numbers)?;
    let [vertices, ..] = header.elements.as_slice() else {
        return Err(Fault::new("header", "no element", "an element `vertex` with x, y and z"));
    };
    if vertices.name != b"vertex" {
        return Err(Fault::new("header", "another element first", "the element `vertex` with x, y and z"));
    }
    let kept = |property: &Property<'_>| {
        let name = String::from_utf8_lossy(property.name).into_owned();
        (property.length.is_none() && keeps(&name)).then_some(name)
    };
    let mut columns: Vec<Option<(CloudColumn, Vec<Printed>)>> = Vec::new();
    for property in &vertices.properties {
        let storage = match property.number {
            Number::Real(4) => CloudStorage::Single,
            Number::Real(_) => CloudStorage::Double,
            Number::Signed(_) | Number::Unsigned(_) => CloudStorage::Whole,
        };
        // The file has a byte or more for each number.
        let values = |_: &String| Vec::with_capacity(vertices.count as usize);
        let column = kept(property).map(|name| {
            let values = values(&name);
            (CloudColumn { name, storage, values }, Vec::new())
        });
        columns.push(column);
    }
    for _ in 0..vertices.count {
        numbers.begin_row()?;
        for (property, column) in vertices.properties.iter().zip(&mut columns) {
            let Some((column, printed)) = column else {
                skip(property, &mut numbers)?;
                continue;
            };
            column.values.push(numbers.real(property.number)?);
            printed.extend(numbers.printed());
        }
        numbers.end_row()?;
    }
    header.elements[1..].iter().try_for_each(|element| skip_rows(element, &mut numbers))?;
    // As of a mesh: surplus rows say that header and numbers do not belong together, and that points are missing.
    numbers.finish()?;
    Ok(with_decimals(columns.into_iter().flatten().collect()))
}

fn skip_rows(element: &Element<'_>, numbers: &mut impl Numbers) -> Result<(), Fault> {
    for _ in 0..element.count {
        numbers.begin_row()?;
        element.properties.iter().try_for_each(|property| skip(property, numbers))?;
        numbers.end_row()?;
    }
    Ok(())
}

/// Refuses rows that cannot be in the file, before memory is asked for.
fn check_counts(header: &Header<'_>, numbers: &impl Numbers) -> Result<(), Fault> {
    let mut left = numbers.bytes_left();
    for element @ Element { name, count, properties } in &header.elements {
        let place = || format!("element `{}`", name[..name.len().min(80)].escape_ascii());
        if *count > 0 && properties.is_empty() {
            return Err(Fault::new(place(), format!("{count} rows without properties"), "a property"));
        }
        let least = numbers.least_row_bytes(element);
        left = count.checked_mul(least).and_then(|claimed| left.checked_sub(claimed)).ok_or_else(|| {
            let found = format!("{count} rows of {least} bytes or more, with {left} bytes left");
            Fault::new(place(), found, "as many rows as the file has (is it cut off?)")
        })?;
    }
    Ok(())
}

fn read_vertices(element: &Element<'_>, numbers: &mut impl Numbers, parts: &mut Parts) -> Result<(), Fault> {
    const AXES: [&[u8]; 3] = [b"x", b"y", b"z"];
    let axis = |property: &Property<'_>| {
        AXES.iter().position(|name| *name == property.name).filter(|_| property.length.is_none())
    };
    let axes: Vec<Option<usize>> = element.properties.iter().map(axis).collect();
    if axes.iter().flatten().count() != AXES.len() {
        return Err(Fault::new("element `vertex`", "no x, y or z", "x, y and z, each a single number"));
    }
    // The file has a byte or more for each coordinate.
    parts.vertices.reserve_exact(element.count as usize);
    for index in 0..element.count {
        numbers.begin_row()?;
        let mut vertex = [0.0; 3];
        for (property, axis) in element.properties.iter().zip(&axes) {
            match axis {
                Some(axis) => {
                    let number = numbers.real(property.number)?;
                    vertex[*axis] = coordinate(number, || format!("{}, vertex {index}", numbers.place()))?;
                }
                None => skip(property, numbers)?,
            }
        }
        numbers.end_row()?;
        parts.vertices.push(vertex);
    }
    Ok(())
}

fn read_faces(
    element: &Element<'_>,
    vertices: u64,
    numbers: &mut impl Numbers,
    parts: &mut Parts,
) -> Result<(), Fault> {
    let is_list = |property: &Property<'_>| {
        let is_whole = !matches!(property.number, Number::Real(_));
        is_whole
            && property.length.is_some()
            && [&b"vertex_indices"[..], b"vertex_index"].contains(&property.name)
    };
    let lists = element.properties.iter().filter(|property| is_list(property)).count();
    if lists != 1 && element.count > 0 {
        let found = format!("{lists} lists of vertices");
        return Err(Fault::new(
            "element `face`",
            found,
            "one list of integers `vertex_indices` or `vertex_index`",
        ));
    }
    let mut corners = Vec::new();
    // The file has a byte or more for each polygon.
    parts.faces.reserve_exact(element.count as usize);
    for _ in 0..element.count {
        numbers.begin_row()?;
        for property in &element.properties {
            let Some(length) = property.length.filter(|_| is_list(property)) else {
                skip(property, numbers)?;
                continue;
            };
            let polygon = parts.polygon_count();
            let count = numbers.whole(length)?;
            if count < 3 {
                let place = format!("{}, polygon {polygon}", numbers.place());
                return Err(Fault::new(place, format!("{count} corners"), "3 or more"));
            }
            corners.clear();
            for _ in 0..count {
                let index = numbers.whole(property.number)?;
                let known = u32::try_from(index).ok().filter(|_| (index as u64) < vertices);
                corners.push(known.ok_or_else(|| {
                    let place = format!("{}, polygon {polygon}", numbers.place());
                    Fault::new(place, format!("vertex {index}"), format!("an index below {vertices}"))
                })?);
            }
            parts.add_polygon(&corners);
        }
        numbers.end_row()?;
    }
    Ok(())
}

/// Skips a number or a list.
fn skip(property: &Property<'_>, numbers: &mut impl Numbers) -> Result<(), Fault> {
    let Some(length) = property.length else { return numbers.skip(property.number, 1) };
    let count = numbers.whole(length)?;
    let count = u64::try_from(count).map_err(|_| {
        Fault::new(numbers.place(), format!("a list of {count} numbers"), "0 numbers or more")
    })?;
    numbers.skip(property.number, count)
}
