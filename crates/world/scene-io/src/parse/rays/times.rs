//! `times_file`: the time at which each ray of a file is fired.

use std::path::Path;
use toml::Spanned;

use raypencil_files::{FileError, Limits, bytes, npy_numbers_from_bytes, sha256};

use crate::digest::NamedDigest;
use crate::parse::key::Key;
use crate::parse::source::Source;
use crate::scene_error::SceneIoError;
use crate::trajectory::TIME_S;

impl Source<'_> {
    /// Times of the rays of the set `name`, seconds: an NPY array of the shape of its `file`.
    pub(super) fn times(
        &self,
        name: &str,
        file_of_rays: &Key<String>,
        file: &Spanned<String>,
        shape: &[u64],
        digests: &mut Vec<NamedDigest>,
    ) -> Result<Vec<f64>, SceneIoError> {
        let refuse = |message: String| self.error(file.span(), message);
        if file_of_rays.is_none() {
            let message = format!(
                "`{name}.times_file` without `file`; expected none: patterns have times of their own"
            );
            return Err(refuse(message));
        }
        let path = self.file.parent().unwrap_or(Path::new("")).join(file.get_ref());
        if !path.is_file() {
            return Err(refuse(format!(
                "`{name}.times_file`: there is no file \"{}\"; expected times as NPY, the path relative to this file",
                path.display()
            )));
        }
        // The header of an NPY file comes on top of its numbers, at most 2^16 bytes.
        let most = Limits::default().bytes + (1 << 16);
        let bytes = bytes::read_file(&path, most).map_err(|error| FileError::io(&path, "read", error))?;
        let array = npy_numbers_from_bytes(&bytes, &path)?;
        if array.shape != shape {
            let found = format!("`{name}.times_file` has shape {:?}", array.shape);
            return Err(refuse(format!("{found}; expected {shape:?}, a time for each ray of `file`")));
        }
        if let Some(index) = array.values.iter().position(|time| !TIME_S.contains(time)) {
            let time = array.values[index];
            return Err(refuse(format!(
                "`{name}.times_file`: the time of ray {index} is {time}; expected -1e12 to 1e12 seconds"
            )));
        }
        digests.push((file.get_ref().clone(), sha256(&bytes)));
        Ok(array.values)
    }
}
