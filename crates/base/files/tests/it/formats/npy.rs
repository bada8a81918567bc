//! NPY: files are written as NumPy writes them; every type, order and endianness is read; other files are refused.

use proptest::prelude::*;
use std::path::PathBuf;

use raypencil_files::{
    Array, Limits, Numbers, Storage, Values, npy_numbers_from_bytes, read_npy, read_npy_numbers, write_npy,
    write_npy_numbers,
};
use raypencil_scene::Image;

struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn path(&self) -> PathBuf {
        self.0.path().join("a.npy")
    }
}

/// A file of version 1.0: the dictionary, padded as NumPy does, then the bytes of the numbers.
fn file(dictionary: &str, numbers: &[u8]) -> Vec<u8> {
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    let length = (10 + dictionary.len() + 1).next_multiple_of(64) - 10;
    bytes.extend((length as u16).to_le_bytes());
    bytes.extend(dictionary.as_bytes());
    bytes.resize(10 + length - 1, b' ');
    bytes.push(b'\n');
    bytes.extend(numbers);
    bytes
}

fn dictionary(descr: &str, fortran: &str, shape: &str) -> String {
    format!("{{'descr': '{descr}', 'fortran_order': {fortran}, 'shape': {shape}, }}")
}

fn read_with(bytes: &[u8], limits: &Limits) -> Result<Array, String> {
    let folder = Folder::new();
    std::fs::write(folder.path(), bytes).unwrap();
    let start = format!("{}: ", folder.path().display());
    read_npy(folder.path(), limits).map_err(|error| error.to_string().replace(&start, ""))
}

fn read(bytes: &[u8]) -> Result<Array, String> {
    read_with(bytes, &Limits::default())
}

fn reals(width: u32, height: u32, cells: &[f64]) -> Values {
    Values::Reals(Image::from_cells(width, height, cells.to_vec()))
}

fn wholes(width: u32, height: u32, cells: &[u32]) -> Values {
    Values::Wholes(Image::from_cells(width, height, cells.to_vec()))
}

#[test]
fn files_are_those_of_numpy() {
    let folder = Folder::new();
    // numpy.save of numpy.array([[1, 2, 3], [4, 5, 6]], dtype='<f8'), as numpy 2 writes it: a header of 118
    // (0x76) bytes, so that the numbers start at byte 128.
    let image = Image::from_cells(3, 2, vec![1.0_f64, 2.0, 3.0, 4.0, 5.0, 6.0]);
    write_npy(folder.path(), &[&image]).unwrap();
    let bytes = std::fs::read(folder.path()).unwrap();
    let mut expected = b"\x93NUMPY\x01\x00\x76\x00".to_vec();
    expected.extend(b"{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }");
    expected.resize(127, b' ');
    expected.push(b'\n');
    expected.extend(image.cells().iter().flat_map(|number| number.to_le_bytes()));
    assert_eq!(bytes, expected);
}

#[test]
fn images_of_every_type_come_back() {
    let folder = Folder::new();
    let back = || read_npy(folder.path(), &Limits::of_size(2, 1)).unwrap();
    write_npy(folder.path(), &[&Image::from_cells(2, 1, vec![0.1_f64, f64::INFINITY])]).unwrap();
    assert_eq!(back(), Array { storage: Storage::F64, planes: vec![reals(2, 1, &[0.1, f64::INFINITY])] });
    write_npy(folder.path(), &[&Image::from_cells(2, 1, vec![0.1_f32, -1e-45])]).unwrap();
    let expected = reals(2, 1, &[f64::from(0.1_f32), f64::from(-1e-45_f32)]);
    assert_eq!(back(), Array { storage: Storage::F32, planes: vec![expected] });
    write_npy(folder.path(), &[&Image::from_cells(2, 1, vec![7_u32, u32::MAX])]).unwrap();
    assert_eq!(back(), Array { storage: Storage::Whole, planes: vec![wholes(2, 1, &[7, u32::MAX])] });
    write_npy(folder.path(), &[&Image::from_cells(2, 1, vec![0_u8, 255])]).unwrap();
    assert_eq!(back(), Array { storage: Storage::Whole, planes: vec![wholes(2, 1, &[0, 255])] });
    // Several planes are one array of components.
    let planes = [vec![1.0_f64, 2.0], vec![3.0, 4.0], vec![5.0, 6.0]];
    let planes: Vec<Image<f64>> = planes.into_iter().map(|cells| Image::from_cells(2, 1, cells)).collect();
    write_npy(folder.path(), &planes.iter().collect::<Vec<_>>()).unwrap();
    let bytes = std::fs::read(folder.path()).unwrap();
    assert!(bytes.windows(9).any(|window| window == b"(1, 2, 3)"));
    let first: Vec<f64> =
        bytes[128..152].chunks(8).map(|b| f64::from_le_bytes(b.try_into().unwrap())).collect();
    assert_eq!(first, [1.0, 3.0, 5.0]);
    assert_eq!(back().planes, planes.into_iter().map(Values::Reals).collect::<Vec<_>>());
}

