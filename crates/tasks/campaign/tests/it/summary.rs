//! The reports of a campaign: the summary against its schema, and the screen.

use raypencil_campaign::{
    Campaign, Merged, PartName, PartRecord, QuantityRecord, ReasonRecord, TerrainRecord, WorstRecord,
    WrongRay, campaign_document, terrain, write_campaign,
};
use raypencil_judge::Quantity;
use raypencil_tests::schema::schema_faults;
use serde_json::Value;

fn campaign_screen(merged: &Merged) -> String {
    campaign_document(merged, |_| false).screen()
}

fn campaign_json(merged: &Merged) -> String {
    campaign_document(merged, |_| false).json()
}

/// A wrong ray.
pub(super) fn wrong_ray() -> WrongRay {
    WrongRay { sensor: "beam-0".into(), i: 3, j: 1, quantity: Quantity::Range, what: "1 m and 2 m".into() }
}

/// A campaign of two terrains with made-up numbers.
pub(super) fn made_up(by_class: [u64; 6], wrong: Vec<WrongRay>) -> Merged {
    with_hits(500, by_class, wrong)
}

/// The same, with this many hits in each scene.
pub(super) fn with_hits(hits: u64, by_class: [u64; 6], wrong: Vec<WrongRay>) -> Merged {
    let worst = |value: f64, i| Some(WorstRecord { value: Some(value), sensor: "camera".into(), i, j: 2 });
    let part = |part: PartName, i| PartRecord {
        part,
        compared: by_class.iter().sum(),
        hits,
        by_class,
        not_compared: 0,
        judged: 12,
        quantities: vec![QuantityRecord {
            quantity: Quantity::Range,
            by_class,
            not_compared: 0,
            worst_error: worst(f64::from(i) * 1e-9, i),
            worst_ratio: worst(f64::from(i) / 16.0, i),
        }],
        wrong: wrong.clone(),
        reasons: Vec::new(),
        candidate: None,
        failed: None,
    };
    let record = |terrain: u64| TerrainRecord {
        terrain,
        faces: 1000 + terrain,
        parts: PartName::ALL.into_iter().zip(1..).map(|(name, i)| part(name, i)).collect(),
    };
    let campaign = Campaign { version: "1.2.3".into(), ..Campaign::new(5, 2) };
    Merged { campaign, terrains: vec![record(0), record(1)] }
}

#[test]
fn screens_are_as_the_snapshots_show() {
    insta::assert_snapshot!(
        "screen_without_defects",
        campaign_screen(&made_up([990, 6, 4, 0, 0, 0], Vec::new()))
    );
    let with_defects = made_up([990, 6, 2, 0, 1, 1], vec![wrong_ray()]);
    insta::assert_snapshot!("screen_with_defects", campaign_screen(&with_defects));
    insta::assert_snapshot!("markdown_with_defects", campaign_document(&with_defects, |_| false).markdown());
    insta::assert_snapshot!(
        "junit_with_defects",
        campaign_document(&with_defects, |_| false).junit().unwrap()
    );
}

#[test]
fn counts_add_up_over_terrains_and_scenes() {
    // Two terrains of four scenes of 1000 rays.
    let mut merged = made_up([990, 6, 2, 0, 1, 1], vec![wrong_ray()]);
    for part in merged.terrains.iter_mut().flat_map(|terrain| &mut terrain.parts) {
        (part.not_compared, part.quantities[0].not_compared) = (7, 3);
    }
    assert_eq!((merged.compared(), merged.passes()), (2 * 4 * 1000, false));
    assert!(made_up([1000, 0, 0, 0, 0, 0], Vec::new()).passes());
    assert!(made_up([900, 50, 40, 10, 0, 0], Vec::new()).passes());
    // One that could not be decided, and one that is wrong.
    assert!(!made_up([999, 0, 0, 0, 1, 0], vec![wrong_ray()]).passes());
    assert!(!made_up([999, 0, 0, 0, 0, 1], vec![wrong_ray()]).passes());
    let json: Value = serde_json::from_str(&campaign_json(&merged)).unwrap();
    let all = &json["all"];
    assert_eq!([&all["compared"], &all["hits"], &all["judged"]], [8000, 2 * 4 * 500, 2 * 4 * 12]);
    assert_eq!([&all["not_compared"], &all["quantities"][0]["not_compared"]], [2 * 4 * 7, 2 * 4 * 3]);
    let own = &json["parts"]["own"];
    assert_eq!([&own["compared"], &own["hits"], &own["judged"]], [2000, 2 * 500, 2 * 12]);
    assert!(!made_up([0; 6], Vec::new()).passes());
}

