//! `validate`, `render`, `probe`, `minimise`, and their errors.

use std::process::ExitCode;

use raypencil::{Precision, RenderOutput, Renderer, Request, Scene};
use tempfile::TempDir;

use super::{assert_trouble, raypencil, screen, text};

/// A folder with `small.toml`: the pyramids with small sensors, so that a run is short.
fn folder() -> TempDir {
    let folder = TempDir::new().expect("a temporary folder");
    let scene = "version = 1\n\
        [camera]\nwidth_px = 64\nheight_px = 48\npixel_pitch_um = 144\n\
        [[beam]]\ncolumns = 64\nrows = 4\n\
        [terrain]\nbuiltin = \"pyramids\"\n";
    std::fs::write(folder.path().join("small.toml"), scene).expect("a scene file");
    folder
}

#[test]
fn without_a_command_it_validates_the_pyramids() {
    let folder = TempDir::new().unwrap();
    let output = raypencil(folder.path(), &[]);
    let screen = text(&output.stdout);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(screen.contains("pyramids") && screen.contains("1,081,344"), "{screen}");
    // One screen: no more than 40 lines of 100 characters.
    assert!(screen.lines().count() <= 40, "{screen}");
    assert!(screen.lines().all(|line| line.chars().count() <= 100), "{screen}");
    // All but the paragraph of times, which no run repeats.
    let lasting: Vec<&str> = screen
        .split("\n\n")
        .map(|part| if part.contains(": clusters ") { "(times)" } else { part })
        .collect();
    insta::with_settings!({ omit_expression => true }, {
        insta::assert_snapshot!("without_a_command", lasting.join("\n\n"));
    });
    for file in
        ["summary.json", "report.html", "summary.md", "junit.xml", "scanline/camera.exr", "tracer/beam-1.exr"]
    {
        assert!(folder.path().join("out/pyramids").join(file).is_file(), "{file} is missing");
    }
    // Standard error is not a terminal, so there is no spinner.
    assert_eq!(text(&output.stderr), "");
}

/// A scene whose sensors look past the ground: the vehicle is 500 m beside it.
const ASIDE: &str = "version = 1\n[vehicle]\nposition_m = [500, 0, 0]\n\
    [camera]\nwidth_px = 64\nheight_px = 48\npixel_pitch_um = 144\n[[beam]]\ncolumns = 64\nrows = 4\n";

#[test]
fn a_scene_in_which_nothing_is_hit_fails_unless_it_is_allowed() {
    let folder = folder();
    std::fs::write(folder.path().join("aside.toml"), ASIDE).unwrap();
    for (options, code) in [(&[][..], 1), (&["--allow-empty"][..], 0)] {
        let shown = screen(folder.path(), &[&["validate", "aside.toml"], options].concat(), code);
        assert!(shown.contains("Nothing is hit: all 3,328 rays miss the terrain."), "{shown}");
        let words = shown.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(words.contains("warning: beam-0: none of its 256 rays hits the front"), "{shown}");
        assert!(!shown.contains("All ") && shown.contains("vehicle at (500.00, 0.00, 0.00) m"), "{shown}");
    }
    // Where something is hit, all is as before.
    screen(folder.path(), &["validate", "small.toml"], 0);
}

#[test]
fn render_and_pack_warn_on_standard_error_and_in_json() {
    let folder = folder();
    std::fs::write(folder.path().join("aside.toml"), ASIDE).unwrap();
    let sentence = "camera: none of its 3,072 rays hits the front of the terrain within the maximum range.";
    for command in
        [&["render", "aside.toml", "--with", "tracer"][..], &["pack", "aside.toml", "--no-bench"][..]]
    {
        let output = raypencil(folder.path(), &[command, &["-o", command[0]]].concat());
        assert_eq!(output.status.code(), Some(0));
        assert!(text(&output.stderr).contains(&format!("warning: {sentence}\n")), "{}", text(&output.stderr));
        assert!(!text(&output.stdout).contains("warning"));
        let json = screen(folder.path(), &[command, &["-o", command[0], "--json"]].concat(), 0);
        let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
        assert_eq!(json["warnings"][0]["code"], "no_hits");
        assert_eq!(json["warnings"].as_array().map(Vec::len), Some(2), "{json}");
    }
    let output = raypencil(folder.path(), &["render", "small.toml", "--with", "tracer", "-o", "maps"]);
    assert_eq!(text(&output.stderr), "");
}