#[test]
fn images_that_make_no_array_are_refused() {
    let folder = Folder::new();
    let message = write_npy::<f64>(folder.path(), &[]).unwrap_err().to_string();
    assert!(message.ends_with("a.npy: images: none; expected at least one"), "{message}");
    let (a, b) = (Image::filled(2, 3, 0_u8), Image::filled(3, 2, 0_u8));
    let message = write_npy(folder.path(), &[&a, &b]).unwrap_err().to_string();
    assert!(message.ends_with("images: 3 x 2; expected 2 x 3 as the first"), "{message}");
    assert!(!folder.path().exists());
}

#[test]
fn every_type_and_byte_order_is_read() {
    // 0x3c00 is 1 and 0xc000 is -2 in half precision; 0x0001 is 2^-24.
    let half = [0x3c00_u16, 0xc000, 0x0001];
    let expected = reals(3, 1, &[1.0, -2.0, 1.0 / 16_777_216.0]);
    let bytes: Vec<u8> = half.iter().flat_map(|n| n.to_le_bytes()).collect();
    let array = read(&file(&dictionary("<f2", "False", "(1, 3)"), &bytes)).unwrap();
    assert_eq!(array, Array { storage: Storage::F16, planes: vec![expected.clone()] });
    let bytes: Vec<u8> = half.iter().flat_map(|n| n.to_be_bytes()).collect();
    assert_eq!(read(&file(&dictionary(">f2", "False", "(1, 3)"), &bytes)).unwrap().planes, [expected]);
    for (descr, bytes) in [
        (">f4", [1.5_f32, -0.25].iter().flat_map(|n| n.to_be_bytes()).collect::<Vec<u8>>()),
        ("<f4", [1.5_f32, -0.25].iter().flat_map(|n| n.to_le_bytes()).collect()),
        (">f8", [1.5_f64, -0.25].iter().flat_map(|n| n.to_be_bytes()).collect()),
        ("<f8", [1.5_f64, -0.25].iter().flat_map(|n| n.to_le_bytes()).collect()),
    ] {
        let array = read(&file(&dictionary(descr, "False", "(1, 2)"), &bytes)).unwrap();
        assert_eq!(array.planes, [reals(2, 1, &[1.5, -0.25])], "{descr}");
    }
    for (descr, bytes) in [
        ("|u1", vec![5_u8, 100]),
        ("<u1", vec![5, 100]),
        ("|i1", vec![5, 100]),
        ("<u2", vec![5, 0, 100, 0]),
        (">u2", vec![0, 5, 0, 100]),
        (">i2", vec![0, 5, 0, 100]),
        ("<u4", vec![5, 0, 0, 0, 100, 0, 0, 0]),
        (">i4", vec![0, 0, 0, 5, 0, 0, 0, 100]),
        ("<u8", [5_u64, 100].iter().flat_map(|n| n.to_le_bytes()).collect()),
        (">i8", [5_i64, 100].iter().flat_map(|n| n.to_be_bytes()).collect()),
    ] {
        let array = read(&file(&dictionary(descr, "False", "(1, 2)"), &bytes)).unwrap();
        assert_eq!((array.storage, &array.planes[0]), (Storage::Whole, &wholes(2, 1, &[5, 100])), "{descr}");
    }
    let array = read(&file(&dictionary("|b1", "False", "(1, 2)"), &[0, 1])).unwrap();
    assert_eq!(array.planes, [wholes(2, 1, &[0, 1])]);
}

