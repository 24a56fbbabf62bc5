use super::{Real, Vec3};
use std::ops::Mul;

/// A 3 x 3 matrix, stored by columns.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Mat3 {
    /// the columns
    pub c: [Vec3; 3],
}

impl Mat3 {
    /// All zero.
    pub const ZERO: Mat3 = Mat3 { c: [Vec3::ZERO; 3] };
    /// The identity.
    pub const IDENTITY: Mat3 = Mat3 { c: [Vec3::X, Vec3::Y, Vec3::Z] };

    /// From three columns.
    #[inline]
    pub const fn from_columns(a: Vec3, b: Vec3, c: Vec3) -> Mat3 {
        Mat3 { c: [a, b, c] }
    }

    /// A diagonal matrix.
    #[inline]
    pub const fn diagonal(d: Vec3) -> Mat3 {
        Mat3 { c: [Vec3::new(d.x, 0.0, 0.0), Vec3::new(0.0, d.y, 0.0), Vec3::new(0.0, 0.0, d.z)] }
    }

    /// The transpose.
    #[inline]
    pub fn transpose(&self) -> Mat3 {
        let [a, b, c] = self.c;
        Mat3::from_columns(Vec3::new(a.x, b.x, c.x), Vec3::new(a.y, b.y, c.y), Vec3::new(a.z, b.z, c.z))
    }

    /// The transpose times a vector: for a rotation, from world into body axes.
    #[inline]
    pub fn transpose_mul(&self, v: Vec3) -> Vec3 {
        Vec3::new(self.c[0].dot(v), self.c[1].dot(v), self.c[2].dot(v))
    }

    /// `self * diagonal(d) * self^T * v`: a tensor given by its principal values, turned by a rotation.
    #[inline]
    pub fn conjugate_diagonal_mul(&self, d: Vec3, v: Vec3) -> Vec3 {
        *self * self.transpose_mul(v).mul_elements(d)
    }

    /// `self * diagonal(d) * self^T`.
    #[inline]
    pub fn conjugate_diagonal(&self, d: Vec3) -> Mat3 {
        let t = self.transpose();
        let scaled = Mat3::from_columns(self.c[0] * d.x, self.c[1] * d.y, self.c[2] * d.z);
        scaled * t
    }

    /// Determinant.
    #[inline]
    pub fn determinant(&self) -> Real {
        self.c[0].dot(self.c[1].cross(self.c[2]))
    }

    /// Entry in row `i`, column `j`.
    #[inline]
    pub fn at(&self, i: usize, j: usize) -> Real {
        self.c[j][i]
    }

    /// Whether every entry is finite.
    pub fn is_finite(&self) -> bool {
        self.c.iter().all(|c| c.is_finite())
    }
}

impl Mul<Vec3> for Mat3 {
    type Output = Vec3;
    #[inline]
    fn mul(self, v: Vec3) -> Vec3 {
        self.c[0] * v.x + self.c[1] * v.y + self.c[2] * v.z
    }
}

impl Mul<Mat3> for Mat3 {
    type Output = Mat3;
    #[inline]
    fn mul(self, o: Mat3) -> Mat3 {
        Mat3::from_columns(self * o.c[0], self * o.c[1], self * o.c[2])
    }
}
