//! MarsYard 2021, a real ground of half a million triangles. The mesh is not part of the project: the tests run where
//! the variable RAYPENCIL_EXTRA_DATA names the folder with `marsyard2021.glb`, and are skipped elsewhere.

use std::path::{Path, PathBuf};

use raypencil::harness::{Counts, Validation, contender, validate};
use raypencil::io::{Overrides, load};
use raypencil::judge::JudgeShare;
use raypencil::{FluxModel, Silent};

/// The path of the mesh. `None` if it is absent: then a message says that `test` is skipped.
fn marsyard(test: &str) -> Option<PathBuf> {
    let path =
        std::env::var_os("RAYPENCIL_EXTRA_DATA").map(|folder| Path::new(&folder).join("marsyard2021.glb"));
    let found = path.filter(|path| path.exists());
    if found.is_none() {
        eprintln!(
            "SKIPPED {test}: nothing was tested, because the environment variable RAYPENCIL_EXTRA_DATA names no folder \
             with marsyard2021.glb (the test is skipped, not passed)"
        );
    }
    found
}

fn validated(path: &Path, overrides: Overrides, names: &[&str]) -> Validation {
    let loaded = load(path.to_str().expect("a path in UTF-8"), &overrides).expect("the marsyard loads");
    let subject = loaded.into_subject("marsyard2021.glb".into());
    let contenders: Vec<_> = names.iter().map(|name| contender(name).expect("a renderer")).collect();
    validate(subject, &contenders, JudgeShare::Sample, &Silent)
}

#[test]
fn both_renderers_agree_on_the_marsyard() {
    let Some(path) = marsyard("both_renderers_agree_on_the_marsyard") else { return };
    let found = validated(&path, Overrides::default(), &["scanline", "tracer"]);
    let Counts { compared, agree, defects, undecided, judged, .. } = found.counts();
    assert_eq!((compared, defects, undecided), (1_081_344, 0, 0));
    assert!(agree > 1_081_300 && judged >= compared / 100 + (compared - agree), "{:?}", found.counts());
}

#[test]
fn both_renderers_agree_on_the_light_of_the_marsyard() {
    let Some(path) = marsyard("both_renderers_agree_on_the_light_of_the_marsyard") else { return };
    for flux_model in [FluxModel::Radiometric, FluxModel::Eq1] {
        for fan_deg in [60.0, 120.0] {
            let overrides =
                Overrides { flux_model: Some(flux_model), fan_deg: Some(fan_deg), ..Overrides::default() };
            let found = validated(&path, overrides, &["scanline", "tracer"]);
            let Counts { compared, defects, undecided, .. } = found.counts();
            assert_eq!(
                (compared, defects, undecided),
                (1_081_344, 0, 0),
                "{flux_model:?}, {fan_deg} degrees"
            );
        }
    }
}

#[test]
fn the_papers_errors_on_the_marsyard_have_causes() {
    let Some(path) = marsyard("the_papers_errors_on_the_marsyard_have_causes") else { return };
    let mut last = 0;
    for thickness_mm in [5.0, 20.0, 80.0] {
        let overrides = Overrides { thickness_mm: Some(thickness_mm), ..Overrides::default() };
        let found = validated(&path, overrides, &["scanline-paper", "tracer"]);
        let Counts { compared, agree, approximation, defects, undecided, judged, .. } = found.counts();
        assert_eq!((defects, undecided), (0, 0), "{thickness_mm} mm");
        assert!(judged >= compared / 100, "{judged} of {compared}, {agree} agree");
        // A thicker sheet has more approximated rays.
        assert!(approximation > last, "{thickness_mm} mm: {approximation} after {last}");
        last = approximation;
    }
}
