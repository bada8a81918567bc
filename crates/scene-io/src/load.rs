//! From a name or a path to a scene.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::digest::scene_sha256;
use crate::drive::camera_keys::KernelPart;
use crate::drive::camera_settings::BlurSettings;
use crate::drive::settings::DriveSettings;
use crate::parse::{self, Kind, Source};
use crate::plan::{DemPart, Plan, Terrain};
use crate::scene_error::SceneIoError;
use crate::{digest, plan};
use crate::{resolve, resolved};
use raypencil_files::{Limits, Sha256Digest, npy_from_bytes};
use raypencil_files::{bytes, combined_sha256_hex, sha256};
use raypencil_mesh_io::{DEFAULT_REFLECTIVITY, Vertices, dem, gltf};
use raypencil_scene::{Beam, FluxModel, Mesh, Pose, Scene, SceneError};
use raypencil_sensor::Kernel;
use raypencil_terrain::{BUILTIN_NAMES, MarsGround, RandomGround, builtin};

/// A scene file larger than this is none: 1 MiB.
pub const MAX_TOML_BYTES: u64 = 1 << 20;

/// A kernel is no larger: 1025 x 1025 real numbers of eight bytes, and a header.
const MOST_KERNEL_BYTES: u64 = 1025 * 1025 * 8 + (1 << 16);

/// Side of a plain generated ground, metres: the default sensors see 20 m, to every side.
const PLAIN_EXTENT: f64 = 40.0;

/// What a scene is made from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum SceneSource {
    /// A built-in ground, under the default rig.
    Builtin(String),
    /// A scene file.
    Toml(PathBuf),
    /// A terrain, under the default rig.
    Gltf(PathBuf),
    /// An elevation model, under the default rig.
    Dem(PathBuf),
}

impl SceneSource {
    /// Tells a built-in name, a `.toml`, a `.glb` or `.gltf` and a `.tif` or `.tiff` apart. A built-in name wins over a file.
    ///
    /// # Errors
    /// Lists the built-in names and the extensions if it is none of them, or if there is no such file.
    pub fn parse(source: &str) -> Result<Self, SceneIoError> {
        if BUILTIN_NAMES.contains(&source) {
            return Ok(Self::Builtin(source.to_string()));
        }
        let refuse = |problem: &str| SceneIoError::Source {
            given: source.to_string(),
            problem: problem.to_string(),
            expected: format!(
                "a built-in name ({}) or a file that ends in .toml, .glb, .gltf, .tif or .tiff",
                BUILTIN_NAMES.join(", ")
            ),
        };
        let path = PathBuf::from(source);
        if path.is_dir() {
            return Err(refuse("is a folder"));
        }
        let known = |end: &str| path.extension().is_some_and(|given| given.eq_ignore_ascii_case(end));
        let exists = path.exists();
        let kind: Option<fn(PathBuf) -> Self> = if known("toml") {
            Some(Self::Toml)
        } else if known("glb") || known("gltf") {
            Some(Self::Gltf)
        } else if known("tif") || known("tiff") {
            Some(Self::Dem)
        } else {
            None
        };
        match kind {
            Some(kind) if exists => Ok(kind(path)),
            Some(_) => Err(refuse("does not exist")),
            None if exists => Err(refuse("is a file of an unknown kind")),
            None => Err(refuse("is neither a built-in name nor a file")),
        }
    }
}

/// What the command line changes of a scene.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Overrides {
    /// The vehicle stands on the ground here, global frame, metres; also if the file gives a height.
    pub at: Option<[f64; 2]>,
    /// The vehicle's heading, degrees to the left of the global x axis.
    pub heading_deg: Option<f64>,
    /// The full fan angle of every beam, degrees.
    pub fan_deg: Option<f64>,
    /// The thickness T of every beam's sheet, millimetres.
    pub thickness_mm: Option<f64>,
    /// The equation of flux.
    pub flux_model: Option<FluxModel>,
}

/// A scene and where it came from.
#[derive(Debug, Clone)]
pub struct LoadedScene {
    /// The scene.
    pub scene: Scene,
    /// A short name, fit for a folder: letters, digits, `.`, `-` and `_`.
    pub name: String,
    /// SHA-256 of what defines the scene, in hexadecimal digits. Of a lone `.glb` it is the file's own; of
    /// several parts (scene file, terrain files, overrides) the SHA-256 of their digests one after the
    /// other. A built-in or generated ground takes part by its numbers, not by its name.
    pub source_sha256: String,
    /// SHA-256 of the resolved numbers, whatever they came from; see [`scene_sha256`].
    pub scene_sha256: String,
    /// The vehicle in the global frame: `global_from_vehicle`. A resolved scene has none: of it, this is the
    /// scene frame.
    pub vehicle: Pose,
    /// What it was made from.
    pub source: SceneSource,
    /// Where the vehicle drives, if a scene file says so.
    pub drive: Option<DriveSettings>,
}

