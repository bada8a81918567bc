//! Sweeps of small scenes: each number against the same scene by itself, interruptions, parts, tables read back.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;
use raypencil_drive::{DriveJob, drive, drive_json};
use raypencil_harness::{Contender, contender, validate};
use raypencil_judge::JudgeShare;
use raypencil_report::Mark;
use raypencil_scene::Silent;
use raypencil_scene_io::{Overrides, Setting, load};
use raypencil_sweep::{
    Axis, Cells, Chart, Finished, Outcome, Part, Sweep, SweepError, SweepProgress, SweepTable, Task,
    default_charts, finish, has_part, read_plan, run_part, write_sweep,
};
use serde_json::Value;

const SCENE: &str = "version = 1
vehicle = { position_m = [-0.6, 0] }
camera = { width_px = 48, height_px = 40, pixel_pitch_um = 200 }
beam = [{ columns = 64, rows = 2 }, { columns = 64, rows = 2 }]
drive = { waypoints_m = [[0.4, 0]], frames_per_s = 3, scans = false }
";

struct House {
    folder: tempfile::TempDir,
    scene: PathBuf,
}

impl House {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let scene = folder.path().join("scene.toml");
        fs::write(&scene, SCENE).unwrap();
        Self { folder, scene }
    }

    fn folder(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn sweep(&self, task: Task, axes: &[&str]) -> Sweep {
        let axes = axes.iter().map(|axis| Axis::parse(axis).unwrap()).collect();
        let names = if task == Task::Validate { vec!["scanline", "tracer"] } else { vec!["scanline"] };
        let names = names.into_iter().map(String::from).collect();
        Sweep::new(self.scene.to_str().unwrap(), axes, task, names, false).unwrap()
    }
}

fn contenders(sweep: &Sweep) -> Vec<Contender> {
    sweep.renderers.iter().map(|name| contender(name).unwrap()).collect()
}

/// Number of runs that were made.
#[derive(Default)]
struct Made(Mutex<u64>);

impl SweepProgress for Made {
    fn runs(&self, _done: u64, _of: u64, made: u64) {
        *self.0.lock().unwrap() = made;
    }

    fn frames(&self, _done: u64, _planned: u64) {}
}

fn made(sweep: &Sweep, part: Part, folder: &Path) -> u64 {
    let progress = Made::default();
    run_part(sweep, part, &contenders(sweep), folder, &progress).unwrap();
    progress.0.into_inner().unwrap()
}

fn finished(sweep: &Sweep, folder: &Path) -> Finished {
    finish(sweep, &[folder.to_path_buf()]).unwrap()
}

/// The table as bytes of its two files.
fn files(finished: &Finished, folder: &Path) -> [Vec<u8>; 2] {
    let written = write_sweep(finished, &SweepTable::new(finished), &[], folder).unwrap();
    written.tables.map(|file| fs::read(file).unwrap())
}

fn results(finished: &Finished, run: usize) -> BTreeMap<String, Value> {
    match &finished.outcomes[run] {
        Outcome::Results(results) => results.iter().cloned().collect(),
        Outcome::Refused(why) => panic!("{why}"),
    }
}

fn loaded(house: &House, settings: &[&str]) -> raypencil_scene_io::LoadedScene {
    let settings = settings.iter().map(|setting| Setting::parse(setting).unwrap()).collect();
    load(house.scene.to_str().unwrap(), &Overrides { settings, ..Overrides::default() }).unwrap()
}

