//! Asks a ray tracer of Rust the rays of a folder: `raypencil-peers-rust PEER FOLDER`, and `raypencil-peers-rust versions`.
//!
//! FOLDER has raw numbers, little-endian: `vertices` (f64, three each), `faces` (u32, three each), `rays` (f64, eight each: origin,
//! direction, t_min, t_max). The answers go there too: `t` (f64, infinite: no hit) and `face` (i32, -1: no hit). Printed are the
//! milliseconds that the rays took, without the trees.

use std::fmt::Display;
use std::path::Path;
use std::process::ExitCode;
use std::time::{Duration, Instant};
use std::{env, fs};

use bvh::aabb::{Aabb, Bounded};
use bvh::bounding_hierarchy::{BHShape, BHValue};
use bvh::bvh::Bvh;
use glam::Vec3A;
use nalgebra::{Point3, Vector3};
use obvhs::BvhBuildParams;
use obvhs::bvh2::builder::build_bvh2_from_tris;
use obvhs::cwbvh::builder::build_cwbvh_from_tris;
use obvhs::ray::{Ray, RayHit};
use obvhs::triangle::Triangle;

type Result<T> = std::result::Result<T, String>;

/// What is asked, in double precision; a peer of single precision rounds it, which changes nothing: it was rounded before.
struct Question {
    vertices: Vec<[f64; 3]>,
    faces: Vec<[u32; 3]>,
    rays: Vec<[f64; 8]>,
}

/// A first hit: its face and its t.
type First = Option<(u32, f64)>;

struct Answers {
    face: Vec<i32>,
    t: Vec<f64>,
    spent: Duration,
}

impl Question {
    fn read(folder: &Path) -> Result<Self> {
        let question = Self {
            vertices: rows(folder, "vertices", f64::from_le_bytes)?,
            faces: rows(folder, "faces", u32::from_le_bytes)?,
            rays: rows(folder, "rays", f64::from_le_bytes)?,
        };
        match question.faces.iter().flatten().find(|&&index| index as usize >= question.vertices.len()) {
            Some(index) => {
                Err(format!("faces: there is no vertex {index}; there are {}", question.vertices.len()))
            }
            None => Ok(question),
        }
    }

    fn corners(&self, face: [u32; 3]) -> [[f64; 3]; 3] {
        face.map(|index| self.vertices[index as usize])
    }

    /// Asks every ray: `first` has its origin, its direction and its end.
    fn answer(&self, mut first: impl FnMut([f64; 3], [f64; 3], f64) -> First) -> Answers {
        let count = self.rays.len();
        let (mut face, mut t) = (vec![-1; count], vec![f64::INFINITY; count]);
        let start = Instant::now();
        for (k, &[ox, oy, oz, dx, dy, dz, _, end]) in self.rays.iter().enumerate() {
            if let Some((number, at)) = first([ox, oy, oz], [dx, dy, dz], end) {
                face[k] = i32::try_from(number).expect("fewer than two thousand million faces");
                t[k] = at;
            }
        }
        Answers { face, t, spent: start.elapsed() }
    }
}

/// A file's rows of WIDE numbers of SIZE bytes each.
fn rows<const SIZE: usize, const WIDE: usize, T>(
    folder: &Path,
    name: &str,
    number: impl Fn([u8; SIZE]) -> T,
) -> Result<Vec<[T; WIDE]>> {
    let bytes = fs::read(folder.join(name)).map_err(in_words(name))?;
    let (numbers, rest) = bytes.as_chunks::<SIZE>();
    let (rows, more) = numbers.as_chunks::<WIDE>();
    if !rest.is_empty() || !more.is_empty() {
        return Err(format!(
            "{name}: {} bytes; expected rows of {WIDE} numbers of {SIZE} bytes",
            bytes.len()
        ));
    }
    Ok(rows.iter().map(|row| row.map(&number)).collect())
}

/// parry's mesh by its own tree and its own test, in one precision.
macro_rules! parry {
    ($name:ident, $crate_name:ident, $real:ty) => {
        fn $name(question: &Question) -> Result<Answers> {
            use $crate_name::math::Vector;
            use $crate_name::query::{Ray, RayCast};
            let vector = |[x, y, z]: [f64; 3]| Vector::new(x as $real, y as $real, z as $real);
            let vertices = question.vertices.iter().copied().map(vector).collect();
            let mesh = $crate_name::shape::TriMesh::new(vertices, question.faces.clone())
                .map_err(|error| error.to_string())?;
            Ok(question.answer(|origin, direction, end| {
                let ray = Ray::new(vector(origin), vector(direction));
                let end = (end as $real).min(<$real>::MAX);
                let hit = mesh.cast_local_ray_and_get_normal(&ray, end, false)?;
                Some((hit.subshape, f64::from(hit.time_of_impact)))
            }))
        }
    };
}