/// Loads a scene from a built-in name, a scene `.toml`, a terrain `.glb` or `.gltf`, or an elevation model `.tif`
/// or `.tiff`.
///
/// A terrain alone, built-in or from a file, gets the default rig. On a terrain from a file the vehicle
/// stands level at the centre of the ground's bounding box; if there is no ground exactly there, on the
/// middle of the nearest face that looks up.
///
/// # Errors
/// Names the file, the place in it, what was found and what was expected.
pub fn load(source: &str, overrides: &Overrides) -> Result<LoadedScene, SceneIoError> {
    check(overrides)?;
    let source = SceneSource::parse(source)?;
    match &source {
        SceneSource::Builtin(name) => {
            let plan = plan::default_rig(Terrain::Builtin(name.clone()));
            finish(&source, plan, Vec::new(), None, overrides)
        }
        SceneSource::Gltf(path) => {
            let (mesh, parts) = gltf::read_mesh(path, DEFAULT_REFLECTIVITY, Vertices::Global)?;
            finish_alone(&source, Terrain::File(path.clone()), parts, mesh, overrides)
        }
        SceneSource::Dem(path) => {
            let (mesh, sha) = dem::read_mesh(path, None, None, DEFAULT_REFLECTIVITY)?;
            let terrain = Terrain::Dem(DemPart { file: path.clone(), window: None, max_error: None });
            finish_alone(&source, terrain, vec![sha], mesh, overrides)
        }
        SceneSource::Toml(path) => {
            let bytes =
                bytes::read_file(path, MAX_TOML_BYTES).map_err(|e| SceneIoError::io(path, "read", e))?;
            let text = String::from_utf8(bytes).map_err(|error| {
                let error = std::io::Error::new(std::io::ErrorKind::InvalidData, error.utf8_error());
                SceneIoError::io(path, "read", error)
            })?;
            load_toml(&source, path, &text, overrides)
        }
    }
}

/// Loads a scene from the text of a scene file that is in no file; `name` is for messages, and its path is that of
/// files that it refers to.
///
/// # Errors
/// As [`load`].
pub fn load_text(text: &str, name: &str) -> Result<LoadedScene, SceneIoError> {
    let path = PathBuf::from(format!("{name}.toml"));
    load_toml(&SceneSource::Toml(path.clone()), &path, text, &Overrides::default())
}

fn load_toml(
    source: &SceneSource,
    path: &Path,
    text: &str,
    overrides: &Overrides,
) -> Result<LoadedScene, SceneIoError> {
    let places = Source { file: path, text };
    let parts = vec![sha256(text.as_bytes())];
    match places.kind()? {
        Kind::Rig => load_rig(source, &places, parts, overrides),
        Kind::Resolved => load_resolved(source, &places, parts, overrides),
    }
}

