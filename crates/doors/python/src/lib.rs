//! The Python package `raypencil`: what its Python sources call. `docs/guide/python.md` is for people.
//!
//! Functions here take and return plain things: arrays, texts, JSON. The classes that people see, their defaults and their
//! docstrings are in `python/raypencil/`. Every long call runs on a thread of its own without Python's lock, so that other
//! threads of Python go on and Ctrl-C is heard.
//!
//! ```text
//! failure        an error on its way to Python
//! folder         output folders, by the rules of the commands
//! watch          work on another thread, watched
//! array          arrays that are made without Python and handed to it without a copy
//! mesh, rays     triangles and rays from arrays
//! cast, judge    rays answered; other answers judged
//! returns        the returns of beams with a width
//! scene          scenes from names, files and texts
//! maps           what a renderer returns, as arrays
//! render, validation, pack, check, diff, recording     one file for each call
//! drive/         a drive, frame by frame
//! ground         generated terrain
//! declared       what is declared about a recording, as arguments
//! picture        a map as PNG
//! campaign, sweep  shards, made anywhere, and what they give together
//! command        the command line
//! ```

mod array;
mod campaign;
mod cast;
mod check;
mod command;
mod declared;
mod diff;
mod drive;
mod failure;
mod folder;
mod ground;
mod judge;
mod maps;
mod mesh;
mod pack;
mod picture;
mod rays;
mod recording;
mod render;
mod returns;
mod scene;
mod sweep;
mod validation;
mod watch;

/// The module `raypencil._raypencil`.
#[pyo3::pymodule]
mod _raypencil {
    #[pymodule_export]
    use crate::campaign::CampaignCore;
    #[pymodule_export]
    use crate::cast::{cast, cast_warnings, check_rays};
    #[pymodule_export]
    use crate::check::check;
    #[pymodule_export]
    use crate::command::command;
    #[pymodule_export]
    use crate::diff::diff;
    #[pymodule_export]
    use crate::drive::DriveCore;
    #[pymodule_export]
    use crate::folder::SharedCore;
    #[pymodule_export]
    use crate::ground::generate_ground;
    #[pymodule_export]
    use crate::judge::judge;
    #[pymodule_export]
    use crate::mesh::{MeshCore, load_mesh};
    #[pymodule_export]
    use crate::pack::{pack_ray_sets, pack_rays, pack_scene};
    #[pymodule_export]
    use crate::picture::picture;
    #[pymodule_export]
    use crate::recording::read_recording;
    #[pymodule_export]
    use crate::render::render;
    #[pymodule_export]
    use crate::returns::beam_returns;
    #[pymodule_export]
    use crate::scene::{SceneCore, refuse_contradictions};
    #[pymodule_export]
    use crate::sweep::{SweepCore, parse_axis};
    #[pymodule_export]
    use crate::validation::{ValidationCore, validate};

    /// The version of the package.
    #[pymodule_export]
    #[allow(non_upper_case_globals)]
    const __version__: &str = env!("CARGO_PKG_VERSION");
}
