//! Sweeps: one scene with many settings, and a table of what each of them gives.
//!
//! Internal to raypencil: any version may change its items. The crate `raypencil` is the door.
//!
//! The paper built its model "as a tool for evaluating the use of structured light systems for local navigation" (section
//! 1): which angle of a sheet, which thickness, which camera finds which obstacle on which ground. A sweep answers such a
//! question. It takes the product of the values of some keys of a scene file, and for each of them renders, compares or
//! drives. A run depends on its own settings alone: it can be made anywhere and at any time, and a sweep with more values
//! takes over the runs that it shares with an earlier one.
//!
//! ```text
//! axis       keys and their values: 20:35:5, or a list in a CSV file
//! plan       all runs, their settings, and the parts that they are divided into
//! formula    texts that a spreadsheet would compute
//! results    what a run gives, as numbers with names
//! record     a run's results in a file that tells whether it is whole
//! records    files of a sweep from bytes, for tests
//! work       makes one run
//! run        makes the runs of a part; joins the records of all parts
//! table      a row for each run, as CSV and Parquet
//! chart      a result against a parameter, as SVG and PNG
//! files      a finished sweep as files
//! document   the same as one document, which every report prints
//! ```

mod axis;
mod chart;
mod document;
mod error;
mod files;
mod formula;
mod plan;
mod record;
pub mod records;
mod results;
mod run;
mod table;
mod work;

pub use axis::Axis;
pub use chart::Chart;
pub use document::{Drawn, Written, sweep_document};
pub use error::SweepError;
pub use files::{default_charts, write_sweep};
pub use plan::{MAX_RUNS, Part, Sweep, Task};
pub use record::Outcome;
pub use results::Named;
pub use run::{Finished, SweepProgress, finish, has_part, read_plan, run_part};
pub use table::{Cells, Column, SweepTable};

/// The README's example, compiled and run with the documentation tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

// The tests by public items are in the program of the unit tests: one executable for the crate.
#[cfg(test)]
extern crate self as raypencil_sweep;
#[cfg(test)]
#[path = "../tests/it/mod.rs"]
mod it;
