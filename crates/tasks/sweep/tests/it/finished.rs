//! What is said and drawn of a finished sweep: its headline, the runs that are shown, its table and its charts.

use std::path::PathBuf;

use raypencil_report::Mark;
use raypencil_sweep::{
    Axis, Chart, Finished, Outcome, Sweep, SweepTable, Task, Written, default_charts, sweep_document,
};
use serde_json::{Value, json};

/// A sweep over these axes with these outcomes, which nobody has made.
pub(super) fn finished(task: Task, axes: &[&str], outcomes: Vec<Outcome>) -> Finished {
    let sweep = Sweep {
        scene: "pyramids".into(),
        scene_sha256: "0".repeat(64),
        axes: axes.iter().map(|axis| Axis::parse(axis).unwrap()).collect(),
        task,
        renderers: vec!["scanline".into(), "tracer".into()],
        as_printed: false,
        build: "1".into(),
    };
    assert_eq!(sweep.runs(), outcomes.len() as u64);
    Finished { sweep, outcomes }
}

pub(super) fn results(results: &[(&str, Value)]) -> Outcome {
    Outcome::Results(results.iter().map(|(name, value)| (name.to_string(), value.clone())).collect())
}

fn passing(passes: bool) -> Outcome {
    results(&[("passes", json!(passes))])
}

pub(super) fn refused() -> Outcome {
    Outcome::Refused("no".into())
}

fn screen(finished: &Finished) -> String {
    let written = Written {
        tables: ["table.csv", "table.parquet"].map(PathBuf::from),
        charts: ["a.svg", "a.png"].map(PathBuf::from).to_vec(),
    };
    sweep_document(finished, &SweepTable::new(finished), &written, &[]).screen()
}

fn verdict(finished: &Finished) -> [String; 2] {
    let written = Written { tables: ["a", "b"].map(PathBuf::from), charts: Vec::new() };
    let document = sweep_document(finished, &SweepTable::new(finished), &written, &[]);
    let data: Value = serde_json::from_str(&document.json()).unwrap();
    ["verdict", "headline"].map(|key| data[key].as_str().unwrap().to_string())
}

#[test]
fn a_headline_tells_refused_runs_and_those_that_disagree() {
    let of = |outcomes: Vec<Outcome>| {
        let axis = format!("a=1:{}:1", outcomes.len());
        verdict(&finished(Task::Validate, &[&axis], outcomes))
    };
    assert_eq!(of(vec![passing(true), passing(true)]), ["made", "2 runs, all made."]);
    // They were made, all of them.
    let disagree = of(vec![passing(true), passing(false), passing(false)]);
    assert_eq!(disagree, ["defects", "3 runs; in 2 of them the renderers disagree."]);
    let not_made = of(vec![refused(), passing(true)]);
    assert_eq!(not_made, ["not_all_made", "1 of 2 runs could not be made."]);
    let both = of(vec![refused(), passing(false), passing(true)]);
    assert_eq!(
        both,
        ["defects", "1 of 3 runs could not be made; in 1 of the others the renderers disagree."]
    );
}

#[test]
fn as_many_runs_are_shown_as_there_is_room_for_and_the_others_are_counted() {
    let of = |count: usize, outcome: fn(usize) -> Outcome| {
        let axis = format!("a=1:{count}:1");
        screen(&finished(Task::Validate, &[&axis], (0..count).map(outcome).collect()))
    };
    let rows = |screen: &str| {
        let is_row = |line: &&str| {
            let mut words = line.split_whitespace().filter_map(|word| word.parse::<u64>().ok());
            matches!((words.next(), words.next()), (Some(run), Some(value)) if value == run + 1)
        };
        screen.lines().filter(is_row).count()
    };
    let [few, many] = [30, 31].map(|count| of(count, |_| passing(true)));
    assert!(!few.contains("more in the table") && rows(&few) == 30, "{few}");
    assert!(many.contains("... and 1 more in the table") && rows(&many) == 30, "{many}");
    // Five refused runs are told with their reason.
    let [five, six] = [5, 6].map(|count| of(count, |_| refused()));
    assert!(five.contains("run 4 could not be made: no") && !five.contains("has them all"), "{five}");
    assert!(!six.contains("run 5 could not be made: no") && six.contains("has them all"), "{six}");
    // A chart has two files.
    assert!(five.contains("beside it: table.parquet, 1 chart, report.html"), "{five}");
}

