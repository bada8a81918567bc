//! Version and kind of a scene file, read before all other keys.

use serde::Deserialize;

use crate::parse::key::Key;
use crate::parse::source::Source;
use crate::scene_error::SceneIoError;

/// Kind of a scene file of version 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Kind {
    /// A rig on a ground: most numbers have defaults.
    Rig,
    /// The numbers of a resolved scene.
    Resolved,
}

#[derive(Deserialize)]
struct HeadKeys {
    version: Key<toml::Value>,
    kind: Key<toml::Value>,
}

impl Source<'_> {
    /// Kind of the file. It is read first, so that a newer file fails by its version and not by one of its keys.
    pub(crate) fn kind(&self) -> Result<Kind, SceneIoError> {
        let wanted = "`version = 1`, the only version there is";
        let head: HeadKeys = self.deserialize()?;
        match head.version {
            None => Err(self.error(0..0, format!("`version` is missing; expected {wanted}"))),
            Some(version) if version.get_ref().as_integer() == Some(1) => match head.kind {
                None => Ok(Kind::Rig),
                Some(kind) if kind.get_ref().as_str() == Some("resolved") => Ok(Kind::Resolved),
                Some(kind) => {
                    let message = format!(
                        "`kind` is {}; expected \"resolved\", or no `kind` for a rig on a ground",
                        kind.get_ref()
                    );
                    Err(self.error(kind.span(), message))
                }
            },
            Some(version) => {
                let message = format!("`version` is {}; expected {wanted}", version.get_ref());
                Err(self.error(version.span(), message))
            }
        }
    }
}
