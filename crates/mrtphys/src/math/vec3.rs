use super::Real;
use std::ops::{Add, AddAssign, Div, Index, IndexMut, Mul, Neg, Sub, SubAssign};

/// A vector of three components.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Vec3 {
    /// first component
    pub x: Real,
    /// second component: up, in scenes
    pub y: Real,
    /// third component
    pub z: Real,
}

impl Vec3 {
    /// The zero vector.
    pub const ZERO: Vec3 = Vec3::new(0.0, 0.0, 0.0);
    /// Unit vector along x.
    pub const X: Vec3 = Vec3::new(1.0, 0.0, 0.0);
    /// Unit vector along y.
    pub const Y: Vec3 = Vec3::new(0.0, 1.0, 0.0);
    /// Unit vector along z.
    pub const Z: Vec3 = Vec3::new(0.0, 0.0, 1.0);

    /// From components.
    #[inline]
    pub const fn new(x: Real, y: Real, z: Real) -> Vec3 {
        Vec3 { x, y, z }
    }

    /// All three components equal.
    #[inline]
    pub const fn splat(s: Real) -> Vec3 {
        Vec3 { x: s, y: s, z: s }
    }

    /// Components as an array.
    #[inline]
    pub const fn to_array(self) -> [Real; 3] {
        [self.x, self.y, self.z]
    }

    /// Scalar product.
    #[inline]
    pub fn dot(self, o: Vec3) -> Real {
        self.x * o.x + self.y * o.y + self.z * o.z
    }

    /// Vector product.
    #[inline]
    pub fn cross(self, o: Vec3) -> Vec3 {
        Vec3::new(self.y * o.z - self.z * o.y, self.z * o.x - self.x * o.z, self.x * o.y - self.y * o.x)
    }

    /// Squared length.
    #[inline]
    pub fn length_squared(self) -> Real {
        self.dot(self)
    }

    /// Length.
    #[inline]
    pub fn length(self) -> Real {
        self.dot(self).sqrt()
    }

    /// Unit vector of the same direction, or `None` for the zero vector and for what is not finite. Components are scaled
    /// by their largest first, so that vectors of any size keep all digits.
    #[inline]
    pub fn try_normalize(self) -> Option<Vec3> {
        let largest = self.max_abs();
        if largest == 0.0 || !self.is_finite() {
            return None;
        }
        // A power of two, so that the scaling itself is exact and a scene scaled by 2^k gives the same unit vector.
        let scaled = self * power_of_two_near(largest);
        Some(scaled / scaled.length())
    }

    /// Largest absolute component.
    #[inline]
    pub fn max_abs(self) -> Real {
        super::max(super::max(self.x.abs(), self.y.abs()), self.z.abs())
    }

    /// Component-wise product.
    #[inline]
    pub fn mul_elements(self, o: Vec3) -> Vec3 {
        Vec3::new(self.x * o.x, self.y * o.y, self.z * o.z)
    }

    /// Component-wise minimum.
    #[inline]
    pub fn min(self, o: Vec3) -> Vec3 {
        Vec3::new(super::min(self.x, o.x), super::min(self.y, o.y), super::min(self.z, o.z))
    }

    /// Component-wise maximum.
    #[inline]
    pub fn max(self, o: Vec3) -> Vec3 {
        Vec3::new(super::max(self.x, o.x), super::max(self.y, o.y), super::max(self.z, o.z))
    }

    /// Component-wise absolute value.
    #[inline]
    pub fn abs(self) -> Vec3 {
        Vec3::new(self.x.abs(), self.y.abs(), self.z.abs())
    }

    /// Whether no component is infinite or NaN.
    #[inline]
    pub fn is_finite(self) -> bool {
        self.x.is_finite() && self.y.is_finite() && self.z.is_finite()
    }

    /// Some unit vector perpendicular to this (unit) vector; the same one every time.
    #[inline]
    pub fn any_perpendicular(self) -> Vec3 {
        let a = self.abs();
        let axis = if a.x <= a.y && a.x <= a.z {
            Vec3::X
        } else if a.y <= a.z {
            Vec3::Y
        } else {
            Vec3::Z
        };
        let p = self.cross(axis);
        p / p.length()
    }
}

/// The reciprocal of the power of two at or below `x` (normal and finite), computed on the exponent: exact.
#[inline]
fn power_of_two_near(x: Real) -> Real {
    let exponent = ((x.to_bits() >> 52) & 0x7ff).clamp(1, 2045);
    Real::from_bits((2046 - exponent) << 52)
}

impl From<[Real; 3]> for Vec3 {
    fn from(a: [Real; 3]) -> Vec3 {
        Vec3::new(a[0], a[1], a[2])
    }
}

impl Index<usize> for Vec3 {
    type Output = Real;
    #[inline]
    fn index(&self, i: usize) -> &Real {
        match i {
            0 => &self.x,
            1 => &self.y,
            _ => &self.z,
        }
    }
}

impl IndexMut<usize> for Vec3 {
    #[inline]
    fn index_mut(&mut self, i: usize) -> &mut Real {
        match i {
            0 => &mut self.x,
            1 => &mut self.y,
            _ => &mut self.z,
        }
    }
}

impl Add for Vec3 {
    type Output = Vec3;
    #[inline]
    fn add(self, o: Vec3) -> Vec3 {
        Vec3::new(self.x + o.x, self.y + o.y, self.z + o.z)
    }
}

impl Sub for Vec3 {
    type Output = Vec3;
    #[inline]
    fn sub(self, o: Vec3) -> Vec3 {
        Vec3::new(self.x - o.x, self.y - o.y, self.z - o.z)
    }
}

impl Neg for Vec3 {
    type Output = Vec3;
    #[inline]
    fn neg(self) -> Vec3 {
        Vec3::new(-self.x, -self.y, -self.z)
    }
}

impl Mul<Real> for Vec3 {
    type Output = Vec3;
    #[inline]
    fn mul(self, s: Real) -> Vec3 {
        Vec3::new(self.x * s, self.y * s, self.z * s)
    }
}

impl Mul<Vec3> for Real {
    type Output = Vec3;
    #[inline]
    fn mul(self, v: Vec3) -> Vec3 {
        v * self
    }
}

impl Div<Real> for Vec3 {
    type Output = Vec3;
    #[inline]
    fn div(self, s: Real) -> Vec3 {
        Vec3::new(self.x / s, self.y / s, self.z / s)
    }
}

impl AddAssign for Vec3 {
    #[inline]
    fn add_assign(&mut self, o: Vec3) {
        *self = *self + o;
    }
}

impl SubAssign for Vec3 {
    #[inline]
    fn sub_assign(&mut self, o: Vec3) {
        *self = *self - o;
    }
}

impl std::iter::Sum for Vec3 {
    fn sum<I: Iterator<Item = Vec3>>(iter: I) -> Vec3 {
        iter.fold(Vec3::ZERO, |a, b| a + b)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normalizing_keeps_all_digits_at_any_size() {
        for k in [-1000, -300, -40, 0, 40, 300, 1000] {
            let s = libm::ldexp(1.0, k);
            let u = (Vec3::new(3.0, -4.0, 12.0) * s).try_normalize().unwrap();
            assert_eq!(u, Vec3::new(3.0 / 13.0, -4.0 / 13.0, 12.0 / 13.0), "2^{k}");
        }
        assert_eq!(Vec3::ZERO.try_normalize(), None);
        assert_eq!(Vec3::new(Real::NAN, 1.0, 0.0).try_normalize(), None);
        assert_eq!(Vec3::new(Real::INFINITY, 1.0, 0.0).try_normalize(), None);
    }
}
