//! Values of keys as they stand in the file. Only names and types are checked here.
//!
//! The tables of keys are structs of options, never tagged enums: those lose the place of an error, and with it the
//! caret.

use serde::Deserialize;
use serde::de::{Deserializer, Error, SeqAccess, Visitor};
use std::ops::Range;
use toml::Spanned;

/// Value with its place in the file; `None` if the key is not given.
pub(crate) type Key<T> = Option<Spanned<T>>;

/// Place of a key's value in the file; `None` if the key is not given.
pub(crate) fn span<T>(key: &Key<T>) -> Option<Range<usize>> {
    key.as_ref().map(Spanned::span)
}

/// A number for x, and maybe another one for y: `9` or `[9, 9]`.
#[derive(Clone, Copy)]
pub(crate) struct OneOrPair {
    pub x: f64,
    /// `None`: one number is given.
    pub y: Option<f64>,
}

impl OneOrPair {
    /// Both numbers; one number is that of both axes.
    pub(crate) fn pair(&self) -> [f64; 2] {
        [self.x, self.y.unwrap_or(self.x)]
    }
}

impl<'de> Deserialize<'de> for OneOrPair {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Numbers;
        impl<'de> Visitor<'de> for Numbers {
            type Value = OneOrPair;

            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("a number, or two as [x, y]")
            }

            fn visit_f64<E: Error>(self, value: f64) -> Result<OneOrPair, E> {
                Ok(OneOrPair { x: value, y: None })
            }

            fn visit_i64<E: Error>(self, value: i64) -> Result<OneOrPair, E> {
                Ok(OneOrPair { x: value as f64, y: None })
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<OneOrPair, A::Error> {
                let mut values = [0.0; 2];
                for (index, value) in values.iter_mut().enumerate() {
                    *value = list.next_element()?.ok_or_else(|| Error::invalid_length(index, &self))?;
                }
                match list.next_element::<f64>()? {
                    None => Ok(OneOrPair { x: values[0], y: Some(values[1]) }),
                    Some(_) => Err(Error::invalid_length(3, &self)),
                }
            }
        }
        deserializer.deserialize_any(Numbers)
    }
}

/// A word in quotes, or a number that may stand without: `"none"`, `-9999`.
#[derive(Clone)]
pub(crate) struct Word(pub String);

impl<'de> Deserialize<'de> for Word {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Words;
        impl Visitor<'_> for Words {
            type Value = Word;

            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("a number, or a text in quotes")
            }

            fn visit_f64<E: Error>(self, value: f64) -> Result<Word, E> {
                Ok(Word(value.to_string()))
            }

            fn visit_i64<E: Error>(self, value: i64) -> Result<Word, E> {
                Ok(Word(value.to_string()))
            }

            fn visit_str<E: Error>(self, value: &str) -> Result<Word, E> {
                Ok(Word(value.to_string()))
            }
        }
        deserializer.deserialize_any(Words)
    }
}
