//! `raypencil terrain generate`: generates a Mars-like terrain as GLB.

use std::path::Path;

use raypencil::io::{FileError, read_dem, write_terrain_glb};
use raypencil::report::counted;
use raypencil::terrain::{Ground, MarsGround, PRESET_NAMES};
use raypencil::{Mesh, Progress as _, SceneError};
use serde_json::{Value, json};

use crate::args::TerrainGenerate;
use crate::console::{Spinner, say};
use crate::terrain::output::{check_output, create_folder};
use crate::{Outcome, Trouble};

pub(crate) fn generate(command: &TerrainGenerate, json: bool) -> Result<Outcome, Trouble> {
    check_output(&command.output)?;
    let spinner = Spinner::new();
    let mut ground = MarsGround::preset(&command.preset, command.seed).ok_or_else(|| {
        let known = PRESET_NAMES.join(", ");
        Trouble::Usage(format!(
            "--preset {}: there is no such preset; expected one of {known}",
            command.preset
        ))
    })?;
    let given = [
        (command.extent, &mut ground.extent),
        (command.post_spacing, &mut ground.post_spacing),
        (command.fine_radius, &mut ground.fine_radius),
        (command.rock_coverage, &mut ground.rocks.coverage),
        (command.rock_smallest, &mut ground.rocks.smallest),
    ];
    for (value, slot) in given {
        *slot = value.unwrap_or(*slot);
    }
    ground.crevasses.count = command.crevasses.unwrap_or(ground.crevasses.count);
    if let Some(coarse) = &command.coarse {
        spinner.stage(&format!("{}: reading", coarse.display()));
        let posts = read_dem(coarse, command.window)?.posts;
        ask_known(coarse, &posts.heights)?;
        ground.coarse = Some(posts);
    }
    spinner.stage(&format!("{}, seed {}: making faces", command.preset, command.seed));
    let origin = || format!("terrain generate --preset {}", command.preset);
    let is_whole = command.coarse.is_some() && command.window.is_none();
    let unfit = |mut source: SceneError| {
        // A model of kilometres with posts of centimetres has too many faces: a part of it is what a rover drives over.
        if is_whole && source.expected.contains("faces in all") {
            source.expected +=
                "; --window X,Y,WIDTH,HEIGHT takes a part of the model, --post-spacing wider posts";
        }
        FileError::Scene { origin: origin(), source }
    };
    let mesh = ground.build().and_then(Ground::into_mesh).map_err(unfit)?;
    spinner.stage(&format!("{}: writing", command.output.display()));
    create_folder(&command.output)?;
    write_terrain_glb(&command.output, &mesh, &parameters(command, &ground))?;
    drop(spinner);
    let report = report(command, &ground, &mesh);
    say(&if json { format!("{report:#}\n") } else { screen(&report) });
    Ok(Outcome::Fine)
}

/// Refuses a coarse model with unknown heights: relief is made between its posts, and nothing fills a gap.
fn ask_known(file: &Path, heights: &[f64]) -> Result<(), Trouble> {
    match heights.iter().filter(|height| height.is_nan()).count() as u64 {
        0 => Ok(()),
        unknown => Err(Trouble::Usage(format!(
            "--coarse {}: {} unknown; expected a height at each: --window X,Y,WIDTH,HEIGHT takes a part without gaps, and a program for \
             maps (gdal_fillnodata) fills them",
            file.display(),
            counted(unknown, "of its posts is", "of its posts are")
        ))),
    }
}

