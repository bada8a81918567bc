//! The drive as a moving picture: the camera's view on the left, the map from above on the right, as APNG.

use crate::picture::Picture;
use crate::run::DriveRun;
use crate::view::View;
use raypencil_report::Scale;

/// Side of each half, pixels.
pub(crate) const SIDE: u32 = 256;

/// Where nothing is known, and around the camera's view.
pub(crate) const EMPTY: [u8; 3] = [236, 234, 229];

pub(crate) const VEHICLE: [u8; 3] = [226, 35, 26];

/// Pictures a second. CHOICE: 8 s for the most pictures there are.
const PICTURES_PER_S: u16 = 8;

/// The pictures of a run, over and over.
pub(crate) fn apng(run: &DriveRun) -> Vec<u8> {
    let elevations = run.pictures.iter().flat_map(|picture| picture.map.elevations());
    let scale = Scale::of(elevations).unwrap_or(Scale::linear(0.0, 0.0));
    let mut out = Vec::new();
    let mut encoder = png::Encoder::new(&mut out, 2 * SIDE, SIDE);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    // Encoding into memory cannot fail once sizes match; there is at least one picture.
    encoder.set_animated(run.pictures.len() as u32, 0).expect("pictures");
    encoder.set_frame_delay(1, PICTURES_PER_S).expect("a delay");
    let mut writer = encoder.write_header().expect("a picture of at least one cell");
    for picture in &run.pictures {
        writer.write_image_data(&cells(picture, scale)).expect("as many cells as the picture has");
    }
    writer.finish().expect("writing to memory");
    out
}

fn cells(Picture { view, map }: &Picture, scale: Scale) -> Vec<u8> {
    let rows = (0..SIDE).flat_map(|j| {
        let left = (0..SIDE).map(move |i| of_view(view, i, j));
        left.chain((0..SIDE).map(move |i| map.colour(i, j, scale)))
    });
    rows.flatten().collect()
}

fn of_view(view: &View, i: u32, j: u32) -> [u8; 3] {
    // In the middle, its own size or smaller.
    let inside = |at: u32, side: u32| (at + side / 2).checked_sub(SIDE / 2).filter(|&at| at < side);
    match (inside(i, view.width), inside(j, view.height)) {
        (Some(i), Some(j)) => view.pixels[(j * view.width + i) as usize],
        _ => EMPTY,
    }
}