#[test]
fn a_campaign_in_which_nothing_is_hit_is_no_pass() {
    let classes = [1000, 0, 0, 0, 0, 0];
    let of = |hits| with_hits(hits, classes, Vec::new());
    let codes =
        |merged: &Merged| merged.warnings().iter().map(|(_, found)| found.code.word()).collect::<Vec<_>>();
    // Four scenes, each of two terrains of 1000 rays: 20 hits are one per cent.
    assert!(of(10).passes() && codes(&of(10)).is_empty());
    assert!(of(9).passes());
    assert_eq!(codes(&of(9)), ["few_hits"; 4]);
    let nothing = of(0);
    assert!(!nothing.passes());
    assert_eq!(codes(&nothing), ["no_hits"; 4]);
    let screen = campaign_screen(&nothing);
    assert!(screen.contains("\n? Nothing is hit: all 8,000 rays miss the terrain.\n"), "{screen}");
    assert!(
        screen.contains("Warning: scenes own: none of its 2,000 rays hits") && !screen.contains('✓'),
        "{screen}"
    );
    let summary: Value = serde_json::from_str(&campaign_json(&nothing)).unwrap();
    assert_eq!(
        (&summary["verdict"], &summary["warnings"][3]["part"]),
        (&"nothing_hit".into(), &"lattice".into())
    );
    let schema = include_str!("../../../../../docs/formats/campaign.schema.json");
    assert_eq!(schema_faults(&serde_json::from_str(schema).unwrap(), &summary), [""; 0]);
}

#[test]
fn the_summary_keeps_to_its_schema() {
    let campaign = Campaign::new(5, 1);
    let folder = tempfile::tempdir().unwrap();
    let mut record = terrain(&campaign, 0, Some(folder.path())).unwrap();
    // No ray is wrong, so that no scene is written.
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    // The scenes of a campaign do hit their terrain.
    assert!(record.parts.iter().all(|part| 0 < part.hits && part.hits <= part.compared), "{record:?}");
    record.parts[0].wrong.push(wrong_ray());
    let merged = Merged { campaign, terrains: vec![record] };
    let schema: Value =
        serde_json::from_str(include_str!("../../../../../docs/formats/campaign.schema.json")).unwrap();
    let mut summary: Value = serde_json::from_str(&campaign_json(&merged)).unwrap();
    assert_eq!(schema_faults(&schema, &summary), [""; 0]);
    // The schema finds a missing key and a surplus one.
    let total = summary["parts"]["own"].as_object_mut().unwrap();
    total.remove("judged");
    total.insert("surplus".into(), Value::Null);
    assert_eq!(schema_faults(&schema, &summary).len(), 2);
}

