//! What the stripes swept: the true ground that was lit by a beam and seen by the camera, and what the sheets passed
//! over without being seen.
//!
//! The rover knows nothing of this. It says why an obstacle was not found: nothing can be found that no stripe reached.

use glam::{DVec2, DVec3};
use raypencil_rover::{ElevationMap, GridPoint, MapSize};
use raypencil_scene::{Beam, Camera, Mounted, RenderOutput, Scene};
use raypencil_terrain::HeightIndex;

/// How the stripes met a point of the ground.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Swept {
    /// It was lit and seen.
    Seen,
    /// A sheet passed over it within its fan and the camera's view, but other ground hid it from beam or camera.
    Hidden,
    /// A sheet passed over it beside its fan, beyond its range or outside the camera's view.
    Outside,
    /// No sheet passed over it.
    Never,
    /// Its cell was lit and seen, but only lower down: a stripe on its way up has not come to its top yet. Of several points of an
    /// obstacle this one is told: it was measured, and too low.
    Lower,
}

#[derive(Debug, Clone, Copy)]
struct Cell {
    /// Index of the cell that is kept here.
    at: GridPoint,
    /// True elevation at the grid point, metres. `None` where the ground ends.
    ground: Option<f64>,
    /// Lowest and highest point that was lit and seen, metres.
    seen: Option<(f64, f64)>,
    passed: bool,
    passed_outside: bool,
    /// Side of each sheet on which the ground was last: bits `beam` (known) and `beam + 16` (above).
    sides: u32,
}

/// Beams whose sides are kept.
const MAX_BEAMS: usize = 16;

/// The ground around the vehicle, cell by cell like the elevation map. It moves with the vehicle.
#[derive(Debug, Clone)]
pub(crate) struct SweptGround {
    /// A map without elevations: the grid alone.
    grid: ElevationMap,
    cells: Vec<Cell>,
}

impl SweptGround {
    /// Nothing is swept yet. `start` is the first grid point, global.
    pub(crate) fn new(size: MapSize, start: DVec2) -> Self {
        let nowhere = GridPoint { i: i64::MAX, j: i64::MAX };
        let cell =
            Cell { at: nowhere, ground: None, seen: None, passed: false, passed_outside: false, sides: 0 };
        let side = size.points as usize;
        Self { grid: ElevationMap::new(size, start), cells: vec![cell; side * side] }
    }

    fn index(&self, at: GridPoint) -> usize {
        let side = i64::from(self.grid.size().points);
        (at.j.rem_euclid(side) * side + at.i.rem_euclid(side)) as usize
    }

    /// Moves with the vehicle to its true place.
    pub(crate) fn recentre(&mut self, place: DVec2, ground: &HeightIndex) {
        self.grid.recentre(place);
        for at in self.grid.points() {
            let index = self.index(at);
            if self.cells[index].at != at {
                let place = self.grid.place(at);
                let ground = ground.height_at(place.x, place.y);
                self.cells[index] =
                    Cell { at, ground, seen: None, passed: false, passed_outside: false, sides: 0 };
            }
        }
    }

    /// Forgets what was swept, as the map does before a scan.
    pub(crate) fn clear(&mut self) {
        for cell in &mut self.cells {
            *cell = Cell { seen: None, passed: false, passed_outside: false, sides: 0, ..*cell };
        }
    }

    /// Adds an exposure: the sheets of `scene`, and the points that they lit. The middle row of each beam stands for its
    /// sheet. Sides are those since the exposure before; `begins` says that the sheets have jumped since.
    pub(crate) fn add(&mut self, scene: &Scene, output: &RenderOutput, begins: bool) {
        let origin = scene.mesh().origin();
        for (index, beam) in scene.beams().iter().enumerate().take(MAX_BEAMS) {
            self.pass(scene.camera(), beam, index as u32, origin, begins);
            let (Some(map), Some(returns)) = (output.beams.get(index), output.returns.get(index)) else {
                continue;
            };
            let (Some(points), Some(visible)) = (&map.point, &returns.visible) else { continue };
            let middle = points.height() / 2;
            for i in 0..points.width() {
                if let (Some(point), true) = (points.at(i, middle).get(), visible.at(i, middle)) {
                    self.see(point + origin);
                }
            }
        }
    }