#[test]
fn every_number_of_a_validation_is_that_of_the_scene_by_itself() {
    let house = House::new();
    let sweep = house.sweep(Task::Validate, &["beam.0.pitch_down_deg=20,35", "flux.model=radiometric,eq1"]);
    assert_eq!(made(&sweep, Part::WHOLE, &house.folder("a")), 4);
    let finished = finished(&sweep, &house.folder("a"));
    assert!(finished.passes());
    let mut fluxes = Vec::new();
    for (run, (pitch, model)) in
        [(20, "radiometric"), (20, "eq1"), (35, "radiometric"), (35, "eq1")].into_iter().enumerate()
    {
        let loaded =
            loaded(&house, &[&format!("beam.0.pitch_down_deg={pitch}"), &format!("flux.model={model}")]);
        let subject = loaded.into_subject(String::new());
        let alone = validate(subject, &contenders(&sweep), JudgeShare::Sample, &Silent);
        let found = results(&finished, run);
        assert_eq!(found["compared"], alone.counts().compared);
        assert_eq!(found["agree"], alone.counts().agree);
        assert_eq!(found["passes"], true);
        let output = &alone.rendered[0].output;
        let camera = output.camera.as_ref().unwrap().range.as_ref().unwrap();
        assert_eq!(found["camera.hits"], camera.cells().iter().filter(|range| range.get().is_some()).count());
        let unit = if model == "eq1" { "w_per_m" } else { "w" };
        for (beam, image) in output.flux.iter().enumerate() {
            let sum: f64 = image.cells().iter().sum();
            assert!(sum > 0.0, "a beam that the camera sees");
            assert_eq!(found[&format!("beam-{beam}.flux_{unit}")], sum);
            // Some pixels are lit, and most of them are dark.
            let lit = image.cells().iter().filter(|flux| **flux != 0.0).count();
            assert!(lit > 0 && lit < image.cells().len() / 2, "{lit}");
            assert_eq!(found[&format!("beam-{beam}.lit_pixels")], lit);
            assert_eq!(found[&format!("beam-{beam}.flux_per_lit_pixel_{unit}")], sum / lit as f64);
            let visible = output.returns[beam].visible.as_ref().unwrap();
            let count = visible.cells().iter().filter(|it| **it).count();
            assert_eq!(found[&format!("beam-{beam}.visible")], count);
            assert_eq!(found[&format!("beam-{beam}.visible_share")], count as f64 / 128.0);
        }
        fluxes.push(found[&format!("beam-0.flux_{unit}")].as_f64().unwrap());
    }
    // The settings came through: another angle and another model are other light.
    assert!(fluxes[0] != fluxes[2] && fluxes[1] != fluxes[3] && fluxes[0] != fluxes[1], "{fluxes:?}");
}

#[test]
fn a_drive_gives_the_numbers_of_its_summary() {
    let house = House::new();
    let sweep = house.sweep(Task::Drive, &["drive.speed_m_per_s=0.3,0.6"]);
    made(&sweep, Part::WHOLE, &house.folder("a"));
    let finished = finished(&sweep, &house.folder("a"));
    for (run, speed) in ["0.3", "0.6"].into_iter().enumerate() {
        let loaded = loaded(&house, &[&format!("drive.speed_m_per_s={speed}")]);
        let job = DriveJob::new(&loaded, None, String::new()).unwrap();
        let scanline = contender("scanline").unwrap().renderer;
        let alone = drive(&job, &[scanline.as_ref()], &Silent).unwrap();
        let summary: Value = serde_json::from_str(&drive_json(&job, &alone)).unwrap();
        let found = results(&finished, run);
        for path in
            ["frames", "driven_m", "edge_points", "map/known", "truth/sectors", "points_off_ground/rms_m"]
        {
            assert_eq!(
                found[&path.replace('/', ".")],
                *summary.pointer(&format!("/{path}")).unwrap(),
                "{path}"
            );
        }
        // 0.4 m take 4 s / 3, or half of it: 5 and 3 frames at 3 per second, both ends included.
        assert_eq!(found["frames"], [5, 3][run]);
    }
}

