//! Grounds that several scenes share.

use std::sync::{Arc, Mutex, PoisonError};

use raypencil_files::Sha256Digest;
use raypencil_mesh_io::FileFacts;
use raypencil_scene::Mesh;

/// A ground, and where it comes from.
#[derive(Debug, Clone)]
pub(crate) struct Ground {
    pub(crate) mesh: Arc<Mesh>,
    /// Digests of its files; `None`: it has no file.
    pub(crate) digests: Option<Vec<Sha256Digest>>,
    /// What was found out about its file.
    pub(crate) facts: FileFacts,
}

/// The grounds of the last few scenes. A scene with the same ground shares it, and with it all that renderers and the
/// referee have made of it.
///
/// A file is taken to stay as it is while this value lives.
///
/// ```
/// use std::sync::Arc;
///
/// use raypencil_scene_io::{Grounds, Overrides, Setting, load_sharing};
///
/// let grounds = Grounds::new(2);
/// let mesh = |setting: &str| {
///     let overrides = Overrides { settings: vec![Setting::parse(setting)?], ..Overrides::default() };
///     load_sharing("pyramids", &overrides, &grounds).map(|loaded| Arc::clone(loaded.scene.mesh()))
/// };
/// let first = mesh("camera.pitch_down_deg=20")?;
/// assert!(Arc::ptr_eq(&first, &mesh("camera.pitch_down_deg=25")?));
/// assert!(!Arc::ptr_eq(&first, &mesh("terrain.builtin=facets")?));
/// # Ok::<(), raypencil_scene_io::SceneIoError>(())
/// ```
#[derive(Debug)]
pub struct Grounds {
    max_count: usize,
    /// The last used one last.
    kept: Mutex<Vec<(String, Ground)>>,
}

impl Grounds {
    /// Room for so many grounds.
    pub fn new(max_count: usize) -> Self {
        Self { max_count, kept: Mutex::new(Vec::new()) }
    }

    /// The ground of that name if it is kept, else the one that `make` makes.
    pub(crate) fn get<E>(&self, name: String, make: impl FnOnce() -> Result<Ground, E>) -> Result<Ground, E> {
        // Whoever needs the same ground waits for it rather than making it twice.
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(at) = kept.iter().position(|(own, _)| *own == name) {
            let found = kept.remove(at);
            let ground = found.1.clone();
            kept.push(found);
            return Ok(ground);
        }
        // An old one goes first: two large grounds less to hold at once.
        if kept.len() >= self.max_count && !kept.is_empty() {
            kept.remove(0);
        }
        let ground = make()?;
        if self.max_count > 0 {
            kept.push((name, ground.clone()));
        }
        Ok(ground)
    }
}
