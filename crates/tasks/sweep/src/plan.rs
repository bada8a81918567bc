//! The plan of a sweep: a scene, its parameters and what is done with each of their combinations.

use raypencil_files::{FileError, bytes, hex_digits, sha256};
use raypencil_scene_io::{MAX_TOML_BYTES, Overrides, SceneSource, Setting, check_settings, load};
use serde::{Deserialize, Serialize};

use crate::axis::{Axis, first_twice};
use crate::error::SweepError;

/// Maximum number of runs.
pub const MAX_RUNS: u64 = 10_000_000;

/// Maximum number of rows of an axis that are tried before the first run: more would take longer than they save.
const MAX_TRIED_ROWS: u64 = 10_000;

/// What is done with each scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Task {
    /// Two renderers render it, and every ray is compared.
    Validate,
    /// One renderer renders it, and its maps are written.
    Render,
    /// The rover drives over it.
    Drive,
}

impl Task {
    /// The name in arguments and files.
    pub fn word(self) -> &'static str {
        match self {
            Self::Validate => "validate",
            Self::Render => "render",
            Self::Drive => "drive",
        }
    }
}

/// A sweep. Equal plans give equal tables, byte for byte.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sweep {
    /// The scene: a built-in name or a path.
    pub scene: String,
    /// SHA-256 of the scene without settings, in hexadecimal digits.
    pub scene_sha256: String,
    /// The parameters. The first changes slowest.
    pub axes: Vec<Axis>,
    /// What is done with each scene.
    pub task: Task,
    /// Names of the renderers.
    pub renderers: Vec<String>,
    /// Whether drives are as the paper prints them.
    pub as_printed: bool,
    /// Build of the program, such as its commit: another may give other results.
    pub build: String,
}

impl Sweep {
    /// A sweep over the product of all parameters.
    ///
    /// ```
    /// use raypencil_sweep::{Axis, Sweep, Task};
    ///
    /// let axes = vec![Axis::parse("camera.pitch_down_deg=20,25")?, Axis::parse("beam.thickness_mm=2:8:2")?];
    /// let renderers = vec!["scanline".to_string(), "tracer".to_string()];
    /// let sweep = Sweep::new("pyramids", axes, Task::Validate, renderers, false)?;
    /// // The first parameter changes slowest.
    /// assert_eq!(sweep.runs(), 8);
    /// assert_eq!(sweep.values(5), ["25", "4"]);
    /// # Ok::<(), raypencil_sweep::SweepError>(())
    /// ```
    ///
    /// # Errors
    /// A scene that cannot be read, a key that is given twice, too many runs.
    pub fn new(
        scene: &str,
        axes: Vec<Axis>,
        task: Task,
        renderers: Vec<String>,
        as_printed: bool,
    ) -> Result<Self, SweepError> {
        let scene_sha256 = source_digest(scene)?;
        let build = env!("CARGO_PKG_VERSION").to_string();
        let sweep = Self { scene: scene.into(), scene_sha256, axes, task, renderers, as_printed, build };
        sweep.checked()
    }

    /// The same plan, if its parameters make one.
    pub(crate) fn checked(self) -> Result<Self, SweepError> {
        let sweep = self;
        if let Some(axis) =
            sweep.axes.iter().find(|axis| axis.rows.iter().any(|row| row.len() != axis.keys.len()))
        {
            return Err(SweepError::Plan {
                found: format!("`{}` has rows of another length", axis.keys.join(",")),
                expected: "a value for each key".into(),
            });
        }
        if let Some(twice) = first_twice(sweep.keys()) {
            return Err(SweepError::Plan {
                found: format!("`{twice}` is given twice"),
                expected: "each key once, with all of its values".into(),
            });
        }
        let product =
            sweep.axes.iter().try_fold(1_u64, |product, axis| product.checked_mul(axis.rows.len() as u64));
        match product {
            Some(1..=MAX_RUNS) => Ok(sweep),
            _ => Err(SweepError::Plan {
                found: product.map_or("more than 2^64 runs".into(), |runs| format!("{runs} runs")),
                expected: format!("1 to {MAX_RUNS}"),
            }),
        }
    }

