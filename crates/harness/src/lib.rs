//! Runs renderers over one scene, compares every ray, reports.

mod candidate;
mod estimate;
mod misses;
mod monte_carlo;
mod output;
mod panel;
mod probe;
mod radiance;
mod rendered;
mod renderers;
mod reproducer;
mod run;
mod shows;
mod validation;

pub use candidate::{CandidateError, Outsider, RadianceMap};
pub use estimate::{Estimate, WayImage};
pub use misses::{MissReproducer, write_misses};
pub use monte_carlo::{CHANCE_LIMITS, ChanceLimits, ImageComparison, compare_images, expected_images};
pub use output::junit::junit as junit_xml;
pub use output::markdown::markdown as summary_markdown;
pub use output::report::html as report_html;
pub use output::screen::one_screen;
pub use output::summary::summary_json;
pub use output::{HarnessError, Written, write_maps, write_validation};
pub use panel::{Held, HeldOutsider, Panel, panel};
pub use probe::{NoSuchRay, Probe, ProbedAnswer, ProbedReturn, probe};
pub use radiance::{RadianceComparison, compare_radiance};
pub use rendered::Rendered;
pub use renderers::{Contender, RENDERER_NAMES, attribute, contender, typed_contenders};
pub use reproducer::{Reproducer, write_reproducer};
pub use run::validate;
pub use shows::{first_shown, shows_class};
pub use validation::{Counts, Pair, Validation};
