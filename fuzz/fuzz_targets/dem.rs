//! Fuzz target: any bytes as a GeoTIFF, whole and in a window.

#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use raypencil::io::dem_from_bytes;

fuzz_target!(|bytes: &[u8]| {
    let file = Path::new("any.tif");
    for window in [None, Some([99.0, 190.0, 10.0, 20.0])] {
        let Ok(dem) = dem_from_bytes(bytes, file, window) else { continue };
        let posts = &dem.posts;
        assert_eq!(posts.heights.len() as u64, u64::from(posts.columns) * u64::from(posts.rows));
        // Large terrains are valid but slow.
        if posts.heights.len() < 1 << 14 {
            let _ = dem.mesh(None, 0.25);
            let _ = dem.mesh(Some(0.5), 0.25);
        }
    }
});
