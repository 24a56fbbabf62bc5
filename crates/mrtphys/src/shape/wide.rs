//! Numbers of twice the precision, for the few places where a difference of large terms is what matters: the volume of a
//! thin needle that lies askew is 10^-12 of each of its terms.
//!
//! A number is an unevaluated sum of two reals (Dekker, "A floating-point technique for extending the available
//! precision", Numer. Math. 18 (1971), 224-242; Knuth's two-sum). No fused multiply-add: the same bits everywhere.

use crate::math::{Real, Vec3};
use std::ops::{Add, Mul, Sub};

/// `hi + lo`, where `lo` is at most half a unit in the last place of `hi`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Wide {
    hi: Real,
    lo: Real,
}

/// `a + b` and its rounding error (Knuth).
#[inline]
fn two_sum(a: Real, b: Real) -> Wide {
    let hi = a + b;
    let bb = hi - a;
    Wide { hi, lo: (a - (hi - bb)) + (b - bb) }
}

/// `a + b` and its rounding error where `|a| >= |b|` (Dekker).
#[inline]
fn quick_two_sum(a: Real, b: Real) -> Wide {
    let hi = a + b;
    Wide { hi, lo: b - (hi - a) }
}

/// Upper and lower half of the digits (Veltkamp).
#[inline]
fn split(a: Real) -> (Real, Real) {
    let c = 134_217_729.0 * a; // 2^27 + 1
    let hi = c - (c - a);
    (hi, a - hi)
}

/// `a b` and its rounding error (Dekker).
#[inline]
fn two_product(a: Real, b: Real) -> Wide {
    let hi = a * b;
    let ((ah, al), (bh, bl)) = (split(a), split(b));
    Wide { hi, lo: ((ah * bh - hi) + ah * bl + al * bh) + al * bl }
}

impl Wide {
    pub(super) const ZERO: Wide = Wide { hi: 0.0, lo: 0.0 };

    /// `a - b`, exactly.
    #[inline]
    pub(super) fn difference(a: Real, b: Real) -> Wide {
        two_sum(a, -b)
    }

    /// The nearest real.
    #[inline]
    pub(super) fn round(self) -> Real {
        self.hi + self.lo
    }

    /// Divided by a wide number: one step of long division after the first quotient.
    pub(super) fn divide(self, d: Wide) -> Wide {
        let q1 = self.hi / d.hi;
        let r = self - d * Wide::from(q1);
        let q2 = r.hi / d.hi;
        let r = r - d * Wide::from(q2);
        quick_two_sum(q1, q2) + Wide::from(r.hi / d.hi)
    }
}

impl From<Real> for Wide {
    #[inline]
    fn from(a: Real) -> Wide {
        Wide { hi: a, lo: 0.0 }
    }
}

impl Add for Wide {
    type Output = Wide;
    #[inline]
    fn add(self, o: Wide) -> Wide {
        let s = two_sum(self.hi, o.hi);
        let t = two_sum(self.lo, o.lo);
        let s = quick_two_sum(s.hi, s.lo + t.hi);
        quick_two_sum(s.hi, s.lo + t.lo)
    }
}

impl Sub for Wide {
    type Output = Wide;
    #[inline]
    fn sub(self, o: Wide) -> Wide {
        self + Wide { hi: -o.hi, lo: -o.lo }
    }
}

impl Mul for Wide {
    type Output = Wide;
    #[inline]
    fn mul(self, o: Wide) -> Wide {
        let p = two_product(self.hi, o.hi);
        quick_two_sum(p.hi, p.lo + (self.hi * o.lo + self.lo * o.hi))
    }
}

/// `a - b` in each component, exactly.
#[inline]
pub(super) fn difference(a: Vec3, b: Vec3) -> [Wide; 3] {
    [Wide::difference(a.x, b.x), Wide::difference(a.y, b.y), Wide::difference(a.z, b.z)]
}

/// The triple product a . (b x c).
#[inline]
pub(super) fn triple(a: [Wide; 3], b: [Wide; 3], c: [Wide; 3]) -> Wide {
    a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keeps_what_plain_numbers_lose() {
        let (a, b) = (1.0 + Real::EPSILON, 1.0 - Real::EPSILON);
        // (1 + e)(1 - e) - 1 = -e^2, which a plain product rounds away
        let p = Wide::from(a) * Wide::from(b) - Wide::from(1.0);
        assert_eq!(p.round(), -Real::EPSILON * Real::EPSILON);
        let s = Wide::from(1e16) + Wide::from(1.0) - Wide::from(1e16);
        assert_eq!(s.round(), 1.0);
        let third = Wide::from(1.0).divide(Wide::from(3.0));
        let back = third * Wide::from(3.0) - Wide::from(1.0);
        assert!(back.round().abs() < 1e-31);
    }
}
