//! How many rays of a scene decide each clause of the contract: on how many a renderer that breaks it is wrong.
//!
//! For each fault of a clause the naive renderer answers all rays with that fault and without any. A ray counts where the
//! two differ and the referee excuses the faulty answer neither as a tie nor as rounding in f64. The faults of a clause
//! have to be found each, so the clause counts the fewest.

use rayon::prelude::*;
use raypencil_judge::{Judge, JudgeShare};
use raypencil_naive::{Clause, Fault, Naive};
use raypencil_referee::Ruling;
use raypencil_scene::{
    FluxModel, Hit, HitQuantity, Place, Precision, Progress, RenderOutput, Renderer, Request, Returns, Scene,
    SensorId,
};

/// The fewest rays that must decide each clause of a blind pack.
pub const MIN_RAYS_PER_CLAUSE: u64 = 3;

/// Relative difference of two values that rounding does not explain. Tuned: bounds of f64 at grazing incidence stay far below,
/// and the faults change values by much more.
const MIN_DIFFERENCE: f64 = 1e-6;

/// The rays that decide a clause.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ClauseRays {
    /// The clause.
    pub clause: Clause,
    /// On how many rays a renderer that breaks it is wrong. Of several faults that break it, the fewest.
    pub rays: u64,
}

/// Most tests of a ray against a face for which clauses are counted unasked. Tuned: some 20 s on two cores.
const MAX_TESTS: f64 = 1e10;

/// Whether counting the rays of each clause takes less than a minute or so: the naive renderer tests each ray against
/// each face, once for each fault.
///
/// ```
/// use raypencil_pack::{blind_scene, can_count_clauses};
/// use raypencil_scene_io::{Overrides, load};
///
/// assert!(can_count_clauses(&blind_scene(7)?));
/// // A million rays.
/// assert!(!can_count_clauses(&load("pyramids", &Overrides::default())?.scene));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn can_count_clauses(scene: &Scene) -> bool {
    tests(scene) <= MAX_TESTS
}

/// The clauses that a pack with this model of light has to test.
pub(crate) fn needed_clauses(model: FluxModel) -> impl Iterator<Item = Clause> {
    Clause::ALL.iter().copied().filter(move |clause| clause.kind().is_in_packs_of(model))
}

/// Tests of a ray against a face that counting takes.
pub(crate) fn tests(scene: &Scene) -> f64 {
    let rays: f64 = scene
        .sensors()
        .filter_map(|sensor| scene.size(sensor))
        .map(|(columns, rows)| f64::from(columns) * f64::from(rows))
        .sum();
    let faults = Clause::ALL.iter().map(|clause| clause.faults().len()).sum::<usize>();
    rays * scene.mesh().faces().len() as f64 * faults as f64
}

/// Counts the rays that decide each clause which a pack of this scene has to test.
///
/// It takes time in proportion to rays times faces times faults: about 10 s for 10,000 rays of 4,000 faces on two cores.
pub fn clause_rays(scene: &Scene, progress: &dyn Progress) -> Vec<ClauseRays> {
    rays_of_clauses(scene, needed_clauses(scene.flux_model()), progress)
}

/// Counts the rays that decide each of some clauses.
pub(crate) fn rays_of_clauses(
    scene: &Scene,
    clauses: impl Iterator<Item = Clause>,
    progress: &dyn Progress,
) -> Vec<ClauseRays> {
    let judge = Judge::new(scene, JudgeShare::All);
    let honest = Naive { fault: None }.render(scene, &Request::EVERYTHING);
    let count = |clause: Clause| {
        progress.stage(&format!("clause {}", clause.key()));
        let of_fault = |fault: &Fault| {
            let faulty = Naive { fault: Some(*fault) }.render(scene, &Request::EVERYTHING);
            wrong_rays(&judge, &honest, &faulty)
        };
        let rays = clause.faults().iter().map(of_fault).min().unwrap_or(0);
        ClauseRays { clause, rays }
    };
    clauses.map(count).collect()
}

/// Number of rays on which `faulty` is wrong.
fn wrong_rays(judge: &Judge<'_>, honest: &RenderOutput, faulty: &RenderOutput) -> u64 {
    let scene = judge.scene();
    let has_wrong_sum = has_wrong_sum(honest, faulty);
    let of_sensor = |sensor: SensorId| -> u64 {
        let (width, height) = scene.size(sensor).expect("a sensor of this scene");
        let is_wrong = |i: u32, j: u32| {
            let place = Place { sensor, i, j };
            is_wrong_hit(judge, place, honest, faulty)
                || match sensor {
                    SensorId::Camera => has_wrong_sum && is_wrong_pixel(place, honest, faulty),
                    SensorId::Beam(beam) => is_wrong_return(judge, place, beam, honest, faulty),
                }
        };
        let row = |j: u32| (0..width).filter(|&i| is_wrong(i, j)).count() as u64;
        (0..height).into_par_iter().map(row).sum()
    };
    scene.sensors().map(of_sensor).sum()
}

