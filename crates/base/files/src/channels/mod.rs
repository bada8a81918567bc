//! Recordings of any program: the channels of a file or a folder by their keys. Rules: `docs/formats/files.md`.

mod channel;
mod declared;
mod find;
mod found;
mod merge;
mod ray_sets;
mod read;

pub use channel::{Channel, Channels, Used};
pub use declared::{Declared, DeclaredChannel};
pub use find::has_maps;
pub use ray_sets::{add_ray_sets, has_ray_sets, is_ray_set};
pub use read::{read_channels, read_channels_as, read_listed_channels};
