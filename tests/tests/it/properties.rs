//! Properties of any rig on any ground, tested by proptest. `PROPTEST_CASES` sets the number of cases, and
//! `PROPTEST_RNG_SEED` their seed. The cases here are few: `raypencil campaign` and `just properties` try as many as one likes.

use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::fmt::Debug;
use std::hash::{BuildHasher, RandomState};
use std::sync::Arc;

use glam::DQuat;
use proptest::prelude::*;
use proptest::test_runner::{RngSeed, TestCaseError, TestCaseResult, TestError, TestRunner};
use raypencil::harness::Contender;
use raypencil::judge::{Class, Judge, JudgeShare, Side};
use raypencil::scanline::{Scanline, ScanlineOptions, Switches};
use raypencil::tracer::Tracer;
use raypencil::{Mesh, Mounted, RenderOutput, Renderer, Request, Scene};
use raypencil_tests::lattice::hash;
use raypencil_tests::random::{Case, cases, lit_cases, mars_cases};
use raypencil_tests::reproducers::{commit, folder, reproduce};
use raypencil_tests::{
    agreement, bits, first_difference, hit, light_bits, remeshed, renderers, scene, unindexed,
};

/// The seed in `.cargo/config.toml`.
const DEFAULT_SEED: u64 = 1990;

/// Runs `property` on `default_cases` cases, or on as many as `PROPTEST_CASES` says.
fn check<S: Strategy<Value: Debug>>(
    default_cases: u32,
    strategy: S,
    property: impl Fn(S::Value) -> TestCaseResult,
) {
    let _ = check_and_reproduce(default_cases, strategy, property, |_| {
        "no reproducer: no defect between two renderers".into()
    });
}

/// [`check`] with a reproducer. A failing case is printed with its seed, the commit, and the line that `reproduce`
/// returns. Returns whether these were the default cases: only for them the frequency of rare events is known.
fn check_and_reproduce<S: Strategy<Value: Debug>>(
    default_cases: u32,
    strategy: S,
    property: impl Fn(S::Value) -> TestCaseResult,
    reproduce: impl Fn(&S::Value) -> String,
) -> bool {
    let from_environment = std::env::var_os("PROPTEST_CASES").is_some();
    let default = ProptestConfig::default();
    let cases = if from_environment { default.cases } else { default_cases };
    let seed = match default.rng_seed {
        RngSeed::Fixed(seed) => seed,
        // The keys of a hash map come from the system's random numbers.
        RngSeed::Random => RandomState::new().hash_one("seed"),
    };
    let rng_seed = RngSeed::Fixed(seed);
    // proptest writes no file of failing cases.
    let config =
        ProptestConfig { cases, rng_seed, failure_persistence: None, max_shrink_iters: 400, ..default };
    if let Err(failure) = TestRunner::new(config).run(&strategy, property) {
        let left = match &failure {
            TestError::Fail(_, case) => reproduce(case),
            TestError::Abort(_) => "no case".into(),
        };
        panic!("{failure}\n{left}\nPROPTEST_RNG_SEED={seed} PROPTEST_CASES={cases}, {}", commit());
    }
    seed == DEFAULT_SEED && !from_environment
}

/// Writes the reproducer of a case on which both renderers do not agree.
fn reproduce_both(property: &'static str) -> impl Fn(&Case) -> String {
    move |case| {
        let [a, b] = [Contender::from(Scanline::default()), Contender::from(Tracer::new())];
        reproduce(&folder(), property, [&a, &b], &case.scene())
    }
}

fn render(renderer: &dyn Renderer, scene: &Scene) -> RenderOutput {
    renderer.render(scene, &Request::EVERYTHING)
}

fn side<'a>(renderer: &'a dyn Renderer, output: &'a RenderOutput) -> Side<'a> {
    Side { name: renderer.name(), output, precision: renderer.precision(), attributions: None }
}

/// Fails unless both outputs hold the same bits.
fn same_bits(what: &str, expected: &RenderOutput, found: &RenderOutput) -> TestCaseResult {
    match first_difference(expected, found) {
        None => Ok(()),
        Some(difference) => Err(TestCaseError::fail(format!("{what}: {difference}"))),
    }
}

/// The number of rays of an output, and the number of hits.
fn count_hits(output: &RenderOutput) -> [u64; 2] {
    let mut counts = [0, 0];
    for map in output.maps() {
        let ranges = map.range.as_ref().expect("every quantity was asked for").cells();
        counts[0] += ranges.len() as u64;
        counts[1] += ranges.iter().filter(|range| range.get().is_some()).count() as u64;
    }
    counts
}

/// Asserts that both renderers agree on every ray of `count` cases.
fn both_agree(count: u32, cases: impl Strategy<Value = Case>, name: &'static str) {
    let (rays, hits) = (Cell::new(0), Cell::new(0));
    let property = |case: Case| {
        let scene = case.scene();
        let (scanline, tracer) = (Scanline::default(), Tracer::new());
        let (a, b) = (render(&scanline, &scene), render(&tracer, &scene));
        let [of_case, hits_of_case] = count_hits(&a);
        rays.set(rays.get() + of_case);
        hits.set(hits.get() + hits_of_case);
        agreement(&scene, side(&scanline, &a), side(&tracer, &b)).map(drop).map_err(TestCaseError::fail)
    };
    let is_default = check_and_reproduce(count, cases, property, reproduce_both(name));
    // Enough rays must hit the ground.
    assert!(!is_default || 5 * hits.get() >= rays.get(), "{} of {} rays hit", hits.get(), rays.get());
}

