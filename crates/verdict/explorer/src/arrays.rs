//! Arrays of numbers inside an HTML page: turned into bytes that repeat, deflated, and written in base64.
//!
//! A page model names an array by a *reference*, a JSON object: the number of the array, the type and the count of its
//! numbers, and the steps that its reader undoes, in their order. `docs/formats/report-page.md` has the format.

use std::fmt::Write;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use rayon::prelude::*;
use serde_json::{Value, json};

/// Level of deflate, of 0 to 10. From 6 on the arrays of a page shrink by less than 3 %, and time doubles.
const DEFLATE_LEVEL: u8 = 6;

/// Type of the numbers of an array.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    U8,
    U16,
    U32,
    I32,
    F32,
}

impl Kind {
    fn name(self) -> &'static str {
        match self {
            Self::U8 => "u8",
            Self::U16 => "u16",
            Self::U32 => "u32",
            Self::I32 => "i32",
            Self::F32 => "f32",
        }
    }

    fn bytes(self) -> usize {
        match self {
            Self::U8 => 1,
            Self::U16 => 2,
            Self::U32 | Self::I32 | Self::F32 => 4,
        }
    }
}

/// What is done to the bits of an array so that its bytes repeat.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Change {
    /// Nothing: for numbers without an order, such as coordinates.
    None,
    /// The difference to the number before: for numbers that are alike in a row, or that rise.
    Delta,
}

/// An array that was added, for arrays that are nearly the same.
#[derive(Debug, Clone)]
pub struct Packed {
    /// Reference to it, for the page model.
    pub reference: Value,
    bits: Vec<u32>,
}

/// The arrays of one page, in the order of their numbers.
///
/// ```
/// use raypencil_explorer::{Arrays, Change};
///
/// let mut arrays = Arrays::default();
/// let faces = arrays.u32(&[7, 7, 7, 8], Change::Delta);
/// assert_eq!(faces.reference["count"], 4);
/// // The reader takes the planes apart first, and then sums up the differences.
/// assert_eq!(faces.reference["steps"], serde_json::json!(["planes", "delta"]));
/// assert!(arrays.scripts().starts_with(r#"<script type="application/octet-stream" id="array-0">"#));
/// ```
#[derive(Debug, Default)]
pub struct Arrays {
    bytes: Vec<Vec<u8>>,
}

impl Arrays {
    /// Adds bytes as they are.
    pub fn u8(&mut self, values: &[u8]) -> Value {
        self.bytes.push(values.to_vec());
        json!({ "array": self.bytes.len() - 1, "type": Kind::U8.name(), "count": values.len(), "steps": [] })
    }

    /// Adds numbers of 16 bits.
    pub fn u16(&mut self, values: &[u16], change: Change) -> Packed {
        self.add(Kind::U16, values.iter().map(|value| u32::from(*value)).collect(), change)
    }

    /// Adds numbers of 32 bits.
    pub fn u32(&mut self, values: &[u32], change: Change) -> Packed {
        self.add(Kind::U32, values.to_vec(), change)
    }

    /// Adds signed numbers of 32 bits.
    pub fn i32(&mut self, values: &[i32], change: Change) -> Packed {
        self.add(Kind::I32, values.iter().map(|value| value.cast_unsigned()).collect(), change)
    }

    /// Adds numbers in single precision. Their bits come back as they are, those of a NaN too.
    pub fn f32(&mut self, values: &[f32], change: Change) -> Packed {
        self.add(Kind::F32, values.iter().map(|value| value.to_bits()).collect(), change)
    }

    /// Adds numbers of 32 bits that are nearly those of another array: where both are the same nothing is stored.
    ///
    /// # Panics
    /// If the arrays have different counts.
    pub fn u32_beside(&mut self, values: &[u32], other: &Packed) -> Packed {
        self.add_beside(Kind::U32, values.to_vec(), other)
    }

    /// The same in single precision.
    ///
    /// # Panics
    /// If the arrays have different counts.
    pub fn f32_beside(&mut self, values: &[f32], other: &Packed) -> Packed {
        self.add_beside(Kind::F32, values.iter().map(|value| value.to_bits()).collect(), other)
    }

    /// The arrays as elements of a page, each on a line.
    pub fn scripts(&self) -> String {
        let texts: Vec<String> = self
            .bytes
            .par_iter()
            .map(|bytes| STANDARD.encode(miniz_oxide::deflate::compress_to_vec(bytes, DEFLATE_LEVEL)))
            .collect();
        let mut html = String::with_capacity(texts.iter().map(|text| text.len() + 80).sum());
        for (number, text) in texts.iter().enumerate() {
            let _ = writeln!(
                html,
                r#"<script type="application/octet-stream" id="array-{number}">{text}</script>"#
            );
        }
        html
    }

    fn add(&mut self, kind: Kind, bits: Vec<u32>, change: Change) -> Packed {
        let (changed, steps) = match change {
            Change::None => (bits.clone(), json!(["planes"])),
            Change::Delta => (differences(&bits, kind), json!(["planes", "delta"])),
        };
        self.push(kind, &changed, bits, steps)
    }

    fn add_beside(&mut self, kind: Kind, bits: Vec<u32>, other: &Packed) -> Packed {
        assert_eq!(bits.len(), other.bits.len(), "arrays beside each other have the same count");
        let changed: Vec<u32> = bits.iter().zip(&other.bits).map(|(mine, theirs)| mine ^ theirs).collect();
        self.push(kind, &changed, bits, json!(["planes", { "xor": other.reference }]))
    }

    fn push(&mut self, kind: Kind, changed: &[u32], bits: Vec<u32>, steps: Value) -> Packed {
        self.bytes.push(planes(changed, kind.bytes()));
        let reference = json!({
            "array": self.bytes.len() - 1, "type": kind.name(), "count": bits.len(), "steps": steps,
        });
        Packed { reference, bits }
    }
}

/// Each number minus the one before, modulo the size of the type.
fn differences(bits: &[u32], kind: Kind) -> Vec<u32> {
    let mask = if kind.bytes() == 2 { 0xffff } else { u32::MAX };
    let before = std::iter::once(0).chain(bits.iter().copied());
    bits.iter().zip(before).map(|(this, before)| this.wrapping_sub(before) & mask).collect()
}

/// The lowest bytes of all numbers, then all second bytes, and so on.
fn planes(bits: &[u32], bytes: usize) -> Vec<u8> {
    (0..bytes).flat_map(|plane| bits.iter().map(move |bits| (bits >> (8 * plane)) as u8)).collect()
}

#[cfg(test)]
#[path = "../tests/unit/arrays.rs"]
pub(crate) mod tests;
