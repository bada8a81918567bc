//! The units of a model's map and of its heights, each on its own: what says them, and whether they are known at all.

use raypencil_files::Fault;

use crate::dem::citation::{Citation, other_unit};
use crate::dem::epsg;
use crate::dem::gdal_metadata::GdalMetadata;
use crate::dem::geo_keys::{GeoKeys, Key, USER_DEFINED};
use crate::dem::unit::{HeightUnit, LengthUnit, METRE};

/// What says a unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum UnitSource {
    /// The code of the coordinate system.
    System,
    /// A key or tag for the unit alone.
    Key,
    /// The caller, over what the file says.
    Option,
    /// Nothing: the metre is the default.
    Default,
}

impl UnitSource {
    /// A word for programs: `system`, `key`, `option` or `default`.
    pub fn word(self) -> &'static str {
        match self {
            Self::System => "system",
            Self::Key => "key",
            Self::Option => "option",
            Self::Default => "default",
        }
    }
}

/// The coordinate system of the map, or of the heights.
#[derive(Debug, Clone, PartialEq)]
pub struct AxisSystem {
    /// Its EPSG code, if the file has one.
    pub code: Option<u16>,
    /// Its name: what the file calls it, or EPSG.
    pub name: Option<String>,
    /// The unit of the numbers in the file, and whether they are depths.
    pub unit: HeightUnit,
    /// What says the unit.
    pub source: UnitSource,
}

impl AxisSystem {
    /// Its EPSG code, if it has one and is in metres.
    pub fn metric_code(&self) -> Option<u16> {
        self.code.filter(|_| self.unit.unit == METRE && !self.unit.is_depth)
    }
}

/// Units that the caller gives, over what the file says.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct GivenUnits {
    pub map: Option<LengthUnit>,
    pub heights: Option<HeightUnit>,
}

/// A unit that the file states, with the place that states it.
struct Stated {
    unit: LengthUnit,
    source: UnitSource,
    place: String,
}

/// The coordinate systems of the map and of the heights.
pub(super) fn systems(
    keys: &GeoKeys,
    metadata: &GdalMetadata,
    given: GivenUnits,
) -> Result<[AxisSystem; 2], Fault> {
    refuse_other_models(keys)?;
    let citation = Citation::of(keys);
    let code = keys.short(Key::PROJECTED).filter(|code| *code != USER_DEFINED);
    let compound = code.and_then(epsg::compound);
    let (unit, source) = match given.map {
        Some(unit) => (unit, UnitSource::Option),
        None => map_unit(keys, code, compound, &citation)?,
    };
    let map =
        AxisSystem { code, name: citation.map.clone(), unit: HeightUnit { unit, is_depth: false }, source };
    let heights =
        heights(keys, metadata, given.heights, &citation, compound.map(|[_, vertical]| vertical), &map)?;
    Ok([map, heights])
}

/// Refuses coordinates that are no places on a map.
fn refuse_other_models(keys: &GeoKeys) -> Result<(), Fault> {
    let project = "project the model first (gdalwarp -t_srs)";
    match keys.short(Key::MODEL_TYPE) {
        Some(2) => {
            Err(Key::MODEL_TYPE.fault("2", format!("map coordinates in metres, not degrees: {project}")))
        }
        Some(3) => {
            Err(Key::MODEL_TYPE.fault("3", format!("map coordinates, not geocentric ones: {project}")))
        }
        _ => Ok(()),
    }
}

