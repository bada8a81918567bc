//! The NaN of cells without a value. Its bits are fixed, so that a pack has the same bytes on every machine.

/// NaN in f64.
pub(crate) const CANONICAL_NAN: f64 = f64::from_bits(0x7ff8_0000_0000_0000);

/// NaN in f32.
pub(crate) const CANONICAL_NAN_F32: f32 = f32::from_bits(0x7fc0_0000);
