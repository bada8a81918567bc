//! Malformed and malicious files for every reader, each with the command that reads it and the words of the refusal.
//! `docs/evidence/malformed-inputs.md` lists them.
//!
//! The files are made here, byte by byte; none is committed. `crates/doors/cli/tests/it/malformed`, where the binary's path
//! is known, asserts what holds for every refusal: exit code 2, one short message that names the file, no other
//! output, no file written, little memory and time.
//!
//! * [`Case`]: one input. `bytes`: truncation, deflate streams.
//! * `glb`, `gltf`, `tiff`, `mesh`: terrain. `exr`, `npy`, `pfm`: maps. `scene`, `drive`: scene files. `rays`: sets of rays. `trajectory`: poses of a
//!   moving sensor. `cloud`: point clouds. `manifest`, `candidate`: packs and recordings.
//! * [`hostile`]: good files with every place changed, by rule.
//! * [`all`], [`tiffs`]: every case. [`good`]: well-formed files of the same formats. [`table`]: the page.
//!
//! ```
//! use raypencil_tests::malformed::all;
//!
//! // Each case has a name of its own.
//! let names: std::collections::BTreeSet<String> = all().into_iter().map(|case| case.name).collect();
//! assert_eq!(names.len(), all().len());
//! ```

pub mod bytes;
mod candidate;
mod case;
mod cloud;
mod drive;
mod exr;
mod glb;
mod gltf;
pub mod hostile;
mod manifest;
mod mesh;
mod npy;
mod pfm;
mod rays;
mod scene;
mod tiff;
mod trajectory;

pub use case::{Case, Item};
pub use tiff::tiffs;

/// Every case except the TIFFs.
pub fn all() -> Vec<Case> {
    [
        gltf::cases(),
        glb::cases(),
        mesh::cases(),
        exr::cases(),
        npy::cases(),
        pfm::cases(),
        scene::cases(),
        rays::cases(),
        trajectory::cases(),
        cloud::cases(),
        drive::cases(),
        manifest::cases(),
        candidate::cases(),
    ]
    .concat()
}

/// Well-formed files under the names of the malformed ones. The command must accept them under the same limits: so a
/// refusal is due to the malformed part. It may report differences.
pub fn good() -> Vec<Case> {
    let scene = "version = 1\n[camera]\nwidth_px = 16\nheight_px = 16\n[[beam]]\ncolumns = 16\nrows = 2\n\
                 [vehicle]\nposition_m = [-0.5, 0.5, 0]\n[terrain]\nfile = \"ground.glb\"\n";
    let diff = |name: &str, bytes: Vec<u8>| {
        let command = format!("diff map.{name} map.{name} -o out");
        Case::new(format!("good-{name}"), "a good file", &command, &[]).file(&format!("map.{name}"), bytes)
    };
    let ground = glb::good();
    vec![
        Case::new("good-glb", "a good file", "validate scene.toml -o out", &[])
            .file("scene.toml", scene)
            .file("ground.glb", ground),
        gltf::forty_buffers(),
        diff("exr", exr::good()),
        diff("npy", npy::good()),
        diff("pfm", pfm::good()),
        Case::new("good-pack", "a good pack, checked against itself", "check PACK PACK -o out", &[]),
        Case::new("good-note", "a good note", "check PACK mine -o out", &[])
            .item("mine", Item::Pack("facets"))
            .file("mine/candidate.json", candidate::good()),
    ]
}

/// The cases as the table of `docs/evidence/malformed-inputs.md`.
pub fn table() -> String {
    let mut text = String::from(
        "# Malformed inputs\n\n\
         The command refuses each of these inputs. `tests/src/malformed` makes them;\n\
         `crates/doors/cli/tests/it/malformed` runs the command on each of them in its own process, with at most 512 MB\n\
         of memory and 2 s of processor time. It asserts exit code 2, one short message with the words below,\n\
         nothing on standard output, and no file written. The readers have [fuzz targets](../../fuzz/README.md)\n\
         too. `just malformed-inputs` writes this page.\n\n\
         Inputs by rule are not listed: a good file in which one place after the other is cut, replaced, doubled or left\n\
         out. [hostile-inputs.md](hostile-inputs.md) has their number and what became of them, under the same limits.\n\n\
         | case | input | words of the message |\n| --- | --- | --- |\n",
    );
    for case in all().iter().chain(&tiffs()) {
        let words =
            case.words.iter().map(|word| format!("`{}`", word.replace('|', "\\|"))).collect::<Vec<_>>();
        text += &format!("| {} | {} | {} |\n", case.name, case.what, words.join(", "));
    }
    text
}
