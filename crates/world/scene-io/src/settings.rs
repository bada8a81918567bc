//! Keys of a scene file that are given outside of it: `camera.pitch_down_deg=25`.
//!
//! The file's text is changed before it is read, so a setting may be any key of `docs/guide/scene.md`, in the file's
//! units, and is checked as if it stood in the file.

use std::fmt;
use std::ops::Range;
use std::str::FromStr;

use toml_edit::{ArrayOfTables, Document, DocumentMut, InlineTable, Item, Table, TableLike, Value};

use crate::scene_error::SceneIoError;

/// Parts of a key, at most.
const MAX_PARTS: usize = 16;

/// A key of a scene file with its value.
///
/// ```
/// use raypencil_scene_io::{Overrides, Setting, load};
///
/// let settings = vec![Setting::parse("beam.1.thickness_mm=8")?, Setting::parse("camera.pitch_down_deg=25")?];
/// let scene = load("pyramids", &Overrides { settings, ..Overrides::default() })?.scene;
/// assert_eq!(scene.beams()[1].sensor.thickness, 0.008);
/// // Without a number the setting is for every beam.
/// let settings = vec![Setting::parse("beam.thickness_mm=4")?];
/// let scene = load("pyramids", &Overrides { settings, ..Overrides::default() })?.scene;
/// assert!(scene.beams().iter().all(|beam| beam.sensor.thickness == 0.004));
/// # Ok::<(), raypencil_scene_io::SceneIoError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Setting {
    key: String,
    value: String,
    /// Whether it replaces what earlier settings say of the same.
    replaces: bool,
}

impl Setting {
    /// Parses `KEY=VALUE`.
    ///
    /// # Errors
    /// As [`Setting::new`], and a text without `=`.
    pub fn parse(text: &str) -> Result<Self, SceneIoError> {
        match text.split_once('=') {
            Some((key, value)) => Self::new(key.trim(), value.trim()),
            None => Err(SceneIoError::Setting {
                setting: text.into(),
                message: "expected KEY=VALUE, such as camera.pitch_down_deg=25".into(),
            }),
        }
    }

    /// A key with its value as TOML. A value that is no TOML is a text, so texts need no quotes.
    ///
    /// The parts of the key are joined by dots. A number chooses a table of several, from 0: `beam.0.pitch_down_deg`.
    /// Without the number, all of them are set: `beam.pitch_down_deg`.
    ///
    /// # Errors
    /// A key with an empty part, with a character that no key has, or of more than 16 parts.
    pub fn new(key: &str, value: &str) -> Result<Self, SceneIoError> {
        let setting = Self { key: key.into(), value: value.into(), replaces: false };
        let is_plain = |c: char| c.is_ascii_alphanumeric() || "_-".contains(c);
        if key.split('.').any(|part| part.is_empty() || !part.chars().all(is_plain)) {
            return Err(
                setting.refused(format!("`{key}` is no key; expected one such as camera.pitch_down_deg"))
            );
        }
        // A table within a table for each part: the deepest key of a scene has five.
        let parts = key.split('.').count();
        if parts > MAX_PARTS {
            return Err(setting.refused(format!("the key has {parts} parts; expected at most {MAX_PARTS}")));
        }
        Ok(setting)
    }

    /// The same as a later change of a scene that has settings already: where two say the same, this one holds. Without this
    /// such a pair is refused.
    ///
    /// ```
    /// use raypencil_scene_io::{Overrides, Setting, load};
    ///
    /// let settings = vec![Setting::parse("beam.0.thickness_mm=4")?, Setting::parse("beam.thickness_mm=8")?];
    /// let error = load("pyramids", &Overrides { settings: settings.clone(), ..Overrides::default() }).unwrap_err();
    /// assert!(error.to_string().contains("beam.0.thickness_mm=4"), "{error}");
    /// let settings = settings.into_iter().map(Setting::replacing).collect();
    /// let scene = load("pyramids", &Overrides { settings, ..Overrides::default() })?.scene;
    /// assert_eq!(scene.beams()[0].sensor.thickness, 0.008);
    /// # Ok::<(), raypencil_scene_io::SceneIoError>(())
    /// ```
    pub fn replacing(self) -> Self {
        Self { replaces: true, ..self }
    }