#[test]
fn minus_one_is_none_and_what_does_not_fit_names_its_cell() {
    for (descr, bytes) in [
        ("|i1", vec![0xff]),
        ("<i2", vec![0xff; 2]),
        (">i4", vec![0xff; 4]),
        ("<i8", vec![0xff; 8]),
        ("<u4", vec![0xff; 4]),
    ] {
        let array = read(&file(&dictionary(descr, "False", "(1, 1)"), &bytes)).unwrap();
        assert_eq!(array.planes, [wholes(1, 1, &[u32::MAX])], "{descr}");
    }
    // Row 1 of two columns: the last number is in cell (1, 1).
    let number = |descr: &str, last: Vec<u8>| {
        let bytes = [vec![0; 3 * last.len()], last].concat();
        read(&file(&dictionary(descr, "False", "(2, 2)"), &bytes)).unwrap_err()
    };
    let signed = "expected 0 to 4294967295, or -1 for none";
    assert_eq!(number("<i2", (-2_i16).to_le_bytes().into()), format!("cell (1, 1): -2; {signed}"));
    assert_eq!(
        number("<i8", (1_i64 << 32).to_le_bytes().into()),
        format!("cell (1, 1): 4294967296; {signed}")
    );
    assert_eq!(
        number("<u8", u64::MAX.to_le_bytes().into()),
        "cell (1, 1): 18446744073709551615; expected 0 to 4294967295"
    );
    assert_eq!(number("|b1", vec![2]), "cell (1, 1): a truth value of 2; expected 0 or 1");
    let parts = read(&file(&dictionary("|i1", "False", "(1, 2, 2)"), &[0, 0, 0, 0x80])).unwrap_err();
    assert_eq!(parts, format!("cell (1, 0), component 1: -128; {signed}"));
}

#[test]
fn fortran_order_runs_down_the_columns() {
    // numpy.array([[1, 2, 3], [4, 5, 6]], order='F') lies as 1 4 2 5 3 6.
    let array = read(&file(&dictionary("|u1", "True", "(2, 3)"), &[1, 4, 2, 5, 3, 6])).unwrap();
    assert_eq!(array.planes, [wholes(3, 2, &[1, 2, 3, 4, 5, 6])]);
    // Two components of a 1 x 2 array: all of the first component come first.
    let array = read(&file(&dictionary("|u1", "True", "(1, 2, 2)"), &[1, 2, 3, 4])).unwrap();
    assert_eq!(array.planes, [wholes(2, 1, &[1, 2]), wholes(2, 1, &[3, 4])]);
    let array = read(&file(&dictionary("|u1", "False", "(1, 2, 2)"), &[1, 2, 3, 4])).unwrap();
    assert_eq!(array.planes, [wholes(2, 1, &[1, 3]), wholes(2, 1, &[2, 4])]);
}

#[test]
fn headers_may_be_written_in_other_ways() {
    let numbers = [1_u8, 2];
    for text in [
        "{\"shape\": (1, 2), \"descr\": \"|u1\", \"fortran_order\": False}",
        "{'shape':(1,2,),'fortran_order':False,'descr':'|u1',}",
        "  { 'descr' : '|u1' , 'fortran_order' : False , 'shape' : ( 1L , 2L ) }  ",
    ] {
        assert_eq!(read(&file(text, &numbers)).unwrap().planes, [wholes(2, 1, &[1, 2])], "{text}");
    }
    // Versions 2.0 and 3.0 have four bytes of length.
    for version in [2, 3] {
        let text = dictionary("|u1", "False", "(1, 2)");
        let mut bytes = vec![0x93, b'N', b'U', b'M', b'P', b'Y', version, 0];
        bytes.extend((text.len() as u32).to_le_bytes());
        bytes.extend(text.as_bytes());
        bytes.extend(numbers);
        assert_eq!(read(&bytes).unwrap().planes, [wholes(2, 1, &[1, 2])]);
    }
}

#[test]
fn types_that_are_no_numbers_of_cells_are_refused_by_name() {
    let types = "expected f2, f4, f8, u1, u2, u4, u8, i1, i2, i4, i8 or b1";
    for (descr, what) in [
        ("|O", "\"|O\" (Python objects, which are code to be run)"),
        ("<c8", "\"<c8\" (complex numbers)"),
        ("<f16", "\"<f16\" (real numbers of a width that not every machine has)"),
        ("|V8", "\"|V8\" (a structured type)"),
        ("<U4", "\"<U4\" (texts)"),
        ("<M8[ns]", "\"<M8[ns]\" (dates or durations)"),
        ("x", "\"x\""),
        ("", "\"\""),
    ] {
        let error = read(&file(&dictionary(descr, "False", "(1, 2)"), &[0; 16])).unwrap_err();
        assert_eq!(error, format!("descr: {what}; {types}"));
    }
    let list = "{'descr': [('x', '<f8'), ('y', '<f8')], 'fortran_order': False, 'shape': (1, 1), }";
    assert_eq!(read(&file(list, &[0; 16])).unwrap_err(), format!("descr: a structured type; {types}"));
    let error = read(&file(&dictionary("|f8", "False", "(1, 2)"), &[0; 16])).unwrap_err();
    assert!(error.contains("byte order is none of"), "{error}");
}

