//! The one form of a check, whatever a pack asks for: rays of sensors, rays of no sensor, or triangles.
//!
//! A *bundle* is what is asked under one name: a camera, a beam, a set of rays, the triangles of a file. Each has its
//! items: the quantities of its rays, or the clauses of loading.

use raypencil_judge::{CHECK_CLASSES, Class, ClassCounts, class_counts_json};
use raypencil_report::{Block, DefectGroup, DefectLine, count, counted};
use raypencil_scene::Precision;
use serde_json::{Map, Value, json};

use crate::published::PackLabel;

/// Maximum number of defects that a screen or a test case describes; all are counted.
pub(crate) const MAX_SHOWN_DEFECTS: usize = 5;

/// What a pack asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PackForm {
    /// Rays of a camera and of beams.
    Sensors,
    /// Rays of no sensor.
    Rays,
    /// The triangles of a glTF file.
    Triangles,
}

impl PackForm {
    pub(super) fn key(self) -> &'static str {
        match self {
            Self::Sensors => "sensors",
            Self::Rays => "rays",
            Self::Triangles => "triangles",
        }
    }
}

/// The largest value of something, and the ray that has it.
#[derive(Debug, Clone, PartialEq)]
pub struct WorstOf {
    /// The value.
    pub value: f64,
    /// Its ray in words.
    pub place: String,
    /// Name of the bundle.
    pub bundle: String,
    /// Index of the ray in its bundle: column and row of a sensor, or the number of a ray.
    pub ray: Vec<u64>,
    /// The referee's ruling on that ray, in words.
    pub ruling: Option<String>,
    /// The command that shows everything about the ray.
    pub command: String,
}

/// What became of one item.
#[derive(Debug, Clone, PartialEq)]
pub struct ItemFindings {
    /// Name for programs.
    pub key: String,
    /// Name for people.
    pub name: String,
    /// Unit of the errors; empty for a pure number.
    pub unit: &'static str,
    /// How the candidate stores it, if that is known.
    pub storage: Option<String>,
    /// Why nothing of it was compared; `None` if something was, or if no ray has it.
    pub not_given: Option<&'static str>,
    /// Rays by class.
    pub by_class: ClassCounts,
    /// Rays for which the candidate does not have it.
    pub not_compared: u64,
    /// The largest error in units in the last place.
    pub worst_ulp: Option<WorstOf>,
    /// The largest error.
    pub worst_error: Option<WorstOf>,
    /// The largest ratio of an error to its bound.
    pub worst_ratio: Option<WorstOf>,
}

impl ItemFindings {
    /// Rays on which it was compared.
    pub(super) fn compared(&self) -> u64 {
        self.by_class.iter().sum()
    }

    /// Rays on which it is wrong or undecided.
    pub(super) fn wrong(&self) -> u64 {
        wrong(&self.by_class)
    }

    pub(super) fn to_json(&self) -> Value {
        let worst = |worst: &Option<WorstOf>| {
            worst.as_ref().map(|worst| {
                json!({
                    "value": worst.value.is_finite().then_some(worst.value),
                    "bundle": worst.bundle, "ray": worst.ray,
                    "ruling": worst.ruling, "command": worst.command,
                })
            })
        };
        json!({
            "quantity": self.key,
            "unit": self.unit,
            "storage": self.storage,
            "not_given": self.not_given,
            "compared": self.compared(),
            "classes": class_counts_json(&self.by_class, &CHECK_CLASSES),
            "not_compared": self.not_compared,
            "worst_ulp": worst(&self.worst_ulp),
            "worst_error": worst(&self.worst_error),
            "worst_ratio": worst(&self.worst_ratio),
        })
    }
}

/// A wrong ray, for people and for programs.
#[derive(Debug, Clone, PartialEq)]
pub struct WrongRay {
    /// Key of the item that is wrong.
    pub key: String,
    /// For people.
    pub line: DefectLine,
    /// For programs: `docs/formats/check.schema.json` has the keys.
    pub data: Value,
}

/// What was said of one element of a list, and what is true of it.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Said<'a> {
    /// Who said it.
    pub who: &'a str,
    /// What was said.
    pub value: String,
    /// What is true, where one value is.
    pub exact: Option<String>,
    /// How far off it is.
    pub difference: Option<f64>,
    /// The same, in units of what is allowed.
    pub ratio: Option<f64>,
    /// What is wrong, in words.
    pub what: &'a str,
}

impl WrongRay {
    /// Number `index` of the bundle `bundle`, which is one list: rays of no sensor, or triangles.
    pub fn of_list(bundle: &str, index: usize, key: &str, said: &Said<'_>, line: DefectLine) -> Self {
        let finite = |value: Option<f64>| value.filter(|value| value.is_finite());
        let data = json!({
            "bundle": bundle,
            "ray": [index],
            "quantity": key,
            "said": [{ "who": said.who, "value": said.value }],
            "true": said.exact,
            "difference": finite(said.difference),
            "difference_unit": "",
            "ratio": finite(said.ratio),
            "margin": Value::Null,
            "what": said.what,
            "command": line.command,
        });
        Self { key: key.into(), line, data }
    }
}