parry!(parry, parry3d, f32);
parry!(parry_f64, parry3d_f64, f64);

/// A face as the crate bvh wants its shapes.
struct Face<T: BHValue> {
    number: u32,
    corners: [Point3<T>; 3],
    node: usize,
}

impl<T: BHValue> Bounded<T, 3> for Face<T> {
    fn aabb(&self) -> Aabb<T, 3> {
        let [a, b, c] = self.corners;
        Aabb::empty().grow(&a).grow(&b).grow(&c)
    }
}

impl<T: BHValue> BHShape<T, 3> for Face<T> {
    fn set_bh_node_index(&mut self, index: usize) {
        self.node = index;
    }

    fn bh_node_index(&self) -> usize {
        self.node
    }
}

/// The crate bvh: its tree finds faces whose boxes a ray meets, and its test of triangles is asked for each. That test leaves out
/// backs, so it is asked for both windings.
macro_rules! bvh {
    ($name:ident, $real:ty) => {
        fn $name(question: &Question) -> Result<Answers> {
            let point = |p: [f64; 3]| Point3::from(p.map(|x| x as $real));
            let mut faces: Vec<Face<$real>> = (0..)
                .zip(&question.faces)
                .map(|(number, &face)| Face { number, corners: question.corners(face).map(point), node: 0 })
                .collect();
            let tree = Bvh::build(&mut faces);
            Ok(question.answer(|origin, direction, _| {
                let ray = bvh::ray::Ray::new(point(origin), Vector3::from(direction.map(|x| x as $real)));
                let mut nearest: Option<(u32, $real)> = None;
                for face in tree.traverse_iterator(&ray, &faces) {
                    let [a, b, c] = &face.corners;
                    let t = ray
                        .intersects_triangle(a, b, c)
                        .distance
                        .min(ray.intersects_triangle(a, c, b).distance);
                    if t < nearest.map_or(<$real>::INFINITY, |(_, t)| t) {
                        nearest = Some((face.number, t));
                    }
                }
                nearest.map(|(number, t)| (number, f64::from(t)))
            }))
        }
    };
}

bvh!(bvh_f32, f32);
bvh!(bvh_f64, f64);

/// obvhs as its examples ask it: a tree of two or of eight children, and `Triangle::intersect`.
macro_rules! obvhs {
    ($name:ident, $build:ident) => {
        fn $name(question: &Question) -> Result<Answers> {
            let vector = |point: [f64; 3]| Vec3A::from_array(point.map(|x| x as f32));
            let triangles: Vec<Triangle> = question
                .faces
                .iter()
                .map(|&face| {
                    let [v0, v1, v2] = question.corners(face).map(vector);
                    Triangle { v0, v1, v2 }
                })
                .collect();
            let tree = $build(&triangles, BvhBuildParams::medium_build(), &mut Duration::default());
            Ok(question.answer(|origin, direction, end| {
                // A part of -0 becomes 0: its tree of eight misses all boxes by the sign of the one and not of the other.
                let ray = Ray::new(vector(origin), vector(direction.map(|x| x + 0.0)), 0.0, end as f32);
                let mut hit = RayHit::none();
                let is_hit = tree.ray_traverse(ray, &mut hit, |ray, id| {
                    triangles[tree.primitive_indices[id] as usize].intersect(ray)
                });
                is_hit.then(|| (tree.primitive_indices[hit.primitive_id as usize], f64::from(hit.t)))
            }))
        }
    };
}

obvhs!(obvhs_bvh2, build_bvh2_from_tris);
obvhs!(obvhs_cwbvh, build_cwbvh_from_tris);

/// tinybvh, by the functions of `tinybvh.cpp`.
mod tinybvh {
    use std::ffi::c_void;

    use super::{Answers, Question, Result};

