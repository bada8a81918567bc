//! Mars-like grounds for proptest: the presets at any size, with more or less relief, rocks, craters and crevasses.

use proptest::prelude::*;
use proptest::sample::select;
use raypencil_terrain::{Craters, Crevasses, MarsGround, PRESET_NAMES, Rocks};

/// Grounds of any preset, with 4 to `cells` cells a side. They shrink towards a small plane: fewer cells, less relief,
/// fewer rocks, craters and crevasses.
pub fn mars_grounds(cells: u32) -> impl Strategy<Value = MarsGround> {
    select(PRESET_NAMES).prop_flat_map(move |name| mars_grounds_of(name, cells))
}

/// Grounds of one preset, as [`mars_grounds`].
///
/// # Panics
/// If there is no such preset.
pub fn mars_grounds_of(name: &'static str, cells: u32) -> impl Strategy<Value = MarsGround> {
    let share = || 0.0..=1.0;
    (any::<u64>(), 4..=cells, 2.0..40.0, [share(), share(), share(), share(), share()]).prop_map(
        move |(seed, cells, extent, [relief, coverage, density, cracks, fine]): (u64, u32, f64, [f64; 5])| {
            let mut ground = MarsGround::preset(name, seed).expect("a preset");
            // Scale all lengths with the extent; use fewer posts.
            let scale = extent / ground.extent;
            ground.extent = extent;
            ground.post_spacing = extent / f64::from(cells);
            ground.fine_radius *= scale * fine;
            ground.roughness.rms_at_1_m *= relief;
            let Rocks { coverage: max_coverage, largest, .. } = ground.rocks;
            // Leave out small rocks, so that there are only a few for each cell.
            ground.rocks = Rocks {
                coverage: max_coverage * coverage,
                smallest: f64::min(0.5 * largest, (0.7 * ground.post_spacing).max(0.05)),
                largest,
            };
            let Craters { density: max_density, smallest, largest } = ground.craters;
            ground.craters = Craters {
                density: max_density * density,
                smallest: smallest * scale,
                largest: largest * scale,
            };
            let Crevasses { count, width, depth, overhang } = ground.crevasses;
            ground.crevasses = Crevasses {
                count: (f64::from(count) * cracks).round() as u32,
                width: width * scale,
                depth,
                overhang: overhang * scale,
            };
            ground
        },
    )
}

#[cfg(test)]
mod tests {
    use proptest::strategy::ValueTree;
    use proptest::test_runner::TestRunner;

    use super::*;

    #[test]
    fn every_ground_can_be_built() {
        let mut runner = TestRunner::deterministic();
        for name in PRESET_NAMES {
            for _ in 0..20 {
                let ground = mars_grounds_of(name, 30).new_tree(&mut runner).unwrap().current();
                let faces = ground.build().unwrap().faces.len();
                assert!(faces >= 2 * 4 * 4, "{name}: {faces} faces");
            }
        }
    }

    #[test]
    fn it_shrinks_to_a_plane() {
        // Always take the simpler ground, as proptest does while the test still fails.
        let mut runner = TestRunner::deterministic();
        for _ in 0..20 {
            let mut tree = mars_grounds(30).new_tree(&mut runner).unwrap();
            while tree.simplify() {}
            let plane = tree.current();
            assert_eq!((plane.rocks.coverage, plane.craters.density, plane.crevasses.count), (0.0, 0.0, 0));
            let ground = plane.build().unwrap();
            assert_eq!(ground.faces.len(), 2 * 4 * 4);
            assert!(ground.vertices.iter().all(|vertex| vertex.z == 0.0));
        }
    }
}
