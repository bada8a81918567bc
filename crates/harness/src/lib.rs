//! Runs renderers over one scene, compares every ray, reports.
//!
//! ```text
//! run        scene -> frames -> comparisons, as one pass
//! compare    two frames, ray by ray: agree, tie, rounding, defect
//! judge      when the referee is asked, and with what tolerance
//! attribution  why the paper's algorithm differs where it does
//! bounds     how far two honest renderers may differ
//! probe      everything about one ray
//! diff       two recordings of anything, channel by channel
//! drive      a whole drive, on one renderer or two in lockstep, and its maps
//! minimise   the plainest scene that still shows a difference
//! outside    renderers that others wrote, held to the same truth
//! output     the folder of a validation: maps, report, summary
//! ```

mod answers;
mod attribution;
mod bounds;
pub mod campaign;
pub mod cases;
mod check;
mod compare;
mod diff;
mod drive;
mod judge;
mod minimise;
mod output;
mod outside;
mod pack;
mod probe;
mod recorded;
mod renderers;
mod run;

pub use answers::{Answers, BeamLight, Certified};
pub use attribution::{Attributions, Cause, SightCause};
pub use bounds::Bounds;
pub use check::{
    Check, CheckError, Checked, ItemTally, Largest, SensorCheck, Truth, Wrong, check, check_json, check_pack,
    check_screen, write_check,
};
pub use compare::{
    ApproximationTallies, ApproximationTally, Class, Defect, First, Place, Quantity, SensorComparison, Side,
    Tally, Worst, class_at, compare, compare_judged, first_of,
};
pub use diff::{
    CellDifference, ChannelDifference, ChannelRuling, DiffError, Difference, RuledCell, Rulings, Sides,
    Thresholds, WrittenDiff, diff, diff_json, diff_screen, rule, write_diff,
};
pub use drive::{
    DriveError, DriveJob, DriveProgress, DriveRun, FluxTrace, Lever, Moved, NoiseLevel, Said, StageTrace,
    TRUTH_HEAD, Trace, TruthMatrix, WrittenDrive, drive, drive_json, drive_screen, pointing_table,
    write_drive,
};
pub use judge::{Judge, JudgeShare};
pub use minimise::{
    MINIMISE_BUDGET, Minimised, NotShown, Reproducer, first_shown, minimise, shows_class, write_reproducer,
};
pub use output::{
    OutputError, Written, count, create, one_screen, probe_command, quoted, summary_json, write_maps,
    write_validation,
};
pub use outside::{
    CHANCE_LIMITS, ChanceLimits, Estimate, Held, HeldOutsider, ImageComparison, MissReproducer, OutsideError,
    Outsider, Panel, RadianceComparison, RadianceMap, WayImage, compare_images, compare_radiance,
    expected_images, panel, write_misses,
};
pub use pack::{PackError, blind_scene, blind_subject, write_pack};
pub use probe::{NoSuchRay, Probe, ProbedAnswer, ProbedReturn, probe};
pub use raypencil_scanline::{Fidelity, Switches};
pub use recorded::{Item, Recorded, RecordingError};
pub use renderers::{Contender, RENDERER_NAMES, contender, typed_contenders};
pub use run::{Counts, Pair, Progress, Rendered, Silent, Subject, Validation, validate};

/// The README's example, compiled and run with the documentation tests.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;
