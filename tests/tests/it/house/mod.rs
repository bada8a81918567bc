//! The house itself: who stands on whom, no circle of files, the law of independence, what `scene` may hold, where unsafe
//! code is, the links of the documents, and what a release promises.
//! (ARCHITECTURE.md)

mod circles;
mod documents;
mod floors;
mod kernels;
mod light;
mod nouns;
mod release;
mod scene_items;
mod source;
mod stamps;
mod unsafe_code;

pub(crate) use source::crates;
