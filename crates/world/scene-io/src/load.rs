//! From a built-in name or a file to a scene.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use raypencil_files::{Sha256Digest, bytes, combined_sha256_hex, sha256};
use raypencil_mesh_io::{
    DEFAULT_REFLECTIVITY, DemOptions, FileFacts, FileFrame, TerrainFile, Vertices, gltf, read_dem_terrain,
    read_terrain,
};
use raypencil_rover::Rig;
use raypencil_scene::{Pose, Scene, SceneError};
use raypencil_survey::Warning;

use crate::digest;
use crate::drive::setup::{DriveSetup, rig_of};
use crate::file_warnings::file_warnings;
use crate::ground::{make_ground, read_ground, terrain_file};
use crate::grounds::{Ground, Grounds};
use crate::overrides::Overrides;
use crate::parse::kind::Kind;
use crate::parse::scene::parse;
use crate::parse::source::Source;
use crate::plan::{DemPart, MeshPart, ScenePlan, Terrain, default_rig};
use crate::resolve::{central_place, extent, resolve};
use crate::resolved::read::parse_resolved;
use crate::scene_error::SceneIoError;
use crate::scene_source::SceneSource;
use crate::settings::{Setting, changed, text_of_ground};
use crate::subject::Subject;

/// Maximum size of a scene file, bytes: 1 MiB.
pub const MAX_TOML_BYTES: u64 = 1 << 20;

/// A scene and its origin.
#[derive(Debug, Clone)]
pub struct LoadedScene {
    /// The scene.
    pub scene: Scene,
    /// Short name, fit for a folder: letters, digits, `.`, `-` and `_`.
    pub name: String,
    /// SHA-256 of what defines the scene, in hexadecimal digits. For a lone `.glb` it is that of the file. For several
    /// parts (scene file, terrain files, overrides) it is the SHA-256 of their digests one after the other. A built-in
    /// or generated ground takes part by its numbers, not by its name.
    pub source_sha256: String,
    /// SHA-256 of the resolved numbers, wherever they come from; see [`scene_sha256`](crate::scene_sha256).
    pub scene_sha256: String,
    /// Pose of the vehicle, `global_from_vehicle`. A resolved scene has no vehicle: then this is the scene frame.
    pub vehicle: Pose,
    /// Whether there is a vehicle: not in a resolved scene.
    pub has_vehicle: bool,
    /// Source of the scene.
    pub source: SceneSource,
    /// Drive of the scene file, placed in the scene; `None`: the file has no `[drive]`.
    pub drive: Option<DriveSetup>,
    /// What was found out about the terrain's file.
    pub file_facts: FileFacts,
}

impl LoadedScene {
    /// Pose of the vehicle in the global frame, if there is one.
    pub fn standing_vehicle(&self) -> Option<Pose> {
        self.has_vehicle.then_some(self.vehicle)
    }

    /// What looks wrong in the files of the terrain.
    pub fn file_warnings(&self) -> Vec<Warning> {
        file_warnings(&self.file_facts)
    }

    /// The scene under test. `arguments` are words that give it again on a command line.
    pub fn into_subject(self, arguments: String) -> Subject {
        Subject {
            vehicle: self.standing_vehicle(),
            scene: self.scene,
            file_facts: self.file_facts,
            name: self.name,
            arguments,
            sha256: self.source_sha256,
        }
    }

    /// Camera and beams in the frame of the vehicle.
    pub fn rig(&self) -> Rig {
        rig_of(&self.scene, &self.vehicle)
    }
}