    unsafe extern "C" {
        fn tinybvh_single(corners: *const f64, count: usize) -> *const c_void;
        fn tinybvh_double(corners: *const f64, count: usize) -> *const c_void;
        fn tinybvh_single_first(made: *const c_void, o: *const f64, d: *const f64, t: *mut f64) -> i64;
        fn tinybvh_double_first(made: *const c_void, o: *const f64, d: *const f64, t: *mut f64) -> i64;
        fn tinybvh_version(version: *mut u32);
    }

    type Build = unsafe extern "C" fn(*const f64, usize) -> *const c_void;
    type First = unsafe extern "C" fn(*const c_void, *const f64, *const f64, *mut f64) -> i64;

    fn answers(question: &Question, build: Build, first: First) -> Answers {
        let corners: Vec<f64> =
            question.faces.iter().flat_map(|&face| question.corners(face)).flatten().collect();
        // SAFETY: there are nine numbers for each face; the tree keeps copies of them, and is never freed.
        let tree = unsafe { build(corners.as_ptr(), question.faces.len()) };
        question.answer(|origin, direction, _| {
            let mut t = 0.0;
            // SAFETY: the tree is of `build`, which goes with `first`; three numbers are read of each array.
            let face = unsafe { first(tree, origin.as_ptr(), direction.as_ptr(), &mut t) };
            u32::try_from(face).ok().map(|face| (face, t))
        })
    }

    pub fn single(question: &Question) -> Result<Answers> {
        Ok(answers(question, tinybvh_single, tinybvh_single_first))
    }

    pub fn double(question: &Question) -> Result<Answers> {
        Ok(answers(question, tinybvh_double, tinybvh_double_first))
    }

    pub fn version() -> String {
        let mut version = [0; 3];
        // SAFETY: three numbers are written.
        unsafe { tinybvh_version(version.as_mut_ptr()) };
        version.map(|part| part.to_string()).join(".")
    }
}

type Asker = fn(&Question) -> Result<Answers>;

/// The peers: their names, the crates (tinybvh has none), and how they are asked.
const PEERS: [(&str, &str, Asker); 8] = [
    ("parry", "parry3d", parry),
    ("parry-f64", "parry3d-f64", parry_f64),
    ("bvh", "bvh", bvh_f32),
    ("bvh-f64", "bvh", bvh_f64),
    ("obvhs", "obvhs", obvhs_bvh2),
    ("obvhs-cwbvh", "obvhs", obvhs_cwbvh),
    ("tinybvh", "", tinybvh::single),
    ("tinybvh-double", "", tinybvh::double),
];

/// The version of a crate that this program was built with.
fn version(name: &str) -> &'static str {
    let lock = include_str!("../Cargo.lock");
    let package =
        lock.split("[[package]]").find(|package| package.contains(&format!("\nname = \"{name}\"\n")));
    let line = package.and_then(|package| package.lines().find_map(|line| line.strip_prefix("version = \"")));
    line.map_or("unknown", |line| line.trim_end_matches('"'))
}

fn in_words<E: Display>(name: &str) -> impl Fn(E) -> String {
    move |error| format!("{name}: {error}")
}

fn run(words: &[String]) -> Result<()> {
    match words {
        [only] if only == "versions" => {
            for (name, package, _) in PEERS {
                let version =
                    if package.is_empty() { tinybvh::version() } else { version(package).to_owned() };
                println!("{name} {version}");
            }
            Ok(())
        }
        [name, folder] => {
            let Some((.., ask)) = PEERS.iter().find(|(known, ..)| known == name) else {
                return Err(format!(
                    "there is no peer `{name}`; expected one of {}",
                    PEERS.map(|(known, ..)| known).join(", ")
                ));
            };
            let folder = Path::new(folder);
            let answers = ask(&Question::read(folder)?)?;
            let face: Vec<u8> = answers.face.iter().flat_map(|face| face.to_le_bytes()).collect();
            let t: Vec<u8> = answers.t.iter().flat_map(|t| t.to_le_bytes()).collect();
            fs::write(folder.join("face"), face).map_err(in_words("face"))?;
            fs::write(folder.join("t"), t).map_err(in_words("t"))?;
            println!("{}", answers.spent.as_secs_f64() * 1000.0);
            Ok(())
        }
        _ => Err("usage: raypencil-peers-rust PEER FOLDER, or raypencil-peers-rust versions".to_owned()),
    }
}

fn main() -> ExitCode {
    match run(&env::args().skip(1).collect::<Vec<_>>()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("raypencil-peers-rust: {message}");
            ExitCode::from(2)
        }
    }
}
