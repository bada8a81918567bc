//! Values of `candidate.json` that JSON does not have: maps without a key that is there twice, and NaN.

use std::fmt;

use serde::Deserialize;
use serde::de::{Deserializer, Error, MapAccess, Visitor};

/// Maps with their channels, as a note has them. A map that is there twice is refused.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ChannelNames(pub Vec<(String, String)>);

impl<'de> Deserialize<'de> for ChannelNames {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Names;
        impl<'de> Visitor<'de> for Names {
            type Value = ChannelNames;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a map of names of maps and channels")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut access: A) -> Result<ChannelNames, A::Error> {
                let mut names: Vec<(String, String)> = Vec::new();
                while let Some((map, channel)) = access.next_entry::<String, String>()? {
                    if names.iter().any(|(other, _)| *other == map) {
                        return Err(A::Error::custom(format!("{map} is there twice")));
                    }
                    names.push((map, channel));
                }
                Ok(ChannelNames(names))
            }
        }
        deserializer.deserialize_map(Names)
    }
}

/// A number that means "no hit", as a note has it: JSON has no NaN, which is the text `nan`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MissNumber(pub f64);

impl<'de> Deserialize<'de> for MissNumber {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(untagged)]
        enum Written {
            Number(f64),
            Text(String),
        }
        match Written::deserialize(deserializer) {
            Ok(Written::Number(number)) => Ok(Self(number)),
            Ok(Written::Text(text)) if text.eq_ignore_ascii_case("nan") => Ok(Self(f64::NAN)),
            _ => Err(D::Error::custom("miss; expected a number or \"nan\"")),
        }
    }
}
