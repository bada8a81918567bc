//! Places of posts: tie points and matrices, areas and points, windows, far coordinates, units.

use super::read;
use super::write::{Double, Short, Tiff, plain_sample};
use super::{assert_names, refusal};
use raypencil_mesh_io::{Registration, load_mesh, read_dem, write_terrain_glb};

pub(super) fn keys(keys: &[[u16; 2]]) -> super::write::Values {
    let mut values = vec![1, 1, 0, keys.len() as u16];
    values.extend(keys.iter().flat_map(|&[key, value]| [key, 0, 1, value]));
    Short(values)
}

#[test]
fn areas_and_points() {
    // The tie point is at (10, 5); pixels are 0.5 m wide and 2 m high, 4 columns and 3 rows. An area's posts are
    // half a pixel from it: x = 10.25, 10.75, ..., 11.75; y = 4, 2, 0. A point's are on it: x = 10, ..., 11.5;
    // y = 5, 3, 1.
    let area = read(&Tiff::plain(), None).unwrap();
    assert_eq!(area.registration, Registration::Area);
    assert_eq!((area.posts.corner.x, area.posts.corner.y), (10.25, 0.0));
    assert_eq!((area.posts.spacing.x, area.posts.spacing.y), (0.5, 2.0));
    // The north-west pixel, (0, 0) with its 0.5 m, is the first of the last row; the south-east one is the last
    // of the first.
    assert_eq!(area.posts.at(0, 2).to_array(), [10.25, 4.0, 0.5]);
    assert_eq!(area.posts.at(3, 0).to_array(), [11.75, 0.0, 203.5]);

    let point = read(&Tiff::plain().tag(34735, keys(&[[1025, 2]])), None).unwrap();
    assert_eq!(point.registration, Registration::Point);
    assert_eq!(point.posts.at(0, 2).to_array(), [10.0, 5.0, 0.5]);

    // A file that states nothing has areas, and is marked as such.
    for tiff in [Tiff::plain().without(34735), Tiff::plain().tag(34735, keys(&[[1024, 1]]))] {
        let silent = read(&tiff, None).unwrap();
        assert_eq!((silent.registration, silent.posts), (Registration::AreaByDefault, area.posts.clone()));
        assert!(!silent.registration.is_stated() && silent.registration.word() == "area");
    }
    let message = refusal(&Tiff::plain().tag(34735, keys(&[[1025, 3]])), None);
    assert_names(&message, &["GeoKeyDirectoryTag, key 1025 GTRasterTypeGeoKey: 3", "PixelIsArea"]);
}

#[test]
fn a_tie_point_may_be_any_pixel() {
    // Pixel (2, 1) at (11, 3) is the same map: 11 - 2 * 0.5 = 10, 3 + 1 * 2 = 5.
    let tie = Double(vec![2.0, 1.0, 0.0, 11.0, 3.0, 0.0]);
    let moved = read(&Tiff::plain().tag(33922, tie), None).unwrap();
    assert_eq!(moved, dem_with_file(&moved, read(&Tiff::plain(), None).unwrap()));
}

/// The same model, with the file name of another.
fn dem_with_file(named: &raypencil_mesh_io::Dem, dem: raypencil_mesh_io::Dem) -> raypencil_mesh_io::Dem {
    raypencil_mesh_io::Dem { file: named.file.clone(), ..dem }
}

