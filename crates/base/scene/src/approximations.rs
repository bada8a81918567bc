//! A switch per approximation of the paper: as the paper has it, or exact. One code path serves both.

use std::fmt;

/// Which side a switch is on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub enum Fidelity {
    /// What the contract's rays really meet.
    #[default]
    Exact,
    /// What the paper's text computes.
    Paper,
}

impl fmt::Display for Fidelity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Exact => "exact",
            Self::Paper => "paper",
        })
    }
}

/// The approximations of the paper that can be had or left, each by itself.
///
/// ```
/// use raypencil_scene::{Fidelity, Switches};
///
/// let mut switches = Switches::EXACT;
/// switches.set("beam-edges", Fidelity::Paper)?;
/// assert_eq!(switches.to_string(), "beam-edges");
/// assert_eq!(Switches::subsets().count(), 32);
/// # Ok::<(), raypencil_scene::UnknownSwitch>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct Switches {
    /// `beam-edges`: how the sides of a face are drawn on a beam's grid. The camera is not concerned.
    ///
    /// * `Exact`: row y of the grid is the plane y = const of space, which cuts a side in one point.
    /// * `Paper`: faces are clipped to the stripe (figures 8, 9), their vertices projected, and straight
    ///   lines drawn between. It costs accuracy where a side leans and recedes at once: one that crosses the
    ///   sheet from (x, z) to (x', z') is off by up to about (x'/z' - x/z) (z' - z) / (2 (z + z')) g on the
    ///   grid, nothing for a thin sheet, hundreds of columns for a thick one that grazes the ground. A pencil
    ///   between line and curve gets the face that the line gives it, at the range of that face's plane, and
    ///   time: every face is clipped.
    pub beam_edges: Fidelity,
    /// `skip-rules`: rules 1b, 3a, 3b and 3c of §4. (1a is the same on both sides.)
    ///
    /// * `Exact`: conservative forms; skipping saves time and never changes a map. Facing is asked per row
    ///   of a beam.
    /// * `Paper`: as printed. 3b loses faces, in both sensors, whose vertices lie beyond the maximum range
    ///   and whose interior does not; with straight beam edges that can be the whole stripe on a wall. 1b,
    ///   asked once per face, makes a beam lose and add hits on faces that its rows see from different
    ///   sides, those added with a negative cosine of incidence. 3c loses faces whose curved sides reach
    ///   into a beam's screen where the straight lines between their corners do not; never if `beam_edges`
    ///   is `Paper` too.
    pub skip_rules: Fidelity,
    /// `facing`: which faces may stand between a stripe and the camera. (§6) Maps are not concerned, here and
    /// below.
    ///
    /// * `Exact`: every face, from either side.
    /// * `Paper`: those whose outward normal "makes an angle of less than 90 degrees with respect to the camera
    ///   axis vector". It saves little. On closed ground a hidden point lies behind *some* back, so nothing is lost
    ///   where every ray to a stripe sees the sides of faces that the axis sees: that is wrong off the axis,
    ///   where a back of the camera's ray may still lean towards its axis, and on ground that is not closed. The
    ///   rule *loses* shadows and adds none.
    pub facing: Fidelity,
    /// `extent`: how deep the faces reach that may stand between a stripe and the camera. (§6)
    ///
    /// * `Exact`: however deep; what lies behind all points is skipped, which changes nothing.
    /// * `Paper`: "only considering triangles with a least one vertex not past the furthest extent of the upper
    ///   laser beam", the greatest depth, along the camera's axis, of the upper beam's hits in this frame. It
    ///   loses shadows on points deeper than that: where the other beam reaches beyond the upper one, because
    ///   that ends at a rock or finds nothing within its range on most of its pencils.
    pub extent: Fidelity,
    /// `place`: where a stripe's point is compared with what may hide it. (§6)
    ///
    /// * `Exact`: at the point's own position on the image.
    /// * `Paper`: at the centre of the pixel it lands in, against a range map of the faces turned away (with
    ///   every face, the stripe's own would hide half of it). Which are turned away `facing` says: from the
    ///   camera's axis on `paper`, from the ray through its position on `exact`. It is wrong, either way, by up
    ///   to half a pixel along the outlines of what hides, and loses what is not closed or narrower than a pixel.
    pub place: Fidelity,
}

