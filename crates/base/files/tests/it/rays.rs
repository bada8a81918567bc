//! Rays from files: NPY and CSV, and what is refused.

use proptest::prelude::*;
use raypencil_files::{RayArray, ray_rows, rays_from_bytes};

fn read(bytes: &[u8]) -> Result<RayArray, String> {
    rays_from_bytes(bytes, "rays".as_ref()).map_err(|error| error.to_string())
}

/// An NPY file of version 1.0.
fn npy(descr: &str, shape: &str, numbers: &[u8]) -> Vec<u8> {
    let header = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': {shape}, }}");
    let mut file = b"\x93NUMPY\x01\x00".to_vec();
    file.extend((header.len() as u16).to_le_bytes());
    file.extend(header.as_bytes());
    file.extend(numbers);
    file
}

fn singles(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

#[test]
fn arrays_of_any_leading_shape_are_rays() {
    let numbers: Vec<f32> = (0..12).map(|k| k as f32 + 0.5).collect();
    let found = read(&npy("<f4", "(1, 2, 1, 6)", &singles(&numbers))).unwrap();
    assert_eq!((found.shape, found.rays.len()), (vec![1, 2, 1], 2));
    assert_eq!(found.rays[1].origin.to_array(), [6.5, 7.5, 8.5]);
    assert_eq!(found.rays[1].direction.to_array(), [9.5, 10.5, 11.5]);
    assert_eq!((found.rays[1].t_min, found.rays[1].t_max), (0.0, f64::INFINITY));
    // With both ends, and without a leading dimension: one ray.
    let numbers = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.25, f32::INFINITY];
    let found = read(&npy("<f4", "(8,)", &singles(&numbers))).unwrap();
    assert_eq!((found.shape, found.rays.len()), (vec![], 1));
    assert_eq!((found.rays[0].t_min, found.rays[0].t_max), (0.25, f64::INFINITY));
    // With the shortest range of a sensor.
    let numbers = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.25, 8.0, 0.5];
    let found = read(&npy("<f4", "(1, 9)", &singles(&numbers))).unwrap().rays[0];
    assert_eq!((found.t_min, found.t_max, found.t_blind), (0.25, 8.0, 0.5));
}

#[test]
fn rows_of_numbers_are_rays() {
    let text = "# made by hand\nox,oy,oz,dx,dy,dz\n\n 0.1, -2,3e2 ,0,0,-1\n1,2,3,4,5,6\n";
    let found = read(text.as_bytes()).unwrap();
    assert_eq!(found.shape, [2]);
    // The double nearest to the decimal.
    assert_eq!(found.rays[0].origin.to_array(), [0.1, -2.0, 300.0]);
    let found = read(b"0,0,0,1,0,0,0.5,inf\r\n0,0,0,1,0,0,0.5,2\r\n").unwrap();
    assert_eq!(found.rays[0].t_max, f64::INFINITY);
    assert_eq!((found.rays[1].t_min, found.rays[1].t_max, found.rays[1].t_blind), (0.5, 2.0, 0.0));
    assert_eq!(read(b"0,0,0,1,0,0,0,inf,0.8").unwrap().rays[0].t_blind, 0.8);
}

#[test]
fn rows_of_rays_have_a_ninth_number_if_one_of_them_has_a_shortest_range() {
    let rays = read(b"0,0,0,1,0,0,0,inf,0.8\n1,2,3,0,1,0,0.5,2,0\n").unwrap().rays;
    let (width, numbers) = ray_rows(&rays);
    assert_eq!((width, numbers.len()), (9, 18));
    assert_eq!(numbers[9..], [1.0, 2.0, 3.0, 0.0, 1.0, 0.0, 0.5, 2.0, 0.0]);
    assert_eq!(ray_rows(&rays[1..]), (8, vec![1.0, 2.0, 3.0, 0.0, 1.0, 0.0, 0.5, 2.0]));
}

