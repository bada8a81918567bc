//! Any two recordings, channel by channel.

mod cells;
mod difference;
mod folder;
mod junit;
mod report;
mod ruled;
mod screen;
mod summary;
mod unit;

pub use cells::{CellDifference, Thresholds};
pub use difference::{ChannelDifference, DiffError, Difference, Sides, diff};
pub use folder::{WrittenDiff, write_diff};
pub use ruled::{ChannelRuling, RuledCell, Rulings, rule};
pub use screen::diff_screen;
pub use summary::diff_json;
