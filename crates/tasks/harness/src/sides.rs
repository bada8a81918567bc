//! Two recordings that are to be compared, each as what is declared and its own `candidate.json` say.

use std::path::{Path, PathBuf};

use raypencil_files::{
    Channels, Declared, DeclaredChannel, FileError, Limits, add_ray_sets, read_channels_as,
};
use raypencil_judge::{Conventions, Recorded};
use raypencil_pack::{CheckError, Declarations, note};
use raypencil_scene::{Precision, Progress, Scene};

/// A recording that is one side of a comparison.
#[derive(Debug, Clone)]
pub struct Side {
    /// The file or folder.
    pub path: PathBuf,
    /// Its channels.
    pub channels: Channels,
    declared: Declared,
    conventions: Conventions,
    /// That of its computation, as its `candidate.json` says, or else double precision.
    precision: Precision,
}

impl Side {
    /// The same as answers about a scene, for the referee. `precision` is that of its computation; `None`: as its `candidate.json` says,
    /// else double precision.
    ///
    /// # Errors
    /// Names the file, the channel and the cell that breaks the conventions; a `candidate.json` that names another scene.
    pub fn recorded(&self, scene: &Scene, precision: Option<Precision>) -> Result<Recorded, CheckError> {
        note(&self.path, scene)?;
        let channels = Recorded::channels(&self.path, scene, &self.declared)?;
        let precision = precision.unwrap_or(self.precision);
        Ok(Recorded::of_folder(&self.path, scene, precision, &channels, self.conventions)?)
    }
}

/// Reads two recordings. What is declared concerns each that has such a channel, and must concern one of them; what a note
/// says concerns its own recording.
///
/// # Errors
/// A file that cannot be read, a note too; something declared that is true of neither.
pub fn read_sides(
    paths: [&Path; 2],
    declarations: &Declarations,
    progress: &dyn Progress,
) -> Result<[Side; 2], FileError> {
    let read = |path: &Path| -> Result<Side, FileError> {
        progress.stage(&format!("{}: reading", path.display()));
        let of_note = Declarations::default().with_note_of(path)?;
        let of_side = declarations.clone().with_note_of(path)?;
        let declared = Declared { may_be_absent: true, ..of_side.declared() };
        let limits = Limits::default();
        let mut channels = read_channels_as(path, &limits, &declared, None)?;
        let is_there = |one: &DeclaredChannel| channels.used.maps.contains(&one.map);
        if let Some(missing) = of_note.channels.iter().find(|one| !is_there(one)) {
            refuse(path, missing)?;
        }
        add_ray_sets(&mut channels, path, &limits)?;
        let (conventions, precision) = (of_side.conventions(), of_side.precision());
        let declared = declared.used(&channels.used);
        Ok(Side { path: path.to_path_buf(), declared, channels, conventions, precision })
    };
    let sides = [read(paths[0])?, read(paths[1])?];
    let [a, b] = &sides;
    let is_there =
        |one: &DeclaredChannel| [a, b].iter().any(|side| side.channels.used.maps.contains(&one.map));
    if let Some(missing) = declarations.channels.iter().find(|one| !is_there(one)) {
        refuse(&a.path, missing)?;
    }
    if declarations.scale.is_some() && !a.channels.used.scale && !b.channels.used.scale {
        let strict = Declared { scale: declarations.scale, may_be_absent: false, ..a.declared.clone() };
        read_channels_as(&a.path, &Limits::default(), &strict, None)?;
    }
    Ok(sides)
}

/// The message that a recording does not have a declared channel.
fn refuse(path: &Path, missing: &DeclaredChannel) -> Result<(), FileError> {
    let strict = Declared { channels: vec![missing.clone()], ..Declared::default() };
    read_channels_as(path, &Limits::default(), &strict, None).map(|_| ())
}
