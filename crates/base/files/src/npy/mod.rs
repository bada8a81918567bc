//! NPY, NumPy's file of one array. (NumPy Enhancement Proposal 1; numpy.lib.format)
//!
//! CHOICE: the crate `npyz` (0.9.1, the only maintained one) is not used. It allocates as much memory as a header
//! claims to be long, up to 4 GiB for a file of 12 bytes. Its messages quote the whole header. It brings a general
//! parser of Python literals, whose recursion guard needs a C compiler. Recordings use three keys and three kinds of
//! value of the format.

mod header;
mod numbers;
mod read;
mod write;

pub use numbers::{Numbers, npy_numbers_from_bytes, read_npy_numbers};
pub(crate) use read::raster_from_bytes;
pub use read::{npy_from_bytes, read_npy};
pub(crate) use write::header;
pub use write::{ArrayNumber, write_npy, write_npy_numbers};
