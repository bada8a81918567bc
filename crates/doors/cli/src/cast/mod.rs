//! `raypencil cast`: any rays on any mesh, answered exactly.

mod compared;
mod ray_command;
mod scans;

use std::path::{Path, PathBuf};

use raypencil::cast::{
    Answers, BagForm, BeamReturns, CastPage, CastSource, DecidedCounts, PageScan, Questions, RayArray,
    SetOfScans, cast as answer, cast_warnings, counts_text, ray_json, ray_text, rays_from_bytes,
    write_answers, write_cast_page, write_scan_bag, write_set,
};
use raypencil::io::{
    FileError, FileFacts, FileFrame, FileUnits, Limits, LoadedRaySets, LoadedSweeps, OutputFolder, RayScene,
    begin_output_folder, bytes, file_warnings, hex_digits, load_ray_scene, read_ray_sets, read_sweeps,
    read_triangles, sha256,
};
use raypencil::survey::{Warning, WarningCode};
use raypencil::{CastRay, HeadSweep, NamedRaySet, Progress, Sides, Triangles};
use serde_json::{Value, json};

use crate::args::Cast;
use crate::console::{Spinner, say, warn};
use crate::file_frame::file_frame;
use crate::overwriting::output_folder;
use crate::{Outcome, Trouble, memory};
use compared::Compared;
use ray_command::ray_command;

/// Rays whose answers are printed one by one, at most, if they come from a file.
const MAX_PRINTED_RAYS: usize = 8;

/// Rays as they were given.
enum Rays {
    /// Rays of no set.
    Array(RayArray),
    /// The sets of a TOML file.
    Sets(Vec<NamedRaySet>),
    /// The same of heads whose scans are asked for, and whose rays are not made yet.
    Sweeps(Vec<HeadSweep>),
}

