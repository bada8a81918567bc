//! The committed digest and the committed packs, byte for byte. A program of its own, because it is built at -O0 as well:
//! the bits are the same at any optimisation level.

mod digest;
mod packs;