    /// Those of several later changes that count: one that a later one overwrites as a whole, or whose place it takes, goes.
    ///
    /// ```
    /// use raypencil_scene_io::Setting;
    ///
    /// let settings = ["beam.0.fan_deg=60", "camera.focal_length_mm=8", "beam.fan_deg=70", "camera.field_of_view_deg=50"];
    /// let settings = settings.into_iter().map(Setting::parse).collect::<Result<Vec<_>, _>>()?;
    /// let left: Vec<String> = Setting::last_of(settings).iter().map(ToString::to_string).collect();
    /// assert_eq!(left, ["beam.fan_deg=70", "camera.field_of_view_deg=50"]);
    /// # Ok::<(), raypencil_scene_io::SceneIoError>(())
    /// ```
    pub fn last_of(settings: Vec<Self>) -> Vec<Self> {
        let covers = |later: &Self, earlier: &Self| {
            meet(&later.parts(), &earlier.parts(), true) || displaces(later, earlier)
        };
        let is_left =
            |index: usize| !settings[index + 1..].iter().any(|later| covers(later, &settings[index]));
        let left: Vec<bool> = (0..settings.len()).map(is_left).collect();
        settings.into_iter().zip(left).filter(|(_, left)| *left).map(|(setting, _)| setting).collect()
    }

    /// Whether both set the same value, one of them perhaps as a part of what the other sets. A number within the one key that
    /// the other does not have chooses a table of those that the other means.
    pub fn overlaps(&self, other: &Self) -> bool {
        meet(&self.parts(), &other.parts(), false)
    }

    /// Whether it sets something within the table that these keys lead to.
    pub(crate) fn is_within(&self, way: &[String]) -> bool {
        let way: Vec<&str> = way.iter().map(String::as_str).collect();
        meet(&way, &self.parts(), false)
    }

    fn parts(&self) -> Vec<&str> {
        self.key.split('.').collect()
    }

    fn toml(&self) -> Value {
        Value::from_str(&self.value).unwrap_or_else(|_| Value::from(self.value.as_str()))
    }

    pub(crate) fn refused(&self, message: impl Into<String>) -> SceneIoError {
        SceneIoError::Setting { setting: self.to_string(), message: message.into() }
    }
}

impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.key, self.value)
    }
}

/// The text of a scene file with the settings in it, and the place of each.
pub(crate) struct ChangedText {
    pub(crate) text: String,
    /// Bytes of key and value, with the setting that put them there.
    pub(crate) places: Vec<(Range<usize>, Setting)>,
}

/// Whether two keys mean the same value, or one of them a part of the other's; with `as_whole` whether the first means all of the
/// second. A number that one of them has where the other has none chooses a table of those that the other means.
fn meet(first: &[&str], second: &[&str], as_whole: bool) -> bool {
    let is_number = |part: &str| index_of(part).is_some();
    match (first, second) {
        ([], _) => true,
        (_, []) => !as_whole,
        ([one, of_first @ ..], [other, of_second @ ..]) if one == other => {
            meet(of_first, of_second, as_whole)
        }
        ([one, of_first @ ..], [other, ..]) if is_number(one) && !is_number(other) => {
            !as_whole && meet(of_first, second, false)
        }
        ([one, ..], [other, of_second @ ..]) if is_number(other) && !is_number(one) => {
            meet(first, of_second, as_whole)
        }
        _ => false,
    }
}

/// Refuses two settings of which one overwrites the other, or a part of it, and two that describe one thing in two ways: the
/// scene would be that of one of them, and whatever tells of the settings would name both.
///
/// # Errors
/// The later of the two, with the earlier.
pub fn refuse_contradictions(settings: &[Setting]) -> Result<(), SceneIoError> {
    for (index, later) in settings.iter().enumerate().filter(|(_, later)| !later.replaces) {
        for earlier in settings[..index].iter().filter(|earlier| *earlier != later) {
            if later.overlaps(earlier) {
                return Err(later.refused(format!("{earlier} sets the same; expected one of the two")));
            }
            if displaces(later, earlier) || displaces(earlier, later) {
                return Err(
                    later.refused(format!("it cannot stand beside {earlier}; expected one of the two"))
                );
            }
        }
    }
    Ok(())
}

/// Whether what the second sets goes where the first is set.
fn displaces(first: &Setting, second: &Setting) -> bool {
    match (first.parts().as_slice(), second.parts().as_slice()) {
        ([table, key, ..], [other_table, other, ..]) => {
            table == other_table
                && key != other
                && displaced(table, key).iter().any(|keys| keys.contains(other))
        }
        _ => false,
    }
}