#[test]
fn shapes_are_held_against_the_file() {
    let shape = |shape: &str, bytes: usize| {
        read(&file(&dictionary("<f8", "False", shape), &vec![0; bytes])).unwrap_err()
    };
    let ranks = "expected 2 (rows, columns) or 3 (rows, columns, components)";
    assert_eq!(shape("()", 8), format!("shape: 0 dimensions; {ranks}"));
    assert_eq!(shape("(7,)", 56), format!("shape: 1 dimensions; {ranks}"));
    assert_eq!(shape("(1, 1, 1, 1)", 8), format!("shape: 4 dimensions; {ranks}"));
    let cells = "expected 1 to 67108864 cells";
    assert_eq!(shape("(0, 5)", 0), format!("shape: 0 rows of 5 columns, 1 components; {cells}"));
    assert_eq!(
        shape("(65536, 65536)", 8),
        format!("shape: 65536 rows of 65536 columns, 1 components; {cells}")
    );
    assert!(shape("(18446744073709551615, 18446744073709551615)", 8).ends_with(cells));
    assert!(shape("(18446744073709551616, 1)", 8).ends_with("expected a whole number below 2^64"));
    assert!(shape("(1, 1, 0)", 0).ends_with("expected 1 to 1024 components"));
    assert!(shape("(1, 1, 1025)", 8200).ends_with("expected 1 to 1024 components"));
    assert_eq!(
        shape("(8192, 8192, 1024)", 8).split_once("; ").unwrap().1,
        "expected at most 4294967296 bytes"
    );
    let cut = "expected the 48 bytes of its shape (is the file cut off?)";
    assert_eq!(shape("(2, 3)", 47), format!("numbers: 47 bytes; {cut}"));
    let longer = cut.replace("is the file cut off?", "is its shape right?");
    assert_eq!(shape("(2, 3)", 49), format!("numbers: 49 bytes; {longer}"));
    let bytes = file(&dictionary("<f8", "False", "(2, 3)"), &[0; 48]);
    let error = read_with(&bytes, &Limits::of_size(2, 3)).unwrap_err();
    assert_eq!(error, "shape: 2 rows of 3 columns, 1 components; expected 3 rows of 2 columns");
    assert!(read_with(&bytes, &Limits::of_size(3, 2)).is_ok());
}

