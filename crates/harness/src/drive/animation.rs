//! The drive as a moving picture: the camera's view on the left, the map from above on the right, as APNG.

use raypencil_rover::{GridPoint, LocalMap};

use super::run::{DriveRun, Picture};
use super::view::View;
use crate::output::picture::ColourMap;
use crate::output::scale::Scale;

/// Side of each half, pixels.
const SIDE: u32 = 256;
/// Where nothing is known, and around the camera's view.
const EMPTY: [u8; 3] = [236, 234, 229];
const VEHICLE: [u8; 3] = [226, 35, 26];
/// Pictures a second. CHOICE: 8 s for the most pictures there are.
const PICTURES_PER_S: u16 = 8;

/// The local map from above, as large as it is shown: whole maps of a drive would fill the memory.
#[derive(Debug, Clone)]
pub(super) struct MapPicture {
    /// Row by row from the top.
    cells: Vec<Seen>,
}

/// What is in a cell.
#[derive(Debug, Clone, Copy)]
enum Seen {
    Nothing,
    Vehicle,
    /// Its elevation, metres.
    Ground(f64),
}

/// The pictures of a run, over and over.
pub(super) fn apng(run: &DriveRun) -> Vec<u8> {
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

impl MapPicture {
    pub(super) fn of(map: &LocalMap) -> Self {
        let points = i64::from(map.size().points);
        // Steps from the middle of the map, north on top.
        let step = |at: u32| i64::from(at) * points / i64::from(SIDE) - points / 2;
        let cell = |j: u32, i: u32| {
            let (right, up) = (step(i), step(SIDE - 1 - j));
            if right.abs().max(up.abs()) <= 1 {
                return Seen::Vehicle;
            }
            let point = GridPoint { i: map.centre().i + right, j: map.centre().j + up };
            map.elevation(point).map_or(Seen::Nothing, Seen::Ground)
        };
        Self { cells: (0..SIDE).flat_map(|j| (0..SIDE).map(move |i| cell(j, i))).collect() }
    }

    fn elevations(&self) -> impl Iterator<Item = f64> {
        self.cells.iter().filter_map(|seen| if let Seen::Ground(z) = seen { Some(*z) } else { None })
    }

    fn colour(&self, i: u32, j: u32, scale: Scale) -> [u8; 3] {
        match self.cells[(j * SIDE + i) as usize] {
            Seen::Nothing => EMPTY,
            Seen::Vehicle => VEHICLE,
            Seen::Ground(z) => ColourMap::Sequential.at(scale.fraction(z)),
        }
    }
}