#[test]
fn an_interrupted_sweep_goes_on_and_ends_with_the_same_bytes() {
    let house = House::new();
    let axes = ["camera.pitch_down_deg=10:30:10", "beam.thickness_mm=4,8"];
    let sweep = house.sweep(Task::Render, &axes);
    let (whole, broken) = (house.folder("whole"), house.folder("broken"));
    assert_eq!(made(&sweep, Part::WHOLE, &whole), 6);
    let expected = files(&finished(&sweep, &whole), &whole);
    // A run again makes nothing.
    assert_eq!(made(&sweep, Part::WHOLE, &whole), 0);

    assert_eq!(made(&sweep, Part::WHOLE, &broken), 6);
    let mut records: Vec<PathBuf> =
        fs::read_dir(broken.join("runs")).unwrap().map(|entry| entry.unwrap().path()).collect();
    records.sort();
    assert_eq!(records.len(), 6);
    // One record is lost; of others a number is changed, the end is cut off, and one is that of another run.
    fs::remove_file(&records[0]).unwrap();
    let text = fs::read_to_string(&records[1]).unwrap();
    let hits = text.find("\"camera.hits\",").unwrap() + "\"camera.hits\",".len();
    let digit = text[hits..].find(|c: char| c.is_ascii_digit()).unwrap() + hits;
    let other = if &text[digit..=digit] == "1" { "2" } else { "1" };
    fs::write(&records[1], format!("{}{other}{}", &text[..digit], &text[digit + 1..])).unwrap();
    let text = fs::read(&records[2]).unwrap();
    fs::write(&records[2], &text[..text.len() / 2]).unwrap();
    fs::copy(&records[4], &records[3]).unwrap();
    let refused = finish(&sweep, std::slice::from_ref(&broken)).unwrap_err().to_string();
    assert!(refused.starts_with("4 of 6 runs have no record"), "{refused}");
    assert_eq!(made(&sweep, Part::WHOLE, &broken), 4);
    assert_eq!(files(&finished(&sweep, &broken), &broken), expected);
}

#[test]
fn parts_join_to_the_whole_and_a_missing_one_is_named() {
    let house = House::new();
    let sweep =
        house.sweep(Task::Render, &["camera.pitch_down_deg=10:25:5", "terrain.builtin=pyramids,facets"]);
    let whole = house.folder("whole");
    made(&sweep, Part::WHOLE, &whole);
    let parts: Vec<PathBuf> = (0..3).map(|index| house.folder(&format!("part-{index}"))).collect();
    let counts: Vec<u64> =
        (0..3).map(|index| made(&sweep, Part { index, count: 3 }, &parts[index as usize])).collect();
    assert_eq!(counts, [3, 3, 2]);
    assert_eq!(read_plan(&parts[2]).unwrap(), sweep);
    let joined = finish(&sweep, &[parts[2].clone(), parts[0].clone(), parts[1].clone()]).unwrap();
    assert_eq!(files(&joined, &parts[0]), files(&finished(&sweep, &whole), &whole));
    let refused = finish(&sweep, &parts[..2]).unwrap_err().to_string();
    assert!(refused.contains("2 of 8 runs have no record, the first of them run 2"), "{refused}");
}

#[test]
fn more_values_take_over_the_runs_of_before_and_another_build_does_not() {
    let house = House::new();
    let folder = house.folder("a");
    assert_eq!(made(&house.sweep(Task::Render, &["camera.pitch_down_deg=10,20"]), Part::WHOLE, &folder), 2);
    let more = house.sweep(Task::Render, &["camera.pitch_down_deg=10,20,30"]);
    assert_eq!(made(&more, Part::WHOLE, &folder), 1);
    assert_eq!(results(&finished(&more, &folder), 2).len(), 13);
    let other = Sweep { build: "another".into(), ..more };
    assert_eq!(made(&other, Part::WHOLE, &folder), 3);
    // Another scene under the same name.
    fs::write(&house.scene, SCENE.replace("48", "50")).unwrap();
    assert_eq!(made(&house.sweep(Task::Render, &["camera.pitch_down_deg=10,20"]), Part::WHOLE, &folder), 2);
}

/// All files below a folder with their bytes, but for lists of what was made.
fn tree(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        if entry.is_dir() {
            found.extend(tree(&entry));
        } else if !entry.ends_with(".raypencil-made") {
            found.insert(entry.clone(), fs::read(entry).unwrap());
        }
    }
    found
}

