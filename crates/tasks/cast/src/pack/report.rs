//! A check of a pack of rays in the form of every check.

use raypencil_judge::Class;
use raypencil_pack::{BundleFindings, CheckFindings, ItemFindings, PackForm, PackLabel, WorstOf, WrongRay};
use raypencil_report::{DefectLine, Document, counted};
use raypencil_scene::{FaceId, Reading};
use serde_json::{Map, Value, json};

use super::check::RayPackChecked;
use crate::comparison::{Wrong, wrong_text};
use crate::page::{CastPage, ComparedHits};
use crate::text::counts_text;

/// Wrong rays that are listed, at most.
const MAX_LISTED: usize = 12;

/// Key of the first hits, beside those of the values.
const HIT: &str = "hit";

impl RayPackChecked {
    /// The check for a screen and for programs.
    pub fn document(&self) -> Document {
        self.findings().document()
    }

    /// The same with the pictures of its page, and the part that answers when asked.
    pub fn document_with_pictures(&self) -> Document {
        let title = format!("{} on {}", self.name, self.pack);
        let page = CastPage {
            title: &title,
            facts: &[],
            shape: &self.rays.shape,
            rays: &self.rays.rays,
            answers: &self.answers,
            set: None,
            compared: Some(ComparedHits {
                name: &self.name,
                stated: &self.stated,
                comparison: &self.comparison,
                ray_command: &|index| self.ray_command(index),
            }),
        };
        let (explorer, notes) = page.explorer_with_notes();
        let mut findings = self.findings();
        findings.notes.extend(notes);
        CheckFindings { explorer, ..findings }.document()
    }

    fn findings(&self) -> CheckFindings {
        let bundle = self.bundle("rays");
        CheckFindings {
            form: PackForm::Rays,
            pack: self.pack.clone(),
            pack_remark: "",
            pack_sha256: self.pack_sha256.clone(),
            label: PackLabel::NONE,
            is_published: false,
            has_answers: false,
            candidate: self.name.clone(),
            arithmetic: Some(self.comparison.precision),
            totals: bundle.items.clone(),
            worst: bundle.listed.iter().map(|wrong| wrong.line.clone()).collect(),
            coarseness: None,
            headline: None,
            why: self.why.clone(),
            notes: self.notes(),
            sharpness: None,
            sizes: None,
            facts: Vec::new(),
            of_form: Map::new(),
            pictures: String::new(),
            explorer: String::new(),
            bundles: vec![bundle],
        }
    }

    /// What the rays are, and what was judged of a cloud.
    fn notes(&self) -> Vec<String> {
        let mut notes = vec![format!("{}.", counts_text(&self.answers))];
        let Some(cloud) = &self.cloud else { return notes };
        let range = if cloud.has_range { ", and the field range" } else { "" };
        notes.push(format!(
            "{} in the frame of {}, laid on the rays {}. Judged: x, y, z, which rays have a point{range}.",
            counted(cloud.points as u64, "point", "points"),
            cloud.frame.words(),
            cloud.assigned
        ));
        let of_kind = |is_kind: fn(&Wrong) -> bool| {
            self.comparison.wrong().filter(|(_, wrong)| is_kind(wrong)).count() as u64
        };
        let missing = of_kind(|wrong| {
            matches!(wrong, Wrong::Hit { stated: Reading::Miss | Reading::TooNear, exact: Reading::Hit(_) })
        });
        let invented =
            of_kind(|wrong| matches!(wrong, Wrong::Distance { exact: Reading::Miss | Reading::TooNear, .. }));
        if missing + invented > 0 {
            notes.push(format!(
                "{} without a point that should have one; {} where nothing is measured.",
                counted(missing, "ray", "rays"),
                counted(invented, "point", "points")
            ));
        }
        if cloud.wrong_keys > 0 {
            notes.push(format!(
                "Ring, channel or time of {} are those of another ray.",
                counted(cloud.wrong_keys as u64, "point", "points")
            ));
        }
        if let Some(first) = cloud.strays.first() {
            notes.push(format!(
                "{} of no ray, or of one that has another point; the first is point {first}, counted from 0.",
                counted(cloud.strays.len() as u64, "point", "points")
            ));
        }
        notes
    }