/// Whether two numbers differ by more than rounding explains.
fn differ(a: f64, b: f64) -> bool {
    // NaN differs from everything.
    let is_near = (a - b).abs() <= MIN_DIFFERENCE * a.abs().max(b.abs());
    !is_near
}

/// Whether a value of a hit differs from that of another one.
fn values_differ(a: &Hit, b: &Hit) -> bool {
    HitQuantity::ALL.into_iter().any(|quantity| {
        let (a, b) = (a.value(quantity), b.value(quantity));
        let largest = b.components().iter().fold(0.0_f64, |largest, part| largest.max(part.abs()));
        let mut pairs = a.components().iter().zip(b.components());
        pairs.any(|(a, b)| {
            let is_near = (a - b).abs() <= MIN_DIFFERENCE * largest;
            !is_near
        })
    })
}

/// Whether the hit that `faulty` states is wrong.
fn is_wrong_hit(judge: &Judge<'_>, place: Place, honest: &RenderOutput, faulty: &RenderOutput) -> bool {
    let hit = |output: &RenderOutput| output.map(place.sensor).and_then(|map| map.hit(place.i, place.j));
    let (right, stated) = (hit(honest), hit(faulty));
    match (right, stated) {
        (None, None) => false,
        (Some(right), Some(stated)) if right.face == stated.face => values_differ(&stated, &right),
        _ => {
            let (face, range) = (stated.map(|hit| hit.face), stated.map(|hit| hit.range));
            if judge.rule(place, face, range, Precision::F64) == Ruling::Wrong {
                return true;
            }
            // Another face is excused; its values have to be its own.
            let own = face.and_then(|face| judge.plane_hit(place, face));
            stated.zip(own).is_some_and(|(stated, own)| values_differ(&stated, &own))
        }
    }
}

/// Whether what `faulty` states of a pencil's return is wrong.
fn is_wrong_return(
    judge: &Judge<'_>,
    place: Place,
    beam: usize,
    honest: &RenderOutput,
    faulty: &RenderOutput,
) -> bool {
    let Place { i, j, .. } = place;
    let [right, stated] = [honest, faulty].map(|output| {
        let returns = &output.returns[beam];
        let visible = returns.visible.as_ref().is_some_and(|image| image.at(i, j));
        let pixel = returns.pixel.as_ref().and_then(|image| image.at(i, j).get());
        let flux = returns.flux.as_ref().map_or(0.0, |image| image.at(i, j));
        (visible, pixel, flux)
    });
    let (visible, pixel, flux) = stated;
    if (visible, pixel) == (right.0, right.1) {
        return differ(flux, right.2);
    }
    let Some(hit) = faulty.beams[beam].hit(i, j) else { return false };
    let ruling = judge.rule_visibility(place, hit.face, Some(hit.range), visible, pixel, Precision::F64);
    ruling.is_none_or(|ruling| ruling.visible == Ruling::Wrong || ruling.pixel == Ruling::Wrong)
}

/// Whether all pencils deliver the same on both sides, so that a difference of pixels is one of their sums. Elsewhere the
/// pencils tell.
fn has_wrong_sum(honest: &RenderOutput, faulty: &RenderOutput) -> bool {
    let same = |(a, b): (&Returns, &Returns)| a.flux == b.flux && a.pixel == b.pixel;
    honest.returns.iter().zip(&faulty.returns).all(same)
}

/// Whether the flux of a pixel differs.
fn is_wrong_pixel(Place { i, j, .. }: Place, honest: &RenderOutput, faulty: &RenderOutput) -> bool {
    honest.flux.iter().zip(&faulty.flux).any(|(right, stated)| differ(stated.at(i, j), right.at(i, j)))
}

#[cfg(test)]
mod tests {
    use raypencil_scene_io::{Overrides, load};

    use super::*;

    #[test]
    fn a_count_takes_a_test_of_each_ray_against_each_face_for_each_fault() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../data/scenes/packs/hard.toml");
        let scene = load(file, &Overrides::default()).expect("a scene").scene;
        // Pixels, and pencils of two beams.
        let rays = 24 * 18 + 2 * 48 * 2;
        let faults: usize = Clause::ALL.iter().map(|clause| clause.faults().len()).sum();
        assert!(faults >= Clause::ALL.len());
        assert_eq!(tests(&scene), (rays * scene.mesh().faces().len() * faults) as f64);
        assert!(can_count_clauses(&scene));
    }

    #[test]
    fn a_wrong_sum_is_one_of_pencils_that_deliver_the_same() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../data/scenes/packs/hard.toml");
        let scene = load(file, &Overrides::default()).expect("a scene").scene;
        let honest = Naive { fault: None }.render(&scene, &Request::EVERYTHING);
        assert!(has_wrong_sum(&honest, &honest.clone()));
        let of = |change: &dyn Fn(&mut Returns)| {
            let mut other = honest.clone();
            change(&mut other.returns[1]);
            has_wrong_sum(&honest, &other)
        };
        assert!(!of(&|returns| returns.flux.as_mut().expect("fluxes").cells_mut()[0] += 1.0));
        assert!(!of(&|returns| returns.pixel = None));
    }
}