#[test]
fn results_stand_in_the_column_of_their_name_wherever_a_run_has_them() {
    let outcomes = vec![
        results(&[("a", json!(1)), ("b", json!(2)), ("passes", json!(true))]),
        results(&[("b", json!(4)), ("c", json!(5)), ("a", json!(3)), ("passes", json!(false))]),
        refused(),
    ];
    let table = SweepTable::new(&finished(Task::Render, &["k=1,2,3"], outcomes));
    let names: Vec<&str> = table.columns.iter().map(|column| column.name.as_str()).collect();
    assert_eq!(names, ["run", "k", "a", "b", "passes", "c", "refused"]);
    let numbers = |name: &str| [0, 1, 2].map(|run| table.column(name).unwrap().cells.number(run));
    assert_eq!(numbers("a"), [Some(1.0), Some(3.0), None]);
    assert_eq!(numbers("b"), [Some(2.0), Some(4.0), None]);
    assert_eq!(numbers("c"), [None, Some(5.0), None]);
    assert_eq!(numbers("passes"), [Some(1.0), Some(0.0), None]);
    assert_eq!(table.column("refused").unwrap().cells.text(2), "no");
}

#[test]
fn results_are_short_numbers_and_parameters_stand_as_they_were_given() {
    let outcome = |hits: u64, share: f64| {
        results(&[("camera.hits", json!(hits)), ("beam-0.visible_share", json!(share))])
    };
    let outcomes = vec![outcome(12_345, 0.123_456), outcome(7, 1.0)];
    let axis = Axis::list_from_bytes(b"a,b\n0.123456,x\n2,long\n", "list.csv".as_ref()).unwrap();
    let mut made = finished(Task::Render, &["a=1,2"], outcomes);
    made.sweep.axes = vec![axis];
    let screen = screen(&made);
    // Whole numbers keep their digits. Texts begin where their head does; numbers end where it does.
    let table: Vec<&str> = screen.lines().skip_while(|line| !line.starts_with("run")).take(3).collect();
    assert_eq!(
        table,
        [
            "run         a  b     camera.hits  beam-0.visible_share",
            "  0  0.123456  x           12345                 0.123",
            "  1         2  long            7                     1",
        ],
        "{screen}"
    );
}

#[test]
fn programs_get_the_words_that_give_the_scene_of_each_run() {
    let made = finished(Task::Validate, &["a=1,2", "b=x"], vec![passing(true), refused()]);
    let written = Written { tables: ["a", "b"].map(PathBuf::from), charts: Vec::new() };
    let json = sweep_document(&made, &SweepTable::new(&made), &written, &[]).json();
    let data: Value = serde_json::from_str(&json).unwrap();
    let run =
        |run: u64| json!({ "run": run, "arguments": format!("pyramids --set a={} --set b=x", run + 1) });
    assert_eq!(data["runs"], json!([run(0), run(1)]));
    assert_eq!(data["refused"], json!([{ "run": 1, "message": "no" }]));
}

#[test]
fn each_run_is_a_case_that_says_its_settings_and_whether_it_was_refused_or_disagrees() {
    let made = finished(Task::Validate, &["a=1:3:1"], vec![passing(true), refused(), passing(false)]);
    let written = Written { tables: ["a", "b"].map(PathBuf::from), charts: Vec::new() };
    let junit = sweep_document(&made, &SweepTable::new(&made), &written, &[]).junit().unwrap();
    let cases: Vec<&str> = junit.split("<testcase ").skip(1).collect();
    assert_eq!(cases.len(), 3, "{junit}");
    let faults = [None, Some(["refused", "no"]), Some(["defect", "the renderers disagree"])];
    for (run, (case, fault)) in cases.iter().zip(faults).enumerate() {
        assert!(case.starts_with(&format!("name=\"run {run}: a={}\"", run + 1)), "{case}");
        assert_eq!(case.contains("<failure"), fault.is_some(), "{case}");
        assert!(fault.iter().flatten().all(|word| case.contains(&format!("\"{word}\""))), "{case}");
    }
}