    /// The rays as a bundle of this name.
    pub fn bundle(&self, name: &str) -> BundleFindings {
        let counts = self.comparison.counts();
        let mut by_class = [0; Class::COUNT];
        by_class[Class::Agree as usize] = counts.same - counts.ties;
        by_class[Class::Tie as usize] = counts.ties;
        by_class[Class::Rounding as usize] = counts.rounding;
        by_class[Class::Defect as usize] = counts.wrong;
        // A ray with a wrong value has the right hit.
        let is_of_values = |(_, wrong): &(usize, Wrong)| matches!(wrong, Wrong::Value { .. });
        let wrong_values = self.comparison.wrong().filter(is_of_values).count() as u64;
        let mut of_hits = by_class;
        of_hits[Class::Defect as usize] -= wrong_values;
        of_hits[Class::Agree as usize] += wrong_values;
        let hits = ItemFindings {
            key: HIT.into(),
            name: "first hit".into(),
            unit: "",
            storage: None,
            not_given: None,
            by_class: of_hits,
            not_compared: 0,
            worst_ulp: None,
            worst_error: None,
            worst_ratio: None,
        };
        let values = self.comparison.values.iter().map(|tally| {
            let mut by_class = [0; Class::COUNT];
            by_class[Class::Defect as usize] = tally.wrong;
            by_class[Class::Agree as usize] = tally.compared - tally.wrong;
            let worst_ratio = tally.worst.map(|(value, index)| WorstOf {
                value,
                place: format!("{name} {index}"),
                bundle: name.into(),
                ray: vec![index as u64],
                ruling: None,
                command: self.ray_command(index),
            });
            ItemFindings {
                key: tally.value.name().into(),
                name: tally.value.name().into(),
                by_class,
                worst_ratio,
                ..hits.clone()
            }
        });
        let listed = self.comparison.wrong().take(MAX_LISTED);
        BundleFindings {
            name: name.into(),
            hits_anything: self.comparison.met > 0,
            must_hit: true,
            by_class,
            not_compared: 0,
            ruled: counts.rounding + counts.wrong,
            items: std::iter::once(hits.clone()).chain(values).collect(),
            listed: listed.map(|(index, wrong)| self.wrong_ray(name, index, &wrong)).collect(),
            why: self.why.clone(),
        }
    }

    /// A wrong ray, for people and for programs.
    fn wrong_ray(&self, bundle: &str, index: usize, wrong: &Wrong) -> WrongRay {
        let key = match wrong {
            Wrong::Value { value, .. } => value.name(),
            _ => HIT,
        };
        let command = self.ray_command(index);
        let words = wrong_text(wrong);
        let (said, exact) = said_and_true(wrong);
        let (difference, ratio) = match wrong {
            Wrong::Value { error, bound, .. } => (Some(*error), Some(error / bound)),
            _ => (None, None),
        };
        let finite = |value: Option<f64>| value.filter(|value| value.is_finite());
        WrongRay {
            key: key.into(),
            data: json!({
                "bundle": bundle,
                "ray": [index],
                "quantity": key,
                "said": [{ "who": self.name, "value": said }],
                "true": exact,
                "difference": finite(difference),
                "difference_unit": "",
                "ratio": finite(ratio),
                "margin": Value::Null,
                "what": words,
                "command": command,
            }),
            line: DefectLine {
                place: format!("{bundle} {index}"),
                quantity: if key == HIT { "first hit".into() } else { key.into() },
                words,
                command,
                ..DefectLine::default()
            },
        }
    }
}

/// The stated answer, and the exact one where there is one.
fn said_and_true(wrong: &Wrong) -> (String, Option<String>) {
    let face = |read: &Reading<FaceId>| match read {
        Reading::Hit(face) => format!("face {}", face.0),
        Reading::TooNear => "too near".into(),
        Reading::Miss => "no hit".into(),
    };
    match wrong {
        Wrong::Hit { stated, exact } => (face(stated), Some(face(exact))),
        Wrong::Distance { stated, exact } => (
            stated.to_string(),
            Some(match exact {
                Reading::Hit(exact) => exact.to_string(),
                Reading::TooNear => "too near".into(),
                Reading::Miss => "no hit".into(),
            }),
        ),
        Wrong::Contradiction => ("too near in one of t and range".into(), None),
        Wrong::Value { value, .. } => (value.name().into(), None),
    }
}
