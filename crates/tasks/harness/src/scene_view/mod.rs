//! A scene as people describe it: its numbers in the units of scene files, and a picture of rig and ground.

mod picture;
mod words;

pub use picture::scene_picture;
pub use words::{scene_json, scene_words};