    /// Adds a point that was lit and seen, global, metres.
    pub(crate) fn see(&mut self, point: DVec3) {
        let at = self.grid.nearest(point.truncate());
        let index = self.index(at);
        let cell = &mut self.cells[index];
        if cell.at == at {
            let (low, high) = cell.seen.unwrap_or((point.z, point.z));
            cell.seen = Some((low.min(point.z), high.max(point.z)));
        }
    }

    /// Marks the cells whose ground has changed sides of a sheet.
    fn pass(
        &mut self,
        camera: &Mounted<Camera>,
        beam: &Mounted<Beam>,
        index: u32,
        origin: DVec3,
        begins: bool,
    ) {
        let beam_from_scene = beam.scene_from_sensor.inverse();
        let camera_from_scene = camera.scene_from_sensor.inverse();
        let spacing = self.grid.size().spacing;
        let start = self.grid.place(GridPoint { i: 0, j: 0 });
        for cell in &mut self.cells {
            let Some(z) = cell.ground else { continue };
            let place = start + DVec2::new(cell.at.i as f64, cell.at.j as f64) * spacing;
            let point = place.extend(z) - origin;
            // In the beam's frame y points to the sheet's lower side.
            let at = beam_from_scene * point;
            let (known, above) = (1 << index, 1 << (index + MAX_BEAMS as u32));
            let was_known = cell.sides & known != 0 && !begins;
            let changed = was_known && (cell.sides & above != 0) != (at.y > 0.0);
            cell.sides = (cell.sides & !above) | known | if at.y > 0.0 { above } else { 0 };
            if !changed || at.z <= 0.0 {
                continue;
            }
            let Beam { grid_distance, half_width, max_range, .. } = beam.sensor;
            let in_fan = at.x.abs() <= at.z * half_width / grid_distance && at.length() <= max_range;
            if in_fan && in_view(&camera.sensor, camera_from_scene * point) {
                cell.passed = true;
            } else {
                cell.passed_outside = true;
            }
        }
    }

    /// How the stripes met a point of the true ground (global, metres).
    ///
    /// It counts as seen if, in its cell or one beside it, something at most half a spacing lower was seen: the top of a
    /// wall needs a stripe near its top.
    pub(crate) fn at(&self, point: DVec3) -> Swept {
        let middle = self.grid.nearest(point.truncate());
        let tolerance = 0.5 * self.grid.size().spacing;
        let mut own = Swept::Never;
        for (i, j) in (-1..=1).flat_map(|j| (-1..=1).map(move |i| (i, j))) {
            let at = GridPoint { i: middle.i + i, j: middle.j + j };
            let cell = &self.cells[self.index(at)];
            if cell.at != at {
                continue;
            }
            if cell.seen.is_some_and(|(low, high)| low <= point.z + tolerance && high >= point.z - tolerance)
            {
                return Swept::Seen;
            }
            if (i, j) == (0, 0) {
                own = match cell {
                    Cell { seen: Some((_, high)), .. } if *high < point.z => Swept::Lower,
                    // A stripe on its way down has not come to the foot yet.
                    Cell { seen: Some(_), .. } => Swept::Never,
                    Cell { passed: true, .. } => Swept::Hidden,
                    Cell { passed_outside: true, .. } => Swept::Outside,
                    _ => Swept::Never,
                };
            }
        }
        own
    }
}

/// Whether the camera's image holds a point of its frame.
fn in_view(camera: &Camera, point: DVec3) -> bool {
    let Camera { focal_length, pixel_pitch, principal_point, width, height, max_range, .. } = *camera;
    if point.z <= focal_length || point.length() > max_range {
        return false;
    }
    let at = |offset: f64, axis: usize| {
        principal_point[axis] + focal_length * offset / point.z / pixel_pitch[axis]
    };
    (0.0..f64::from(width)).contains(&at(point.x, 0)) && (0.0..f64::from(height)).contains(&at(point.y, 1))
}
