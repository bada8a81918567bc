//! `[[rays]]`: named sets of rays, from files and from patterns of range sensors.

mod angles;
mod cone;
mod grid;
mod mount;
mod pattern;
mod spinning;
mod times;

use serde::Deserialize;
use std::collections::BTreeSet;
use toml::Spanned;

use raypencil_files::part_of_memory;
use raypencil_scene::pattern::MAX_RAYS;
use raypencil_scene::{NamedRaySet, SceneError, Sides};

use crate::digest::NamedDigest;
use crate::parse::key::Key;
use crate::parse::rays::cone::ConeKeys;
use crate::parse::rays::mount::{BagKeys, OnePose, TimedPoseKeys};
use crate::parse::rays::pattern::{Pattern, PatternKeys};
use crate::parse::source::Source;
use crate::scene_error::SceneIoError;

/// Maximum number of sets.
const MAX_SETS: usize = 1000;

/// Memory of a ray as it is made: where it starts, where it goes, its limits and its time, bytes.
const BYTES_OF_RAY: u64 = 96;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RaysKeys {
    name: Key<String>,
    file: Key<String>,
    times_file: Key<String>,
    spinning: Key<spinning::SpinningKeys>,
    grid: Key<grid::GridKeys>,
    angles: Key<angles::AnglesKeys>,
    cone: Key<ConeKeys>,
    sides: Key<String>,
    start_s: Key<f64>,
    position_m: Key<Vec<f64>>,
    pitch_down_deg: Key<f64>,
    yaw_left_deg: Key<f64>,
    roll_right_deg: Key<f64>,
    poses: Key<Vec<Spanned<TimedPoseKeys>>>,
    poses_file: Key<String>,
    poses_topic: Key<String>,
    poses_frames: Key<Vec<String>>,
}

impl Source<'_> {
    /// The sets of all tables `[[rays]]`, and the digests of the files that they name, in their order.
    pub(crate) fn ray_sets(
        &self,
        tables: &[Spanned<RaysKeys>],
    ) -> Result<(Vec<NamedRaySet>, Vec<NamedDigest>), SceneIoError> {
        if let Some(table) = tables.get(MAX_SETS) {
            let message = format!("there are {} sets of rays; expected at most {MAX_SETS}", tables.len());
            return Err(self.error(table.span(), message));
        }
        let (mut names, mut digests) = (BTreeSet::new(), Vec::new());
        for (index, table) in tables.iter().enumerate() {
            let name = self.set_name(index, table)?;
            if !names.insert(name.get_ref()) {
                let message = format!(
                    "`rays {index}.name` is {:?}, the name of another set; expected a name of its own",
                    name.get_ref()
                );
                return Err(self.error(name.span(), message));
            }
        }
        let (mut sets, mut before) = (Vec::new(), 0_u64);
        for (index, table) in tables.iter().enumerate() {
            let pattern = self.pattern_of(index, table, &mut digests)?;
            // Nothing of this pattern was allocated yet.
            let count = pattern.count();
            if count > MAX_RAYS - before {
                let with = match before {
                    0 => String::new(),
                    _ => format!(", {} with those before it", before.saturating_add(count)),
                };
                let message =
                    format!("`rays {index}` has {count} rays{with}; expected at most {MAX_RAYS} in all sets");
                return Err(self.error(table.span(), message));
            }
            let needed = before.saturating_add(count).saturating_mul(BYTES_OF_RAY);
            let memory = part_of_memory(1);
            if needed > memory {
                let message = format!(
                    "`rays {index}` has {count} rays, which take about {needed} bytes with those before them; expected at \
                     most {memory}, the memory that there is (--max-memory)"
                );
                return Err(self.error(table.span(), message));
            }
            before += count;
            sets.push(self.ray_set(index, table, pattern, &mut digests)?);
        }
        Ok((sets, digests))
    }

    fn set_name<'k>(
        &self,
        index: usize,
        table: &'k Spanned<RaysKeys>,
    ) -> Result<&'k Spanned<String>, SceneIoError> {
        let Some(name) = &table.get_ref().name else {
            let message = format!("`rays {index}.name` is missing; expected a name for the set");
            return Err(self.error(table.span(), message));
        };
        NamedRaySet::check_name(name.get_ref()).map_err(|SceneError { value, expected, .. }| {
            self.error(name.span(), format!("`rays {index}.name` is {value}; expected {expected}"))
        })?;
        Ok(name)
    }

    fn pattern_of(
        &self,
        index: usize,
        table: &Spanned<RaysKeys>,
        digests: &mut Vec<NamedDigest>,
    ) -> Result<Pattern, SceneIoError> {
        let name = format!("rays {index}");
        let keys = table.get_ref();
        let inner = PatternKeys {
            file: &keys.file,
            spinning: &keys.spinning,
            grid: &keys.grid,
            angles: &keys.angles,
        };
        self.pattern((&name, table.span()), inner, Some(&keys.cone), digests)
    }

    fn ray_set(
        &self,
        index: usize,
        table: &Spanned<RaysKeys>,
        pattern: Pattern,
        digests: &mut Vec<NamedDigest>,
    ) -> Result<NamedRaySet, SceneIoError> {
        let keys = table.get_ref();
        let name = format!("rays {index}");
        let mut sides = Sides::Both;
        let words = [("both", Sides::Both), ("fronts", Sides::Fronts)];
        self.choice(&keys.sides, &format!("{name}.sides"), &mut sides, &words)?;
        let pose =
            OnePose::new(&keys.position_m, [&keys.yaw_left_deg, &keys.pitch_down_deg, &keys.roll_right_deg]);
        let choice = BagKeys { topic: &keys.poses_topic, frames: &keys.poses_frames };
        let mounting = match &keys.poses_file {
            Some(file) => self.mounting_of_file(&name, &pose, (&keys.poses, file), choice, digests)?,
            None => {
                self.without_bag(&name, choice)?;
                self.mounting(&name, &pose, &keys.poses)?
            }
        };
        let start = self.start(&name, &keys.start_s)?;
        let refused = |error| self.refused(table.span(), &error);
        let mut rays = pattern.rays(&name).map_err(refused)?;
        if let Some(file) = &keys.times_file {
            rays.times = Some(self.times(&name, &keys.file, file, &rays.shape, digests)?);
        }
        if let Some(start) = start {
            rays = rays.starting_at(start);
        }
        let rays = mounting.place(rays, &name).map_err(refused)?;
        let set = self.set_name(index, table)?;
        NamedRaySet::new(set.get_ref(), rays, sides).map_err(|error| {
            let field = format!("{name}.{}", error.field);
            self.refused(table.span(), &SceneError { field, ..error })
        })
    }
}
