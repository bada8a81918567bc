//! Point clouds of other programs: what is read, and what is refused with which words.

use raypencil_mesh_io::{
    Cloud, CloudStorage, PackedField, PackedKind, PackedPoints, cloud_from_bytes, lzf_compressed,
};

fn read(bytes: &[u8]) -> Result<Cloud, String> {
    cloud_from_bytes(bytes, "c".as_ref(), |name| name != "unasked").map_err(|error| error.to_string())
}

fn header(data: &str) -> String {
    format!(
        "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z _ ring time normal unasked\nSIZE 4 4 8 1 2 4 4 1\nTYPE F F F U U I F U\n\
         COUNT 1 1 1 3 1 1 2 1\nWIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA {data}\n"
    )
}

/// The points of that header, field by field.
fn fields() -> Vec<[Vec<u8>; 2]> {
    let single = |a: f32, b: f32| [a.to_le_bytes().to_vec(), b.to_le_bytes().to_vec()];
    vec![
        single(1.5, f32::NAN),
        single(-2.0, 4.0),
        [0.1_f64.to_le_bytes().to_vec(), 3.0_f64.to_le_bytes().to_vec()],
        [vec![7; 3], vec![7; 3]],
        [500_u16.to_le_bytes().to_vec(), 65_535_u16.to_le_bytes().to_vec()],
        [(-5_i32).to_le_bytes().to_vec(), 6_i32.to_le_bytes().to_vec()],
        [vec![0; 8], vec![0; 8]],
        [vec![1], vec![2]],
    ]
}

#[track_caller]
fn expect(cloud: &Cloud) {
    let names: Vec<&str> = cloud.columns.iter().map(|column| column.name.as_str()).collect();
    assert_eq!(names, ["x", "y", "z", "ring", "time"]);
    let of = |name: &str| cloud.column(name).expect("a field").values.clone();
    assert!(of("x")[0] == 1.5 && of("x")[1].is_nan());
    assert_eq!((of("y"), of("z")), (vec![-2.0, 4.0], vec![0.1, 3.0]));
    assert_eq!((of("ring"), of("time")), (vec![500.0, 65_535.0], vec![-5.0, 6.0]));
    assert_eq!((cloud.width, cloud.height, cloud.len(), cloud.is_empty()), (2, 1, 2, false));
}

#[test]
fn the_three_kinds_of_pcd_are_the_same_cloud() {
    let mut binary = header("binary").into_bytes();
    for point in [0, 1] {
        fields().iter().for_each(|field| binary.extend(&field[point]));
    }
    let cloud = read(&binary).expect("a cloud");
    expect(&cloud);
    assert_eq!(cloud.columns[0].storage, CloudStorage::Single);
    assert_eq!(cloud.columns[2].storage, CloudStorage::Double);
    assert_eq!(cloud.columns[3].storage, CloudStorage::Whole);
    // Field by field; LZF of at most 32 bytes as they are at a time.
    let plain: Vec<u8> = fields().iter().flatten().flatten().copied().collect();
    let packed: Vec<u8> =
        plain.chunks(32).flat_map(|part| [&[part.len() as u8 - 1], part].concat()).collect();
    let mut compressed = header("binary_compressed").into_bytes();
    compressed.extend((packed.len() as u32).to_le_bytes());
    compressed.extend((plain.len() as u32).to_le_bytes());
    compressed.extend(&packed);
    expect(&read(&compressed).expect("a cloud"));
    let text = header("ascii") + "1.5 -2 0.1 7 7 7 500 -5 0 0 1\nnan 4.00 3e0 7 7 7 65535 6 0 0 2\n";
    let cloud = read(text.as_bytes()).expect("a cloud");
    expect(&cloud);
    // Two decimals, after single precision: half a hundredth and half a unit at 4.
    assert_eq!(cloud.columns[1].error(1), 0.005 + 1.0 / 4_194_304.0);
    // Whatever is cut off is no cloud.
    for file in [&binary, &compressed] {
        for end in [file.len() - 1, file.len() - plain.len()] {
            assert!(read(&file[..end]).unwrap_err().contains("cut off"), "{end}");
        }
    }
    // The Point Cloud Library up to 1.8 leaves zeros behind the points, and nobody leaves anything else there.
    for file in [&binary, &compressed] {
        expect(&read(&[&file[..], &[0; 64]].concat()).expect("a cloud"));
        let message = read(&[&file[..], b"\0more"].concat()).unwrap_err();
        assert!(message.contains("data: 5 bytes after the last point"), "{message}");
    }
    let end = text.len() - 3;
    assert!(read(&text.as_bytes()[..end]).unwrap_err().contains("10 numbers; expected 11 numbers"));
}