#[test]
fn both_renderers_agree_on_every_ray() {
    both_agree(1000, cases(), "both-renderers-agree");
}

#[test]
fn both_renderers_agree_on_mars_like_ground() {
    both_agree(500, mars_cases(), "both-renderers-agree-on-mars");
}

#[test]
fn every_error_of_the_paper_has_a_confirmed_cause() {
    let approximated = RefCell::new(BTreeMap::new());
    // In half of the cases the camera sees the stripes.
    let cases = prop_oneof![cases().boxed(), lit_cases().boxed()];
    // Three sets of switches: the paper's own, a set of one or two, and any set.
    let all: Vec<Switches> = Switches::subsets().collect();
    let sets = |few: usize, any: usize| [Switches::PAPER, all[[0, 1, 2, 3, 4, 8, 16, 28][few]], all[any]];
    let property = |(case, few, any): (Case, usize, usize)| {
        let scene = case.scene();
        let tracer = Tracer::new();
        let b = render(&tracer, &scene);
        let judge = Judge::new(&scene, JudgeShare::Sample);
        for switches in sets(few, any) {
            let scanline = Scanline::new(ScanlineOptions { switches, ..ScanlineOptions::EXACT });
            let a = render(&scanline, &scene);
            let attributions = raypencil::harness::attribute(&judge, &a, switches, scanline.precision());
            let a = Side { attributions: Some(&attributions), ..side(&scanline, &a) };
            let sensors = agreement(&scene, a, side(&tracer, &b))
                .map_err(|error| TestCaseError::fail(format!("{}: {error}", scanline.name())))?;
            for sensor in &sensors {
                let causes = &sensor.approximations;
                let rays: u64 = causes.values().map(|tally| tally.rays).sum();
                prop_assert_eq!(rays, sensor.of(Class::Approximation));
                for (cause, tally) in causes {
                    prop_assert!(switches.contains(*cause), "{} for {}", cause, switches);
                    *approximated.borrow_mut().entry(*cause).or_insert(0) += tally.rays;
                }
            }
        }
        Ok(())
    };
    let reproduced = |(case, few, any): &(Case, usize, usize)| {
        let with_switches = |switches| {
            let contenders = [Contender::scanline(switches), Contender::from(Tracer::new())];
            reproduce(&folder(), "errors-have-causes", contenders.each_ref(), &case.scene())
        };
        sets(*few, *any).map(with_switches).join("\n")
    };
    let is_default = check_and_reproduce(500, (cases, 0..8_usize, 0..32_usize), property, reproduced);
    // Sheets are up to a metre thick and ranges start at 30 cm: the approximations err often.
    let approximated = approximated.into_inner();
    let of = |switches: Switches| approximated.get(&switches).copied().unwrap_or(0);
    let sets: Vec<Switches> = Switches::subsets().collect();
    for (set, min_rays) in [(1, 1500), (2, 1500), (3, 15), (4, 30), (8, 3), (16, 150)] {
        assert!(!is_default || of(sets[set]) > min_rays, "{}: {approximated:?}", sets[set]);
    }
}

#[test]
fn both_renderers_agree_on_what_the_camera_sees() {
    let (pencils, seen) = (Cell::new(0), Cell::new(0));
    let property = |case: Case| {
        let scene = case.scene();
        let (scanline, tracer) = (Scanline::default(), Tracer::new());
        let (a, b) = (render(&scanline, &scene), render(&tracer, &scene));
        for returns in &a.returns {
            let visible = returns.visible.as_ref().expect("returns were asked for").cells();
            pencils.set(pencils.get() + visible.len() as u64);
            seen.set(seen.get() + visible.iter().filter(|visible| **visible).count() as u64);
        }
        agreement(&scene, side(&scanline, &a), side(&tracer, &b)).map(drop).map_err(TestCaseError::fail)
    };
    let is_default =
        check_and_reproduce(600, lit_cases(), property, reproduce_both("both-renderers-see-alike"));
    assert!(
        !is_default || 20 * seen.get() > pencils.get(),
        "{} of {} pencils are seen",
        seen.get(),
        pencils.get()
    );
}

#[test]
fn skipping_faces_never_changes_a_map() {
    check(500, cases(), |case: Case| {
        let scene = case.scene();
        let skipping = render(&Scanline::default(), &scene);
        let testing_all = render(
            &Scanline::new(ScanlineOptions { skip_unseen: false, ..ScanlineOptions::default() }),
            &scene,
        );
        same_bits("skipping", &testing_all, &skipping)
    });
}