/// Puts settings into the text of a scene file. Of two settings of one key the last holds, if it
/// [replaces](Setting::replacing).
///
/// # Errors
/// Two settings that contradict one another; a setting that does not fit the tables of the file; a file that is no TOML gives `None`, and its reader says why.
pub(crate) fn changed(text: &str, settings: &[Setting]) -> Result<Option<ChangedText>, SceneIoError> {
    refuse_contradictions(settings)?;
    let Ok(mut document) = DocumentMut::from_str(text) else { return Ok(None) };
    for setting in settings {
        let parts = setting.parts();
        make_room(document.as_table_mut(), &parts);
        set_in_table(document.as_table_mut(), false, &parts, setting)?;
    }
    let text = document.to_string();
    let document = Document::parse(text.as_str()).expect("a document that was written");
    let mut places = Vec::new();
    for setting in settings {
        find_in_table(document.as_table(), &setting.parts(), &mut |place| {
            places.push((place, setting.clone()))
        });
    }
    drop(document);
    Ok(Some(ChangedText { text, places }))
}

/// Text of a scene file with a single ground, and nothing else. `key` is one of `[terrain]`.
pub(crate) fn text_of_ground(key: &str, value: &str) -> String {
    format!("version = 1\n[terrain]\n{key} = {}\n", Value::from(value))
}

/// Makes room for a setting: the default beams, which a file with a beam of its own does not have; and what cannot stand beside
/// a new ground or a new description of the image goes.
fn make_room(root: &mut Table, parts: &[&str]) {
    let [name, key, ..] = parts else { return };
    if *name == "beam" && !root.contains_key("beam") {
        let mut beams = ArrayOfTables::new();
        for _ in raypencil_scene::rig::DEFAULT_BEAM_MOUNTS {
            beams.push(Table::new());
        }
        root.insert("beam", Item::ArrayOfTables(beams));
    }
    if let Some(table) = root.get_mut(name).and_then(Item::as_table_like_mut) {
        for other in displaced(name, key).into_iter().flatten().filter(|other| **other != *key) {
            table.remove(other);
        }
    }
}

/// Keys of a table that go when this one of it is set.
fn displaced(table: &str, key: &str) -> [&'static [&'static str]; 3] {
    match table {
        "terrain" => displaced_by_ground(key),
        "camera" => displaced_by_image(key),
        _ => [&[]; 3],
    }
}

/// Keys of `[terrain]` that go when one of them says what the ground is.
fn displaced_by_ground(key: &str) -> [&'static [&'static str]; 3] {
    let grounds = &["builtin", "file", "dem", "generate"];
    let of_file = &["up", "scale"];
    let of_dem = &["dem_window_m", "dem_max_error_m", "dem_nodata", "dem_unit", "dem_z_unit"];
    match key {
        // Axes and unit of a file hold for the next one, such as each terrain of a campaign under one rig.
        "file" => [grounds, &[], of_dem],
        "dem" => [grounds, of_file, &[]],
        "builtin" | "generate" => [grounds, of_file, of_dem],
        _ => [&[]; 3],
    }
}

/// Keys of `[camera]` that go when one of them says how the image is made.
fn displaced_by_image(key: &str) -> [&'static [&'static str]; 3] {
    let ways = &["focal_length_mm", "field_of_view_deg", "intrinsics_px", "camera_info"];
    let of_calibration = &["camera_info_rectified"];
    match key {
        "focal_length_mm" => [ways, of_calibration, &[]],
        "field_of_view_deg" | "intrinsics_px" => [ways, of_calibration, &["principal_point_px"]],
        "camera_info" => [ways, &["width_px", "height_px"], &["principal_point_px"]],
        _ => [&[]; 3],
    }
}

fn set_in_table(
    table: &mut dyn TableLike,
    is_inline: bool,
    parts: &[&str],
    setting: &Setting,
) -> Result<(), SceneIoError> {
    let [part, rest @ ..] = parts else { return Ok(()) };
    if rest.is_empty() {
        // The old value goes with its comment.
        table.insert(part, Item::Value(setting.toml()));
        return Ok(());
    }
    if !table.contains_key(part) {
        if index_of(rest[0]).is_some() {
            let whole = setting.key.strip_suffix(&format!(".{}", rest.join("."))).unwrap_or(part);
            return Err(setting.refused(format!(
                "`{whole}` is not in the scene, so that it has no `{}`; expected the whole of it: {whole}=[...]",
                rest[0]
            )));
        }
        let new = if is_inline { Item::Value(InlineTable::new().into()) } else { Item::Table(Table::new()) };
        table.insert(part, new);
    }
    set_in_item(table.get_mut(part).expect("it was put there"), part, rest, setting)
}