/// The lines of a chart that join the means of its runs: thinner ones are those of its axes and its grid.
fn lines(table: &SweepTable, chart: &str) -> Vec<Vec<[f64; 2]>> {
    let drawing = Chart::parse(chart).unwrap().draw(table).unwrap();
    let mean = |mark: &Mark| match mark {
        Mark::Line { points, width, .. } if *width == 1.6 => Some(points.clone()),
        _ => None,
    };
    drawing.marks.iter().filter_map(mean).collect()
}

#[test]
fn a_line_joins_the_means_of_its_runs_from_left_to_right() {
    let of = |values: [f64; 6]| {
        let outcomes = values.into_iter().map(|value| results(&[("y", json!(value))])).collect();
        SweepTable::new(&finished(Task::Render, &["x=2,-3,-1", "seed=1,2"], outcomes))
    };
    // At 2 the runs are 0 and 10, at the other places 5 and 5.
    let found = lines(&of([0.0, 10.0, 5.0, 5.0, 5.0, 5.0]), "y,x");
    let [line] = found.as_slice() else { panic!("{found:?}") };
    assert!(line.windows(2).all(|pair| pair[0][0] < pair[1][0] && pair[0][1] == pair[1][1]), "{line:?}");
    assert_eq!(line.len(), 3);
    // Three quarters of the way from -3 to 2 are two fifths from -3 to -1.
    let share = (line[1][0] - line[0][0]) / (line[2][0] - line[0][0]);
    assert!((share - 0.4).abs() < 1e-9, "{share}");
    // A line for each value of another parameter.
    assert_eq!(lines(&of([0.0, 10.0, 5.0, 5.0, 5.0, 5.0]), "y,x,seed").len(), 2);
}

#[test]
fn charts_are_drawn_of_parameters_with_several_numbers() {
    let of = |axes: &[&str], count: usize| {
        let outcomes = vec![results(&[("camera.hits", json!(7))]); count];
        let table = SweepTable::new(&finished(Task::Render, axes, outcomes));
        default_charts(&table, Task::Render).into_iter().map(|chart| chart.parameter).collect::<Vec<_>>()
    };
    assert_eq!(of(&["a=1,2", "b=3", "c=x,y"], 4), ["a"]);
    assert!(of(&["a=1"], 1).is_empty());
    // A list may leave a value to the scene: that run has no place in a chart.
    let axis = Axis::list_from_bytes(b"a,b\n1,4\n2,\n3,5\n", "list.csv".as_ref()).unwrap();
    let outcomes = vec![results(&[("camera.hits", json!(7))]); 3];
    let mut list = finished(Task::Render, &["a=1,2,3"], outcomes);
    list.sweep.axes = vec![axis];
    let charts = default_charts(&SweepTable::new(&list), Task::Render);
    assert_eq!(charts.iter().map(|chart| chart.parameter.as_str()).collect::<Vec<_>>(), ["a", "b"]);
}

#[test]
fn an_empty_line_of_a_list_is_a_run_for_nobody() {
    let list = |text: &str| Axis::list_from_bytes(text.as_bytes(), "list.csv".as_ref());
    // In a list of one key it may stand for an empty value, which a reader of CSV passes over.
    for text in ["k\n15\n\n20\n", "k\r\n15\r\n \r\n20\r\n"] {
        let error = list(text).unwrap_err().to_string();
        assert!(
            error.contains("list.csv") && error.contains("line 3: an empty line") && error.contains("\"\""),
            "{error}"
        );
    }
    // Written out it is one, and empty lines at the end are none.
    assert_eq!(list("k\n15\n\"\"\n20\n\n\n").unwrap().rows.len(), 3);
    assert_eq!(list("k,m\n15,1\n\n20,2\n").unwrap().rows.len(), 2);
}
