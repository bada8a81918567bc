//! Which face a ray meets: the contract's conditions as signs of polynomials, the values there, and rulings on answers.

pub(crate) mod aspect;
pub(crate) mod edge_filter;
pub(crate) mod face;
pub(crate) mod face_forms;
pub(crate) mod intersection;
pub(crate) mod neighbourhood;
pub(crate) mod region;
pub(crate) mod rounded_face;
pub(crate) mod ruling;
pub(crate) mod through_point;
pub(crate) mod values;
pub(crate) mod verdict;
