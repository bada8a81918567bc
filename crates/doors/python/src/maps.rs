//! What a renderer returns, as arrays: one group for each sensor.

use glam::DVec3;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use raypencil::{FaceId, Image, Maybe, Pixel, RenderOutput, Returns, SensorId, SensorMap};

use crate::array::Arrays;

/// What stands for no face and no pixel.
const NONE: u32 = u32::MAX;

/// The arrays of each sensor, by its name: `camera`, `beam-0`, ...
pub(crate) type SensorArrays = Vec<(String, Arrays)>;

fn scalars(image: &Image<Maybe<f64>>, miss: f64) -> Vec<f64> {
    image.cells().iter().map(|cell| cell.get().unwrap_or(miss)).collect()
}

fn vectors(image: &Image<Maybe<DVec3>>) -> Vec<f64> {
    image.cells().iter().flat_map(|cell| cell.get().unwrap_or(DVec3::NAN).to_array()).collect()
}

/// The maps of a sensor. Misses are as in the files: infinite distances, NaN, 4294967295.
fn add_map(arrays: &mut Arrays, map: &SensorMap) {
    let size = [map.height as usize, map.width as usize];
    let of_three = [size[0], size[1], 3];
    let of_scalars = [
        ("range", &map.range, f64::INFINITY),
        ("depth", &map.depth, f64::INFINITY),
        ("cos_incidence", &map.cos_incidence, f64::NAN),
    ];
    for (name, image, miss) in of_scalars {
        if let Some(image) = image {
            arrays.add(name, &size, scalars(image, miss));
        }
    }
    for (name, image) in [("point", &map.point), ("normal", &map.normal)] {
        if let Some(image) = image {
            arrays.add(name, &of_three, vectors(image));
        }
    }
    if let Some(image) = &map.face {
        let face = |cell: &Maybe<FaceId>| cell.get().map_or(NONE, |face| face.0);
        arrays.add("face", &size, image.cells().iter().map(face).collect::<Vec<u32>>());
    }
}

/// The light that comes back from a beam's pencils.
fn add_returns(arrays: &mut Arrays, returns: &Returns) {
    let size = [returns.rows as usize, returns.columns as usize];
    if let Some(image) = &returns.visible {
        arrays.add("visible", &size, image.cells().to_vec());
    }
    if let Some(image) = &returns.pixel {
        let both = |cell: &Maybe<Pixel>| cell.get().map_or([NONE; 2], |pixel| [pixel.i, pixel.j]);
        arrays.add(
            "pixel",
            &[size[0], size[1], 2],
            image.cells().iter().flat_map(both).collect::<Vec<u32>>(),
        );
    }
    let of_scalars = [
        ("view_depth", &returns.depth, f64::INFINITY),
        ("cos_off_axis", &returns.cos_off_axis, f64::NAN),
        ("cos_view", &returns.cos_view, f64::NAN),
    ];
    for (name, image, miss) in of_scalars {
        if let Some(image) = image {
            arrays.add(name, &size, scalars(image, miss));
        }
    }
    if let Some(image) = &returns.flux {
        arrays.add("flux", &size, image.cells().to_vec());
    }
}

/// All of it.
pub(crate) fn sensor_arrays(output: &RenderOutput) -> SensorArrays {
    let mut all = Vec::new();
    for map in output.maps() {
        let mut arrays = Arrays::default();
        add_map(&mut arrays, map);
        match map.sensor {
            SensorId::Camera => {
                if let Some(first) = output.flux.first() {
                    let shape = [output.flux.len(), first.height() as usize, first.width() as usize];
                    let flux: Vec<f64> =
                        output.flux.iter().flat_map(|image| image.cells()).copied().collect();
                    arrays.add("flux", &shape, flux);
                }
            }
            SensorId::Beam(index) => {
                if let Some(returns) = output.returns.get(index) {
                    add_returns(&mut arrays, returns);
                }
            }
        }
        all.push((map.sensor.to_string(), arrays));
    }
    all
}

/// A dictionary of dictionaries.
pub(crate) fn into_dict(py: Python<'_>, sensors: SensorArrays) -> PyResult<Bound<'_, PyDict>> {
    let dict = PyDict::new(py);
    for (name, arrays) in sensors {
        dict.set_item(name, arrays.into_dict(py)?)?;
    }
    Ok(dict)
}
