//! The renderer's options.

use crate::Switches;

/// The options of [`Scanline`](crate::Scanline): which work it may skip, and which of the paper's approximations it
/// makes.
///
/// ```
/// use raypencil_scanline::{Fidelity, ScanlineOptions, Switches};
///
/// // The default makes no approximation.
/// assert_eq!(ScanlineOptions::default(), ScanlineOptions::EXACT);
/// // One approximation of the paper, all else exact.
/// let switches = Switches { skip_rules: Fidelity::Paper, ..Switches::EXACT };
/// let options = ScanlineOptions { switches, ..ScanlineOptions::EXACT };
/// assert_eq!(options.switches.count(), 1);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ScanlineOptions {
    /// Whether faces that cannot be seen are skipped before they are scanned. (§4, 1a, 3a, 3b, 3c)
    ///
    /// With `skip-rules = exact` skipping saves time and never changes a map; a test shows it by rendering without.
    /// With `skip-rules = paper` this option concerns the printed rules 3a, 3b and 3c. The printed 1b stays, since
    /// it decides which side of a face is hit.
    pub skip_unseen: bool,
    /// The paper's approximations.
    pub switches: Switches,
}

impl ScanlineOptions {
    /// The contract's answers.
    pub const EXACT: Self = Self { skip_unseen: true, switches: Switches::EXACT };
    /// The paper's answers. [`Switches`] says what each approximation costs.
    pub const PAPER: Self = Self { skip_unseen: true, switches: Switches::PAPER };
}

impl Default for ScanlineOptions {
    fn default() -> Self {
        Self::EXACT
    }
}
