//! Files that somebody made to hurt: each with the command that meets it and the words of the refusal. `docs/evidence/malformed-inputs.md`
//! lists them.
//!
//! They are made here, byte by byte, and none is committed. What is true of every refusal (exit code 2, one short message
//! that names the file, nothing else printed, no file written, little memory and time) is asserted in
//! `crates/cli/tests/hostile.rs`, where the binary's path is known.

pub mod bytes;
mod candidate;
mod case;
mod drive;
mod exr;
mod glb;
mod gltf;
mod manifest;
mod npy;
mod pfm;
mod scene;
mod tiff;

pub use case::{Case, Item};
pub use tiff::tiffs;

/// Every case but the TIFFs.
pub fn all() -> Vec<Case> {
    [
        gltf::cases(),
        glb::cases(),
        exr::cases(),
        npy::cases(),
        pfm::cases(),
        scene::cases(),
        drive::cases(),
        manifest::cases(),
        candidate::cases(),
    ]
    .concat()
}

/// Good files, under the names of the hostile ones: what is refused is refused for what is wrong with it, and the limits
/// are no narrower than good files need. The command may find differences, but no trouble.
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
        diff("exr", exr::good()),
        diff("npy", npy::good()),
        diff("pfm", pfm::good()),
        Case::new("good-pack", "a good pack, judged by itself", "check PACK PACK -o out", &[]),
        Case::new("good-note", "a good note", "check PACK mine -o out", &[])
            .item("mine", Item::Pack("facets"))
            .file("mine/candidate.json", candidate::good()),
    ]
}

/// The cases as the table of `docs/evidence/malformed-inputs.md`.
pub fn table() -> String {
    let mut text = String::from(
        "# Hostile files\n\nMade by `tests/src/hostile`, run by `crates/cli/tests/hostile.rs`: each in a process of its own \
         under a limit of 512 MB of\nmemory and 2 s of processor time. Asserted of each: exit code 2, one short message with \
         these words, nothing on standard\noutput, no file written. `just hostile` writes this page.\n\n| case | what it is | words of the message |\n| --- | --- | --- |\n",
    );
    for case in all().iter().chain(&tiffs()) {
        let words =
            case.words.iter().map(|word| format!("`{}`", word.replace('|', "\\|"))).collect::<Vec<_>>();
        text += &format!("| {} | {} | {} |\n", case.name, case.what, words.join(", "));
    }
    text
}
