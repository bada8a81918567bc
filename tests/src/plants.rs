//! The scenes that planted faults are looked for on.

pub mod geometry;
pub mod hunt;
pub mod light;

use raypencil::{FluxModel, Scene};

use crate::lattice;
use crate::naive::Kind;

/// The scenes for faults of a kind, by name, in the order in which they are tried: ordinary ground first.
pub fn scenes_of(kind: Kind) -> Vec<(&'static str, Scene)> {
    match kind {
        Kind::Geometry | Kind::Clipping | Kind::Ties => vec![
            ("pyramids", geometry::pyramids()),
            ("pyramids, long quaternions", geometry::on_pyramids(3.0)),
            ("a ground 1400 km away", geometry::far_ground()),
            ("a plate turned away", geometry::plate_turned_away()),
            ("a ramp through the SPP", geometry::ramp_through_spp()),
            ("a plate beside the rays", geometry::plate_beside_rays()),
            ("a plate before the SPP", geometry::screen_before_spp()),
            ("a wall whose edges the rays meet", geometry::lattice()),
            ("a turned lattice whose edges the rays meet", lattice::turned(31)),
            ("a ridge that the rays meet", geometry::ridge()),
            ("a wall of fine faces", geometry::fine_wall()),
            ("a wall cut by the range", geometry::range_cut_wall()),
        ],
        Kind::Visibility | Kind::Flux => vec![
            ("lit pyramids", light::lit(FluxModel::Radiometric)),
            ("lit pyramids, equation (1)", light::lit(FluxModel::Eq1)),
            ("a plate 0.5 mm before a wall", light::screened(1.0 / 2048.0, false)),
            ("a wall of two sheets", light::doubled()),
            ("a plate that shows its back", light::screened(0.25, true)),
        ],
        Kind::Files => vec![("pyramids", geometry::pyramids())],
    }
}