#[test]
fn maps_are_those_of_their_row_whatever_the_folder_had() {
    let house = House::new();
    let render = |values: &str, folder: &Path| {
        let sweep = house.sweep(Task::Render, &[&format!("camera.pitch_down_deg={values}")]);
        made(&sweep, Part::WHOLE, folder)
    };
    let maps = |folder: &Path| -> BTreeMap<PathBuf, Vec<u8>> {
        let below = folder.join("maps");
        tree(&below)
            .into_iter()
            .map(|(path, bytes)| (path.strip_prefix(&below).unwrap().into(), bytes))
            .collect()
    };
    let (used, fresh) = (house.folder("used"), house.folder("fresh"));
    assert_eq!(render("20,25", &used), 2);
    // Run 0 was another one, and run 1 is new.
    assert_eq!(render("25,30", &used), 2);
    assert_eq!(render("25,30", &fresh), 2);
    assert_eq!(maps(&used), maps(&fresh));
    assert_eq!(render("25,30", &used), 0);
    // A map that was changed, or is gone, is made again with its run.
    let map = used.join("maps/000001/beam-0.exr");
    fs::write(&map, "changed").unwrap();
    assert_eq!(render("25,30", &used), 1);
    fs::remove_file(&map).unwrap();
    assert_eq!(render("25,30", &used), 1);
    assert_eq!(maps(&used), maps(&fresh));
    // A smaller sweep leaves no map without a row, and what is not its own.
    fs::write(used.join("maps/000001/mine.txt"), "mine").unwrap();
    assert_eq!(render("25", &used), 0);
    let left: Vec<PathBuf> = maps(&used).into_keys().filter(|path| !path.starts_with("000000")).collect();
    assert_eq!(left, [PathBuf::from("000001/mine.txt")]);
}

#[test]
fn a_ground_that_changes_behind_its_runs_has_them_made_again() {
    let house = House::new();
    let ground = |name: &str, height: f64| {
        let corners = [[-50, -50], [50, -50], [50, 50], [-50, 50]];
        let vertices = corners.map(|[x, y]| format!("v {x} {y} {height}\n")).concat();
        fs::write(house.folder(name), format!("{vertices}f 1 2 3\nf 1 3 4\n")).unwrap();
    };
    ground("g.obj", 0.0);
    ground("h.obj", 0.5);
    let axes = ["terrain.file=g.obj,h.obj", "camera.pitch_down_deg=10,20"];
    let sweep = || house.sweep(Task::Render, &axes);
    let (folder, fresh) = (house.folder("a"), house.folder("fresh"));
    assert_eq!(made(&sweep(), Part::WHOLE, &folder), 4);
    assert_eq!(made(&sweep(), Part::WHOLE, &folder), 0);
    assert!(has_part(&sweep(), Part::WHOLE, &folder));
    // One ground of two: its runs alone.
    ground("g.obj", 0.75);
    assert!(!has_part(&sweep(), Part::WHOLE, &folder));
    let earlier = house.folder("earlier");
    assert_eq!(made(&sweep(), Part { index: 0, count: 2 }, &earlier), 2);
    assert_eq!(made(&sweep(), Part::WHOLE, &folder), 2);
    assert_eq!(made(&sweep(), Part::WHOLE, &fresh), 4);
    let sweep = sweep();
    assert_eq!(files(&finished(&sweep, &folder), &folder), files(&finished(&sweep, &fresh), &fresh));
    // Parts of two grounds are no sweep.
    ground("g.obj", 1.0);
    let later = house.folder("later");
    assert_eq!(made(&sweep, Part { index: 1, count: 2 }, &later), 2);
    let refused = finish(&sweep, &[earlier, later]).unwrap_err().to_string();
    assert!(refused.starts_with("g.obj is another file for run 1 than for run 0"), "{refused}");
}

#[test]
fn a_run_that_is_refused_has_its_reason_in_the_table() {
    let house = House::new();
    let sweep = house.sweep(Task::Validate, &["beam.0.thickness_mm=8,-8"]);
    let folder = house.folder("a");
    assert_eq!(made(&sweep, Part::WHOLE, &folder), 2);
    // It is tried again.
    assert_eq!(made(&sweep, Part::WHOLE, &folder), 1);
    let finished = finished(&sweep, &folder);
    assert!(!finished.passes());
    let table = SweepTable::new(&finished);
    let refused = table.column("refused").unwrap();
    assert_eq!(refused.cells.text(0), "");
    assert!(refused.cells.text(1).starts_with("set beam.0.thickness_mm=-8: "), "{}", refused.cells.text(1));
    assert_eq!(table.column("compared").unwrap().cells.number(1), None);
}

