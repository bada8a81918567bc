//! Conventions of a recording that may be declared: how it says that nothing is hit, and whether its faces count.

use raypencil_files::Storage;

/// Conventions of a recording that differ from those of `docs/formats/files.md`, as they are declared.
///
/// ```
/// use raypencil_judge::Conventions;
///
/// // The convention of files is +Inf for lengths; 0 is a number like another.
/// assert!(!Conventions::STANDARD.means_miss(0.0));
/// // Declared, it means "no hit"; so does NaN.
/// let zero = Conventions { miss: Some(0.0), ..Conventions::STANDARD };
/// assert!(zero.means_miss(0.0) && !zero.means_miss(1.5));
/// assert!(Conventions { miss: Some(f64::NAN), ..Conventions::STANDARD }.means_miss(f64::NAN));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Conventions {
    /// A number that means "no hit" in every channel of numbers; it may be NaN.
    pub miss: Option<f64>,
    /// Whether the channel of faces is left out.
    pub ignores_faces: bool,
}

impl Conventions {
    /// Those of `docs/formats/files.md`.
    pub const STANDARD: Self = Self { miss: None, ignores_faces: false };

    /// Those that hold for numbers that are stored so. Whole numbers that count steps have been read: the declared number was
    /// one of theirs, and the metres that they became are numbers like others.
    pub fn of_storage(self, storage: Storage) -> Self {
        match storage {
            Storage::Steps(_) => Self { miss: None, ..self },
            _ => self,
        }
    }

    /// Whether a number is the declared one for "no hit".
    pub fn means_miss(&self, number: f64) -> bool {
        // A file of single precision holds it rounded.
        self.miss.is_some_and(|miss| {
            number == miss || number == f64::from(miss as f32) || number.is_nan() && miss.is_nan()
        })
    }
}
