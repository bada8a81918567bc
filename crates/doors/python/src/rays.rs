//! Rays from arrays.

use glam::DVec3;
use numpy::{PyReadonlyArray2, PyUntypedArrayMethods};
use raypencil::io::{RayArray, ray_rows};
use raypencil::{CastRay, NamedRaySet, RaySet, Sides};

use crate::array::Arrays;
use crate::failure::Failure;

/// The sides of faces that are hit.
pub(crate) fn sides(fronts_only: bool) -> Sides {
    if fronts_only { Sides::Fronts } else { Sides::Both }
}

/// Rays from an array of (n, 9): origin, direction, `t_min`, `t_max`, `t_blind`.
///
/// # Errors
/// As [`RaySet::new`], for the first ray that is wrong.
pub(crate) fn rays_of(array: &PyReadonlyArray2<'_, f64>, sides: Sides) -> Result<RaySet, Failure> {
    Ok(RaySet::new(unchecked_rays(array)?, sides)?)
}

/// The same of a part of all rays, whose first one has the index `first` in messages.
pub(crate) fn rays_from(array: &PyReadonlyArray2<'_, f64>, first: usize) -> Result<Vec<CastRay>, Failure> {
    let rays = unchecked_rays(array)?;
    rays.iter().enumerate().try_for_each(|(index, ray)| {
        // The name costs time only where it is needed.
        ray.validate("").or_else(|_| ray.validate(&format!("rays[{}]", first + index)))
    })?;
    Ok(rays)
}

fn unchecked_rays(array: &PyReadonlyArray2<'_, f64>) -> Result<Vec<CastRay>, Failure> {
    if array.shape()[1] != 9 {
        return Err(Failure::new(format!("rays are {:?}; expected (n, 9)", array.shape())));
    }
    let view = array.as_array();
    let rays = view.rows().into_iter().map(|row| CastRay {
        origin: DVec3::new(row[0], row[1], row[2]),
        direction: DVec3::new(row[3], row[4], row[5]),
        t_min: row[6],
        t_max: row[7],
        t_blind: row[8],
    });
    Ok(rays.collect())
}

/// A set of rays as arrays.
pub(crate) fn set_arrays(set: &NamedRaySet) -> Arrays {
    let shape: Vec<usize> = set.shape.iter().map(|&side| side as usize).collect();
    let (width, numbers) = ray_rows(set.set.rays());
    let of_rays: Vec<usize> = shape.iter().copied().chain([width]).collect();
    let mut arrays = Arrays::default();
    arrays.add("rays", &of_rays, numbers);
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
