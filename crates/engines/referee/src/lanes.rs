//! What of the processor is used that the language does not reach safely: asking memory ahead, and fused operations.

/// Work that gains from fused operations. `run` and all that it calls must be `#[inline(always)]`.
pub(crate) trait Work {
    type Output;

    /// The same result whether operations are fused or not.
    fn run<const FUSED: bool>(self) -> Self::Output;
}

/// Runs `work`, with fused operations where the processor has them.
#[allow(unsafe_code, reason = "code for fused operations is called where the processor was asked for them")]
#[inline]
pub(crate) fn run<W: Work>(work: W) -> W::Output {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("fma") && std::arch::is_x86_feature_detected!("avx2") {
        #[target_feature(enable = "avx2,fma")]
        fn fused<W: Work>(work: W) -> W::Output {
            work.run::<true>()
        }
        // SAFETY: the processor has both.
        return unsafe { fused(work) };
    }
    #[cfg(target_arch = "aarch64")]
    return work.run::<true>();
    #[cfg(not(target_arch = "aarch64"))]
    work.run::<false>()
}

/// Asks memory for a value that will be needed soon, and does not wait for it. Nothing is read.
#[allow(unsafe_code, reason = "a hint to the processor, which reads nothing")]
#[inline(always)]
pub(crate) fn fetch<T>(value: &T) {
    #[cfg(target_arch = "x86_64")]
    {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        const LINE: usize = 64;
        let start = std::ptr::from_ref(value).cast::<i8>();
        for line in 0..size_of::<T>().div_ceil(LINE) {
            // SAFETY: the address lies within the value, and is not read.
            unsafe { _mm_prefetch::<_MM_HINT_T0>(start.wrapping_add(LINE * line)) };
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = value;
}
