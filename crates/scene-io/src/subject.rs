use raypencil_scene::Place;
use raypencil_scene::{Scene, SensorId};

/// The command that shows everything about one ray.
pub fn probe_command(subject: &Subject, place: Place) -> String {
    let Place { sensor, i, j } = place;
    let arguments = &subject.arguments;
    match sensor {
        SensorId::Camera => format!("raypencil probe {arguments} --pixel {i},{j}"),
        SensorId::Beam(index) => format!("raypencil probe {arguments} --beam {index} --pencil {i},{j}"),
    }
}

/// A word as a shell takes it for one.
pub fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "._-/+@%:,=".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_string()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

/// The scene under test, and how people name it.
#[derive(Debug, Clone)]
pub struct Subject {
    /// The resolved scene.
    pub scene: Scene,
    /// A short name, fit for a folder.
    pub name: String,
    /// The words after `raypencil validate` or `raypencil probe` that give this scene and its renderers again.
    pub arguments: String,
    /// SHA-256 of what defines the scene, in hexadecimal digits.
    pub sha256: String,
}
