//! Scene TOML to a plan: each key is checked by itself, and every error points to its place in the file.

pub(crate) mod dem;
pub(crate) mod generate;

use glam::DVec3;
use std::ops::{Range, RangeInclusive};
use std::path::{Path, PathBuf};
use toml::Spanned;

use crate::keys::{BeamKeys, CameraKeys, FilterKeys, HeadKeys, Key, SceneKeys, TerrainKeys, VehicleKeys};
use crate::plan::{DEFAULT_FAN_DEG, DemPart, Mount, Plan, Terrain, default_beam, default_rig};
use crate::scene_error::SceneIoError;
use crate::toml_problem::TomlProblem;
use raypencil_mesh_io::DEFAULT_REFLECTIVITY;
use raypencil_scene::{Beam, Camera, Filter, FluxModel, Profile};

/// CHOICE: the effective index of common interference filters lies around 2.
const DEFAULT_FILTER_INDEX: f64 = 2.0;

/// A fan of light, from a thread to just below a half plane, degrees.
pub(crate) const FAN_DEG: RangeInclusive<f64> = 0.001..=179.9;

pub(crate) const THICKNESS_MM: RangeInclusive<f64> = 1e-3..=1e5;

/// Any turn, either way, degrees.
pub(crate) const TURN_DEG: RangeInclusive<f64> = -360.0..=360.0;

/// Global coordinates, metres: a scene origin's own limit.
pub(crate) const GLOBAL_M: RangeInclusive<f64> = -1e12..=1e12;

/// Coordinates of a sensor on the vehicle, metres.
const MOUNT_M: RangeInclusive<f64> = -1e3..=1e3;

/// The longest range of a sensor, metres.
const MAX_RANGE_M: RangeInclusive<f64> = 1e-3..=1e7;

/// Columns or rows of a sensor, and all its cells: 2^20 and 2^26, the limits of the `scene` crate.
const SIDE: RangeInclusive<i64> = 1..=1 << 20;

const MOST_CELLS: u64 = 1 << 26;

/// The words for the equations of flux.
pub(crate) const FLUX_MODELS: [(&str, FluxModel); 2] =
    [("radiometric", FluxModel::Radiometric), ("eq1", FluxModel::Eq1)];

/// Reads a scene TOML of version 1 and no special kind.
pub(crate) fn parse(source: &Source) -> Result<Plan, SceneIoError> {
    let keys: SceneKeys = source.deserialize()?;
    source.plan(keys)
}

/// What a scene TOML describes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Kind {
    /// A rig on a ground: most numbers have defaults.
    Rig,
    /// A scene's own numbers.
    Resolved,
}

/// The text of a scene file, to which every error points.
pub(crate) struct Source<'a> {
    pub file: &'a Path,
    pub text: &'a str,
}