/// Loads a scene from a built-in name, a scene `.toml`, a terrain (`.glb`, `.gltf`, `.stl`, `.obj`, `.ply`), or an
/// elevation model `.tif` or `.tiff`.
///
/// A terrain alone, built-in or from a file, gets the default rig. On a terrain from a file the vehicle
/// stands level at the centre of the ground's bounding box; if there is no ground exactly there, on the
/// middle of the nearest face that is not too steep.
///
/// # Errors
/// Names the file, the place in it, the value found and the values expected.
///
/// ```
/// use raypencil_scene_io::{Overrides, load};
///
/// // The vehicle stands on the plane z = 0 of the pyramids, the default camera 1.5 m above it.
/// let loaded = load("pyramids", &Overrides::default())?;
/// assert_eq!(loaded.name, "pyramids");
/// assert_eq!(loaded.scene.camera().scene_from_sensor.position.z, 1.5);
/// // A file that is not there is named in the message.
/// let error = load("nowhere.toml", &Overrides::default()).unwrap_err();
/// assert!(error.to_string().starts_with("`nowhere.toml` does not exist; expected a built-in name"));
/// # Ok::<(), raypencil_scene_io::SceneIoError>(())
/// ```
pub fn load(source: &str, overrides: &Overrides) -> Result<LoadedScene, SceneIoError> {
    overrides.check()?;
    let source = SceneSource::parse(source)?;
    if !overrides.settings.is_empty() {
        return load_changed(&source, overrides, None);
    }
    match &source {
        SceneSource::Builtin(name) => {
            let plan = default_rig(Terrain::Builtin(name.clone()));
            let mesh = make_ground(&plan).map_err(|error| SceneIoError::scene(source.origin(), error))?;
            let ground = Ground { mesh: Arc::new(mesh), digests: None, facts: FileFacts::default() };
            finish(&source, plan, Vec::new(), ground, overrides)
        }
        SceneSource::Mesh(path) => {
            let frame = FileFrame::default();
            let read = read_terrain(path, DEFAULT_REFLECTIVITY, &frame)?;
            let terrain = Terrain::File(MeshPart { file: path.clone(), frame });
            finish_alone(&source, terrain, read, overrides)
        }
        SceneSource::Dem(path) => {
            let options = DemOptions::default();
            let read = read_dem_terrain(path, &options, None, DEFAULT_REFLECTIVITY)?;
            let terrain = Terrain::Dem(DemPart { file: path.clone(), options, max_error: None });
            finish_alone(&source, terrain, read, overrides)
        }
        SceneSource::Toml(path) => load_toml(&source, path, &read_toml(path)?, overrides, None),
    }
}

/// As [`load`], for one scene after the other: those on the same ground share it.
///
/// # Errors
/// As [`load`].
pub fn load_sharing(
    source: &str,
    overrides: &Overrides,
    grounds: &Grounds,
) -> Result<LoadedScene, SceneIoError> {
    overrides.check()?;
    load_changed(&SceneSource::parse(source)?, overrides, Some(grounds))
}

/// Whether the keys of a scene take these settings: the text is read and its numbers are checked. No ground is read or made, and
/// nothing is placed on it.
///
/// # Errors
/// As [`load`], for what the text alone decides.
///
/// ```
/// use raypencil_scene_io::{Setting, check_settings};
///
/// assert!(check_settings("pyramids", &[Setting::parse("camera.pitch_down_deg=25")?]).is_ok());
/// let error = check_settings("pyramids", &[Setting::parse("camera.pitch_down_deg=steep")?]).unwrap_err();
/// assert!(error.to_string().contains("camera.pitch_down_deg"), "{error}");
/// # Ok::<(), raypencil_scene_io::SceneIoError>(())
/// ```
pub fn check_settings(source: &str, settings: &[Setting]) -> Result<(), SceneIoError> {
    let source = SceneSource::parse(source)?;
    let (path, text) = text_of(&source)?;
    let changed = changed(&text, settings)?;
    let file = Source::changed(&path, &text, changed.as_ref());
    match file.kind()? {
        Kind::Rig => parse(&file).map(|_| ()),
        Kind::Resolved => parse_resolved(&file).map(|_| ()),
    }
}

/// The text of a scene, which a ground alone gets for the purpose, and the path that messages call it by.
pub(crate) fn text_of(source: &SceneSource) -> Result<(PathBuf, String), SceneIoError> {
    let beside = |path: &Path| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    Ok(match source {
        SceneSource::Toml(path) => (path.clone(), read_toml(path)?),
        SceneSource::Builtin(name) => (PathBuf::from(name), text_of_ground("builtin", name)),
        SceneSource::Mesh(path) => (path.clone(), text_of_ground("file", &beside(path))),
        SceneSource::Dem(path) => (path.clone(), text_of_ground("dem", &beside(path))),
    })
}

/// Loads a scene from a text, which a ground alone gets for the purpose, so that it can be changed.
fn load_changed(
    source: &SceneSource,
    overrides: &Overrides,
    grounds: Option<&Grounds>,
) -> Result<LoadedScene, SceneIoError> {
    let (path, text) = text_of(source)?;
    load_toml(source, &path, &text, overrides, grounds)
}

/// The text of a TOML file, at most [`MAX_TOML_BYTES`] long.
pub(crate) fn read_toml(path: &Path) -> Result<String, SceneIoError> {
    let refused = |error| SceneIoError::io(path, "read", error);
    let bytes = bytes::read_file(path, MAX_TOML_BYTES).map_err(refused)?;
    String::from_utf8(bytes)
        .map_err(|error| refused(std::io::Error::new(std::io::ErrorKind::InvalidData, error.utf8_error())))
}

