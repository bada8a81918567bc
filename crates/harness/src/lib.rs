//! Runs renderers over one scene, compares every ray, reports.
//!
//! ```text
//! run        scene -> frames -> comparisons, as one pass
//! compare    two frames, ray by ray: agree, tie, rounding, defect
//! judge      when the referee is asked, and with what tolerance
//! attribution  why the paper's algorithm differs where it does
//! bounds     how far two honest renderers may differ
//! probe      everything about one ray
//! output     the folder of a validation: maps, report, summary
//! ```

mod attribution;
mod bounds;
mod compare;
mod judge;
mod output;
mod probe;
mod renderers;
mod run;

pub use attribution::{Attributions, Cause, SightCause};
pub use bounds::Bounds;
pub use compare::{
    ApproximationTallies, ApproximationTally, Class, Defect, Place, Quantity, SensorComparison, Side, Tally,
    Worst, compare, compare_judged,
};
pub use judge::{Judge, JudgeShare};
pub use output::{
    OutputError, Written, one_screen, probe_command, summary_json, write_maps, write_validation,
};
pub use probe::{NoSuchRay, Probe, ProbedAnswer, ProbedReturn, probe};
pub use raypencil_scanline::{Fidelity, Switches};
pub use renderers::{Contender, RENDERER_NAMES, contender};
pub use run::{Counts, Pair, Progress, Rendered, Silent, Subject, Validation, validate};

/// The README's example, compiled and run with the documentation tests.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;
