//! Memory that a reader asks for, on the thread that runs it.

/// The most bytes that were in use at once during `work`, beyond those before it.
pub(crate) fn peak_bytes<T>(work: impl FnOnce() -> T) -> (T, usize) {
    let mut result = None;
    let counted = allocation_counter::measure(|| result = Some(work()));
    (result.expect("a result"), usize::try_from(counted.bytes_max).expect("bytes in memory"))
}

#[test]
fn what_is_asked_for_is_counted() {
    let (_, peak) = peak_bytes(|| drop(vec![1_u8; 1000]));
    assert!((1000..2000).contains(&peak), "{peak}");
}