#[test]
fn the_worst_is_the_first_of_the_largest_and_no_number_is_larger_than_all() {
    let worst = |values: [Option<f64>; 4]| -> Value {
        let mut merged = made_up([1000, 0, 0, 0, 0, 0], Vec::new());
        merged.terrains.push(TerrainRecord { terrain: 2, ..merged.terrains[0].clone() });
        merged.terrains.push(TerrainRecord { terrain: 3, ..merged.terrains[0].clone() });
        for (record, value) in merged.terrains.iter_mut().zip(values) {
            record.parts.truncate(1);
            for slot in [&mut record.parts[0].quantities[0]]
                .into_iter()
                .flat_map(|one| [&mut one.worst_error, &mut one.worst_ratio])
            {
                slot.as_mut().unwrap().value = value;
            }
        }
        let json: Value = serde_json::from_str(&campaign_json(&merged)).unwrap();
        let quantity = &json["all"]["quantities"][0];
        assert_eq!(quantity["worst_error"]["terrain"], quantity["worst_ratio"]["terrain"]);
        quantity["worst_error"]["terrain"].clone()
    };
    assert_eq!(worst([Some(1.0), Some(3.0), Some(3.0), Some(2.0)]), 1);
    assert_eq!(worst([Some(0.0); 4]), 0);
    // A value that is not finite is written as null.
    assert_eq!(worst([Some(1.0), Some(1e300), None, Some(2.0)]), 2);
    assert_eq!(worst([None, Some(1e300), None, Some(2.0)]), 0);
}

#[test]
fn only_all_of_the_wrong_rays_are_a_hundred_per_cent() {
    let share = |explained: u64, wrong: u64| {
        let mut merged = made_up([990, 6, 0, 0, 0, 4], vec![wrong_ray()]);
        merged.campaign = merged.campaign.hunting("my {pack} {out}").expect("a command");
        merged.terrains[0].parts[0].reasons = vec![ReasonRecord {
            mistakes: vec!["scaled".into()],
            clause: "lengths are times 2".into(),
            wrong,
            explained,
            right: 9,
            broken: 0,
        }];
        let screen = campaign_screen(&merged).split_whitespace().collect::<Vec<_>>().join(" ");
        let (before, _) = screen.split_once(" % of them agree if lengths").expect("a reason");
        before.rsplit(' ').next().unwrap_or_default().to_string()
    };
    assert_eq!(share(1_000_000, 1_000_000), "100");
    assert_eq!(share(999_999, 1_000_000), "99.99");
    assert_eq!(share(2, 3), "66.66");
}

#[test]
fn the_command_that_runs_it_again_has_its_options_in_their_units() {
    let mut merged = made_up([1000, 0, 0, 0, 0, 0], Vec::new());
    merged.campaign = merged.campaign.hunting("my {pack} {out}").expect("a command");
    (merged.campaign.candidate_ms, merged.campaign.max_faces) = (Some(1500), Some(900));
    let page = page(&merged, &[]);
    for option in ["--terrains 2 ", "--max-faces 900 ", "--seed 5 ", "--timeout 1.5 "] {
        assert!(page.contains(option), "{option}: {page}");
    }
}

/// The page of a campaign that was written into a folder with these files in its folder `wrong`.
fn page(merged: &Merged, wrong: &[&str]) -> String {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("wrong")).unwrap();
    wrong.iter().for_each(|name| std::fs::write(folder.path().join("wrong").join(name), "").unwrap());
    write_campaign(merged, folder.path()).unwrap();
    assert!(folder.path().join("summary.json").exists());
    std::fs::read_to_string(folder.path().join("report.html")).unwrap()
}

#[test]
fn the_page_counts_lists_and_links() {
    let mut merged = made_up([990, 6, 2, 0, 1, 1], vec![wrong_ray()]);
    merged.terrains[1].parts[2].by_class = [980, 6, 12, 0, 1, 1];
    let page = page(&merged, &["terrain-000000-own.toml", "terrain-000000-own-smallest.md"]);
    // Eight scenes of 1000 rays, with a defect and an undecided one each.
    assert!(page.contains("16 of 8,000 rays are wrong or undecided"), "{page}");
    // Terrain 1 has ten rays more of class `rounding`: it is the harder one, and its scene `aimed` is to be seen again.
    let at = |words: &str| page.find(words).unwrap_or_else(|| panic!("{words} is not in {page}"));
    let [one, zero] =
        [1, 0].map(|terrain| at(&format!("<tr class=\"fails\"><th scope=\"row\">{terrain}</th>")));
    assert!(one < zero);
    at("raypencil campaign replay --seed 5 --terrain 1 --part aimed -o DIR</code>");
    // Links lead to files that are there, and to no others.
    at("<a href=\"wrong/terrain-000000-own-smallest.md\">smallest scene</a>");
    at("<a href=\"wrong/terrain-000000-own.toml\">whole scene</a>");
    assert_eq!(page.matches("<a href").count(), 2);
    at("beam-0 3,1</b>, range. 1 m and 2 m");
    // Of the scenes `own` 20 rays do not simply agree: 12 tie, 4 are rounding, 2 undecided, 2 defects.
    for share in ["60.00", "20.00", "10.00"] {
        at(&format!("\" style=\"width:{share}%\"></i>"));
    }
    at("raypencil probe DIR/scene.toml --beam 0 --pencil 3,1");
}

