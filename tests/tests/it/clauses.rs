//! The clauses of the contract: a renderer that breaks one fails a pack, and the right ones pass.

use std::ops::Range;
use std::path::Path;

use rayon::prelude::*;
use raypencil::io::{Overrides, load};
use raypencil::judge::{Check, Class, GroundTruth, Recorded, check};
use raypencil::naive::{Clause, ClauseKind, Fault, Naive};
use raypencil::pack::{LoadingClause, MIN_RAYS_PER_CLAUSE, Manifest, blind_scene, clause_rays, with_bench};
use raypencil::{FluxModel, Renderer, Request, Scene, Silent};
use raypencil_tests::renderers;

/// Seeds of two blind scenes: one of each flux model.
const SEEDS: [u64; 2] = [1, 2];

/// Blind seeds to try with every wrong renderer in place of [`SEEDS`], as first and end: `RAYPENCIL_BLIND_SEEDS=0..50
/// cargo test --release -p raypencil-tests --test it clauses::blind -- --nocapture` takes half an hour on two cores.
const SEEDS_VARIABLE: &str = "RAYPENCIL_BLIND_SEEDS";

/// The seeds that [`SEEDS_VARIABLE`] asks for.
fn asked_seeds() -> Option<Range<u64>> {
    let text = std::env::var(SEEDS_VARIABLE).ok()?;
    let (first, end) = text.split_once("..").expect("two seeds with `..` between them, as 0..50");
    let seed = |text: &str| text.parse().expect("a seed");
    let seeds = seed(first)..seed(end);
    assert!(!seeds.is_empty(), "{SEEDS_VARIABLE}={text} names no seed");
    Some(seeds)
}

/// What a wrong renderer is asked for, until a defect is seen: the check of everything has the defects of each part.
const PARTS: [Request; 3] = [
    Request { beams: false, ..Request::MAPS },
    Request { camera: false, ..Request::MAPS },
    Request::EVERYTHING,
];

fn checked(truth: &GroundTruth<'_>, renderer: &dyn Renderer, request: &Request) -> Check {
    let scene = truth.scene();
    let output = renderer.render(scene, request);
    let recorded = Recorded::of_output(renderer.name(), scene, &output, renderer.precision());
    check(truth, &recorded, &Silent)
}

/// The faults of all clauses that a pack of the scene has to test.
fn faults_for(scene: &Scene) -> Vec<(Clause, Fault)> {
    let needed = Clause::ALL.iter().filter(|clause| clause.kind().is_in_packs_of(scene.flux_model()));
    needed.flat_map(|clause| clause.faults().iter().map(|fault| (*clause, *fault))).collect()
}

/// Those of the faults whose renderer has no defect.
fn faults_unseen(truth: &GroundTruth<'_>, faults: &[(Clause, Fault)]) -> Vec<(Clause, Fault)> {
    let has_defect = |fault: Fault, part: &Request| {
        checked(truth, &Naive { fault: Some(fault) }, part).of(Class::Defect) > 0
    };
    let is_unseen = |fault: Fault| !PARTS.iter().any(|part| has_defect(fault, part));
    faults.par_iter().filter(|(_, fault)| is_unseen(*fault)).copied().collect()
}

#[test]
fn each_blind_pack_passes_the_right_renderers_and_fails_each_wrong_one() {
    let mut models = Vec::new();
    let asked = asked_seeds();
    for seed in asked.clone().map_or(SEEDS.to_vec(), Iterator::collect) {
        let scene = blind_scene(seed).expect("a scene");
        models.push(scene.flux_model());
        let truth = GroundTruth::certified(&scene, &Silent);
        for renderer in renderers().into_iter().chain([Box::new(Naive { fault: None }) as Box<dyn Renderer>])
        {
            let check = checked(&truth, &*renderer, &Request::EVERYTHING);
            let first = check.sensors.iter().find_map(|sensor| sensor.defects.first());
            assert!(check.passes(), "seed {seed}, {}: {first:?}", renderer.name());
            assert!(check.sensors.iter().all(|sensor| sensor.not_compared == 0), "seed {seed}");
        }
        // The first scene has to fail every wrong renderer. Of the second, whose flux follows the other model, those of its
        // flux are tried.
        let is_tried = |clause: Clause| {
            asked.is_some() || seed == SEEDS[0] || matches!(clause.kind(), ClauseKind::Flux(_))
        };
        let mut tried = faults_for(&scene);
        tried.retain(|(clause, _)| is_tried(*clause));
        let passed = faults_unseen(&truth, &tried);
        assert!(passed.is_empty(), "seed {seed} passes these wrong renderers: {passed:?}");
        println!("seed {seed}, {:?}: {} wrong renderers fail", scene.flux_model(), tried.len());
    }
    assert!(models.contains(&FluxModel::Radiometric) && models.contains(&FluxModel::Eq1), "{models:?}");
}

