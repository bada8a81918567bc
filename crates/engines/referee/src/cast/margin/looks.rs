//! Counts faces that are looked at for places of borders, for the tests.

/// Counts one.
#[inline]
pub(super) fn take_note_of_a_look() {
    #[cfg(test)]
    LOOKS.with(|looks| looks.set(looks.get() + 1));
}

#[cfg(test)]
thread_local! {
    /// Faces that this thread looked at.
    pub(super) static LOOKS: std::cell::Cell<u64> = const { std::cell::Cell::new(0) };
}
