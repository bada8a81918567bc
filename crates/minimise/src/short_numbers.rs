//! Shorter numbers: a frame that makes them so, then each in as few binary digits as still show it.

use glam::{DQuat, DVec3, Vec3};

use crate::draft::Draft;
use crate::trials::Trials;
use raypencil_scene::Pose;

/// Significant binary digits to try, the fewest first.
const DIGITS: [u32; 11] = [1, 2, 3, 4, 5, 6, 8, 10, 13, 17, 22];

/// Binary places to try for all vertices at once, whole metres first.
const PLACES: [i32; 9] = [0, 1, 2, 3, 4, 6, 8, 11, 15];

/// Binary places of a quaternion whose largest entry is 1.
const QUATERNION_PLACES: [i32; 8] = [0, 1, 2, 3, 4, 6, 9, 13];

/// With more vertices than that they are rounded all at once only.
const FEW_VERTICES: usize = 24;

pub(super) fn shortest(trials: &mut Trials<'_>) {
    trials.stage("shorter numbers");
    plainer_frame(trials);
    poses(trials);
    vertices_together(trials);
    for number in of_rig(trials.best()) {
        round(trials, &number);
    }
    for number in of_vertices(trials.best()) {
        round(trials, &number);
    }
}

/// Moves the scene so that the sensor in question stands at the origin and looks along z, or at least stands there.
/// Everything is rounded on the way: it is a proposal like any other.
fn plainer_frame(trials: &mut Trials<'_>) {
    let pose = trials.best().pose();
    let moves = [pose.inverse(), Pose::from_position(-pose.position)];
    trials.plainest_of(moves, |draft, new_from_old| {
        let moved =
            |_: usize, at: [f32; 3]| (new_from_old * Vec3::from_array(at).as_dvec3()).as_vec3().to_array();
        let mut draft = draft.with_vertices(moved)?;
        let own = draft.pose();
        for pose in draft.poses_mut() {
            // What is the identity is to be it to the last bit.
            *pose = match *pose == own && new_from_old != Pose::from_position(-own.position) {
                true => Pose::IDENTITY,
                false => new_from_old * *pose,
            };
        }
        Some(draft)
    });
}

fn poses(trials: &mut Trials<'_>) {
    for index in 0..1 + trials.best().beams.len() {
        let rotation =
            |draft: &Draft| draft.clone().poses_mut().nth(index).map(|pose| pose.rotation.to_array());
        let Some(entries) = rotation(trials.best()) else { continue };
        let largest = entries.iter().fold(0.0_f64, |largest, entry| largest.max(entry.abs()));
        trials.plainest_of(QUATERNION_PLACES, |draft, places| {
            let mut draft = draft.clone();
            let rounded = entries.map(|entry| at_places(entry / largest, places));
            draft.poses_mut().nth(index)?.rotation = DQuat::from_array(rounded);
            Some(draft)
        });
        trials.plainest_of(PLACES, |draft, places| {
            let mut draft = draft.clone();
            let position = &mut draft.poses_mut().nth(index)?.position;
            *position = DVec3::from_array(position.to_array().map(|x| at_places(x, places)));
            Some(draft)
        });
    }
}

fn vertices_together(trials: &mut Trials<'_>) {
    trials.plainest_of(PLACES, |draft, places| {
        draft.with_vertices(|_, at| at.map(|x| at_places(f64::from(x), places) as f32))
    });
}

/// A draft with another number in its place; `None` if that is none.
type Replace = dyn Fn(&Draft, f64) -> Option<Draft>;

/// One number of a draft, to be replaced.
struct Number {
    get: Box<dyn Fn(&Draft) -> f64>,
    set: Box<Replace>,
    /// What it is a multiple of, if that is to be short instead: of a grid's extent the number of cells, so that a
    /// cell's size is.
    unit: f64,
}

/// Tries 0, then ever more digits.
fn round(trials: &mut Trials<'_>, number: &Number) {
    let value = (number.get)(trials.best());
    let shorter = DIGITS.map(|digits| significant(value / number.unit, digits) * number.unit);
    let candidates = std::iter::once(0.0).chain(shorter);
    trials.plainest_of(candidates, |draft, value| (number.set)(draft, value));
}

