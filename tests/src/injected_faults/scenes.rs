//! The scenes on which injected faults are looked for.

use raypencil::pack::with_bench;
use raypencil::{FluxModel, Scene};

use super::{geometry, light};
use crate::lattice;
use crate::naive::FaultKind;

/// The scenes for faults of a kind, with their names, in the order of the search: ordinary ground first.
pub fn scenes_of(kind: FaultKind) -> Vec<(&'static str, Scene)> {
    match kind {
        FaultKind::Geometry | FaultKind::Clipping | FaultKind::Ties => vec![
            ("pyramids", geometry::pyramids()),
            ("pyramids, long quaternions", geometry::on_pyramids(3.0)),
            ("a ground 1400 km away", geometry::far_ground()),
            ("a plate that shows its back to the rays", geometry::plate_turned_away()),
            ("a ramp through the SPP", geometry::ramp_through_spp()),
            ("a plate beside the rays", geometry::plate_beside_rays()),
            ("a plate before the SPP", geometry::screen_before_spp()),
            ("a wall with rays through its edges", geometry::lattice()),
            ("a rotated lattice with rays through its edges", lattice::turned(31)),
            ("a ridge with rays through it", geometry::ridge()),
            ("a wall of fine faces", geometry::fine_wall()),
            ("a wall beyond the maximum range in part", geometry::range_cut_wall()),
            ("pyramids with a bench", benched(&geometry::pyramids())),
        ],
        FaultKind::Visibility | FaultKind::Flux => vec![
            ("lit pyramids", light::lit(FluxModel::Radiometric)),
            ("lit pyramids, equation (1)", light::lit(FluxModel::Eq1)),
            ("a plate 0.5 mm before a wall", light::screened(1.0 / 2048.0, false)),
            ("a wall of doubled faces", light::doubled()),
            ("a plate that shows its back to the camera", light::screened(0.25, true)),
            ("lit pyramids with a bench", benched(&light::lit(FluxModel::Radiometric))),
        ],
        FaultKind::Files => vec![("pyramids", geometry::pyramids())],
    }
}

/// A scene with the bench of a pack, whose rays run through edges and end at limits.
fn benched(scene: &Scene) -> Scene {
    with_bench(scene).expect("few beams")
}
