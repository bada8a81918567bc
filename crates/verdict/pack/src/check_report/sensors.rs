//! A check of sensors in the form of every check.

use std::collections::BTreeSet;

use raypencil_diagnosis::{Diagnosis, Reason};
use raypencil_judge::{
    Answers, Check, Class, Item, ItemTally, Largest, Recorded, SensorResult, key_of, listed_defects, name_of,
    unit_of,
};
use raypencil_report::{
    DefectLine, Document, JunitSuite, MapPair, SensorPlots, count, counted, max_side_of_pictures,
};
use raypencil_scene::{Image, Maybe, SensorMap};
use raypencil_scene_io::{Subject, probe_command};
use serde_json::json;

use crate::check::{Checked, Verified};
use crate::check_report::document::suite;
use crate::check_report::explorer::explorer;
use crate::check_report::findings::{
    BundleFindings, CheckFindings, ItemFindings, PackForm, WorstOf, WrongRay,
};
use crate::check_report::given::{coarse_storages, items_not_given, listed_totals, not_given};
use crate::check_report::sharpness;
use crate::claims::Found;
use crate::published::PackIdentity;

/// Pictures of every sensor: the exact ranges, the candidate's, and their difference.
const PICTURES_OF_SENSOR: u64 = 3;

impl Checked {
    /// Whether something was compared, none of it is wrong, and what was compared proves something.
    pub fn passes(&self) -> bool {
        findings(self).verdict() == "agrees"
    }

    /// The check, with its sets of rays, for a screen and for programs.
    pub fn document(&self) -> Document {
        findings(self).document()
    }

    /// The same with the pictures of its page, and the part that answers when asked. They take seconds.
    ///
    /// # Errors
    /// An error of a template of pictures.
    pub fn document_with_pictures(&self) -> Result<Document, askama::Error> {
        let parts = (pictures(self)?, explorer(self));
        Ok(CheckFindings { pictures: parts.0, explorer: parts.1, ..findings(self) }.document())
    }
}

fn findings(checked: &Checked) -> CheckFindings {
    let Checked { subject, recorded, check, diagnosis, is_blind, verified, pack, .. } = checked;
    let mut bundles = sensor_bundles(subject, check, Some((recorded, &checked.exact)));
    for (bundle, result) in bundles.iter_mut().zip(&check.sensors) {
        bundle.why = diagnosis.as_ref().and_then(|found| found.of(result.sensor)).map(Reason::sentence);
    }
    bundles.extend(checked.ray_sets.iter().cloned());
    let totals = listed_totals(check);
    let totals = totals.iter().map(|(item, tally)| {
        let storage = recorded.storage_of_item(*item).map(|how| how.to_string());
        item_findings(subject, *item, tally, storage)
    });
    // A row for each set of rays: all that is wrong with its rays, and the worst of its values.
    let of_sets = checked.ray_sets.iter().filter_map(|set| {
        let ratios = set.items.iter().filter_map(|item| item.worst_ratio.as_ref());
        let worst_ratio = ratios.reduce(|worst, other| if other.value > worst.value { other } else { worst });
        let hits = set.items.first()?.clone();
        let name = set.name.clone();
        Some(ItemFindings { name, by_class: set.by_class, worst_ratio: worst_ratio.cloned(), ..hits })
    });
    let told = sharpness::told(checked);
    let of_form = [
        ("scene", json!({ "name": subject.name, "sha256": subject.sha256 })),
        ("blind", (*is_blind).into()),
        (
            "verified",
            json!({
                "answers": verified.answers, "of": verified.of, "seed": verified.seed, "ray_files": verified.rays,
                "clauses": { "found": verified.clauses.found, "of": verified.clauses.of },
                "sizes": { "found": verified.sizes.found, "of": verified.sizes.of },
            }),
        ),
        ("diagnosis", diagnosis.as_ref().map(Diagnosis::to_json).into()),
        ("sharpness", sharpness::to_json(&told)),
        ("unknown_channels", recorded.unknown.clone().into()),
    ];
    let mut worst: Vec<DefectLine> =
        listed_defects(&check.sensors).into_iter().map(|one| wrong_ray(subject, one).line).collect();
    worst.extend(checked.ray_sets.iter().flat_map(|set| set.listed.iter().map(|wrong| wrong.line.clone())));
    let coarse_sets = checked.ray_sets.iter().filter_map(|set| set.coarseness.clone());
    let coarse: BTreeSet<String> = recorded.coarseness().into_iter().chain(coarse_sets).collect();
    CheckFindings {
        form: PackForm::Sensors,
        pack: subject.name.clone(),
        pack_remark: if *is_blind { " (blind)" } else { "" },
        pack_sha256: pack.sha256.clone(),
        label: pack.label.clone(),
        is_published: pack.is_published(),
        has_answers: checked.has_answers,
        candidate: recorded.name.clone(),
        arithmetic: Some(recorded.precision),
        totals: totals.chain(of_sets).collect(),
        worst,
        coarseness: (!coarse.is_empty()).then(|| coarse.into_iter().collect::<Vec<_>>().join(" and ")),
        headline: None,
        why: checked.why(),
        notes: notes(checked),
        sharpness: sharpness::sentence(&told, pack.is_published()),
        sizes: sharpness::block(&told),
        facts: vec![("Scene SHA-256", subject.sha256.clone())],
        of_form: of_form.into_iter().map(|(key, value)| (key.to_string(), value)).collect(),
        pictures: String::new(),
        explorer: String::new(),
        bundles,
    }
}