#[test]
fn vertices_of_ply_are_a_cloud() {
    let text = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty double y\nproperty float z\n\
                property uchar ring\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n\
                1.25 2.5 nan 3\n0 0 -1 4\n3 0 0 0\n";
    let cloud = read(text.as_bytes()).expect("a cloud");
    assert_eq!(cloud.column("ring").expect("a field").values, [3.0, 4.0]);
    // The coordinates have two decimals at most.
    assert_eq!(cloud.column("y").expect("a field").error(0), 0.005);
    assert!(cloud.column("z").expect("a field").values[0].is_nan());
    let mut binary =
        b"ply\nformat binary_big_endian 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
            .to_vec();
    [1.0_f32, 2.0, 3.0].iter().for_each(|part| binary.extend(part.to_be_bytes()));
    let surplus = read(&[&binary[..], &[0; 4]].concat()).unwrap_err();
    assert!(surplus.contains("4 bytes after the last row; expected the end of the file"), "{surplus}");
    let cloud = read(&binary).expect("a cloud");
    assert_eq!(cloud.columns[2].values, [3.0]);
    assert_eq!(cloud.columns[2].storage, CloudStorage::Single);
}

#[test]
fn what_is_no_cloud_is_refused_in_one_sentence() {
    let good =
        "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ascii\n1 2 3\n";
    assert!(read(good.as_bytes()).is_ok());
    let cases = [
        ("FIELDS x y z", "FIELDS x y", "fields: no z; expected x, y and z"),
        ("FIELDS x y z", "FIELDS x y z y", "SIZE: 3 words; expected 4"),
        ("SIZE 4 4 4", "SIZE 4 3 4", "field `y`: SIZE 3, TYPE F; expected SIZE 1, 2, 4 or 8"),
        ("SIZE 4 4 4", "SIZE 4 2 4", "TYPE I, U or F, which has 4 or 8"),
        ("TYPE F F F", "TYPE F Q F", "field `y`: SIZE 4, TYPE Q"),
        ("TYPE F F F\n", "TYPE F F F\nCOUNT 1 2 1\n", "field `y`: COUNT 2; expected a single number"),
        ("TYPE F F F\n", "TYPE F F F\nCOUNT 1 0 1\n", "field `y`: COUNT 0; expected 1 to 65536"),
        ("WIDTH 1", "WIDTH 2", "1 POINTS, 2 WIDTH, 1 HEIGHT; expected WIDTH times HEIGHT"),
        ("WIDTH 1", "WIDTH one", "line 5: one; expected WIDTH and a number"),
        (
            "WIDTH 1\nHEIGHT 1\nPOINTS 1",
            "WIDTH 99999999999\nPOINTS 99999999999",
            "3 numbers for each of 99999999999 points",
        ),
        ("WIDTH 1\nHEIGHT 1\nPOINTS 1", "WIDTH 9999999999999999999\nHEIGHT 9999999999", "header: no POINTS"),
        ("DATA ascii", "DATA octal", "line 8: octal; expected DATA and ascii"),
        (
            "DATA ascii",
            "DATA binary",
            "line 8: DATA binary, before rows of numbers as text; expected DATA ascii, or the bytes of the numbers",
        ),
        (
            "DATA ascii",
            "DATA binary_compressed",
            "line 8: DATA binary_compressed, before rows of numbers as text",
        ),
        ("DATA ascii\n1 2 3\n", "DATA binary\n123456", "data: 6 bytes; expected 12 for each of 1 points"),
        (
            "DATA ascii\n1 2 3\n",
            "DATA binary_compressed\n123456",
            "data: 6 bytes; expected two sizes of 4 bytes",
        ),
        // As many bytes as points of single precision have.
        ("DATA ascii\n1 2 3\n", "DATA binary\n\n1.25 -2 3e+01\n", "line 8: DATA binary, before rows"),
        (
            "1 2 3\n",
            "1 2 3\n\u{1} \u{80}",
            "line 10: bytes that are no text; expected numbers as text, as `DATA ascii` says (is it DATA binary?)",
        ),
        ("DATA ascii\n1 2 3\n", "", "line 8: the end of the header"),
        ("1 2 3", "1 2 x", "line 9, field `z`: \"x\"; expected a decimal number, or nan"),
        ("1 2 3", "1 2 3\n4 5 6", "line 10: a line after the last point"),
        ("VERSION .7", "VERTEX", "file: neither `ply` nor the header of a PCD file"),
        ("HEIGHT 1", "DEPTH 1", "line 6: DEPTH; expected VERSION, FIELDS"),
        ("VERSION .7", "VERSION 9", "line 1: VERSION 9; expected VERSION 0.5, 0.6 or 0.7"),
        ("VERSION .7", "VERSION .7 1", "line 1: VERSION .7 1; expected VERSION 0.5"),
        (
            "WIDTH 1",
            "VIEWPOINT nan 2 3 1 0 0 0\nWIDTH 1",
            "line 5: VIEWPOINT nan 2 3 1 0 0 0; expected VIEWPOINT, a position",
        ),
        ("WIDTH 1", "VIEWPOINT 1 2 3\nWIDTH 1", "line 5: VIEWPOINT 1 2 3; expected VIEWPOINT, a position"),
        ("WIDTH 1", "VIEWPOINT 1 2 3 9 9 9 9\nWIDTH 1", "a unit quaternion, seven numbers"),
        (
            "DATA ascii\n1 2 3\n",
            "DATA binary\n\0\0\0\0\0\0\0\0\0\0\0\0\0zz",
            "data: 3 bytes after the last point; expected the end of the file, or zeros",
        ),
    ];
    for (from, to, words) in cases {
        let message = read(good.replace(from, to).as_bytes()).expect_err(to);
        assert!(message.starts_with("c: ") && message.contains(words), "{to:?}: {message}");
    }
    let ply =
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nend_header\n1 2\n";
    assert!(read(ply.as_bytes()).unwrap_err().contains("no z"));
    let long = ply.replace("property float y", "property float y\nproperty float z") + " 3\n4 5 6\n";
    let message = read(long.replace("1 2\n 3", "1 2 3").as_bytes()).unwrap_err();
    assert!(message.contains("line 9: a line after the last row; expected the end of the file"), "{message}");
    let ply = ply.replace("vertex", "face");
    assert!(read(ply.as_bytes()).unwrap_err().contains("another element first"));
    // Sizes that no file of this length has.
    let mut huge = good.replace("DATA ascii\n1 2 3\n", "DATA binary_compressed\n").into_bytes();
    huge.extend([[9, 0, 0, 0], [12, 0, 0, 0]].concat());
    assert!(read(&huge).unwrap_err().contains("9 compressed bytes (is the file cut off?)"));
}

