//! A diagnosis: the mistakes, and how much they explain.

use crate::mistake::Mistake;

/// The mistake that explains why a recording is wrong nearly everywhere, or the two.
#[derive(Debug, Clone, PartialEq)]
pub struct Diagnosis {
    /// One or two mistakes, in a fixed order.
    pub mistakes: Vec<Mistake>,
    /// Rays that agree once the mistakes are undone; of a mistake of the rays themselves (as hits on backs), rays that
    /// agree with a renderer that makes it.
    pub agree: u64,
    /// Rays on which this was tried: all that are compared, or a fixed sample of a large scene.
    pub tried: u64,
}

impl Diagnosis {
    /// Share of the tried rays that agree, from 0 to 1.
    pub fn share(&self) -> f64 {
        if self.tried == 0 { 0.0 } else { self.agree as f64 / self.tried as f64 }
    }

    /// What would make the recording right, as a clause that follows "if".
    pub fn clause(&self) -> String {
        let one = |mistake: &Mistake| {
            let (file, place) = mistake.docs();
            format!("{mistake} ({file}, {place})")
        };
        self.mistakes.iter().map(one).collect::<Vec<_>>().join(", and ")
    }

    /// The diagnosis as one sentence.
    ///
    /// ```
    /// use raypencil_diagnosis::{Diagnosis, Mistake};
    ///
    /// let found = Diagnosis { mistakes: vec![Mistake::RowsReversed], agree: 9999, tried: 10000 };
    /// let words = "99.99 % agree if rows are reversed: row 0 is the top row (docs/formats/files.md, Orientation)";
    /// assert_eq!(found.sentence(), words);
    /// ```
    pub fn sentence(&self) -> String {
        // Rounded down: only all of them are 100 %.
        let hundredths = self.agree.saturating_mul(10_000) / self.tried.max(1);
        let share = match hundredths {
            10_000 => "100".into(),
            part => format!("{}.{:02}", part / 100, part % 100),
        };
        format!("{share} % agree if {}", self.clause())
    }
}