fn set_in_item(item: &mut Item, name: &str, rest: &[&str], setting: &Setting) -> Result<(), SceneIoError> {
    match item {
        Item::Table(table) => set_in_table(table, false, rest, setting),
        Item::ArrayOfTables(tables) => {
            let (chosen, rest) = chosen(tables.len(), name, rest, setting)?;
            for index in chosen {
                let table = tables.get_mut(index).expect("an index below their number");
                match (rest, setting.toml()) {
                    ([], Value::InlineTable(whole)) => *table = whole.into_table(),
                    ([], value) => {
                        let value = value.to_string();
                        return Err(setting.refused(format!(
                            "`{name}.{index}` is {}; expected a table of keys, {{ ... }}",
                            value.trim()
                        )));
                    }
                    _ => set_in_table(table, false, rest, setting)?,
                }
            }
            Ok(())
        }
        Item::Value(Value::InlineTable(table)) => set_in_table(table, true, rest, setting),
        Item::Value(Value::Array(values)) => {
            let (chosen, rest) = chosen(values.len(), name, rest, setting)?;
            for index in chosen {
                let value = values.get_mut(index).expect("an index below their number");
                match (value, rest) {
                    (value, []) => *value = setting.toml(),
                    (Value::InlineTable(table), rest) => set_in_table(table, true, rest, setting)?,
                    (value, _) => return Err(no_table(name, &value.to_string(), setting)),
                }
            }
            Ok(())
        }
        Item::Value(value) => Err(no_table(name, &value.to_string(), setting)),
        Item::None => Ok(()),
    }
}

/// The number of a table in its list, by a part of a key. One place has one name: `00` is none.
fn index_of(part: &str) -> Option<usize> {
    part.parse::<usize>().ok().filter(|index| index.to_string() == part)
}

/// Indices of the elements that a key means, and the rest of the key.
fn chosen<'a>(
    count: usize,
    name: &str,
    rest: &'a [&'a str],
    setting: &Setting,
) -> Result<(Range<usize>, &'a [&'a str]), SceneIoError> {
    let Some(index) = rest.first().and_then(|part| index_of(part)) else { return Ok((0..count, rest)) };
    if index >= count {
        return Err(setting.refused(format!(
            "`{name}.{index}` is not there; expected 0 to {}, for the scene has {count}",
            count.saturating_sub(1)
        )));
    }
    Ok((index..index + 1, &rest[1..]))
}

fn no_table(name: &str, value: &str, setting: &Setting) -> SceneIoError {
    setting.refused(format!("`{name}` is {} in the scene; expected a table that has keys", value.trim()))
}

fn find_in_table(table: &dyn TableLike, parts: &[&str], found: &mut dyn FnMut(Range<usize>)) {
    let [part, rest @ ..] = parts else { return };
    let Some((key, item)) = table.get_key_value(part) else { return };
    if !rest.is_empty() {
        return find_in_item(item, rest, found);
    }
    if let (Some(key), Some(value)) = (key.span(), item.span()) {
        found(key.start..value.end);
    }
}

fn find_in_item(item: &Item, rest: &[&str], found: &mut dyn FnMut(Range<usize>)) {
    let index = rest.first().and_then(|part| index_of(part));
    let is_chosen = |at: usize| index.is_none_or(|index| index == at);
    let rest = if index.is_some() { &rest[1..] } else { rest };
    match item {
        Item::Table(table) => find_in_table(table, rest, found),
        Item::Value(Value::InlineTable(table)) => find_in_table(table, rest, found),
        Item::ArrayOfTables(tables) => {
            for (_, table) in tables.iter().enumerate().filter(|(at, _)| is_chosen(*at)) {
                find_in_table(table, rest, found);
            }
        }
        Item::Value(Value::Array(values)) => {
            for (_, value) in values.iter().enumerate().filter(|(at, _)| is_chosen(*at)) {
                match (value, rest) {
                    (value, []) => value.span().into_iter().for_each(&mut *found),
                    (Value::InlineTable(table), rest) => find_in_table(table, rest, found),
                    _ => {}
                }
            }
        }
        _ => {}
    }
}