#[test]
fn the_hardest_terrain_is_that_of_the_most_wrong_then_rounded_then_tied_rays() {
    let mut merged = made_up([1000, 0, 0, 0, 0, 0], Vec::new());
    // Classes in their order: agree, tie, rounding, approximation, undecided, defect.
    merged.terrains[0].parts[0].by_class = [948, 50, 2, 0, 0, 0];
    merged.terrains[1].parts[0].by_class = [988, 3, 9, 0, 0, 0];
    let order = |merged: &Merged| {
        let page = page(merged, &[]);
        let at = |terrain: u64| page.find(&format!("<th scope=\"row\">{terrain}</th>")).expect("a row");
        at(0) < at(1)
    };
    assert!(!order(&merged));
    merged.terrains[1].parts[0].by_class = [995, 3, 2, 0, 0, 0];
    assert!(order(&merged));
    // The worst of a terrain, of which one value is no number.
    merged.terrains[1].parts[2].quantities[0].worst_ratio.as_mut().unwrap().value = None;
    assert!(page(&merged, &[]).contains("<td>infinite</td>"), "{}", page(&merged, &[]));
}

#[test]
fn a_worst_value_that_is_no_finite_number_is_told_in_words() {
    let mut merged = made_up([1000, 0, 0, 0, 0, 0], Vec::new());
    let quantity = &mut merged.terrains[0].parts[0].quantities[0];
    quantity.worst_ratio.as_mut().unwrap().value = None;
    let row = |merged: &Merged| {
        let screen = campaign_screen(merged);
        screen.lines().find(|line| line.starts_with("range ")).expect("a row").to_string()
    };
    // As `check` has it where nothing was allowed.
    assert!(row(&merged).contains(" infinite ") && !row(&merged).contains("NaN"), "{}", row(&merged));
    merged.terrains[0].parts[0].quantities[0].worst_error.as_mut().unwrap().value = None;
    assert!(row(&merged).contains(" not finite  infinite "), "{}", row(&merged));
}

#[test]
fn the_least_and_the_most_faces_are_those_of_any_terrain() {
    let mut merged = made_up([1000, 0, 0, 0, 0, 0], Vec::new());
    merged.terrains.push(TerrainRecord { terrain: 2, ..merged.terrains[0].clone() });
    let faces = |merged: &Merged| -> Value {
        serde_json::from_str::<Value>(&campaign_json(merged)).unwrap()["faces"].clone()
    };
    (merged.terrains[0].faces, merged.terrains[1].faces, merged.terrains[2].faces) = (50, 7, 60);
    assert_eq!(faces(&merged), serde_json::json!({ "least": 7, "most": 60, "total": 117 }));
    (merged.terrains[0].faces, merged.terrains[1].faces, merged.terrains[2].faces) = (50, 70, 60);
    assert_eq!(faces(&merged), serde_json::json!({ "least": 50, "most": 70, "total": 180 }));
}

