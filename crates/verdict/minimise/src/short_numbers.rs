//! Shorter numbers: a simpler frame of axes, then each number in as few binary digits as keep the scene interesting.

use glam::{DQuat, DVec3, Vec3};
use raypencil_scene::Pose;

use crate::reducer::Reducer;
use crate::reduction::Reduction;

/// Numbers of significant binary digits to try, the fewest first.
const SIGNIFICANT_DIGITS: [u32; 11] = [1, 2, 3, 4, 5, 6, 8, 10, 13, 17, 22];

/// Numbers of binary places of metres to try, for positions and for all vertices together. 0 places are whole metres.
const LENGTH_PLACES: [i32; 9] = [0, 1, 2, 3, 4, 6, 8, 11, 15];

/// Numbers of binary places to try for a quaternion whose largest entry is 1.
const QUATERNION_PLACES: [i32; 8] = [0, 1, 2, 3, 4, 6, 9, 13];

/// Maximum number of vertices that are rounded one by one; more are only rounded together.
const MAX_SINGLE_VERTICES: usize = 24;

/// Shortens all numbers of rig and vertices.
pub(super) fn shorten_numbers(reducer: &mut Reducer<'_>) {
    reducer.stage("shorter numbers");
    simplify_frame(reducer);
    shorten_poses(reducer);
    shorten_vertices_together(reducer);
    for number in rig_numbers(reducer.best()) {
        shorten_number(reducer, &number);
    }
    for number in vertex_numbers(reducer.best()) {
        shorten_number(reducer, &number);
    }
}

/// Moves the scene so that the sensor in question is at the origin and looks along z, or at least is at the origin. The
/// move rounds all vertices, so it must pass the test like any other change.
fn simplify_frame(reducer: &mut Reducer<'_>) {
    let pose = reducer.best().pose();
    let moves = [pose.inverse(), Pose::from_position(-pose.position)];
    reducer.accept_simplest(moves, |reduction, new_from_old| {
        let moved =
            |_: usize, at: [f32; 3]| (new_from_old * Vec3::from_array(at).as_dvec3()).as_vec3().to_array();
        let mut reduction = reduction.with_vertices(moved)?;
        let moved_pose = reduction.pose();
        for pose in reduction.poses_mut() {
            // The sensor's own pose becomes the identity exactly, without rounding errors.
            *pose = match *pose == moved_pose && new_from_old != Pose::from_position(-moved_pose.position) {
                true => Pose::IDENTITY,
                false => new_from_old * *pose,
            };
        }
        Some(reduction)
    });
}

fn shorten_poses(reducer: &mut Reducer<'_>) {
    for index in 0..1 + reducer.best().beams.len() {
        let rotation = |reduction: &Reduction| {
            reduction.clone().poses_mut().nth(index).map(|pose| pose.rotation.to_array())
        };
        let Some(entries) = rotation(reducer.best()) else { continue };
        let largest = entries.iter().fold(0.0_f64, |largest, entry| largest.max(entry.abs()));
        reducer.accept_simplest(QUATERNION_PLACES, |reduction, places| {
            let mut reduction = reduction.clone();
            let rounded = entries.map(|entry| round_to_places(entry / largest, places));
            reduction.poses_mut().nth(index)?.rotation = DQuat::from_array(rounded);
            Some(reduction)
        });
        reducer.accept_simplest(LENGTH_PLACES, |reduction, places| {
            let mut reduction = reduction.clone();
            let position = &mut reduction.poses_mut().nth(index)?.position;
            *position = DVec3::from_array(position.to_array().map(|x| round_to_places(x, places)));
            Some(reduction)
        });
    }
}

fn shorten_vertices_together(reducer: &mut Reducer<'_>) {
    reducer.accept_simplest(LENGTH_PLACES, |reduction, places| {
        reduction.with_vertices(|_, at| at.map(|x| round_to_places(f64::from(x), places) as f32))
    });
}

/// A copy of a reduction with another value of a number. `None`: the copy is invalid.
type SetNumber = dyn Fn(&Reduction, f64) -> Option<Reduction>;

/// A number of a reduction.
struct Number {
    get: Box<dyn Fn(&Reduction) -> f64>,
    set: Box<SetNumber>,
    /// The search shortens the number divided by `unit`. For the extent of a grid it is the number of cells, so that
    /// the size of a cell becomes short. For other numbers it is 1.
    unit: f64,
}