/// The suite of one check of sensors.
pub fn check_suite(subject: &Subject, candidate: &str, check: &Check) -> JunitSuite {
    suite(&subject.name, candidate, &sensor_bundles(subject, check, None), "rays")
}

/// A bundle for each sensor.
fn sensor_bundles(
    subject: &Subject,
    check: &Check,
    of_pack: Option<(&Recorded, &Answers)>,
) -> Vec<BundleFindings> {
    let bundle = |sensor: &SensorResult| {
        let items = sensor.items.iter().map(|(item, tally)| {
            let storage = of_pack.and_then(|(recorded, _)| recorded.storage.get(&(sensor.sensor, item)));
            item_findings(subject, item, tally, storage.map(ToString::to_string))
        });
        BundleFindings {
            name: sensor.sensor.to_string(),
            hits_anything: of_pack.is_none_or(|(_, exact)| map_hits(exact.map(sensor.sensor))),
            must_hit: false,
            by_class: sensor.by_class,
            not_compared: sensor.not_compared,
            ruled: sensor.judged,
            items: items.collect(),
            listed: sensor.listed.iter().map(|one| wrong_ray(subject, one)).collect(),
            why: None,
            coarseness: None,
        }
    };
    check.sensors.iter().map(bundle).collect()
}

fn wrong_ray(subject: &Subject, one: &raypencil_judge::ListedDefect) -> WrongRay {
    let command = probe_command(subject, one.place);
    let mut data = one.to_json(subject.scene.flux_model(), &command);
    if let Some(keys) = data.as_object_mut() {
        // As every bundle has them: the name of the bundle, the index of the ray, the command that shows it.
        let sensor = keys.remove("sensor");
        let indices = [keys.remove("i"), keys.remove("j")];
        keys.remove("probe");
        keys.insert("bundle".into(), sensor.into());
        keys.insert("ray".into(), indices.into_iter().flatten().collect());
        keys.insert("command".into(), command.as_str().into());
    }
    WrongRay {
        key: key_of(subject.scene.flux_model(), one.item),
        line: DefectLine {
            place: one.place.to_string(),
            quantity: name_of(one.item),
            words: one.words(),
            what: one.what.clone(),
            command,
            ..DefectLine::default()
        },
        data,
    }
}

fn item_findings(subject: &Subject, item: Item, tally: &ItemTally, storage: Option<String>) -> ItemFindings {
    let model = subject.scene.flux_model();
    let worst = |largest: &Option<Largest>| {
        largest.as_ref().map(|Largest { value, place, ruling }| WorstOf {
            value: *value,
            place: place.to_string(),
            bundle: place.sensor.to_string(),
            ray: vec![place.i.into(), place.j.into()],
            ruling: ruling.clone(),
            command: probe_command(subject, *place),
        })
    };
    ItemFindings {
        key: key_of(model, item),
        name: name_of(item),
        unit: unit_of(model, item),
        storage,
        not_given: not_given(tally),
        by_class: tally.by_class,
        not_compared: tally.not_compared,
        worst_ulp: worst(&tally.worst_ulps),
        worst_error: worst(&tally.worst_error),
        worst_ratio: worst(&tally.worst_ratio),
    }
}

/// Whether any ray of a sensor hits, by its exact map.
fn map_hits(map: &SensorMap) -> bool {
    map.range.iter().flat_map(|range| range.cells()).any(|range| range.get().is_some())
}

