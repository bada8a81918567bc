//! Both margins of a ray in one call: how far its verdict and its surface are from changing.

use raypencil_scene::SensorId;

use crate::hits::neighbourhood::Neighbourhood;
use crate::hits::verdict::{Referee, Verdict};
use crate::margins::face::face_margin;
use crate::margins::margin::{Margin, Margins};
use crate::rays::ray::{Aim, MountedSensor};

impl Referee<'_> {
    /// Both margins of cell (i, j); `None` if there is no such cell.
    ///
    /// ```
    /// # mod wall { include!(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/common/wall.rs")); }
    /// # use wall::wall_scene;
    /// use raypencil_referee::Referee;
    /// use raypencil_scene::SensorId;
    ///
    /// let scene = wall_scene();
    /// let margins = Referee::new(&scene).margins(SensorId::Camera, 4, 4).unwrap();
    /// // The wall ends 1/8 m to the right of the hit, and a pixel is 1/4 m wide there: half a cell.
    /// assert!(margins.face.lo <= 0.5 && 0.5 <= margins.face.hi);
    /// // The witness is a ray beyond the wall's side.
    /// assert!(margins.face.witness.unwrap().dx > 0.5);
    /// // There the surface ends as well.
    /// assert!(margins.surface.lo <= 0.5 && 0.5 <= margins.surface.hi);
    /// ```
    pub fn margins(&self, sensor: SensorId, i: u32, j: u32) -> Option<Margins> {
        self.verdict_with_margins(sensor, i, j).map(|(_, margins)| margins)
    }

    /// The verdict on cell (i, j) and both of its margins; `None` if there is no such cell. Faster than three separate calls.
    pub fn verdict_with_margins(&self, sensor: SensorId, i: u32, j: u32) -> Option<(Verdict, Margins)> {
        let (sensor, aim) = self.sensor_and_aim(sensor, i, j)?;
        let (mut near, nearest, face) = self.with_face_margin(&sensor, aim);
        let verdict = Verdict { faces: nearest.iter().map(|&index| near.faces[index].face.id).collect() };
        let surface = near.surface_margin(&nearest, &face);
        Some((verdict, Margins { face, surface }))
    }

    /// The margin of the set of nearest faces of cell (i, j); `None` if there is no such cell.
    pub fn face_margin(&self, sensor: SensorId, i: u32, j: u32) -> Option<Margin> {
        let (sensor, aim) = self.sensor_and_aim(sensor, i, j)?;
        Some(self.with_face_margin(&sensor, aim).2)
    }

    /// The margin of the surface of cell (i, j); `None` if there is no such cell.
    pub fn surface_margin(&self, sensor: SensorId, i: u32, j: u32) -> Option<Margin> {
        self.margins(sensor, i, j).map(|margins| margins.surface)
    }

    /// The start of every margin: the neighbourhood, the nearest faces in it, and their margin.
    fn with_face_margin<'a>(
        &'a self,
        sensor: &'a MountedSensor,
        aim: Aim,
    ) -> (Neighbourhood<'a>, Vec<usize>, Margin) {
        let mut near = Neighbourhood::new(self, sensor, aim);
        let nearest = near.nearest_at([0.0; 2]);
        if let Some(&first) = nearest.first() {
            near.extend_to(near.faces[first].farthest);
        }
        let face = face_margin(&near, &nearest);
        (near, nearest, face)
    }
}
