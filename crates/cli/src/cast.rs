//! `raypencil cast`: any rays on any mesh, answered exactly.

use std::path::Path;

use raypencil::cast::{
    CastSource, Comparison, Questions, RayArray, Stated, cast as answer, compare, comparison_json,
    comparison_text, counts_text, ray_json, ray_text, rays_from_bytes, write_answers, write_comparison,
};
use raypencil::io::{FileError, Limits, bytes, create_folder, hex_digits, quoted, read_triangles, sha256};
use raypencil::{CastRay, Precision, Progress, Sides, Triangles};
use serde_json::json;

use crate::args::Cast;
use crate::console::{Spinner, say};
use crate::{Outcome, Trouble};

/// Rays whose answers are printed one by one, at most, if they come from a file.
const MAX_PRINTED_RAYS: usize = 8;

pub(crate) fn cast(command: &Cast, json: bool) -> Result<Outcome, Trouble> {
    let spinner = Spinner::new();
    spinner.stage(&format!("{}: loading", command.mesh.display()));
    let mesh = read_triangles(&command.mesh)?;
    let (rays, given, digest) = match &command.rays {
        None => {
            let rays = RayArray { shape: vec![command.ray.len() as u64], rays: command.ray.clone() };
            (rays, "--ray".to_string(), None)
        }
        Some(path) => {
            spinner.stage(&format!("{}: reading", path.display()));
            let bytes = read_bytes(path)?;
            (rays_from_bytes(&bytes, path)?, path.display().to_string(), Some(hex_digits(&sha256(&bytes))))
        }
    };
    let sides = if command.fronts_only { Sides::Fronts } else { Sides::Both };
    let questions = Questions { any: command.any, all: command.all, margins: command.margins };
    let answers = answer(&mesh.triangles, &rays.rays, sides, questions, &spinner);
    let with = command.with.as_deref();
    let compared = with.map(|name| with_tracer(name, &mesh.triangles, &rays.rays, sides, &spinner));
    let mut written = None;
    if let Some(folder) = &command.output {
        spinner.stage("writing");
        let source = CastSource {
            mesh: command.mesh.display().to_string(),
            mesh_sha256: mesh.digests.iter().map(hex_digits).collect(),
            rays: given,
            rays_sha256: digest,
        };
        if let Some(Compared { name, stated, comparison }) = &compared {
            create_folder(folder)?;
            write_comparison(folder, name, &rays.shape, stated, comparison)?;
        }
        written = Some(write_answers(folder, &answers, (&mesh.triangles, &rays, sides), &source)?);
    }
    drop(spinner);
    let printed = if command.rays.is_none() { rays.rays.len() } else { MAX_PRINTED_RAYS };
    let is_each_printed = rays.rays.len() <= printed;
    if json {
        let each = is_each_printed.then(|| {
            rays.rays.iter().enumerate().map(|(k, ray)| ray_json(ray, &answers, k)).collect::<Vec<_>>()
        });
        let (hits, ties) = answers.counts();
        let counts =
            json!({ "rays": rays.rays.len(), "hits": hits, "misses": rays.rays.len() - hits, "ties": ties });
        let summary = written.map(|path| path.display().to_string());
        let mut document = json!({ "counts": counts, "rays": each, "summary": summary });
        if let Some(compared) = &compared {
            document["compared"] = comparison_json(compared.name, &compared.comparison);
        }
        say(&format!("{document:#}\n"));
        return Ok(outcome(compared.as_ref()));
    }
    let mut text = format!("{}: {}\n", command.mesh.display(), mesh_text(&mesh.triangles));
    if is_each_printed {
        for (k, ray) in rays.rays.iter().enumerate() {
            text += &ray_text(ray, &answers, k);
        }
    }
    text += &format!("{}\n", counts_text(&answers));
    if let Some(Compared { name, comparison, .. }) = &compared {
        let command = |index: usize| ray_command(command, &rays.rays[index]);
        text += &format!("\n{}", comparison_text(name, comparison, command));
    }
    if let Some(summary) = written {
        text += &format!(
            "\n{}\n  beside it: an array for each value, of shape {:?}\n",
            summary.display(),
            rays.shape
        );
    }
    say(&text);
    Ok(outcome(compared.as_ref()))
}

/// A renderer's first hits, and what became of them.
struct Compared<'a> {
    name: &'a str,
    stated: Stated,
    comparison: Comparison,
}

fn with_tracer<'a>(
    name: &'a str,
    mesh: &Triangles,
    rays: &[CastRay],
    sides: Sides,
    progress: &dyn Progress,
) -> Compared<'a> {
    progress.stage(&format!("{name}: tracing {} rays", rays.len()));
    let stated = Stated::by_tracer(mesh, rays, sides);
    let comparison = compare(mesh, rays, sides, &stated, Precision::F64, progress);
    Compared { name, stated, comparison }
}

fn outcome(compared: Option<&Compared<'_>>) -> Outcome {
    match compared {
        Some(compared) if !compared.comparison.passes() => Outcome::Differs,
        _ => Outcome::Fine,
    }
}

/// The command that shows everything about a ray.
fn ray_command(command: &Cast, ray: &CastRay) -> String {
    let [ox, oy, oz] = ray.origin.to_array();
    let [dx, dy, dz] = ray.direction.to_array();
    let mut numbers = format!("{ox},{oy},{oz},{dx},{dy},{dz}");
    if ray.t_min > 0.0 || ray.t_max < f64::INFINITY {
        numbers += &format!(",{},{}", ray.t_min, ray.t_max);
    }
    let fronts = if command.fronts_only { " --fronts-only" } else { "" };
    format!(
        "raypencil cast {} --ray={numbers}{fronts} --all --margins",
        quoted(&command.mesh.display().to_string())
    )
}

/// The bytes of a file, or of standard input.
fn read_bytes(path: &Path) -> Result<Vec<u8>, FileError> {
    // The header of an NPY file comes on top of its numbers, at most 2^16 bytes.
    let most = Limits::default().bytes + (1 << 16);
    let read = if path == Path::new("-") {
        bytes::read_stream(std::io::stdin().lock(), most)
    } else {
        bytes::read_file(path, most)
    };
    read.map_err(|error| FileError::io(path, "read", error))
}

fn mesh_text(mesh: &Triangles) -> String {
    let of_zero_area = match mesh.zero_area_faces() {
        0 => String::new(),
        count => format!(", {count} of them without an area"),
    };
    let Some([low, high]) = mesh.bounds() else { return "no vertices".into() };
    let size = high - low;
    format!(
        "{} vertices, {} faces{of_zero_area}; {} x {} x {} wide",
        mesh.vertices().len(),
        mesh.faces().len(),
        size.x,
        size.y,
        size.z
    )
}
