//! Work compiled twice: for any processor, and in lanes of four `f64` for those that have them.
//!
//! The two do the same operations in the same order; nothing is fused. So the bits are the same, and a test holds that.

/// The instructions that a renderer may use.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Instructions {
    /// The widest that the processor has and this program knows: AVX2 on x86-64.
    #[default]
    Detected,
    /// Those that every processor of the architecture has.
    Baseline,
}

/// Work whose inner loops gain from wide lanes. `run` and all that it calls must be `#[inline(always)]`.
pub(crate) trait Work {
    type Output;

    fn run(self) -> Self::Output;
}

/// Runs `work` with these instructions.
#[allow(unsafe_code, reason = "code for AVX2 is called where the processor was asked for it")]
pub(crate) fn run<W: Work>(instructions: Instructions, work: W) -> W::Output {
    #[cfg(target_arch = "x86_64")]
    if instructions == Instructions::Detected && std::arch::is_x86_feature_detected!("avx2") {
        #[target_feature(enable = "avx2")]
        fn with_avx2<W: Work>(work: W) -> W::Output {
            work.run()
        }
        // SAFETY: the processor has AVX2.
        return unsafe { with_avx2(work) };
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = instructions;
    work.run()
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
