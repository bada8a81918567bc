//! What a set is made of: `file`, `spinning`, `grid`, `angles`, or a `cone` of one of these.

use std::ops::Range;
use std::path::Path;
use toml::Spanned;

use raypencil_files::{FileError, Limits, RayArray, bytes, rays_from_bytes, sha256};
use raypencil_scene::SceneError;
use raypencil_scene::pattern::{Cone, Grid, Mounting, PatternRays, Returns, Spinning};

use crate::digest::NamedDigest;
use crate::parse::key::Key;
use crate::parse::rays::angles::{Angles, AnglesKeys};
use crate::parse::rays::cone::{ConeKeys, OfKeys};
use crate::parse::rays::grid::GridKeys;
use crate::parse::rays::spinning::SpinningKeys;
use crate::parse::source::Source;
use crate::scene_error::SceneIoError;

/// Keys of which exactly one is given.
pub(super) struct PatternKeys<'k> {
    pub file: &'k Key<String>,
    pub spinning: &'k Key<SpinningKeys>,
    pub grid: &'k Key<GridKeys>,
    pub angles: &'k Key<AnglesKeys>,
}

/// A pattern whose rays are not made yet.
pub(super) enum Pattern {
    File(RayArray),
    Spinning(Spinning),
    Grid(Grid),
    Angles(Angles),
    Cone(Cone, Option<Returns>, Box<Pattern>),
}

impl Pattern {
    /// Number of rays.
    pub(super) fn count(&self) -> u64 {
        match self {
            Self::File(array) => array.rays.len() as u64,
            Self::Spinning(head) => head.steps.saturating_mul(head.channels.len() as u64),
            Self::Grid(grid) => grid.columns.saturating_mul(grid.rows),
            Self::Angles(angles) => angles.rows.len() as u64,
            Self::Cone(cone, _, inner) => cone.count().saturating_mul(inner.count()),
        }
    }

    /// The rays in the pattern's frame.
    pub(super) fn rays(self, name: &str) -> Result<PatternRays, SceneError> {
        match self {
            Self::File(RayArray { shape, rays }) => Ok(PatternRays {
                shape,
                rays,
                times: None,
                weights: None,
                returns: None,
                elevations_deg: None,
                mounting: Mounting::HERE,
            }),
            Self::Spinning(head) => head.rays(&format!("{name}.spinning")),
            Self::Grid(grid) => grid.rays(&format!("{name}.grid")),
            Self::Angles(angles) => angles.rays(&format!("{name}.angles")),
            Self::Cone(cone, returns, inner) => {
                let rays = cone.spread(&inner.rays(name)?, &format!("{name}.cone"))?;
                Ok(PatternRays { returns, ..rays })
            }
        }
    }
}

impl Source<'_> {
    /// The pattern of a table `name` at `place`. `cone` is `None` where a cone may not be: within a cone.
    pub(super) fn pattern(
        &self,
        (name, place): (&str, Range<usize>),
        keys: PatternKeys<'_>,
        cone: Option<&Key<ConeKeys>>,
        digests: &mut Vec<NamedDigest>,
    ) -> Result<Pattern, SceneIoError> {
        let is_given = [
            ("file", keys.file.is_some()),
            ("spinning", keys.spinning.is_some()),
            ("grid", keys.grid.is_some()),
            ("angles", keys.angles.is_some()),
            ("cone", cone.is_some_and(Option::is_some)),
        ];
        let given: Vec<String> =
            is_given.iter().filter(|(_, given)| *given).map(|(key, _)| format!("`{key}`")).collect();
        if given.len() != 1 {
            let wanted = match cone {
                Some(_) => "`file`, `spinning`, `grid`, `angles` and `cone`",
                None => "`file`, `spinning`, `grid` and `angles`",
            };
            let found = match given.len() {
                0 => "no pattern".to_string(),
                _ => given.join(" and "),
            };
            return Err(self.error(place, format!("`{name}` has {found}; expected exactly one of {wanted}")));
        }
        if let Some(file) = keys.file {
            return self.rays_of_file(name, file, digests).map(Pattern::File);
        }
        if let Some(spinning) = keys.spinning {
            return self.spinning(&format!("{name}.spinning"), spinning).map(Pattern::Spinning);
        }
        if let Some(grid) = keys.grid {
            return self.grid(&format!("{name}.grid"), grid).map(Pattern::Grid);
        }
        if let Some(angles) = keys.angles {
            return self.angles(&format!("{name}.angles"), angles, digests).map(Pattern::Angles);
        }
        let Some(cone) = cone.and_then(Option::as_ref) else { unreachable!("one of the five is given") };
        let name = format!("{name}.cone");
        let (cone, returns, of) = self.cone(&name, cone)?;
        let OfKeys { file, spinning, grid, angles } = of.get_ref();
        let keys = PatternKeys { file, spinning, grid, angles };
        let inner = self.pattern((&format!("{name}.of"), of.span()), keys, None, digests)?;
        Ok(Pattern::Cone(cone, returns, Box::new(inner)))
    }

    /// The rays of an NPY or CSV file. Its path is relative to the TOML file.
    fn rays_of_file(
        &self,
        name: &str,
        key: &Spanned<String>,
        digests: &mut Vec<NamedDigest>,
    ) -> Result<RayArray, SceneIoError> {
        let file = self.file.parent().unwrap_or(Path::new("")).join(key.get_ref());
        if !file.is_file() {
            let message = format!(
                "`{name}.file`: there is no file \"{}\"; expected rays as NPY or CSV, the path relative to this file",
                file.display()
            );
            return Err(self.error(key.span(), message));
        }
        // The header of an NPY file comes on top of its numbers, at most 2^16 bytes.
        let most = Limits::default().bytes + (1 << 16);
        let bytes = bytes::read_file(&file, most).map_err(|error| FileError::io(&file, "read", error))?;
        digests.push((key.get_ref().clone(), sha256(&bytes)));
        Ok(rays_from_bytes(&bytes, &file)?)
    }
}
