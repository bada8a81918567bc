//! Reports in a real browser: what people see is what the files hold, and everything that differs is found.
//!
//! A test says so where no browser is installed. `RAYPENCIL_NEEDS_BROWSER` makes that a failure.

mod accessibility;
mod browser;
mod candidates;
mod cast;
mod drives;
mod functions;
mod maps;
mod rays;
mod reach;

use std::path::PathBuf;

use raypencil::Silent;
use raypencil::harness::{Contender, Validation, contender, validate, write_validation};
use raypencil::io::{Overrides, Setting, Subject, load};
use raypencil::judge::JudgeShare;
use tempfile::TempDir;

/// A validation in a folder.
struct Written {
    folder: TempDir,
    validation: Validation,
}

impl Written {
    fn new(validation: Validation) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        write_validation(&validation, folder.path(), &Silent).expect("a report");
        Self { folder, validation }
    }

    fn page(&self) -> PathBuf {
        self.folder.path().join("report.html")
    }
}

/// A scene by its name, with these overrides.
fn subject(scene: &str, overrides: &Overrides) -> Subject {
    load(scene, overrides).expect("a scene").into_subject(scene.into())
}

fn contenders<const N: usize>(names: [&str; N]) -> [Contender; N] {
    names.map(|name| contender(name).expect("a renderer"))
}

/// The default scene with an image of a sixteenth of the pixels: a browser takes a second for what a million cells take ten.
fn small(overrides: Overrides) -> Overrides {
    let settings = ["camera.width_px=256", "camera.height_px=256", "camera.pixel_pitch_um=36"];
    let settings = settings.map(|text| Setting::parse(text).expect("a key with its value"));
    Overrides { settings: settings.into(), ..overrides }
}

/// The default scene by both renderers, which agree.
fn pyramids() -> Written {
    let subject = subject("pyramids", &small(Overrides::default()));
    Written::new(validate(subject, &contenders(["scanline", "tracer"]), JudgeShare::Sample, &Silent))
}

/// A sheet of 80 mm by the paper's algorithm: some hundred rays differ.
fn paper() -> Written {
    let overrides = Overrides { thickness_mm: Some(80.0), ..Overrides::default() };
    let subject = subject("pyramids", &small(overrides));
    let found = validate(subject, &contenders(["scanline-paper", "tracer"]), JudgeShare::Sample, &Silent);
    Written::new(found)
}
