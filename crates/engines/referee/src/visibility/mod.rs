//! What the camera sees of a pencil's hit, how far that is from changing, and rulings on answers.

pub(crate) mod line_of_sight;
pub(crate) mod margin;
pub(crate) mod occluder;
pub(crate) mod rounded_line;
pub(crate) mod ruling;
pub(crate) mod seen;