/// What became of one bundle.
#[derive(Debug, Clone, PartialEq)]
pub struct BundleFindings {
    /// Its name: camera, beam-0, rays/NAME, triangles.
    pub name: String,
    /// Whether any of its rays meets something.
    pub hits_anything: bool,
    /// Whether it proves nothing by itself where none does: a set of rays, but no single sensor.
    pub must_hit: bool,
    /// Rays of which anything was compared, by the worst class of their items.
    pub by_class: ClassCounts,
    /// Rays of which nothing was compared.
    pub not_compared: u64,
    /// Rays on which the referee ruled, because the answer is not the exact one.
    pub ruled: u64,
    /// Each item.
    pub items: Vec<ItemFindings>,
    /// The worst and most telling rays.
    pub listed: Vec<WrongRay>,
    /// What explains why its rays are wrong, as one sentence without its full stop.
    pub why: Option<String>,
    /// How coarsely its values are stored, in words, if it is more coarsely than in single precision, and it is no sensor.
    pub coarseness: Option<String>,
}

impl BundleFindings {
    /// A bundle of which the candidate gives nothing.
    pub fn not_given(name: String, rays: u64) -> Self {
        let by_class = [0; Class::COUNT];
        Self {
            name,
            hits_anything: false,
            must_hit: true,
            by_class,
            not_compared: rays,
            ruled: 0,
            items: Vec::new(),
            listed: Vec::new(),
            why: None,
            coarseness: None,
        }
    }

    /// Whether nothing of it is wrong or undecided.
    pub fn passes(&self) -> bool {
        wrong(&self.by_class) == 0
    }

    /// Rays of which anything was compared.
    pub fn compared(&self) -> u64 {
        self.by_class.iter().sum()
    }

    /// The bundle for programs: `docs/formats/check.schema.json` has the keys.
    pub fn to_json(&self) -> Value {
        json!({
            "name": self.name,
            "compared": self.compared(),
            "classes": class_counts_json(&self.by_class, &CHECK_CLASSES),
            "not_compared": self.not_compared,
            "ruled": self.ruled,
            "why": self.why,
            "quantities": self.items.iter().map(ItemFindings::to_json).collect::<Vec<_>>(),
            "worst_defects": self.listed.iter().map(|wrong| &wrong.data).collect::<Vec<_>>(),
        })
    }

    /// The listed rays below a title that counts all; `None` if nothing is wrong.
    pub fn group(&self) -> Option<DefectGroup> {
        let total = wrong(&self.by_class);
        let lines: Vec<DefectLine> = self.listed.iter().map(|wrong| wrong.line.clone()).collect();
        let more = match total - total.min(lines.len() as u64) {
            0 => String::new(),
            more => format!("{} not listed here.", counted(more, "more is", "more are")),
        };
        (total > 0).then_some(DefectGroup {
            title: format!("{}: {} wrong", self.name, count(total)),
            lines,
            more,
        })
    }
}

/// A check in its one form.
#[derive(Debug, Clone, PartialEq)]
pub struct CheckFindings {
    /// What the pack asks for.
    pub form: PackForm,
    /// Name of the pack.
    pub pack: String,
    /// Words after the pack's name, with a blank before them; mostly none.
    pub pack_remark: &'static str,
    /// SHA-256 of the file of the pack that lists the others.
    pub pack_sha256: String,
    /// Version and licence of the pack.
    pub label: PackLabel,
    /// Whether it is the published pack of its name.
    pub is_published: bool,
    /// Whether the answers were read from the pack: else nobody needs to know it.
    pub has_answers: bool,
    /// Name of the candidate.
    pub candidate: String,
    /// Arithmetic of the candidate; triangles are copied, not computed.
    pub arithmetic: Option<Precision>,
    /// The bundles.
    pub bundles: Vec<BundleFindings>,
    /// The items over all bundles, as tables list them.
    pub totals: Vec<ItemFindings>,
    /// The worst rays of all, for a screen.
    pub worst: Vec<DefectLine>,
    /// The coarsest type in which the candidate is stored, if it is coarser than single precision.
    pub coarseness: Option<String>,
    /// The verdict in one sentence, where it is not told by counts of rays.
    pub headline: Option<String>,
    /// What explains why the candidate is wrong, as one sentence without its full stop.
    pub why: Option<String>,
    /// Sentences on what was compared, and what was not.
    pub notes: Vec<String>,
    /// How large a mistake would have been noticed, as a sentence; a pass alone says it.
    pub sharpness: Option<String>,
    /// All of those sizes, for a page.
    pub sizes: Option<Block>,
    /// Names and values of what was asked.
    pub facts: Vec<(&'static str, String)>,
    /// What only this form of a pack has, for programs: `scene`, `blind`, `verified`, `diagnosis`, `sharpness`, `unknown_channels`.
    pub of_form: Map<String, Value>,
    /// Pictures as HTML; empty if there are none.
    pub pictures: String,
    /// The part of the page that answers when asked, as HTML; empty if there is none.
    pub explorer: String,
}

/// Rays that are wrong or undecided.
fn wrong(by_class: &ClassCounts) -> u64 {
    by_class[Class::Defect as usize] + by_class[Class::Undecided as usize]
}

/// The name of an arithmetic.
pub(crate) fn arithmetic(precision: Precision) -> &'static str {
    if precision == Precision::F32 { "f32" } else { "f64" }
}