/// Tries 0, then more and more digits.
fn shorten_number(reducer: &mut Reducer<'_>, number: &Number) {
    let value = (number.get)(reducer.best());
    let shorter = SIGNIFICANT_DIGITS.map(|digits| round_to_digits(value / number.unit, digits) * number.unit);
    let values = std::iter::once(0.0).chain(shorter);
    reducer.accept_simplest(values, |reduction, value| (number.set)(reduction, value));
}

/// The numbers of sensors and their poses.
fn rig_numbers(reduction: &Reduction) -> Vec<Number> {
    fn number(field: impl Fn(&mut Reduction) -> &mut f64 + Clone + 'static, unit: f64) -> Number {
        let read = field.clone();
        Number {
            get: Box::new(move |reduction| *read(&mut reduction.clone())),
            set: Box::new(move |reduction, value| {
                let mut reduction = reduction.clone();
                *field(&mut reduction) = value;
                Some(reduction)
            }),
            unit,
        }
    }
    let mut all = vec![
        number(|reduction| &mut reduction.camera.sensor.focal_length, 1.0),
        number(|reduction| &mut reduction.camera.sensor.aperture, 1.0),
        number(|reduction| &mut reduction.camera.sensor.max_range, 1.0),
    ];
    for axis in 0..2 {
        all.push(number(move |reduction| &mut reduction.camera.sensor.pixel_pitch[axis], 1.0));
        all.push(number(move |reduction| &mut reduction.camera.sensor.principal_point[axis], 1.0));
    }
    for axis in 0..3 {
        all.push(number(move |reduction| &mut reduction.camera.scene_from_sensor.position[axis], 1.0));
    }
    for (index, beam) in reduction.beams.iter().enumerate() {
        let (columns, rows) = (f64::from(beam.sensor.columns), f64::from(beam.sensor.rows));
        all.push(number(move |reduction| &mut reduction.beams[index].sensor.grid_distance, 1.0));
        all.push(number(move |reduction| &mut reduction.beams[index].sensor.half_width, columns));
        all.push(number(move |reduction| &mut reduction.beams[index].sensor.thickness, rows));
        all.push(number(move |reduction| &mut reduction.beams[index].sensor.max_range, 1.0));
        for axis in 0..3 {
            all.push(number(
                move |reduction| &mut reduction.beams[index].scene_from_sensor.position[axis],
                1.0,
            ));
        }
    }
    all
}

/// The coordinates of all vertices; none if there are more than [`MAX_SINGLE_VERTICES`] vertices.
fn vertex_numbers(reduction: &Reduction) -> Vec<Number> {
    let count = reduction.mesh.vertices().len();
    let coordinates = (0..count).flat_map(|vertex| (0..3).map(move |axis| (vertex, axis)));
    let number = |(vertex, axis): (usize, usize)| Number {
        get: Box::new(move |reduction| f64::from(reduction.mesh.vertices()[vertex][axis])),
        set: Box::new(move |reduction, value| {
            reduction.with_vertices(|index, mut at| {
                if index == vertex {
                    at[axis] = value as f32;
                }
                at
            })
        }),
        unit: 1.0,
    };
    if count <= MAX_SINGLE_VERTICES { coordinates.map(number).collect() } else { Vec::new() }
}

/// `x` rounded to `digits` significant binary digits, 1 to 52; halves are rounded away from 0.
fn round_to_digits(x: f64, digits: u32) -> f64 {
    let dropped = 53 - digits;
    // A carry out of the mantissa increments the exponent, as it should.
    f64::from_bits((x.to_bits() + (1 << (dropped - 1))) >> dropped << dropped)
}

/// `x` rounded to a multiple of 2^-places; halves are rounded away from 0.
fn round_to_places(x: f64, places: i32) -> f64 {
    let unit = libm::ldexp(1.0, -places);
    // Adding 0 turns -0 into 0.
    (x / unit).round() * unit + 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_rounded_to_the_nearest_with_so_many_digits() {
        // 0.7 = 0.1011001...b
        assert_eq!([1, 2, 3, 4].map(|digits| round_to_digits(0.7, digits)), [0.5, 0.75, 0.75, 0.6875]);
        // 0.1111b: the carry doubles it.
        assert_eq!(round_to_digits(-0.9375, 3), -1.0);
        assert_eq!(round_to_digits(0.0, 1), 0.0);
        assert_eq!([0, 1, 2].map(|places| round_to_places(-0.7, places)), [-1.0, -0.5, -0.75]);
        assert!(round_to_places(-0.2, 0).is_sign_positive());
    }
}