pub(crate) fn cast(command: &Cast, json: bool) -> Result<Outcome, Trouble> {
    let spinner = Spinner::new();
    spinner.stage(&format!("{}: loading", command.mesh.display()));
    let Given { mesh, origin, mesh_sha256, rays, from, rays_sha256, frame, facts } =
        given(command, &spinner)?;
    let questions = Questions { any: command.any, all: command.all, margins: command.margins };
    let source = CastSource {
        mesh: command.mesh.display().to_string(),
        mesh_sha256,
        rays: from,
        rays_sha256,
        frame,
        facts,
        origin,
        is_scene: is_toml(&command.mesh),
    };
    let mesh = &mesh;
    let of_scans: Vec<SetOfScans<'_>> = match &rays {
        Rays::Array(_) => Vec::new(),
        Rays::Sets(sets) => sets.iter().map(SetOfScans::Made).collect(),
        Rays::Sweeps(sweeps) => sweeps.iter().map(SetOfScans::Sweep).collect(),
    };
    let sequences = command.scans.unwrap_or(u64::MAX);
    let count = match &rays {
        Rays::Array(array) => array.rays.len(),
        // One after the other.
        _ => of_scans.iter().map(|set| set.rays_at_a_time(sequences)).max().unwrap_or(0),
    };
    if command.bag.is_some() && matches!(rays, Rays::Array(_)) {
        let text = "--bag is for sets of rays, which have times and poses; expected RAYS that end in .toml, or a scene";
        return Err(Trouble::Usage(text.into()));
    }
    if command.scans.is_some() && matches!(rays, Rays::Array(_)) {
        let text = "--scans is for the set of a spinning head; expected RAYS that end in .toml, or a scene";
        return Err(Trouble::Usage(text.into()));
    }
    memory::ask_cast(count, mesh.faces().len(), command.scans.is_some() && matches!(rays, Rays::Sets(_)))?;
    let folder = command.output.as_deref();
    let output = match folder {
        Some(folder) => {
            let rays = command.rays.as_deref();
            Some(output_folder(folder, "cast", &command.mesh.to_string_lossy(), rays.as_slice())?)
        }
        None => None,
    };
    if let (Some(sequences), Some(folder)) = (command.scans, folder) {
        let sets = (mesh, of_scans.as_slice());
        let outcome = scans::cast_scans(command, sets, sequences, folder, &source, (&spinner, json))?;
        output.map_or(Ok(()), OutputFolder::finish)?;
        return Ok(outcome);
    }
    let results = match &rays {
        Rays::Array(array) => {
            let sides = if command.fronts_only { Sides::Fronts } else { Sides::Both };
            let answers = answer(mesh, &array.rays, sides, questions, &spinner);
            let compared = Compared::of(command, mesh, &array.rays, sides, &spinner);
            let mut warnings = cast_warnings((mesh, source.home()), &array.rays, sides, None, &answers);
            if !command.ray.is_empty() {
                // A miss is the answer to a question.
                warnings.retain(|warning| warning.code != WarningCode::NoHits);
            }
            spinner.stage("writing");
            if let Some(folder) = folder {
                let set = None;
                write_page(
                    folder,
                    command,
                    &source,
                    (mesh, &array.rays, &array.shape, set),
                    sides,
                    &answers,
                    &compared,
                )?;
            }
            let written = folder.map(|folder| write_answers(folder, &answers, (mesh, array, sides), &source));
            vec![Answered {
                set: None,
                rays: &array.rays,
                shape: &array.shape,
                answers,
                returns: None,
                compared,
                warnings,
                summary: written.transpose()?,
            }]
        }
        Rays::Sets(sets) => {
            let mut results = Vec::new();
            let pcd = command.pcd.unwrap_or_default();
            for set in sets {
                let sides = if command.fronts_only { Sides::Fronts } else { set.set.sides() };
                let answers = answer(mesh, set.set.rays(), sides, questions, &spinner);
                let compared = Compared::of(command, mesh, set.set.rays(), sides, &spinner);
                let warnings =
                    cast_warnings((mesh, source.home()), set.set.rays(), sides, Some(set), &answers);
                let returns = BeamReturns::of(&answers, set);
                spinner.stage(&format!("{}: writing", set.name));
                // One set is written as rays of no set are; of several each has a folder of its own.
                let folder: Option<PathBuf> =
                    folder.map(|folder| if sets.len() == 1 { folder.into() } else { folder.join(&set.name) });
                if let Some(folder) = &folder {
                    let of_set = (mesh, set.set.rays(), set.shape.as_slice(), Some(set));
                    write_page(folder, command, &source, of_set, sides, &answers, &compared)?;
                    if let Some(fields) = command.bag {
                        let form = BagForm { fields, is_dense: command.bag_dense };
                        write_scan_bag(&folder.join("rosbag"), &answers, set, form, source.origin)?;
                    }
                }
                let written =
                    folder.map(|folder| write_set(&folder, &answers, (mesh, set, sides), &source, pcd));
                let summary = written.transpose()?;
                results.push(Answered {
                    set: Some(&set.name),
                    rays: set.set.rays(),
                    shape: &set.shape,
                    answers,
                    returns,
                    compared,
                    warnings,
                    summary,
                });
            }
            results
        }
        // Their scans are written above.
        Rays::Sweeps(_) => Vec::new(),
    };
    output.map_or(Ok(()), OutputFolder::finish)?;
    drop(spinner);
    let is_each_right = results
        .iter()
        .flat_map(|result| &result.compared)
        .all(|compared| compared.passes(command.allow_empty));
    // Rays of the command line are questions, one by one; a miss is their answer.
    let misses = |result: &Answered| result.answers.misses() == result.rays.len();
    let is_empty = command.ray.is_empty() && results.iter().all(misses) && !command.allow_empty;
    let outcome = if is_each_right && !is_empty { Outcome::Fine } else { Outcome::Differs };
    let of_file = file_warnings(&source.facts);
    let printed = if command.ray.is_empty() { MAX_PRINTED_RAYS } else { usize::MAX };
    if json {
        let documents: Vec<Value> = results.iter().map(|result| result.json(printed)).collect();
        let mut document = match (&rays, documents.as_slice()) {
            (Rays::Array(_), [document]) => document.clone(),
            _ => json!({ "sets": documents }),
        };
        document["mesh"] = json!({
            "up": source.frame.up.map(|up| up.word()),
            "scale": source.frame.scale,
                "units": source.facts.units.as_ref().map(FileUnits::to_json),
            "polygons": source.facts.polygons,
            "warnings": of_file,
        });
        say(&format!("{document:#}\n"));
        return Ok(outcome);
    }
    warn(&of_file);
    results.iter().for_each(|result| warn(&result.warnings));
    let mut text = format!("{}: {}\n", command.mesh.display(), mesh_text(mesh, &source));
    for result in &results {
        text += &result.text(printed);
    }
    say(&text);
    Ok(outcome)
}

