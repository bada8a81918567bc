use crate::animation::{EMPTY, SIDE, VEHICLE};
use crate::view::View;
use raypencil_report::{ColourMap, Scale};
use raypencil_rover::{ElevationMap, GridPoint};

/// The local map from above, as large as it is shown: whole maps of a drive would fill the memory.
#[derive(Debug, Clone)]
pub(crate) struct MapPicture {
    /// Row by row from the top.
    cells: Vec<Seen>,
}

/// What is in a cell.
#[derive(Debug, Clone, Copy)]
enum Seen {
    Nothing,
    Vehicle,
    /// Its elevation, metres.
    VisibleSurface(f64),
}

impl MapPicture {
    pub(super) fn of(map: &ElevationMap) -> Self {
        let points = i64::from(map.size().points);
        // Steps from the middle of the map, north on top.
        let step = |at: u32| i64::from(at) * points / i64::from(SIDE) - points / 2;
        let cell = |j: u32, i: u32| {
            let (right, up) = (step(i), step(SIDE - 1 - j));
            if right.abs().max(up.abs()) <= 1 {
                return Seen::Vehicle;
            }
            let point = GridPoint { i: map.centre().i + right, j: map.centre().j + up };
            map.elevation(point).map_or(Seen::Nothing, Seen::VisibleSurface)
        };
        Self { cells: (0..SIDE).flat_map(|j| (0..SIDE).map(move |i| cell(j, i))).collect() }
    }

    pub(crate) fn elevations(&self) -> impl Iterator<Item = f64> {
        self.cells.iter().filter_map(|seen| if let Seen::VisibleSurface(z) = seen { Some(*z) } else { None })
    }

    pub(crate) fn colour(&self, i: u32, j: u32, scale: Scale) -> [u8; 3] {
        match self.cells[(j * SIDE + i) as usize] {
            Seen::Nothing => EMPTY,
            Seen::Vehicle => VEHICLE,
            Seen::VisibleSurface(z) => ColourMap::Sequential.at(scale.fraction(z)),
        }
    }
}

/// One picture of the animation.
#[derive(Debug, Clone)]
pub(crate) struct Picture {
    pub view: View,
    pub map: MapPicture,
}
