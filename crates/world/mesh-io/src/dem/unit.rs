//! Units of length by the codes of EPSG, and the words that name them.

use std::fmt;

/// A unit of length, as a fraction of the metre.
///
/// ```
/// use raypencil_mesh_io::LengthUnit;
///
/// // A US survey foot is 1200/3937 m; its EPSG code says the same as its name.
/// let foot = LengthUnit::parse("ftUS")?;
/// assert_eq!(foot, LengthUnit::parse("9003")?);
/// assert_eq!(foot.to_metres(3937.0), 1200.0);
/// # Ok::<(), String>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LengthUnit {
    /// Its EPSG code; `None`: a unit of the file's own.
    pub code: Option<u16>,
    /// Its name by EPSG.
    pub name: &'static str,
    /// The metre times this, divided by the next, is the unit.
    numerator: f64,
    denominator: f64,
}

/// The unit of heights or depths.
///
/// A minus before the unit stands for depths, as on sea charts: `-ft`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeightUnit {
    /// The unit.
    pub unit: LengthUnit,
    /// Whether the numbers are depths, positive down.
    pub is_depth: bool,
}

pub(super) const METRE: LengthUnit = unit(9001, "metre", 1.0, 1.0);

const fn unit(code: u16, name: &'static str, numerator: f64, denominator: f64) -> LengthUnit {
    LengthUnit { code: Some(code), name, numerator, denominator }
}

/// All units of length of EPSG v11.022 but the deprecated widths of seismic bins: table *Unit of Measure*, factors B and C. The
/// fractions are those factors as whole numbers. 9015 is of GeoTIFF 1.0 alone, and equal to 9030.
pub(super) const UNITS: [LengthUnit; 48] = [
    METRE,
    unit(9002, "foot", 381.0, 1250.0),
    unit(9003, "US survey foot", 1200.0, 3937.0),
    unit(1025, "millimetre", 1.0, 1e3),
    unit(1033, "centimetre", 1.0, 1e2),
    unit(9005, "Clarke's foot", 3_047_972_654.0, 1e10),
    unit(9014, "fathom", 1143.0, 625.0),
    unit(9015, "nautical mile", 1852.0, 1.0),
    unit(9030, "nautical mile", 1852.0, 1.0),
    unit(9031, "German legal metre", 10_000_135_965.0, 1e10),
    unit(9033, "US survey chain", 79_200.0, 3937.0),
    unit(9034, "US survey link", 792.0, 3937.0),
    unit(9035, "US survey mile", 6_336_000.0, 3937.0),
    unit(9036, "kilometre", 1000.0, 1.0),
    unit(9037, "Clarke's yard", 9_143_917_962.0, 1e10),
    unit(9038, "Clarke's chain", 201_166_195_164.0, 1e10),
    unit(9039, "Clarke's link", 201_166_195_164.0, 1e12),
    unit(9040, "British yard (Sears 1922)", 36e6, 39_370_147.0),
    unit(9041, "British foot (Sears 1922)", 12e6, 39_370_147.0),
    unit(9042, "British chain (Sears 1922)", 792e6, 39_370_147.0),
    unit(9043, "British link (Sears 1922)", 7.92e6, 39_370_147.0),
    unit(9050, "British yard (Benoit 1895 A)", 9_143_992.0, 1e7),
    unit(9051, "British foot (Benoit 1895 A)", 9_143_992.0, 3e7),
    unit(9052, "British chain (Benoit 1895 A)", 201_167_824.0, 1e7),
    unit(9053, "British link (Benoit 1895 A)", 201_167_824.0, 1e9),
    unit(9060, "British yard (Benoit 1895 B)", 36e6, 39_370_113.0),
    unit(9061, "British foot (Benoit 1895 B)", 12e6, 39_370_113.0),
    unit(9062, "British chain (Benoit 1895 B)", 792e6, 39_370_113.0),
    unit(9063, "British link (Benoit 1895 B)", 7.92e6, 39_370_113.0),
    unit(9070, "British foot (1865)", 9_144_025.0, 3e7),
    unit(9080, "Indian foot", 12e6, 39_370_142.0),
    unit(9081, "Indian foot (1937)", 30_479_841.0, 1e8),
    unit(9082, "Indian foot (1962)", 3_047_996.0, 1e7),
    unit(9083, "Indian foot (1975)", 3_047_995.0, 1e7),
    unit(9084, "Indian yard", 36e6, 39_370_142.0),
    unit(9085, "Indian yard (1937)", 91_439_523.0, 1e8),
    unit(9086, "Indian yard (1962)", 9_143_988.0, 1e7),
    unit(9087, "Indian yard (1975)", 9_143_985.0, 1e7),
    unit(9093, "Statute mile", 201_168.0, 125.0),
    unit(9094, "Gold Coast foot", 6_378_300.0, 20_926_201.0),
    unit(9095, "British foot (1936)", 3_048_007_491.0, 1e10),
    unit(9096, "yard", 1143.0, 1250.0),
    unit(9097, "chain", 12_573.0, 625.0),
    unit(9098, "link", 12_573.0, 62_500.0),
    unit(9099, "British yard (Sears 1922 truncated)", 914_398.0, 1e6),
    unit(9300, "British foot (Sears 1922 truncated)", 914_398.0, 3e6),
    unit(9301, "British chain (Sears 1922 truncated)", 20_116_756.0, 1e6),
    unit(9302, "British link (Sears 1922 truncated)", 20_116_756.0, 1e8),
];

