//! Elevation models: files made by hand and by an encoder are read back, malformed ones are refused by name.

mod facts;
mod malformed;
mod placement;
mod samples;
mod units;
mod unknown;
mod write;
mod zstd;

use std::path::Path;
use write::Tiff;

use raypencil_files::FileError;
use raypencil_mesh_io::{Dem, DemOptions, read_dem, read_dem_with};

/// Writes a file and reads it.
fn read(tiff: &Tiff, window: Option<[f64; 4]>) -> Result<Dem, FileError> {
    let folder = tempfile::tempdir().unwrap();
    read_dem(tiff.write(folder.path()), window)
}

/// Writes a file and reads it, with what it does not say itself.
fn read_with(tiff: &Tiff, options: &DemOptions) -> Result<Dem, FileError> {
    let folder = tempfile::tempdir().unwrap();
    read_dem_with(tiff.write(folder.path()), options)
}

/// Message by which a file is refused.
fn refusal(tiff: &Tiff, window: Option<[f64; 4]>) -> String {
    match read(tiff, window) {
        Ok(dem) => panic!("{dem:?}"),
        Err(error) => error.to_string(),
    }
}

fn assert_names(message: &str, words: &[&str]) {
    for word in words {
        assert!(message.contains(word), "{message}\nhas no {word:?}");
    }
}

/// The model of MarsYard 2021 is not part of the project: the test needs RAYPENCIL_EXTRA_DATA, the folder with it.
#[test]
fn the_marsyard_has_the_size_and_place_of_its_source() {
    let path = std::env::var_os("RAYPENCIL_EXTRA_DATA")
        .map(|folder| Path::new(&folder).join("marsyard2021_dem.tif"))
        .filter(|path| path.exists());
    let Some(path) = path else {
        eprintln!("skipped: RAYPENCIL_EXTRA_DATA names no folder with marsyard2021_dem.tif");
        return;
    };
    let dem = read_dem(&path, None).unwrap();
    let posts = &dem.posts;
    assert_eq!((posts.columns, posts.rows, dem.unknown), (500, 500, 0));
    assert_eq!((posts.spacing.x, posts.spacing.y), (0.094, 0.094));
    // The tie point, (-23.5, 21.5), is the north-west corner of an area: the first column is half a pixel further
    // east, the last row 499 pixels south of 21.5 - 0.047 m.
    assert!((posts.corner.x - -23.453).abs() < 1e-12 && (posts.corner.y - -25.453).abs() < 1e-12);
    let low = posts.heights.iter().copied().fold(f64::INFINITY, f64::min);
    let high = posts.heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    assert!((low - -0.984).abs() < 5e-4 && (high - 5.591).abs() < 5e-4, "{low} to {high}");

    let whole = dem.mesh(None, 0.25).unwrap();
    assert_eq!(whole.faces().len(), 2 * 499 * 499);
    let simple = dem.mesh(Some(0.02), 0.25).unwrap();
    assert!(simple.faces().len() < whole.faces().len() / 2, "{} faces", simple.faces().len());
    // f32 vertices within 26 m are good to 2^-20 m, 1 micrometre, and slopes are below 10.
    for row in (0..500).step_by(37) {
        for column in (0..500).step_by(37) {
            let post = posts.at(column, row);
            for (mesh, bound) in [(&whole, 1e-5), (&simple, 0.02 + 1e-5)] {
                // A border post may lie outside by the rounding of its vertex.
                let inside = post * 0.999_999_9;
                if let Some(z) = raypencil_terrain::height_at(mesh, inside.x, inside.y) {
                    assert!((z - post.z).abs() <= bound + 1e-4, "{z} at {post}");
                }
            }
        }
    }
}
