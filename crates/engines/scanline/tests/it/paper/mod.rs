//! The paper's approximations, switch by switch, on scenes whose numbers are derived beside them.

mod beam_edges;
mod occlusion_rules;
mod printed_rules;
mod scenes;
mod switches;
