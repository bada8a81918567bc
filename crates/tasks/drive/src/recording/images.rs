//! Digital images of a recording.

use std::path::Path;

use raypencil_files::{FileError, write_atomically, write_npy};
use raypencil_rover::{CameraImage, Exposure};
use raypencil_scene::Image;

use crate::recording::contents::RecordContents;

/// Name of an exposure's files, without ending.
fn stem(exposure: &Exposure) -> String {
    let scan = exposure.step.map_or(String::new(), |step| format!("-scan{step:03}"));
    let beam = exposure.beam.map_or("all".to_string(), |beam| format!("beam{beam}"));
    format!("{:06}{scan}-{beam}", exposure.frame)
}

/// Writes one image. `is_signed`: its numbers may be negative.
pub(super) fn write_image(
    folder: &Path,
    contents: RecordContents,
    exposure: &Exposure,
    image: &CameraImage,
    is_signed: bool,
) -> Result<(), FileError> {
    let stem = stem(exposure);
    let path = |ending: &str| folder.join(format!("{stem}.{ending}"));
    if contents.png {
        write_png(&path("png"), &grey(image))?;
    }
    if contents.npy {
        match image {
            CameraImage::Flux(flux) => write_npy(path("npy"), &[flux])?,
            CameraImage::Numbers(numbers) if is_signed => write_npy(path("npy"), &[numbers])?,
            CameraImage::Numbers(_) => write_npy(path("npy"), &[&grey(image)])?,
        }
    }
    Ok(())
}

/// Grey values of 16 bits: the digital numbers, or the share of the brightest pixel times 65535.
fn grey(image: &CameraImage) -> Image<u16> {
    let most = f64::from(u16::MAX);
    match image {
        CameraImage::Flux(flux) => {
            let largest = flux.cells().iter().copied().fold(0.0, f64::max);
            let scale = if largest > 0.0 { most / largest } else { 0.0 };
            let value = |&flux: &f64| (flux * scale + 0.5).clamp(0.0, most) as u16;
            Image::from_cells(flux.width(), flux.height(), flux.cells().iter().map(value).collect())
        }
        CameraImage::Numbers(numbers) => {
            // A camera has at most 16 bits; only a difference can be negative.
            let value = |&number: &i32| number.clamp(0, i32::from(u16::MAX)) as u16;
            Image::from_cells(numbers.width(), numbers.height(), numbers.cells().iter().map(value).collect())
        }
    }
}

/// Writes grey values as a PNG of 16 bits.
fn write_png(path: &Path, image: &Image<u16>) -> Result<(), FileError> {
    write_atomically(path, |file| {
        let mut encoder = png::Encoder::new(file, image.width(), image.height());
        encoder.set_color(png::ColorType::Grayscale);
        encoder.set_depth(png::BitDepth::Sixteen);
        // Images are dark but for two stripes: the fastest level is small enough.
        encoder.set_compression(png::Compression::Fast);
        let bytes: Vec<u8> = image.cells().iter().flat_map(|value| value.to_be_bytes()).collect();
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&bytes)?;
        writer.finish()?;
        Ok(())
    })
}