#[test]
fn no_cut_and_no_changed_byte_breaks_the_reader() {
    let mut binary = header("binary").into_bytes();
    for point in [0, 1] {
        fields().iter().for_each(|field| binary.extend(&field[point]));
    }
    let mut compressed = header("binary_compressed").into_bytes();
    // Ten bytes as they are, then copies of what is before them, 68 bytes in all.
    let packed = [&[9][..], &[0; 10], &[7 << 5, 49, 4]].concat();
    compressed.extend([(packed.len() as u32).to_le_bytes(), 68_u32.to_le_bytes()].concat());
    compressed.extend(&packed);
    let text = header("ascii") + "1.5 -2 0.1 7 7 7 500 -5 0 0 1\nnan 4.00 3e0 7 7 7 65535 6 0 0 2\n";
    for good in [binary, compressed, text.into_bytes()] {
        let whole = read(&good);
        assert!(whole.is_ok(), "{whole:?}");
        for at in 0..good.len() {
            // What is read has a number of each field for each point.
            let check = |bytes: &[u8]| {
                if let Ok(cloud) = read(bytes) {
                    let points = cloud.width * cloud.height;
                    assert!(cloud.columns.iter().all(|column| column.values.len() as u64 == points));
                    cloud
                        .columns
                        .iter()
                        .for_each(|column| assert!((0..cloud.len()).all(|k| column.error(k) >= 0.0)));
                }
            };
            check(&good[..at]);
            for byte in [0, b'\n', b' ', b'9', b'-', 0x80, 0xff, good[at] ^ 1] {
                let mut changed = good.clone();
                changed[at] = byte;
                check(&changed);
            }
        }
    }
}

