//! NPZ: archives of NumPy, plain and compressed, and damaged ones.

use std::io::Write as _;
use std::path::Path;

use raypencil_files::{ArrayData, Limits, NamedArray, Storage, Values, npz_from_bytes, write_npz};
use zip::CompressionMethod;
use zip::write::SimpleFileOptions;

/// An NPY file of numbers in double precision, as NumPy writes it.
fn npy(shape: &str, numbers: &[f64]) -> Vec<u8> {
    let text = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({shape}), }}\n");
    let mut file = b"\x93NUMPY\x01\x00".to_vec();
    file.extend((text.len() as u16).to_le_bytes());
    file.extend(text.bytes());
    file.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
    file
}

fn archive(entries: &[(&str, &[u8])], method: CompressionMethod) -> Vec<u8> {
    let mut archive = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    for (name, bytes) in entries {
        archive.start_file(*name, SimpleFileOptions::default().compression_method(method)).unwrap();
        archive.write_all(bytes).unwrap();
    }
    archive.finish().unwrap().into_inner()
}

fn refusal(bytes: &[u8], limits: &Limits) -> String {
    npz_from_bytes(bytes, Path::new("a.npz"), limits).expect_err("a refusal").to_string()
}

#[test]
fn plain_and_compressed_archives_are_read() {
    let (range, points) = (npy("1, 2", &[1.5, f64::INFINITY]), npy("1, 1, 3", &[1.0, 2.0, 3.0]));
    let (times, note) = (npy("3,", &[0.0, 1.0, 2.0]), b"not an array".as_slice());
    let entries: [(&str, &[u8]); 4] =
        [("range.T.npy", &range), ("P.npy", &points), ("times.npy", &times), ("note.txt", note)];
    for method in [CompressionMethod::Stored, CompressionMethod::Deflated] {
        let bytes = archive(&entries, method);
        let arrays = npz_from_bytes(&bytes, Path::new("a.npz"), &Limits::default()).unwrap();
        // Times are no map.
        let names: Vec<&str> = arrays.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["range.T", "P"], "{method}");
        assert_eq!(arrays[0].1.storage, Storage::F64);
        assert_eq!((arrays[0].1.planes[0].real(0), arrays[0].1.planes[0].real(1)), (1.5, f64::INFINITY));
        let Values::Reals(z) = &arrays[1].1.planes[2] else { panic!("reals") };
        assert_eq!(z.cells(), [3.0]);
    }
}

#[test]
fn damaged_and_hostile_archives_are_refused() {
    let range = npy("1, 2", &[1.5, 2.5]);
    let good = archive(&[("range.T.npy", &range)], CompressionMethod::Stored);
    assert!(refusal(&good[..good.len() - 30], &Limits::default()).starts_with("a.npz: archive: "));
    assert!(refusal(b"PK", &Limits::default()).contains("an NPZ file that is complete"));
    // A number that was changed has another check sum.
    let mut changed = good.clone();
    let at = good.windows(8).position(|bytes| bytes == 1.5_f64.to_le_bytes()).unwrap();
    changed[at + 7] ^= 1;
    assert!(refusal(&changed, &Limits::default()).starts_with("a.npz: array \"range.T\": "));
    let cut = archive(&[("range.T.npy", &range[..range.len() - 8])], CompressionMethod::Stored);
    let expected = "a.npz: array \"range.T\", numbers: 8 bytes; expected the 16 bytes of its shape (is the file cut off?)";
    assert_eq!(refusal(&cut, &Limits::default()), expected);
    // Zeros of a thousand times the size: refused by their claim.
    let zeros = npy("1024, 1024", &vec![0.0; 1 << 20]);
    let bytes = archive(&[("zeros.npy", &zeros)], CompressionMethod::Deflated);
    let few = Limits { bytes: 1 << 20, ..Limits::default() };
    assert!(refusal(&bytes, &few).contains("array \"zeros\": 8388"), "{}", refusal(&bytes, &few));
}

#[test]
fn limits_hold_for_all_arrays_of_an_archive_together() {
    let read = |bytes: &[u8], most: u64| {
        let limits = Limits { bytes: most, ..Limits::default() };
        npz_from_bytes(bytes, Path::new("a.npz"), &limits).map(|arrays| arrays.len())
    };
    // 80 000 bytes each; the header of an array may have 65 536 beside them.
    let numbers = npy("100, 100", &[0.5; 10_000]);
    let entries = ["a.npy", "b.npy", "c.npy"].map(|name| (name, numbers.as_slice()));
    let three = archive(&entries, CompressionMethod::Stored);
    assert_eq!(read(&three, 240_000).unwrap(), 3);
    let error = read(&three, 100_000).unwrap_err().to_string();
    assert!(error.starts_with("a.npz: array \"c\": "), "{error}");
    // As many files as there may be, and one more.
    let names: Vec<String> = (0..1025).map(|k| format!("{k}.txt")).collect();
    let files = |count: usize| -> Vec<u8> {
        let entries: Vec<(&str, &[u8])> =
            names[..count].iter().map(|name| (name.as_str(), &b""[..])).collect();
        archive(&entries, CompressionMethod::Stored)
    };
    assert_eq!(read(&files(1024), 1000).unwrap(), 0);
    let error = read(&files(1025), 1000).unwrap_err().to_string();
    assert_eq!(error, "a.npz: archive: 1025 files; expected at most 1024");
}

#[test]
fn an_array_that_is_there_twice_is_refused_wherever_the_second_one_stands() {
    let [one, two] = [1.0, 2.0].map(|number| npy("1, 1", &[number]));
    // A short name, and one whose length takes two bytes.
    for length in [2, 300] {
        let names = ["a", "b", "c"].map(|letter| letter.repeat(length));
        let files = names.each_ref().map(|name| format!("{name}.npy"));
        let entries: Vec<(&str, &[u8])> =
            files.iter().map(String::as_str).zip([one.as_slice(), &one, &two]).collect();
        let mut bytes = archive(&entries, CompressionMethod::Stored);
        // In its own header, and in the list at the end.
        while let Some(at) = bytes.windows(length).position(|name| name == names[2].as_bytes()) {
            bytes[at..at + length].copy_from_slice(names[0].as_bytes());
        }
        let found = npz_from_bytes(&bytes, Path::new("a.npz"), &Limits::default());
        assert_eq!(
            found.expect_err("a refusal").to_string(),
            format!("a.npz: array \"{}\": there twice; expected each array once", names[0])
        );
    }
}

#[test]
fn an_archive_is_the_bytes_that_the_format_asks_for() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.npz");
    let array = NamedArray {
        name: "t".into(),
        unit: "s",
        meaning: "times",
        shape: vec![("row", 1), ("column", 2)],
        data: ArrayData::F64(vec![1.5, 2.5]),
    };
    write_npz(&path, std::slice::from_ref(&array)).unwrap();
    let bytes = std::fs::read(&path).unwrap();
    // The local header: no 64-bit form, which some programs do not read; stored, as long as the array, name of 5 letters.
    let entry = array.npy();
    let at = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    let half = |at: usize| u16::from_le_bytes([bytes[at], bytes[at + 1]]);
    assert!(half(4) < 45, "version {}", half(4));
    assert_eq!((half(8), at(18), at(22), half(26), half(28)), (0, entry.len(), entry.len(), 5, 0));
    assert_eq!((&bytes[30..35], &bytes[35..35 + entry.len()]), (&b"t.npy"[..], entry.as_slice()));
}
