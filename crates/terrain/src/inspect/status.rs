//! The part that each face plays in an inspection.

/// What becomes of a face.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FaceStatus {
    /// It stays.
    Sound,
    /// It stays, the other way round.
    Inverted,
    /// It has no area.
    ZeroArea,
    /// A face of lower number has the same corners in the same sense.
    Duplicate,
    /// The same, and that face is of another material.
    DuplicateOfOtherMaterial,
}

impl FaceStatus {
    /// Whether the face belongs to the surface that rays meet.
    pub(crate) fn is_surface(self) -> bool {
        matches!(self, Self::Sound | Self::Inverted)
    }
}
