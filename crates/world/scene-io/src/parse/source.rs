//! The text of a scene file, and the readers of its numbers, words and lists.

use serde::de::DeserializeOwned;
use std::ops::{Range, RangeInclusive};
use std::path::Path;
use toml::Spanned;

use raypencil_scene::SceneError;

use crate::original_place::{Origin, origin};
use crate::parse::key::Key;
use crate::parse::plain_words::plain_words;
use crate::scene_error::SceneIoError;
use crate::settings::{ChangedText, Setting};
use crate::toml_problem::TomlProblem;

/// Text of a scene file, to which every error points.
pub(crate) struct Source<'a> {
    pub file: &'a Path,
    /// The text that is read: the file's own, or that with settings in it.
    pub text: &'a str,
    /// The text of the file.
    original: &'a str,
    /// Bytes that settings put into the text; an error there is one of the setting.
    settings: &'a [(Range<usize>, Setting)],
}

impl<'a> Source<'a> {
    /// A file that stands as it is.
    pub(crate) fn unchanged(file: &'a Path, text: &'a str) -> Self {
        Self { file, text, original: text, settings: &[] }
    }

    /// A file of this text, with the settings in it if there are some.
    pub(crate) fn changed(file: &'a Path, original: &'a str, changed: Option<&'a ChangedText>) -> Self {
        match changed {
            None => Self::unchanged(file, original),
            Some(ChangedText { text, places }) => Self { file, text, original, settings: places },
        }
    }

    /// Error at these bytes of the file.
    pub(crate) fn error(&self, span: Range<usize>, message: impl Into<String>) -> SceneIoError {
        let is_in = |place: &Range<usize>| place.start <= span.start && span.start < place.end;
        if let Some((_, setting)) = self.settings.iter().rev().find(|(place, _)| is_in(place)) {
            return setting.refused(message);
        }
        let span = match self.settings {
            [] => span,
            settings => match origin(self.original, self.text, &span) {
                Origin::File(span) => span,
                // Of a table that the file does not have: the setting that made it misses something, or says too much.
                Origin::Made(way) => match settings.iter().rev().find(|(_, setting)| setting.is_within(&way))
                {
                    Some((_, setting)) => return setting.refused(message),
                    None => 0..0,
                },
            },
        };
        SceneIoError::Toml(Box::new(TomlProblem::new(self.file, self.original, span, message)))
    }

    /// Numbers that are in range one by one, but make no rays together.
    pub(crate) fn refused(&self, span: Range<usize>, error: &SceneError) -> SceneIoError {
        let SceneError { field, value, expected } = error;
        self.error(span, format!("`{field}` is {value}; expected {expected}"))
    }

    pub(crate) fn deserialize<T: DeserializeOwned>(&self) -> Result<T, SceneIoError> {
        toml::from_str(self.text)
            .map_err(|error| self.error(error.span().unwrap_or(0..0), plain_words(error.message())))
    }

    /// Refuses a `value` outside `range`, and with it NaN and infinities.
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

    /// Value of a key, in range; `None` if the key is not given.
    pub(crate) fn optional(
        &self,
        key: &Key<f64>,
        name: &str,
        range: RangeInclusive<f64>,
        unit: &str,
    ) -> Result<Option<f64>, SceneIoError> {
        let Some(key) = key else { return Ok(None) };
        self.check(*key.get_ref(), key.span(), name, range, unit)?;
        Ok(Some(*key.get_ref()))
    }

    /// Replaces `slot` by the value of the key, if the key is given.
    pub(crate) fn number(
        &self,
        key: &Key<f64>,
        name: &str,
        slot: &mut f64,
        range: RangeInclusive<f64>,
        unit: &str,
    ) -> Result<(), SceneIoError> {
        self.converted(key, name, slot, range, unit, |value| value)
    }

    /// Replaces `slot` by the value of the key, if the key is given; `si` converts it from `unit` to SI.
    pub(crate) fn converted(
        &self,
        key: &Key<f64>,
        name: &str,
        slot: &mut f64,
        range: RangeInclusive<f64>,
        unit: &str,
        si: impl Fn(f64) -> f64,
    ) -> Result<(), SceneIoError> {
        if let Some(value) = self.optional(key, name, range, unit)? {
            *slot = si(value);
        }
        Ok(())
    }

    /// Replaces `slot` by the integer of the key, if the key is given. All of `range` fits into the slot's type.
    pub(crate) fn integer<T: TryFrom<i64>>(
        &self,
        key: &Key<i64>,
        name: &str,
        slot: &mut T,
        range: RangeInclusive<i64>,
        unit: &str,
    ) -> Result<(), SceneIoError> {
        let Some(key) = key else { return Ok(()) };
        let value = *key.get_ref();
        if !range.contains(&value) {
            let message =
                format!("`{name}` is {value}; expected {} to {} {unit}", range.start(), range.end());
            return Err(self.error(key.span(), message.trim_end()));
        }
        let Ok(value) = T::try_from(value) else { unreachable!("`{name}`: a range within its type") };
        *slot = value;
        Ok(())
    }

    /// List of numbers whose length is one of `lengths`.
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

    /// Value that belongs to the key's word, one of `words`.
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

    /// Replaces `slot` by the value that belongs to the key's word, if the key is given.
    pub(crate) fn choice<T: Copy>(
        &self,
        key: &Key<String>,
        name: &str,
        slot: &mut T,
        words: &[(&str, T)],
    ) -> Result<(), SceneIoError> {
        if let Some(key) = key {
            *slot = self.word(key, name, words)?;
        }
        Ok(())
    }
}

/// Number in words: in powers of ten where decimals would be a long row of zeros.
pub(crate) fn number_text(value: f64) -> String {
    match value.abs() {
        size if size.is_finite() && size != 0.0 && !(1e-4..1e8).contains(&size) => format!("{value:e}"),
        _ => value.to_string(),
    }
}