#[test]
fn each_shipped_pack_fails_each_wrong_renderer() {
    let mut models = Vec::new();
    for pack in ["pyramids", "facets", "hard"] {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../data/packs").join(pack);
        let manifest = Manifest::read_verified(&folder).expect("a pack");
        let scene = folder.join("scene.toml");
        let scene = load(&scene.to_string_lossy(), &Overrides::default()).expect("the pack's scene").scene;
        models.push(scene.flux_model());
        let truth = GroundTruth::certified(&scene, &Silent);
        let passed = faults_unseen(&truth, &faults_for(&scene));
        assert!(passed.is_empty(), "{pack} passes these wrong renderers: {passed:?}");
        // `packs.rs` counts them again.
        assert!(!manifest.clauses.is_empty(), "{pack}");
        for one in &manifest.clauses {
            assert!(one.rays >= MIN_RAYS_PER_CLAUSE, "{pack}: {one:?}");
        }
    }
    assert!(models.contains(&FluxModel::Radiometric) && models.contains(&FluxModel::Eq1), "{models:?}");
}

#[test]
fn without_a_bench_wrong_renderers_pass_unseen() {
    // This is why packs have a bench: nothing here is met from behind, or lies before the grid plane.
    let scene = load("pyramids", &Overrides::default()).expect("a built-in scene").scene;
    let mut camera = *scene.camera();
    (camera.sensor.width, camera.sensor.height) = (32, 24);
    camera.sensor.pixel_pitch = camera.sensor.pixel_pitch.map(|pitch| 32.0 * pitch);
    camera.sensor.principal_point = [15.7, 12.4];
    let plain = Scene::new(scene.mesh().clone(), camera, Vec::new(), scene.atmosphere(), scene.flux_model());
    let plain = plain.expect("a camera alone");
    let rays = |scene: &Scene, clause: Clause| {
        clause_rays(scene, &Silent)
            .into_iter()
            .find(|one| one.clause == clause)
            .expect("a clause of hits")
            .rays
    };
    let benched = with_bench(&plain).expect("room for a bench");
    for clause in [Clause::FrontsOnly, Clause::NotBeforeThePlane, Clause::Edges] {
        assert_eq!(rays(&plain, clause), 0, "{clause:?}");
        assert!(rays(&benched, clause) >= MIN_RAYS_PER_CLAUSE, "{clause:?}");
    }
}

#[test]
fn the_rays_that_decide_a_clause_are_counted() {
    // The level bench has three rays that end exactly at the maximum range, three that meet a plate on the SPP, and
    // five that meet small plates: no ray elsewhere depends on these clauses. Beside a face by a millionth of its size and less pass three
    // rays of that bench, and twelve of the pencils that bite: three on each side.
    let counts = clause_rays(&blind_scene(SEEDS[0]).expect("a scene"), &Silent);
    let rays =
        |clause: Clause| counts.iter().find(|one| one.clause == clause).expect("a clause of hits").rays;
    assert_eq!(rays(Clause::MaximumRangeIncluded), 3);
    assert_eq!(rays(Clause::OnThePlane), 3);
    assert_eq!(rays(Clause::NothingBesideTheFace), 3 + 4 * 3);
    for one in &counts {
        assert!(one.rays >= MIN_RAYS_PER_CLAUSE, "{one:?}");
    }
}

#[test]
fn the_page_of_the_contract_has_every_clause() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/theory/contract.md");
    let page = std::fs::read_to_string(page).expect("the page");
    for clause in Clause::ALL {
        let row = format!("| `{}` | {} |", clause.key(), clause.sentence().replace('|', "\\|"));
        assert!(page.contains(&row), "docs/theory/contract.md lacks the row\n{row}");
    }
    let rows = page.lines().filter(|line| line.starts_with("| `")).count();
    // The clauses of loading are held by `loading.rs`.
    assert_eq!(rows, Clause::ALL.len() + LoadingClause::ALL.len(), "rows of docs/theory/contract.md");
}

#[test]
fn each_clause_has_a_key_of_its_own_and_faults_that_no_other_clause_has() {
    let mut keys: Vec<&str> = Clause::ALL.iter().map(|clause| clause.key()).collect();
    let mut faults: Vec<Fault> = Clause::ALL.iter().flat_map(|clause| clause.faults()).copied().collect();
    let counts = (keys.len(), faults.len());
    keys.sort_unstable();
    keys.dedup();
    faults.sort_unstable();
    faults.dedup();
    assert_eq!((keys.len(), faults.len()), counts);
    let of = |kind: ClauseKind| Clause::ALL.iter().filter(|clause| clause.kind() == kind).count();
    assert!(of(ClauseKind::Rays) >= 10 && of(ClauseKind::Hits) >= 18 && of(ClauseKind::Visibility) >= 10);
}
