//! Switches between the rules that the paper prints and the mended ones. (Paper, §7)

/// Which of two rules is in force.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Rule {
    /// The rule of the paper. Where the paper is silent, the simplest reading of it.
    Paper,
    /// The rule that mends what the paper's rule gets wrong.
    #[default]
    Mended,
}

/// What is known of the ground before the first stripe. What the vehicle covers then is measured by stripes later, or
/// stays unknown, unless one of the last two rules invents it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum StartRule {
    /// The one under the vehicle's origin, by the proximity sensor. "All of the grid points are initialized to 's' at
    /// the start of the run." (§7) CHOICE: elevation needs one cell to start from.
    #[default]
    Origin,
    /// All under the vehicle, as if the ground were the plane of its wheels. This rule is here to be compared: the
    /// invented elevations are read back while the vehicle drives off them, and spoil its own elevation for the whole
    /// drive.
    Footprint,
    /// As `Origin`, and the mended obstacle tests take the ground on which the vehicle stands, or could turn on the spot, for
    /// the plane of its wheels. This is an assumption: a start from a levelled place. A rock beside the vehicle is not seen.
    Circle,
}

/// Rules of the elevation map and of the vehicle. Those of the obstacle map are in [`crate::TraversabilityRules`].
///
/// `docs/theory/rover.md` derives each mended rule and says what the printed one costs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct MapRules {
    /// Grid points that are known at the start, and after a scan that clears the map.
    pub start: StartRule,
    /// Elevation of the vehicle. Paper: the one cell under its origin, and by tilt while that is unknown. Mended: a
    /// prediction by tilt, corrected by a fit of the measured cells around.
    pub elevation: Rule,
    /// Paper: a new point goes to all of its eight neighbours that hold no new point, measured before or not. Mended:
    /// only to those where nothing was measured.
    pub extrapolate: Rule,
    /// Paper: of several points of a cell the last one stays. Mended: the highest of a frame or of a scan; those of
    /// later frames are blended by their errors.
    pub several: Rule,
    /// Paper: differences are not looked at. Mended: a new measurement against all earlier ones of its cell.
    pub inconsistency: Rule,
    /// How the vehicle stands. Paper: forty steps towards the best plane, with wheels of a few points. Mended: wheels as
    /// discs in contact with the true faces, solved.
    pub settle: Rule,
}

impl MapRules {
    /// All rules as the paper prints them.
    pub const AS_PRINTED: Self = Self {
        start: StartRule::Origin,
        elevation: Rule::Paper,
        extrapolate: Rule::Paper,
        several: Rule::Paper,
        inconsistency: Rule::Paper,
        settle: Rule::Paper,
    };

    /// All rules mended.
    pub const MENDED: Self = Self {
        start: StartRule::Origin,
        elevation: Rule::Mended,
        extrapolate: Rule::Mended,
        several: Rule::Mended,
        inconsistency: Rule::Mended,
        settle: Rule::Mended,
    };
}
