//! TOML of `kind = "resolved"` to sensors and poses; every error points to its place in the file.

use glam::{DQuat, DVec3};
use serde::Deserialize;
use std::ops::Range;
use toml::Spanned;

use raypencil_scene::{Atmosphere, Beam, Camera, Filter, FluxModel, Lens, Mounted, Pose, SceneError};

use crate::parse::shared::GLOBAL_M;
use crate::parse::source::Source;
use crate::scene_error::SceneIoError;

/// All of a resolved scene except for its mesh.
pub(crate) struct Resolved {
    pub camera: Mounted<Camera>,
    pub beams: Vec<Mounted<Beam>>,
    pub atmosphere: Atmosphere,
    pub flux_model: FluxModel,
    /// File of the ground, relative to the scene file, and its place in it.
    pub file: Spanned<String>,
    /// Scene origin, global frame, metres.
    pub origin: DVec3,
    places: FieldPlaces,
}

impl Resolved {
    /// The error of [`raypencil_scene::Scene::new`], pointed to its key if the field stands in the file.
    pub(crate) fn point_to(&self, source: &Source, error: SceneError) -> SceneIoError {
        placed(&self.places, source, error)
    }
}

/// The whole file. All keys are required but `filter` and the width of a Gaussian: a default would be a guess.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Keys {
    #[allow(dead_code, reason = "checked before; named here so that it is a known key")]
    version: i64,
    #[allow(dead_code, reason = "checked before; named here so that it is a known key")]
    kind: String,
    camera: CameraKeys,
    #[serde(default)]
    beam: Vec<BeamKeys>,
    terrain: TerrainKeys,
    atmosphere: AtmosphereKeys,
    flux: FluxKeys,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PoseKeys {
    position_m: Spanned<[f64; 3]>,
    quaternion_xyzw: Spanned<[f64; 4]>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct CameraKeys {
    scene_from_camera: PoseKeys,
    width_px: Spanned<i64>,
    height_px: Spanned<i64>,
    pixel_pitch_m: Spanned<[f64; 2]>,
    focal_length_m: Spanned<f64>,
    principal_point_px: Spanned<[f64; 2]>,
    aperture_m: Spanned<f64>,
    transmission: Spanned<f64>,
    filter: Option<FilterKeys>,
    max_range_m: Spanned<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FilterKeys {
    centre_m: Spanned<f64>,
    width_m: Spanned<f64>,
    index: Spanned<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct BeamKeys {
    scene_from_beam: PoseKeys,
    columns: Spanned<i64>,
    rows: Spanned<i64>,
    thickness_m: Spanned<f64>,
    grid_distance_m: Spanned<f64>,
    half_width_m: Spanned<f64>,
    max_range_m: Spanned<f64>,
    power_w: Spanned<f64>,
    wavelength_m: Spanned<f64>,
    profile: Spanned<String>,
    gaussian_half_width_rad: Option<Spanned<f64>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct TerrainKeys {
    file: Spanned<String>,
    origin_m: Spanned<[f64; 3]>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct AtmosphereKeys {
    attenuation_per_m: Spanned<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FluxKeys {
    model: Spanned<String>,
}

/// Place of each field of a scene in the file. The limits are checked by `scene`; its errors find their places here.
#[derive(Default)]
struct FieldPlaces(Vec<FieldPlace>);

struct FieldPlace {
    /// Start of [`SceneError::field`].
    field: String,
    key: String,
    span: Range<usize>,
}

impl FieldPlaces {
    /// Value of `key`, which becomes `field` of a scene.
    fn take<T>(&mut self, field: String, key: String, value: Spanned<T>) -> T {
        self.0.push(FieldPlace { field, key, span: value.span() });
        value.into_inner()
    }

    fn error(&self, source: &Source, error: SceneError) -> Result<SceneIoError, SceneError> {
        match self.0.iter().find(|place| error.field.starts_with(&place.field)) {
            None => Err(error),
            Some(place) => {
                let message = format!("`{}` is {}; expected {}", place.key, error.value, error.expected);
                Ok(source.error(place.span.clone(), message))
            }
        }
    }
}

/// Reads a scene file whose kind is [`crate::parse::kind::Kind::Resolved`]. Sensors are checked alone, not yet together
/// with the ground.
pub(crate) fn parse_resolved(source: &Source) -> Result<Resolved, SceneIoError> {
    let keys: Keys = source.deserialize()?;
    let mut places = FieldPlaces::default();
    let camera = camera(source, keys.camera, &mut places)?;
    let mut beams = Vec::with_capacity(keys.beam.len());
    for (index, beam_keys) in keys.beam.into_iter().enumerate() {
        beams.push(beam(source, index, beam_keys, &mut places)?);
    }
    let attenuation = keys.atmosphere.attenuation_per_m;
    let attenuation =
        places.take("atmosphere.attenuation".into(), "atmosphere.attenuation_per_m".into(), attenuation);
    let origin = keys.terrain.origin_m;
    for &coordinate in origin.get_ref() {
        source.check(coordinate, origin.span(), "terrain.origin_m", GLOBAL_M, "metres")?;
    }
    Ok(Resolved {
        camera,
        beams,
        atmosphere: Atmosphere { attenuation },
        flux_model: source.flux_model(&keys.flux.model)?,
        file: keys.terrain.file,
        origin: DVec3::from_array(origin.into_inner()),
        places,
    })
}

fn pose(keys: PoseKeys, field: &str, key: &str, places: &mut FieldPlaces) -> Pose {
    let position = places.take(format!("{field}.position"), format!("{key}.position_m"), keys.position_m);
    let rotation =
        places.take(format!("{field}.rotation"), format!("{key}.quaternion_xyzw"), keys.quaternion_xyzw);
    Pose { position: DVec3::from_array(position), rotation: DQuat::from_array(rotation) }
}

/// Number of columns or rows. `scene` checks its own limits, which are narrower than those of the type.
fn count(
    source: &Source,
    value: Spanned<i64>,
    field: String,
    key: String,
    places: &mut FieldPlaces,
) -> Result<u32, SceneIoError> {
    let span = value.span();
    let given = *value.get_ref();
    let count = u32::try_from(given)
        .map_err(|_| source.error(span, format!("`{key}` is {given}; expected 1 to 1048576")))?;
    places.take(field, key, value);
    Ok(count)
}

fn camera(
    source: &Source,
    keys: CameraKeys,
    places: &mut FieldPlaces,
) -> Result<Mounted<Camera>, SceneIoError> {
    let scene_from_sensor = pose(keys.scene_from_camera, "camera", "camera.scene_from_camera", places);
    let key = |name: &str| format!("camera.{name}");
    // An error of "camera.width x height" points to the width: its field starts so.
    let width = count(source, keys.width_px, key("width"), key("width_px"), places)?;
    let height = count(source, keys.height_px, key("height"), key("height_px"), places)?;
    let mut take = |field: &str, name: &str, value| places.take(key(field), key(name), value);
    let focal_length = take("focal_length", "focal_length_m", keys.focal_length_m);
    let aperture = take("aperture", "aperture_m", keys.aperture_m);
    let max_range = take("max_range", "max_range_m", keys.max_range_m);
    let transmission = take("lens.transmission", "transmission", keys.transmission);
    let filter = match keys.filter {
        None => Filter::None,
        Some(keys) => Filter::Interference {
            centre: take("lens.filter.centre", "filter.centre_m", keys.centre_m),
            width: take("lens.filter.width", "filter.width_m", keys.width_m),
            index: take("lens.filter.index", "filter.index", keys.index),
        },
    };
    let pixel_pitch = places.take(key("pixel_pitch"), key("pixel_pitch_m"), keys.pixel_pitch_m);
    let principal_point =
        places.take(key("principal_point"), key("principal_point_px"), keys.principal_point_px);
    let lens = Lens { transmission, filter };
    let sensor =
        Camera { width, height, pixel_pitch, focal_length, principal_point, aperture, lens, max_range };
    sensor.validate("camera").map_err(|error| placed(places, source, error))?;
    Ok(Mounted { scene_from_sensor, sensor })
}

fn beam(
    source: &Source,
    index: usize,
    keys: BeamKeys,
    places: &mut FieldPlaces,
) -> Result<Mounted<Beam>, SceneIoError> {
    let name = format!("beam {index}");
    let scene_from_sensor = pose(keys.scene_from_beam, &name, &format!("{name}.scene_from_beam"), places);
    let key = |part: &str| format!("{name}.{part}");
    let columns = count(source, keys.columns, key("columns"), key("columns"), places)?;
    let rows = count(source, keys.rows, key("rows"), key("rows"), places)?;
    let mut take = |field: &str, part: &str, value| places.take(key(field), key(part), value);
    let thickness = take("thickness", "thickness_m", keys.thickness_m);
    let grid_distance = take("grid_distance", "grid_distance_m", keys.grid_distance_m);
    let half_width = take("half_width", "half_width_m", keys.half_width_m);
    let max_range = take("max_range", "max_range_m", keys.max_range_m);
    let power = take("power", "power_w", keys.power_w);
    let wavelength = take("wavelength", "wavelength_m", keys.wavelength_m);
    if let Some(width) = &keys.gaussian_half_width_rad {
        take("profile.half_width", "gaussian_half_width_rad", width.clone());
    }
    let width = keys.gaussian_half_width_rad;
    let profile = source.profile_word(&name, &keys.profile, &width, "gaussian_half_width_rad")?;
    let sensor =
        Beam { columns, rows, thickness, grid_distance, half_width, max_range, power, wavelength, profile };
    sensor.validate(&name).map_err(|error| placed(places, source, error))?;
    Ok(Mounted { scene_from_sensor, sensor })
}

/// Error with its place, if the field stands in the file.
fn placed(places: &FieldPlaces, source: &Source, error: SceneError) -> SceneIoError {
    places
        .error(source, error)
        .unwrap_or_else(|error| SceneIoError::scene(source.file.display().to_string(), error))
}
