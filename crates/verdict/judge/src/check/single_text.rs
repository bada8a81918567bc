//! One judged ray of a recording in words.

use std::fmt::Write as _;

use crate::check::single::CheckedRay;
use crate::class::Class;
use crate::quantity::{Quantity, name_of};

impl CheckedRay {
    /// What the recording with this name says of each quantity, what is true, and the class, in lines.
    pub fn text(&self, name: &str) -> String {
        let Some(class) = self.class else { return format!("  {name} (candidate): not given\n") };
        let mut text = format!("  {name} (candidate): {} ({})\n", class_words(class), self.ruling);
        // What comes back of a pencil is judged as its own visibility says, so that one mistake counts once.
        let is_seen_otherwise = self.items.iter().any(|of| {
            of.item.quantity == Quantity::Visible && of.said.as_ref().is_some_and(|said| *said != of.truth)
        });
        for of in &self.items {
            let quantity = name_of(of.item);
            let Some(said) = &of.said else {
                let _ = writeln!(text, "    {quantity}: not given, true is {}", of.truth);
                continue;
            };
            let _ = write!(text, "    {quantity}: says {said}, true is {}", of.truth);
            if let Some(difference) = of.difference.filter(|difference| *difference != 0.0) {
                let unit = of.difference_unit;
                let space = if unit.is_empty() { "" } else { " " };
                let _ = write!(text, ", off by {difference:.3e}{space}{unit}");
            }
            if let Some(ratio) = of.ratio.filter(|ratio| *ratio != 0.0 && of.is_ratio_of_difference) {
                let _ = write!(text, ", {ratio:.2e} times its bound");
            }
            let without_class = match of.item.quantity {
                Quantity::PixelFlux => "judged by all pencils that land there",
                _ => "not compared",
            };
            let is_of_own = is_seen_otherwise
                && of.item.quantity == Quantity::PencilFlux
                && of.class.is_some_and(|class| class < Class::Undecided);
            let of_own = if is_of_own { " with its own visibility" } else { "" };
            let _ = writeln!(text, ": {}{of_own}", of.class.map_or(without_class, class_words));
        }
        if !self.what.is_empty() {
            let _ = writeln!(text, "    {}", self.what);
        }
        text
    }
}

fn class_words(class: Class) -> &'static str {
    match class {
        Class::Agree => "agrees",
        Class::Tie => "tie",
        Class::Rounding => "rounding",
        Class::Approximation => "approximation",
        Class::Undecided => "undecided",
        Class::Defect => "defect",
    }
}
