//! Kernel of a blur, from a file of its own.

use std::path::Path;
use toml::Spanned;

use raypencil_files::{Limits, bytes, npy_from_bytes, sha256};
use raypencil_scene::SceneError;
use raypencil_sensor::Kernel;

use crate::digest::NamedDigest;
use crate::parse::source::Source;
use crate::scene_error::SceneIoError;

/// Maximum size of a kernel's file: 1025 x 1025 real numbers of eight bytes, and a header.
const MAX_KERNEL_BYTES: u64 = 1025 * 1025 * 8 + (1 << 16);

impl Source<'_> {
    /// Kernel in the NPY file that the key `name` gives, and the digest of the file.
    pub(super) fn kernel(
        &self,
        key: &Spanned<String>,
        name: &str,
    ) -> Result<(Kernel, NamedDigest), SceneIoError> {
        let refuse = |message: String| self.error(key.span(), message);
        let file = self.file.parent().unwrap_or(Path::new("")).join(key.get_ref());
        if !file.is_file() {
            return Err(refuse(format!(
                "`{name}`: there is no file \"{}\"; expected an NPY file, its path relative to the scene file",
                file.display()
            )));
        }
        let bytes = bytes::read_file(&file, MAX_KERNEL_BYTES)
            .map_err(|error| SceneIoError::io(&file, "read", error))?;
        let limits = Limits { bytes: MAX_KERNEL_BYTES, ..Limits::default() };
        let array = npy_from_bytes(&bytes, &file, &limits)?;
        let [plane] = array.planes.as_slice() else {
            return Err(refuse(format!(
                "`{name}` has {} numbers in each cell; expected rows and columns alone",
                array.planes.len()
            )));
        };
        let (columns, rows) = plane.size();
        let (columns, rows) = (columns as usize, rows as usize);
        let weights: Vec<f64> = (0..columns * rows).map(|index| plane.real(index)).collect();
        let kernel = Kernel::from_weights(columns, rows, &weights).map_err(|error| {
            let SceneError { field, value, expected } = error;
            refuse(format!("`{name}`: {field} is {value}; expected {expected}"))
        })?;
        Ok((kernel, (key.get_ref().clone(), sha256(&bytes))))
    }
}
