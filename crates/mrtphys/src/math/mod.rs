//! Numbers, vectors, rotations. Every operation has one fixed order, no fused multiply-add and no platform `libm`, so that
//! the same inputs give the same bits on every machine, and scaling lengths by a power of two scales results exactly.

mod mat3;
mod quat;
mod vec3;

pub use mat3::Mat3;
pub use quat::Quat;
pub use vec3::Vec3;

/// The number type of the whole simulator. Double precision: measured on the target machine, a double-precision sphere gas
/// steps as fast as a single-precision one until it leaves the cache, and energy is exact to 1e-14 instead of 1e-6.
pub type Real = f64;

/// Relative rounding error of one operation on [`Real`]: 2^-53.
pub const ROUNDING: Real = Real::EPSILON / 2.0;

/// Sine and cosine from the portable software library: the platform's own differ in the last bit.
#[inline]
pub fn sin_cos(x: Real) -> (Real, Real) {
    libm::sincos(x)
}

/// `x` raised to a non-negative integer power, by repeated squaring (fixed order).
#[inline]
pub fn powi(x: Real, n: u32) -> Real {
    let (mut base, mut n, mut out) = (x, n, 1.0);
    while n > 0 {
        if n & 1 == 1 {
            out *= base;
        }
        base *= base;
        n >>= 1;
    }
    out
}

/// The larger of two numbers; the second where they compare equal or unordered (`f64::max` may choose either zero).
#[inline]
pub fn max(a: Real, b: Real) -> Real {
    if a > b { a } else { b }
}

/// The smaller of two numbers; the second where they compare equal or unordered.
#[inline]
pub fn min(a: Real, b: Real) -> Real {
    if a < b { a } else { b }
}
