//! Tables that are kept between frames.

use std::sync::{Arc, Mutex, PoisonError};

/// A cached table, if one has been made yet.
pub(crate) type Cached<T> = Mutex<Option<Arc<T>>>;

/// The cached table if it `fits`; else a new one from `make`, which replaces it.
pub(crate) fn cached<T>(
    cache: &Cached<T>,
    fits: impl FnOnce(&T) -> bool,
    make: impl FnOnce() -> T,
) -> Arc<T> {
    // A poisoned lock still holds a complete table: it is stored in one assignment.
    let mut cache = cache.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(table) = cache.as_ref()
        && fits(table)
    {
        return Arc::clone(table);
    }
    let table = Arc::new(make());
    *cache = Some(Arc::clone(&table));
    table
}