impl Source<'_> {
    /// An error at some bytes of the file.
    pub(crate) fn error(&self, span: Range<usize>, message: impl Into<String>) -> SceneIoError {
        SceneIoError::Toml(Box::new(TomlProblem::new(self.file, self.text, span, message)))
    }

    pub(crate) fn deserialize<T: serde::de::DeserializeOwned>(&self) -> Result<T, SceneIoError> {
        toml::from_str(self.text)
            .map_err(|error| self.error(error.span().unwrap_or(0..0), error.message().trim_end()))
    }

    /// The kind of a file of version 1: asked first, so that a newer file fails by its version and not by
    /// a key.
    pub(crate) fn kind(&self) -> Result<Kind, SceneIoError> {
        let wanted = "`version = 1`, the only version there is";
        let head: HeadKeys = self.deserialize()?;
        match head.version {
            None => Err(self.error(0..0, format!("`version` is missing; expected {wanted}"))),
            Some(version) if version.get_ref().as_integer() == Some(1) => match head.kind {
                None => Ok(Kind::Rig),
                Some(kind) if kind.get_ref().as_str() == Some("resolved") => Ok(Kind::Resolved),
                Some(kind) => {
                    let message = format!(
                        "`kind` is {}; expected \"resolved\", or no `kind` for a rig on a ground",
                        kind.get_ref()
                    );
                    Err(self.error(kind.span(), message))
                }
            },
            Some(version) => {
                let message = format!("`version` is {}; expected {wanted}", version.get_ref());
                Err(self.error(version.span(), message))
            }
        }
    }

    fn plan(&self, keys: SceneKeys) -> Result<Plan, SceneIoError> {
        let mut plan = default_rig(Terrain::Builtin("pyramids".to_string()));
        self.vehicle(keys.vehicle, &mut plan)?;
        self.camera(keys.camera, &mut plan.camera)?;
        if let Some(beams) = keys.beam {
            let build = |(index, keys)| self.beam(index, keys);
            plan.beams = beams.into_iter().enumerate().map(build).collect::<Result<_, _>>()?;
        }
        if let Some(terrain) = keys.terrain {
            plan.terrain_span = terrain.span();
            self.terrain(terrain, &mut plan)?;
        }
        let attenuation = keys.atmosphere.attenuation_per_m;
        self.number(
            attenuation,
            "atmosphere.attenuation_per_m",
            &mut plan.attenuation,
            0.0..=1e3,
            "per metre",
        )?;
        if let Some(model) = keys.flux.model {
            plan.flux_model = self.word(&model, "flux.model", &FLUX_MODELS)?;
        }
        if let Some(keys) = keys.drive {
            let (drive, kernels) = self.drive(keys)?;
            (plan.drive, plan.kernels) = (Some(drive), kernels);
        }
        Ok(plan)
    }

    fn vehicle(&self, keys: VehicleKeys, plan: &mut Plan) -> Result<(), SceneIoError> {
        let vehicle = &mut plan.vehicle;
        if let Some(position) = keys.position_m {
            plan.position_span = position.span();
            let place = "vehicle.position_m";
            match *self.list(&position, place, &[2, 3], GLOBAL_M, "metres")? {
                [x, y] => vehicle.position = [x, y],
                [x, y, z] => (vehicle.position, vehicle.height) = ([x, y], Some(z)),
                _ => unreachable!("two or three numbers"),
            }
        }
        self.number(keys.heading_deg, "vehicle.heading_deg", &mut vehicle.heading_deg, TURN_DEG, "degrees")?;
        let pitch = &mut vehicle.pitch_down_deg;
        self.number(keys.pitch_down_deg, "vehicle.pitch_down_deg", pitch, TURN_DEG, "degrees")?;
        let roll = &mut vehicle.roll_right_deg;
        self.number(keys.roll_right_deg, "vehicle.roll_right_deg", roll, TURN_DEG, "degrees")
    }

    /// The keys that a camera and a beam share.
    fn mount(
        &self,
        sensor: &str,
        keys: [Key<f64>; 3],
        position: Key<Vec<f64>>,
        mount: &mut Mount,
    ) -> Result<(), SceneIoError> {
        if let Some(position) = position {
            let place = format!("{sensor}.position_m");
            mount.position = DVec3::from_slice(self.list(&position, &place, &[3], MOUNT_M, "metres")?);
        }
        let [pitch, yaw, roll] = keys;
        self.number(
            pitch,
            &format!("{sensor}.pitch_down_deg"),
            &mut mount.pitch_down_deg,
            TURN_DEG,
            "degrees",
        )?;
        self.number(yaw, &format!("{sensor}.yaw_left_deg"), &mut mount.yaw_left_deg, TURN_DEG, "degrees")?;
        self.number(roll, &format!("{sensor}.roll_right_deg"), &mut mount.roll_right_deg, TURN_DEG, "degrees")
    }

    fn camera(&self, keys: CameraKeys, (mount, camera): &mut (Mount, Camera)) -> Result<(), SceneIoError> {
        let turns = [keys.pitch_down_deg, keys.yaw_left_deg, keys.roll_right_deg];
        self.mount("camera", turns, keys.position_m, mount)?;
        let sides = [("width_px", keys.width_px), ("height_px", keys.height_px)];
        [camera.width, camera.height] =
            self.cells("camera", sides, [camera.width, camera.height], "pixels")?;
        if let Some(pitch) = keys.pixel_pitch_um {
            for value in pitch.get_ref().0 {
                self.check(value, pitch.span(), "camera.pixel_pitch_um", 0.01..=1e5, "micrometres")?;
            }
            camera.pixel_pitch = pitch.get_ref().0.map(|um| um / 1e6);
        }
        camera.focal_length = self.scaled(
            keys.focal_length_mm,
            "camera.focal_length_mm",
            camera.focal_length,
            0.01..=1e5,
            "millimetres",
            1e3,
        )?;
        camera.aperture = self.scaled(
            keys.aperture_mm,
            "camera.aperture_mm",
            camera.aperture,
            1e-3..=1e4,
            "millimetres",
            1e3,
        )?;
        let transmission = &mut camera.lens.transmission;
        self.number(keys.transmission, "camera.transmission", transmission, 0.0..=1.0, "")?;
        if let Some(filter) = keys.filter {
            camera.lens.filter = self.filter(filter.into_inner())?;
        }
        // The middle of the image, whatever its size.
        camera.principal_point = [camera.width, camera.height].map(|side| 0.5 * f64::from(side));
        if let Some(point) = keys.principal_point_px {
            let numbers = self.list(&point, "camera.principal_point_px", &[2], -1e6..=1e6, "pixels")?;
            camera.principal_point = [numbers[0], numbers[1]];
        }
        self.number(keys.max_range_m, "camera.max_range_m", &mut camera.max_range, MAX_RANGE_M, "metres")
    }

    fn filter(&self, keys: FilterKeys) -> Result<Filter, SceneIoError> {
        let nanometres = |key: Spanned<f64>, name: &str, range| {
            self.scaled(Some(key), &format!("camera.filter.{name}"), 0.0, range, "nanometres", 1e9)
        };
        let centre = nanometres(keys.centre_nm, "centre_nm", 10.0..=1e6)?;
        let width = nanometres(keys.width_nm, "width_nm", 1e-3..=1e6)?;
        let mut index = DEFAULT_FILTER_INDEX;
        self.number(keys.index, "camera.filter.index", &mut index, 1.0..=10.0, "")?;
        Ok(Filter::Interference { centre, width, index })
    }

    fn beam(&self, index: usize, keys: BeamKeys) -> Result<(Mount, Beam), SceneIoError> {
        let (mut mount, mut beam) = default_beam(index);
        let name = format!("beam {index}");
        let key = |key: &str| format!("{name}.{key}");
        let turns = [keys.pitch_down_deg, keys.yaw_left_deg, keys.roll_right_deg];
        self.mount(&name, turns, keys.position_m, &mut mount)?;
        let mut fan_deg = DEFAULT_FAN_DEG;
        self.number(keys.fan_deg, &key("fan_deg"), &mut fan_deg, FAN_DEG, "degrees")?;
        let mm = "millimetres";
        beam.thickness =
            self.scaled(keys.thickness_mm, &key("thickness_mm"), beam.thickness, THICKNESS_MM, mm, 1e3)?;
        let distance = &key("grid_distance_mm");
        beam.grid_distance =
            self.scaled(keys.grid_distance_mm, distance, beam.grid_distance, 0.1..=1e5, mm, 1e3)?;
        beam.half_width = Beam::half_width_of(beam.grid_distance, fan_deg.to_radians());
        let sides = [("columns", keys.columns), ("rows", keys.rows)];
        [beam.columns, beam.rows] = self.cells(&name, sides, [beam.columns, beam.rows], "pencils")?;
        self.number(keys.power_w, &key("power_w"), &mut beam.power, 0.0..=1e6, "watts")?;
        let wavelength = &key("wavelength_nm");
        beam.wavelength =
            self.scaled(keys.wavelength_nm, wavelength, beam.wavelength, 10.0..=1e6, "nanometres", 1e9)?;
        self.number(keys.max_range_m, &key("max_range_m"), &mut beam.max_range, MAX_RANGE_M, "metres")?;
        beam.profile = self.profile(&name, keys.profile, keys.gaussian_half_width_deg)?;
        Ok((mount, beam))
    }

    /// `profile` and `gaussian_half_width_deg`, which is there exactly when the profile is Gaussian.
    fn profile(&self, beam: &str, profile: Key<String>, width: Key<f64>) -> Result<Profile, SceneIoError> {
        let key = "gaussian_half_width_deg";
        let profile = profile.unwrap_or_else(|| Spanned::new(0..0, "paper".to_string()));
        let place = width.as_ref().map_or(0..0, Spanned::span);
        match self.shape(beam, &profile, width, key)? {
            Profile::Gaussian { half_width } => {
                self.check(half_width, place, &format!("{beam}.{key}"), 1e-3..=1e4, "degrees")?;
                Ok(Profile::Gaussian { half_width: half_width.to_radians() })
            }
            other => Ok(other),
        }
    }

    /// A profile, with the width of a Gaussian as it is given under `key`.
    pub(crate) fn shape(
        &self,
        beam: &str,
        profile: &Spanned<String>,
        width: Key<f64>,
        key: &str,
    ) -> Result<Profile, SceneIoError> {
        let name = format!("{beam}.profile");
        // The Gaussian's width is filled in below.
        let gaussian = Profile::Gaussian { half_width: 0.0 };
        let words =
            [("paper", Profile::Paper), ("uniform_angle", Profile::UniformAngle), ("gaussian", gaussian)];
        match (self.word(profile, &name, &words)?, width) {
            (Profile::Gaussian { .. }, Some(width)) => {
                Ok(Profile::Gaussian { half_width: width.into_inner() })
            }
            (Profile::Gaussian { .. }, None) => {
                let message = format!("`{name}` is \"gaussian\" without a width; expected `{key}` too");
                Err(self.error(profile.span(), message))
            }
            (other, None) => Ok(other),
            (_, Some(width)) => {
                let message = format!(
                    "`{beam}.{key}` is given; expected it only with profile = \"gaussian\", not \"{}\"",
                    profile.get_ref()
                );
                Err(self.error(width.span(), message))
            }
        }
    }

    fn terrain(&self, terrain: Spanned<TerrainKeys>, plan: &mut Plan) -> Result<(), SceneIoError> {
        let whole = terrain.span();
        let keys = terrain.into_inner();
        let mut reflectivity = DEFAULT_REFLECTIVITY;
        if let Some(given) = keys.reflectivity {
            self.number(Some(given), "terrain.reflectivity", &mut reflectivity, 0.0..=1.0, "")?;
            plan.reflectivity = Some(reflectivity);
        }
        let dem = self.dem_part(keys.dem_window_m, keys.dem_max_error_m, keys.dem.as_ref())?;
        let one = "exactly one of `builtin`, `file`, `dem` and `generate`";
        plan.terrain = match (keys.builtin, keys.file, keys.dem, keys.generate) {
            (Some(name), None, None, None) => {
                let names: Vec<_> =
                    raypencil_terrain::BUILTIN_NAMES.iter().map(|name| (*name, *name)).collect();
                Terrain::Builtin(self.word(&name, "terrain.builtin", &names)?.to_string())
            }
            (None, Some(file), None, None) => {
                plan.terrain_span = file.span();
                Terrain::File(PathBuf::from(file.into_inner()))
            }
            (None, None, Some(file), None) => {
                plan.terrain_span = file.span();
                Terrain::Dem(DemPart { file: PathBuf::from(file.into_inner()), ..dem })
            }
            (None, None, None, Some(generate)) => self.generate(generate)?,
            (None, None, None, None) => {
                return Err(self.error(whole, format!("`terrain` has no ground; expected {one}")));
            }
            // The later of the two is the one too many.
            (builtin, file, dem, generate) => {
                let named = [
                    ("builtin", builtin.map(|key| key.span())),
                    ("file", file.map(|key| key.span())),
                    ("dem", dem.map(|key| key.span())),
                    ("generate", generate.map(|key| key.span())),
                ];
                let given = named.into_iter().filter_map(|(name, span)| Some((span?, name)));
                let (span, last) = given.max_by_key(|(span, _)| span.start).unwrap_or((whole, "terrain"));
                return Err(
                    self.error(span, format!("`terrain.{last}` is one ground too many; expected {one}"))
                );
            }
        };
        Ok(())
    }

    /// Refuses a `value` outside `range`, and NaN and the infinities with it.
    pub(crate) fn check(
        &self,
        value: f64,
        span: Range<usize>,
        name: &str,
        range: RangeInclusive<f64>,
        unit: &str,
    ) -> Result<(), SceneIoError> {
        if range.contains(&value) {
            return Ok(());
        }
        let (low, high) = (number_text(*range.start()), number_text(*range.end()));
        let message = format!("`{name}` is {}; expected {low} to {high} {unit}", number_text(value));
        Err(self.error(span, message.trim_end()))
    }

    /// Replaces `slot` by the key's value, if there is one.
    fn number(
        &self,
        key: Key<f64>,
        name: &str,
        slot: &mut f64,
        range: RangeInclusive<f64>,
        unit: &str,
    ) -> Result<(), SceneIoError> {
        if let Some(key) = key {
            self.check(*key.get_ref(), key.span(), name, range, unit)?;
            *slot = key.into_inner();
        }
        Ok(())
    }

    /// The key's value divided by `per_si` (units per metre), else the `default`, which is SI already.
    ///
    /// A division by a power of ten rounds once: 9 micrometres are the double nearest 9e-6.
    fn scaled(
        &self,
        key: Key<f64>,
        name: &str,
        default: f64,
        range: RangeInclusive<f64>,
        unit: &str,
        per_si: f64,
    ) -> Result<f64, SceneIoError> {
        let Some(key) = key else { return Ok(default) };
        self.check(*key.get_ref(), key.span(), name, range, unit)?;
        Ok(key.into_inner() / per_si)
    }

    /// A list of numbers whose length is one of `lengths`.
    pub(crate) fn list<'k>(
        &self,
        key: &'k Spanned<Vec<f64>>,
        name: &str,
        lengths: &[usize],
        range: RangeInclusive<f64>,
        unit: &str,
    ) -> Result<&'k [f64], SceneIoError> {
        let numbers = key.get_ref();
        if !lengths.contains(&numbers.len()) {
            let wanted = lengths.iter().map(usize::to_string).collect::<Vec<_>>().join(" or ");
            let message = format!("`{name}` has {} numbers; expected {wanted}", numbers.len());
            return Err(self.error(key.span(), message));
        }
        for &number in numbers {
            self.check(number, key.span(), name, range.clone(), unit)?;
        }
        Ok(numbers)
    }

    /// One of a few words.
    pub(crate) fn word<T: Copy>(
        &self,
        key: &Spanned<String>,
        name: &str,
        words: &[(&str, T)],
    ) -> Result<T, SceneIoError> {
        if let Some((_, value)) = words.iter().find(|(word, _)| word == key.get_ref()) {
            return Ok(*value);
        }
        let known = words.iter().map(|(word, _)| format!("\"{word}\"")).collect::<Vec<_>>().join(", ");
        Err(self.error(key.span(), format!("`{name}` is \"{}\"; expected one of {known}", key.get_ref())))
    }

    /// Columns and rows of a sensor: each in range, and their product too.
    fn cells(
        &self,
        sensor: &str,
        keys: [(&str, Key<i64>); 2],
        defaults: [u32; 2],
        unit: &str,
    ) -> Result<[u32; 2], SceneIoError> {
        let mut sides = defaults;
        let mut place = 0..0;
        let mut names = [""; 2];
        for (axis, (name, key)) in keys.into_iter().enumerate() {
            names[axis] = name;
            let Some(key) = key else { continue };
            place = key.span();
            if !SIDE.contains(key.get_ref()) {
                let (low, high) = (SIDE.start(), SIDE.end());
                let message =
                    format!("`{sensor}.{name}` is {}; expected {low} to {high} {unit}", key.get_ref());
                return Err(self.error(place, message));
            }
            sides[axis] = u32::try_from(key.into_inner()).unwrap_or(u32::MAX);
        }
        let [across, down] = sides;
        if u64::from(across) * u64::from(down) > MOST_CELLS {
            let names = names.join(" x ");
            let message =
                format!("`{sensor}.{names}` is {across} x {down}; expected at most {MOST_CELLS} {unit}");
            return Err(self.error(place, message));
        }
        Ok(sides)
    }
}

/// A number for people: no long rows of zeros.
fn number_text(value: f64) -> String {
    match value.abs() {
        size if size.is_finite() && size != 0.0 && !(1e-4..1e8).contains(&size) => format!("{value:e}"),
        _ => value.to_string(),
    }
}