/// The numbers of sensors and their poses.
fn of_rig(draft: &Draft) -> Vec<Number> {
    fn number(field: impl Fn(&mut Draft) -> &mut f64 + Clone + 'static, unit: f64) -> Number {
        let read = field.clone();
        Number {
            get: Box::new(move |draft| *read(&mut draft.clone())),
            set: Box::new(move |draft, value| {
                let mut draft = draft.clone();
                *field(&mut draft) = value;
                Some(draft)
            }),
            unit,
        }
    }
    let mut all = vec![
        number(|draft| &mut draft.camera.sensor.focal_length, 1.0),
        number(|draft| &mut draft.camera.sensor.aperture, 1.0),
        number(|draft| &mut draft.camera.sensor.max_range, 1.0),
    ];
    for axis in 0..2 {
        all.push(number(move |draft| &mut draft.camera.sensor.pixel_pitch[axis], 1.0));
        all.push(number(move |draft| &mut draft.camera.sensor.principal_point[axis], 1.0));
    }
    for axis in 0..3 {
        all.push(number(move |draft| &mut draft.camera.scene_from_sensor.position[axis], 1.0));
    }
    for (index, beam) in draft.beams.iter().enumerate() {
        let (columns, rows) = (f64::from(beam.sensor.columns), f64::from(beam.sensor.rows));
        all.push(number(move |draft| &mut draft.beams[index].sensor.grid_distance, 1.0));
        all.push(number(move |draft| &mut draft.beams[index].sensor.half_width, columns));
        all.push(number(move |draft| &mut draft.beams[index].sensor.thickness, rows));
        all.push(number(move |draft| &mut draft.beams[index].sensor.max_range, 1.0));
        for axis in 0..3 {
            all.push(number(move |draft| &mut draft.beams[index].scene_from_sensor.position[axis], 1.0));
        }
    }
    all
}

/// The coordinates of vertices, if they are few.
fn of_vertices(draft: &Draft) -> Vec<Number> {
    let count = draft.mesh.vertices().len();
    let coordinates = (0..count).flat_map(|vertex| (0..3).map(move |axis| (vertex, axis)));
    let number = |(vertex, axis): (usize, usize)| Number {
        get: Box::new(move |draft| f64::from(draft.mesh.vertices()[vertex][axis])),
        set: Box::new(move |draft, value| {
            draft.with_vertices(|index, mut at| {
                if index == vertex {
                    at[axis] = value as f32;
                }
                at
            })
        }),
        unit: 1.0,
    };
    if count <= FEW_VERTICES { coordinates.map(number).collect() } else { Vec::new() }
}

/// `x` in so many significant binary digits, 1 to 52, halves away from 0.
fn significant(x: f64, digits: u32) -> f64 {
    let dropped = 53 - digits;
    // The carry of a mantissa of all ones goes where it belongs, into the exponent.
    f64::from_bits((x.to_bits() + (1 << (dropped - 1))) >> dropped << dropped)
}

/// `x` as a whole multiple of 2^-places, halves away from 0.
fn at_places(x: f64, places: i32) -> f64 {
    let unit = libm::ldexp(1.0, -places);
    // -0 is no plainer than 0.
    (x / unit).round() * unit + 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_rounded_to_the_nearest_with_so_many_digits() {
        // 0.7 = 0.1011001...b
        assert_eq!([1, 2, 3, 4].map(|digits| significant(0.7, digits)), [0.5, 0.75, 0.75, 0.6875]);
        // 0.1111b: the carry doubles it.
        assert_eq!(significant(-0.9375, 3), -1.0);
        assert_eq!(significant(0.0, 1), 0.0);
        assert_eq!([0, 1, 2].map(|places| at_places(-0.7, places)), [-1.0, -0.5, -0.75]);
        assert!(at_places(-0.2, 0).is_sign_positive());
    }
}