#[test]
fn the_table_reads_back_from_parquet_and_csv() {
    let house = House::new();
    let list = house.folder("runs.csv");
    fs::write(
        &list,
        "flux.model,camera.pitch_down_deg,camera.aperture_mm\nradiometric,20,2\n,22.5,4\neq1,25,2\n",
    )
    .unwrap();
    let axes = vec![Axis::read_list(&list).unwrap()];
    let sweep =
        Sweep::new(house.scene.to_str().unwrap(), axes, Task::Render, vec!["tracer".into()], false).unwrap();
    let folder = house.folder("a");
    made(&sweep, Part::WHOLE, &folder);
    let finished = finished(&sweep, &folder);
    let table = SweepTable::new(&finished);
    let written = write_sweep(&finished, &table, &[], &folder).unwrap();
    // The reports beside the table: a row and a test case for each run.
    let read = |name: &str| fs::read_to_string(folder.join(name)).unwrap();
    let runs = table.runs();
    assert_eq!(read("report.html").matches("<th scope=\"row\">").count(), runs);
    assert!(read("junit.xml").contains(&format!("tests=\"{runs}\" skipped=\"0\" failures=\"0\"")));
    assert!(read("summary.md").contains(&format!("{runs} runs, all made")));
    let types: Vec<&str> = table.columns[..4]
        .iter()
        .map(|column| match column.cells {
            Cells::Integers(_) => "integers",
            Cells::Numbers(_) => "numbers",
            Cells::Truths(_) => "truths",
            Cells::Texts(_) => "texts",
        })
        .collect();
    assert_eq!(types, ["integers", "texts", "numbers", "integers"]);
    let mut csv = csv::Reader::from_path(&written.tables[0]).unwrap();
    let names: Vec<String> = csv.headers().unwrap().iter().map(String::from).collect();
    assert_eq!(names[..4], ["run", "flux.model", "camera.pitch_down_deg", "camera.aperture_mm"]);
    assert!(
        names.contains(&"beam-1.flux_w".to_string()) && names.contains(&"beam-1.flux_w_per_m".to_string())
    );
    let rows: Vec<csv::StringRecord> = csv.records().map(Result::unwrap).collect();
    assert_eq!(rows.len(), 3);
    // An empty value in the list is the scene's own.
    assert_eq!((&rows[1][1], &rows[1][2]), ("", "22.5"));
    let reader = SerializedFileReader::new(fs::File::open(&written.tables[1]).unwrap()).unwrap();
    let mut cells = 0;
    for (row, csv) in reader.get_row_iter(None).unwrap().map(Result::unwrap).zip(&rows) {
        for ((name, field), (expected, text)) in row.get_column_iter().zip(names.iter().zip(csv)) {
            assert_eq!(name, expected);
            match field {
                Field::Null => assert_eq!(text, "", "{name}"),
                Field::Long(value) => assert_eq!(text, value.to_string(), "{name}"),
                Field::Double(value) => {
                    assert_eq!(text.parse::<f64>().unwrap().to_bits(), value.to_bits(), "{name}")
                }
                Field::Str(value) => assert_eq!(text, value, "{name}"),
                other => panic!("{name}: {other:?}"),
            }
            cells += 1;
        }
    }
    assert_eq!(cells, 3 * names.len());
    // An empty cell is one of a unit that the run does not have.
    assert_eq!(table.column("beam-1.flux_w_per_m").unwrap().cells.number(0), None);
    assert!(table.column("beam-1.flux_w_per_m").unwrap().cells.number(2).unwrap() > 0.0);
}

