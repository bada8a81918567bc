//! Everything that a drive writes, read back by readers that are only here and held to the ground that was driven over.
//!
//! The ground leans in both axes, has a rock ahead on the left and a step farther ahead on the right, and the heading is no
//! multiple of 90 degrees: nothing stays the same in a mirror, or if two axes are exchanged. Where the vehicle stands, where
//! it looks and where its points are follow from the text of the scene by the arithmetic in `geometry` and `ground`, which
//! shares no code with the crates. The only readers that are not our own are those of PNG and of the container MCAP.

mod bag;
mod driven;
mod geometry;
mod ground;
mod images;
mod maps;
mod noise;
mod obstacles;
mod points;
mod poses;
mod readers;
mod setup;