impl CheckFindings {
    pub(super) fn by_class(&self) -> ClassCounts {
        std::array::from_fn(|k| self.bundles.iter().map(|bundle| bundle.by_class[k]).sum())
    }

    /// Whether any ray hits, and any of each set that is given. Where nothing is hit, a program that answers nothing is right.
    pub(super) fn hits_anything(&self) -> bool {
        let is_idle =
            |bundle: &BundleFindings| bundle.must_hit && bundle.compared() > 0 && !bundle.hits_anything;
        self.bundles.iter().any(|bundle| bundle.hits_anything) && !self.bundles.iter().any(is_idle)
    }

    /// The outcome in one word.
    pub fn verdict(&self) -> &'static str {
        let by_class = self.by_class();
        match (by_class.iter().sum::<u64>(), wrong(&by_class), self.hits_anything()) {
            (0, ..) => "nothing_compared",
            (_, 1.., _) => "defects",
            (_, 0, true) => "agrees",
            (_, 0, false) => "nothing_hit",
        }
    }

    /// The outcome in one sentence. A recording in half precision, or in steps, is never said to be exact.
    pub(super) fn sentence(&self) -> String {
        let by_class = self.by_class();
        let of = |class| count(by_class[class as usize]);
        let rays = count(by_class.iter().sum());
        let rays_agree = match by_class.iter().sum() {
            1_u64 => "1 ray agrees".to_string(),
            _ => format!("{rays} rays agree"),
        };
        match self.verdict() {
            _ if self.headline.is_some() => self.headline.clone().unwrap_or_default(),
            "agrees" => {
                let is_partial = self.totals.iter().any(|item| item.not_compared > 0);
                let partial = if is_partial { "; nothing is known about what was not compared" } else { "" };
                let (agree, tie, rounding) = (of(Class::Agree), of(Class::Tie), of(Class::Rounding));
                match &self.coarseness {
                    None => {
                        // A number is called exact only if it is.
                        let is_exact = |item: &ItemFindings| {
                            let worst = item.worst_ulp.as_ref().or(item.worst_ratio.as_ref());
                            worst.is_none_or(|one| one.value == 0.0)
                        };
                        let words =
                            if self.totals.iter().all(is_exact) { "exact" } else { "within rounding" };
                        format!(
                            "{rays_agree} with the exact answers: {agree} {words}, {tie} tie, {rounding} rounding{partial}."
                        )
                    }
                    Some(coarse) => {
                        format!(
                            "{rays_agree} to {coarse}: {agree} agree, {tie} tie, {rounding} rounding{partial}."
                        )
                    }
                }
            }
            "defects" => {
                let undecided = match by_class[Class::Undecided as usize] {
                    0 => String::new(),
                    rays => format!(", {} undecided", count(rays)),
                };
                let are = if by_class[Class::Defect as usize] == 1 { "is" } else { "are" };
                format!("{} of {rays} rays {are} wrong{undecided}.", of(Class::Defect))
            }
            "nothing_hit" => format!(
                "No ray of this pack, or of one of its sets, hits anything: that the candidate agrees on {} proves little.",
                counted(by_class.iter().sum(), "ray", "rays")
            ),
            _ => "Nothing was compared.".into(),
        }
    }

    /// What the verdict adds of a pack with answers that nobody has published.
    pub(super) fn of_unknown_pack(&self) -> String {
        match self.has_answers && !self.is_published {
            true => {
                let short: String = self.pack_sha256.chars().take(12).collect();
                format!(" (By a pack that is not published: sha256 {short}...)")
            }
            false => String::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_group_tells_how_many_wrong_rays_it_does_not_list() {
        let listed = |index: usize| {
            WrongRay::of_list("rays/head", index, "range", &Said::default(), DefectLine::default())
        };
        let more = |defects: u64, undecided: u64, count: usize| {
            let mut bundle = BundleFindings::not_given("rays/head".into(), 0);
            bundle.by_class[Class::Defect as usize] = defects;
            bundle.by_class[Class::Undecided as usize] = undecided;
            bundle.listed = (0..count).map(listed).collect();
            bundle.group().map(|group| (group.title, group.more))
        };
        let told = |title: &str, more: &str| Some((format!("rays/head: {title}"), more.to_string()));
        assert_eq!(more(0, 0, 0), None);
        assert_eq!(more(5, 2, 7), told("7 wrong", ""));
        assert_eq!(more(5, 2, 6), told("7 wrong", "1 more is not listed here."));
        assert_eq!(more(5, 2, 2), told("7 wrong", "5 more are not listed here."));
    }
}
