//! Words of the labels of obstacle maps and navigator maps, in all files and on the screen.

use raypencil_rover::Label;

pub(crate) fn label_word(label: Label) -> &'static str {
    match label {
        Label::Obstacle => "obstacle",
        Label::Unknown => "unknown",
        Label::Visibility => "visibility",
    }
}