fn map_unit(
    keys: &GeoKeys,
    code: Option<u16>,
    compound: Option<[u16; 2]>,
    citation: &Citation,
) -> Result<(LengthUnit, UnitSource), Fault> {
    let option = "`--unit` with the unit of the map (`dem_unit` of a scene file)";
    let projected = compound.map_or(code, |[projected, _]| Some(projected));
    if let Some(code) = projected.filter(|code| epsg::is_reversed(*code)) {
        let expected = format!(
            "x to the east and y to the north: project the model (gdalwarp -t_srs), or say {option} if the \
             numbers in the file grow to the east and north"
        );
        return Err(Key::PROJECTED.fault(format!("{code}, whose axes point west or south"), expected));
    }
    let of_system = projected.and_then(epsg::projected).map(|unit| Stated {
        unit,
        source: UnitSource::System,
        place: format!("{} {}", Key::PROJECTED.name(), code.unwrap_or_default()),
    });
    let of_key = unit_of_key(keys, Key::PROJECTED_UNIT, Some(Key::PROJECTED_UNIT_SIZE), option)?;
    let is_unknown = of_system.is_none() && of_key.is_none();
    if let Some(code) = code.filter(|_| is_unknown) {
        let expected = format!("a code of EPSG v11.022 for a map, or {option}");
        return Err(Key::PROJECTED.fault(format!("{code}, whose unit is not known"), expected));
    }
    let names = [citation.map.as_deref(), keys.text(Key::PROJECTED_CITATION)];
    if let Some(stated) = one_unit([of_system, of_key], Key::PROJECTED_UNIT, option)? {
        if stated.unit.is_metre() {
            refuse_other_name(&names, Key::PROJECTED_UNIT, &format!("metres by {}", stated.place), option)?;
        }
        return Ok((stated.unit, stated.source));
    }
    refuse_other_name(&names, Key::PROJECTED_UNIT, "no unit", option)?;
    // The unit of the ellipsoid says nothing about the map, but then it is the metre nearly always.
    match keys.short(Key::GEODETIC_UNIT).and_then(LengthUnit::of_code) {
        Some(unit) if !unit.is_metre() => {
            let found = format!("missing, while {} is {unit}", Key::GEODETIC_UNIT.name());
            return Err(Key::PROJECTED_UNIT.fault(found, format!("the unit of the map, or {option}")));
        }
        _ => {}
    }
    // Of a file that says it is a map, but names no projection and a system in degrees, one of the two is wrong.
    let is_projected =
        [Key::PROJECTED, Key::PROJECTION, Key::TRANSFORM].iter().any(|key| keys.short(*key).is_some());
    if let Some(geodetic) = keys.short(Key::GEODETIC).filter(|_| !is_projected) {
        let model = keys.short(Key::MODEL_TYPE).map_or("missing".into(), |model| match model {
            USER_DEFINED => format!("{USER_DEFINED}, of another kind"),
            model => format!("{model}, without a projection"),
        });
        let found = format!("{model}, while {} is {geodetic}", Key::GEODETIC.name());
        let expected = format!(
            "1, a map, and its projection: if coordinates are degrees, project the model (gdalwarp -t_srs), else say {option}"
        );
        return Err(Key::MODEL_TYPE.fault(found, expected));
    }
    Ok((METRE, UnitSource::Default))
}

