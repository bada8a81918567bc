//! What a manifest says of its scene beside the answers: all of it follows from the scene.

use raypencil_files::Fault;
use raypencil_naive::Clause;
use raypencil_scene::{Precision, Progress, Scene, Silent};

use crate::bench::has_bench;
use crate::clauses::{can_count_clauses, clause_rays, needed_clauses, tests};
use crate::manifest::{Manifest, ManifestSharpness, PackKind};
use crate::sharpness::sharpness;
use crate::verification::Verification;

/// Most tests of a ray against a face for which clauses are counted again unasked. Tuned: a second or two.
const MAX_TESTS_UNASKED: f64 = 5e7;

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

/// Refuses sizes of tolerances that are not those which the scene's bench notices. They are measured if all of the pack is to be verified.
pub(crate) fn check_sharpness(
    manifest: &Manifest,
    scene: &Scene,
    share: Verification,
    progress: &dyn Progress,
) -> Result<(), Fault> {
    if manifest.sharpness.is_empty() || share != Verification::All {
        return Ok(());
    }
    progress.stage("measuring which tolerances are noticed");
    let of = |precision| match has_bench(scene) {
        true => sharpness(scene, precision, &Silent)
            .map_err(|error| Fault::new("sharpness", error.to_string(), "a bench")),
        false => Ok(Vec::new()),
    };
    let measured = of(Precision::F64)?.into_iter().zip(of(Precision::F32)?);
    let measured: Vec<ManifestSharpness> =
        measured.map(|(double, single)| ManifestSharpness::new(&double, &single)).collect();
    let words = |one: Option<&ManifestSharpness>| one.map_or("nothing".into(), |one| format!("{one:?}"));
    for at in 0..measured.len().max(manifest.sharpness.len()) {
        let (own, stated) = (measured.get(at), manifest.sharpness.get(at));
        if own != stated {
            return Err(Fault::new(format!("sharpness[{at}]"), words(stated), words(own)));
        }
    }
    Ok(())
}

/// Refuses counts of clauses that are not those of the scene. They are counted again where that takes some seconds, or if all of the
/// pack is to be verified.
pub(crate) fn check_clauses(
    manifest: &Manifest,
    scene: &Scene,
    share: Verification,
    progress: &dyn Progress,
) -> Result<(), Fault> {
    let most = if share == Verification::All { f64::INFINITY } else { MAX_TESTS_UNASKED };
    if manifest.kind == PackKind::Questions || !can_count_clauses(scene) || tests(scene) > most {
        return Ok(());
    }
    progress.stage("counting the rays of each clause again");
    let counted = clause_rays(scene, &Silent);
    let wrong = (0..counted.len().max(manifest.clauses.len())).find(|&at| {
        let (own, stated) = (counted.get(at), manifest.clauses.get(at));
        own.map(|own| (own.clause.key(), own.rays))
            != stated.map(|stated| (stated.clause.as_str(), stated.rays))
    });
    let Some(at) = wrong else { return Ok(()) };
    let words = |clause: &str, rays: u64| format!("{clause} decides {rays} rays");
    let stated = manifest.clauses.get(at).map_or("no count".into(), |one| words(&one.clause, one.rays));
    let expected = counted.get(at).map_or("none".into(), |one| words(one.clause.key(), one.rays));
    Err(Fault::new(format!("clauses[{at}]"), stated, expected))
}
