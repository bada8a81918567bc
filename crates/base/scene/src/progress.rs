//! Who is told what a long computation is doing.

/// Receives progress messages, from any thread.
pub trait Progress: Sync {
    /// A new stage begins; `what` names it in a few words.
    fn stage(&self, what: &str);
}

/// Discards all progress messages.
#[derive(Debug, Clone, Copy)]
pub struct Silent;

impl Progress for Silent {
    fn stage(&self, _what: &str) {}
}
