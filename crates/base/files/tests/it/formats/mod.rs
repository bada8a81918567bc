//! Every file format of the crate: what is written is read back, what is malformed is refused by name.

mod channels;
mod declared;
mod exr;
mod exr_limits;
mod npy;
mod npz;
mod pfm;
mod pictures;
mod zarr;

// The file alone: it counts what a reader asks for.
mod memory;
