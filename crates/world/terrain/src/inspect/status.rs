//! What an inspection decides about each face.

/// Result of the inspection for one face.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FaceStatus {
    /// Part of the surface.
    Sound,
    /// Part of the surface, to be turned round.
    Inverted,
    ZeroArea,
    /// Duplicate of a face of lower number: the same corners in the same sense.
    Duplicate,
    DuplicateOfOtherMaterial,
}

impl FaceStatus {
    /// Whether the face belongs to the surface that rays hit.
    pub(crate) fn is_surface(self) -> bool {
        matches!(self, Self::Sound | Self::Inverted)
    }
}
