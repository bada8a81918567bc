//! `[[rays]]`: named sets of rays, from files and from patterns of range sensors.

mod angles;
mod cone;
mod grid;
mod keys;
mod mount;
mod pattern;
mod spinning;
mod times;

use serde::Deserialize;
use std::collections::BTreeSet;
use std::ops::RangeInclusive;
use toml::Spanned;

use raypencil_files::part_of_memory;
use raypencil_scene::pattern::{EchoLight, MAX_RAYS, Mounting};
use raypencil_scene::{HeadSweep, NamedRaySet, SceneError, Sides};

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

/// Extinction of the air, 1/m.
const EXTINCTION_PER_M: RangeInclusive<f64> = 0.0..=1e6;

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
    reflectivity: Key<f64>,
    extinction_per_m: Key<f64>,
}

/// What is told of a set beside its pattern.
struct Placing {
    sides: Sides,
    mounting: Mounting,
    start: Option<f64>,
    echo: EchoLight,
}

impl Source<'_> {
    /// The sets of all tables `[[rays]]`, and the digests of the files that they name, in their order.
    pub(crate) fn ray_sets(
        &self,
        tables: &[Spanned<RaysKeys>],
    ) -> Result<(Vec<NamedRaySet>, Vec<NamedDigest>), SceneIoError> {
        self.sets_of(tables, BYTES_OF_RAY, |index, table, pattern, digests| {
            self.ray_set(index, table, pattern, digests)
        })
    }

    /// The same of spinning heads alone, whose rays are not made.
    pub(crate) fn sweeps(
        &self,
        tables: &[Spanned<RaysKeys>],
    ) -> Result<(Vec<HeadSweep>, Vec<NamedDigest>), SceneIoError> {
        self.sets_of(tables, 0, |index, table, pattern, digests| self.sweep(index, table, pattern, digests))
    }

    /// A set of each table, as `make` makes it; its rays take so many bytes each.
    fn sets_of<T>(
        &self,
        tables: &[Spanned<RaysKeys>],
        bytes_of_ray: u64,
        make: impl Fn(usize, &Spanned<RaysKeys>, Pattern, &mut Vec<NamedDigest>) -> Result<T, SceneIoError>,
    ) -> Result<(Vec<T>, Vec<NamedDigest>), SceneIoError> {
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
            let needed = before.saturating_add(count).saturating_mul(bytes_of_ray);
            let memory = part_of_memory(1);
            if needed > memory {
                let message = format!(
                    "`rays {index}` has {count} rays, which take about {needed} bytes with those before them; expected at \
                     most {memory}, the memory that there is (--max-memory)"
                );
                return Err(self.error(table.span(), message));
            }
            before += count;
            sets.push(make(index, table, pattern, &mut digests)?);
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
        let name = format!("rays {index}");
        let keys = table.get_ref();
        let Placing { sides, mounting, start, echo } = self.placing(&name, keys, digests)?;
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
        let set = NamedRaySet::new(set.get_ref(), rays, sides).map_err(|error| {
            let field = format!("{name}.{}", error.field);
            self.refused(table.span(), &SceneError { field, ..error })
        })?;
        Ok(NamedRaySet { echo, ..set })
    }

    fn sweep(
        &self,
        index: usize,
        table: &Spanned<RaysKeys>,
        pattern: Pattern,
        digests: &mut Vec<NamedDigest>,
    ) -> Result<HeadSweep, SceneIoError> {
        let name = format!("rays {index}");
        let keys = table.get_ref();
        let set = self.set_name(index, table)?.get_ref();
        let (head, cone) = match pattern {
            Pattern::Spinning(head) => (Some(head), None),
            Pattern::Cone(cone, returns, inner) => match *inner {
                Pattern::Spinning(head) => (Some(head), Some((cone, returns))),
                _ => (None, None),
            },
            _ => (None, None),
        };
        let Some(head) = head else {
            let message =
                format!("`{name}`, {set}, has no firing sequences; expected a spinning head, for scans");
            return Err(self.error(table.span(), message));
        };
        if let Some(file) = &keys.times_file {
            // Refused: a head has times of its own.
            self.times(&name, &keys.file, file, &[], digests)?;
        }
        let Placing { sides, mounting, start, echo } = self.placing(&name, keys, digests)?;
        let sweep = HeadSweep { name: set.clone(), head, cone, mounting, start_s: start, sides, echo };
        sweep.check(&name).map_err(|error| self.refused(table.span(), &error))?;
        Ok(sweep)
    }

    /// What is told of a set beside its pattern.
    fn placing(
        &self,
        name: &str,
        keys: &RaysKeys,
        digests: &mut Vec<NamedDigest>,
    ) -> Result<Placing, SceneIoError> {
        let mut sides = Sides::Both;
        let words = [("both", Sides::Both), ("fronts", Sides::Fronts)];
        self.choice(&keys.sides, &format!("{name}.sides"), &mut sides, &words)?;
        let pose =
            OnePose::new(&keys.position_m, [&keys.yaw_left_deg, &keys.pitch_down_deg, &keys.roll_right_deg]);
        let choice = BagKeys { topic: &keys.poses_topic, frames: &keys.poses_frames };
        let mounting = match &keys.poses_file {
            Some(file) => self.mounting_of_file(name, &pose, (&keys.poses, file), choice, digests)?,
            None => {
                self.without_bag(name, choice)?;
                self.mounting(name, &pose, &keys.poses)?
            }
        };
        let start = self.start(name, &keys.start_s)?;
        Ok(Placing { sides, mounting, start, echo: self.echo(name, keys)? })
    }

    /// What surfaces and air leave of the light.
    fn echo(&self, name: &str, keys: &RaysKeys) -> Result<EchoLight, SceneIoError> {
        let mut echo = EchoLight::default();
        let [reflectivity, extinction] =
            ["reflectivity", "extinction_per_m"].map(|key| format!("{name}.{key}"));
        self.number(&keys.reflectivity, &reflectivity, &mut echo.reflectivity, 0.0..=1.0, "")?;
        self.number(
            &keys.extinction_per_m,
            &extinction,
            &mut echo.extinction_per_m,
            EXTINCTION_PER_M,
            "1/m",
        )?;
        Ok(echo)
    }
}
