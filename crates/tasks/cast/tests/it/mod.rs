//! The tests of this crate by its public items, one program together with its unit tests.

mod bags;
mod beam_trial;
mod bounds;
mod cloud;
mod cloud_trial;
mod clouds_at_limits;
mod clouds_in_text;
mod clouds_of_many_returns;
mod clouds_of_one_key;
mod clouds_of_others;
mod clouds_of_return_numbers;
mod clouds_of_returns;
mod clouds_of_sensors;
mod columns;
mod kept_packs;
mod lidar;
mod pack_trial;
mod packs_refused;
mod packs_right;
mod packs_told;
mod reported;
mod returns;
mod returns_at_limits;
mod shortest_range;
mod thin_faces;
mod written;
