//! Maps in files of any program.

use std::path::PathBuf;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use raypencil::io::{Channel, Limits, Storage, Values, add_ray_sets, read_channels};

use crate::array::Arrays;
use crate::watch::watched;

/// Reads the channels of a file or a folder by their keys: (rows, columns) each. Single precision stays single.
#[pyfunction]
#[pyo3(signature = (path, on_stage=None))]
pub(crate) fn read_recording<'py>(
    py: Python<'py>,
    path: PathBuf,
    on_stage: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let arrays = watched(py, on_stage, move |_| {
        let mut channels = read_channels(&path, &Limits::default())?;
        add_ray_sets(&mut channels, &path, &Limits::default())?;
        let mut arrays = Arrays::default();
        for (key, Channel { storage, values, .. }) in channels.by_key {
            let (width, height) = values.size();
            let shape = [height as usize, width as usize];
            match values {
                Values::Reals(image) if matches!(storage, Storage::F64 | Storage::Whole) => {
                    arrays.add(key, &shape, image.cells().to_vec());
                }
                // Halves and singles were widened exactly.
                Values::Reals(image) => {
                    arrays.add(
                        key,
                        &shape,
                        image.cells().iter().map(|&cell| cell as f32).collect::<Vec<_>>(),
                    );
                }
                Values::Wholes(image) => arrays.add(key, &shape, image.cells().to_vec()),
            }
        }
        Ok(arrays)
    })?;
    arrays.into_dict(py)
}
