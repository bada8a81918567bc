//! Any bytes as a GeoTIFF, whole and in a window.

use libfuzzer_sys::fuzz_target;

use raypencil_mesh_io::dem_from_bytes;

#![no_main]

use std::path::Path;

fuzz_target!(|bytes: &[u8]| {
    let file = Path::new("any.tif");
    for window in [None, Some([99.0, 190.0, 10.0, 20.0])] {
        let Ok(dem) = dem_from_bytes(bytes, file, window) else { continue };
        let posts = &dem.posts;
        assert_eq!(posts.heights.len() as u64, u64::from(posts.columns) * u64::from(posts.rows));
        // Large grounds are right, and slow.
        if posts.heights.len() < 1 << 14 {
            let _ = dem.mesh(None, 0.25);
            let _ = dem.mesh(Some(0.5), 0.25);
        }
    }
});