/// The parameters of the ground, for the extras of its file and for the report.
fn parameters(command: &TerrainGenerate, ground: &MarsGround) -> Value {
    let MarsGround { roughness, rocks, craters, crevasses, .. } = ground;
    let coarse = command.coarse.as_ref().and_then(|coarse| coarse.file_name());
    json!({
        "preset": command.preset,
        "seed": ground.seed,
        "extent_m": ground.coarse.is_none().then_some(ground.extent),
        "post_spacing_m": ground.post_spacing,
        "fine_radius_m": ground.fine_radius,
        "coarse": coarse.map(|name| name.to_string_lossy()),
        "hurst": roughness.hurst,
        "roughness_m": roughness.rms_at_1_m,
        "octave_gains": roughness.octave_gains,
        "rock_coverage": rocks.coverage,
        "rock_smallest_m": rocks.smallest,
        "rock_largest_m": rocks.largest,
        "crater_density": craters.density,
        "crater_smallest_m": craters.smallest,
        "crater_largest_m": craters.largest,
        "crevasses": crevasses.count,
        "crevasse_width_m": crevasses.width,
        "crevasse_depth_m": crevasses.depth,
        "crevasse_overhang_m": crevasses.overhang,
    })
}

/// The report for programs, from which that for people is made.
fn report(command: &TerrainGenerate, ground: &MarsGround, mesh: &Mesh) -> Value {
    let bounds = mesh.bounds().map(|bounds| bounds.map(|corner| (corner + mesh.origin()).to_array()));
    let along = |axis: usize| bounds.map(|[low, high]| [low[axis], high[axis]]);
    let diameters = ground.rock_diameters();
    // Area of all rocks of the square, including the parts of rocks beyond its border.
    let covered: f64 = diameters.iter().map(|d| std::f64::consts::FRAC_PI_4 * d * d).sum();
    let extents = ground.extents();
    json!({
        "terrain": command.output.display().to_string(),
        "parameters": parameters(command, ground),
        "x_m": along(0),
        "y_m": along(1),
        "z_m": along(2),
        "rocks": diameters.len(),
        "largest_rock_m": diameters.first(),
        "rocks_cover": covered / (extents.x * extents.y),
        "rocks_cover_by_the_law": ground.rocks.cumulative_area(ground.rocks.smallest),
        "craters": ground.crater_list().len(),
        "vertices": mesh.vertices().len(),
        "faces": mesh.faces().len(),
        "scene_origin_m": mesh.origin().to_array(),
    })
}

fn screen(report: &Value) -> String {
    let number = |pointer: &str| report.pointer(pointer).and_then(Value::as_f64).unwrap_or(f64::NAN);
    let whole = |pointer: &str| report.pointer(pointer).map_or(String::new(), Value::to_string);
    let extent = |axis: &str| {
        format!("{axis} {:.3} to {:.3}", number(&format!("/{axis}_m/0")), number(&format!("/{axis}_m/1")))
    };
    let rocks = match report["largest_rock_m"].as_f64() {
        None => "none".to_string(),
        Some(largest) => format!(
            "{}, {} to {largest:.2} m wide, on {:.4} of the ground (the law: {:.4})",
            whole("/rocks"),
            whole("/parameters/rock_smallest_m"),
            number("/rocks_cover"),
            number("/rocks_cover_by_the_law"),
        ),
    };
    let or_none = |count: String, rest: String| if count == "0" { "none".into() } else { count + &rest };
    let craters = format!(
        ", {} to {} m wide",
        whole("/parameters/crater_smallest_m"),
        whole("/parameters/crater_largest_m")
    );
    let crevasses = format!(
        ", {} m wide and {} m deep, overhang {} m",
        whole("/parameters/crevasse_width_m"),
        whole("/parameters/crevasse_depth_m"),
        whole("/parameters/crevasse_overhang_m"),
    );
    let lines = [
        ("extent", format!("{}, {} m", extent("x"), extent("y"))),
        ("heights", format!("{} m", extent("z"))),
        ("rocks", rocks),
        ("craters", or_none(whole("/craters"), craters)),
        ("crevasses", or_none(whole("/parameters/crevasses"), crevasses)),
        ("faces", whole("/faces")),
    ];
    let lines = lines.map(|(name, value)| format!("  {name:<14} {value}\n"));
    let title =
        |pointer: &str| report.pointer(pointer).and_then(Value::as_str).unwrap_or_default().to_string();
    let heading = format!("{}, seed {}", title("/parameters/preset"), whole("/parameters/seed"));
    format!("{heading}\n{}{}\n", lines.concat(), title("/terrain"))
}
