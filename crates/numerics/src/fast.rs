//! Loops for the machine at hand.

/// Work compiled for the machine's vector instructions: without them each fused multiplication
/// and addition is a call. `work`, and the functions that it calls, must be `#[inline(always)]`;
/// results have the same bits either way.
#[inline(always)]
pub fn fast<T>(work: impl FnOnce() -> T) -> T {
    pulp::Arch::new().dispatch(work)
}
