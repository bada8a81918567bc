//! A check of a pack of rays in the form of every check.

use std::collections::{BTreeMap, BTreeSet};

use raypencil_judge::Class;
use raypencil_pack::{
    BundleFindings, CheckFindings, ItemFindings, PackForm, PackLabel, Said, WorstOf, WrongRay,
    half_precision_note,
};
use raypencil_report::{DefectLine, Document, count, counted};
use raypencil_scene::{FaceId, Reading};
use serde_json::Map;

use super::check::RayPackChecked;
use super::kept_answers::MAX_COUNTED;
use crate::comparison::{RayVerdict, Wrong, wrong_text};
use crate::page::{CastPage, ComparedHits};
use crate::text::counts_text;

/// Wrong rays that are listed, at most.
const MAX_LISTED: usize = 12;

/// Key of the first hits, beside those of the values.
const HIT: &str = "hit";

/// Key of the fields of a cloud that tell the ray of a point.
const KEYS: &str = "ring_channel_time";

/// Key of the field of a cloud that has the number of a return.
const NUMBERS: &str = "return_number";

/// Key of points that belong to no ray, or to one that has another.
const STRAYS: &str = "points";

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
            mesh: self.mesh.as_ref(),
            set: None,
            has_arrays: false,
            scan: self.scan.as_ref().map(|scan| scan.on_page("scan")),
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
            coarseness: self.stated.stored.coarseness(),
            headline: self.headline(),
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
        if self.mesh.is_some() && self.rays.rays.len() > MAX_COUNTED {
            notes.push(format!(
                "How many rays test backs, limits and lengths, and the hits behind the first one, are the pack's own word: not computed again \
                 beyond {} rays.",
                count(MAX_COUNTED as u64)
            ));
        }
        if !self.unread.is_empty() {
            notes.push(format!("Not read, for no array has that name: {}.", self.unread.join(", ")));
        }
        notes.extend(self.absent_note());
        let Some(cloud) = &self.cloud else {
            let halves: Vec<&str> = self.stated.stored.coarse.iter().map(|(value, _)| value.name()).collect();
            if !halves.is_empty() {
                notes.push(format!("{}.", half_precision_note(&halves.join(", "))));
            }
            return notes;
        };
        let range = cloud.has_range.then_some("range");
        let fields: Vec<&str> =
            cloud.keys.iter().chain(&cloud.number_field).map(String::as_str).chain(range).collect();
        let fields = match fields[..] {
            [] => String::new(),
            [one] => format!(", and the field {one}"),
            _ => format!(", and the fields {}", fields.join(", ")),
        };
        notes.push(format!(
            "{}{} in the frame of {}, laid on the rays {}. Judged: x, y, z, which rays have a point{fields}.",
            counted(cloud.points as u64, "point", "points"),
            cloud.source.as_ref().map_or(String::new(), |source| format!(" of {source}")),
            cloud.frame.words(),
            cloud.assigned
        ));
        if !cloud.unjudged.is_empty() {
            notes.push(format!(
                "Not judged, as the pack knows nothing of them, or another field was judged in their place: {}.",
                cloud.unjudged.join(", ")
            ));
        }
        if let Some(steps) = &cloud.steps {
            let needed = match cloud.excused {
                _ if !self.comparison.passes() => String::new(),
                0 => " No point is further off than arithmetic alone explains.".into(),
                1 => " 1 point is further off than arithmetic alone explains, and agrees by that.".into(),
                more => {
                    format!(
                        " {} points are further off than arithmetic alone explains, and agree by that.",
                        count(more)
                    )
                }
            };
            notes.push(format!(
                "Its numbers are printed in {steps} and judged as such: errors below half a step cannot be seen.{needed}"
            ));
        }
        if let Some(places) = cloud.returns_of_beam {
            let beams = counted(self.rays.rays.len().div_ceil(places) as u64, "beam", "beams");
            notes.push(format!(
                "A ray is the leading ray of a return of {beams}, up to {places} each; without a return it meets nothing."
            ));
        }
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
        if !cloud.wrong_keys.is_empty() {
            notes.push(format!(
                "Ring, channel or time of {} are those of another ray.",
                counted(cloud.wrong_keys.len() as u64, "point", "points")
            ));
        }
        if !cloud.wrong_numbers.is_empty() {
            notes.push(format!(
                "The number of return of {} is another than that of its return.",
                counted(cloud.wrong_numbers.len() as u64, "point", "points")
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

    /// What is wrong with a cloud, if it is more than wrong rays: a point of no ray is no ray. Of answers that say only which rays hit,
    /// that no more is known: a right hit alone is no exact answer.
    fn headline(&self) -> Option<String> {
        if let Some(sentence) = self.hits_alone() {
            return Some(sentence);
        }
        let cloud = self.cloud.as_ref()?;
        let wrong = self.comparison.counts().wrong;
        let rays = count(self.comparison.verdicts.len() as u64);
        let of_rays = match wrong {
            0 => None,
            1 => Some(format!("1 of {rays} rays is wrong")),
            more => Some(format!("{} of {rays} rays are wrong", count(more))),
        };
        let keys = cloud.wrong_keys.len() as u64;
        let of_keys = (keys > 0).then(|| {
            format!("ring, channel or time of {} are those of another ray", counted(keys, "point", "points"))
        });
        let numbers = cloud.wrong_numbers.len() as u64;
        let of_numbers = (numbers > 0)
            .then(|| format!("the number of return of {} is another", counted(numbers, "point", "points")));
        let strays = cloud.strays.len() as u64;
        let of_strays = (strays > 0).then(|| {
            let are = if strays == 1 { "is" } else { "are" };
            format!("{} {are} of no ray, or of one that has another", counted(strays, "point", "points"))
        });
        (keys + numbers + strays > 0).then(|| {
            let said: Vec<String> = [of_rays, of_keys, of_numbers, of_strays].into_iter().flatten().collect();
            format!("{}.", capital(&said.join("; ")))
        })
    }

    /// The rays as a bundle of this name.
    pub fn bundle(&self, name: &str) -> BundleFindings {
        let counts = self.comparison.counts();
        let (keys, numbers, strays) = match &self.cloud {
            Some(cloud) => {
                (cloud.wrong_keys.as_slice(), cloud.wrong_numbers.as_slice(), cloud.strays.as_slice())
            }
            None => (&[][..], &[][..], &[][..]),
        };
        let mut of_rays = [0; Class::COUNT];
        of_rays[Class::Agree as usize] = counts.same - counts.ties;
        of_rays[Class::Tie as usize] = counts.ties;
        of_rays[Class::Rounding as usize] = counts.rounding;
        of_rays[Class::Defect as usize] = counts.wrong;
        let mut by_class = of_rays;
        let of_fields: BTreeSet<usize> = keys.iter().chain(numbers).copied().collect();
        for ray in of_fields {
            let class = match &self.comparison.verdicts[ray] {
                RayVerdict::Same { is_tie: false } => Class::Agree,
                RayVerdict::Same { is_tie: true } => Class::Tie,
                RayVerdict::Rounding { .. } => Class::Rounding,
                RayVerdict::Wrong(_) => continue,
            };
            by_class[class as usize] -= 1;
            by_class[Class::Defect as usize] += 1;
        }
        // Points that are too many stand beside the rays.
        by_class[Class::Defect as usize] += strays.len() as u64;
        // A ray with a wrong value has the right hit.
        let is_of_values = |(_, wrong): &(usize, Wrong)| matches!(wrong, Wrong::Value { .. });
        let wrong_values = self.comparison.wrong().filter(is_of_values).count() as u64;
        let mut of_hits = of_rays;
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
                not_compared: tally.not_compared,
                worst_ratio,
                ..hits.clone()
            }
        });
        let absent = self.absent(&hits);
        // What else a cloud states: the ray of each point.
        let of_cloud = |key: &str, name: &str, agree: u64, wrong: u64| {
            let mut by_class = [0; Class::COUNT];
            by_class[Class::Agree as usize] = agree;
            by_class[Class::Defect as usize] = wrong;
            ItemFindings { key: key.into(), name: name.into(), by_class, ..hits.clone() }
        };
        let points = self.cloud.as_ref().map_or(0, |cloud| cloud.points - strays.len()) as u64;
        let of_keys = (!keys.is_empty())
            .then(|| of_cloud(KEYS, "ring, channel, time", points - keys.len() as u64, keys.len() as u64));
        let of_numbers = (!numbers.is_empty()).then(|| {
            let all = self.cloud.as_ref().map_or(0, |cloud| cloud.numbered) as u64;
            of_cloud(NUMBERS, "number of return", all - numbers.len() as u64, numbers.len() as u64)
        });
        let of_strays = (!strays.is_empty())
            .then(|| of_cloud(STRAYS, "points of one ray each", points, strays.len() as u64));
        let listed = self.telling().into_iter().map(|(index, wrong)| self.wrong_ray(name, index, &wrong));
        let listed = listed.chain(keys.iter().take(MAX_LISTED).map(|ray| self.wrong_key(name, *ray)));
        let listed = listed.chain(numbers.iter().take(MAX_LISTED).map(|ray| self.wrong_number(name, *ray)));
        let listed = listed.chain(strays.iter().take(MAX_LISTED).map(|point| self.stray(name, *point)));
        BundleFindings {
            name: name.into(),
            hits_anything: self.comparison.met > 0,
            must_hit: true,
            by_class,
            not_compared: 0,
            ruled: counts.rounding + counts.wrong,
            items: std::iter::once(hits.clone())
                .chain(values)
                .chain(absent)
                .chain(of_keys)
                .chain(of_numbers)
                .chain(of_strays)
                .collect(),
            listed: listed.collect(),
            why: self.why.clone(),
            coarseness: self.stated.stored.coarseness(),
        }
    }

    /// The wrong rays to list, by turns: one with a wrong hit, then one of each value, the largest part of its bound first.
    fn telling(&self) -> Vec<(usize, Wrong)> {
        let mut groups: BTreeMap<Option<usize>, Vec<(usize, Wrong)>> = BTreeMap::new();
        for (index, wrong) in self.comparison.wrong() {
            let group = match &wrong {
                Wrong::Value { value, .. } => Some(*value as usize),
                _ => None,
            };
            groups.entry(group).or_default().push((index, wrong));
        }
        let ratio = |wrong: &Wrong| match wrong {
            // What is no number is the worst.
            Wrong::Value { error, bound, .. } if (error / bound).is_finite() => error / bound,
            _ => f64::INFINITY,
        };
        // Stable: of equals the first ray stays first.
        groups.values_mut().for_each(|group| group.sort_by(|a, b| ratio(&b.1).total_cmp(&ratio(&a.1))));
        let most = groups.values().map(Vec::len).max().unwrap_or(0).min(MAX_LISTED);
        let turns =
            (0..most).flat_map(|turn| groups.values().filter_map(move |group| group.get(turn).cloned()));
        turns.take(MAX_LISTED).collect()
    }

    /// A ray whose point has the ring, channel or time of another.
    fn wrong_key(&self, bundle: &str, ray: usize) -> WrongRay {
        let words = "ring, channel or time of its point are those of another ray";
        let place = format!("{bundle} {ray}");
        self.wrong_point(bundle, ray, (KEYS, "ring, channel, time"), (place, words), self.ray_command(ray))
    }

    /// A ray whose point has the number of another return.
    fn wrong_number(&self, bundle: &str, ray: usize) -> WrongRay {
        let words = "the number of return of its point is another";
        let place = format!("{bundle} {ray}");
        self.wrong_point(bundle, ray, (NUMBERS, "number of return"), (place, words), self.ray_command(ray))
    }

    /// A point of no ray, or of one that has another.
    fn stray(&self, bundle: &str, point: usize) -> WrongRay {
        let words = "is of no ray, or of one that has another point";
        self.wrong_point(bundle, point, (STRAYS, "point"), (format!("point {point}"), words), String::new())
    }

    fn wrong_point(
        &self,
        bundle: &str,
        index: usize,
        (key, quantity): (&str, &str),
        (place, words): (String, &str),
        command: String,
    ) -> WrongRay {
        let said = Said { who: &self.name, value: place.clone(), what: words, ..Said::default() };
        let line = DefectLine {
            place,
            quantity: quantity.into(),
            words: words.into(),
            command,
            ..DefectLine::default()
        };
        WrongRay::of_list(bundle, index, key, &said, line)
    }

    /// A wrong ray, for people and for programs.
    fn wrong_ray(&self, bundle: &str, index: usize, wrong: &Wrong) -> WrongRay {
        // A cloud has points in place of arrays.
        let of_point = match wrong {
            Wrong::Disagreement { by: "t", is_hit, of, number } if self.cloud.is_some() => {
                Some(Wrong::Disagreement { by: "the point", is_hit: *is_hit, of, number: *number })
            }
            _ => None,
        };
        let words = wrong_text(of_point.as_ref().unwrap_or(wrong));
        let (value, exact) = said_and_true(wrong);
        let (key, quantity, difference, ratio) = match wrong {
            Wrong::Value { value, error, bound } => {
                (value.name(), value.name(), Some(*error), Some(error / bound))
            }
            _ => (HIT, "first hit", None, None),
        };
        let said = Said { who: &self.name, value, exact, difference, ratio, what: &words };
        let line = DefectLine {
            place: format!("{bundle} {index}"),
            quantity: quantity.into(),
            words: words.clone(),
            command: self.ray_command(index),
            ..DefectLine::default()
        };
        WrongRay::of_list(bundle, index, key, &said, line)
    }
}

/// The same words as the beginning of a sentence.
fn capital(words: &str) -> String {
    let mut letters = words.chars();
    letters
        .next()
        .map_or_else(String::new, |first| first.to_uppercase().collect::<String>() + letters.as_str())
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
        Wrong::Something { exact } => ("a hit".into(), Some(face(exact))),
        Wrong::Contradiction => ("too near in one of t and range".into(), None),
        Wrong::Disagreement { of, number, .. } => (format!("{of} {number}"), None),
        Wrong::Value { value, .. } => (value.name().into(), None),
    }
}

#[cfg(test)]
#[path = "../../tests/unit/report.rs"]
mod tests;
