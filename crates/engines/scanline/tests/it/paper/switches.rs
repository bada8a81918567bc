//! Names, presets and combinations of switches.

use raypencil_scanline::{Fidelity, Scanline, ScanlineOptions, Switches};
use raypencil_scene::Renderer;
use raypencil_terrain::builtin;

use super::scenes::{BEAM_EDGES, SKIP_RULES, render, rig_on, same_maps};

#[test]
fn a_renderer_is_named_after_its_switches() {
    let name =
        |switches| Scanline::new(ScanlineOptions { switches, ..ScanlineOptions::EXACT }).name().to_string();
    assert_eq!(Scanline::exact().name(), "scanline");
    assert_eq!(Scanline::default().name(), "scanline");
    assert_eq!(Scanline::paper().name(), "scanline-paper");
    assert_eq!(name(BEAM_EDGES), "scanline-paper-beam-edges");
    assert_eq!(name(SKIP_RULES), "scanline-paper-skip-rules");
    // No two combinations share a name.
    let mut names: Vec<_> = Switches::subsets().map(name).collect();
    names.sort();
    names.dedup();
    assert_eq!(names.len(), Switches::subsets().count());
}

#[test]
fn no_switch_changes_the_maps_of_the_papers_pyramids() {
    // A stripe of 5 mm, no face that two rows see from different sides, no face wholly beyond 20 m.
    let scene = rig_on(builtin("pyramids", 0.25).unwrap(), 5e-3, 20.0);
    let exact = render(&scene, Switches::EXACT);
    for switches in Switches::subsets() {
        let paper = render(&scene, switches);
        assert!(same_maps(&exact, &paper), "{switches}");
        // `place = paper` changes the outlines of shadows, where a pixel's centre is not the point: see
        // `occlusion_rules`.
        if switches.place == Fidelity::Exact {
            assert!(exact.returns == paper.returns && exact.flux == paper.flux, "{switches}");
        }
    }
}
