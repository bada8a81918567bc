//! A diagnosis: the mistakes, in which sensors, and how much they explain.

use crate::mistake::Mistake;
use raypencil_scene::SensorId;
use serde_json::{Value, json};

/// One mistake, or two at once, that explains why rays of some sensors are wrong.
#[derive(Debug, Clone, PartialEq)]
pub struct Reason {
    /// The sensors whose wrong rays it explains, the camera first.
    pub sensors: Vec<SensorId>,
    /// Whether these are all sensors of which anything was compared.
    pub is_everywhere: bool,
    /// One or two mistakes, in a fixed order.
    pub mistakes: Vec<Mistake>,
    /// Wrong rays on which this was tried: all of these sensors, or a fixed sample of many.
    pub wrong: u64,
    /// Those that become right once the mistakes are undone; of a mistake of the rays themselves (as hits on backs),
    /// those that agree with a renderer that makes it.
    pub explained: u64,
    /// Right rays on which this was tried.
    pub right: u64,
    /// Those that become wrong.
    pub broken: u64,
}

impl Reason {
    /// Share of the wrong rays that it explains, from 0 to 1.
    pub fn share(&self) -> f64 {
        if self.wrong == 0 { 0.0 } else { self.explained as f64 / self.wrong as f64 }
    }

    /// What would make the rays right, as a clause that follows "if".
    pub fn clause(&self) -> String {
        let one = |mistake: &Mistake| {
            let (file, place) = mistake.docs();
            format!("{mistake} ({file}, {place})")
        };
        self.mistakes.iter().map(one).collect::<Vec<_>>().join(", and ")
    }

    /// The reason for programs: `reason` of `docs/formats/check.schema.json`.
    pub fn to_json(&self) -> Value {
        let mistakes = self.mistakes.iter().map(|mistake| {
            let (file, place) = mistake.docs();
            json!({ "name": mistake.key(), "what": mistake.to_string(), "docs": format!("{file}, {place}") })
        });
        json!({
            "bundles": self.sensors.iter().map(ToString::to_string).collect::<Vec<_>>(),
            "explained": self.explained,
            "wrong": self.wrong,
            "broken": self.broken,
            "right": self.right,
            "mistakes": mistakes.collect::<Vec<_>>(),
        })
    }

    /// The reason as one sentence, without its full stop.
    ///
    /// ```
    /// use raypencil_diagnosis::{Mistake, Reason};
    /// use raypencil_scene::SensorId;
    ///
    /// let mut reason = Reason {
    ///     sensors: vec![SensorId::Beam(0)],
    ///     is_everywhere: false,
    ///     mistakes: vec![Mistake::RowsReversed],
    ///     wrong: 10_000,
    ///     explained: 9_999,
    ///     right: 240,
    ///     broken: 0,
    /// };
    /// let rule = "rows are reversed: row 0 is the top row (docs/formats/files.md, Orientation)";
    /// let words = format!("99.99 % of the wrong rays of beam-0 agree if {rule}, and no right ray breaks");
    /// assert_eq!(reason.sentence(), words);
    ///
    /// reason.is_everywhere = true;
    /// reason.broken = 1;
    /// let words = format!("99.99 % of the wrong rays agree if {rule}, and 1 of 240 right rays breaks");
    /// assert_eq!(reason.sentence(), words);
    /// ```
    pub fn sentence(&self) -> String {
        // Rounded down: only all of them are 100 %.
        let hundredths = self.explained.saturating_mul(10_000) / self.wrong.max(1);
        let share = match hundredths {
            10_000 => "100".into(),
            part => format!("{}.{:02}", part / 100, part % 100),
        };
        let whose = if self.is_everywhere { String::new() } else { format!(" of {}", listed(&self.sensors)) };
        let broken = match self.broken {
            0 => "no right ray breaks".into(),
            1 => format!("1 of {} right rays breaks", self.right),
            many => format!("{many} of {} right rays break", self.right),
        };
        format!("{share} % of the wrong rays{whose} agree if {}, and {broken}", self.clause())
    }
}

/// Why rays are wrong, sensor by sensor.
#[derive(Debug, Clone, PartialEq)]
pub struct Diagnosis {
    /// Reasons, each of other sensors; at least one.
    pub reasons: Vec<Reason>,
    /// Sensors with wrong rays that no reason explains.
    pub unexplained: Vec<SensorId>,
}

impl Diagnosis {
    /// The diagnosis as one sentence, without its full stop.
    pub fn sentence(&self) -> String {
        let mut parts: Vec<String> = self.reasons.iter().map(Reason::sentence).collect();
        if !self.unexplained.is_empty() {
            parts.push(format!("for the wrong rays of {} no reason is known", listed(&self.unexplained)));
        }
        parts.join("; ")
    }

    /// The diagnosis for programs: `diagnosis` of `docs/formats/check.schema.json`.
    pub fn to_json(&self) -> Value {
        json!({
            "reasons": self.reasons.iter().map(Reason::to_json).collect::<Vec<_>>(),
            "unexplained": self.unexplained.iter().map(ToString::to_string).collect::<Vec<_>>(),
        })
    }

    /// The reason that concerns a sensor.
    pub fn of(&self, sensor: SensorId) -> Option<&Reason> {
        self.reasons.iter().find(|reason| reason.sensors.contains(&sensor))
    }
}

/// Sensors as a list in words.
fn listed(sensors: &[SensorId]) -> String {
    let name = |sensor: &SensorId| match sensor {
        SensorId::Camera => "the camera".to_string(),
        beam => beam.to_string(),
    };
    let names: Vec<String> = sensors.iter().map(name).collect();
    match names.as_slice() {
        [] => String::new(),
        [one] => one.clone(),
        [some @ .., last] => format!("{} and {last}", some.join(", ")),
    }
}
