//! Maps in files of any program.

use std::path::PathBuf;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use raypencil::io::{Channel, Limits, Storage, Values, add_ray_sets, read_channels_as};
use raypencil::pack::Declarations;

use crate::array::Arrays;
use crate::declared::declared;
use crate::watch::watched;

/// Reads the channels of a file or a folder by their keys: (rows, columns) each. Single precision stays single.
#[pyfunction]
#[pyo3(signature = (path, channels, scale, on_stage=None))]
pub(crate) fn read_recording<'py>(
    py: Python<'py>,
    path: PathBuf,
    channels: Vec<(String, String)>,
    scale: Option<f64>,
    on_stage: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let arrays = watched(py, on_stage, move |_| {
        let declared: Declarations = declared(&channels, scale)?.with_note_of(&path)?;
        let mut channels = read_channels_as(&path, &Limits::default(), &declared.declared(), None)?;
        add_ray_sets(&mut channels, &path, &Limits::default())?;
        let mut arrays = Arrays::default();
        for (key, Channel { storage, values, .. }) in channels.by_key {
            let (width, height) = values.size();
            let shape = [height as usize, width as usize];
            match values {
                Values::Reals(image)
                    if matches!(storage, Storage::F64 | Storage::Whole | Storage::Steps(_)) =>
                {
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
