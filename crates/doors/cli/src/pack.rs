//! `raypencil pack`: writes the reference pack of a scene, or a blind one, which has no answers, or the input pack.

use std::path::{Path, PathBuf};

use raypencil::cast::{CastSource, RayArray, RayPackCounts, read_rays, write_ray_pack, write_scan_pack};
use raypencil::harness::{PackedRaySet, write_pack_with_ray_sets};
use raypencil::io::{
    FileError, FileFacts, FileFrame, FileUnits, LoadedRaySets, OutputFolder, file_sha256_hex, file_warnings,
    hex_digits, read_ray_sets, read_triangles,
};
use raypencil::pack::{
    MIN_RAYS_PER_CLAUSE, Manifest, PackLabel, benched, blind_subject, input_faces, write_input,
};
use raypencil::report::{count, counted};
use raypencil::survey::warnings;
use raypencil::{NamedRaySet, Progress as _, Sides};

use crate::args::Pack;
use crate::console::{Spinner, say, warn};
use crate::memory::Rates;
use crate::overwriting::{PackOf, ask_pack, ask_pack_inputs};
use crate::subject::subject;
use crate::{Outcome, Trouble, memory};

pub(crate) fn pack(command: &Pack, json: bool) -> Result<Outcome, Trouble> {
    let rays = command.rays.as_deref();
    ask_pack_inputs(
        &command.output,
        rays.is_some(),
        &[&[Path::new(&command.scene.scene)], rays.as_slice()].concat(),
    )?;
    // No list of files is left in a pack: its manifest is one.
    let output = OutputFolder::begin_any(&command.output)?;
    let outcome = packed_into(command, json)?;
    output.finish_unlisted()?;
    Ok(outcome)
}

fn packed_into(command: &Pack, json: bool) -> Result<Outcome, Trouble> {
    let folder = command.output.display().to_string();
    let label = PackLabel { version: command.pack_version.clone(), licence: command.licence.clone() };
    if command.input {
        ask_pack(&command.output, PackOf::Input)?;
        write_input(&command.output)?;
        say(&match json {
            true => format!("{:#}\n", serde_json::json!({ "pack": folder })),
            false => format!("{folder}: the input pack, {} faces\n", input_faces().len()),
        });
        return Ok(Outcome::Fine);
    }
    if let Some(rays) = &command.rays {
        return pack_rays(command, rays, json);
    }
    let spinner = Spinner::new();
    let (subject, warnings) = match command.blind {
        // This scene is ours: there is nobody to warn.
        Some(seed) => (blind_subject(seed)?, Vec::new()),
        None => {
            let subject = subject(&command.scene, "", &spinner)?;
            memory::ask(Rates::PACK, &subject.scene)?;
            spinner.stage("looking at the scene");
            let mut warned = subject.file_warnings();
            warned.extend(warnings(&subject.scene, subject.vehicle.as_ref(), None));
            let is_plain = command.no_bench;
            (if is_plain { subject } else { benched(subject)? }, warned)
        }
    };
    ask_pack(&command.output, PackOf::Scene(&subject.name, label.version.as_deref()))?;
    let (manifest, sets) =
        write_pack_with_ray_sets(&subject, command.blind, &label, &command.output, &spinner)?;
    drop(spinner);
    if json {
        let document = serde_json::json!({
            "pack": folder,
            "scene_sha256": manifest.scene.sha256,
            "clauses": manifest.clauses,
            "warnings": warnings,
            "ray_sets": sets.iter().map(set_json).collect::<Vec<_>>(),
        });
        say(&format!("{document:#}\n"));
    } else {
        warn(&warnings);
        let mut text = format!("{folder}: the pack of {}\n{}\n", subject.name, tested(&manifest));
        for PackedRaySet { name, counts } in &sets {
            text += &format!("rays {name}: {}", counts_text(counts));
        }
        say(&text);
    }
    Ok(Outcome::Fine)
}

/// Rays for a pack of their own.
struct Packed {
    /// Name of their set; `None`: they are of no set, or of the only one.
    name: Option<String>,
    rays: PackedRays,
    sides: Sides,
}

/// What is known of rays.
enum PackedRays {
    /// The rays alone.
    Array(RayArray),
    /// Those of a pattern, with its times and poses.
    Set(Box<NamedRaySet>),
}

impl PackedRays {
    fn len(&self) -> usize {
        match self {
            Self::Array(array) => array.rays.len(),
            Self::Set(set) => set.set.rays().len(),
        }
    }
}

/// The rays of a file, and its digest: those of each set of a `.toml`, else an array.
fn packed(rays: &Path) -> Result<(Vec<Packed>, String), Trouble> {
    if !rays.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml")) {
        // Rays that are too many are refused before gigabytes of them are read for a digest.
        let array = read_rays(rays)?;
        let (_, digest) = file_sha256_hex(rays).map_err(|error| FileError::io(rays, "read", error))?;
        return Ok((vec![Packed { name: None, rays: PackedRays::Array(array), sides: Sides::Both }], digest));
    }
    let LoadedRaySets { sets, sha256 } = read_ray_sets(rays)?;
    let is_one = sets.len() == 1;
    let of_set = |set: NamedRaySet| Packed {
        name: (!is_one).then(|| set.name.clone()),
        sides: set.set.sides(),
        rays: PackedRays::Set(Box::new(set)),
    };
    Ok((sets.into_iter().map(of_set).collect(), sha256))
}