/// Loads a scene from the text of a scene file. Messages call the file `<name>.toml`; paths in the text are relative to
/// that path.
///
/// # Errors
/// As [`load`].
///
/// ```
/// use raypencil_scene_io::load_text;
///
/// // All keys but the version have defaults. Millimetres are divided by 1000.
/// let scene = load_text("version = 1\n[camera]\nfocal_length_mm = 6\n", "short")?.scene;
/// assert_eq!((scene.camera().sensor.focal_length, scene.beams().len()), (0.006, 2));
/// // A message points to line 3, column 19.
/// let error = load_text("version = 1\n[camera]\nfocal_length_mm = -6\n", "short").unwrap_err();
/// let message = "short.toml:3:19: `camera.focal_length_mm` is -6; expected 0.01 to 100000 millimetres";
/// assert_eq!(error.to_string(), message);
/// # Ok::<(), raypencil_scene_io::SceneIoError>(())
/// ```
pub fn load_text(text: &str, name: &str) -> Result<LoadedScene, SceneIoError> {
    load_text_with(text, name, &Overrides::default())
}

/// As [`load_text`], with changes.
///
/// # Errors
/// As [`load`].
pub fn load_text_with(text: &str, name: &str, overrides: &Overrides) -> Result<LoadedScene, SceneIoError> {
    overrides.check()?;
    let path = PathBuf::from(format!("{name}.toml"));
    load_toml(&SceneSource::Toml(path.clone()), &path, text, overrides, None)
}

fn load_toml(
    source: &SceneSource,
    path: &Path,
    text: &str,
    overrides: &Overrides,
    grounds: Option<&Grounds>,
) -> Result<LoadedScene, SceneIoError> {
    let changed = match overrides.settings.as_slice() {
        [] => None,
        settings => changed(text, settings)?,
    };
    let file = Source::changed(path, text, changed.as_ref());
    // A built-in ground takes part by its numbers, wherever its settings stand.
    let parts = match source {
        SceneSource::Builtin(_) => Vec::new(),
        _ => vec![sha256(file.text.as_bytes())],
    };
    match file.kind()? {
        Kind::Rig => load_rig(source, &file, parts, overrides, grounds),
        Kind::Resolved => load_resolved(source, &file, parts, overrides),
    }
}

/// Loads a rig on a ground. `parts` are digests.
fn load_rig(
    source: &SceneSource,
    file: &Source,
    mut parts: Vec<Sha256Digest>,
    overrides: &Overrides,
    grounds: Option<&Grounds>,
) -> Result<LoadedScene, SceneIoError> {
    let mut plan = parse(file)?;
    parts.extend(plan.named_files().map(|(_, digest)| *digest));
    let make = || -> Result<Ground, SceneIoError> {
        match read_ground(file, &plan)? {
            Some(TerrainFile { mesh, digests, facts }) => {
                Ok(Ground { mesh: Arc::new(mesh), digests: Some(digests), facts })
            }
            None => make_ground(&plan)
                .map(|mesh| Ground { mesh: Arc::new(mesh), digests: None, facts: FileFacts::default() })
                .map_err(|error| SceneIoError::scene(source.origin(), error)),
        }
    };
    let ground = match grounds {
        // All that the mesh is made of; the folder, for paths are relative to it.
        Some(grounds) => grounds
            .get(format!("{:?} {:?} {:?}", plan.terrain, plan.reflectivity, file.file.parent()), make)?,
        None => make()?,
    };
    let is_from_file = ground.digests.is_some();
    parts.extend(ground.digests.iter().flatten());
    let position_span = plan.position_span.clone();
    // A lone terrain, whose text is only settings: as in `finish_alone`.
    let is_alone = matches!(source, SceneSource::Mesh(_) | SceneSource::Dem(_));
    if is_alone && is_from_file && position_span.is_empty() && overrides.at.is_none() {
        plan.vehicle.position = central_place(&ground.mesh).unwrap_or_default();
    }
    finish(source, plan, parts, ground, overrides).map_err(|error| match error {
        // A vehicle off the ground is the fault of a line in the file, unless the command line put it there.
        SceneIoError::NoGround { x, y, ground, .. } if overrides.at.is_none() => {
            no_ground(file, position_span, [x, y], &ground, overrides.for_drive)
        }
        other => other,
    })
}