#[test]
fn a_page_without_defects_or_hits_says_so() {
    let fine = page(&made_up([990, 6, 4, 0, 0, 0], Vec::new()), &[]);
    assert!(
        fine.contains("8,000 rays, no defect, none undecided") && fine.contains("<p>None.</p>"),
        "{fine}"
    );
    let nothing = page(&with_hits(0, [1000, 0, 0, 0, 0, 0], Vec::new()), &[]);
    assert!(nothing.contains("Nothing is hit: all 8,000 rays miss the terrain"), "{nothing}");
    assert!(nothing.contains("Warning: scenes own: none of its 2,000 rays hits"), "{nothing}");
}

#[test]
fn the_page_of_a_hunt_says_what_is_hunted_and_what_failed() {
    let mut merged = made_up([990, 6, 4, 0, 0, 0], Vec::new());
    merged.campaign = merged.campaign.hunting("my <tracer> {pack} {out}").unwrap();
    assert!(merged.passes());
    let fine = page(&merged, &[]);
    assert!(
        fine.contains("Every answer of the program under test was compared with the exact one"),
        "{fine}"
    );
    assert!(fine.contains("my &#60;tracer&#62; {pack} {out}") && !fine.contains("<tracer>"), "{fine}");
    assert!(fine.contains("--candidate-command &#39;my") && !fine.contains("<h2>No answer</h2>"), "{fine}");
    merged.terrains[1].parts[0].failed = Some("it ended with exit status: 3".into());
    assert!(!merged.passes());
    assert_eq!(merged.failures().collect::<Vec<_>>(), [(1, PartName::Own, "it ended with exit status: 3")]);
    let failed = page(&merged, &[]);
    assert!(failed.contains("1 scene has no answer") && !failed.contains("Nothing is hit"), "{failed}");
    assert!(failed.contains("terrain 1 own: no answer: it ended with exit status: 3"), "{failed}");
    let screen = campaign_screen(&merged);
    assert!(
        screen.contains("under test: my <tracer>") && screen.contains("1 scene has no answer"),
        "{screen}"
    );
    let json: Value = serde_json::from_str(&campaign_json(&merged)).unwrap();
    assert_eq!(json["no_answer"][0]["terrain"], 1);
    assert_eq!(json["verdict"], "defects");
}

