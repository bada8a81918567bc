//! Points of the stripes against the true ground: the score of a stripe extraction.

use raypencil_rover::MeasuredPoint;
use raypencil_scene::Pose;
use raypencil_terrain::HeightIndex;

/// Heights of measured points above the true ground below them, with the vehicle where it truly is: errors of images and of
/// the stripe extraction alone, not of the vehicle's own position.
///
/// On a wall the height above the ground says little; the share of points that are close is the better number then.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PointErrors {
    /// Number of points with ground below them.
    pub points: u64,
    /// How many of them are less than 1 cm off.
    pub within_1cm: u64,
    /// Number of points beyond the ground.
    pub beyond: u64,
    /// Sum of the squared heights, square metres.
    sum_of_squares: f64,
    /// Largest height, either way, metres.
    pub largest: f64,
}

/// A point that is less than this off the ground is close, metres.
const CLOSE_M: f64 = 0.01;

impl PointErrors {
    /// Adds the points of a frame, with the true pose `global_from_vehicle`.
    pub(crate) fn add(&mut self, measured: &[MeasuredPoint], pose: &Pose, ground: &HeightIndex) {
        for point in measured {
            let place = *pose * point.point;
            let Some(height) = ground.height_at(place.x, place.y) else {
                self.beyond += 1;
                continue;
            };
            let error = (place.z - height).abs();
            self.points += 1;
            self.within_1cm += u64::from(error < CLOSE_M);
            self.sum_of_squares += error * error;
            self.largest = self.largest.max(error);
        }
    }

    /// Root of the mean square, metres; 0 without points.
    pub fn rms(&self) -> f64 {
        (self.sum_of_squares / self.points.max(1) as f64).sqrt()
    }

    /// Share of points that are less than 1 cm off, from 0 to 1; 0 without points.
    pub fn share_within_1cm(&self) -> f64 {
        self.within_1cm as f64 / self.points.max(1) as f64
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use raypencil_rover::EdgePoint;

    use super::*;
    use crate::common::mesh;

    #[test]
    fn heights_are_counted_from_where_the_vehicle_truly_is() {
        // Level ground at z = 1 below x and y of 0 to 10 m; the vehicle stands at (1, 1, 1).
        let corners =
            [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)].map(|(x, y)| DVec3::new(x, y, 1.0));
        let ground = HeightIndex::new(&mesh(&corners, vec![[0, 1, 2], [0, 2, 3]]));
        let pose = Pose::from_position(DVec3::ONE);
        let at = |x: f64, z: f64| MeasuredPoint {
            step: None,
            beam: 0,
            edge: EdgePoint { i: 0, j: 0, row: 0.5 },
            point: DVec3::new(x, 2.0, z),
            standard_error: 0.0,
        };
        let mut errors = PointErrors::default();
        errors.add(&[at(2.0, 0.004), at(3.0, -0.03), at(4.0, 0.0), at(20.0, 0.0)], &pose, &ground);
        assert_eq!((errors.points, errors.within_1cm, errors.beyond), (3, 2, 1));
        assert!((errors.rms() - ((0.004 * 0.004 + 0.03 * 0.03_f64) / 3.0).sqrt()).abs() < 1e-12);
        assert!((errors.largest - 0.03).abs() < 1e-12);
        assert_eq!(PointErrors::default().rms(), 0.0);
    }
}
