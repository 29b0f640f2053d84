//! Square root in single precision.

/// Correctly rounded square root of a positive number: the FPU's instruction, which the core library does not offer.
///
/// By way of core registers, because the compiler passes no FPU register to assembly on a single-precision FPU: two
/// moves more than a compiler with an intrinsic would need.
#[cfg(target_os = "none")]
#[inline]
pub(super) fn sqrt(x: f32) -> f32 {
    let bits: u32;
    // SAFETY: every target of this name has the FPU. The register it works in is declared; besides that it touches
    // only the exception flags of FPSCR, which Rust does not rely on.
    unsafe {
        core::arch::asm!(
            "vmov s0, {x}",
            "vsqrt.f32 s0, s0",
            "vmov {x}, s0",
            x = inout(reg) x.to_bits() => bits,
            out("s0") _,
            options(pure, nomem, nostack),
        );
    }
    f32::from_bits(bits)
}

/// Correctly rounded square root of a positive number.
#[cfg(not(target_os = "none"))]
#[inline]
pub(super) fn sqrt(x: f32) -> f32 {
    libm::sqrtf(x)
}
