//! What a manifest says of its scene beside the answers: all of it follows from the scene.

use std::collections::BTreeSet;

use raypencil_files::Fault;
use raypencil_naive::{Clause, Slack};
use raypencil_scene::{Precision, Progress, Scene, Silent};

use crate::bench::has_bench;
use crate::clauses::{can_count_clauses, needed_clauses, rays_of_clauses, tests};
use crate::manifest::{Manifest, PackKind};
use crate::sharpness::first_false;
use crate::verification::{Verification, drawn};

/// Most tests of a ray against a face by which clauses are counted again unasked. Tuned: a second or less on two cores.
const MAX_TESTS_UNASKED: f64 = 1.5e8;

/// Sizes of tolerances that are measured again unasked. Tuned: half a second on two cores.
const SIZES_UNASKED: u64 = 6;

/// Refuses what a manifest says of its scene if that is not so. Names of sensors were compared when it was read.
pub(crate) fn check_facts(manifest: &Manifest, scene: &Scene) -> Result<(), Fault> {
    if manifest.flux_model != scene.flux_model() {
        let [found, expected] = [manifest.flux_model, scene.flux_model()].map(|model| format!("{model:?}"));
        return Err(Fault::new("fluxModel", found, format!("{expected}, as the scene has")));
    }
    let sizes: Vec<(u32, u32)> = scene.sensors().filter_map(|sensor| scene.size(sensor)).collect();
    let stated: Vec<(u32, u32)> = manifest.sensors.iter().map(|one| (one.columns, one.rows)).collect();
    if stated != sizes {
        return Err(Fault::new(
            "sensors",
            format!("{stated:?}"),
            format!("columns and rows {sizes:?}, as the scene has"),
        ));
    }
    // Which clauses there are follows from the scene; how often, from counting.
    let needed: Vec<&str> = needed_clauses(scene.flux_model()).map(Clause::key).collect();
    let stated: Vec<&str> = manifest.clauses.iter().map(|one| one.clause.as_str()).collect();
    if !stated.is_empty() && stated != needed {
        return Err(Fault::new("clauses", stated.join(", "), needed.join(", ")));
    }
    Ok(())
}

/// How many of some statements of a manifest were found to be so.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Found {
    /// Statements that are so.
    pub found: u64,
    /// Statements in all.
    pub of: u64,
}

impl Found {
    /// So many of all, and which ones: drawn by the seed, unless all are.
    fn drawn(most: u64, of: u64, seed: u64) -> (Self, BTreeSet<u64>) {
        let found = most.min(of);
        (Self { found, of }, drawn(found, of, seed))
    }

    /// Whether some were left out.
    pub fn is_partial(self) -> bool {
        self.found < self.of
    }
}

/// Refuses counts of clauses and sizes of tolerances that are not those of the scene, and says how many were found again. All are, if
/// all of the pack is to be verified or if it takes a second; else as many as take a second, drawn by the seed.
pub(crate) fn check_numbers(
    manifest: &Manifest,
    scene: &Scene,
    (share, seed): (Verification, u64),
    progress: &dyn Progress,
) -> Result<[Found; 2], Fault> {
    if manifest.kind == PackKind::Questions {
        let stated = [("clauses", manifest.clauses.len()), ("sharpness", manifest.sharpness.len())];
        return match stated.into_iter().find(|(_, count)| *count > 0) {
            Some((key, count)) => Err(Fault::new(key, count.to_string(), "none: nobody counted them")),
            None => Ok([Found::default(); 2]),
        };
    }
    let (clauses, sizes) = match share {
        Verification::All => (u64::MAX, u64::MAX),
        Verification::Drawn { .. } => {
            let share = MAX_TESTS_UNASKED / tests(scene);
            ((share * manifest.clauses.len() as f64) as u64, SIZES_UNASKED)
        }
    };
    progress.stage("counting the rays of clauses again");
    let clauses = check_clauses(manifest, scene, (clauses, seed))?;
    progress.stage("measuring again which tolerances are noticed");
    Ok([clauses, check_sharpness(manifest, scene, (sizes, seed))?])
}

/// Refuses sizes of tolerances that are not those which the scene's bench notices.
fn check_sharpness(manifest: &Manifest, scene: &Scene, (most, seed): (u64, u64)) -> Result<Found, Fault> {
    let stated = &manifest.sharpness;
    if stated.is_empty() {
        return Ok(Found::default());
    }
    if !has_bench(scene) {
        return Err(Fault::new("sharpness", format!("{} sizes", stated.len()), "none: there is no bench"));
    }
    let words = |slack: &str, unit: &str| format!("{slack}, {unit}");
    for at in 0..stated.len().max(Slack::ALL.len()) {
        let found = stated.get(at).map_or("nothing".into(), |one| words(&one.slack, &one.unit));
        let own = Slack::ALL.get(at).map(|slack| words(slack.key(), slack.unit().words()));
        let own = own.unwrap_or("nothing".into());
        if found != own {
            return Err(Fault::new(format!("sharpness[{at}]"), found, own));
        }
    }
    let (count, chosen) = Found::drawn(most, stated.len() as u64, seed);
    let chosen = chosen.into_iter().map(|at| at as usize);
    let chosen = chosen.flat_map(|at| [(at, Precision::F64), (at, Precision::F32)]);
    let chosen: Vec<(usize, Precision)> = chosen.collect();
    let size = |&(at, precision): &(usize, Precision)| match precision {
        Precision::F32 => stated[at].f32,
        _ => stated[at].f64,
    };
    let sizes: Vec<_> = chosen.iter().map(|one| (Slack::ALL[one.0], one.1, size(one))).collect();
    let wrong = first_false(scene, &sizes)
        .map_err(|error| Fault::new("sharpness", error.to_string(), "a bench of its own"))?;
    let Some((at, precision)) = wrong.map(|wrong| chosen[wrong]) else { return Ok(count) };
    let found =
        size(&(at, precision)).map_or("no size is noticed".into(), |size| format!("{size:e} is noticed"));
    Err(Fault::new(
        format!("sharpness[{at}]"),
        format!(
            "{}: of {}, {found}",
            stated[at].slack,
            if precision == Precision::F32 { "f32" } else { "f64" }
        ),
        "the smallest size of 1, 2 or 5 times a power of ten that the bench notices",
    ))
}

