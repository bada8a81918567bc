//! The hard rays of `data/rays/hard`: the exact answers are those beside them, and the tracer's are theirs or excused.

use std::fs;
use std::path::{Path, PathBuf};

use raypencil::cast::{Answers, Questions, RayVerdict, Stated, cast, compare};
use raypencil::io::{Limits, load_triangles, read_npy_numbers, read_rays};
use raypencil::{CastRay, Precision, Sides, Silent, Triangles};
use serde_json::Value;

fn hard() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../data/rays/hard")
}

struct Family {
    name: String,
    folder: PathBuf,
    mesh: Triangles,
    rays: Vec<CastRay>,
}

fn families() -> Vec<Family> {
    let listed = fs::read(hard().join("families.json")).expect("families.json");
    let listed: Vec<Value> = serde_json::from_slice(&listed).expect("a list");
    let family = |entry: &Value| {
        let name = entry["name"].as_str().expect("a name").to_string();
        let folder = hard().join(&name);
        let mesh = load_triangles(&folder.join("mesh.obj")).expect("a mesh");
        let rays = read_rays(&folder.join("rays.npy")).expect("rays").rays;
        assert_eq!(entry["rays"], rays.len(), "{name}");
        Family { name, folder, mesh, rays }
    };
    listed.iter().map(family).collect()
}

impl Family {
    fn stored(&self, name: &str) -> Vec<f64> {
        let path = self.folder.join("answers").join(format!("{name}.npy"));
        read_npy_numbers(path, &Limits::default()).expect("an array").values
    }

    fn answers(&self, margins: bool) -> Answers {
        let questions = Questions { margins, ..Questions::default() };
        cast(&self.mesh, &self.rays, Sides::Both, questions, &Silent)
    }
}

#[test]
fn the_exact_answers_are_those_beside_the_rays() {
    let mut count = 0;
    for family in families() {
        let answers = family.answers(true);
        let name = &family.name;
        let faces = answers.values(|hit| f64::from(hit.face.0), f64::from(u32::MAX));
        assert_eq!(faces, family.stored("face"), "{name}");
        assert_eq!(answers.values(|hit| f64::from(hit.ties), 0.0), family.stored("ties"), "{name}");
        assert_eq!(answers.distances(|hit| hit.t), family.stored("t"), "{name}");
        let margins = answers.margins.as_ref().expect("margins");
        let face: Vec<f64> = margins.iter().flat_map(|both| [both.face.lo, both.face.hi]).collect();
        let surface: Vec<f64> = margins.iter().flat_map(|both| [both.surface.lo, both.surface.hi]).collect();
        assert_eq!(face, family.stored("margin.face"), "{name}");
        assert_eq!(surface, family.stored("margin.surface"), "{name}");
        count += answers.first.len();
    }
    assert!(count > 3000, "{count} rays");
}

#[test]
fn the_tracer_is_right_or_excused_by_one_displaced_ray() {
    let (mut rounding, mut of_families) = (0, 0);
    for family in families() {
        let stated = Stated::by_tracer(&family.mesh, &family.rays, Sides::Both);
        let compared = compare(&family.mesh, &family.rays, Sides::Both, &stated, Precision::F64, &Silent);
        let wrong: Vec<_> = compared.wrong().collect();
        assert!(wrong.is_empty() && compared.passes(), "{}: {wrong:?}", family.name);
        rounding += compared.counts().rounding;
        of_families += 1;
    }
    // Layers that are one step of f64 apart cannot be told apart in f64: a tracer without a rounded answer was not asked.
    assert!(of_families >= 18 && rounding > 20, "{of_families} families, {rounding} rounded answers");
}

#[test]
fn families_are_what_their_names_say() {
    for family in families() {
        let answers = family.answers(false);
        let (hits, ties) = answers.counts();
        let rays = family.rays.len();
        let all =
            |condition: &dyn Fn(&CastRay) -> bool| family.rays.iter().filter(|ray| condition(ray)).count();
        let is_so = match family.name.as_str() {
            // Closed meshes: no ray through an edge or a vertex may leak, and nearly all see it first.
            "edges" | "vertices" | "tiny" | "huge" | "far-mesh" | "far-origins" | "long-directions" => {
                hits == rays && ties * 10 > rays * 9
            }
            "just-before" => answers.hits().filter(|hit| hit.t < 1e-7).count() == rays,
            "one-ulp-beside" => hits == rays && ties * 10 < rays,
            "duplicates" | "crossing" | "folds" | "grazing" | "needles" => ties * 2 > rays,
            "in-plane" => {
                all(&|ray| ray.direction.z == 0.0 && ray.origin.z == 0.0) == rays && hits > 20 && hits < rays
            }
            "on-surface" => {
                let at_ends = answers.first.iter().zip(&family.rays);
                let at_ends = at_ends.filter(|(read, ray)| {
                    read.hit().is_some_and(|hit| hit.t == ray.t_min || hit.t == ray.t_max)
                });
                at_ends.count() * 2 > rays
            }
            "nearly-coincident" => hits == rays,
            "axis-aligned" => {
                all(&|ray| ray.direction.to_array().iter().filter(|&&part| part == 0.0).count() == 2) == rays
            }
            name => panic!("{name}: say what this family is"),
        };
        assert!(is_so, "{}: {rays} rays, {hits} hits, {ties} ties", family.name);
    }
}

/// A tracer with an epsilon at the start of its rays is found.
#[test]
fn a_tracer_with_an_epsilon_is_wrong_on_them() {
    let family = families().into_iter().find(|family| family.name == "just-before").expect("the family");
    let later: Vec<CastRay> = family.rays.iter().map(|ray| CastRay { t_min: 1e-6, ..*ray }).collect();
    let stated = Stated::by_tracer(&family.mesh, &later, Sides::Both);
    let compared = compare(&family.mesh, &family.rays, Sides::Both, &stated, Precision::F64, &Silent);
    let wrong = compared.verdicts.iter().filter(|verdict| matches!(verdict, RayVerdict::Wrong(_))).count();
    assert_eq!(wrong, family.rays.len());
}
