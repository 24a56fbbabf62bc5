//! The few matrices that a picture needs, column by column as the shaders want them. Computed in doubles, handed over in
//! singles: coordinates are relative to the point looked at, in units of its distance, whatever the scene's size.

use mrtphys::{Real, Vec3};

/// A matrix of four columns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Matrix(pub [[Real; 4]; 4]);

impl Matrix {
    /// World to eye coordinates (right, up, backward) for orthonormal axes.
    pub fn view(eye: Vec3, right: Vec3, up: Vec3, forward: Vec3) -> Matrix {
        let (r, u, b) = (right, up, -forward);
        Matrix([
            [r.x, u.x, b.x, 0.0],
            [r.y, u.y, b.y, 0.0],
            [r.z, u.z, b.z, 0.0],
            [-r.dot(eye), -u.dot(eye), -b.dot(eye), 1.0],
        ])
    }

    /// Perspective without a far plane, depth 1 at the near plane and 0 at infinity: with floating-point depth this is as
    /// precise far away as it is near.
    pub fn perspective(tan_half_fov: Real, aspect: Real, near: Real) -> Matrix {
        let f = 1.0 / tan_half_fov;
        Matrix([[f / aspect, 0.0, 0.0, 0.0], [0.0, f, 0.0, 0.0], [0.0, 0.0, 0.0, -1.0], [0.0, 0.0, near, 0.0]])
    }

    /// Parallel projection of a cube of eye coordinates about the origin, depth 0 in front to 1 behind.
    pub fn parallel(half: Real) -> Matrix {
        let s = 1.0 / half;
        Matrix([[s, 0.0, 0.0, 0.0], [0.0, s, 0.0, 0.0], [0.0, 0.0, -0.5 * s, 0.0], [0.0, 0.0, 0.5, 1.0]])
    }

    /// The product: `other` is applied first.
    pub fn times(&self, other: &Matrix) -> Matrix {
        let mut out = [[0.0; 4]; 4];
        for (column, o) in out.iter_mut().zip(&other.0) {
            for (row, x) in column.iter_mut().enumerate() {
                *x = (0..4).map(|k| self.0[k][row] * o[k]).sum();
            }
        }
        Matrix(out)
    }

    /// A point's homogeneous image.
    #[cfg(test)]
    pub fn apply(&self, p: Vec3) -> [Real; 4] {
        let v = [p.x, p.y, p.z, 1.0];
        std::array::from_fn(|row| (0..4).map(|k| self.0[k][row] * v[k]).sum())
    }

    /// As the shaders take it.
    pub fn to_f32(self) -> [[f32; 4]; 4] {
        self.0.map(|c| c.map(|x| x as f32))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depth_is_one_at_the_near_plane_and_falls_to_zero() {
        let p = Matrix::perspective(1.0, 2.0, 0.5);
        let depth = |z: Real| {
            let c = p.apply(Vec3::new(0.0, 0.0, -z));
            c[2] / c[3]
        };
        assert_eq!(depth(0.5), 1.0);
        assert!(depth(1.0) > depth(2.0) && depth(1e9) > 0.0);
        // 45 degrees up is the upper edge; twice as far to the side is the right edge.
        let c = p.apply(Vec3::new(6.0, 3.0, -3.0));
        assert_eq!((c[0] / c[3], c[1] / c[3]), (1.0, 1.0));
    }

    #[test]
    fn the_view_puts_the_eye_in_the_origin_and_looks_along_minus_z() {
        let (eye, forward, up) = (Vec3::new(1.0, 2.0, 3.0), Vec3::X, Vec3::Y);
        let v = Matrix::view(eye, forward.cross(up), up, forward);
        assert_eq!(v.apply(eye), [0.0, 0.0, 0.0, 1.0]);
        assert_eq!(v.apply(eye + Vec3::X * 5.0), [0.0, 0.0, -5.0, 1.0]);
        assert_eq!(v.apply(eye + Vec3::Y), [0.0, 1.0, 0.0, 1.0]);
        assert_eq!(v.apply(eye + Vec3::Z), [1.0, 0.0, 0.0, 1.0]);
        let both = Matrix::parallel(5.0).times(&v);
        assert_eq!(both.apply(eye + Vec3::X * 5.0), [0.0, 0.0, 1.0, 1.0]);
    }
}