#[test]
fn a_principal_point_left_from_the_default_image_is_told() {
    let folder = folder();
    let scene = "version = 1\n[camera]\nwidth_px = 1280\nheight_px = 960\nprincipal_point_px = [512, 512]\n";
    std::fs::write(folder.path().join("left.toml"), scene).unwrap();
    let output =
        raypencil(folder.path(), &["render", "left.toml", "--with", "tracer", "-o", "out", "--json"]);
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(json["warnings"][0]["code"], "principal_point_off_centre");
    assert_eq!(json["warnings"].as_array().map(Vec::len), Some(1), "{json}");
}

/// The paper's approximations on a thick sheet.
const PAPER: [&str; 4] = ["--thickness", "80", "--with", "scanline-paper,tracer"];

/// The summary of their validation, and its screen: one run for the tests that look at it.
fn of_the_paper() -> &'static (serde_json::Value, String) {
    static RUN: std::sync::OnceLock<(serde_json::Value, String)> = std::sync::OnceLock::new();
    RUN.get_or_init(|| {
        let folder = folder();
        let arguments = [["validate", "pyramids", "-o", "out"].as_slice(), &PAPER].concat();
        let shown = screen(folder.path(), &arguments, 0);
        let summary = std::fs::read(folder.path().join("out/summary.json")).expect("a summary");
        (serde_json::from_slice(&summary).expect("JSON"), shown)
    })
}

#[test]
fn a_text_for_a_pipe_is_not_cut() {
    // Of the paper's approximations on a thick sheet a line gets longer than a terminal is wide.
    let (_, shown) = of_the_paper();
    let line =
        shown.lines().find(|line| line.starts_with("camera  1,048,576 rays: ")).expect("the camera's line");
    assert!(line.contains(" approximation; ") && line.ends_with(" hit"), "{shown}");
    assert!(!shown.contains("..."), "{shown}");
}