#[test]
fn a_heading_names_the_columns() {
    let ray = |text: &str| {
        let found = read(text.as_bytes()).unwrap();
        assert_eq!(found.shape, [1]);
        let ray = found.rays[0];
        (ray.origin.to_array(), ray.direction.to_array(), [ray.t_min, ray.t_max, ray.t_blind])
    };
    let both = ([1.0, 2.0, 3.0], [4.0, 5.0, 6.0]);
    let plain = (both.0, both.1, [0.0, f64::INFINITY, 0.0]);
    assert_eq!(ray("dx,dy,dz,ox,oy,oz\n4,5,6,1,2,3"), plain);
    assert_eq!(ray("OX, oy ,oz,dx,DY,dz\n1,2,3,4,5,6"), plain);
    // Each of the ends may be left out.
    assert_eq!(ray("t_max,dx,dy,dz,ox,oy,oz\n7,4,5,6,1,2,3"), (both.0, both.1, [0.0, 7.0, 0.0]));
    let all = "ox,oy,oz,dx,dy,dz,t_blind,t_max,t_min\n1,2,3,4,5,6,0.5,7,0.25";
    assert_eq!(ray(all), (both.0, both.1, [0.25, 7.0, 0.5]));
    // NumPy's savetxt writes its heading as a comment; other comments are none.
    assert_eq!(ray("# by me\n# dx,dy,dz,ox,oy,oz\n4,5,6,1,2,3"), plain);
    assert_eq!(ray("# dx,dy,dz\n1,2,3,4,5,6\n# of dx,dy,dz\n"), plain);
    let prose = "# rays: ox, oy, oz are the origin, dx, dy, dz the direction\n1,2,3,4,5,6";
    assert_eq!(ray(prose), plain);
    // Of two headings the one next to the numbers counts.
    assert_eq!(ray("# ox,oy,oz,dx,dy,dz\n# dx,dy,dz,ox,oy,oz\n4,5,6,1,2,3"), plain);
    // Whatever stands between the names and around them, and before the whole text.
    for heading in
        ["# \"dx\",\"dy\",\"dz\",\"ox\",\"oy\",\"oz\"", "# dx;dy;dz;ox;oy;oz", "#dx dy\tdz  ox oy oz"]
    {
        assert_eq!(ray(&format!("{heading}\n4,5,6,1,2,3")), plain, "{heading}");
        assert_eq!(ray(&format!("\u{feff}{heading}\r\n4,5,6,1,2,3")), plain, "{heading} behind a mark");
    }
    assert_eq!(ray("\u{feff}dx,dy,dz,ox,oy,oz\n4,5,6,1,2,3"), plain);
    assert_eq!(ray("\u{feff}1,2,3,4,5,6"), plain);
    // The heading of a file that was joined, with the same columns.
    for first in ["", "# ox,oy,oz,dx,dy,dz\n", "ox,oy,oz,dx,dy,dz\n"] {
        let text = format!("{first}1,2,3,4,5,6\n# ox,oy,oz,dx,dy,dz\n1,2,3,4,5,6\n");
        assert_eq!(read(text.as_bytes()).unwrap().rays.len(), 2, "{text}");
    }
}