/// Writes what a folder of answers has beside them: the page, and the arrays of a comparison.
fn write_page(
    folder: &Path,
    command: &Cast,
    source: &CastSource,
    (mesh, rays, shape, set): (&Triangles, &[CastRay], &[u64], Option<&NamedRaySet>),
    sides: Sides,
    answers: &Answers,
    compared: &Option<Compared<'_>>,
) -> Result<(), Trouble> {
    // The mark of an earlier run goes first: it says that its page and its answers are all there.
    begin_output_folder(folder, "summary.json")?;
    if let Some(compared) = compared {
        compared.write(folder, shape)?;
    }
    let of_rays = match set {
        Some(set) => format!("{} of {}", set.name, source.rays),
        None if command.rays.is_none() => "rays of the command line".to_string(),
        None => source.rays.clone(),
    };
    let title = format!("{of_rays} on {}", source.mesh);
    let sides = if sides == Sides::Fronts { "fronts only" } else { "both" };
    let facts = [
        ("mesh", source.mesh.clone()),
        ("rays", of_rays.clone()),
        ("sides of faces that are hit", sides.into()),
    ];
    let ray_command = |index: usize| ray_command(command, &rays[index]);
    let compared = compared.as_ref().map(|compared| compared.hits(&ray_command));
    let scan = set.map(PageScan::of);
    let mesh = Some(mesh);
    let page = CastPage {
        title: &title,
        facts: &facts,
        shape,
        rays,
        answers,
        mesh,
        set,
        scan,
        has_arrays: true,
        compared,
    };
    write_cast_page(folder, &page)?;
    Ok(())
}

/// The answers to an array or to a set of rays.
struct Answered<'a> {
    set: Option<&'a str>,
    rays: &'a [CastRay],
    shape: &'a [u64],
    answers: Answers,
    returns: Option<BeamReturns>,
    compared: Option<Compared<'a>>,
    warnings: Vec<Warning>,
    summary: Option<PathBuf>,
}

impl Answered<'_> {
    /// Each ray, if there are at most `printed`.
    fn json(&self, printed: usize) -> Value {
        let (hits, ties) = self.answers.counts();
        let rays = self.rays.len();
        let each = (rays <= printed).then(|| {
            self.rays.iter().enumerate().map(|(k, ray)| ray_json(ray, &self.answers, k)).collect::<Vec<_>>()
        });
        let (too_near, misses) = (self.answers.too_near(), self.answers.misses());
        let counts =
            json!({ "rays": rays, "hits": hits, "tooNear": too_near, "misses": misses, "ties": ties });
        let summary = self.summary.as_ref().map(|path| path.display().to_string());
        let mut document =
            json!({ "counts": counts, "rays": each, "warnings": self.warnings, "summary": summary });
        if let Some(DecidedCounts { filter, intervals, exact }) = self.answers.decided {
            document["decided"] = json!({ "filter": filter, "intervals": intervals, "exact": exact });
        }
        if let Some(name) = self.set {
            document["name"] = json!(name);
        }
        if let Some(returns) = &self.returns {
            document["returns"] = returns.json();
        }
        if let Some(compared) = &self.compared {
            document["compared"] = compared.json();
        }
        document
    }

    /// Each ray, if there are at most `printed`, then the counts.
    fn text(&self, printed: usize) -> String {
        let mut text = String::new();
        if self.rays.len() <= printed {
            for (k, ray) in self.rays.iter().enumerate() {
                text += &ray_text(ray, &self.answers, k);
            }
        }
        let name = self.set.map(|name| format!("{name}: ")).unwrap_or_default();
        text += &format!("{name}{}\n", counts_text(&self.answers));
        if let Some(returns) = &self.returns {
            text += &format!("{name}{}\n", returns.text());
        }
        if let Some(compared) = &self.compared {
            text += &format!("\n{}", compared.text(self.rays));
        }
        if let Some(summary) = &self.summary {
            let more = match (self.set, self.answers.counts()) {
                (None, _) => ", report.html",
                (Some(_), (0, _)) => ", report.html and point clouds",
                (Some(_), _) => ", report.html, point clouds and pictures",
            };
            text += &format!(
                "\n{}\n  beside it: an array for each value, of shape {:?}{more}\n",
                summary.display(),
                self.shape
            );
        }
        text
    }
}

/// Mesh and rays, and where they come from.
struct Given {
    mesh: Triangles,
    /// Where the origin of the mesh's frame lies in its map.
    origin: [f64; 3],
    mesh_sha256: Vec<String>,
    rays: Rays,
    /// The rays' file, or what else they come from.
    from: String,
    rays_sha256: Option<String>,
    /// The axes and the unit that the options give for the mesh's file.
    frame: FileFrame,
    facts: FileFacts,
}