#[test]
fn runs_of_one_ground_are_made_one_after_the_other() {
    let house = House::new();
    let axes = ["camera.pitch_down_deg=10,20", "terrain.generate.seed=1,2"];
    fs::write(
        &house.scene,
        format!("{SCENE}terrain = {{ generate = {{ kind = \"plain\", faces = 200 }} }}\n"),
    )
    .unwrap();
    let sweep = house.sweep(Task::Render, &axes);
    let folder = house.folder("a");
    made(&sweep, Part::WHOLE, &folder);
    let finished = finished(&sweep, &folder);
    // Runs 0 and 2 have the ground of seed 1. The maps of run 2 are those of its scene, and not of a ground that was kept.
    let hits = |run: usize| results(&finished, run)["camera.hits"].as_u64().unwrap();
    for (run, seed) in [(0, 1), (1, 2), (2, 1), (3, 2)] {
        let pitch = [10, 10, 20, 20][run];
        let scene = loaded(
            &house,
            &[&format!("camera.pitch_down_deg={pitch}"), &format!("terrain.generate.seed={seed}")],
        )
        .scene;
        let output =
            contender("tracer").unwrap().renderer.render(&scene, &raypencil_scene::Request::EVERYTHING);
        let camera = output.camera.unwrap().range.unwrap();
        assert_eq!(
            hits(run),
            camera.cells().iter().filter(|range| range.get().is_some()).count() as u64,
            "{run}"
        );
    }
}

#[test]
fn charts_have_a_line_for_each_value_and_name_what_is_missing() {
    let house = House::new();
    let sweep =
        house.sweep(Task::Render, &["camera.pitch_down_deg=10,20,30", "terrain.builtin=pyramids,facets"]);
    let folder = house.folder("a");
    made(&sweep, Part::WHOLE, &folder);
    let table = SweepTable::new(&finished(&sweep, &folder));
    let all = default_charts(&table, Task::Render);
    // The ground is no number: it has no chart of its own.
    assert_eq!(all.len(), 3);
    assert!(all.iter().all(|chart| chart.parameter == "camera.pitch_down_deg"));
    let chart = Chart::parse("camera.hits,camera.pitch_down_deg,terrain.builtin").unwrap();
    let svg = chart.draw(&table).unwrap().svg();
    for word in [">pyramids<", ">facets<", ">camera.hits<", ">camera.pitch_down_deg<"] {
        assert!(svg.contains(word), "{word}");
    }
    // The key's own name, 21 letters of at most 8 pixels, ends on the page, though its values are short.
    let by_pitch =
        Chart::parse("camera.hits,terrain.builtin,camera.pitch_down_deg").unwrap().draw(&table).unwrap();
    let named = by_pitch.marks.iter().filter_map(|mark| match mark {
        Mark::Text { at, text, .. } if text == "camera.pitch_down_deg" => Some(at[0] + 8.0 * 21.0),
        _ => None,
    });
    assert!(named.fold(0.0, f64::max) <= f64::from(by_pitch.width), "{}", by_pitch.width);
    let over_words = Chart::parse("camera.hits,terrain.builtin").unwrap().draw(&table).unwrap().svg();
    assert!(over_words.contains(">facets<") && over_words.contains("mean of the runs"));
    for (text, expected) in [
        (
            "nothing,camera.pitch_down_deg",
            "the table has no result `nothing`; expected one of run, camera.pitch_down_deg",
        ),
        ("camera.hits,beam.pitch", "the table has no parameter `beam.pitch`"),
        ("terrain.builtin,camera.pitch_down_deg", "`terrain.builtin` has no number in any run"),
    ] {
        let message = Chart::parse(text).unwrap().draw(&table).unwrap_err().to_string();
        assert!(message.contains(expected), "{message}");
    }
}