/// The mesh with its faces in another order: face k of the result is `order[k]` of the original.
fn shuffled(original: &Mesh, seed: u64) -> (Arc<Mesh>, Vec<u32>) {
    let mut order: Vec<u32> = (0..original.faces().len() as u32).collect();
    order.sort_by_key(|&face| hash(seed, u64::from(face)));
    let faces = order.iter().map(|&face| original.faces()[face as usize]).collect();
    (remeshed(original, original.vertices().to_vec(), faces), order)
}

#[test]
fn the_order_of_faces_does_not_matter() {
    check(300, (cases(), any::<u64>()), |(case, seed): (Case, u64)| {
        let mesh = case.mesh();
        let (shuffled, order) = shuffled(&mesh, seed);
        let (scene, other) = (case.scene_of(&mesh, &mesh), case.scene_of(&shuffled, &mesh));
        for renderer in renderers() {
            let (expected, found) = (render(&*renderer, &scene), render(&*renderer, &other));
            for (of_expected, of_found) in expected.maps().zip(found.maps()) {
                for j in 0..of_expected.height {
                    for i in 0..of_expected.width {
                        let what = format!("{} {} {i},{j}", renderer.name(), of_expected.sensor);
                        let (expected, found) = (hit(of_expected, i, j), hit(of_found, i, j));
                        let (Some(expected), Some(found)) = (expected, found) else {
                            prop_assert!(expected.is_none() && found.is_none(), "{what}");
                            continue;
                        };
                        let face = order[found.face.0 as usize];
                        prop_assert_eq!(expected.range.to_bits(), found.range.to_bits(), "{}", what);
                        if face == expected.face.0 {
                            prop_assert_eq!(expected.normal, found.normal, "{}", what);
                            prop_assert_eq!(expected.point, found.point, "{}", what);
                        } else {
                            // Two faces at the same range: the one that is first in the order of the mesh is reported.
                            prop_assert!(
                                expected.face.0 < face,
                                "{what}: face {face} before {:?}",
                                expected.face
                            );
                            let place = order.iter().position(|&at| at == expected.face.0);
                            prop_assert!(found.face.0 < place.unwrap() as u32, "{what}: not the first");
                        }
                    }
                }
            }
        }
        Ok(())
    });
}

/// The mesh with every vertex doubled, and half of the faces on the copies, as exporters split a mesh where normals
/// differ.
fn split(original: &Mesh, seed: u64) -> Arc<Mesh> {
    let count = original.vertices().len() as u32;
    let vertices = [original.vertices(), original.vertices()].concat();
    let copy = |face: usize| count * (hash(seed, face as u64) % 2) as u32;
    let faces = original.faces().iter().enumerate().map(|(index, face)| face.map(|v| v + copy(index)));
    remeshed(original, vertices, faces.collect())
}

#[test]
fn sharing_vertices_or_not_does_not_matter() {
    check(300, (cases(), any::<u64>()), |(case, seed): (Case, u64)| {
        let mesh = case.mesh();
        let scene = case.scene_of(&mesh, &mesh);
        for renderer in renderers() {
            let expected = render(&*renderer, &scene);
            for (how, other) in [("unindexed", unindexed(&mesh)), ("split", split(&mesh, seed))] {
                let found = render(&*renderer, &case.scene_of(&other, &mesh));
                same_bits(&format!("{}, {how}", renderer.name()), &expected, &found)?;
            }
        }
        Ok(())
    });
}

#[test]
fn the_length_of_a_quaternion_does_not_matter() {
    check(300, (cases(), -1.5..1.5), |(case, exponent): (Case, f64)| {
        let one = case.scene();
        let factor = libm::pow(10.0, exponent);
        fn scaled<S: Copy>(mounted: &Mounted<S>, factor: f64) -> Mounted<S> {
            let mut mounted = *mounted;
            let q = mounted.scene_from_sensor.rotation.to_array().map(|entry| factor * entry);
            mounted.scene_from_sensor.rotation = DQuat::from_array(q);
            mounted
        }
        let beams = one.beams().iter().map(|beam| scaled(beam, factor)).collect();
        let other = scene(Arc::clone(one.mesh()), scaled(one.camera(), factor), beams);
        for renderer in renderers() {
            let (a, b) = (render(&*renderer, &one), render(&*renderer, &other));
            agreement(&one, side(&*renderer, &a), side(&*renderer, &b)).map_err(TestCaseError::fail)?;
        }
        Ok(())
    });
}

#[test]
fn rendering_again_gives_the_same_bits() {
    // A renderer caches tables and trees between renders: it must not use those of another scene.
    check(400, (lit_cases(), lit_cases()), |(first, second): (Case, Case)| {
        let scenes = [first.scene(), second.scene()];
        for (reused, fresh) in renderers().into_iter().zip(renderers()) {
            render(&*reused, &scenes[1]);
            let (again, anew) = (render(&*reused, &scenes[0]), render(&*fresh, &scenes[0]));
            prop_assert!(bits(&again) == bits(&anew), "{}", reused.name());
            prop_assert!(light_bits(&again) == light_bits(&anew), "light of {}", reused.name());
        }
        Ok(())
    });
}