fn load_rig(
    source: &SceneSource,
    places: &Source,
    mut parts: Vec<Sha256Digest>,
    overrides: &Overrides,
) -> Result<LoadedScene, SceneIoError> {
    let mut plan = parse::parse(places)?;
    for part in std::mem::take(&mut plan.kernels) {
        let (kernel, sha) = kernel_file(places, &part)?;
        parts.push(sha);
        let blurs = plan.drive.as_mut().and_then(|drive| drive.optics.blurs.as_mut());
        blurs.expect("a list that names the file").insert(part.blur, BlurSettings::Kernel(kernel));
    }
    let mesh = match &plan.terrain {
        Terrain::File(file) => {
            let terrain = terrain_file(places, "file", &["glb", "gltf"], file, &plan.terrain_span)?;
            let reflectivity = plan.reflectivity.unwrap_or(DEFAULT_REFLECTIVITY);
            let (mesh, more) = gltf::read_mesh(&terrain, reflectivity, Vertices::Global)?;
            parts.extend(more);
            Some(mesh)
        }
        Terrain::Dem(DemPart { file, window, max_error }) => {
            let terrain = terrain_file(places, "dem", &["tif", "tiff"], file, &plan.terrain_span)?;
            let reflectivity = plan.reflectivity.unwrap_or(DEFAULT_REFLECTIVITY);
            let (mesh, sha) = dem::read_mesh(&terrain, *window, *max_error, reflectivity)?;
            parts.push(sha);
            Some(mesh)
        }
        Terrain::Mars { ground, coarse: Some((file, span)) } => {
            let coarse = terrain_file(places, "generate.coarse", &["tif", "tiff"], file, span)?;
            let (posts, sha) = dem::read_posts(&coarse)?;
            parts.push(sha);
            let ground = MarsGround { coarse: Some(posts), ..(**ground).clone() };
            let unfit = |error: SceneError| {
                let SceneError { field, value, expected } = error;
                places.error(
                    span.clone(),
                    format!("`terrain.generate.{field}` is {value}; expected {expected}"),
                )
            };
            Some(mars_mesh(&ground, plan.reflectivity).map_err(unfit)?)
        }
        _ => None,
    };
    let position_span = plan.position_span.clone();
    finish(source, plan, parts, mesh, overrides).map_err(|error| match error {
        // A vehicle off the ground is a matter of a line in the file, unless the command line put it there.
        SceneIoError::NoGround { x, y, ground, .. } if overrides.at.is_none() => {
            let message = format!("`vehicle.position_m`: no ground under ({x}, {y}); expected a place within {ground}, or a height as the third number");
            places.error(position_span, message)
        }
        other => other,
    })
}

/// Where `terrain.file` or `terrain.dem` is, if it is a file of a kind that is known by its end.
fn terrain_file(
    places: &Source,
    key: &str,
    ends: &[&str; 2],
    file: &Path,
    span: &Range<usize>,
) -> Result<PathBuf, SceneIoError> {
    let terrain = places.file.parent().unwrap_or(Path::new("")).join(file);
    let known = |end: &&str| terrain.extension().is_some_and(|given| given.eq_ignore_ascii_case(end));
    if !ends.iter().any(known) {
        let [a, b] = ends;
        let message =
            format!("`terrain.{key}` is \"{}\"; expected a file that ends in .{a} or .{b}", file.display());
        return Err(places.error(span.clone(), message));
    }
    if !terrain.is_file() {
        let message = format!(
            "`terrain.{key}`: there is no file \"{}\"; expected a path relative to the scene file",
            terrain.display()
        );
        return Err(places.error(span.clone(), message));
    }
    Ok(terrain)
}

/// The kernel of a blur, from the file that a scene file names.
fn kernel_file(places: &Source, part: &KernelPart) -> Result<(Kernel, Sha256Digest), SceneIoError> {
    let file = places.file.parent().unwrap_or(Path::new("")).join(&part.file);
    let name = format!("drive.optics.blurs[{}].kernel", part.blur);
    if !file.is_file() {
        let message = format!(
            "`{name}`: there is no file \"{}\"; expected an NPY file, its path relative to the scene file",
            file.display()
        );
        return Err(places.error(part.span.clone(), message));
    }
    let bytes =
        bytes::read_file(&file, MOST_KERNEL_BYTES).map_err(|error| SceneIoError::io(&file, "read", error))?;
    let array = npy_from_bytes(&bytes, &file, &Limits { bytes: MOST_KERNEL_BYTES, ..Limits::default() })?;
    let [plane] = array.planes.as_slice() else {
        let message = format!(
            "`{name}` has {} numbers in each cell; expected rows and columns alone",
            array.planes.len()
        );
        return Err(places.error(part.span.clone(), message));
    };
    let (columns, rows) = plane.size();
    let weights: Vec<f64> = (0..columns as usize * rows as usize).map(|index| plane.real(index)).collect();
    let kernel = Kernel::from_weights(columns as usize, rows as usize, &weights).map_err(|error| {
        let SceneError { field, value, expected } = error;
        places.error(part.span.clone(), format!("`{name}`: {field} is {value}; expected {expected}"))
    })?;
    Ok((kernel, sha256(&bytes)))
}

/// A terrain without a scene file: the default rig stands in its middle.
fn finish_alone(
    source: &SceneSource,
    terrain: Terrain,
    parts: Vec<Sha256Digest>,
    mesh: Mesh,
    overrides: &Overrides,
) -> Result<LoadedScene, SceneIoError> {
    let mut plan = plan::default_rig(terrain);
    if overrides.at.is_none() {
        plan.vehicle.position = resolve::central_place(&mesh).unwrap_or_default();
    }
    finish(source, plan, parts, Some(mesh), overrides)
}

