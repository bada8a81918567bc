//! A pack of rays upon a cube, and a candidate for it whose arrays are changed.

use raypencil_cast::{
    CandidateConventions, CastSource, Questions, RayArray, RayPackChecked, cast, check_ray_pack,
    rays_from_bytes, write_answers, write_ray_pack,
};
use raypencil_files::{read_npy_numbers, write_npy_numbers};
use raypencil_scene::{CastRay, Precision, Sides, Silent, Triangles};

use super::kept_packs::put_pack;

/// The cube from -1 to 1, its fronts outside.
pub(super) fn cube() -> Triangles {
    let corner = |k: u32| [0, 1, 2].map(|axis| if k >> axis & 1 == 1 { 1.0 } else { -1.0 });
    let squares = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let faces = squares.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
    Triangles::new((0..8).map(corner).collect(), faces.collect()).unwrap()
}

/// Rays from outside and inside at all lengths, with and without ends, some exactly through corners.
pub(super) fn rays() -> RayArray {
    let mut text = String::new();
    let mut state = 1_u64;
    let mut draw = |low: f64, high: f64| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * ((state >> 11) as f64 / (1_u64 << 53) as f64)
    };
    for k in 0..200 {
        let from = [0; 3].map(|_| draw(-3.0, 3.0));
        let to = if k % 20 == 0 { [1.0; 3] } else { [0; 3].map(|_| draw(-1.0, 1.0)) };
        let length = draw(0.2, 3.0);
        let along =
            [0, 1, 2].map(
                |axis: usize| {
                    if k % 20 == 0 { to[axis] - from[axis] } else { (to[axis] - from[axis]) * length }
                },
            );
        let ends = match k % 4 {
            1 => [draw(0.0, 2.0), f64::INFINITY],
            2 => [0.0, draw(0.0, 2.0)],
            _ => [0.0, f64::INFINITY],
        };
        let numbers = from.into_iter().chain(along).chain(ends).map(|number| number.to_string());
        text += &(numbers.collect::<Vec<_>>().join(",") + "\n");
    }
    let rays = rays_from_bytes(text.as_bytes(), "rays".as_ref()).unwrap().rays;
    RayArray { shape: vec![10, 20], rays }
}

pub(super) fn source() -> CastSource {
    CastSource { mesh: "cube".into(), rays: "rays".into(), ..CastSource::default() }
}

/// The pack, and a folder with the answers to a question that may be another.
pub(super) struct Folders {
    pub(super) pack: tempfile::TempDir,
    pub(super) candidate: tempfile::TempDir,
}

impl Folders {
    pub(super) fn new(sides: Sides, answered: Sides, change: impl Fn(&mut CastRay)) -> Self {
        let folders = Self { pack: tempfile::tempdir().unwrap(), candidate: tempfile::tempdir().unwrap() };
        let (mesh, rays) = (cube(), rays());
        put_pack(folders.pack.path(), &(&mesh, &rays, sides), |pack| {
            let counts = write_ray_pack(pack, (&mesh, &rays, sides), &source(), &Silent).unwrap();
            assert_eq!(counts.untested(), [""; 0], "{counts:?}");
        });
        let mut changed = rays.clone();
        changed.rays.iter_mut().for_each(change);
        let answers = cast(&mesh, &changed.rays, answered, Questions::default(), &Silent);
        write_answers(folders.candidate.path(), &answers, (&mesh, &changed, answered), &source()).unwrap();
        folders
    }

    pub(super) fn right() -> Self {
        Self::new(Sides::Both, Sides::Both, |_| {})
    }

    /// Changes an array of the candidate, number by number; its index goes with it.
    pub(super) fn change(self, name: &str, by: impl Fn(usize, f64) -> f64) -> Self {
        let path = self.candidate.path().join(format!("{name}.npy"));
        let array = read_npy_numbers(&path, &Default::default()).unwrap();
        let values: Vec<f64> =
            array.values.iter().enumerate().map(|(index, &value)| by(index, value)).collect();
        write_npy_numbers(&path, &array.shape, &values).unwrap();
        self
    }