/// Words for units, as people and programs write them; compared without case, blanks, `-` and `_`. "Feet" alone is none of
/// them: it may be either foot.
const WORDS: [(&str, u16); 38] = [
    ("m", 9001),
    ("metre", 9001),
    ("metres", 9001),
    ("meter", 9001),
    ("meters", 9001),
    ("km", 9036),
    ("kilometre", 9036),
    ("kilometres", 9036),
    ("kilometer", 9036),
    ("kilometers", 9036),
    ("cm", 1033),
    ("centimetre", 1033),
    ("centimetres", 1033),
    ("centimeter", 1033),
    ("centimeters", 1033),
    ("mm", 1025),
    ("millimetre", 1025),
    ("millimetres", 1025),
    ("millimeter", 1025),
    ("millimeters", 1025),
    ("ft", 9002),
    ("foot", 9002),
    ("internationalfoot", 9002),
    ("internationalfeet", 9002),
    ("ftus", 9003),
    ("usft", 9003),
    ("footus", 9003),
    ("usfoot", 9003),
    ("usfeet", 9003),
    ("ussurveyfoot", 9003),
    ("ussurveyfeet", 9003),
    ("yd", 9096),
    ("yard", 9096),
    ("yards", 9096),
    ("mi", 9093),
    ("fathom", 9014),
    ("fathoms", 9014),
    ("indft", 9081),
];

impl LengthUnit {
    /// The unit of an EPSG code, if it is one of length.
    pub(super) fn of_code(code: u16) -> Option<Self> {
        UNITS.into_iter().find(|unit| unit.code == Some(code))
    }

    /// The unit of a word, if the word means one unit alone.
    pub(super) fn of_word(word: &str) -> Option<Self> {
        // A minus before a unit has a meaning of its own, for heights.
        if word.trim_start().starts_with('-') {
            return None;
        }
        let plain: String = word.chars().filter(|letter| !" -_.".contains(*letter)).collect();
        let plain = plain.to_lowercase();
        WORDS.iter().find(|(word, _)| *word == plain).and_then(|(_, code)| Self::of_code(*code))
    }

    /// A unit of so many metres, which has no code.
    pub(super) fn of_size(metres: f64) -> Self {
        Self { code: None, name: "unit of the file's own", numerator: metres, denominator: 1.0 }
    }

    /// The unit of a word or an EPSG code: `m`, `ft`, `ftUS`, `9084`, `EPSG:9084`.
    ///
    /// # Errors
    /// What is expected, if it is none of these.
    pub fn parse(text: &str) -> Result<Self, String> {
        let code = text.trim().strip_prefix("EPSG:").unwrap_or(text.trim());
        let unit = match code.parse() {
            Ok(code) => Self::of_code(code),
            Err(_) => Self::of_word(text),
        };
        let expected = "expected m, km, cm, mm, ft (0.3048 m), ftUS (1200/3937 m), yd, mi, fathom, or the EPSG code \
                        of a unit of length, such as 9084";
        unit.ok_or_else(|| expected.to_string())
    }

    /// A length in this unit, in metres. Metres stay as they are.
    pub fn to_metres(self, length: f64) -> f64 {
        // A product that is exact, as of a float with a small numerator, is rounded once, by the division.
        length * self.numerator / self.denominator
    }

    /// Metres of one unit.
    pub fn metres(self) -> f64 {
        self.to_metres(1.0)
    }

    /// Whether it is the metre, by whatever code.
    pub fn is_metre(self) -> bool {
        self.metres() == 1.0
    }

    /// Whether two units have the same length. CHOICE: to 1e-9 of it, since some writers round a size.
    pub(super) fn is_as_long_as(self, other: Self) -> bool {
        (self.metres() - other.metres()).abs() <= 1e-9 * other.metres()
    }
}

impl fmt::Display for LengthUnit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name)?;
        if let Some(code) = self.code {
            write!(f, " (EPSG:{code})")?;
        }
        if !self.is_metre() {
            write!(f, ", {} m", self.metres())?;
        }
        Ok(())
    }
}

impl HeightUnit {
    /// As [`LengthUnit::parse`]; a minus before the unit stands for depths.
    ///
    /// # Errors
    /// As [`LengthUnit::parse`].
    ///
    /// ```
    /// use raypencil_mesh_io::HeightUnit;
    ///
    /// // A depth of 25 fathoms is a height of -45.72 m.
    /// assert_eq!(HeightUnit::parse("-fathom")?.to_height(25.0), -45.72);
    /// # Ok::<(), String>(())
    /// ```
    pub fn parse(text: &str) -> Result<Self, String> {
        let (unit, is_depth) = match text.trim().strip_prefix('-') {
            Some(unit) => (unit, true),
            None => (text, false),
        };
        match LengthUnit::parse(unit) {
            Ok(unit) => Ok(Self { unit, is_depth }),
            Err(expected) => Err(format!("{expected}; a minus before it for depths")),
        }
    }

    /// A sample as a height, metres.
    pub fn to_height(self, sample: f64) -> f64 {
        let metres = self.unit.to_metres(sample);
        if self.is_depth { -metres } else { metres }
    }
}

#[cfg(test)]
#[path = "../../tests/unit/unit.rs"]
mod tests;
