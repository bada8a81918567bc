//! Heights on a regular grid to GeoTIFF, as [`crate::read_dem`] reads it. (TIFF 6.0; OGC 19-008r4, GeoTIFF 1.1)

use std::io::Cursor;
use std::path::Path;

use raypencil_files::{FileError, write_atomically};
use raypencil_terrain::HeightGrid;
use tiff::encoder::TiffEncoder;
use tiff::encoder::colortype::Gray64Float;
use tiff::tags::Tag;

use crate::dem::geo_keys::USER_DEFINED;

/// Geo keys: this projected system, pixels that are points, metres along all axes.
fn geo_keys(system: u16) -> [u16; 24] {
    [
        // Version 1.1.0, five keys.
        1, 1, 0, 5, //
        1024, 0, 1, 1, // GTModelTypeGeoKey: projected
        1025, 0, 1, 2, // GTRasterTypeGeoKey: PixelIsPoint
        3072, 0, 1, system, // ProjectedCRSGeoKey
        3076, 0, 1, 9001, // ProjLinearUnitsGeoKey: metre
        4099, 0, 1, 9001, // VerticalUnitsGeoKey: metre
    ]
}

/// Writes posts as a GeoTIFF with one band of f64, metres, the northernmost row first.
///
/// Pixels are points: the tie point is at a post. Unknown heights are NaN, which the file declares as no data. `system` is the EPSG
/// code of the projected system, in metres, in which the posts lie; `None`: the file says that it is nobody's.
///
/// # Errors
/// An error of the file system or of the encoder, with the path.
pub fn write_geotiff(
    path: impl AsRef<Path>,
    posts: &HeightGrid,
    system: Option<u16>,
) -> Result<(), FileError> {
    let path = path.as_ref();
    let bytes =
        encode(posts, system).map_err(|error| FileError::io(path, "write", std::io::Error::other(error)))?;
    write_atomically(path, |file| file.write_all(&bytes))
}

fn encode(posts: &HeightGrid, system: Option<u16>) -> tiff::TiffResult<Vec<u8>> {
    let mut file = Cursor::new(Vec::new());
    let mut encoder = TiffEncoder::new(&mut file)?;
    let mut image = encoder.new_image::<Gray64Float>(posts.columns, posts.rows)?;
    let north = posts.corner.y + posts.spacing.y * f64::from(posts.rows.saturating_sub(1));
    let tags = image.encoder();
    tags.write_tag(Tag::ModelPixelScaleTag, [posts.spacing.x, posts.spacing.y, 0.0].as_slice())?;
    tags.write_tag(Tag::ModelTiepointTag, [0.0, 0.0, 0.0, posts.corner.x, north, 0.0].as_slice())?;
    tags.write_tag(Tag::GeoKeyDirectoryTag, geo_keys(system.unwrap_or(USER_DEFINED)).as_slice())?;
    tags.write_tag(Tag::GdalNodata, "nan")?;
    let rows = posts.heights.chunks_exact(posts.columns as usize).rev();
    let heights: Vec<f64> = rows.flatten().copied().collect();
    image.write_data(&heights)?;
    Ok(file.into_inner())
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;
    use crate::dem::{Registration, read_dem};

    #[test]
    fn what_is_written_is_read_back() {
        let posts = HeightGrid {
            columns: 4,
            rows: 3,
            corner: DVec2::new(-7.5, 2.25),
            spacing: DVec2::new(0.125, 0.125),
            heights: (0..12).map(|k| if k == 5 { f64::NAN } else { 0.1 * f64::from(k) - 0.3 }).collect(),
        };
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("map.tif");
        // UTM zone 33 N, and none.
        write_geotiff(&path, &posts, Some(32633)).unwrap();
        assert_eq!(read_dem(&path, None).unwrap().map.metric_code(), Some(32633));
        write_geotiff(&path, &posts, None).unwrap();
        assert_eq!(read_dem(&path, None).unwrap().map.metric_code(), None);
        let dem = read_dem(&path, None).unwrap();
        assert_eq!((dem.registration, dem.unknown), (Registration::Point, 1));
        assert!(dem.nodata.is_some_and(f64::is_nan));
        let read = dem.posts;
        assert_eq!((read.columns, read.rows, read.spacing), (4, 3, posts.spacing));
        assert!((read.corner - posts.corner).length() < 1e-12);
        for (a, b) in read.heights.iter().zip(&posts.heights) {
            assert_eq!(a.to_bits(), b.to_bits());
        }
    }
}
