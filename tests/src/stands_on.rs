//! What the tables and figures of the documents stand on: fingerprints of the rules that they show, and the stamps in the pages
//! that name them.
//!
//! A fingerprint is a digest of what small runs give, bit by bit, and not of source text: comments, names, tests and files
//! that are moved leave every table as it is; a changed number, limit or order of operations does not. A drive's has the map, the
//! points, the tests of every point of the radial grid and the truth, so that a limit which moves by a thousandth of itself
//! changes it long before a count of the table does.

mod drive;
mod stamp;

use std::fs;
use std::path::Path;
use std::sync::OnceLock;

use glam::DVec3;
use raypencil::terrain::{MarsGround, PRESET_NAMES, builtin, height_at};
use raypencil::{Mesh, Request};
use sha2::{Digest, Sha256};

pub use stamp::{Rule, Stamp, stamps, with_new_digests};

/// Letters of a digest in a stamp: 64 bits.
const LETTERS: usize = 16;

/// A digest on its way.
#[derive(Default)]
struct Fingerprint(Sha256);

impl Fingerprint {
    fn numbers(&mut self, numbers: impl IntoIterator<Item = f64>) {
        for number in numbers {
            self.0.update(number.to_bits().to_le_bytes());
        }
    }

    fn counts(&mut self, counts: impl IntoIterator<Item = u64>) {
        for count in counts {
            self.0.update(count.to_le_bytes());
        }
    }

    fn point(&mut self, point: DVec3) {
        self.numbers(point.to_array());
    }

    fn letters(self) -> String {
        let digits = self.0.finalize();
        digits.iter().map(|byte| format!("{byte:02x}")).collect::<String>()[..LETTERS].to_string()
    }
}

/// Fingerprint of a rule. It is computed once.
pub fn fingerprint(of: Rule) -> String {
    static DRIVE: OnceLock<String> = OnceLock::new();
    static GROUND: OnceLock<String> = OnceLock::new();
    static RENDERERS: OnceLock<String> = OnceLock::new();
    match of {
        Rule::Drive => DRIVE.get_or_init(drive::fingerprint),
        Rule::Ground => GROUND.get_or_init(ground),
        Rule::Renderers => RENDERERS.get_or_init(renderers),
    }
    .clone()
}

/// Each preset of generated ground, coarse and small.
fn ground() -> String {
    let mut digest = Fingerprint::default();
    for preset in PRESET_NAMES {
        let ground = MarsGround {
            extent: 12.0,
            post_spacing: 0.5,
            ..MarsGround::preset(preset, 4).expect("a preset")
        };
        let mesh: Mesh = ground.build().expect("a ground").into_mesh().expect("a mesh");
        digest.counts([mesh.faces().len() as u64]);
        digest.numbers(mesh.vertices().iter().flatten().map(|&number| f64::from(number)));
    }
    digest.letters()
}

/// All maps and all light of both renderers on the built-in grounds.
fn renderers() -> String {
    let mut digest = Fingerprint::default();
    for name in ["pyramids", "facets"] {
        let mesh = builtin(name, 0.25).expect("a built-in name").into_mesh().expect("a mesh");
        let mesh = std::sync::Arc::new(mesh);
        let height = height_at(&mesh, 0.0, 0.0).unwrap_or(0.0);
        let (camera, beams) = crate::rig::default_rig(16, DVec3::new(0.0, 0.0, height), 0.4);
        let scene = crate::scene(mesh, camera, beams);
        for renderer in crate::renderers() {
            digest.counts(crate::bits(&renderer.render(&scene, &Request::EVERYTHING)));
        }
    }
    digest.letters()
}

/// Digest of the bytes of files, in the order in which they are named.
///
/// # Errors
/// The name of a file that cannot be read.
pub fn digest_of_files(root: &Path, files: &[String]) -> Result<String, String> {
    let mut digest = Fingerprint::default();
    for file in files {
        let bytes = fs::read(root.join(file)).map_err(|error| format!("{file}: {error}"))?;
        digest.counts([bytes.len() as u64]);
        digest.0.update(&bytes);
    }
    Ok(digest.letters())
}
