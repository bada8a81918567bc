//! A check's findings as the document that every report prints.

use raypencil_judge::{CHECK_CLASSES, Class, class_counts_json};
use raypencil_report::{
    Block, Column, Document, Grid, JunitCase, JunitSuite, Outcome, Room, count, number, quantity,
};
use serde_json::{Map, Value, json};

use super::findings::{
    BundleFindings, CheckFindings, ItemFindings, MAX_SHOWN_DEFECTS, PackForm, WorstOf, WrongRay, arithmetic,
};

/// Number of the format of `check.json`. It grows when a key changes its meaning or goes away.
const FORMAT: u32 = 4;

impl CheckFindings {
    /// The document that all reports print.
    pub fn document(self) -> Document {
        let by_class = self.by_class();
        let verdict = self.verdict();
        let arithmetic = self.arithmetic.map(arithmetic);
        let with = arithmetic.map_or(String::new(), |arithmetic| format!(", arithmetic {arithmetic}"));
        let mut data = Map::new();
        data.extend([
            ("kind".to_string(), self.form.key().into()),
            ("candidate".to_string(), self.candidate.as_str().into()),
            ("arithmetic".to_string(), arithmetic.into()),
            (
                "pack".to_string(),
                json!({
                    "name": self.pack,
                    "sha256": self.pack_sha256,
                    "version": self.label.version,
                    "licence": self.label.licence,
                    "published": self.is_published,
                }),
            ),
            ("compared".to_string(), by_class.iter().sum::<u64>().into()),
            ("classes".to_string(), class_counts_json(&by_class, &CHECK_CLASSES)),
            ("why".to_string(), self.why.as_deref().into()),
            ("bundles".to_string(), self.bundles.iter().map(BundleFindings::to_json).collect()),
        ]);
        let absent = ["scene", "verified", "diagnosis", "sharpness", "triangles"]
            .map(|key| (key.to_string(), Value::Null));
        data.extend(absent);
        data.extend([("blind".to_string(), false.into()), ("unknown_channels".to_string(), json!([]))]);
        data.extend(self.of_form.clone());
        let noun = if self.form == PackForm::Triangles { "faces" } else { "rays" };
        let mut suite = suite(&self.pack, &self.candidate, &self.bundles, noun);
        if !self.hits_anything() {
            suite.push(JunitCase::failed(
                "something is hit",
                "nothing_hit",
                "no ray of this pack hits anything",
            ));
        }
        let mut remarks: Vec<String> = self.why.iter().map(|why| format!("Why: {why}.")).collect();
        // A single bundle has the same reason, and the one sentence names the sensors.
        if self.bundles.len() > 1 {
            let sets = self.bundles.iter().filter(|bundle| bundle.must_hit);
            let whys = sets.filter_map(|bundle| Some((&bundle.name, bundle.why.as_ref()?)));
            remarks.extend(whys.map(|(name, why)| format!("Why in {name}: {why}.")));
        }
        let agrees = verdict == "agrees";
        remarks.extend(self.sharpness.clone().filter(|_| agrees));
        let sizes = self.sizes.clone().filter(|_| agrees);
        let mut facts = vec![("Candidate", self.candidate.clone())];
        facts.extend(arithmetic.map(|arithmetic| ("Arithmetic", arithmetic.to_string())));
        facts.push(("Pack", self.pack.clone()));
        facts.extend(self.facts.clone());
        Document {
            run: format!("raypencil check {} {}", self.pack, self.candidate),
            question: format!(
                "{} against the answers to {}{}{with}",
                self.candidate, self.pack, self.pack_remark
            ),
            outcome: match verdict {
                "agrees" => Outcome::Agrees,
                "defects" => Outcome::Fails,
                _ => Outcome::Open,
            },
            headline: self.sentence() + &self.of_unknown_pack(),
            remarks,
            explanation: Vec::new(),
            counts: Vec::new(),
            blocks: [
                Some(Block::Table { title: "Every quantity", grid: grid(&self.totals) }),
                sizes,
                Some(Block::Findings {
                    title: "Defects",
                    groups: self.bundles.iter().filter_map(BundleFindings::group).collect(),
                    worst: self.worst.into_iter().take(MAX_SHOWN_DEFECTS).collect(),
                }),
                Some(Block::Text { title: "", lines: self.notes, room: Room::Everywhere }),
                Some(Block::Pictures {
                    title: "Range maps beside the exact ones",
                    html: self.pictures,
                    stays: false,
                }),
            ]
            .into_iter()
            .flatten()
            .collect(),
            suites: vec![suite],
            facts,
            format: FORMAT,
            verdict,
            data,
            explorer: self.explorer,
        }
    }
}

