use super::{Mat3, Real, Vec3, sin_cos};
use std::ops::Mul;

/// A unit quaternion x i + y j + z k + w: a rotation from body into world axes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Quat {
    /// coefficient of i
    pub x: Real,
    /// coefficient of j
    pub y: Real,
    /// coefficient of k
    pub z: Real,
    /// real part
    pub w: Real,
}

impl Default for Quat {
    fn default() -> Quat {
        Quat::IDENTITY
    }
}

impl Quat {
    /// No rotation.
    pub const IDENTITY: Quat = Quat { x: 0.0, y: 0.0, z: 0.0, w: 1.0 };

    /// From components, in the order of files: x, y, z, w.
    #[inline]
    pub const fn new(x: Real, y: Real, z: Real, w: Real) -> Quat {
        Quat { x, y, z, w }
    }

    /// Rotation by `angle` \[rad\] about the unit vector `axis`, counter-clockwise seen from its tip (equation 21).
    #[inline]
    pub fn from_axis_angle(axis: Vec3, angle: Real) -> Quat {
        let (s, c) = sin_cos(0.5 * angle);
        Quat::new(axis.x * s, axis.y * s, axis.z * s, c)
    }

    /// Rotation by the vector `v`: about its direction, by its length \[rad\].
    #[inline]
    pub fn from_rotation_vector(v: Vec3) -> Quat {
        let angle = v.length();
        if angle == 0.0 {
            return Quat::IDENTITY;
        }
        let (s, c) = sin_cos(0.5 * angle);
        let k = s / angle;
        Quat::new(v.x * k, v.y * k, v.z * k, c)
    }

    /// The rotation that a proper orthogonal matrix describes (Shepperd's method: the largest component first).
    pub fn from_matrix(m: &Mat3) -> Quat {
        let (m00, m11, m22) = (m.at(0, 0), m.at(1, 1), m.at(2, 2));
        let trace = m00 + m11 + m22;
        let q = if trace > 0.0 {
            let s = (trace + 1.0).sqrt() * 2.0;
            Quat::new(
                (m.at(2, 1) - m.at(1, 2)) / s,
                (m.at(0, 2) - m.at(2, 0)) / s,
                (m.at(1, 0) - m.at(0, 1)) / s,
                0.25 * s,
            )
        } else if m00 >= m11 && m00 >= m22 {
            let s = (1.0 + m00 - m11 - m22).sqrt() * 2.0;
            Quat::new(
                0.25 * s,
                (m.at(0, 1) + m.at(1, 0)) / s,
                (m.at(0, 2) + m.at(2, 0)) / s,
                (m.at(2, 1) - m.at(1, 2)) / s,
            )
        } else if m11 >= m22 {
            let s = (1.0 + m11 - m00 - m22).sqrt() * 2.0;
            Quat::new(
                (m.at(0, 1) + m.at(1, 0)) / s,
                0.25 * s,
                (m.at(1, 2) + m.at(2, 1)) / s,
                (m.at(0, 2) - m.at(2, 0)) / s,
            )
        } else {
            let s = (1.0 + m22 - m00 - m11).sqrt() * 2.0;
            Quat::new(
                (m.at(0, 2) + m.at(2, 0)) / s,
                (m.at(1, 2) + m.at(2, 1)) / s,
                0.25 * s,
                (m.at(1, 0) - m.at(0, 1)) / s,
            )
        };
        q.try_normalize().unwrap_or(Quat::IDENTITY)
    }

    /// The inverse rotation.
    #[inline]
    pub fn conjugate(self) -> Quat {
        Quat::new(-self.x, -self.y, -self.z, self.w)
    }

    /// Scalar product of the two as four-vectors.
    #[inline]
    pub fn dot(self, o: Quat) -> Real {
        self.x * o.x + self.y * o.y + self.z * o.z + self.w * o.w
    }

    /// Whether every component is finite.
    pub fn is_finite(self) -> bool {
        self.x.is_finite() && self.y.is_finite() && self.z.is_finite() && self.w.is_finite()
    }

    /// The unit quaternion of the same direction, or `None` if all components are zero or one is not finite.
    pub fn try_normalize(self) -> Option<Quat> {
        let v = Vec3::new(self.x, self.y, self.z);
        let largest = super::max(v.max_abs(), self.w.abs());
        if largest == 0.0 || !self.is_finite() {
            return None;
        }
        let q = Quat::new(self.x / largest, self.y / largest, self.z / largest, self.w / largest);
        let n = q.dot(q).sqrt();
        Some(Quat::new(q.x / n, q.y / n, q.z / n, q.w / n))
    }

    /// One Newton step back to unit length: exact to round-off after one multiplication of unit quaternions.
    #[inline]
    pub fn renormalize(self) -> Quat {
        let k = 1.5 - 0.5 * self.dot(self);
        Quat::new(self.x * k, self.y * k, self.z * k, self.w * k)
    }

    /// The rotation matrix: its columns are the body axes in world coordinates. Divided by the squared length, so that it
    /// is a rotation to round-off even where the quaternion's length is off by more.
    #[inline]
    pub fn to_matrix(self) -> Mat3 {
        let s = 2.0 / self.dot(self);
        let (xs, ys, zs) = (self.x * s, self.y * s, self.z * s);
        let (wx, wy, wz) = (self.w * xs, self.w * ys, self.w * zs);
        let (xx, xy, xz) = (self.x * xs, self.x * ys, self.x * zs);
        let (yy, yz, zz) = (self.y * ys, self.y * zs, self.z * zs);
        Mat3::from_columns(
            Vec3::new(1.0 - (yy + zz), xy + wz, xz - wy),
            Vec3::new(xy - wz, 1.0 - (xx + zz), yz + wx),
            Vec3::new(xz + wy, yz - wx, 1.0 - (xx + yy)),
        )
    }

    /// Rotates a vector.
    #[inline]
    pub fn rotate(self, v: Vec3) -> Vec3 {
        self.to_matrix() * v
    }
}

impl Mul for Quat {
    type Output = Quat;
    /// First `o`, then `self`.
    #[inline]
    fn mul(self, o: Quat) -> Quat {
        Quat::new(
            self.w * o.x + self.x * o.w + self.y * o.z - self.z * o.y,
            self.w * o.y - self.x * o.z + self.y * o.w + self.z * o.x,
            self.w * o.z + self.x * o.y - self.y * o.x + self.z * o.w,
            self.w * o.w - self.x * o.x - self.y * o.y - self.z * o.z,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn product_is_composition_and_matrix_round_trips() {
        let a = Quat::from_axis_angle(Vec3::new(1.0, 2.0, 3.0).try_normalize().unwrap(), 0.7);
        let b = Quat::from_axis_angle(Vec3::new(-2.0, 0.5, 1.0).try_normalize().unwrap(), 2.9);
        let v = Vec3::new(0.3, -1.0, 2.0);
        let composed = (a * b).rotate(v);
        assert!((composed - a.rotate(b.rotate(v))).length() < 1e-15);
        for q in [a, b, a * b, Quat::IDENTITY, Quat::new(1.0, 0.0, 0.0, 0.0), Quat::new(0.0, 0.0, 1.0, 0.0)] {
            assert!((Quat::from_matrix(&q.to_matrix()).dot(q).abs() - 1.0).abs() < 1e-15);
        }
    }
}