/// A scene whose numbers stand in the file as they are.
fn load_resolved(
    source: &SceneSource,
    places: &Source,
    mut parts: Vec<Sha256Digest>,
    overrides: &Overrides,
) -> Result<LoadedScene, SceneIoError> {
    let at = overrides.at.map(|[x, y]| ("at", format!("{x},{y}")));
    let heading = overrides.heading_deg.map(|heading| ("heading", heading.to_string()));
    if let Some((name, value)) = at.or(heading) {
        let expected = "none: a resolved scene has no vehicle to place, only sensors".to_string();
        return Err(SceneIoError::Override { name, value, expected });
    }
    let mut resolved = resolved::parse(places)?;
    let terrain = terrain_file(
        places,
        "file",
        &["glb", "gltf"],
        Path::new(resolved.file.get_ref()),
        &resolved.file.span(),
    )?;
    let vertices = Vertices::OffsetsFrom(resolved.origin);
    let (mesh, more) = gltf::read_mesh(&terrain, DEFAULT_REFLECTIVITY, vertices)?;
    parts.extend(more);
    resolved.beams.iter_mut().for_each(|beam| apply_to_beam(overrides, &mut beam.sensor));
    let flux_model = overrides.flux_model.unwrap_or(resolved.flux_model);
    // Nothing is lost by the copies: beams are few and small.
    let scene =
        Scene::new(Arc::new(mesh), resolved.camera, resolved.beams.clone(), resolved.atmosphere, flux_model)
            .map_err(|error| resolved.unfit(places, error))?;
    let vehicle = Pose::from_position(scene.mesh().origin());
    Ok(loaded(source, scene, vehicle, parts, overrides, None))
}

/// Resolves a plan: makes the ground if it is not loaded yet, stands the vehicle on it, mounts the sensors.
fn finish(
    source: &SceneSource,
    mut plan: Plan,
    mut parts: Vec<Sha256Digest>,
    mesh: Option<Mesh>,
    overrides: &Overrides,
) -> Result<LoadedScene, SceneIoError> {
    let origin = || match source {
        SceneSource::Builtin(name) => name.clone(),
        SceneSource::Toml(path) | SceneSource::Gltf(path) | SceneSource::Dem(path) => {
            path.display().to_string()
        }
    };
    let unfit = |source: SceneError| SceneIoError::scene(origin(), source);
    apply(overrides, &mut plan);
    let from_file = mesh.is_some();
    let mesh = match mesh {
        Some(mesh) => mesh,
        None => make(&plan).map_err(unfit)?,
    };
    let Some(vehicle) = plan.vehicle.global_from_vehicle(&mesh) else {
        let [x, y] = plan.vehicle.position;
        return Err(SceneIoError::NoGround { origin: origin(), x, y, ground: resolve::extent(&mesh) });
    };
    let scene = resolve::resolve(&plan, Arc::new(mesh), vehicle).map_err(unfit)?;
    // A ground that was made takes part in the digest by its numbers, which its name does not promise.
    match source {
        SceneSource::Builtin(_) => parts.push(digest::resolved(&scene)),
        _ if !from_file => parts.push(digest::mesh(scene.mesh())),
        _ => {}
    }
    Ok(loaded(source, scene, vehicle, parts, overrides, plan.drive))
}

/// Adds names and digests to a scene.
fn loaded(
    source: &SceneSource,
    scene: Scene,
    vehicle: Pose,
    mut parts: Vec<Sha256Digest>,
    overrides: &Overrides,
    drive: Option<DriveSettings>,
) -> LoadedScene {
    if *overrides != Overrides::default() && !matches!(source, SceneSource::Builtin(_)) {
        parts.push(sha256(format!("{overrides:?}").as_bytes()));
    }
    LoadedScene {
        name: folder_name(source),
        source_sha256: combined_sha256_hex(&parts),
        scene_sha256: scene_sha256(&scene),
        scene,
        vehicle,
        source: source.clone(),
        drive,
    }
}