/// The items in rows.
fn grid(items: &[ItemFindings]) -> Grid {
    let mut grid = Grid::new([
        Column::text(""),
        Column::text("stored as").wide(),
        Column::number("compared"),
        Column::number("agree"),
        Column::number("tie"),
        Column::number("rounding"),
        Column::number("undecided").wide(),
        Column::number("defect"),
        Column::number("not compared"),
        Column::number("ulp"),
        Column::number("error"),
        Column::number("/bound"),
        Column::text("at"),
    ]);
    for item in items {
        let of = |class| match item.not_given {
            // Never 0: a quantity that is not given is not one without errors.
            Some(_) => String::new(),
            None => count(item.by_class[class as usize]),
        };
        let worst = |worst: &Option<WorstOf>, unit: &str| {
            worst.as_ref().map_or(String::new(), |worst| quantity(worst.value, unit))
        };
        let row = [
            item.name.clone(),
            item.storage.clone().unwrap_or_default(),
            match item.not_given {
                None => count(item.compared()),
                Some("not given") => "not given".into(),
                // The notes below the table say it in full.
                Some(_) => "type too small".into(),
            },
            of(Class::Agree),
            of(Class::Tie),
            of(Class::Rounding),
            of(Class::Undecided),
            of(Class::Defect),
            count(item.not_compared),
            worst(&item.worst_ulp, ""),
            worst(&item.worst_error, item.unit),
            worst(&item.worst_ratio, ""),
            item.worst_ratio.as_ref().map_or(String::new(), |worst| {
                let ray: Vec<String> = worst.ray.iter().map(u64::to_string).collect();
                format!("{} {}", worst.bundle, ray.join(","))
            }),
        ];
        grid.row(row, item.wrong() > 0);
    }
    grid
}

/// Test results: a case for each bundle and item. What the candidate does not give is skipped.
pub(crate) fn suite(pack: &str, candidate: &str, bundles: &[BundleFindings], noun: &str) -> JunitSuite {
    let mut suite = JunitSuite::new(format!("{pack}: {candidate}"));
    for bundle in bundles {
        let class = format!("{pack}.{candidate}.{}", bundle.name);
        if bundle.items.is_empty() {
            suite.push(JunitCase::skipped("first hit", "not given").with_class(class.as_str()));
        }
        for item in &bundle.items {
            suite.push(case(bundle, item, bundle.why.as_deref(), noun).with_class(class.as_str()));
        }
    }
    // Without this, a report of skipped cases alone would look like a pass.
    if bundles.iter().all(|bundle| bundle.compared() == 0) {
        suite.push(JunitCase::failed("something is compared", "nothing_compared", "nothing was compared"));
    }
    suite
}

/// The outcome of one item of one bundle.
fn case(bundle: &BundleFindings, item: &ItemFindings, why: Option<&str>, noun: &str) -> JunitCase {
    let name = item.name.as_str();
    if item.wrong() == 0 {
        return match item.not_given {
            Some(why) => JunitCase::skipped(name, why),
            None if item.compared() == 0 => JunitCase::skipped(name, format!("none of the {noun} has it")),
            None => JunitCase::passed(name),
        };
    }
    let [wrong, rays] = [item.wrong(), item.compared()].map(count);
    let message = format!("{}: {name} is wrong on {wrong} of {rays} {noun}", bundle.name);
    let of_item = bundle.listed.iter().filter(|one| one.key == item.key).take(MAX_SHOWN_DEFECTS);
    let mut lines: Vec<String> = of_item
        .flat_map(|WrongRay { line, .. }| {
            [
                format!("{}: {}", line.place, line.words),
                format!("    {}", line.what),
                format!("    {}", line.command),
            ]
        })
        .filter(|line| !line.trim().is_empty())
        .collect();
    if let Some(largest) = &item.worst_ulp {
        let ruling = largest.ruling.as_deref().map_or(String::new(), |ruling| format!(" ({ruling})"));
        lines.push(format!("Largest error: {} ulp at {}{ruling}", number(largest.value), largest.place));
        lines.push(format!("    {}", largest.command));
    }
    lines.extend(why.map(|why| format!("Why: {why}.")));
    JunitCase::failed(name, "defect", message).with_text(lines.join("\n"))
}
