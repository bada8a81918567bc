//! Reproducers of failing properties: the smallest scene that still fails, and the commit.

use std::path::{Path, PathBuf};
use std::process::Command;

use raypencil::harness::{
    Contender, Reproducer, first_interesting_ray, is_interesting_in_class, typed_contenders, write_reproducer,
};
use raypencil::io::scene_sha256;
use raypencil::judge::{Class, JudgeShare};
use raypencil::minimise::{MINIMISE_BUDGET, minimise};
use raypencil::{Scene, Silent};

/// The folder for reproducers: `reproducers` in the target folder of cargo.
pub fn folder() -> PathBuf {
    let target = std::env::var_os("CARGO_TARGET_DIR").map(PathBuf::from);
    target.unwrap_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../target")).join("reproducers")
}

/// The commit under test, or the version of the package where there is no git repository.
pub fn commit() -> String {
    let git = Command::new("git")
        .args(["rev-parse", "--short", "HEAD"])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output();
    match git {
        Ok(output) if output.status.success() => {
            format!("commit {}", String::from_utf8_lossy(&output.stdout).trim())
        }
        _ => format!("version {}", env!("CARGO_PKG_VERSION")),
    }
}

/// Minimises the first defect between two renderers on a scene, and writes the smallest scene to `folder`. Returns one
/// line: the path of the reproducer, or the reason why there is none.
pub fn reproduce(folder: &Path, property: &str, contenders: [&Contender; 2], scene: &Scene) -> String {
    let shows = is_interesting_in_class(contenders, Class::Defect);
    let minimised = first_interesting_ray(contenders, scene, Class::Defect, JudgeShare::Sample)
        .and_then(|first| minimise(scene, Some(first.place), &shows, MINIMISE_BUDGET, &Silent).ok());
    let Some(minimised) = minimised else {
        return "no reproducer: the two renderers show no defect on this scene".into();
    };
    // The name contains digests of scene and result, so that one failure does not overwrite another.
    let [of_scene, of_result] = [scene, &minimised.scene].map(|scene| scene_sha256(scene)[..8].to_string());
    let name = format!("{property}-{of_scene}-{of_result}");
    let [a, b] = contenders.map(|contender| contender.renderer.name());
    let what = format!("The property `{property}` fails at {}: {a} and {b} differ beyond doubt.", commit());
    let with = typed_contenders(&contenders);
    let reproducer = Reproducer { name: &name, what: &what, with: &with };
    match write_reproducer(folder, &minimised, reproducer) {
        Ok([scene, ..]) => {
            let (after, before) = (minimised.faces_after, minimised.faces_before);
            format!("reproducer: {}, {after} of {before} faces", scene.display())
        }
        Err(error) => format!("no reproducer: {error}"),
    }
}