impl Switches {
    /// No approximation.
    pub const EXACT: Self = Self::all(Fidelity::Exact);
    /// All of the paper's.
    pub const PAPER: Self = Self::all(Fidelity::Paper);
    /// Names of the switches, in the order of the fields.
    pub const NAMES: [&'static str; 5] = ["beam-edges", "skip-rules", "facing", "extent", "place"];

    const fn all(on: Fidelity) -> Self {
        Self { beam_edges: on, skip_rules: on, facing: on, extent: on, place: on }
    }

    /// Sets a switch by its name.
    ///
    /// # Errors
    /// If there is no switch of that name.
    pub fn set(&mut self, name: &str, fidelity: Fidelity) -> Result<(), UnknownSwitch> {
        let index = Self::NAMES.iter().position(|known| *known == name);
        let index = index.ok_or_else(|| UnknownSwitch(name.to_string()))?;
        *self.in_order()[index] = fidelity;
        Ok(())
    }

    /// How many stand on `paper`.
    pub fn count(self) -> usize {
        self.iter().filter(|(_, fidelity)| *fidelity == Fidelity::Paper).count()
    }

    /// Whether every switch that stands on `paper` in `other` does so here.
    pub fn contains(self, other: Self) -> bool {
        self.iter().zip(other.iter()).all(|((_, mine), (_, theirs))| mine >= theirs)
    }

    /// These, but `exact` where `other` stands on `paper`.
    #[must_use]
    pub fn without(mut self, mut other: Self) -> Self {
        for (mine, theirs) in self.in_order().into_iter().zip(other.in_order()) {
            if *theirs == Fidelity::Paper {
                *mine = Fidelity::Exact;
            }
        }
        self
    }

    /// All that stand on `paper` in either.
    #[must_use]
    pub fn union(mut self, mut other: Self) -> Self {
        for (mine, theirs) in self.in_order().into_iter().zip(other.in_order()) {
            *mine = (*mine).max(*theirs);
        }
        self
    }

    /// Every switch's name and side, in the order of [`Switches::NAMES`].
    pub fn iter(&self) -> impl Iterator<Item = (&'static str, Fidelity)> + use<> {
        Self::NAMES.into_iter().zip([self.beam_edges, self.skip_rules, self.facing, self.extent, self.place])
    }

    /// All combinations, from [`Switches::EXACT`] to [`Switches::PAPER`].
    pub fn subsets() -> impl Iterator<Item = Self> {
        (0..1_u32 << Self::NAMES.len()).map(|bits| {
            let mut switches = Self::EXACT;
            for (k, switch) in switches.in_order().into_iter().enumerate() {
                if bits >> k & 1 == 1 {
                    *switch = Fidelity::Paper;
                }
            }
            switches
        })
    }

    fn in_order(&mut self) -> [&mut Fidelity; 5] {
        [&mut self.beam_edges, &mut self.skip_rules, &mut self.facing, &mut self.extent, &mut self.place]
    }
}

/// The names of the switches that stand on `paper`, joined with `+`; nothing if none does.
impl fmt::Display for Switches {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut separator = "";
        for (name, fidelity) in self.iter() {
            if fidelity == Fidelity::Paper {
                write!(f, "{separator}{name}")?;
                separator = "+";
            }
        }
        Ok(())
    }
}

/// A name that is no switch's.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnknownSwitch(pub String);

impl fmt::Display for UnknownSwitch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "no switch is called {:?}; there are {}", self.0, Switches::NAMES.join(", "))
    }
}

impl std::error::Error for UnknownSwitch {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn switches_are_set_by_name() {
        for (k, name) in Switches::NAMES.into_iter().enumerate() {
            let mut switches = Switches::EXACT;
            switches.set(name, Fidelity::Paper).unwrap();
            // That one and no other.
            let on: Vec<_> = switches.iter().map(|(_, fidelity)| fidelity == Fidelity::Paper).collect();
            assert_eq!(on.iter().filter(|on| **on).count(), 1);
            assert!(on[k]);
            assert_eq!(switches.to_string(), name);
            switches.set(name, Fidelity::Exact).unwrap();
            assert_eq!(switches, Switches::EXACT);
        }
        let mut switches = Switches::EXACT;
        let error = switches.set("beam_edges", Fidelity::Paper).unwrap_err();
        assert_eq!(
            error.to_string(),
            "no switch is called \"beam_edges\"; there are beam-edges, skip-rules, facing, extent, place"
        );
    }

    #[test]
    fn every_combination_comes_once() {
        let names: Vec<_> = Switches::subsets().map(|switches| switches.to_string()).collect();
        assert_eq!(names[..5], ["", "beam-edges", "skip-rules", "beam-edges+skip-rules", "facing"]);
        assert_eq!(names[31], "beam-edges+skip-rules+facing+extent+place");
        let mut different = names.clone();
        different.sort();
        different.dedup();
        assert_eq!((names.len(), different.len()), (32, 32));
        assert_eq!(Switches::subsets().next(), Some(Switches::EXACT));
        assert_eq!(Switches::subsets().last(), Some(Switches::PAPER));
    }

    #[test]
    fn sets_of_switches() {
        for a in Switches::subsets() {
            for b in Switches::subsets() {
                let union = a.union(b);
                assert!(union.contains(a) && union.contains(b));
                assert_eq!(a.contains(b), union == a);
                assert_eq!(a.without(b).count(), union.count() - b.count());
                assert!(a.contains(a.without(b)));
            }
        }
    }
}
