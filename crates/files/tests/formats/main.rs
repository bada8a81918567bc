//! Every file format of the crate: what is written is read back, what is malformed is refused by name.

mod channels;
mod exr;
mod npy;
mod pfm;
