//! Mars grounds by name, with the source of each number.

use glam::DVec3;

use super::{Craters, Crevasses, MarsGround, Rocks, Roughness};

/// Names that [`MarsGround::preset`] accepts.
pub const PRESET_NAMES: &[&str] = &["smooth", "viking1", "pathfinder", "crater_field", "crevassed", "worst"];

/// Numbers of a preset: (Hurst exponent, rms difference of height at 1 m), (rock coverage, largest rock), (crater
/// density, largest crater), and (count, width, depth, overhang) of the crevasses.
struct Numbers {
    relief: (f64, f64),
    rocks: (f64, f64),
    craters: (f64, f64),
    crevasses: (u32, f64, f64, f64),
}

impl MarsGround {
    /// Ground by its name and seed, 40 m square, with a post each 0.1 m, each 0.05 m within 10 m of the middle, and each
    /// 0.025 m within 4 m; `None` for an unknown name.
    ///
    /// * `smooth`: a plain with few and small rocks. CHOICE: a third of the roughness of Viking 1 and rocks on
    ///   0.01 of the ground, as on the plains that landers are sent to.
    /// * `viking1`: roughness from stereo images (Shepard, Seelos, Arvidson and Haldemann, "The roughness of the
    ///   Martian surface: what we know": Hurst exponent 0.5 to 0.8; rms slopes of 4.8 degrees at 1 m and 3.0 at
    ///   10 m, hence 0.8); rocks on 0.069 of the ground (Golombek and Rapp 1997).
    /// * `pathfinder`: the same sources: Hurst exponent 0.54 to 0.61, 5.4 degrees at 1 m; rocks on 0.19 (Golombek
    ///   et al. 2003).
    /// * `crater_field`: craters at 5 % of geometric saturation (Gault 1970 gives 1 to 10 % in equilibrium), up
    ///   to 15 m; rocks on 0.05, the smallest of the models of Golombek et al. (2003).
    /// * `crevassed`: the ground of Viking 1 with two cracks, 0.6 m wide and 1.2 m deep. CHOICE: the paper's
    ///   ground has crevasses but no sizes for them; a rover's wheel would fall into these.
    /// * `worst`: all features together, twice as rough as Pathfinder, rocks on 0.35, overhanging crevasses. No
    ///   place on Mars looks like this.
    ///
    /// The smallest rocks are 5 cm wide. The largest are as given; larger ones would cover a thousandth of the
    /// ground or less.
    pub fn preset(name: &str, seed: u64) -> Option<Self> {
        const NO_CREVASSES: (u32, f64, f64, f64) = (0, 0.6, 1.2, 0.0);
        // The rms difference of height at 1 m is the tangent of the rms slope there: tan 4.8 deg = 0.084,
        // tan 5.4 deg = 0.0945.
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
            roughness: Roughness { hurst: relief.0, rms_at_1_m: relief.1, octave_gains: Vec::new() },
            rocks: Rocks { coverage: rocks.0, smallest: 0.05, largest: rocks.1 },
            craters: Craters { density: craters.0, smallest: 1.0, largest: craters.1 },
            crevasses: Crevasses {
                count: crevasses.0,
                width: crevasses.1,
                depth: crevasses.2,
                overhang: crevasses.3,
            },
            fine_radius: 4.0,
            offset: DVec3::ZERO,
        })
    }
}
