//! Maps of a rendering in the formats that other people's programs open at once.

use std::path::{Path, PathBuf};

use glam::DVec3;
use raypencil_files::{
    ArrayData, Attributes, ExrMap, FileError, NamedArray, Raster, create_folder, write_atomically, write_exr,
    write_npz, write_zarr,
};
use raypencil_judge::{Quantity, flux_channel, image_channel};
use raypencil_scene::{
    FluxModel, HitQuantity, HitRaster, Image, Maybe, Pixel, RenderOutput, Returns, Sample, Sampling,
    SensorId, SensorMap,
};
use raypencil_scene_io::{Subject, scene_sha256};

use crate::output::folder::{HarnessError, write_maps};

/// Format of the maps of a rendering.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MapFormat {
    /// An OpenEXR file for each sensor, with a channel for each quantity, in single precision.
    Exr,
    /// An OpenEXR file for each quantity of each sensor, with the channels `Y`, or `R`, `G` and `B` for a vector: what viewers
    /// and OpenCV show.
    ExrEach,
    /// An NPY file for each quantity of each sensor, in double precision.
    Npy,
    /// An NPZ file for each sensor, in double precision.
    Npz,
    /// A Zarr store, `maps.zarr`, with a group for each sensor, in double precision.
    Zarr,
}

/// NaN of a cell without a value; its bits are fixed.
const NO_VALUE: f64 = f64::from_bits(0x7ff8_0000_0000_0000);

/// Writes the maps of every sensor into `folder`, and returns the paths of the files; of a store, that of its folder.
///
/// # Errors
/// A file or folder that could not be written; the message names it and the reason.
pub fn write_maps_as(
    format: MapFormat,
    output: &RenderOutput,
    renderer: &str,
    subject: &Subject,
    sampling: Sampling,
    folder: &Path,
) -> Result<Vec<PathBuf>, HarnessError> {
    if format == MapFormat::Exr {
        return write_maps(output, renderer, subject, sampling, folder);
    }
    let model = subject.scene.flux_model();
    let sensors: Vec<(String, Vec<NamedArray>)> =
        output.maps().map(|map| (map.sensor.to_string(), arrays(map, output, model))).collect();
    create_folder(folder)?;
    let sha256 = scene_sha256(&subject.scene);
    let mut files = Vec::new();
    match format {
        MapFormat::Npz => {
            for (sensor, arrays) in &sensors {
                let path = folder.join(format!("{sensor}.npz"));
                write_npz(&path, arrays)?;
                files.push(path);
            }
        }
        MapFormat::Zarr => {
            let path = folder.join("maps.zarr");
            let version = env!("CARGO_PKG_VERSION");
            let attributes =
                [("renderer", renderer), ("scene_sha256", sha256.as_str()), ("raypencil_version", version)];
            write_zarr(&path, &attributes, &sensors)?;
            files.push(path);
        }
        MapFormat::Npy | MapFormat::ExrEach | MapFormat::Exr => {
            let attributes =
                Attributes { renderer: renderer.into(), scene_sha256: sha256, extra: Vec::new() };
            for (sensor, arrays) in &sensors {
                create_folder(&folder.join(sensor))?;
                for array in arrays {
                    let path = |ending: &str| folder.join(sensor).join(format!("{}.{ending}", array.name));
                    files.push(if format == MapFormat::Npy {
                        let bytes = array.npy();
                        write_atomically(path("npy"), |file| file.write_all(&bytes))?;
                        path("npy")
                    } else {
                        write_single_exr(&path("exr"), array, &attributes)?;
                        path("exr")
                    });
                }
            }
        }
    }
    Ok(files)
}

/// An array as an EXR of its own. Indices become numbers: exact up to 2^24, and a cell without one is NaN.
fn write_single_exr(path: &Path, array: &NamedArray, attributes: &Attributes) -> Result<(), FileError> {
    let side = |at: usize| array.shape[at].1 as u32;
    let (height, width) = (side(0), side(1));
    let mut exr = ExrMap::new(width, height);
    for (name, value) in [
        ("renderer", attributes.renderer.as_str()),
        ("sceneSha256", &attributes.scene_sha256),
        ("quantity", &array.name),
        ("unit", array.unit),
    ] {
        exr.attributes.insert(name.into(), value.into());
    }
    let plane = |numbers: Vec<f32>| Raster::F32(Image::from_cells(width, height, numbers));
    match &array.data {
        ArrayData::F64(numbers) if array.shape.len() == 3 => {
            for (axis, name) in ["R", "G", "B"].into_iter().enumerate() {
                exr.insert(name, plane(numbers.iter().skip(axis).step_by(3).map(|&x| x as f32).collect()));
            }
        }
        ArrayData::F64(numbers) => exr.insert("Y", plane(numbers.iter().map(|&x| x as f32).collect())),
        ArrayData::U32(numbers) => {
            let number = |&index: &u32| if index == u32::MAX { f32::NAN } else { index as f32 };
            exr.insert("Y", plane(numbers.iter().map(number).collect()));
        }
        ArrayData::U8(numbers) => exr.insert("Y", plane(numbers.iter().map(|&x| f32::from(x)).collect())),
    }
    write_exr(path, &exr)
}

