//! PFM: rows from below, either endianness, one or three components; other files are refused.

use std::path::PathBuf;

use raypencil_files::{Array, Limits, Storage, Values, read_pfm, write_pfm};
use raypencil_scene::Image;

fn path(folder: &tempfile::TempDir) -> PathBuf {
    folder.path().join("a.pfm")
}

fn read(bytes: &[u8]) -> Result<Array, String> {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(path(&folder), bytes).unwrap();
    let start = format!("{}: ", path(&folder).display());
    read_pfm(path(&folder), &Limits::default()).map_err(|error| error.to_string().replace(&start, ""))
}

fn file(header: &str, numbers: &[f32], bytes: fn(f32) -> [u8; 4]) -> Vec<u8> {
    let numbers = numbers.iter().flat_map(|&number| bytes(number));
    header.bytes().chain(numbers).collect()
}

fn reals(width: u32, height: u32, cells: &[f64]) -> Values {
    Values::Reals(Image::from_cells(width, height, cells.to_vec()))
}

#[test]
fn the_lowest_row_comes_first_in_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let image = Image::from_cells(2, 2, vec![1.0_f32, 2.0, f32::INFINITY, 4.0]);
    write_pfm(path(&folder), &[&image]).unwrap();
    let expected = file("Pf\n2 2\n-1.0\n", &[f32::INFINITY, 4.0, 1.0, 2.0], f32::to_le_bytes);
    assert_eq!(std::fs::read(path(&folder)).unwrap(), expected);
    let back = read(&expected).unwrap();
    assert_eq!(
        (back.storage, back.planes),
        (Storage::F32, vec![reals(2, 2, &[1.0, 2.0, f64::INFINITY, 4.0])])
    );
}

#[test]
fn the_sign_of_the_scale_is_the_order_of_bytes() {
    let numbers = [0.1_f32, -3.0];
    let expected = [reals(2, 1, &[f64::from(0.1_f32), -3.0])];
    for (header, bytes) in [
        ("Pf\n2 1\n-1.0\n", f32::to_le_bytes as fn(f32) -> [u8; 4]),
        ("Pf\n2 1\n1.0\n", f32::to_be_bytes),
        ("Pf 2 1 -1.000000 ", f32::to_le_bytes),
        ("Pf\r\n2\t1\n+1e0\n", f32::to_be_bytes),
    ] {
        assert_eq!(read(&file(header, &numbers, bytes)).unwrap().planes, expected, "{header:?}");
    }
}

#[test]
fn colours_are_three_planes() {
    let folder = tempfile::tempdir().unwrap();
    let planes: Vec<Image<f32>> =
        [[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]].map(|cells| Image::from_cells(1, 2, cells.to_vec())).into();
    write_pfm(path(&folder), &planes.iter().collect::<Vec<_>>()).unwrap();
    let bytes = std::fs::read(path(&folder)).unwrap();
    assert_eq!(bytes, file("PF\n1 2\n-1.0\n", &[2.0, 4.0, 6.0, 1.0, 3.0, 5.0], f32::to_le_bytes));
    let expected = [reals(1, 2, &[1.0, 2.0]), reals(1, 2, &[3.0, 4.0]), reals(1, 2, &[5.0, 6.0])];
    assert_eq!(read(&bytes).unwrap().planes, expected);
    let two = write_pfm(path(&folder), &[&planes[0], &planes[1]]).unwrap_err().to_string();
    assert!(two.ends_with("a.pfm: images: 2; expected 1 or 3"), "{two}");
    let other = Image::filled(2, 1, 0.0);
    let sizes = write_pfm(path(&folder), &[&planes[0], &planes[1], &other]).unwrap_err().to_string();
    assert!(sizes.ends_with("images: 2 x 1; expected 1 x 2 as the first"), "{sizes}");
}

#[test]
fn files_that_are_no_float_map_are_refused() {
    let refused = |bytes: &[u8], message: &str| assert_eq!(read(bytes).unwrap_err(), message);
    let word = "expected a short word, then white space (is the file cut off?)";
    refused(b"", &format!("magic: []; {word}"));
    refused(b"Pf", &format!("magic: [50, 66]; {word}"));
    refused(b"P6\n1 1\n255\n", "magic: \"P6\"; expected \"Pf\" or \"PF\"");
    refused(&[0xff; 100], &format!("magic: [ff, ff, ff, ff, ff, ff, ff, ff]; {word}"));
    refused(b"Pf\n1", &format!("width: [31]; {word}"));
    refused(b"Pf\n-1 1\n-1.0\n", "width: \"-1\"; expected a whole number");
    refused(
        b"Pf\n1 99999999999999999999\n-1.0\n",
        "height: \"99999999999999999999\"; expected a whole number",
    );
    refused(b"Pf\n# 1\n", "width: \"#\"; expected a whole number");
    for scale in ["nan", "inf", "0", "2.0", "-0.5", "one"] {
        let bytes = file(&format!("Pf\n1 1\n{scale}\n"), &[1.0], f32::to_le_bytes);
        refused(&bytes, &format!("scale: \"{scale}\"; expected -1 (little endian) or 1 (big endian)"));
    }
    let cells = "expected 1 to 67108864 cells";
    refused(b"Pf\n0 1\n-1\n", &format!("shape: 1 rows of 0 columns, 1 components; {cells}"));
    refused(
        b"PF\n1000000 1000000\n-1\n",
        &format!("shape: 1000000 rows of 1000000 columns, 3 components; {cells}"),
    );
    // A claim of 256 MiB in a file of 30 bytes costs nothing.
    let claimed = "expected the 268435456 bytes of its shape (is the file cut off?)";
    refused(b"Pf\n8192 8192\n-1\nfifteen bytes..", &format!("numbers: 15 bytes; {claimed}"));
    refused(
        &[&b"Pf\n1 1\n-1\n"[..], &[0; 5]].concat(),
        "numbers: 5 bytes; expected the 4 bytes of its shape (is its shape right?)",
    );
    let whole = file("PF\n2 2\n-1\n", &[0.5; 12], f32::to_le_bytes);
    assert!(read(&whole).is_ok());
    for end in 0..whole.len() {
        assert!(read(&whole[..end]).is_err(), "{end}");
    }
}

#[test]
fn a_word_of_the_header_has_up_to_32_letters() {
    let with = |word: &str| read(&file(&format!("Pf\n1 1\n{word}\n"), &[2.5], f32::to_le_bytes));
    let (longest, longer) = (format!("-1.{}", "0".repeat(29)), format!("-1.{}", "0".repeat(30)));
    assert_eq!(with(&longest).unwrap().planes, [reals(1, 1, &[2.5])]);
    assert!(with(&longer).unwrap_err().starts_with("scale: "), "{:?}", with(&longer));
}