/// Sentences on what was compared, what was not, and what of the pack was verified.
fn notes(checked: &Checked) -> Vec<String> {
    let Checked { recorded, check, .. } = checked;
    let mut notes: Vec<String> =
        recorded.unknown.iter().map(|name| format!("Unknown channel, not compared: {name}")).collect();
    if !recorded.unknown.is_empty() {
        notes.push(
            "Say which map a channel is by --channel MAP=CHANNEL, such as --channel depth.Z=CHANNEL.".into(),
        );
    }
    notes.extend(coarse_storages(recorded));
    for why in ["not given", "stored in a type that cannot hold it"] {
        let absent = items_not_given(check).into_iter().filter(|(_, reason)| *reason == why);
        let names: Vec<String> = absent.map(|(item, _)| name_of(item)).collect();
        if !names.is_empty() {
            notes.push(format!("Not compared, because {why}: {}", names.join(", ")));
        }
    }
    notes.extend(
        checked
            .ray_sets
            .iter()
            .filter(|set| set.items.is_empty())
            .map(|set| format!("Not compared, because not given: {}", set.name)),
    );
    notes.push(pack_words(&checked.pack, checked.verified));
    notes
}

/// Which pack it was and what of it was verified, in sentences.
fn pack_words(pack: &PackIdentity, verified: Verified) -> String {
    let Verified { answers, of, rays, seed, clauses, sizes } = verified;
    let all = if answers == of { "all " } else { "" };
    let hint = match seed {
        _ if answers == of => String::new(),
        Some(seed) => format!(", drawn by seed {seed}, (all: --verify)"),
        None => " (all: --verify)".into(),
    };
    let rays = counted(rays, "array of rays is that", "arrays of rays are those");
    let numbers = [("counts of clauses", clauses), ("sizes of tolerances", sizes)];
    let numbers = numbers.into_iter().filter(|(_, found)| found.of > 0).map(|(name, Found { found, of })| {
        let all = if found == of { "all " } else { "" };
        format!("{all}{} of {} {name}", count(found), count(of))
    });
    let numbers: Vec<String> = numbers.collect();
    let by_seed = match seed {
        Some(seed) if clauses.is_partial() || sizes.is_partial() => {
            format!(", drawn by seed {seed}, (all: --verify)")
        }
        _ => String::new(),
    };
    let numbers = match numbers.as_slice() {
        [] => String::new(),
        numbers => format!(" Found again, too: {}{by_seed}.", numbers.join(" and ")),
    };
    format!(
        "The pack ({}): {all}{} of {} answers are the referee's{hint}, and so is each by which a ray is wrong; {rays} of its scene.{numbers}",
        pack.words(),
        count(answers),
        count(of)
    )
}

/// The pictures of each sensor: the exact ranges, the candidate's, and their difference with the defects marked.
fn pictures(checked: &Checked) -> Result<String, askama::Error> {
    let exact = &checked.exact;
    let sizes: Vec<(u32, u32)> = exact.maps.iter().map(|map| (map.width, map.height)).collect();
    let max_side = max_side_of_pictures(&sizes, PICTURES_OF_SENSOR);
    let shown = checked
        .check
        .sensors
        .iter()
        .filter_map(|sensor| Some((sensor, exact.map(sensor.sensor).range.as_ref()?)));
    shown.map(|(sensor, exact)| section(checked, sensor, exact, max_side)).collect()
}

fn section(
    checked: &Checked,
    sensor: &SensorResult,
    exact: &Image<Maybe<f64>>,
    max_side: u32,
) -> Result<String, askama::Error> {
    let recorded = &checked.recorded;
    let id = sensor.sensor;
    let mut plots = SensorPlots::new(id, (exact.width(), exact.height()), max_side);
    let mut numbers = match sensor.compared() {
        0 => "not given".into(),
        rays => {
            let wrong = sensor.of(Class::Defect) + sensor.of(Class::Undecided);
            format!("{} wrong of {}", count(wrong), counted(rays, "ray", "rays"))
        }
    };
    match &recorded.answers.map(id).range {
        Some(range) => {
            plots.add_ranges(&[("exact", exact), (&recorded.name, range)]);
            let pair = MapPair { a: ("exact", exact), b: (&recorded.name, range) };
            plots.add_difference(pair, None, sensor.defects.iter().map(|defect| defect.place));
        }
        None => {
            numbers.push_str(" · range: not given");
            plots.add_ranges(&[("exact", exact)]);
        }
    }
    let size = format!("{} × {}", exact.width(), exact.height());
    plots.section(&id.to_string(), &size, &numbers)
}