#[test]
fn decimal_numbers_beyond_their_type_are_refused() {
    let pcd = |number: &str| {
        let head =
            "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 8\nTYPE F F F\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ascii";
        read(format!("{head}\n0 {number} 1e200\n").as_bytes())
    };
    let ply = |number: &str| {
        let head =
            "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty double z";
        read(format!("{head}\nend_header\n0 {number} 1e200\n").as_bytes())
    };
    for of in [&pcd as &dyn Fn(&str) -> Result<Cloud, String>, &ply] {
        for number in ["3.5e38", "-3.5e38", "1e999"] {
            let message = of(number).expect_err("f32 ends at 3.4e38");
            assert!(message.contains(number) && message.contains("that its type holds"), "{message}");
        }
        // The largest number of f32 has half the gap below it, 2^103: what its decimal leaves open is lost beside it.
        let cloud = of("340282346638528859811704183484516925440.0").expect("the largest of f32");
        let error = cloud.column("y").expect("a field").error(0);
        assert_eq!(error, (1_u128 << 103) as f64);
        for endless in ["inf", "-inf", "nan"] {
            assert!(!of(endless).expect("a word for it").column("y").expect("a field").values[0].is_finite());
        }
    }
}

/// Half of the last printed decimal, which an exponent moves.
#[test]
fn a_printed_number_may_be_off_by_half_of_its_last_decimal_wherever_its_point_is() {
    let header = "ply\nformat ascii 1.0\nelement vertex 1\nproperty double x\nproperty double y\nproperty double z\nend_header\n";
    // The last line may lack its end.
    let cloud = read(format!("{header}1 2 3").as_bytes()).unwrap();
    assert_eq!(cloud.len(), 1);
    for (text, error) in
        [("1.25e-3", 5e-6), ("1.25E-3", 5e-6), ("1e2", 50.0), ("1.5e2", 5.0), ("7", 0.5), ("7.", 0.5)]
    {
        let cloud = read(format!("{header}{text} 0 0\n").as_bytes()).unwrap();
        assert_eq!(cloud.column("x").unwrap().error(0), error, "{text}");
    }
}

#[test]
fn rows_of_packed_points_may_have_bytes_behind_them() {
    let real = |(name, offset): (&str, usize)| PackedField {
        name: name.into(),
        offset,
        kind: PackedKind::Real,
        size: 4,
        count: 1,
    };
    let fields = [("x", 0), ("y", 4), ("z", 8)].map(real);
    // Two points of 16 bytes in a row, and 8 bytes behind each row.
    let point = |x: f32| [[x, 10.0 + x, 20.0 + x].map(f32::to_le_bytes).as_flattened(), &[0xff; 4]].concat();
    let row = |x: f32| [point(x), point(x + 1.0), vec![0xff; 8]].concat();
    let data = [row(0.0), row(2.0)].concat();
    let points = PackedPoints {
        fields: &fields,
        size: [2, 2],
        point_step: 16,
        row_step: 40,
        is_big_endian: false,
        data: &data,
    };
    let cloud = points.cloud(|_| true).unwrap();
    assert_eq!((cloud.width, cloud.height), (2, 2));
    let of = |name: &str| cloud.column(name).unwrap().values.clone();
    assert_eq!((of("x"), of("z")), (vec![0.0, 1.0, 2.0, 3.0], vec![20.0, 21.0, 22.0, 23.0]));
}

#[test]
fn the_shortest_text_of_a_cloud_is_read() {
    let header = "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA ascii\n";
    // A digit for each number, and nothing behind the last.
    let cloud = read(format!("{header}1 2 3\n4 5 6").as_bytes()).unwrap();
    assert_eq!(cloud.column("z").unwrap().values, [3.0, 6.0]);
    let error = read(format!("{header}1 2 3\n4 5").as_bytes()).unwrap_err();
    assert!(error.contains("data: 9 bytes; expected 3 numbers for each of 2 points"), "{error}");
}

#[test]
fn a_copy_reaches_8192_bytes_back_and_no_further() {
    let apart = |bytes: usize| lzf_compressed(&[&[1, 2, 3][..], &vec![0; bytes - 3], &[1, 2, 3]].concat());
    // Three bytes from 8191 + 1 back; or as they are.
    assert!(apart(8192).ends_with(&[1 << 5 | 31, 255]), "{:?}", apart(8192));
    assert!(apart(8193).ends_with(&[2, 1, 2, 3]), "{:?}", apart(8193));
}