/// A pack of rays on a mesh; of several sets of rays one each, in a folder of its name.
fn pack_rays(command: &Pack, rays: &Path, json: bool) -> Result<Outcome, Trouble> {
    let spinner = Spinner::new();
    let file = &command.scene.scene;
    spinner.stage(&format!("{file}: loading"));
    let mesh = read_triangles(file.as_ref())?;
    mesh.require_faces(file.as_ref())?;
    let (packed, digest) = packed(rays)?;
    let units = FileUnits::Mesh { is_gltf: mesh.is_gltf, frame: FileFrame::default() };
    let source = CastSource {
        mesh: file.clone(),
        mesh_sha256: mesh.digests.iter().map(hex_digits).collect(),
        rays: rays.display().to_string(),
        rays_sha256: Some(digest),
        facts: FileFacts { units: Some(units), polygons: mesh.polygon_facts },
        ..CastSource::default()
    };
    warn(&file_warnings(&source.facts));
    for one in &packed {
        let folder = one.name.as_ref().map_or(command.output.clone(), |name| command.output.join(name));
        ask_pack(&folder, PackOf::Mesh(file))?;
    }
    // One after the other.
    let most = packed.iter().map(|one| one.rays.len()).max().unwrap_or(0);
    memory::ask_cast(most, mesh.triangles.faces().len(), false)?;
    let mut packs = Vec::new();
    for Packed { name, rays, sides } in packed {
        let folder = name.map_or(command.output.clone(), |name| command.output.join(name));
        let sides = if command.fronts_only { Sides::Fronts } else { sides };
        let triangles = &mesh.triangles;
        let counts = match &rays {
            PackedRays::Array(array) => {
                write_ray_pack(&folder, (triangles, array, sides), &source, &spinner)?
            }
            PackedRays::Set(set) => write_scan_pack(&folder, (triangles, set, sides), &source, &spinner)?,
        };
        packs.push((folder, counts));
    }
    drop(spinner);
    let of_pack = |(folder, counts): &(PathBuf, RayPackCounts)| serde_json::json!({ "pack": folder.display().to_string(), "untested": counts.untested() });
    say(&match (json, packs.as_slice()) {
        (true, [one]) => format!("{:#}\n", of_pack(one)),
        (true, all) => {
            format!("{:#}\n", serde_json::json!({ "packs": all.iter().map(of_pack).collect::<Vec<_>>() }))
        }
        (false, all) => {
            let text = |(folder, counts): &(PathBuf, RayPackCounts)| {
                format!("{}: the pack of {}", folder.display(), counts_text(counts))
            };
            all.iter().map(text).collect()
        }
    });
    Ok(Outcome::Fine)
}

/// What a pack of rays tests, in two lines.
fn counts_text(counts: &RayPackCounts) -> String {
    let untested = counts.untested();
    let nothing = if untested.is_empty() { "nothing".to_string() } else { untested.join(", ") };
    let RayPackCounts { rays, hits, misses, ties, too_near, .. } = counts;
    let too_near = if *too_near == 0 { String::new() } else { format!(", {} too near", count(*too_near)) };
    format!(
        "{}; {} hit, {} of them at a tie{too_near}, {} miss\n\
         Not tested by any of its rays: {nothing}.\n",
        counted(*rays, "ray", "rays"),
        count(*hits),
        count(*ties),
        count(*misses)
    )
}

/// The same for programs, of a set in a pack of a scene.
fn set_json(PackedRaySet { name, counts }: &PackedRaySet) -> serde_json::Value {
    serde_json::json!({
        "name": name, "rays": counts.rays, "hits": counts.hits, "too_near": counts.too_near, "untested": counts.untested(),
    })
}

/// Which clauses of the contract the pack tests, in a sentence.
fn tested(manifest: &Manifest) -> String {
    if manifest.clauses.is_empty() {
        return "The scene is too large to count which clauses of the contract its rays decide.".into();
    }
    let (tested, untested): (Vec<_>, Vec<_>) =
        manifest.clauses.iter().partition(|one| one.rays >= MIN_RAYS_PER_CLAUSE);
    let all = manifest.clauses.len();
    let said = format!(
        "{} of {all} clauses of the contract decide {MIN_RAYS_PER_CLAUSE} or more of its rays each",
        tested.len()
    );
    if untested.is_empty() {
        return said + ".";
    }
    let names: Vec<String> = untested.iter().map(|one| format!("{} ({})", one.clause, one.rays)).collect();
    format!("{said}; fewer: {}.", names.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_counts_of_a_pack_of_rays_are_written_alike() {
        let counts = RayPackCounts {
            rays: 28_928,
            hits: 4_979,
            misses: 22_849,
            ties: 1_200,
            too_near: 1_100,
            ..RayPackCounts::default()
        };
        let expected = "28,928 rays; 4,979 hit, 1,200 of them at a tie, 1,100 too near, 22,849 miss\n";
        assert!(counts_text(&counts).starts_with(expected), "{}", counts_text(&counts));
    }
}
