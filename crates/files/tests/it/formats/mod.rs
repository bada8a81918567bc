//! Every file format of the crate: what is written is read back, what is malformed is refused by name.

mod channels;
mod exr;
mod exr_limits;
mod npy;
mod pfm;

// The file alone: it counts what a reader asks for.
mod memory;
