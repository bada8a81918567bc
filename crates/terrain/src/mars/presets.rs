//! Grounds with a name, and where their numbers come from.

use glam::DVec3;

use super::{Craters, Crevasses, MarsGround, Rocks, Roughness};

/// The names that [`MarsGround::preset`] knows.
pub const PRESET_NAMES: &[&str] = &["smooth", "viking1", "pathfinder", "crater_field", "crevassed", "worst"];

/// Numbers of a preset: Hurst exponent and rms difference of height at 1 m; rock coverage and largest rock; density and
/// largest diameter of craters; count, width, depth and overhang of crevasses.
struct Numbers {
    relief: (f64, f64),
    rocks: (f64, f64),
    craters: (f64, f64),
    crevasses: (u32, f64, f64, f64),
}

impl MarsGround {
    /// The ground of that name and seed, 40 m square with a post each 0.1 m; `None` for an unknown name.
    ///
    /// * `smooth`: a plain with few and small rocks. CHOICE: a third of the roughness of Viking 1, a hundredth of the ground
    ///   covered, as on plains that landers are sent to.
    /// * `viking1`: roughness from stereo images (Shepard, Seelos, Arvidson and Haldemann, "The roughness of the Martian
    ///   surface: what we know": Hurst exponent 0.5 to 0.8; rms slopes of 4.8 degrees at 1 m, 3.0 at 10 m, hence 0.8);
    ///   0.069 of the ground covered by rocks (Golombek and Rapp 1997).
    /// * `pathfinder`: the same sources: Hurst exponent 0.54 to 0.61, 5.4 degrees at 1 m; 0.19 covered (Golombek et al. 2003).
    /// * `crater_field`: craters to 5 % of geometric saturation (Gault 1970 gives 1 to 10 % in equilibrium), up to 15 m;
    ///   0.05 covered by rocks, the least of the models of Golombek et al. (2003).
    /// * `crevassed`: the ground of Viking 1 with two cracks of 0.6 m and 1.2 m deep. CHOICE: the paper's ground has
    ///   crevasses, and says nothing of their sizes; these are those that a rover's wheel would fall into.
    /// * `worst`: all of it, twice as rough as Pathfinder, 0.35 covered, with overhanging crevasses. No place on Mars.
    ///
    /// The smallest rocks are 5 cm wide (2 cm more than the facets of the smallest can show), the largest as given; the
    /// law puts a thousandth or less of the ground under larger ones.
    pub fn preset(name: &str, seed: u64) -> Option<Self> {
        const NO_CREVASSES: (u32, f64, f64, f64) = (0, 0.6, 1.2, 0.0);
        // tan of the rms slope at 1 m is the rms difference of height there: tan 4.8 deg = 0.084, tan 5.4 deg = 0.0945.
        let Numbers { relief, rocks, craters, crevasses } = match name {
            "smooth" => Numbers {
                relief: (0.8, 0.028),
                rocks: (0.01, 0.5),
                craters: (0.0, 5.0),
                crevasses: NO_CREVASSES,
            },
            "viking1" => Numbers {
                relief: (0.8, 0.084),
                rocks: (0.069, 2.0),
                craters: (0.0, 5.0),
                crevasses: NO_CREVASSES,
            },
            "pathfinder" => Numbers {
                relief: (0.58, 0.0945),
                rocks: (0.19, 3.0),
                craters: (0.0, 5.0),
                crevasses: NO_CREVASSES,
            },
            "crater_field" => Numbers {
                relief: (0.8, 0.028),
                rocks: (0.05, 2.0),
                craters: (0.077, 15.0),
                crevasses: NO_CREVASSES,
            },
            "crevassed" => Numbers {
                relief: (0.8, 0.084),
                rocks: (0.069, 2.0),
                craters: (0.0, 5.0),
                crevasses: (2, 0.6, 1.2, 0.0),
            },
            "worst" => Numbers {
                relief: (0.58, 0.19),
                rocks: (0.35, 4.0),
                craters: (0.077, 10.0),
                crevasses: (4, 0.8, 1.6, 0.25),
            },
            _ => return None,
        };
        Some(Self {
            seed,
            extent: 40.0,
            post_spacing: 0.1,
            coarse: None,
            roughness: Roughness { hurst: relief.0, at_1_m: relief.1, octave_gains: Vec::new() },
            rocks: Rocks { coverage: rocks.0, smallest: 0.05, largest: rocks.1 },
            craters: Craters { density: craters.0, smallest: 1.0, largest: craters.1 },
            crevasses: Crevasses {
                count: crevasses.0,
                width: crevasses.1,
                depth: crevasses.2,
                overhang: crevasses.3,
            },
            offset: DVec3::ZERO,
        })
    }
}
