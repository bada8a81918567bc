//! The house itself: who stands on whom, no circle of files, the law of independence, what `scene` may hold.
//! (ARCHITECTURE.md)

mod circles;
mod documents;
mod floors;
mod kernels;
mod scene_items;
mod source;
mod unsafe_code;