#[test]
fn plans_that_are_none_are_refused() {
    let house = House::new();
    let scene = house.scene.to_str().unwrap();
    let plan = |axes: &[&str]| {
        let axes = axes.iter().map(|axis| Axis::parse(axis).unwrap()).collect();
        Sweep::new(scene, axes, Task::Render, vec!["tracer".into()], false)
    };
    let message = |result: Result<Sweep, SweepError>| result.unwrap_err().to_string();
    assert!(message(plan(&["a=1,2", "a=3"])).starts_with("`a` is given twice"));
    let many: Vec<String> = (0..4).map(|key| format!("k{key}=1:1000:1")).collect();
    assert!(
        message(plan(&many.iter().map(String::as_str).collect::<Vec<_>>()))
            .contains("runs; expected 1 to 10000000")
    );
    assert!(
        message(Sweep::new("nowhere.toml", vec![], Task::Render, vec![], false)).contains("does not exist")
    );
    let folder = house.folder("a");
    fs::create_dir(&folder).unwrap();
    assert!(read_plan(&folder).unwrap_err().to_string().contains("sweep.json"));
    for text in ["{}", "[1", "{\"scene\": 3}"] {
        fs::write(folder.join("sweep.json"), text).unwrap();
        assert!(read_plan(&folder).unwrap_err().to_string().contains("expected the plan of a sweep"));
    }
    // Ten million runs, and not one of them made.
    let plan_of = |axes: &[&str]| serde_json::to_string(&plan(axes).unwrap()).unwrap();
    let axes: Vec<String> = (0..7).map(|key| format!("k{key}=1:10:1")).collect();
    fs::write(folder.join("sweep.json"), plan_of(&axes.iter().map(String::as_str).collect::<Vec<_>>()))
        .unwrap();
    let start = std::time::Instant::now();
    let refused = message(
        read_plan(&folder).and_then(|plan| finish(&plan, std::slice::from_ref(&folder)).map(|_| plan)),
    );
    assert!(
        refused.starts_with("10000 or more of 10000000 runs have no record, the first of them run 0"),
        "{refused}"
    );
    assert!(start.elapsed().as_secs() < 5);
    // A plan that was changed by hand, with a row that is too short.
    let plan = serde_json::to_string(&plan(&["a=1,2"]).unwrap()).unwrap().replace("[\"2\"]", "[]");
    fs::write(folder.join("sweep.json"), plan).unwrap();
    assert!(read_plan(&folder).unwrap_err().to_string().contains("a value for each key"));
}

#[test]
fn a_run_that_one_folder_has_and_another_refused_has_its_results() {
    let house = House::new();
    let sweep = house.sweep(Task::Render, &["terrain.file=g.obj", "camera.pitch_down_deg=10,20"]);
    let (before, after) = (house.folder("before"), house.folder("after"));
    made(&sweep, Part::WHOLE, &before);
    fs::write(house.folder("g.obj"), "v -50 -50 0\nv 50 -50 0\nv 0 50 0\nf 1 2 3\n").unwrap();
    made(&sweep, Part::WHOLE, &after);
    let [refused, joined] =
        [vec![before.clone()], vec![before.clone(), after]].map(|folders| finish(&sweep, &folders));
    assert_eq!(refused.unwrap().refused().count(), 2);
    assert_eq!(joined.unwrap().refused().count(), 0);
    // One folder by two names.
    let again = house.folder("after/../before");
    let twice = finish(&sweep, &[before, again]).unwrap_err().to_string();
    assert!(twice.contains("is given twice; expected each folder once"), "{twice}");
}

#[test]
fn each_value_is_tried_in_the_first_run_that_has_it() {
    let house = House::new();
    let first_wrong = |axes: &[&str]| match house.sweep(Task::Render, axes).check_values() {
        Ok(()) => None,
        Err(SweepError::Value { run, given, .. }) => Some((run, given)),
        Err(other) => panic!("{other}"),
    };
    let fine = ["camera.pitch_down_deg=10,20", "beam.0.thickness_mm=2,4,8"];
    assert_eq!(first_wrong(&fine), None);
    let wrong = |run: u64, given: &str| Some((run, given.to_string()));
    assert_eq!(first_wrong(&["beam.0.thickness_mm=-8,4"]), wrong(0, "beam.0.thickness_mm=-8"));
    assert_eq!(first_wrong(&[fine[0], "beam.0.thickness_mm=2,4,-8"]), wrong(2, "beam.0.thickness_mm=-8"));
    // Run 3 is the first with the second value of the first axis, before three of the second.
    assert_eq!(first_wrong(&["camera.width_px=48,-1", fine[1]]), wrong(3, "camera.width_px=-1"));
}