#[test]
fn each_wrong_file_is_told_where_it_is_wrong() {
    for (bytes, message) in [
        (
            npy("<f8", "(1, 5)", &[0; 40]),
            "rays: shape: [1, 5]; expected (..., 6), (..., 8) or (..., 9): 6 numbers (origin, \
            direction), 8 (origin, direction, t_min, t_max) or 9 (with t_blind)",
        ),
        (npy("<f8", "()", &[0; 8]), "rays: shape: []; expected (..., 6)"),
        (npy("<f4", "(2, 6)", &[0; 47]), "rays: numbers: 47 bytes; expected the 48 bytes of shape [2, 6]"),
        (
            npy("<f4", "(1, 6)", &singles(&[0.0; 6])),
            "rays: ray 0.direction is [0, 0, 0]: expected three finite numbers",
        ),
        // Files that were joined.
        (
            b"# dx,dy,dz,ox,oy,oz\n0,0,1,0,0,0\n# ox,oy,oz,dx,dy,dz\n1,1,1,1,1,1".to_vec(),
            "rays: line 3: a heading of other columns, ox,oy,oz,dx,dy,dz; expected dx,dy,dz,ox,oy,oz, as the rows before it",
        ),
        (
            b"0,0,0,0,0,1\n\n# dx,dy,dz,ox,oy,oz\n1,1,1,1,1,1".to_vec(),
            "rays: line 3: a heading of other columns, dx,dy,dz,ox,oy,oz; expected ox,oy,oz,dx,dy,dz, as the rows before it",
        ),
        (
            b"dx,dy,dz,ox,oy,oz\n0,0,1,0,0,0\n# ox oy oz dx dy dz\n1,1,1,1,1,1".to_vec(),
            "rays: line 3: a heading of other columns",
        ),
        (
            b"0,0,0,0,0,1\n# ox,oy,oz,dx,dy,dz,t_min,t_max\n0,0,0,0,0,1".to_vec(),
            "rays: line 2: a heading of other columns",
        ),
        (b"0,0,0,0,0,1\n# dx,dy,dz,x,y,z\n0,0,0,0,0,1".to_vec(), "rays: line 2: \"x\"; expected a heading"),
        (b"0,0,0,0,0,1\n0,0,0,0,0".to_vec(), "rays: line 2: 5 fields; expected 6 numbers"),
        (b"0,0,0,0,0,1\n0,0,0,0,0,1,0,1".to_vec(), "rays: line 2: 8 fields; expected 6, as line 1 has"),
        (
            b"# one\n\n0,0,0,0,0,1\n# two\n0,0,0,0,0,1,0,1".to_vec(),
            "rays: line 5: 8 fields; expected 6, as line 3 has",
        ),
        (b"0;0;0;0;0;1\n".to_vec(), "rays: line 1: no comma between its numbers; expected 6 numbers"),
        (
            b"# ox oy oz dx dy dz\n0 0 0 0 0 1\n".to_vec(),
            "rays: line 2: no comma between its numbers; expected 6 numbers",
        ),
        (b"0 0 0 0 0 1\n".to_vec(), "rays: line 1: no comma between its numbers; expected 6 numbers"),
        (b"0\t0\t0\t0\t0\t1\n".to_vec(), "rays: line 1: no comma between its numbers; expected 6 numbers"),
        (b"ox,oy,oz,dx,dy,dz\n0,0,0,0,0,1,0,1".to_vec(), "rays: line 2: 8 fields; expected 6, as line 1 has"),
        (b"# dx,dy,dz,ox,oy,oz\n0,0,1,0".to_vec(), "rays: line 2: 4 fields; expected 6, as line 1 has"),
        (
            b"a,b,c,d,e,f\n0,0,0,0,0,1".to_vec(),
            "rays: line 1: \"a\"; expected a heading of the names ox,oy,oz,dx,dy,dz, and if wanted t_min,t_max,t_blind, in any order",
        ),
        (b"# dx,dy,dz,ox,oy,oy\n0,0,0,0,0,1".to_vec(), "rays: line 1: oy twice; expected a heading"),
        (b"# dx,dy,dz,x,y,z\n0,0,0,0,0,1".to_vec(), "rays: line 1: \"x\"; expected a heading"),
        (
            b"# dx,dy,dz,ox [m],oy [m],oz [m]\n0,0,0,0,0,1".to_vec(),
            "rays: line 1: \"ox [m]\"; expected a heading",
        ),
        (b"# x,y,z,dx/m,dy/m,dz/m\n0,0,0,0,0,1".to_vec(), "rays: line 1: \"x\"; expected a heading"),
        (b"\nox,oy,oz,dx,dy\n".to_vec(), "rays: line 2: no dz; expected a heading of the names"),
        (b"ox,oy,oz,dx,dy,dz,dx\n".to_vec(), "rays: line 1: dx twice; expected a heading of the names"),
        (
            b"ox oy oz dx dy dz\n0 0 0 0 0 1".to_vec(),
            "rays: line 1: \"ox oy oz dx dy dz\"; expected a heading",
        ),
        (npy("<f8", "(0, 6)", &[]), "rays: shape: [0, 6]; expected one ray or more"),
        (npy("<f4", "(4, 0, 9)", &[]), "rays: shape: [4, 0, 9]; expected one ray or more"),
        (b"0,0,0,0,0,1\n0,0,x,0,0,1".to_vec(), "rays: line 2: field 3: \"x\"; expected a number"),
        (b"0,0,0,0,0,1\na,b,c,d,e,f".to_vec(), "rays: line 2: field 1: \"a\"; expected a number"),
        (b"0,0,0,0,0,1\n0,0,0,nan,0,1".to_vec(), "rays: line 2: ray 1.direction is [NaN, 0, 1]: expected"),
        (
            b"0,0,0,0,0,1,2,1".to_vec(),
            "rays: line 1: ray 0.t_max is 1: expected 2 (t_min) to 1e30, or infinity",
        ),
        (b"0,0,0,0,0,1,0,inf,-1".to_vec(), "rays: line 1: ray 0.t_blind is -1: expected 0 to 1e30"),
        (b"0,0,0,0,0,1,0,2,3".to_vec(), "rays: line 1: ray 0.t_blind is 3: expected 0 to 2 (t_max)"),
        (b"0,0,0,0,0,1,0,1,0,0".to_vec(), "rays: line 1: 10 fields; expected 6 numbers"),
        (b"0,0,0,0,0,1,-1,1".to_vec(), "rays: line 1: ray 0.t_min is -1: expected 0 to 1e30"),
        (b"".to_vec(), "rays: file: no ray; expected rows of 6 numbers"),
        (b"# nothing\nox,oy,oz,dx,dy,dz\n".to_vec(), "rays: file: no ray; expected rows"),
        (b"\xff\xfe\n".to_vec(), "rays: line 1: bytes that are no text; expected rows of numbers"),
    ] {
        let error = read(&bytes).unwrap_err();
        assert!(error.starts_with(message), "{error}\n{message}");
    }
}

proptest! {
    /// Whatever the bytes are, there are rays or one error; a file cut off anywhere is one or the other.
    #[test]
    fn any_bytes_are_rays_or_an_error(bytes in prop::collection::vec(any::<u8>(), 0..200), cut in 0_usize..80) {
        let _ = read(&bytes);
        let whole = npy("<f8", "(2, 6)", &[0x3f; 96]);
        prop_assert!(read(&whole[..whole.len() - 1 - cut]).is_err());
        let text = String::from_utf8_lossy(&bytes).replace(|letter: char| !letter.is_ascii(), ",");
        let _ = read(format!("0,0,0,0,0,1\n{text}").as_bytes());
    }
}
