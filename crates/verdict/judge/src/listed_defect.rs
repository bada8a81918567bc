//! A defect as reports list it: what is said, what is true, the difference, and how far the ray is from another answer.

use std::fmt::Write as _;

use crate::quantity::{Item, key_of};
use raypencil_scene::{FluxModel, Place};
use serde_json::{Value, json};

/// How far a ray is from another answer: an interval that the referee proves.
#[derive(Debug, Clone, PartialEq)]
pub struct DefectMargin {
    /// What changes at the margin: `face`, `surface`, `visibility` or `landing`.
    pub of: &'static str,
    /// `cells` of the sensor, or `pixels` of the camera.
    pub unit: &'static str,
    /// No displacement below this one changes it.
    pub lo: f64,
    /// A displacement that changes it; 1 if none was found below one cell.
    pub hi: f64,
}

/// A defect as reports list it.
#[derive(Debug, Clone, PartialEq)]
pub struct ListedDefect {
    /// The ray.
    pub place: Place,
    /// The item that is wrong.
    pub item: Item,
    /// Each side's name and what it says of the item.
    pub said: Vec<(String, String)>,
    /// What is true of the item; empty if the referee has no single answer, as for an image of several beams.
    pub truth: String,
    /// How far the farther side is from the truth (without a truth: from the other side), in `difference_unit`. Of a
    /// hit or a face it is the difference of the ranges. `None` if one of both is no number.
    pub difference: Option<f64>,
    /// Unit of the difference; empty for a pure number.
    pub difference_unit: &'static str,
    /// Ratio of the error to its bound; `None` for what has no bound, such as a face.
    pub ratio: Option<f64>,
    /// How far the ray is from another answer; `None` for the flux of a pixel, which is of many rays.
    pub margin: Option<DefectMargin>,
    /// All that is wrong with the ray, in words, with the ruling.
    pub what: String,
}

impl ListedDefect {
    /// The defect as a JSON object; `probe` is the command that shows its ray.
    pub fn to_json(&self, model: FluxModel, probe: &str) -> Value {
        let finite = |value: Option<f64>| value.filter(|value| value.is_finite());
        let said: Vec<Value> =
            self.said.iter().map(|(who, value)| json!({ "who": who, "value": value })).collect();
        let margin = self
            .margin
            .as_ref()
            .map(|DefectMargin { of, unit, lo, hi }| json!({ "of": of, "unit": unit, "interval": [lo, hi] }));
        json!({
            "sensor": self.place.sensor.to_string(), "i": self.place.i, "j": self.place.j,
            "quantity": key_of(model, self.item),
            "said": said,
            "true": (!self.truth.is_empty()).then_some(&self.truth),
            "difference": finite(self.difference),
            "difference_unit": self.difference_unit,
            "ratio": finite(self.ratio),
            "margin": margin,
            "what": self.what,
            "probe": probe,
        })
    }

    /// The defect in one sentence: said, true, difference, margin.
    ///
    /// ```
    /// use raypencil_judge::{DefectMargin, ListedDefect, Quantity};
    /// use raypencil_scene::{Place, SensorId};
    ///
    /// let defect = ListedDefect {
    ///     place: Place { sensor: SensorId::Camera, i: 3, j: 4 },
    ///     item: Quantity::Range.into(),
    ///     said: vec![("mine".into(), "4.5 m".into())],
    ///     truth: "4 m".into(),
    ///     difference: Some(0.5),
    ///     difference_unit: "m",
    ///     ratio: Some(1e12),
    ///     margin: Some(DefectMargin { of: "face", unit: "cells", lo: 0.25, hi: 0.375 }),
    ///     what: String::new(),
    /// };
    /// assert_eq!(
    ///     defect.words(),
    ///     "mine says 4.5 m; true is 4 m; off by 5.000e-1 m, 1.00e12 times its bound; \
    ///      face margin 0.250 to 0.375 cells"
    /// );
    /// ```
    pub fn words(&self) -> String {
        let said: Vec<String> = self.said.iter().map(|(who, what)| format!("{who} says {what}")).collect();
        let mut text = said.join(", ");
        if !self.truth.is_empty() {
            let _ = write!(text, "; true is {}", self.truth);
        }
        if let Some(difference) = self.difference {
            let unit = self.difference_unit;
            let _ = write!(text, "; off by {difference:.3e}{}{unit}", if unit.is_empty() { "" } else { " " });
        }
        if let Some(ratio) = self.ratio {
            let joint = if self.difference.is_some() { ", " } else { "; " };
            let _ = match ratio.is_finite() {
                true => write!(text, "{joint}{ratio:.2e} times its bound"),
                false => write!(text, "{joint}where no error is allowed"),
            };
        }
        if let Some(DefectMargin { of, unit, lo, hi }) = &self.margin {
            let number = |x: f64| if x >= 1e-3 { format!("{x:.3}") } else { format!("{x:.2e}") };
            let _ = match *lo >= 1.0 {
                true => write!(text, "; {of} margin at least 1 {}", unit.trim_end_matches('s')),
                false => write!(text, "; {of} margin {} to {} {unit}", number(*lo), number(*hi)),
            };
        }
        text
    }
}