    /// Refuses a value that its key does not take, before any run is made: each row of an axis is tried beside the first rows of the
    /// others, at most 10,000 of each axis. What a ground decides, such as a place beside it, is known when its run is made.
    ///
    /// # Errors
    /// The first run that the text of its scene alone refuses.
    pub fn check_values(&self) -> Result<(), SweepError> {
        // Runs count up along the last axis first.
        let mut stride = 1;
        for (index, axis) in self.axes.iter().enumerate().rev() {
            let rows = axis.rows.len() as u64;
            // The run of all first rows is tried once.
            let first = u64::from(index + 1 < self.axes.len());
            for row in first..rows.min(MAX_TRIED_ROWS) {
                let run = row * stride;
                check_settings(&self.scene, &self.settings(run)?).map_err(|error| {
                    let pairs = axis.keys.iter().zip(&axis.rows[row as usize]);
                    let words: Vec<String> = pairs.map(|(key, value)| format!("{key}={value}")).collect();
                    SweepError::Value { run, given: words.join(" "), source: Box::new(error) }
                })?;
            }
            stride *= rows;
        }
        Ok(())
    }

    /// Number of runs.
    pub fn runs(&self) -> u64 {
        self.axes.iter().map(|axis| axis.rows.len() as u64).product()
    }

    /// All keys, in order.
    pub fn keys(&self) -> Vec<&str> {
        self.axes.iter().flat_map(|axis| axis.keys.iter().map(String::as_str)).collect()
    }

    /// Values of the keys in a run.
    pub fn values(&self, run: u64) -> Vec<&str> {
        let mut rest = run;
        let mut rows = Vec::new();
        for axis in self.axes.iter().rev() {
            let count = axis.rows.len() as u64;
            rows.push(&axis.rows[(rest % count) as usize]);
            rest /= count;
        }
        rows.iter().rev().flat_map(|row| row.iter().map(String::as_str)).collect()
    }

    /// Settings of a run. An empty value in a list leaves the scene's own.
    pub(crate) fn settings(&self, run: u64) -> Result<Vec<Setting>, SweepError> {
        let pairs = self.keys().into_iter().zip(self.values(run));
        let given = pairs.filter(|(_, value)| !value.is_empty());
        Ok(given.map(|(key, value)| Setting::new(key, value)).collect::<Result<_, _>>()?)
    }

    /// The runs in the order in which they are made: those of one ground one after the other, so that they share it.
    pub(crate) fn order(&self, part: Part) -> Vec<u64> {
        let is_of_ground: Vec<bool> = self.keys().iter().map(|key| key.starts_with("terrain.")).collect();
        let ground = |run: u64| -> Vec<String> {
            let values = self.values(run).into_iter().zip(&is_of_ground);
            values.filter(|(_, is_of_ground)| **is_of_ground).map(|(value, _)| value.to_string()).collect()
        };
        let mut runs: Vec<u64> = part.runs(self.runs()).collect();
        if is_of_ground.contains(&true) {
            runs.sort_by_cached_key(|&run| (ground(run), run));
        }
        runs
    }

    /// SHA-256 of all that decides the results of a run, in hexadecimal digits. It does not depend on the other runs, so that
    /// a sweep with more values takes over the runs that it shares with an earlier one.
    pub(crate) fn identity(&self, run: u64) -> String {
        let mut pairs: Vec<(&str, &str)> = self.keys().into_iter().zip(self.values(run)).collect();
        pairs.retain(|(_, value)| !value.is_empty());
        // The order of the keys changes nothing: no key is given twice.
        pairs.sort_unstable();
        let all = (&self.build, &self.scene_sha256, self.task, &self.renderers, self.as_printed, pairs);
        let text = serde_json::to_string(&all).expect("JSON of texts and numbers");
        hex_digits(&sha256(text.as_bytes()))
    }
}