#[test]
fn json_is_the_summary_that_was_written() {
    let folder = folder();
    let output = raypencil(folder.path(), &["validate", "small.toml", "--json", "-o", "here"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let printed: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let written = std::fs::read(folder.path().join("here/summary.json")).unwrap();
    let written: serde_json::Value = serde_json::from_slice(&written).expect("JSON");
    assert_eq!(printed, written);
    // 64 x 48 pixels and one beam of 64 x 4 pencils.
    assert_eq!(printed["compared"], 64 * 48 + 64 * 4);
    assert_eq!(printed["defects"], 0);
}

#[test]
fn maps_do_not_depend_on_the_number_of_threads() {
    let folder = folder();
    for threads in ["1", "3"] {
        let output =
            raypencil(folder.path(), &["validate", "small.toml", "--threads", threads, "-o", threads]);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    }
    for file in ["scanline/camera.exr", "scanline/beam-0.exr", "tracer/camera.exr", "tracer/beam-0.exr"] {
        let read = |threads: &str| std::fs::read(folder.path().join(threads).join(file)).unwrap();
        assert!(read("1") == read("3"), "{file} differs");
    }
}

#[test]
fn probe_prints_every_answer_to_one_ray() {
    let folder = folder();
    let output = raypencil(folder.path(), &["probe", "small.toml", "--beam", "0", "--pencil", "20,3"]);
    let said = text(&output.stdout);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let words = [
        "beam-0 pencil 20,3",
        "scanline: face",
        "tracer: face",
        "range",
        "normal",
        "seen by the camera",
        "cos(theta)",
        "flux",
    ];
    for word in words {
        assert!(said.contains(word), "`{word}` is not in:\n{said}");
    }
    let output = raypencil(folder.path(), &["probe", "small.toml", "--pixel", "63,47", "--json"]);
    let said: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(said["cell"], serde_json::json!([63, 47]));
    assert_eq!(said["answers"].as_array().map(Vec::len), Some(2));
}

#[test]
fn the_papers_errors_have_causes() {
    // With a sheet of 80 mm, the straight side of a pyramid's face is drawn beyond pencil 715,4.
    let (summary, _) = of_the_paper();
    let folder = folder();
    let paper = PAPER;
    assert_eq!(summary["defects"], 0);
    let of_cause = summary["approximations"]["beam-edges"].as_u64().expect("rays of that cause");
    assert!(of_cause > 10, "{summary:#}");
    let of_causes: u64 = summary["approximations"]
        .as_object()
        .expect("causes")
        .values()
        .map(|count| count.as_u64().expect("a count"))
        .sum();
    let count = |class: &str| summary[class].as_u64().expect("a count");
    assert_eq!(count("agree") + count("tie") + count("rounding") + of_causes, count("compared"));

    let ray = ["--beam", "0", "--pencil", "715,4"];
    let arguments = [["probe", "pyramids"].as_slice(), &paper, &ray].concat();
    let said = text(&raypencil(folder.path(), &arguments).stdout);
    for words in [
        "(approximation: beam-edges)",
        "is lost: the pencil lies between a true side and the straight line drawn for it",
        "tracer: face 130 (exact)",
        "again: raypencil probe pyramids --thickness 80 --with scanline-paper,tracer --beam 0 --pencil 715,4",
    ] {
        assert!(said.contains(words), "`{words}` is not in:\n{said}");
    }
    // One switch of the default renderer has the same effect; the renderer's name states it.
    let arguments = ["probe", "pyramids", "--thickness", "80", "--switch", "beam-edges=paper"];
    let said = text(&raypencil(folder.path(), &[arguments.as_slice(), &ray].concat()).stdout);
    assert!(said.contains("scanline-paper-beam-edges: face 54 (approximation: beam-edges)"), "{said}");
    // Another switch does not.
    let arguments = ["probe", "pyramids", "--thickness", "80", "--switch", "skip-rules=paper"];
    let said = text(&raypencil(folder.path(), &[arguments.as_slice(), &ray].concat()).stdout);
    assert!(said.contains("scanline-paper-skip-rules: face 130 (exact)"), "{said}");
}

#[test]
fn random_pencils_are_rendered_or_refused() {
    let folder = folder();
    let render = |with: &str, seed: &str, to: &str| {
        raypencil(folder.path(), &["render", "small.toml", "--with", with, "--jitter", seed, "-o", to])
    };
    let read = |to: &str| std::fs::read(folder.path().join(to).join("beam-0.exr")).unwrap();
    for (seed, to) in [("1", "a"), ("1", "b"), ("2", "c")] {
        let output = render("tracer", seed, to);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    }
    assert!(read("a") == read("b") && read("a") != read("c"), "the seed alone decides");
    assert_trouble(&render("scanline", "1", "d"), &["--jitter 1", "scanline", "tracer or referee"]);
    assert!(!folder.path().join("d").exists());
}

#[test]
fn render_writes_one_renderers_maps() {
    let folder = folder();
    let output = raypencil(folder.path(), &["render", "small.toml", "--with", "tracer", "-o", "maps"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let mut written: Vec<_> = std::fs::read_dir(folder.path().join("maps"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    written.sort();
    assert_eq!(written, [".raypencil-made", "beam-0.exr", "camera.exr"]);
}

#[test]
fn errors_are_one_clear_message() {
    let folder = folder();
    let at = folder.path();
    assert_trouble(&raypencil(at, &["validate", "moon"]), &["`moon`", "pyramids", ".glb"]);
    assert_trouble(&raypencil(at, &["validate", "gone.glb"]), &["gone.glb", "does not exist"]);
    assert_trouble(&raypencil(at, &["validate", "small.toml", "--with", "tracer"]), &["at least 2"]);
    assert_trouble(&raypencil(at, &["validate", "small.toml", "--with", "tracer,tracer"]), &["twice"]);
    assert_trouble(
        &raypencil(at, &["validate", "small.toml", "--with", "scanline,magic"]),
        &["magic", "scanline"],
    );
    let switch = |words: &'static str| raypencil(at, &["validate", "small.toml", "--switch", words]);
    assert_trouble(&switch("beam-edges"), &["beam-edges=paper"]);
    assert_trouble(&switch("beam-edges=maybe"), &["beam-edges=paper"]);
    assert_trouble(&switch("edges=paper"), &["edges", "beam-edges, skip-rules"]);
    let without = ["validate", "small.toml", "--with", "tracer,referee", "--switch", "beam-edges=paper"];
    assert_trouble(&raypencil(at, &without), &["no switches", "scanline"]);
    let twice =
        ["validate", "small.toml", "--with", "scanline,scanline-paper", "--switch", "beam-edges=paper"];
    let output = raypencil(at, &twice);
    assert_eq!(output.status.code(), Some(0), "different switches: {}", text(&output.stderr));
    std::fs::remove_dir_all(at.join("out")).unwrap();
    let others = ["skip-rules", "facing", "extent", "place"].map(|name| format!("{name}=paper"));
    let others: Vec<&str> = others.iter().flat_map(|setting| ["--switch", setting]).collect();
    let twice = [twice.as_slice(), &others].concat();
    assert_trouble(&raypencil(at, &twice), &["scanline-paper is named twice"]);
    assert_trouble(&raypencil(at, &["validate", "small.toml", "--fan", "180"]), &["fan", "180"]);
    assert_trouble(&raypencil(at, &["validate", "small.toml", "--at", "1000,0"]), &["no ground", "1000"]);
    assert_trouble(&raypencil(at, &["probe", "small.toml", "--pixel", "64,0"]), &["64,0", "64 x 48"]);
    assert_trouble(
        &raypencil(at, &["probe", "small.toml", "--beam", "1", "--pencil", "0,0"]),
        &["no beam 1", "1"],
    );
    assert_trouble(&raypencil(at, &["probe", "small.toml"]), &["--pixel"]);
    assert_trouble(&raypencil(at, &["validate", "small.toml", "--threads", "0"]), &["--threads"]);

    std::fs::write(at.join("bad.toml"), "version = 1\n[camera]\nwidth_px = 0\n").unwrap();
    assert_trouble(&raypencil(at, &["validate", "bad.toml"]), &["bad.toml", "width_px", "3"]);
    std::fs::write(at.join("rubbish.glb"), b"glTF rubbish that is no GLB at all").unwrap();
    assert_trouble(&raypencil(at, &["validate", "rubbish.glb"]), &["rubbish.glb"]);

    // A file in place of the output folder; none of the errors above left a file.
    std::fs::write(at.join("taken"), "").unwrap();
    assert_trouble(&raypencil(at, &["validate", "small.toml", "-o", "taken"]), &["taken"]);
    assert!(!at.join("out").exists());
}

/// A renderer whose normals have the wrong sign in x.
struct Flipped {
    inner: Box<dyn Renderer>,
}

impl Renderer for Flipped {
    fn name(&self) -> &str {
        "tracer"
    }

    fn precision(&self) -> Precision {
        self.inner.precision()
    }

    fn render(&self, scene: &Scene, request: &Request) -> RenderOutput {
        let mut output = self.inner.render(scene, request);
        for map in output.camera.iter_mut().chain(&mut output.beams) {
            for normal in map.normal.iter_mut().flat_map(|image| image.cells_mut()) {
                *normal = normal
                    .get()
                    .map(|mut n| {
                        n.x = -n.x;
                        n
                    })
                    .into();
            }
        }
        output
    }
}

#[test]
fn a_renderer_with_one_sign_flipped_is_a_defect() {
    let folder = folder();
    let registry = |name: &str| {
        let contender = raypencil::harness::contender(name)?;
        Some(if name == "tracer" { Flipped { inner: contender.renderer }.into() } else { contender })
    };
    let scene = folder.path().join("small.toml").display().to_string();
    let out = folder.path().join("out").display().to_string();
    let arguments = ["raypencil", "validate", scene.as_str(), "-o", out.as_str()].map(Into::into);
    assert_eq!(raypencil_cli::main_with(arguments, &registry), ExitCode::from(1));
    let summary = std::fs::read(folder.path().join("out/summary.json")).expect("a summary of what failed");
    let summary: serde_json::Value = serde_json::from_slice(&summary).expect("JSON");
    assert!(summary["defects"].as_u64() > Some(100), "{summary:#}");
    // The same arguments with the correct renderers agree.
    let arguments = ["raypencil", "validate", scene.as_str(), "-o", out.as_str()].map(Into::into);
    assert_eq!(raypencil_cli::main_with(arguments, &raypencil::harness::contender), ExitCode::SUCCESS);
}

#[test]
fn a_defect_is_reduced_and_reproduced() {
    let folder = folder();
    let registry = |name: &str| {
        let contender = raypencil::harness::contender(name)?;
        Some(if name == "tracer" { Flipped { inner: contender.renderer }.into() } else { contender })
    };
    let [scene, out] = ["small.toml", "out"].map(|name| folder.path().join(name).display().to_string());
    let arguments = ["raypencil", "minimise", scene.as_str(), "-o", out.as_str()].map(Into::into);
    assert_eq!(raypencil_cli::main_with(arguments, &registry), ExitCode::SUCCESS);
    let smallest = folder.path().join("out/small-defect.toml");
    let validate = |registry: &raypencil_cli::Registry| {
        let [scene, out] = [&smallest, &folder.path().join("again")].map(|path| path.display().to_string());
        let arguments = ["raypencil", "validate", scene.as_str(), "-o", out.as_str()].map(Into::into);
        raypencil_cli::main_with(arguments, registry)
    };
    assert_eq!(validate(&registry), ExitCode::from(1));
    // One face suffices for this fault.
    let text = std::fs::read_to_string(folder.path().join("out/small-defect.md")).unwrap();
    assert!(text.contains("1 face of 224 is left."), "{text}");
    assert_eq!(validate(&raypencil::harness::contender), ExitCode::SUCCESS);
}

#[test]
fn json_of_a_reduced_scene_tells_the_faces_before_and_after() {
    let folder = folder();
    let thick = "minimise small.toml --thickness 300 --with scanline-paper,tracer --class approximation -o out --json";
    let output = raypencil(folder.path(), &thick.split(' ').collect::<Vec<_>>());
    let report: serde_json::Value = serde_json::from_str(&text(&output.stdout)).unwrap();
    assert_eq!(report["faces_before"], 224, "{report}");
    let left = report["faces_after"].as_u64().unwrap();
    assert!((1..224).contains(&left), "{report}");
    let words = std::fs::read_to_string(folder.path().join("out/small-approximation.md")).unwrap();
    assert!(words.contains(&format!("{left} face")), "{words}");
}

#[test]
fn a_renderer_is_not_compared_with_itself() {
    let folder = folder();
    for with in ["scanline,scanline", "scanline,tracer,scanline", "tracer,scanline,referee,tracer"] {
        let output = raypencil(folder.path(), &["validate", "small.toml", "--with", with, "-o", "out"]);
        assert_trouble(&output, &[with, "is named twice; expected different renderers"]);
    }
    assert!(!folder.path().join("out").exists());
}

#[test]
fn a_class_may_be_chosen_and_may_be_absent() {
    let folder = folder();
    // Sheets so thick that the paper's straight sides are visibly wrong.
    let thick =
        "minimise small.toml --thickness 300 --with scanline-paper,tracer --class approximation -o out";
    let output = raypencil(folder.path(), &thick.split(' ').collect::<Vec<_>>());
    let screen = text(&output.stdout);
    assert_eq!(output.status.code(), Some(0), "{screen}{}", text(&output.stderr));
    assert!(screen.contains("scanline-paper and tracer differ by an approximation of the paper"), "{screen}");
    for file in ["small-approximation.toml", "small-approximation.glb", "small-approximation.md"] {
        assert!(folder.path().join("out").join(file).is_file(), "{file} is missing");
    }
    let output = raypencil(folder.path(), &["minimise", "small.toml", "-o", "none"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(text(&output.stdout).contains("nothing to minimise"), "{}", text(&output.stdout));
    assert!(!folder.path().join("none").exists());
    let three = ["minimise", "small.toml", "--with", "scanline,tracer,referee"];
    assert_trouble(&raypencil(folder.path(), &three), &["scanline,tracer,referee", "expected two"]);
}
