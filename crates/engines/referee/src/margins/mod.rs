//! How far an answer is from changing, with a witness.

pub(crate) mod both;
pub(crate) mod face;
pub(crate) mod margin;
pub(crate) mod sheet;
pub(crate) mod subdivision;
pub(crate) mod surface;
