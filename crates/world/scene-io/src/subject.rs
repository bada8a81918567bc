//! A scene under test, and the commands that people type to see it.

use raypencil_mesh_io::FileFacts;
use raypencil_scene::{Place, Pose, Scene, SensorId};
use raypencil_survey::Warning;

use crate::file_warnings::file_warnings;

/// Scene under test, with the names that people give it.
#[derive(Debug, Clone)]
pub struct Subject {
    /// Resolved scene.
    pub scene: Scene,
    /// Short name, fit for a folder.
    pub name: String,
    /// Words after `raypencil validate` or `raypencil probe` that give this scene and its renderers again.
    pub arguments: String,
    /// SHA-256 of the source: of the files or the input that define the scene, in hexadecimal digits. That of the
    /// resolved scene, which candidates and packs have, is [`scene_sha256`](crate::scene_sha256).
    pub sha256: String,
    /// Pose of the vehicle in the global frame; `None`: the scene has sensors alone.
    pub vehicle: Option<Pose>,
    /// What was found out about the files of its terrain.
    pub file_facts: FileFacts,
}

impl Subject {
    /// What looks wrong in the files of the terrain.
    pub fn file_warnings(&self) -> Vec<Warning> {
        file_warnings(&self.file_facts)
    }
}

/// Command that shows everything about one ray.
///
/// ```
/// use raypencil_scene::{Place, SensorId};
/// use raypencil_scene_io::{Overrides, load, probe_command, quoted};
///
/// let loaded = load("pyramids", &Overrides::default())?;
/// // A shell splits words at spaces, so this path needs quotes.
/// let subject = loaded.into_subject(quoted("my scenes/pyramids.toml"));
/// let place = Place { sensor: SensorId::Beam(1), i: 412, j: 3 };
/// let command = "raypencil probe 'my scenes/pyramids.toml' --beam 1 --pencil 412,3";
/// assert_eq!(probe_command(&subject, place), command);
/// # Ok::<(), raypencil_scene_io::SceneIoError>(())
/// ```
pub fn probe_command(subject: &Subject, place: Place) -> String {
    let Place { sensor, i, j } = place;
    let arguments = &subject.arguments;
    match sensor {
        SensorId::Camera => format!("raypencil probe {arguments} --pixel {i},{j}"),
        SensorId::Beam(index) => format!("raypencil probe {arguments} --beam {index} --pencil {i},{j}"),
    }
}