#[test]
fn matrices_that_scale_and_move() {
    let matrix = |a: f64, b: f64, d: f64, e: f64, f: f64, h: f64| {
        let rows = vec![a, b, 0.0, d, e, f, 0.0, h, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
        Tiff::plain().without(33550).without(33922).tag(34264, Double(rows))
    };
    let north_up = read(&matrix(0.5, 0.0, 10.0, 0.0, -2.0, 5.0), None).unwrap();
    assert_eq!(north_up.posts, read(&Tiff::plain(), None).unwrap().posts);
    // Rows to the north: the file's first row is the first of the posts. y = 5 + 0.5 * 2 = 6, 8, 10.
    let south_up = read(&matrix(0.5, 0.0, 10.0, 0.0, 2.0, 5.0), None).unwrap();
    assert_eq!(south_up.posts.at(0, 0).to_array(), [10.25, 6.0, 0.5]);
    assert_eq!(south_up.posts.at(3, 2).to_array(), [11.75, 10.0, 203.5]);
    // Turned, sheared, mirrored, flat.
    for tiff in [
        matrix(0.4, 0.3, 10.0, 0.3, -0.4, 5.0),
        matrix(0.5, 0.1, 10.0, 0.0, -2.0, 5.0),
        matrix(-0.5, 0.0, 10.0, 0.0, -2.0, 5.0),
        matrix(0.5, 0.0, 10.0, 0.0, 0.0, 5.0),
        matrix(f64::NAN, 0.0, 10.0, 0.0, -2.0, 5.0),
        matrix(0.5, 0.0, 1e300, 0.0, -2.0, 5.0),
    ] {
        assert_names(&refusal(&tiff, None), &["tag 34264 ModelTransformationTag", "expected "]);
    }
}

/// A program may take either of the two.
#[test]
fn a_matrix_beside_a_tie_point_says_the_same_place() {
    let beside = |a: f64, d: f64, f: f64, h: f64| {
        let rows = vec![a, 0.0, 0.0, d, 0.0, f, 0.0, h, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
        Tiff::plain().tag(34264, Double(rows))
    };
    let plain = read(&Tiff::plain(), None).unwrap().posts;
    assert_eq!(read(&beside(0.5, 10.0, -2.0, 5.0), None).unwrap().posts, plain);
    // A writer that rounds: a ten-thousandth of a pixel.
    assert!(read(&beside(0.5, 10.00005, -2.0, 4.9998), None).is_ok());
    // One tag alone says no place.
    assert!(read(&beside(0.5, 70.0, -2.0, 5.0).without(33550), None).is_ok());
    assert!(read(&beside(0.5, 70.0, -2.0, 5.0).without(33922), None).is_ok());
    for tiff in [
        beside(0.5, 11.0, -2.0, 5.0),
        beside(0.5, 10.002, -2.0, 5.0),
        beside(0.5, 10.0, -2.0, 6.0),
        beside(0.500_001, 10.0, -2.0, 5.0),
        beside(0.5, 10.0, -2.00001, 5.0),
        beside(0.5, 10.0, 2.0, 1.0),
    ] {
        let names = [
            "tag 34264 ModelTransformationTag, tag 33550 ModelPixelScaleTag and tag 33922 ModelTiepointTag: ",
        ];
        assert_names(&refusal(&tiff, None), &names);
    }
    let message = refusal(&beside(1.0, 5.0, -2.0, 5.0), None);
    let words = "the middle of pixel (0, 0) at (5.5, 4) and steps of 1 and -2, and at (10.25, 4) and steps of 0.5 and -2";
    assert_names(&message, &[words, "expected one place: take the matrix or the two others out"]);
    // What is refused of a tie point is refused beside a matrix, too.
    let heights = beside(0.5, 10.0, -2.0, 5.0).tag(33922, Double(vec![0.0, 0.0, 0.0, 10.0, 5.0, 250.0]));
    assert_names(
        &refusal(&heights, None),
        &["ModelTiepointTag: heights scaled by 0 and moved from 0 to 250"],
    );
}

#[test]
fn a_picture_without_a_place_is_refused() {
    let bare = Tiff::plain().without(33550).without(33922);
    assert_names(&refusal(&bare, None), &["tag 33550 ModelPixelScaleTag: missing", "34264", "-a_ullr"]);
    let half = Tiff::plain().without(33922);
    assert_names(&refusal(&half, None), &["tag 33922 ModelTiepointTag: missing"]);
    for (tag, numbers) in [
        (33550, vec![0.5, -2.0, 0.0]),
        (33550, vec![0.5, 0.0, 0.0]),
        (33550, vec![f64::NAN, 2.0, 0.0]),
        (33550, vec![0.5, 2.0]),
        (33550, vec![0.5, 2.0, 0.3]),
        (33922, vec![0.0; 12]),
        (33922, vec![0.0, 0.0, 0.0, 1.0, 1.0, 250.0]),
        (33922, vec![0.0, 0.0, 0.0, f64::INFINITY, 1.0, 0.0]),
    ] {
        assert_names(&refusal(&Tiff::plain().tag(tag, Double(numbers)), None), &["tag 33", "expected "]);
    }
}

#[test]
fn degrees_and_broken_keys_are_refused() {
    for (key, value, words) in [
        (1024, 2, ["GTModelTypeGeoKey: 2", "not degrees"]),
        (1024, 3, ["GTModelTypeGeoKey: 3", "geocentric"]),
    ] {
        let message = refusal(&Tiff::plain().tag(34735, keys(&[[key, value]])), None);
        assert_names(&message, &words);
        assert_names(&message, &["tag 34735 GeoKeyDirectoryTag, key "]);
    }
    for broken in [vec![], vec![1, 1, 0], vec![1, 1, 0, 9], vec![2, 1, 0, 0]] {
        assert_names(&refusal(&Tiff::plain().tag(34735, Short(broken)), None), &["GeoKeyDirectoryTag: "]);
    }
}

/// Of two values a program may take the first or the last.
#[test]
fn a_key_that_is_there_twice_is_refused_with_both_values() {
    for (pairs, words) in [
        ([[1025, 2], [1025, 1]], "key 1025 GTRasterTypeGeoKey: 2 and 1; expected the key once"),
        ([[1024, 2], [1024, 1]], "key 1024 GTModelTypeGeoKey: 2 and 1; expected the key once"),
        ([[4099, 9002], [4099, 9001]], "key 4099 VerticalUnitsGeoKey: 9002 and 9001; expected the key once"),
        (
            [[3076, 9001], [3076, 9001]],
            "key 3076 ProjLinearUnitsGeoKey: 9001 and 9001; expected the key once",
        ),
        ([[2060, 7], [2060, 8]], "key 2060 of another kind: 7 and 8; expected the key once"),
    ] {
        let message = refusal(&Tiff::plain().tag(34735, keys(&pairs)), None);
        assert_names(&message, &["tag 34735 GeoKeyDirectoryTag, ", words]);
    }
    let mixed = |entries: &[u16]| {
        let numbers = [&[1, 1, 0, entries.len() as u16 / 4], entries].concat();
        let tiff = Tiff::plain().tag(34735, Short(numbers)).tag(34736, Double(vec![0.5, 2.0]));
        refusal(&tiff.tag(34737, super::write::Values::Text("ab|cd|")), None)
    };
    let sizes = [3077, 34736, 1, 0, 3077, 34736, 1, 1];
    assert_names(&mixed(&sizes), &["key 3077 ProjLinearUnitSizeGeoKey: 0.5 and 2; expected the key once"]);
    let texts = [1026, 34737, 3, 0, 1026, 34737, 3, 3];
    assert_names(&mixed(&texts), &["key 1026 GTCitationGeoKey: \"ab\" and \"cd\"; expected the key once"]);
    // A number and a text are two values, too.
    let of_two_kinds = [1026, 0, 1, 5, 1026, 34737, 3, 3];
    assert_names(&mixed(&of_two_kinds), &["key 1026 GTCitationGeoKey: 5 and \"cd\"; expected the key once"]);
}

#[test]
fn messages_about_windows_name_the_posts() {
    let tiff = Tiff::plain();
    // Posts at x = 10.25 to 11.75, y = 0 to 4; the window's border is closed.
    let part = read(&tiff, Some([10.75, 0.0, 0.5, 2.0])).unwrap().posts;
    assert_eq!(part.heights, [201.5, 202.5, 101.5, 102.5]);
    assert_eq!((part.corner.x, part.corner.y), (10.75, 0.0));
    assert_names(
        &refusal(&tiff, Some([0.0, 0.0, 1.0, 1.0])),
        &["window: no post in x 0 to 1, y 0 to 1 m", "posts of x 10.25 to 11.75, y 0 to 4 m"],
    );
    assert_names(&refusal(&tiff, Some([10.0, -1.0, 0.5, 9.0])), &["window: 1 x 3 posts", "2 x 2"]);
    for window in [
        [10.0, 0.0, -1.0, 1.0],
        [10.0, 0.0, 1.0, 0.0],
        [f64::NAN, 0.0, 1.0, 1.0],
        [0.0, 0.0, f64::INFINITY, 1.0],
    ] {
        assert_names(&refusal(&tiff, Some(window)), &["window: ", "lower left corner"]);
    }
}

#[test]
fn a_million_metres_away_a_ground_is_the_same_ground() {
    let folder = tempfile::tempdir().unwrap();
    for far in [0.0, 1e3, 1e6] {
        // Pixels of 0.1 m: their middles are at far + 0.05, 0.15, ...; the scene origin is a whole metre near by.
        let mut tiff = Tiff::plain()
            .tag(33550, Double(vec![0.1, 0.1, 0.0]))
            .tag(33922, Double(vec![0.0, 0.0, 0.0, far, far, 0.0]));
        (tiff.size, tiff.block) = ([30, 20], vec![16, 16]);
        let path = tiff.with(|c, r| plain_sample(c, r) / 100.0).write(folder.path());
        let dem = read_dem(&path, None).unwrap();
        let mesh = dem.mesh(None, 0.25).unwrap();
        assert_eq!(mesh.faces().len(), 2 * 29 * 19);
        for (index, vertex) in mesh.vertices().iter().enumerate() {
            let (column, row) = (index % 30, 19 - index / 30);
            // As exact decimals would have it: far + 0.1 (column + 1/2), far - 0.1 (row + 1/2).
            let x = far - mesh.origin().x + 0.1 * (column as f64 + 0.5);
            let y = far - mesh.origin().y - 0.1 * (row as f64 + 0.5);
            assert!(
                (f64::from(vertex[0]) - x).abs() < 1e-6 && (f64::from(vertex[1]) - y).abs() < 1e-6,
                "{far}"
            );
        }
        // To a file and back, bit for bit.
        let glb = folder.path().join("ground.glb");
        write_terrain_glb(&glb, &mesh, &serde_json::json!({})).unwrap();
        let back = load_mesh(&glb).unwrap();
        assert_eq!(back, mesh);
        let bits = |mesh: &raypencil_scene::Mesh| -> Vec<u32> {
            mesh.vertices().as_flattened().iter().map(|coordinate| coordinate.to_bits()).collect()
        };
        assert_eq!(bits(&back), bits(&mesh), "{far}");
    }
}

#[test]
fn posts_that_single_precision_cannot_hold_apart() {
    // 1 mm apart at 900 m: the scene origin stays at 0, where an f32 is good to 6e-5 m only at 1 km, so that 1 mm
    // holds; 0.1 mm does not.
    let at = |spacing: f64| {
        Tiff::plain()
            .tag(33550, Double(vec![spacing, spacing, 0.0]))
            .tag(33922, Double(vec![0.0, 0.0, 0.0, 900.0, 900.0, 0.0]))
    };
    assert!(read(&at(1e-3), None).unwrap().mesh(None, 0.25).is_ok());
    let message = read(&at(1e-4), None).unwrap().mesh(None, 0.25).unwrap_err().to_string();
    assert_names(&message, &["spacing: posts 0.0001 m apart", "single precision"]);
    let dem = read(&Tiff::plain(), None).unwrap();
    assert_names(&dem.mesh(Some(0.0), 0.25).unwrap_err().to_string(), &["largest error: 0 m", "1e-6"]);
    let none = read(&Tiff::plain().with(|c, r| if (c + r) % 2 == 0 { 1.0 } else { f64::NAN }), None).unwrap();
    assert_names(
        &none.mesh(None, 0.25).unwrap_err().to_string(),
        &["6 of 12 posts not known", "a cell with four"],
    );
}

/// Posts that single precision cannot hold apart along one axis, although it can along the other.
#[test]
fn the_nearer_of_the_posts_have_to_be_apart() {
    for (spacing, is_mesh) in [([2.0, 1e-7], false), ([1e-7, 2.0], false), ([2.0, 1e-3], true)] {
        let tiff = Tiff::plain().tag(33550, Double(vec![spacing[0], spacing[1], 0.0]));
        let mesh = read(&tiff, None).unwrap().mesh(None, 0.25);
        assert_eq!(mesh.is_ok(), is_mesh, "{spacing:?}");
        if let Err(error) = mesh {
            assert_names(
                &error.to_string(),
                &["spacing: posts 0.0000001 m apart", "offsets in single precision"],
            );
        }
    }
}

#[test]
fn the_first_post_may_be_a_million_kilometres_away() {
    // The post is in the middle of a pixel of 0.5 m, and the others are nearer.
    let at = |x: f64| Tiff::plain().tag(33922, Double(vec![0.0, 0.0, 0.0, x - 0.25, 5.0, 0.0]));
    assert_eq!(read(&at(-1e9), None).unwrap().posts.corner.x, -1e9);
    assert_names(
        &refusal(&at(-1e9 - 0.5), None),
        &["ModelPixelScaleTag: pixel (0, 0) at (-1000000000.5, 4)", "coordinates within 1e9 m"],
    );
}