#[test]
fn headers_that_are_broken_are_refused() {
    assert_eq!(read(b"").unwrap_err(), "first bytes: []; expected the magic \"\\x93NUMPY\"");
    assert!(read(b"\x89PNG\r\n\x1a\n").unwrap_err().starts_with("first bytes: [89, 50, 4e, 47, 0d, 0a]"));
    let cut = "expected a complete header (is the file cut off?)";
    assert_eq!(read(b"\x93NUMPY").unwrap_err(), format!("header: 6 bytes; {cut}"));
    assert_eq!(read(b"\x93NUMPY\x01\x00\x76").unwrap_err(), format!("header: 9 bytes; {cut}"));
    assert_eq!(read(b"\x93NUMPY\x01\x00\x76\x00{}").unwrap_err(), format!("header: 12 bytes; {cut}"));
    let four = read(b"\x93NUMPY\x04\x00\x00\x00").unwrap_err();
    assert_eq!(four, "header: version 4.0; expected version 1.0, 2.0 or 3.0");
    // A claim of 4 GiB costs nothing.
    let huge = read(b"\x93NUMPY\x02\x00\xff\xff\xff\xff").unwrap_err();
    assert_eq!(huge, "header: a length of 4294967295; expected at most 65536 bytes");
    for (length, is_read) in [(65_536_u32, true), (65_537, false)] {
        let mut bytes = b"\x93NUMPY\x02\x00".to_vec();
        bytes.extend(length.to_le_bytes());
        bytes.extend(dictionary("<f8", "False", "(1, 1)").as_bytes());
        bytes.resize(12 + length as usize, b' ');
        bytes.extend([0; 8]);
        assert_eq!(read(&bytes).is_ok(), is_read, "{length}");
    }
    for text in [
        "",
        "{",
        "[]",
        "{'descr'}",
        "{'descr': ",
        "{'descr': '<f8', 'fortran_order': None, 'shape': (1, 1)}",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (1, -1)}",
        "{'descr': '<f8', 'fortran_order': False, 'shape': [1, 1]}",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (1, 1), 'more': 'x'}",
        "{'descr': '<f8', 'descr': '<f8', 'fortran_order': False, 'shape': (1, 1)}",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (1, 1)} + 1",
        "{'descr': 'nan\\x00', 'fortran_order': False, 'shape': (1, 1)}",
        "{'descr': nan, 'fortran_order': False, 'shape': (1, 1)}",
        &"(".repeat(60_000),
        &"{".repeat(60_000),
    ] {
        let error = read(&file(text, &[0; 8])).unwrap_err();
        assert!(error.starts_with("header, character ") && error.len() < 200, "{text}: {error}");
    }
    let lacks = read(&file("{'descr': '<f8', 'shape': (1, 1)}", &[0; 8])).unwrap_err();
    assert_eq!(lacks, "header: no `fortran_order`; expected descr, fortran_order and shape");
}

#[test]
fn missing_and_irregular_files_are_named() {
    let folder = Folder::new();
    let message = read_npy(folder.path(), &Limits::default()).unwrap_err().to_string();
    assert!(message.contains("a.npy: cannot read: "), "{message}");
    std::fs::create_dir(folder.path()).unwrap();
    let message = read_npy(folder.path(), &Limits::default()).unwrap_err().to_string();
    assert!(message.ends_with("cannot read: not a regular file"), "{message}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn changed_bytes_never_panic(
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
        end in prop::option::of(any::<prop::sample::Index>()),
    ) {
        let mut bytes = file(&dictionary("<i4", "True", "(2, 3, 2)"), &[1; 48]);
        for (at, byte) in changes {
            // Mostly in the header.
            let at = at.index(96);
            bytes[at] = byte;
        }
        if let Some(end) = end {
            bytes.truncate(end.index(bytes.len()));
        }
        let _ = read(&bytes);
    }
}

// ---- Numbers of any shape ----

fn numbers(bytes: &[u8]) -> Result<Numbers, String> {
    npy_numbers_from_bytes(bytes, "a.npy".as_ref()).map_err(|error| error.to_string().replace("a.npy: ", ""))
}

#[test]
fn numbers_of_any_shape_type_and_order_are_read() {
    let of = |shape: &[u64], storage, values: &[f64]| Numbers {
        shape: shape.to_vec(),
        storage,
        values: values.to_vec(),
    };
    // Shape (2, 3, 2) in Fortran order: the first index runs fastest. Number (a, b, c) is 100 a + 10 b + c.
    let place = |k: usize| (k % 2) as u8 * 100 + (k / 2 % 3) as u8 * 10 + (k / 6) as u8;
    let bytes: Vec<u8> = (0..12).map(place).collect();
    let found = numbers(&file(&dictionary("|u1", "True", "(2, 3, 2)"), &bytes)).unwrap();
    let expected = [0, 1, 10, 11, 20, 21, 100, 101, 110, 111, 120, 121].map(f64::from);
    assert_eq!(found, of(&[2, 3, 2], Storage::Whole, &expected));
    // One dimension, none, and an empty one.
    let halves = [0x00, 0x3e, 0x00, 0xc0];
    assert_eq!(
        numbers(&file(&dictionary("<f2", "False", "(2,)"), &halves)),
        Ok(of(&[2], Storage::F16, &[1.5, -2.0]))
    );
    let big = 0.1_f64.to_be_bytes();
    assert_eq!(numbers(&file(&dictionary(">f8", "False", "()"), &big)), Ok(of(&[], Storage::F64, &[0.1])));
    assert_eq!(
        numbers(&file(&dictionary("<f4", "False", "(0, 6)"), &[])),
        Ok(of(&[0, 6], Storage::F32, &[]))
    );
    let signed = (-2_i64).to_le_bytes();
    assert_eq!(numbers(&file(&dictionary("<i8", "False", "(1, 1, 1, 1)"), &signed)).unwrap().values, [-2.0]);
}

