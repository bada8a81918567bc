//! Memory that a reader asks for, on the thread that runs it.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

thread_local! {
    static LIVE: Cell<usize> = const { Cell::new(0) };
    static PEAK: Cell<usize> = const { Cell::new(0) };
}

/// The system's memory, counted for each thread.
struct Counting;

#[global_allocator]
static COUNTING: Counting = Counting;

#[allow(unsafe_code, reason = "an allocator is unsafe to write; this one counts, in tests alone")]
// SAFETY: every request goes to the system's allocator as it is; counting allocates nothing.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // A large request is seen here before it could fail.
        let live = LIVE.get().wrapping_add(layout.size());
        LIVE.set(live);
        PEAK.set(PEAK.get().max(live));
        // SAFETY: as the caller's.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // Memory of another thread may be freed here.
        LIVE.set(LIVE.get().saturating_sub(layout.size()));
        // SAFETY: as the caller's.
        unsafe { System.dealloc(memory, layout) }
    }
}

/// The most bytes that were in use at once during `work`, beyond those before it.
pub(crate) fn peak_bytes<T>(work: impl FnOnce() -> T) -> (T, usize) {
    let before = LIVE.get();
    PEAK.set(before);
    let result = work();
    (result, PEAK.get() - before)
}

#[test]
fn what_is_asked_for_is_counted() {
    let (_, peak) = peak_bytes(|| drop(vec![1_u8; 1000]));
    assert!((1000..2000).contains(&peak), "{peak}");
}