/// The error of a vehicle that should stand where there is no ground.
pub(crate) fn no_ground(
    file: &Source,
    span: Range<usize>,
    [x, y]: [f64; 2],
    ground: &str,
    for_drive: bool,
) -> SceneIoError {
    let or_height = if for_drive { "" } else { ", or a height as the third number" };
    let message = format!(
        "`vehicle.position_m`: no ground under ({x}, {y}); expected a place within {ground}{or_height}"
    );
    file.error(span, message)
}

/// Loads a scene whose numbers stand in the file as they are. `parts` are digests.
fn load_resolved(
    source: &SceneSource,
    file: &Source,
    mut parts: Vec<Sha256Digest>,
    overrides: &Overrides,
) -> Result<LoadedScene, SceneIoError> {
    overrides.check_resolved()?;
    let mut resolved = parse_resolved(file)?;
    let (path, span) = (Path::new(resolved.file.get_ref()), resolved.file.span());
    let terrain = terrain_file(file, "file", &["glb", "gltf"], path, &span)?;
    let vertices = Vertices::OffsetsFrom(resolved.origin);
    let (mesh, of_files) = gltf::read_mesh(&terrain, DEFAULT_REFLECTIVITY, vertices)?;
    parts.extend(of_files);
    resolved.beams.iter_mut().for_each(|beam| overrides.apply_to_beam(&mut beam.sensor));
    let flux_model = overrides.flux_model.unwrap_or(resolved.flux_model);
    // The copy costs nothing: beams are few and small.
    let beams = resolved.beams.clone();
    let scene = Scene::new(Arc::new(mesh), resolved.camera, beams, resolved.atmosphere, flux_model)
        .map_err(|error| resolved.point_to(file, error))?;
    let vehicle = Pose::from_position(scene.mesh().origin());
    Ok(LoadedScene { has_vehicle: false, ..loaded(source, scene, vehicle, parts, overrides) })
}

/// Loads a terrain without a scene file: the default rig stands in its middle.
fn finish_alone(
    source: &SceneSource,
    terrain: Terrain,
    TerrainFile { mesh, digests, facts }: TerrainFile,
    overrides: &Overrides,
) -> Result<LoadedScene, SceneIoError> {
    let mut plan = default_rig(terrain);
    if overrides.at.is_none() {
        plan.vehicle.position = central_place(&mesh).unwrap_or_default();
    }
    let ground = Ground { mesh: Arc::new(mesh), digests: Some(digests.clone()), facts };
    finish(source, plan, digests, ground, overrides)
}

/// Resolves a plan: stands the vehicle on the ground and mounts the sensors. `parts` are digests, also those of the ground's files.
fn finish(
    source: &SceneSource,
    mut plan: ScenePlan,
    mut parts: Vec<Sha256Digest>,
    Ground { mesh, digests, facts: file_facts }: Ground,
    overrides: &Overrides,
) -> Result<LoadedScene, SceneIoError> {
    let unfit = |error: SceneError| SceneIoError::scene(source.origin(), error);
    overrides.apply(&mut plan);
    let Some(vehicle) = plan.vehicle.global_from_vehicle(&mesh) else {
        let [x, y] = plan.vehicle.position;
        return Err(SceneIoError::NoGround { origin: source.origin(), x, y, ground: extent(&mesh) });
    };
    let scene = resolve(&plan, mesh, vehicle).map_err(unfit)?;
    // A generated ground takes part in the digest by its numbers, which its name does not promise.
    match source {
        SceneSource::Builtin(_) => parts.push(digest::resolved(&scene)),
        _ if digests.is_none() => parts.push(digest::mesh(scene.mesh())),
        _ => {}
    }
    if let Some(drive) = &mut plan.drive {
        drive.place(&scene, &vehicle);
    }
    let drive = plan.drive;
    Ok(LoadedScene { drive, file_facts, ..loaded(source, scene, vehicle, parts, overrides) })
}

/// Adds names and digests to a scene.
fn loaded(
    source: &SceneSource,
    scene: Scene,
    vehicle: Pose,
    mut parts: Vec<Sha256Digest>,
    overrides: &Overrides,
) -> LoadedScene {
    if let Some(words) = overrides.words().filter(|_| !matches!(source, SceneSource::Builtin(_))) {
        parts.push(sha256(words.as_bytes()));
    }
    LoadedScene {
        name: source.folder_name(),
        source_sha256: combined_sha256_hex(&parts),
        scene_sha256: digest::scene_sha256(&scene),
        scene,
        vehicle,
        has_vehicle: true,
        source: source.clone(),
        drive: None,
        file_facts: FileFacts::default(),
    }
}