#[test]
fn whole_numbers_beyond_their_type_and_fractions_are_refused() {
    let pcd = |kind: char, size: usize, word: &str| {
        let head = format!(
            "VERSION 0.7\nFIELDS x y z ring\nSIZE 4 4 4 {size}\nTYPE F F F {kind}\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ascii"
        );
        read(format!("{head}\n0 1 2 {word}\n").as_bytes())
    };
    let ply = |kind: char, size: usize, word: &str| {
        let name = match size {
            1 => "char",
            2 => "short",
            _ => "int",
        };
        let sign = if kind == 'U' { "u" } else { "" };
        let head =
            "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z";
        read(format!("{head}\nproperty {sign}{name} ring\nend_header\n0 1 2 {word}\n").as_bytes())
    };
    let limits: [(char, usize, &str, &str); 6] = [
        ('U', 1, "0", "255"),
        ('I', 1, "-128", "127"),
        ('U', 2, "0", "65535"),
        ('I', 2, "-32768", "32767"),
        ('U', 4, "0", "4294967295"),
        ('I', 4, "-2147483648", "2147483647"),
    ];
    for of in [&pcd as &dyn Fn(char, usize, &str) -> Result<Cloud, String>, &ply] {
        for (kind, size, least, most) in limits {
            for held in [least, most] {
                let value: f64 = held.parse().expect("a number");
                for word in [held.to_string(), format!("{held}.0"), format!("{value:e}")] {
                    let cloud =
                        of(kind, size, &word).unwrap_or_else(|error| panic!("{kind}{size} {word}: {error}"));
                    assert_eq!(cloud.column("ring").expect("a field").values, [value], "{kind}{size} {word}");
                }
            }
            let value = |word: &str| word.parse::<i64>().expect("a number");
            let beyond = [(value(least) - 1).to_string(), (value(most) + 1).to_string()];
            let others = ["0.5", "nan", "inf", "1e300", "five"].map(String::from);
            for word in beyond.into_iter().chain(others) {
                let message = of(kind, size, &word).expect_err("no such number");
                assert!(
                    message.contains(&word) && message.contains("a whole number that its type holds"),
                    "{message}"
                );
            }
        }
    }
    // 64 bits, which PLY does not have: the last numbers are told apart though no double does.
    for (kind, held, beyond) in [
        ('U', "18446744073709551615", "18446744073709551616"),
        ('I', "9223372036854775807", "9223372036854775808"),
        ('I', "-9223372036854775808", "-9223372036854775809"),
    ] {
        assert!(pcd(kind, 8, held).is_ok());
        let message = pcd(kind, 8, beyond).expect_err("no such number");
        assert!(message.contains("line 9, field `ring`") && message.contains(beyond), "{message}");
    }
    // What a double does not tell apart is to be printed as digits alone.
    assert!(pcd('U', 8, "100000000000000000").is_ok() && pcd('U', 8, "1e17").is_err());
}

#[test]
fn lengths_and_corners_of_polygons_fit_their_types() {
    let mesh = |length: &str, index: &str, row: &str| {
        let mut text = "ply\nformat ascii 1.0\nelement vertex 300\nproperty float x\nproperty float y\nproperty float z\n".to_string();
        text += &format!("element face 1\nproperty list {length} {index} vertex_indices\nend_header\n");
        for k in 0..300 {
            text += &format!("{k} {} 0\n", k * k);
        }
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("m.ply");
        std::fs::write(&path, text + row).expect("a file");
        raypencil_mesh_io::read_triangles(&path)
            .map(|read| read.triangles.faces().len())
            .map_err(|error| error.to_string())
    };
    assert_eq!(mesh("uchar", "int", "3 0 1 299\n"), Ok(1));
    let message = mesh("uchar", "uchar", "3 0 1 256\n").expect_err("a byte ends at 255");
    assert!(
        message.contains("line 310") && message.contains("256") && message.contains("(uchar)"),
        "{message}"
    );
    let corners: Vec<String> = (0..256).map(|k: i32| k.to_string()).collect();
    let polygon = format!("256 {}\n", corners.join(" "));
    let message = mesh("uchar", "int", &polygon).expect_err("a byte ends at 255");
    assert!(message.contains("256") && message.contains("(uchar)"), "{message}");
    assert_eq!(mesh("ushort", "short", &polygon), Ok(254));
}