#[test]
fn numbers_that_do_not_fit_their_shape_are_refused() {
    let refused = |dictionary: String, bytes: &[u8]| numbers(&file(&dictionary, bytes)).unwrap_err();
    assert_eq!(
        refused(dictionary("<f4", "False", "(3, 6)"), &[0; 70]),
        "numbers: 70 bytes; expected the 72 bytes of shape [3, 6] (is the file cut off?)"
    );
    assert_eq!(
        refused(dictionary("<f4", "False", "(3, 6)"), &[0; 76]),
        "numbers: 76 bytes; expected the 72 bytes of shape [3, 6] (is its shape right?)"
    );
    // 2^32 times 2^32 rays: no memory is asked for.
    assert_eq!(
        refused(dictionary("<f8", "False", "(4294967296, 4294967296)"), &[0; 8]),
        "numbers: 8 bytes; expected more bytes than any file has, of shape [4294967296, 4294967296]"
    );
    let many = vec!["1"; 65].join(", ");
    assert!(
        refused(dictionary("|u1", "False", &format!("({many})")), &[0]).starts_with("shape: 65 dimensions")
    );
    assert_eq!(
        refused(dictionary("<u8", "False", "(1,)"), &u64::MAX.to_le_bytes()),
        "number 0: 18446744073709551615; expected a whole number up to 2^53"
    );
    // The last whole number before which a double holds each one, with either sign.
    for (number, is_read) in [(1_i64 << 53, true), (-(1 << 53), true), ((1 << 53) + 1, false)] {
        let bytes = file(&dictionary("<i8", "False", "(1,)"), &number.to_le_bytes());
        assert_eq!(numbers(&bytes).is_ok(), is_read, "{number}");
    }
    for (dimensions, is_read) in [(64, true), (65, false)] {
        let shape = format!("({})", "1,".repeat(dimensions));
        let bytes = file(&dictionary("<f8", "False", &shape), &[0; 8]);
        assert_eq!(numbers(&bytes).is_ok(), is_read, "{dimensions}");
    }
}

/// NumPy's header is the smallest multiple of 64 bytes that holds the ten bytes before the dictionary, the dictionary and a line feed.
#[test]
fn a_header_is_no_longer_than_it_has_to_be() {
    let folder = Folder::new();
    let mut is_full = false;
    for (dimensions, last) in (1..40).flat_map(|count| [1_u64, 10, 100].map(|last| (count, last))) {
        let mut shape = vec![1; dimensions];
        shape.push(last);
        write_npy_numbers(folder.path(), &shape, &vec![0_u8; last as usize]).unwrap();
        let bytes = std::fs::read(folder.path()).unwrap();
        let end = bytes.iter().position(|byte| *byte == b'}').unwrap() + 1;
        is_full |= (end + 1).is_multiple_of(64);
        assert_eq!(bytes.len() - last as usize, (end + 1).next_multiple_of(64), "{shape:?}");
    }
    assert!(is_full, "one of the dictionaries leaves no room");
}

#[test]
fn written_numbers_come_back_with_their_shape() {
    let folder = Folder::new();
    for shape in [vec![6_u64], vec![2, 3], vec![3, 1, 2], vec![0, 4]] {
        let count = shape.iter().product::<u64>();
        let values: Vec<f64> = (0..count).map(|k| k as f64 / 3.0).collect();
        write_npy_numbers(folder.path(), &shape, &values).unwrap();
        let found = read_npy_numbers(folder.path(), &Limits::default()).unwrap();
        assert_eq!((found.shape, found.storage, found.values), (shape, Storage::F64, values));
    }
    // The header is padded to a multiple of 64 bytes, and a tuple of one has its comma.
    write_npy_numbers(folder.path(), &[2], &[-1_i8, 1]).unwrap();
    let bytes = std::fs::read(folder.path()).unwrap();
    assert_eq!((bytes.len(), &bytes[128..]), (130, &[255, 1][..]));
    assert!(bytes[10..].starts_with(b"{'descr': '|i1', 'fortran_order': False, 'shape': (2,), }"));
    let error = write_npy_numbers(folder.path(), &[2, 2], &[1.0]).unwrap_err().to_string();
    assert!(error.contains("numbers: 1; expected 4, as shape [2, 2] has"), "{error}");
}
