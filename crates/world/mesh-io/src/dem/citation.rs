//! The names of coordinate systems in a GeoTIFF, which people and programs write as they like.

use crate::dem::geo_keys::{GeoKeys, Key};

/// Words that name another unit than the metre. A name that has one of them is in that unit, or its writer thought so. A yard is
/// a place as well.
const OTHER_UNITS: [&str; 22] = [
    "ft",
    "ftus",
    "usft",
    "ftint",
    "ftcla",
    "ftse",
    "ftgc",
    "ftind",
    "foot",
    "feet",
    "footus",
    "usfoot",
    "usfeet",
    "yd",
    "ydcl",
    "ydse",
    "ydind",
    "fathom",
    "fathoms",
    "km",
    "kilometre",
    "kilometres",
];

/// What the names of a file say.
pub(super) struct Citation {
    /// Name of the projected coordinate system.
    pub map: Option<String>,
    /// Name of the vertical one.
    pub vertical: Option<String>,
}

impl Citation {
    /// The names of a file. A compound system has both in one text, joined by a plus.
    pub fn of(keys: &GeoKeys) -> Self {
        let whole = keys.text(Key::CITATION);
        let [first, second] = whole.map_or([None; 2], parts);
        let map = keys.text(Key::PROJECTED_CITATION).filter(|text| !text.starts_with("LUnits"));
        Self {
            map: first.or(map).map(String::from),
            vertical: keys.text(Key::VERTICAL_CITATION).or(second).map(String::from),
        }
    }
}

/// The name of the map and that of the heights in a text that may have both.
fn parts(text: &str) -> [Option<&str>; 2] {
    let at = ["VERTCS[", "VERT_CS[", "VERTCRS["].iter().find_map(|word| text.find(word));
    match (at, text.split_once(" + ")) {
        (Some(at), _) => [Some(&text[..at]), Some(&text[at..])],
        (None, Some((map, vertical))) => [Some(map), Some(vertical)],
        (None, None) => [Some(text), None],
    }
}

/// A word of the text that names another unit than the metre.
pub(super) fn other_unit(text: &str) -> Option<&str> {
    // In well-known text the last unit is that of the axes; ellipsoids may be named after feet as well.
    let upper = text.to_ascii_uppercase();
    let text = match upper.rfind("UNIT[") {
        Some(at) => text[at..].split(']').next().unwrap_or_default(),
        None => text,
    };
    let words = text.split(|letter: char| !letter.is_alphanumeric());
    words.into_iter().find(|word| OTHER_UNITS.contains(&word.to_lowercase().as_str()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_of_other_units_are_found() {
        for (text, word) in [
            ("NAD83 / Texas South Central (ftUS)", Some("ftUS")),
            ("NAD_1983_StatePlane_Texas_South_Central_FIPS_4204_Feet", Some("Feet")),
            ("Poolbeg height (ft(Br36))", Some("ft")),
            ("Projection Name = State Plane\nUnits = us_survey_feet", Some("feet")),
            ("PROJCS[\"A\",SPHEROID[\"Clarke_1880_Intl_Ft\",1,2],UNIT[\"Meter\",1.0]]", None),
            ("PROJCS[\"A\",GEOGCS[\"B\",UNIT[\"Degree\",0.01]],UNIT[\"Foot_US\",0.3048]]", Some("Foot")),
            ("WGS 84 / UTM zone 32N", None),
            ("Left Foothills local grid", None),
            ("LUnits = metre", None),
        ] {
            assert_eq!(other_unit(text), word, "{text}");
        }
    }

    #[test]
    fn a_compound_name_has_two_parts() {
        assert_eq!(parts("A / B (ftUS) + C height"), [Some("A / B (ftUS)"), Some("C height")]);
        assert_eq!(parts("PROJCS[\"A\"],VERTCS[\"B\"]"), [Some("PROJCS[\"A\"],"), Some("VERTCS[\"B\"]")]);
        assert_eq!(parts("A+B"), [Some("A+B"), None]);
    }
}