#[test]
fn the_same_mistake_of_many_scenes_is_one_reason() {
    let mut merged = made_up([990, 6, 0, 0, 0, 4], vec![wrong_ray()]);
    merged.campaign = merged.campaign.hunting("my {pack} {out}").expect("a command");
    let reason = |key: &str, clause: &str, explained: u64| ReasonRecord {
        mistakes: vec![key.into()],
        clause: clause.into(),
        wrong: 4,
        explained,
        right: 90,
        broken: 4 - explained,
    };
    // Eight scenes with wrong rays: of two terrains in four parts.
    merged.terrains[0].parts[0].reasons = vec![reason("scaled", "lengths are times 2", 4)];
    merged.terrains[1].parts[2].reasons = vec![reason("scaled", "lengths are times 3", 3)];
    merged.terrains[1].parts[3].reasons = vec![
        reason("rows_reversed", "rows are reversed", 4),
        reason("rows_reversed", "rows are reversed", 4),
    ];
    let screen = campaign_screen(&merged).split_whitespace().collect::<Vec<_>>().join(" ");
    for words in [
        "Why: in 2 of 8 scenes with wrong rays, 87.50 % of them agree if lengths are times 2 (the numbers are those of \
         terrain 0 own; other scenes have others), and 1 of 180 right rays breaks.",
        "Why: in 1 of 8 scenes with wrong rays, 100 % of them agree if rows are reversed, and no right ray breaks.",
    ] {
        assert!(screen.contains(words), "{screen}");
        assert!(page(&merged, &[]).contains(words), "{words}");
    }
    let json: Value = serde_json::from_str(&campaign_json(&merged)).unwrap();
    assert_eq!(json["reasons"][0]["numbers_differ"], true);
    // Also where the last scene has the numbers of the first again.
    let mut again = merged.clone();
    again.terrains[1].parts[3].reasons = vec![reason("scaled", "lengths are times 2", 4)];
    let of_again: Value = serde_json::from_str(&campaign_json(&again)).unwrap();
    assert_eq!(
        [&of_again["reasons"][0]["numbers_differ"], &of_again["reasons"][0]["scenes"]],
        [&Value::from(true), &Value::from(3)]
    );
    // And where two scenes have others.
    again.terrains[1].parts[3].reasons = vec![reason("scaled", "lengths are times 4", 4)];
    let of_again: Value = serde_json::from_str(&campaign_json(&again)).unwrap();
    assert_eq!(of_again["reasons"][0]["numbers_differ"], true);
    // A scene whose wrong rays have no reason counts among those with wrong rays; of equals the one that explains more is told first.
    let mut few = merged.clone();
    few.terrains[0].parts[0].reasons = vec![reason("zz", "z", 1), reason("aa", "a", 2)];
    few.terrains[1].parts[2].reasons = vec![reason("zz", "z", 1)];
    few.terrains[1].parts[3].reasons.clear();
    let of_few: Value = serde_json::from_str(&campaign_json(&few)).unwrap();
    let names: Vec<&Value> = (0..2).map(|at| &of_few["reasons"][at]["mistakes"][0]).collect();
    assert_eq!(names, ["zz", "aa"], "most scenes first, whatever they explain");
    assert_eq!([&json["reasons"][1]["scenes"], &json["reasons"][1]["explained"]], [1, 8]);
    let schema = include_str!("../../../../../docs/formats/campaign.schema.json");
    assert_eq!(schema_faults(&serde_json::from_str(schema).unwrap(), &json), [""; 0]);
    // Three are told in words.
    let mut many = merged.clone();
    let told = |merged: &Merged, count: usize| {
        let mut many = merged.clone();
        many.terrains[0].parts[0].reasons =
            ["aa", "bb", "cc", "dd", "ee"].map(|key| reason(key, key, 4))[..count].to_vec();
        campaign_screen(&many)
    };
    many.terrains.iter_mut().flat_map(|terrain| &mut terrain.parts).for_each(|part| part.reasons.clear());
    assert!(!told(&many, 3).contains("in summary.json"));
    assert!(told(&many, 4).contains("1 more reason in summary.json."));
    assert!(told(&many, 5).contains("2 more reasons in summary.json."));
}

#[test]
fn a_campaign_in_which_nothing_is_compared_says_so() {
    let told = |merged: &Merged| {
        let summary: Value = serde_json::from_str(&campaign_json(merged)).unwrap();
        let schema = include_str!("../../../../../docs/formats/campaign.schema.json");
        assert_eq!(schema_faults(&serde_json::from_str(schema).unwrap(), &summary), [""; 0]);
        assert!(!merged.passes());
        (summary["verdict"].as_str().unwrap().to_string(), campaign_screen(merged))
    };
    let mut left_out = made_up([0; 6], Vec::new());
    left_out.campaign.max_faces = Some(12);
    left_out.terrains.iter_mut().for_each(|terrain| terrain.parts.clear());
    let (verdict, screen) = told(&left_out);
    assert_eq!(verdict, "nothing_compared");
    let words = "--max-faces 12 leaves out 2 of 2 terrains; the smallest has 1,000 faces.";
    assert!(screen.contains("? Nothing is compared.") && screen.contains(words), "{screen}");
    // Scenes without a ray are no matter of their faces.
    let idle = with_hits(0, [0; 6], Vec::new());
    let (verdict, screen) = told(&idle);
    assert_eq!((verdict.as_str(), idle.warnings().len()), ("nothing_compared", 0));
    assert!(
        screen.contains("None of the scenes has a ray to compare.") && !screen.contains("max-faces"),
        "{screen}"
    );
    // A scene without an answer is told, not that nothing is compared.
    let mut failed = made_up([0; 6], Vec::new());
    failed.terrains[0].parts[0].failed = Some("it crashed".into());
    let (verdict, screen) = told(&failed);
    assert_eq!(verdict, "defects");
    assert!(screen.contains("1 scene has no answer"), "{screen}");
}