/// Makes a ground that comes from no file.
fn make(plan: &Plan) -> Result<Mesh, SceneError> {
    match &plan.terrain {
        Terrain::Builtin(name) => builtin(name, plan.reflectivity.unwrap_or(DEFAULT_REFLECTIVITY))
            .ok_or_else(|| SceneError::new("terrain.builtin", name, BUILTIN_NAMES.join(", ")))?
            .into_mesh(),
        &Terrain::Generate { nasty, seed, faces, extent, offset } => {
            let mut random = match nasty {
                true => RandomGround::nasty(seed, faces),
                false => RandomGround::plain(seed, faces, extent.unwrap_or(PLAIN_EXTENT)),
            };
            random.offset = offset;
            random.extent = extent.unwrap_or(random.extent);
            let mut ground = random.build();
            // A reflectivity in the file is for the whole ground, else each kind keeps its own.
            if let Some(reflectivity) = plan.reflectivity {
                ground.materials.iter_mut().for_each(|kind| kind.reflectivity = reflectivity);
            }
            ground.into_mesh()
        }
        Terrain::Mars { ground, coarse: None } => mars_mesh(ground, plan.reflectivity),
        Terrain::Mars { coarse: Some((path, _)), .. } => {
            Err(SceneError::new("terrain.generate.coarse", path.display(), "posts that are loaded already"))
        }
        Terrain::File(path) | Terrain::Dem(DemPart { file: path, .. }) => {
            Err(SceneError::new("terrain.file", path.display(), "a terrain that is loaded already"))
        }
    }
}

/// The mesh of generated ground; a reflectivity in the file is for all of it.
fn mars_mesh(ground: &MarsGround, reflectivity: Option<f64>) -> Result<Mesh, SceneError> {
    let mut ground = ground.build()?;
    if let Some(reflectivity) = reflectivity {
        ground.materials.iter_mut().for_each(|kind| kind.reflectivity = reflectivity);
    }
    ground.into_mesh()
}

/// Refuses an override out of range.
fn check(overrides: &Overrides) -> Result<(), SceneIoError> {
    let [x, y] = overrides.at.map_or([None; 2], |at| at.map(Some));
    let all = [
        ("at x", x, parse::GLOBAL_M, "metres"),
        ("at y", y, parse::GLOBAL_M, "metres"),
        ("heading", overrides.heading_deg, parse::TURN_DEG, "degrees"),
        ("fan", overrides.fan_deg, parse::FAN_DEG, "degrees"),
        ("thickness", overrides.thickness_mm, parse::THICKNESS_MM, "millimetres"),
    ];
    for (name, value, range, unit) in all {
        if let Some(value) = value.filter(|value| !range.contains(value)) {
            let expected = format!("{} to {} {unit}", range.start(), range.end());
            return Err(SceneIoError::Override { name, value: value.to_string(), expected });
        }
    }
    Ok(())
}

/// Puts the overrides in place of what the file says.
fn apply(overrides: &Overrides, plan: &mut Plan) {
    if let Some(at) = overrides.at {
        plan.vehicle.position = at;
        plan.vehicle.height = None;
    }
    if let Some(heading_deg) = overrides.heading_deg {
        plan.vehicle.heading_deg = heading_deg;
    }
    plan.beams.iter_mut().for_each(|(_, beam)| apply_to_beam(overrides, beam));
    if let Some(flux_model) = overrides.flux_model {
        plan.flux_model = flux_model;
    }
}

/// Puts the overrides of beams in place of what the file says of one.
fn apply_to_beam(overrides: &Overrides, beam: &mut Beam) {
    if let Some(fan_deg) = overrides.fan_deg {
        beam.half_width = Beam::half_width_of(beam.grid_distance, fan_deg.to_radians());
    }
    if let Some(thickness_mm) = overrides.thickness_mm {
        beam.thickness = thickness_mm / 1e3;
    }
}

/// The source's own name as a folder name: other characters than letters, digits, `.`, `-` and `_` become
/// `-`; no leading dots, no longer than 64.
fn folder_name(source: &SceneSource) -> String {
    let stem = match source {
        SceneSource::Builtin(name) => name.clone(),
        SceneSource::Toml(path) | SceneSource::Gltf(path) | SceneSource::Dem(path) => {
            path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default()
        }
    };
    let plain = |c: char| if c.is_ascii_alphanumeric() || "._-".contains(c) { c } else { '-' };
    let name: String = stem.trim_start_matches('.').chars().map(plain).take(64).collect();
    if name.is_empty() { "scene".to_string() } else { name }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_fit_for_folders() {
        let name = |path: &str| folder_name(&SceneSource::Toml(path.into()));
        assert_eq!(name("a/b/My Scene (2).v1.toml"), "My-Scene--2-.v1");
        assert_eq!(name("..toml"), "scene");
        assert_eq!(name(&format!("{}.toml", "x".repeat(100))).len(), 64);
    }
}
