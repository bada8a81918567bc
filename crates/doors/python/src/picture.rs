//! A map as a picture.

use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use raypencil::report::{Picture, Reduction, Scale};
use raypencil::{Image, Maybe};

use crate::scene::usage;

/// The map as PNG, at most `max_side` pixels wide and high: cells that are not finite are grey. `light`: of a map of light
/// the brightest cell of each block is drawn, and colours begin at 0.
#[pyfunction]
pub(crate) fn picture<'py>(
    py: Python<'py>,
    map: PyReadonlyArray2<'py, f64>,
    max_side: u32,
    light: bool,
) -> PyResult<Bound<'py, PyBytes>> {
    let view = map.as_array();
    let (rows, columns) = view.dim();
    let (Ok(width), Ok(height)) = (u32::try_from(columns), u32::try_from(rows)) else {
        return Err(usage(py, format!("a map of {rows} x {columns}")));
    };
    if rows == 0 || columns == 0 || max_side == 0 {
        return Err(usage(
            py,
            format!("a map of {rows} x {columns}, drawn {max_side} wide; expected at least one cell"),
        ));
    }
    let cells: Vec<Maybe<f64>> =
        view.iter().map(|&cell| Some(cell).filter(|cell| cell.is_finite()).into()).collect();
    let png = py.detach(|| {
        let map = Image::from_cells(width, height, cells);
        let values = || map.cells().iter().filter_map(|cell| cell.get());
        let scale = if light { Scale::from_zero(values()) } else { Scale::of_ranges(values()) };
        let (scale, reduction) =
            (scale.unwrap_or(Scale::linear(0.0, 0.0)), Reduction::to_fit(width, height, max_side));
        let draw = if light { Picture::of_light } else { Picture::of_map };
        draw(&map, scale, reduction).png
    });
    Ok(PyBytes::new(py, &png))
}
