//! Rays from arrays.

use glam::DVec3;
use numpy::{PyReadonlyArray2, PyUntypedArrayMethods};
use raypencil::io::RayArray;
use raypencil::{CastRay, NamedRaySet, RaySet, Sides};

use crate::array::Arrays;
use crate::failure::Failure;

/// The sides of faces that are hit.
pub(crate) fn sides(fronts_only: bool) -> Sides {
    if fronts_only { Sides::Fronts } else { Sides::Both }
}

/// Rays from an array of (n, 8): origin, direction, `t_min`, `t_max`.
///
/// # Errors
/// As [`RaySet::new`], for the first ray that is wrong.
pub(crate) fn rays_of(array: &PyReadonlyArray2<'_, f64>, sides: Sides) -> Result<RaySet, Failure> {
    if array.shape()[1] != 8 {
        return Err(Failure::new(format!("rays are {:?}; expected (n, 8)", array.shape())));
    }
    let view = array.as_array();
    let rays = view.rows().into_iter().map(|row| CastRay {
        origin: DVec3::new(row[0], row[1], row[2]),
        direction: DVec3::new(row[3], row[4], row[5]),
        t_min: row[6],
        t_max: row[7],
    });
    Ok(RaySet::new(rays.collect(), sides)?)
}

/// The numbers of rays, eight each.
fn numbers(rays: &[CastRay]) -> Vec<f64> {
    let eight = |ray: &CastRay| {
        let ([ox, oy, oz], [dx, dy, dz]) = (ray.origin.to_array(), ray.direction.to_array());
        [ox, oy, oz, dx, dy, dz, ray.t_min, ray.t_max]
    };
    rays.iter().flat_map(eight).collect()
}

/// A set of rays as arrays.
pub(crate) fn set_arrays(set: &NamedRaySet) -> Arrays {
    let shape: Vec<usize> = set.shape.iter().map(|&side| side as usize).collect();
    let of_eight: Vec<usize> = shape.iter().copied().chain([8]).collect();
    let mut arrays = Arrays::default();
    arrays.add("rays", &of_eight, numbers(set.set.rays()));
    if let Some(times) = &set.times {
        arrays.add("times", &shape, times.clone());
    }
    if let Some(weights) = &set.weights {
        arrays.add("weights", &[weights.len()], weights.clone());
    }
    if let Some(elevations) = &set.elevations_deg {
        arrays.add("elevations_deg", &[elevations.len()], elevations.clone());
    }
    arrays
}

/// Rays with the shape that people gave them.
pub(crate) fn shaped(set: RaySet, shape: &[u64]) -> RayArray {
    RayArray { shape: shape.to_vec(), rays: set.rays().to_vec() }
}
