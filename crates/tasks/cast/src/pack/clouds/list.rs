//! Mistakes in a list, and what undoes most of them: points that are moved, or laid on other rays.

use glam::DVec3;
use raypencil_scene::{CastRay, Pose};

use crate::pack::mistakes::{Extra, Group};
use crate::pack::scan::{Scan, moved};
use crate::pack::trial::{CloudPart, Trial};

/// Mistakes, one after the other.
pub(super) struct List<'a> {
    pub(super) extras: Vec<Extra<'a>>,
}

impl<'a> List<'a> {
    fn push(&mut self, words: String, (is_common, group): (bool, Group), undo: impl Fn(&mut Trial) + 'a) {
        self.extras.push(Extra { words, undo: Box::new(undo), is_common, group });
    }

    pub(super) fn add(&mut self, words: impl Into<String>, is_common: bool, undo: impl Fn(&mut Trial) + 'a) {
        self.push(words.into(), (is_common, Group::Others), undo);
    }

    /// A mistake of lengths by a factor.
    pub(super) fn add_factor(
        &mut self,
        words: impl Into<String>,
        is_common: bool,
        undo: impl Fn(&mut Trial) + 'a,
    ) {
        self.push(words.into(), (is_common, Group::Factors), undo);
    }

    /// A mistake about the rays: `head` gives the ray in the pattern's frame that was fired in place of the asked one.
    pub(super) fn add_ray(
        &mut self,
        words: impl Into<String>,
        is_common: bool,
        scan: &'a Scan,
        head: impl Fn(usize, CastRay) -> CastRay + 'a,
    ) {
        self.add(words, is_common, move |trial| {
            for (&index, ray) in trial.indices.iter().zip(&mut trial.rays) {
                let pose = scan.pose(index);
                *ray = moved(&pose, &head(index, moved(&pose.inverse(), ray)));
            }
        });
    }
}

/// The points as the file has them.
pub(super) fn parts(trial: &mut Trial) -> &mut [DVec3] {
    trial.cloud.as_mut().map_or(&mut [], |cloud| &mut cloud.raw)
}

/// Puts other points of the file on the rays.
pub(super) fn laid(trial: &mut Trial, part: &CloudPart) {
    let Some(cloud) = &mut trial.cloud else { return };
    for (k, &index) in trial.indices.iter().enumerate() {
        (cloud.raw[k], cloud.error[k]) = (part.raw[index], part.error[index]);
    }
}

pub(super) fn scaled(trial: &mut Trial, factor: f64) {
    if let Some(cloud) = &mut trial.cloud {
        cloud.raw.iter_mut().for_each(|point| *point *= factor);
        cloud.error.iter_mut().for_each(|error| *error *= factor);
    }
    trial.stated.range.iter_mut().flatten().for_each(|range| *range *= factor);
    trial.stated.stored.range.iter_mut().flatten().for_each(|error| *error *= factor);
}

/// Moves each point along its ray: `length` gives the right distance from the ray's origin, by the ray and the one that is stated.
pub(super) fn along(trial: &mut Trial, length: impl Fn(usize, &CastRay, f64) -> f64) {
    along_of(trial, |_| true, length);
}

/// The same of those whose place in the trial `is_of` names.
pub(super) fn along_of(
    trial: &mut Trial,
    is_of: impl Fn(usize) -> bool,
    length: impl Fn(usize, &CastRay, f64) -> f64,
) {
    let Some(cloud) = &mut trial.cloud else { return };
    let all = trial.indices.iter().zip(&trial.rays).enumerate();
    for (k, (&index, ray)) in all.filter(|(k, _)| is_of(*k)) {
        let (point, _) = cloud.point(k);
        let from = point - ray.origin;
        let stated = from.length();
        let factor = length(index, ray, stated) / stated;
        let point = ray.origin + from * factor;
        // What storing did grows with the length.
        cloud.error[k] *= factor.abs().max(1.0);
        cloud.raw[k] = cloud.pose[k].map_or(point, |pose| pose.inverse() * point);
    }
}

pub(super) fn set_poses(trial: &mut Trial, pose: impl Fn(usize) -> Option<Pose>) {
    if let Some(cloud) = &mut trial.cloud {
        cloud.pose = trial.indices.iter().map(|&index| pose(index)).collect();
    }
}