/// Part of a sweep: the runs k with k mod `count` = `index`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Part {
    /// Index of the part, from 0.
    pub index: u64,
    /// Number of parts.
    pub count: u64,
}

impl Part {
    /// The whole sweep as one part.
    pub const WHOLE: Self = Self { index: 0, count: 1 };

    /// Numbers of the part's runs, ascending.
    pub fn runs(self, of: u64) -> impl Iterator<Item = u64> {
        (self.index..of).step_by(usize::try_from(self.count).unwrap_or(usize::MAX))
    }
}

/// Digest of a scene as it stands. One that only settings make whole has that of its file.
fn source_digest(scene: &str) -> Result<String, SweepError> {
    match load(scene, &Overrides::default()) {
        Ok(loaded) => Ok(loaded.source_sha256),
        Err(error) => match SceneSource::parse(scene) {
            Ok(SceneSource::Toml(path)) => {
                let text = bytes::read_file(&path, MAX_TOML_BYTES)
                    .map_err(|error| FileError::io(&path, "read", error))?;
                Ok(hex_digits(&sha256(&text)))
            }
            _ => Err(error.into()),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_of_one_ground_follow_each_other() {
        let order = |axes: &[&str]| {
            let axes = axes.iter().map(|axis| Axis::parse(axis).unwrap()).collect();
            let sweep = Sweep::new("pyramids", axes, Task::Render, vec!["tracer".into()], false).unwrap();
            sweep.order(Part::WHOLE)
        };
        assert_eq!(order(&["camera.pitch_down_deg=10,20", "terrain.generate.seed=1,2"]), [0, 2, 1, 3]);
        assert_eq!(order(&["camera.pitch_down_deg=10,20", "terrains.a=1,2"]), [0, 1, 2, 3]);
    }

    #[test]
    fn whatever_decides_the_results_of_a_run_is_in_its_identity() {
        let axis = |text: &str| Axis::parse(text).unwrap();
        let plan = || Sweep {
            scene: "pyramids".into(),
            scene_sha256: "0".repeat(64),
            axes: vec![axis("a=1,2"), axis("b=3")],
            task: Task::Drive,
            renderers: vec!["scanline".into(), "tracer".into()],
            as_printed: false,
            build: "1".into(),
        };
        let own = plan().identity(0);
        let others = [
            Sweep { scene_sha256: "1".repeat(64), ..plan() },
            Sweep { axes: vec![axis("a=2,1"), axis("b=3")], ..plan() },
            Sweep { axes: vec![axis("a=1"), axis("c=3")], ..plan() },
            Sweep { axes: vec![axis("a=1"), axis("b=3"), axis("c=4")], ..plan() },
            Sweep { task: Task::Render, ..plan() },
            Sweep { renderers: vec!["scanline".into()], ..plan() },
            Sweep { renderers: vec!["tracer".into(), "scanline".into()], ..plan() },
            Sweep { as_printed: true, ..plan() },
            Sweep { build: "2".into(), ..plan() },
        ];
        let mut identities: Vec<String> = others.iter().map(|other| other.identity(0)).collect();
        identities.extend([own.clone(), plan().identity(1)]);
        // The second of the swapped values is the first of the plan: one pair is the same, and no other.
        assert_eq!(others[1].identity(1), own);
        assert_eq!(others[1].identity(0), plan().identity(1));
        identities.sort_unstable();
        identities.dedup();
        assert_eq!(identities.len(), others.len() + 1);
        // A key that a list leaves to the scene is none.
        let list = Axis { keys: vec!["a".into(), "d".into()], rows: vec![vec!["1".into(), String::new()]] };
        assert_eq!(Sweep { axes: vec![list, axis("b=3")], ..plan() }.identity(0), own);
        // The other values, their order and the scene's name change nothing.
        for same in [
            Sweep { axes: vec![axis("a=1,5,7"), axis("b=3,4")], ..plan() },
            Sweep { axes: vec![axis("b=3"), axis("a=1,2")], ..plan() },
            Sweep { scene: "other".into(), ..plan() },
        ] {
            assert_eq!(same.identity(0), own);
        }
    }
}
