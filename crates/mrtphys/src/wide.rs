//! Loops over all bodies with the widest registers the processor has. They are written once, for every processor, and compiled
//! twice; which one runs is decided when it runs. The bits are the same: nothing is fused, and no sum changes its order.
#![allow(unsafe_code)]

/// A loop worth wide registers. `run` must be marked `#[inline(always)]`: only so it is compiled for them.
pub(crate) trait Loop {
    /// What it returns.
    type Output;

    /// Runs the loop.
    fn run(self) -> Self::Output;
}

/// Runs a loop, with AVX2 where the processor has it.
#[inline]
pub(crate) fn run<L: Loop>(work: L) -> L::Output {
    #[cfg(target_arch = "x86_64")]
    if has_avx2() {
        // SAFETY: the processor has AVX2 and BMI2.
        return unsafe { run_with_avx2(work) };
    }
    work.run()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,bmi2")]
fn run_with_avx2<L: Loop>(work: L) -> L::Output {
    work.run()
}

/// Whether the processor has AVX2 and BMI2. The standard library asks it once.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
pub(crate) fn has_avx2() -> bool {
    std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("bmi2")
}
