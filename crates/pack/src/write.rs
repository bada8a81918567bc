//! Reference packs: a scene, its rays, and every answer correctly rounded, for other people's renderers.
//!
//! ```text
//! DIR/scene.toml, terrain.glb         the resolved scene: the very numbers that the answers are about
//! DIR/rays-camera.npy, rays-beam-N    origin and direction of each ray, for those who read no scene
//! DIR/camera/, beam-N/                every quantity as f64 arrays
//! DIR/camera.exr, beam-N.exr          the same in f32, rounded from the exact numbers and not from the f64
//! DIR/manifest.json                   written last: each file's size, digest, channels and units
//! ```
//!
//! The same scene gives the same bytes on any machine, for any number of threads and any optimisation.

use rayon::prelude::*;
use std::path::Path;

use crate::arrays::{Arrays, channel, convert, unit_of_flux};
use crate::manifest::{
    ChannelType, FileRole, FileType, FluxWord, MANIFEST_FORMAT, Manifest, ManifestFile, ManifestScene,
    ManifestSensor, PackKind,
};
use crate::margins::SensorMargins;
use raypencil_files::{
    Attributes, ExrMap, FileError, FolderError, Raster, create_folder, write_exr, write_npy,
};
use raypencil_judge::{Answers, Certified, flux_channel, image_channel};
use raypencil_referee::{Format, Referee};
use raypencil_scene::{FluxModel, Image, Progress, Scene, SensorId};
use raypencil_scene_io::{Subject, scene_sha256, write_resolved};

/// Why a pack could not be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PackError {
    /// A file or folder; the message names it.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// A file; the message names it.
    #[error(transparent)]
    File(#[from] FileError),
    /// Values that the referee's budget of bits did not decide.
    #[error(
        "{name}: {count} values lie on a midpoint between two numbers for all that 2048 bits tell; a pack holds certain values only"
    )]
    Undecided {
        /// The scene.
        name: String,
        /// How many values.
        count: usize,
    },
}

/// Writes the pack of a scene into `folder`: with all answers, or for a blind seed without any.
///
/// An earlier pack is removed before anything is written, its manifest first, so that a manifest marks a complete pack
/// whatever happens in between, and no answer stays beside questions that are not its own.
///
/// # Errors
/// Names the file or folder that could not be written, and why; values that are not decided.
pub fn write_pack(
    subject: &Subject,
    blind_seed: Option<u64>,
    folder: &Path,
    progress: &dyn Progress,
) -> Result<(), PackError> {
    let scene = &subject.scene;
    // The answers first: nothing is written unless all are certain.
    let certified = blind_seed.is_none().then(|| Certified::new(scene, progress));
    if let Some(count) = certified.as_ref().map(Certified::undecided).filter(|count| *count > 0) {
        return Err(PackError::Undecided { name: subject.name.clone(), count });
    }

    create_folder(folder)?;
    Manifest::remove_pack(folder)?;
    progress.stage("writing the scene");
    write_resolved(folder.join("scene.toml"), scene, "terrain.glb")?;
    let mut files = vec![
        ManifestFile::of(folder, "scene.toml", FileRole::Scene)?,
        ManifestFile::of(folder, "terrain.glb", FileRole::Terrain)?,
    ];
    let referee = Referee::new(scene);
    for sensor in scene.sensors() {
        progress.stage(&format!("{sensor}: rays"));
        files.push(write_rays(&referee, scene, sensor, folder)?);
    }
    if let Some(certified) = &certified {
        files.extend(write_answers(certified, &referee, scene, folder, progress)?);
    }

    let sensor = |sensor: SensorId| {
        let (columns, rows) = scene.size(sensor).expect("a sensor of this scene");
        ManifestSensor { name: sensor.to_string(), columns, rows }
    };
    let manifest = Manifest {
        format: MANIFEST_FORMAT,
        kind: if blind_seed.is_some() { PackKind::Blind } else { PackKind::Answers },
        raypencil_version: env!("CARGO_PKG_VERSION").into(),
        scene: ManifestScene { name: subject.name.clone(), sha256: scene_sha256(scene) },
        flux_model: match scene.flux_model() {
            FluxModel::Radiometric => FluxWord::Radiometric,
            FluxModel::Eq1 => FluxWord::Eq1,
        },
        blind_seed,
        sensors: scene.sensors().map(sensor).collect(),
        files,
    };
    Ok(manifest.write(folder)?)
}

/// Every quantity of every sensor, and every margin.
fn write_answers(
    certified: &Certified,
    referee: &Referee<'_>,
    scene: &Scene,
    folder: &Path,
    progress: &dyn Progress,
) -> Result<Vec<ManifestFile>, PackError> {
    let model = scene.flux_model();
    let [doubles, singles] =
        [Format::Double, Format::Single].map(|format| certified.in_format(format, model));
    let attributes =
        Attributes { renderer: "referee".into(), scene_sha256: scene_sha256(scene), extra: Vec::new() };
    let mut files = Vec::new();
    for sensor in scene.sensors() {
        progress.stage(&format!("{sensor}: margins"));
        let margins = SensorMargins::find(referee, scene, sensor);
        progress.stage(&format!("{sensor}: writing"));
        create_folder(&folder.join(sensor.to_string()))?;
        let mut arrays = Arrays::new(folder, sensor);
        arrays.write(&doubles, &margins, model)?;
        files.append(&mut arrays.files);
        files.push(write_map(&singles, &margins, model, &attributes, sensor, folder)?);
    }
    Ok(files)
}

