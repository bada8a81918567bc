//! The faces that a ray may meet: a hierarchy of boxes.

pub(crate) mod bvh;
pub(crate) mod wide_boxes;
