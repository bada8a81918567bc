//! Frame of the animation: the camera's view on the left, the local map from above on the right.

use raypencil_report::{ColourMap, Scale};
use raypencil_rover::{ElevationMap, GridPoint};

use crate::camera_view::CameraView;

/// Side of each half of a frame, pixels.
pub(crate) const HALF_SIDE_PX: u32 = 256;

/// Colour of unknown cells, and of the space around the camera's view.
const EMPTY_COLOUR: [u8; 3] = [236, 234, 229];

const VEHICLE_COLOUR: [u8; 3] = [226, 35, 26];

#[derive(Debug, Clone)]
pub(crate) struct AnimationFrame {
    pub view: CameraView,
    pub map: MapThumbnail,
}

impl AnimationFrame {
    /// Red, green and blue of all pixels, row by row from the top. The map's colours follow `scale`, in metres.
    pub(crate) fn rgb(&self, scale: Scale) -> Vec<u8> {
        let rows = (0..HALF_SIDE_PX).flat_map(|j| {
            let left = (0..HALF_SIDE_PX).map(move |i| self.view_colour(i, j));
            left.chain((0..HALF_SIDE_PX).map(move |i| self.map.colour(i, j, scale)))
        });
        rows.flatten().collect()
    }

    /// Colour of the left half at a pixel: the view lies in the middle, at its own size.
    fn view_colour(&self, i: u32, j: u32) -> [u8; 3] {
        let view = &self.view;
        let inside =
            |at: u32, side: u32| (at + side / 2).checked_sub(HALF_SIDE_PX / 2).filter(|&at| at < side);
        match (inside(i, view.width), inside(j, view.height)) {
            (Some(i), Some(j)) => view.pixels[(j * view.width + i) as usize],
            _ => EMPTY_COLOUR,
        }
    }
}

/// Local map from above, at the size at which it is shown. Keeping every frame's whole map would fill the memory.
#[derive(Debug, Clone)]
pub(crate) struct MapThumbnail {
    /// Row by row from the top.
    pixels: Vec<MapPixel>,
}

#[derive(Debug, Clone, Copy)]
enum MapPixel {
    Unknown,
    Vehicle,
    /// Elevation, metres.
    Elevation(f64),
}

impl MapThumbnail {
    pub(crate) fn of(map: &ElevationMap) -> Self {
        let points = i64::from(map.size().points);
        // Grid steps from the middle of the map; north is on top.
        let step = |at: u32| i64::from(at) * points / i64::from(HALF_SIDE_PX) - points / 2;
        let pixel = |j: u32, i: u32| {
            let (right, up) = (step(i), step(HALF_SIDE_PX - 1 - j));
            if right.abs().max(up.abs()) <= 1 {
                return MapPixel::Vehicle;
            }
            let point = GridPoint { i: map.centre().i + right, j: map.centre().j + up };
            map.elevation(point).map_or(MapPixel::Unknown, MapPixel::Elevation)
        };
        let rows = 0..HALF_SIDE_PX;
        Self { pixels: rows.flat_map(|j| (0..HALF_SIDE_PX).map(move |i| pixel(j, i))).collect() }
    }

    /// Known elevations, metres.
    pub(crate) fn elevations(&self) -> impl Iterator<Item = f64> {
        self.pixels
            .iter()
            .filter_map(|pixel| if let MapPixel::Elevation(z) = pixel { Some(*z) } else { None })
    }

    fn colour(&self, i: u32, j: u32, scale: Scale) -> [u8; 3] {
        match self.pixels[(j * HALF_SIDE_PX + i) as usize] {
            MapPixel::Unknown => EMPTY_COLOUR,
            MapPixel::Vehicle => VEHICLE_COLOUR,
            MapPixel::Elevation(z) => ColourMap::Sequential.at(scale.fraction(z)),
        }
    }
}
