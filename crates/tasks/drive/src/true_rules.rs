//! Which rule of the vehicle's truth stops it: words, sentences and counts.

use raypencil_chassis::ObstructionKind;
use raypencil_report::count;

/// Numbers of sectors with a true obstacle, by the rule that stops the vehicle at it. (docs/theory/rover.md, "The truth")
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct TrueRules {
    /// One front wheel would stand too much higher than the other.
    pub front_slope: u64,
    /// One rear wheel would.
    pub rear_slope: u64,
    /// The vehicle would stand too steep, up or down.
    pub length_slope: u64,
    /// It would tip over.
    pub tip_over: u64,
    /// The ground would touch the underside.
    pub belly: u64,
    /// A wheel would have to climb too high a step.
    pub step: u64,
}

impl TrueRules {
    /// Counts a sector.
    pub(crate) fn add(&mut self, kind: ObstructionKind) {
        *match kind {
            ObstructionKind::FrontSlope => &mut self.front_slope,
            ObstructionKind::RearSlope => &mut self.rear_slope,
            ObstructionKind::LengthSlope => &mut self.length_slope,
            ObstructionKind::TipOver => &mut self.tip_over,
            ObstructionKind::Belly => &mut self.belly,
            ObstructionKind::Step => &mut self.step,
        } += 1;
    }

    /// Each rule's word in files, and its count.
    pub(crate) fn all(self) -> [(&'static str, u64); 6] {
        let Self { front_slope, rear_slope, length_slope, tip_over, belly, step } = self;
        [
            ("front_slope", front_slope),
            ("rear_slope", rear_slope),
            ("length_slope", length_slope),
            ("tip_over", tip_over),
            ("belly", belly),
            ("step", step),
        ]
    }

    /// "true obstacles by rule: length slope 12, belly 3"; `None` without any.
    pub(crate) fn sentence(self) -> Option<String> {
        let parts: Vec<String> = self
            .all()
            .into_iter()
            .filter(|(_, sectors)| *sectors > 0)
            .map(|(word, sectors)| format!("{} {}", word.replace('_', " "), count(sectors)))
            .collect();
        (!parts.is_empty()).then(|| format!("true obstacles by rule: {}", parts.join(", ")))
    }
}

/// Word of a rule in files.
pub(crate) fn rule_word(kind: ObstructionKind) -> &'static str {
    let mut one = TrueRules::default();
    one.add(kind);
    one.all().into_iter().find(|(_, sectors)| *sectors > 0).map_or("", |(word, _)| word)
}

/// A rule as the end of a sentence about the vehicle.
pub(crate) fn rule_words(kind: ObstructionKind) -> &'static str {
    match kind {
        ObstructionKind::FrontSlope => "one front wheel would stand too high above the other",
        ObstructionKind::RearSlope => "one rear wheel would stand too high above the other",
        ObstructionKind::LengthSlope => "it would stand too steep from its front to its rear wheels",
        ObstructionKind::TipOver => "it would tip over",
        ObstructionKind::Belly => "the ground would touch its belly",
        ObstructionKind::Step => "a wheel would have to climb too high a step",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_rule_has_its_own_count_and_word() {
        let kinds = [
            (ObstructionKind::FrontSlope, "front_slope"),
            (ObstructionKind::RearSlope, "rear_slope"),
            (ObstructionKind::LengthSlope, "length_slope"),
            (ObstructionKind::TipOver, "tip_over"),
            (ObstructionKind::Belly, "belly"),
            (ObstructionKind::Step, "step"),
        ];
        let mut rules = TrueRules::default();
        assert_eq!(rules.sentence(), None);
        for (number, (kind, word)) in kinds.into_iter().enumerate() {
            assert_eq!(rule_word(kind), word);
            (0..=number).for_each(|_| rules.add(kind));
        }
        assert_eq!(rules.all().map(|(_, sectors)| sectors), [1, 2, 3, 4, 5, 6]);
        let said = rules.sentence().unwrap();
        assert_eq!(
            said,
            "true obstacles by rule: front slope 1, rear slope 2, length slope 3, tip over 4, belly 5, step 6"
        );
    }
}