fn given(command: &Cast, spinner: &Spinner) -> Result<Given, Trouble> {
    let name = command.mesh.display().to_string();
    let has_rays = command.rays.is_some() || !command.ray.is_empty();
    let frame = file_frame(command.up, command.scale)?;
    let (mesh, origin, digests, facts) = match is_toml(&command.mesh) {
        true if frame != FileFrame::default() => {
            let text = "--up and --scale are for a mesh; a scene file has them in [terrain] (--set terrain.scale=0.001)";
            return Err(Trouble::Usage(format!("{name}: {text}")));
        }
        true => {
            let RayScene { triangles, origin, sets, terrain_digests, file_facts, sha256 } =
                load_ray_scene(&command.mesh, &command.set)?;
            if !has_rays {
                let mesh_sha256 = terrain_digests.iter().map(hex_digits).collect();
                let (rays, rays_sha256) = (Rays::Sets(sets), Some(sha256));
                return Ok(Given {
                    mesh: triangles,
                    origin,
                    mesh_sha256,
                    rays,
                    from: name,
                    rays_sha256,
                    frame,
                    facts: file_facts,
                });
            }
            (triangles, origin, terrain_digests, file_facts)
        }
        false if !command.set.is_empty() => {
            let text = "--set changes a scene file; expected a MESH that ends in .toml, or no --set";
            return Err(Trouble::Usage(format!("{name}: {text}")));
        }
        false if !has_rays => {
            let text = "no rays are given; expected RAYS, --ray, or a scene file with tables [[rays]]";
            return Err(Trouble::Usage(format!("{name}: {text}")));
        }
        false => {
            let read = read_triangles(&command.mesh)?;
            read.require_faces(&command.mesh)?;
            let too_large = |source| FileError::Scene { origin: name.clone(), source };
            let units = Some(FileUnits::Mesh { is_gltf: read.is_gltf, frame });
            let facts = FileFacts { units, polygons: read.polygon_facts };
            (frame.triangles(read.triangles).map_err(too_large)?, [0.0; 3], read.digests, facts)
        }
    };
    let mesh_sha256 = digests.iter().map(hex_digits).collect();
    let (rays, from, rays_sha256) = match &command.rays {
        None => {
            let rays = RayArray { shape: vec![command.ray.len() as u64], rays: command.ray.clone() };
            (Rays::Array(rays), "--ray".to_string(), None)
        }
        Some(path) => {
            spinner.stage(&format!("{}: reading", path.display()));
            let (rays, digest) = read(path, command.scans.is_some())?;
            (rays, path.display().to_string(), Some(digest))
        }
    };
    Ok(Given { mesh, origin, mesh_sha256, rays, from, rays_sha256, frame, facts })
}

fn is_toml(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml"))
}

/// The rays of a file, and their SHA-256 in hexadecimal: the sets of a `.toml`, else an array.
fn read(path: &Path, in_scans: bool) -> Result<(Rays, String), Trouble> {
    if is_toml(path) && in_scans {
        let LoadedSweeps { sweeps, sha256 } = read_sweeps(path)?;
        return Ok((Rays::Sweeps(sweeps), sha256));
    }
    if is_toml(path) {
        let LoadedRaySets { sets, sha256 } = read_ray_sets(path)?;
        return Ok((Rays::Sets(sets), sha256));
    }
    let bytes = read_bytes(path)?;
    Ok((Rays::Array(rays_from_bytes(&bytes, path)?), hex_digits(&sha256(&bytes))))
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

fn mesh_text(mesh: &Triangles, source: &CastSource) -> String {
    let of_zero_area = match mesh.zero_area_faces() {
        0 => String::new(),
        count => format!(", {count} of them without an area in double precision"),
    };
    let Some([low, high]) = mesh.bounds() else { return "no vertices".into() };
    let size = high - low;
    let of_origin = match source.origin {
        [0.0, 0.0, 0.0] => String::new(),
        [x, y, z] => format!("; its origin at ({x}, {y}, {z}) of the map, and rays in its frame"),
    };
    let of_polygons = match source.facts.polygons.words() {
        words if words.is_empty() => words,
        words => format!("; {words}"),
    };
    format!(
        "{} vertices, {} faces{of_zero_area}; {} x {} x {} wide{of_origin}{of_polygons}",
        mesh.vertices().len(),
        mesh.faces().len(),
        size.x,
        size.y,
        size.z
    )
}
