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
    /// On pages only.
    Page,
}

/// What a document is printed on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Medium {
    Screen,
    Page,
    Markdown,
}

/// Whether what has this room is shown there.
pub(super) fn is_shown(room: Room, medium: Medium) -> bool {
    match room {
        Room::Everywhere => true,
        Room::Screen => medium == Medium::Screen,
        Room::Wide => medium != Medium::Screen,
        Room::Page => medium == Medium::Page,
    }
}