/// All arrays of a sensor, under the names of `docs/formats/files.md`; `P` and `N` have three components.
pub fn arrays(map: &SensorMap, output: &RenderOutput, model: FluxModel) -> Vec<NamedArray> {
    let mut arrays = Vec::new();
    for quantity in HitQuantity::ALL {
        let [name, ..] = quantity.channels() else { continue };
        match map.raster(quantity) {
            Some(HitRaster::Scalar(image)) => {
                let nothing = if quantity.is_length() { f64::INFINITY } else { NO_VALUE };
                arrays.push(reals(name, quantity.unit(), meaning(name), image, nothing));
            }
            Some(HitRaster::Vector(image)) => {
                let name = name.trim_end_matches(".X");
                arrays.push(vectors(name, quantity.unit(), meaning(name), image));
            }
            None => {}
        }
    }
    if let Some(faces) = &map.face {
        let numbers = faces.cells().iter().map(|face| face.get().map_or(u32::MAX, |face| face.0)).collect();
        arrays.push(plane("face.I", "1", faces.width(), faces.height(), ArrayData::U32(numbers)));
    }
    match map.sensor {
        SensorId::Camera => {
            for (beam, image) in output.flux.iter().enumerate() {
                let name = image_channel(beam, None);
                let numbers = ArrayData::F64(image.cells().to_vec());
                arrays.push(plane(
                    &name,
                    Quantity::PixelFlux.unit(model),
                    image.width(),
                    image.height(),
                    numbers,
                ));
            }
        }
        SensorId::Beam(index) => {
            if let Some(returns) = output.returns.get(index) {
                add_returns(&mut arrays, returns, model);
            }
        }
    }
    arrays
}

fn add_returns(arrays: &mut Vec<NamedArray>, returns: &Returns, model: FluxModel) {
    if let Some(visible) = &returns.visible {
        let numbers = ArrayData::U8(visible.cells().iter().map(|&visible| u8::from(visible)).collect());
        arrays.push(plane("visible.V", "1", visible.width(), visible.height(), numbers));
    }
    if let Some(pixel) = &returns.pixel {
        for (name, axis) in [("pixel.I", (|pixel| pixel.i) as fn(Pixel) -> u32), ("pixel.J", |pixel| pixel.j)]
        {
            let number = |cell: &Maybe<Pixel>| axis(cell.get().unwrap_or(Pixel::NOTHING));
            let numbers = ArrayData::U32(pixel.cells().iter().map(number).collect());
            arrays.push(plane(name, "1", pixel.width(), pixel.height(), numbers));
        }
    }
    for (name, unit, image, nothing) in [
        ("view.Z", "m", &returns.depth, f64::INFINITY),
        ("offAxis.V", "1", &returns.cos_off_axis, NO_VALUE),
        ("emission.V", "1", &returns.cos_view, NO_VALUE),
    ] {
        if let Some(image) = image {
            arrays.push(reals(name, unit, meaning(name), image, nothing));
        }
    }
    if let Some(flux) = &returns.flux {
        let numbers = ArrayData::F64(flux.cells().to_vec());
        arrays.push(plane(
            &flux_channel(None),
            Quantity::PixelFlux.unit(model),
            flux.width(),
            flux.height(),
            numbers,
        ));
    }
}

/// What an array means, in words.
fn meaning(name: &str) -> &'static str {
    match name {
        "range.T" => "distance from the ray's origin along the ray; Inf: no hit",
        "depth.Z" => "distance along the sensor's normal axis; Inf: no hit",
        "P" => "hit point, scene frame; NaN: no hit",
        "N" => "unit normal of the face, outward, scene frame; NaN: no hit",
        "incidence.V" => "cosine of the angle between the reversed ray and the normal; NaN: no hit",
        "face.I" => "index of the face; 4294967295: no hit",
        "visible.V" => "whether the camera sees the hit",
        "pixel.I" => "column of the camera's pixel in which the hit lands; 4294967295: none",
        "pixel.J" => "row of the camera's pixel in which the hit lands; 4294967295: none",
        "view.Z" => "depth of the hit in the camera; Inf: no hit",
        "offAxis.V" => "cosine of the angle between the camera's axis and the ray to the hit; NaN: no hit",
        "emission.V" => "cosine of the angle between the normal and the direction to the camera; NaN: no hit",
        "flux.V" => "flux that the pencil delivers to its pixel",
        _ => "flux that the beam delivers to the pixel",
    }
}

fn plane(name: &str, unit: &'static str, width: u32, height: u32, data: ArrayData) -> NamedArray {
    let shape = vec![("row", u64::from(height)), ("column", u64::from(width))];
    NamedArray { name: name.into(), unit, meaning: meaning(name), shape, data }
}

fn reals(
    name: &str,
    unit: &'static str,
    meaning: &'static str,
    image: &Image<Maybe<f64>>,
    nothing: f64,
) -> NamedArray {
    let numbers = ArrayData::F64(image.cells().iter().map(|cell| cell.get().unwrap_or(nothing)).collect());
    NamedArray { meaning, ..plane(name, unit, image.width(), image.height(), numbers) }
}

fn vectors(name: &str, unit: &'static str, meaning: &'static str, image: &Image<Maybe<DVec3>>) -> NamedArray {
    let vector = |cell: &Maybe<DVec3>| cell.get().map_or([NO_VALUE; 3], |vector| vector.to_array());
    let numbers = ArrayData::F64(image.cells().iter().flat_map(vector).collect());
    let mut array = plane(name, unit, image.width(), image.height(), numbers);
    array.shape.push(("axis", 3));
    NamedArray { meaning, ..array }
}