/// Origin and direction of each ray, (rows, columns, 6), metres in the scene frame, the nearest f64.
fn write_rays(
    referee: &Referee<'_>,
    scene: &Scene,
    sensor: SensorId,
    folder: &Path,
) -> Result<ManifestFile, PackError> {
    let (width, height) = scene.size(sensor).expect("a sensor of this scene");
    let ray = |i: u32, j: u32| -> [f64; 6] {
        let [origin, direction] = referee.ray(sensor, i, j).expect("a cell of this sensor");
        let part = |k: usize| if k < 3 { origin[k].double } else { direction[k - 3].double };
        [0, 1, 2, 3, 4, 5].map(part)
    };
    let rows = (0..height).into_par_iter();
    let rays: Vec<[f64; 6]> =
        rows.flat_map_iter(|j| (0..width).map(move |i| (i, j))).map(|(i, j)| ray(i, j)).collect();
    let planes: Vec<Image<f64>> =
        (0..6).map(|k| Image::from_cells(width, height, rays.iter().map(|ray| ray[k]).collect())).collect();
    let path = format!("rays-{sensor}.npy");
    write_npy(folder.join(&path), &planes.iter().collect::<Vec<_>>())?;
    let names = ["origin.X", "origin.Y", "origin.Z", "direction.X", "direction.Y", "direction.Z"];
    Ok(ManifestFile {
        kind: Some(FileType::Float64),
        shape: Some(vec![height, width, 6]),
        channels: names.map(|name| channel(name, "m", ChannelType::Float64)).to_vec(),
        ..ManifestFile::of(folder, path, FileRole::Rays)?
    })
}

/// The answers in f32, by the channels of any renderer, and those that packs have beside them.
fn write_map(
    answers: &Answers,
    margins: &SensorMargins,
    model: FluxModel,
    attributes: &Attributes,
    sensor: SensorId,
    folder: &Path,
) -> Result<ManifestFile, PackError> {
    let mut exr = ExrMap::from_sensor_map(answers.map(sensor), attributes);
    let second = model.other();
    let single = |image: &Image<f64>| Raster::F32(convert(image, |flux| flux as f32));
    match sensor {
        SensorId::Camera => {
            for (beam, light) in answers.light.iter().enumerate() {
                if let Some(image) = &light.image {
                    exr.insert_flux(beam, image, model);
                }
                if let Some(image) = &light.other_image {
                    exr.insert(image_channel(beam, Some(second)), single(image));
                }
            }
        }
        SensorId::Beam(beam) => {
            exr.insert_returns(&answers.light[beam].returns, model);
            if let Some(flux) = &answers.light[beam].other_flux {
                exr.insert(flux_channel(Some(second)), single(flux));
            }
        }
    }
    for (name, _, image) in margins.channels() {
        exr.insert(name, Raster::F32(convert(image, single_margin)));
    }
    let extra = [
        (
            "rounding",
            "each value is the single nearest to the exact number; margins are rounded down".to_string(),
        ),
        ("otherFluxUnit", format!("flux.{}: {}", second.word(), unit_of_flux(second))),
        ("marginUnit", "face, surface, visibility: cell; landing: camera pixel".into()),
    ];
    exr.attributes.extend(extra.map(|(name, value)| (name.to_string(), value)));
    let path = format!("{sensor}.exr");
    write_exr(folder.join(&path), &exr)?;
    let of = |(name, raster): (&String, &Raster)| {
        let kind = if raster.as_u32().is_some() { ChannelType::Uint32 } else { ChannelType::Float32 };
        channel(name, unit_of(name, model), kind)
    };
    Ok(ManifestFile {
        kind: Some(FileType::Exr),
        shape: Some(vec![exr.height, exr.width]),
        channels: exr.channels.iter().map(of).collect(),
        ..ManifestFile::of(folder, path, FileRole::Answers)?
    })
}

/// A margin, which is an f32 already, or the one NaN that stands for nothing.
fn single_margin(margin: f64) -> f32 {
    if margin.is_nan() { f32::from_bits(0x7fc0_0000) } else { margin as f32 }
}

/// The unit of a channel of the files of a scene with this model of flux.
fn unit_of(channel: &str, model: FluxModel) -> &'static str {
    let second = model.other();
    match channel {
        "range.T" | "depth.Z" | "view.Z" | "P.X" | "P.Y" | "P.Z" => "m",
        "face.I" | "pixel.I" | "pixel.J" => "index",
        "margin.landing" => "pixel",
        name if name.starts_with("margin.") => "cell",
        name if name.starts_with(&format!("flux.{}.", second.word())) => unit_of_flux(second),
        name if name.starts_with("flux.") => unit_of_flux(model),
        _ => "1",
    }
}
