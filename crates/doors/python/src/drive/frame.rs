//! A frame of a drive as arrays and plain values.

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use raypencil::Image;
use raypencil::rover::{
    CameraImage, DriveFrame, EdgePoint, ElevationMap, ElevationSource, Exposure, Label, ScanReason, SectorEnd,
};

use super::replay::ReplayedFrame;
use crate::array::Array;
use crate::scene::pose_dict;

fn label(label: Label) -> &'static str {
    match label {
        Label::Obstacle => "obstacle",
        Label::Unknown => "unknown",
        Label::Visibility => "visibility",
    }
}

fn scan(reason: ScanReason) -> &'static str {
    match reason {
        ScanReason::Start => "start",
        ScanReason::Distance => "distance",
        ScanReason::Inconsistency => "inconsistency",
    }
}

/// The image in the type of the recorded file: `uint16`; `int32` if its numbers may be negative; `float64` for a flux.
fn image_array(image: &CameraImage, is_signed: bool) -> Array {
    let size = |image: &Image<i32>| [image.height() as usize, image.width() as usize];
    match image {
        CameraImage::Flux(image) => {
            Array::new(&[image.height() as usize, image.width() as usize], image.cells().to_vec())
        }
        CameraImage::Numbers(image) if is_signed => Array::new(&size(image), image.cells().to_vec()),
        CameraImage::Numbers(image) => {
            let number = |&number: &i32| number.clamp(0, i32::from(u16::MAX)) as u16;
            Array::new(&size(image), image.cells().iter().map(number).collect::<Vec<u16>>())
        }
    }
}

/// What tells one edge from another: frame, step of the scan (-1: none), beam, column, row.
fn key(frame: u64, step: Option<u32>, beam: usize, edge: &EdgePoint) -> [f64; 5] {
    [frame as f64, step.map_or(-1.0, f64::from), beam as f64, f64::from(edge.i), edge.row]
}

/// Edges and points as the rows of `stripes.npy` and `points.npy`.
fn stripe_arrays(frame: &DriveFrame) -> (Array, Array) {
    let DriveFrame { index, edges, measured, believed, .. } = frame;
    let stripes: Vec<f64> =
        edges.iter().flat_map(|found| key(*index, found.step, found.beam, &found.edge)).collect();
    let row = |point: &raypencil::rover::MeasuredPoint| {
        let global = *believed * point.point;
        let key = key(*index, point.step, point.beam, &point.edge);
        key.into_iter().chain(point.point.to_array()).chain(global.to_array())
    };
    let points: Vec<f64> = measured.iter().flat_map(row).collect();
    (Array::new(&[edges.len(), 5], stripes), Array::new(&[measured.len(), 11], points))
}

/// The map: the row of smallest y comes first.
fn map_dict<'py>(py: Python<'py>, map: &ElevationMap) -> PyResult<Bound<'py, PyDict>> {
    let side = map.size().points as usize;
    let estimate = |point| map.estimate(point).map_or(f64::NAN, |estimate| estimate.elevation);
    let elevations: Vec<f64> = map.points().map(estimate).collect();
    let source = |point| match map.source(point) {
        ElevationSource::Unknown => 0_u8,
        ElevationSource::Proximity => 1,
        ElevationSource::Extrapolated => 2,
        ElevationSource::Measured => 3,
    };
    let corner = map.points().next().map(|point| map.place(point)).unwrap_or_default();
    let dict = PyDict::new(py);
    dict.set_item("elevation", Array::new(&[side, side], elevations).into_numpy(py)?)?;
    dict.set_item(
        "source",
        Array::new(&[side, side], map.points().map(source).collect::<Vec<u8>>()).into_numpy(py)?,
    )?;
    dict.set_item("west", corner.x)?;
    dict.set_item("south", corner.y)?;
    dict.set_item("spacing", map.size().spacing)?;
    Ok(dict)
}

fn exposure_name(exposure: &Exposure) -> String {
    exposure.beam.map_or("all".into(), |beam| format!("beam{beam}"))
}

/// All of it. `is_signed`: images may have negative numbers.
pub(super) fn frame_dict<'py>(
    py: Python<'py>,
    replayed: &ReplayedFrame,
    is_signed: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let ReplayedFrame { frame, map, images } = replayed;
    let dict = PyDict::new(py);
    dict.set_item("index", frame.index)?;
    dict.set_item("time", frame.time)?;
    dict.set_item("driven", frame.place.driven)?;
    dict.set_item("true_pose", pose_dict(py, &frame.stance.pose())?)?;
    dict.set_item("believed_pose", pose_dict(py, &frame.believed)?)?;
    dict.set_item("scan", frame.scan.map(scan))?;
    dict.set_item("columns_left_out", frame.columns_left_out)?;
    let of_images = PyDict::new(py);
    for (exposure, image) in images {
        of_images.set_item(exposure_name(exposure), image_array(image, is_signed).into_numpy(py)?)?;
    }
    dict.set_item("images", of_images)?;
    let (stripes, points) = stripe_arrays(frame);
    dict.set_item("stripes", stripes.into_numpy(py)?)?;
    dict.set_item("points", points.into_numpy(py)?)?;
    dict.set_item("map", map_dict(py, map)?)?;
    match &frame.obstacles {
        None => {
            dict.set_item("sectors", py.None())?;
            dict.set_item("vectors", py.None())?;
        }
        Some((obstacles, vectors)) => {
            let numbers = |end: &SectorEnd| [end.direction, end.radius, end.point.x, end.point.y];
            let sectors = &obstacles.sectors;
            let of_sectors = PyDict::new(py);
            let ends: Vec<f64> = sectors.iter().flat_map(numbers).collect();
            of_sectors.set_item("ends", Array::new(&[sectors.len(), 4], ends).into_numpy(py)?)?;
            of_sectors.set_item("labels", PyList::new(py, sectors.iter().map(|end| label(end.label)))?)?;
            dict.set_item("sectors", of_sectors)?;
            let of_vectors = PyDict::new(py);
            let ends: Vec<f64> =
                vectors.iter().flat_map(|one| [one.from.x, one.from.y, one.to.x, one.to.y]).collect();
            of_vectors.set_item("ends", Array::new(&[vectors.len(), 4], ends).into_numpy(py)?)?;
            of_vectors.set_item("labels", PyList::new(py, vectors.iter().map(|one| label(one.label)))?)?;
            dict.set_item("vectors", of_vectors)?;
        }
    }
    Ok(dict)
}