    /// Stores arrays of the candidate in single or half precision, each number moved by so many units in its last place.
    pub(super) fn store(self, is_half: bool, units: i16, names: &[&str]) -> Self {
        for name in names {
            let path = self.candidate.path().join(format!("{name}.npy"));
            let array = read_npy_numbers(&path, &Default::default()).unwrap();
            let single = |value: f64| {
                let bits = (value as f32).to_bits();
                if value.is_finite() && value != 0.0 { bits.wrapping_add_signed(units.into()) } else { bits }
            };
            let half = |value: f64| {
                let bits = half_bits(value);
                if value.is_finite() && value != 0.0 { bits.wrapping_add_signed(units) } else { bits }
            };
            let bytes: Vec<u8> = match is_half {
                true => array.values.iter().flat_map(|&value| half(value).to_le_bytes()).collect(),
                false => array.values.iter().flat_map(|&value| single(value).to_le_bytes()).collect(),
            };
            let file = npy_of(if is_half { "<f2" } else { "<f4" }, &array.shape, bytes);
            std::fs::write(&path, file).unwrap();
        }
        self
    }

    /// Lays the answers to the 200 rays otherwise: `from` gives the ray whose answer is in the place of another.
    pub(super) fn lay(self, from: impl Fn(usize) -> usize) -> Self {
        for name in [&VALUES[..], &["face", "side"]].concat() {
            let path = self.candidate.path().join(format!("{name}.npy"));
            let array = read_npy_numbers(&path, &Default::default()).unwrap();
            let parts = array.values.len() / 200;
            let values: Vec<f64> =
                (0..array.values.len()).map(|k| array.values[from(k / parts) * parts + k % parts]).collect();
            write_npy_numbers(&path, &array.shape, &values).unwrap();
        }
        self
    }

    /// Adds truth values to the candidate: which rays hit.
    pub(super) fn with_hits(self, hits: &[bool]) -> Self {
        let array = npy_of("|b1", &[10, 20], hits.iter().map(|hit| u8::from(*hit)).collect());
        std::fs::write(self.candidate.path().join("hit.npy"), array).unwrap();
        self
    }

    pub(super) fn without(self, names: &[&str]) -> Self {
        for name in names {
            std::fs::remove_file(self.candidate.path().join(format!("{name}.npy"))).unwrap();
        }
        self
    }

    pub(super) fn of(&self, name: &str) -> Vec<f64> {
        let path = self.pack.path().join(format!("{name}.npy"));
        read_npy_numbers(path, &Default::default()).unwrap().values
    }

    pub(super) fn check(&self) -> RayPackChecked {
        self.check_by(Precision::F64, CandidateConventions::default())
    }

    pub(super) fn check_by(
        &self,
        precision: Precision,
        conventions: CandidateConventions<'_>,
    ) -> RayPackChecked {
        check_ray_pack(self.pack.path(), self.candidate.path(), precision, conventions, &Silent).unwrap()
    }

    /// The candidate fails, and this explains it.
    #[track_caller]
    pub(super) fn expect_why(self, words: &[&str]) {
        let checked = self.check();
        assert!(!checked.passes());
        let why = checked.why.expect("an explanation");
        for words in words {
            assert!(why.contains(words), "{why}");
        }
    }
}

/// An NPY file of this type.
pub(super) fn npy_of(descr: &str, shape: &[u64], bytes: Vec<u8>) -> Vec<u8> {
    let shape: Vec<String> = shape.iter().map(u64::to_string).collect();
    let header =
        format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': ({}), }}\n", shape.join(", "));
    let mut file = b"\x93NUMPY\x01\x00".to_vec();
    file.extend((header.len() as u16).to_le_bytes());
    file.extend(header.as_bytes());
    file.extend(bytes);
    file
}

/// The number of half precision that is nearest, as its bits. (IEEE 754, 3.4)
fn half_bits(value: f64) -> u16 {
    let sign = if value.is_sign_negative() { 0x8000 } else { 0 };
    let size = value.abs();
    if size.is_nan() {
        return 0x7e00;
    }
    // Units of the last place are 2^-24 below the smallest normal number, 2^-14.
    let exponent = libm::ilogb(size).clamp(-14, 16);
    let units = libm::scalbn(size, 10 - exponent).round_ties_even();
    let bits = if size.is_infinite() { 31.0 * 1024.0 } else { units + f64::from(exponent + 14) * 1024.0 };
    sign | bits as u16
}

pub(super) const VALUES: [&str; 6] = ["t", "range", "point", "normal", "barycentric", "cos_incidence"];

/// What a single-precision program has of a number.
pub(super) fn single(_: usize, value: f64) -> f64 {
    if value == f64::from(u32::MAX) { -1.0 } else { f64::from(value as f32) }
}
