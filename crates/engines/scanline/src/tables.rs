//! Look-up tables: cell centres along the axes of the screen, and |q| of every pixel. (§5: "can, therefore, be fetched
//! from pre-computed tables")

use rayon::prelude::*;
use raypencil_scene::Camera;

/// Cell centres along one axis of the sensor screen, metres on the SPP, ascending.
#[derive(Debug, Clone)]
pub(crate) struct Axis {
    centres: Vec<f64>,
    /// Cells per metre. With `origin_index` it gives the first guess of a search, which the table then corrects.
    cells_per_metre: f64,
    /// Index, in cells, at which the axis has the coordinate 0.
    origin_index: f64,
    /// The screen's two borders, half a cell beyond the outermost centres, metres.
    borders: [f64; 2],
}

impl Axis {
    /// Pixel centres `(i + 1/2 - principal_point) pitch`.
    pub(crate) fn pixels(count: u32, principal_point: f64, pitch: f64) -> Self {
        let centres = (0..count).map(|i| (f64::from(i) + 0.5 - principal_point) * pitch).collect();
        let borders = [-principal_point * pitch, (f64::from(count) - principal_point) * pitch];
        Self { centres, cells_per_metre: 1.0 / pitch, origin_index: principal_point - 0.5, borders }
    }

    /// Column centres of a beam's grid over -w..w: `w (2i + 1 - count) / count`.
    pub(crate) fn grid_columns(count: u32, half_width: f64) -> Self {
        let n = f64::from(count);
        let centres = (0..count).map(|i| half_width * (2.0 * f64::from(i) + 1.0 - n) / n).collect();
        Self {
            centres,
            cells_per_metre: n / (2.0 * half_width),
            origin_index: 0.5 * n - 0.5,
            borders: [-half_width, half_width],
        }
    }

    /// Row centres of a beam's grid over a sheet of thickness T: `T (2j + 1 - count) / (2 count)`.
    pub(crate) fn grid_rows(count: u32, thickness: f64) -> Self {
        let n = f64::from(count);
        let centres = (0..count).map(|j| thickness * (2.0 * f64::from(j) + 1.0 - n) / (2.0 * n)).collect();
        let half = 0.5 * thickness;
        Self { centres, cells_per_metre: n / thickness, origin_index: 0.5 * n - 0.5, borders: [-half, half] }
    }

    pub(crate) fn count(&self) -> u32 {
        self.centres.len() as u32
    }

    #[inline]
    pub(crate) fn centre(&self, index: u32) -> f64 {
        self.centres[index as usize]
    }

    pub(crate) fn centres(&self) -> &[f64] {
        &self.centres
    }

    pub(crate) fn borders(&self) -> [f64; 2] {
        self.borders
    }

    /// The index of `value` in cells, with centres at whole numbers. It is approximate: a first guess.
    #[inline]
    fn approximate_index(&self, value: f64) -> f64 {
        value * self.cells_per_metre + self.origin_index
    }

    /// The first cell whose centre is at or after `value`; the cell count if there is none.
    ///
    /// The comparison is with the centres themselves, so that every face decides in the same way.
    #[inline]
    pub(crate) fn first_at_or_after(&self, value: f64) -> u32 {
        let count = self.count();
        // `as` rounds towards 0, saturates, and takes NaN to 0.
        let mut index = self.approximate_index(value) as u32;
        index = index.min(count);
        while index > 0 && self.centres[index as usize - 1] >= value {
            index -= 1;
        }
        while index < count && self.centres[index as usize] < value {
            index += 1;
        }
        index
    }

    /// One past the last cell whose centre is at or before `value`; 0 if there is none.
    #[inline]
    pub(crate) fn end_at_or_before(&self, value: f64) -> u32 {
        let count = self.count();
        let mut end = (self.approximate_index(value) + 1.0) as u32;
        end = end.min(count);
        while end > 0 && self.centres[end as usize - 1] > value {
            end -= 1;
        }
        while end < count && self.centres[end as usize] <= value {
            end += 1;
        }
        end
    }
}

/// The tables that depend on the camera alone.
#[derive(Debug)]
pub(crate) struct CameraTables {
    camera: Camera,
    pub(crate) x: Axis,
    pub(crate) y: Axis,
    /// |q| of every pixel, row by row, metres. The range is |q| / (1/t).
    pub(crate) q_length: Vec<f64>,
}

impl CameraTables {
    pub(crate) fn new(camera: &Camera) -> Self {
        let x = Axis::pixels(camera.width, camera.principal_point[0], camera.pixel_pitch[0]);
        let y = Axis::pixels(camera.height, camera.principal_point[1], camera.pixel_pitch[1]);
        let f_squared = camera.focal_length * camera.focal_length;
        let mut q_length = vec![0.0; camera.width as usize * camera.height as usize];
        q_length.par_chunks_mut(camera.width as usize).enumerate().for_each(|(j, row)| {
            let y = y.centre(j as u32);
            for (length, x) in row.iter_mut().zip(x.centres()) {
                *length = (x * x + (y * y + f_squared)).sqrt();
            }
        });
        Self { camera: *camera, x, y, q_length }
    }

    /// Whether these are the tables of `camera`.
    pub(crate) fn fit(&self, camera: &Camera) -> bool {
        self.camera == *camera
    }
}

#[cfg(test)]
#[path = "../tests/unit/tables.rs"]
mod tests;
