//! `report.html`: a check for people, as one file that links to nothing.

use askama::Template;
use raypencil_judge::{Class, Item, ItemTally, Largest, SensorResult, listed_defects, name_of, unit_of};
use raypencil_report::{
    DefectGroup, DefectLine, MapPair, SensorPlots, VERSION, count, counted, defect_list,
    max_side_of_pictures, page_head, quantity,
};
use raypencil_scene::{Image, Maybe};

use crate::check::Checked;
use crate::check_report::explorer::explorer;
use crate::check_report::verdict::{
    arithmetic, coarse_storages, headline, items_not_given, listed_totals, not_given, sign, verdict,
};

/// Pictures of every sensor: the exact ranges, the candidate's, and their difference.
const PICTURES_OF_SENSOR: u64 = 3;

#[derive(Template)]
#[template(path = "check.html")]
struct Page<'a> {
    head: String,
    verdict: &'static str,
    sign: &'static str,
    headline: String,
    /// The mistake that explains why the candidate is wrong nearly everywhere; empty if none is known.
    why: String,
    /// The worst defect in one sentence; empty if there is none.
    worst: String,
    coarse: Vec<String>,
    /// What was not compared, and why; empty if everything was.
    absent: String,
    candidate: &'a str,
    arithmetic: &'static str,
    pack: &'a str,
    blind: bool,
    sha256: &'a str,
    version: &'static str,
    /// The lists of defects as HTML.
    defects: String,
    rows: Vec<Row>,
    sensors: Vec<Sensor>,
    /// Data, style and script of the part that answers when asked, as HTML.
    explorer: String,
}

/// One quantity over all sensors.
struct Row {
    quantity: String,
    /// Why nothing was compared; empty if something was.
    absent: &'static str,
    storage: String,
    is_wrong: bool,
    /// Rays that agree, tie, are rounding, undecided, and defects.
    classes: [String; 5],
    not_compared: String,
    error: String,
    error_place: String,
    ratio: String,
    ratio_place: String,
}

/// The pictures of a sensor.
struct Sensor {
    name: String,
    size: String,
    numbers: String,
    note: String,
    /// The pictures as HTML.
    pictures: String,
}

/// The contents of `report.html`.
///
/// # Errors
/// An error of the template.
pub fn check_page(checked: &Checked) -> Result<String, askama::Error> {
    let Checked { subject, recorded, check, exact, is_blind, .. } = checked;
    let headline = headline(checked);
    let head = page_head(&format!("{} {}: {headline}", sign(checked), recorded.name), "");
    let worst = listed_defects(&check.sensors);
    let worst = worst.first().map(|one| format!("{}, {}: {}", one.place, name_of(one.item), one.words()));
    let absent: Vec<String> =
        items_not_given(check).into_iter().map(|(item, why)| format!("{} ({why})", name_of(item))).collect();
    let sizes: Vec<(u32, u32)> = exact.maps.iter().map(|map| (map.width, map.height)).collect();
    let max_side = max_side_of_pictures(&sizes, PICTURES_OF_SENSOR);
    let groups: Vec<DefectGroup> =
        check.sensors.iter().filter_map(|sensor| defects(checked, sensor)).collect();
    let page = Page {
        head,
        verdict: match verdict(checked) {
            "agrees" => "agree",
            "defects" => "defects",
            _ => "nothing",
        },
        sign: sign(checked),
        headline,
        worst: worst.unwrap_or_default(),
        why: checked.why().unwrap_or_default(),
        coarse: coarse_storages(recorded),
        absent: absent.join(", "),
        candidate: &recorded.name,
        arithmetic: arithmetic(recorded.precision),
        pack: &subject.name,
        blind: *is_blind,
        sha256: &subject.sha256,
        version: VERSION,
        defects: defect_list(&groups)?,
        rows: listed_totals(check).into_iter().map(|(item, tally)| row(checked, item, &tally)).collect(),
        sensors: check
            .sensors
            .iter()
            .filter_map(|sensor| Some((sensor, exact.map(sensor.sensor).range.as_ref()?)))
            .map(|(sensor, exact)| pictures(checked, sensor, exact, max_side))
            .collect::<Result<_, _>>()?,
        explorer: explorer(checked),
    };
    page.render()
}

fn defects(checked: &Checked, sensor: &SensorResult) -> Option<DefectGroup> {
    let total = sensor.of(Class::Defect) + sensor.of(Class::Undecided);
    let lines: Vec<DefectLine> = sensor
        .listed
        .iter()
        .map(|one| DefectLine {
            place: one.place.to_string(),
            quantity: name_of(one.item),
            words: one.words(),
            what: one.what.clone(),
            folder: String::new(),
            command: checked.repro(one.place),
        })
        .collect();
    let more = match total - total.min(lines.len() as u64) {
        0 => String::new(),
        more => format!(
            "{} of this sensor not listed here. The list has the worst rays of each quantity.",
            counted(more, "more ray", "more rays")
        ),
    };
    let title = format!("{}: {} wrong", sensor.sensor, counted(total, "ray", "rays"));
    (total > 0).then_some(DefectGroup { title, lines, more })
}

fn row(checked: &Checked, item: Item, tally: &ItemTally) -> Row {
    let unit = unit_of(checked.subject.scene.flux_model(), item);
    let value = |largest: &Option<Largest>, unit: &str| {
        largest.as_ref().map_or(String::new(), |largest| quantity(largest.value, unit))
    };
    let place = |largest: &Option<Largest>| {
        largest.as_ref().map_or(String::new(), |largest| largest.place.to_string())
    };
    let classes = [Class::Agree, Class::Tie, Class::Rounding, Class::Undecided, Class::Defect];
    Row {
        quantity: name_of(item),
        absent: match tally.compared() {
            0 => not_given(tally).unwrap_or("no ray has it"),
            _ => "",
        },
        storage: checked.recorded.storage_of_item(item).map_or(String::new(), |how| how.to_string()),
        is_wrong: tally.of(Class::Defect) + tally.of(Class::Undecided) > 0,
        classes: classes.map(|class| count(tally.of(class))),
        not_compared: count(tally.not_compared),
        error: value(&tally.worst_error, unit),
        error_place: place(&tally.worst_error),
        ratio: value(&tally.worst_ratio, ""),
        ratio_place: place(&tally.worst_ratio),
    }
}

/// The exact ranges of a sensor, the candidate's beside them, and the difference with its defects marked.
fn pictures(
    checked: &Checked,
    sensor: &SensorResult,
    exact: &Image<Maybe<f64>>,
    max_side: u32,
) -> Result<Sensor, askama::Error> {
    let recorded = &checked.recorded;
    let id = sensor.sensor;
    let mut plots = SensorPlots::new(id, (exact.width(), exact.height()), max_side);
    let mut numbers = match sensor.compared() {
        0 => "not given".into(),
        rays => format!(
            "{} wrong of {}",
            count(sensor.of(Class::Defect) + sensor.of(Class::Undecided)),
            counted(rays, "ray", "rays")
        ),
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
    Ok(Sensor {
        name: id.to_string(),
        size: format!("{} × {}", exact.width(), exact.height()),
        numbers,
        note: plots.note.clone(),
        pictures: plots.html()?,
    })
}
