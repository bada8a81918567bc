//! Where the parts of a document have room.

/// Where a part is printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Room {
    /// Everywhere.
    Everywhere,
    /// On screens only, in place of what a page shows better.
    Screen,
    /// On pages and in Markdown, where there is room.
    Wide,
}

/// Whether a screen, or a page, shows what has this room.
pub(super) fn is_shown(room: Room, on_screen: bool) -> bool {
    match room {
        Room::Everywhere => true,
        Room::Screen => on_screen,
        Room::Wide => !on_screen,
    }
}