/// Refuses counts of clauses that are not those of the scene.
fn check_clauses(manifest: &Manifest, scene: &Scene, (most, seed): (u64, u64)) -> Result<Found, Fault> {
    let stated = &manifest.clauses;
    let needed: Vec<Clause> = needed_clauses(scene.flux_model()).collect();
    // Which clauses there are was compared before.
    if stated.is_empty() {
        return match can_count_clauses(scene) {
            true => Err(Fault::new("clauses[0]", "no count", "how many rays decide each clause")),
            false => Ok(Found::default()),
        };
    }
    let (count, chosen) = Found::drawn(most, needed.len() as u64, seed);
    let of_chosen = chosen.iter().map(|at| needed[*at as usize]);
    let counted = if chosen.is_empty() { Vec::new() } else { rays_of_clauses(scene, of_chosen, &Silent) };
    let mut pairs = chosen.into_iter().map(|at| at as usize).zip(counted);
    let Some((at, own)) = pairs.find(|(at, own)| own.rays != stated[*at].rays) else { return Ok(count) };
    let words = |rays: u64| format!("{} decides {rays} rays", own.clause.key());
    Err(Fault::new(format!("clauses[{at}]"), words(stated[at].rays), words(own.rays)))
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    fn published(name: &str) -> (Manifest, Scene) {
        let pack = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../data/packs").join(name);
        let manifest = Manifest::read(&pack).expect("a manifest");
        let scene = manifest.load_scene(&pack).expect("a scene").scene;
        (manifest, scene)
    }

    #[test]
    fn a_count_that_is_drawn_and_false_is_refused() {
        let (manifest, scene) = published("hard");
        let check = |manifest: &Manifest| check_clauses(manifest, &scene, (2, 5));
        assert_eq!(check(&manifest), Ok(Found { found: 2, of: 51 }));
        let forged = |at: usize| {
            let mut forged = manifest.clone();
            forged.clauses[at].rays += 1;
            check(&forged)
        };
        let chosen = drawn(2, 51, 5);
        assert_eq!(chosen.len(), 2);
        for at in chosen.iter().map(|at| *at as usize) {
            let fault = forged(at).expect_err("a false count").to_string();
            assert!(fault.starts_with(&format!("clauses[{at}]")), "{fault}");
        }
        // What was not drawn is not known; the verdict's line says how many were.
        let other = (0..51).find(|at| !chosen.contains(at)).expect("another") as usize;
        assert!(forged(other).expect("not drawn").is_partial());
    }

    #[test]
    fn a_size_that_is_drawn_and_false_is_refused() {
        let (manifest, scene) = published("hard");
        let at = drawn(1, Slack::ALL.len() as u64, 3).into_iter().next().expect("a number") as usize;
        let check = |change: &dyn Fn(&mut Manifest)| {
            let mut forged = manifest.clone();
            change(&mut forged);
            check_sharpness(&forged, &scene, (1, 3))
        };
        assert_eq!(check(&|_| ()), Ok(Found { found: 1, of: Slack::ALL.len() as u64 }));
        let sharper = |size: &mut Option<f64>| *size = size.map(|size| size / 1000.0);
        let place = format!("sharpness[{at}]");
        for (change, at) in [
            (
                &(|of: &mut Manifest| sharper(&mut of.sharpness[at].f64)) as &dyn Fn(&mut Manifest),
                place.as_str(),
            ),
            (&|of| sharper(&mut of.sharpness[at].f32), &place),
            (&|of| of.sharpness[at].f64 = None, &place),
            (&|of| of.sharpness[at].f64 = Some(0.3), &place),
            // Labels and names, drawn or not.
            (&|of| of.sharpness[0].unit = "m".into(), "sharpness[0]"),
            (&|of| of.sharpness[1].slack = "all".into(), "sharpness[1]"),
            (&|of| _ = of.sharpness.pop(), "sharpness["),
        ] {
            let fault = check(change).expect_err("a false size").to_string();
            assert!(fault.starts_with(at), "{fault}");
        }
    }

    #[test]
    fn a_pack_without_answers_counts_nothing() {
        let (mut manifest, scene) = published("hard");
        manifest.kind = PackKind::Questions;
        let check = |manifest: &Manifest| {
            let share = (Verification::Drawn { seed: None }, 1);
            check_numbers(manifest, &scene, share, &Silent).map_err(|fault| fault.to_string())
        };
        assert!(check(&manifest).is_err_and(|fault| fault.starts_with("clauses: 51")));
        manifest.clauses.clear();
        assert!(check(&manifest).is_err_and(|fault| fault.starts_with("sharpness: 37")));
        manifest.sharpness.clear();
        assert_eq!(check(&manifest), Ok([Found::default(); 2]));
    }
}