/// The coordinate system of the heights. `of_compound` is the code of the vertical part of a compound system.
fn heights(
    keys: &GeoKeys,
    metadata: &GdalMetadata,
    given: Option<HeightUnit>,
    citation: &Citation,
    of_compound: Option<u16>,
    map: &AxisSystem,
) -> Result<AxisSystem, Fault> {
    let code = keys.short(Key::VERTICAL).filter(|code| *code != USER_DEFINED).or(of_compound);
    let known = code.and_then(epsg::vertical);
    let name = citation.vertical.clone().or(known.map(|known| known.name.to_string()));
    let system = |unit, source| AxisSystem { code, name: name.clone(), unit, source };
    if let Some(unit) = given {
        return Ok(system(unit, UnitSource::Option));
    }
    let option = "`--z-unit` with the unit of the heights (`dem_z_unit` of a scene file; a minus before it for depths)";
    if let (Some(code), None) = (code, known) {
        let found = format!("{code}, whose unit and direction are not known");
        return Err(Key::VERTICAL.fault(found, format!("a vertical code of EPSG v11.022, or {option}")));
    }
    let axis = known.and_then(|known| known.unit);
    let of_system = axis.zip(code).map(|(axis, code)| Stated {
        unit: axis.unit,
        source: UnitSource::System,
        place: format!("{} {code}", Key::VERTICAL.name()),
    });
    let of_key = unit_of_key(keys, Key::VERTICAL_UNIT, None, option)?;
    let of_metadata =
        metadata.height_unit(option)?.map(|(unit, place)| Stated { unit, source: UnitSource::Key, place });
    let names = [citation.vertical.as_deref()];
    // A vertical system of the file's own, of which only the name tells the direction.
    if let Some(name) = names[0].filter(|name| axis.is_none() && name.to_lowercase().contains("depth")) {
        return Err(
            Key::VERTICAL_CITATION.fault(format!("{name:?} without a code"), format!("heights, or {option}"))
        );
    }
    let stated = one_unit([of_system, of_key], Key::VERTICAL_UNIT, option)?;
    if let Some(stated) = one_unit([stated, of_metadata], Key::VERTICAL_UNIT, option)? {
        if stated.unit.is_metre() {
            refuse_other_name(&names, Key::VERTICAL_UNIT, &format!("metres by {}", stated.place), option)?;
        }
        let is_depth = axis.is_some_and(|axis| axis.is_depth);
        return Ok(system(HeightUnit { unit: stated.unit, is_depth }, stated.source));
    }
    if let Some(code) = code {
        let found =
            format!("missing, while {} is {code}, which has no unit of its own", Key::VERTICAL.name());
        return Err(Key::VERTICAL_UNIT.fault(found, format!("the unit of the heights, or {option}")));
    }
    refuse_other_name(&names, Key::VERTICAL_UNIT, "no unit", option)?;
    if !map.unit.unit.is_metre() {
        let found = format!("missing, while the map is in another unit than metres: {}", map.unit.unit);
        return Err(Key::VERTICAL_UNIT.fault(found, format!("the unit of the heights, or {option}")));
    }
    Ok(system(HeightUnit { unit: METRE, is_depth: false }, UnitSource::Default))
}

/// The unit that a key states. `size` is the key of the size of a unit of the file's own.
fn unit_of_key(keys: &GeoKeys, key: Key, size: Option<Key>, option: &str) -> Result<Option<Stated>, Fault> {
    let Some(code) = keys.short(key) else { return Ok(None) };
    let stated =
        |unit| Ok(Some(Stated { unit, source: UnitSource::Key, place: format!("{} {code}", key.name()) }));
    if let Some(unit) = LengthUnit::of_code(code) {
        return stated(unit);
    }
    match (code, size.and_then(|size| keys.double(size))) {
        (USER_DEFINED, Some(metres)) if metres > 0.0 && metres.is_finite() => {
            stated(LengthUnit::of_size(metres))
        }
        (USER_DEFINED, size) => {
            let found = match size {
                Some(metres) => format!("a unit of {metres} m"),
                None => "a unit of the file's own, without its size".to_string(),
            };
            Err(key.fault(found, format!("a unit by its EPSG code, or {option}")))
        }
        _ => {
            let found = match code {
                9004 | 9006..=9013 => format!("{code}, a unit of GeoTIFF 1.0, which does not give its size"),
                _ => format!("{code}, which is no unit of length"),
            };
            Err(key.fault(found, format!("the EPSG code of a unit, such as 9001 for metres, or {option}")))
        }
    }
}

/// The unit that several places of the file state, if they agree.
fn one_unit(stated: [Option<Stated>; 2], key: Key, option: &str) -> Result<Option<Stated>, Fault> {
    match stated {
        [Some(first), Some(second)] if !first.unit.is_as_long_as(second.unit) => {
            let found =
                format!("two units: {} by {}, {} by {}", first.unit, first.place, second.unit, second.place);
            Err(key.fault(found, format!("one, or {option}")))
        }
        [first, second] => Ok(first.or(second)),
    }
}

/// Refuses a name that speaks of feet where the file states metres, or nothing.
fn refuse_other_name(names: &[Option<&str>], key: Key, stated: &str, option: &str) -> Result<(), Fault> {
    let found = names.iter().flatten().find_map(|name| Some((name, other_unit(name)?)));
    match found {
        None => Ok(()),
        Some((name, word)) => {
            let found = format!("{stated}, while the name {name:?} says {word:?}");
            Err(key.fault(found, format!("one unit, or {option}")))
        }
    }
}
