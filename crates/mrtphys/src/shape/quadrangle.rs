//! The plane quadrangle (thesis, sections 6.6.3 and A.16).

use super::{MassProperties, Shape, enclosing, planar, surface};
use crate::bounds::{Aabb, Ball};
use crate::error::{Error, Result};
use crate::math::{Mat3, Real, Vec3, max};
use std::sync::Arc;

/// A thin plane convex quadrangle; its centre of mass is the origin of its coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct Quadrangle {
    pub(crate) corners: [Vec3; 4],
    pub(crate) normal: Vec3,
    pub(crate) ball: Ball,
    pub(crate) mass: MassProperties,
    pub(crate) author_origin: Vec3,
}

impl Quadrangle {
    /// From four corners \[m\] in order round the quadrangle, either way round: the normal is that from which they are
    /// seen counter-clockwise. Moved so that its area's centroid is the origin.
    ///
    /// # Errors
    /// [`Error::NonFinite`], [`Error::OutOfRange`]; [`Error::Degenerate`] for corners without area;
    /// [`Error::InvalidMesh`] if a corner lies farther than 10^-9 of the extent off the plane of the four, or if the
    /// quadrangle is not strictly convex (corners on a line, one inside the triangle of the others, crossing edges).
    pub fn new(points: [Vec3; 4]) -> Result<Quadrangle> {
        let normal = checked_normal("quadrangle", &points)?;
        let center = plate_centroid(&points, normal);
        let center =
            if center.max_abs() <= 16.0 * Real::EPSILON * super::extent(&points) { Vec3::ZERO } else { center };
        let corners = points.map(|p| p - center);
        let mass = MassProperties::of_tensor(0.0, &plate_inertia(&corners, normal));
        let author_origin = Vec3::ZERO - center;
        Ok(Quadrangle { corners, normal, ball: enclosing::body_ball(&corners), mass, author_origin })
    }

    /// Corners \[m\], counter-clockwise seen against the normal.
    #[inline]
    pub fn corners(&self) -> &[Vec3; 4] {
        &self.corners
    }

    /// Unit normal.
    #[inline]
    pub fn normal(&self) -> Vec3 {
        self.normal
    }
}

/// The unit normal of four corners that form a plane, strictly convex quadrangle.
pub(super) fn checked_normal(object: &str, points: &[Vec3; 4]) -> Result<Vec3> {
    let size = super::check_points(object, points)?;
    let area = planar::area_vector(points);
    let Some(normal) = area.try_normalize().filter(|_| area.max_abs() > 4.0 * Real::EPSILON * size * size) else {
        return Err(Error::Degenerate { object: object.into(), rank: usize::from(size > 0.0) });
    };
    let offset = planar::plane_offset(normal, points);
    let off = points.iter().fold(0.0, |m, p| max(m, (normal.dot(*p) - offset).abs()));
    if off > surface::PLANE_TOLERANCE * size {
        return Err(surface::invalid(
            object,
            None,
            None,
            format!("the corners lie off their plane by up to {off:e} m"),
        ));
    }
    // Four left turns could also wind twice, but not with four corners.
    if !planar::is_strictly_convex(&planar::project(points, normal)) {
        return Err(surface::invalid(object, None, None, "the corners do not form a convex quadrangle"));
    }
    Ok(normal)
}

/// The two triangles of the quadrangle from its first corner: areas (up to a common factor) and corners.
fn halves(p: &[Vec3; 4], normal: Vec3) -> [(Real, [Vec3; 3]); 2] {
    [[p[0], p[1], p[2]], [p[0], p[2], p[3]]].map(|t| ((t[1] - t[0]).cross(t[2] - t[0]).dot(normal), t))
}

/// Centroid of the area: that of the two triangles, weighted by their areas.
fn plate_centroid(p: &[Vec3; 4], normal: Vec3) -> Vec3 {
    let mean = (p[0] + p[1]) * 0.25 + (p[2] + p[3]) * 0.25;
    let (mut area, mut first) = (0.0, Vec3::ZERO);
    for (a, [u, v, w]) in halves(p, normal) {
        area += a;
        first += ((u - mean) + (v - mean) + (w - mean)) * (a / 3.0);
    }
    mean + first / area
}

/// Inertia tensor per mass of the homogeneous plate about the origin, its centroid. For a triangle a, b, c the mean of
/// x x^T is (s s^T + a a^T + b b^T + c c^T)/12, s = a + b + c; J = tr C 1 - C for C the area's mean of it. About the normal
/// it is the sum of the two others, since the plate has no thickness.
fn plate_inertia(p: &[Vec3; 4], normal: Vec3) -> Mat3 {
    let (mut area, mut c) = (0.0, [[0.0; 3]; 3]);
    for (a, [u, v, w]) in halves(p, normal) {
        area += a;
        let s = u + v + w;
        for (i, row) in c.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                *entry += a / 12.0 * (s[i] * s[j] + u[i] * u[j] + v[i] * v[j] + w[i] * w[j]);
            }
        }
    }
    let c = |i: usize, j: usize| c[i][j] / area;
    Mat3::from_columns(
        Vec3::new(c(1, 1) + c(2, 2), -c(0, 1), -c(0, 2)),
        Vec3::new(-c(0, 1), c(2, 2) + c(0, 0), -c(1, 2)),
        Vec3::new(-c(0, 2), -c(1, 2), c(0, 0) + c(1, 1)),
    )
}

impl Shape for Quadrangle {
    fn kind(&self) -> &'static str {
        "quadrangle"
    }
    fn bounding_sphere(&self) -> Ball {
        self.ball
    }
    fn bounding_box(&self, position: Vec3, rotation: &Mat3) -> Aabb {
        Aabb::of_points(self.corners.iter().map(|&c| position + *rotation * c))
    }
    /// Of the homogeneous thin plate. Its volume is zero: its mass must be given by value.
    fn mass_properties(&self) -> Option<MassProperties> {
        Some(self.mass)
    }
    fn volume(&self) -> Real {
        0.0
    }
    fn author_origin(&self) -> Vec3 {
        self.author_origin
    }
}

impl From<Quadrangle> for Arc<dyn Shape> {
    fn from(s: Quadrangle) -> Arc<dyn Shape> {
        Arc::new(s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Quat;

    #[test]
    fn rectangle() {
        let (a, b) = (3.0, 2.0);
        let p = [Vec3::ZERO, Vec3::X * a, Vec3::new(a, b, 0.0), Vec3::Y * b];
        let q = Quadrangle::new(p).unwrap();
        assert_eq!(q.author_origin, Vec3::new(-1.5, -1.0, 0.0));
        assert_eq!(q.normal, Vec3::Z);
        assert_eq!(q.volume(), 0.0);
        let want = Vec3::new(b * b, a * a, a * a + b * b) / 12.0;
        assert!((q.mass.moments_per_mass - want).max_abs() < 1e-15);
        assert_eq!(q.mass.axes, Quat::IDENTITY);
        assert!((q.ball.radius - 0.5 * 13f64.sqrt()).abs() < 1e-14);
        assert_eq!(Quadrangle::new([p[0], p[3], p[2], p[1]]).unwrap().normal, -Vec3::Z);
        let up = Quat::from_axis_angle(Vec3::X, std::f64::consts::FRAC_PI_2).to_matrix();
        let b = q.bounding_box(Vec3::new(1.0, 2.0, 3.0), &up);
        assert!((b.max - b.min - Vec3::new(3.0, 0.0, 2.0)).max_abs() < 1e-15);
    }

    #[test]
    fn trapezium_against_its_closed_form() {
        // parallel sides 4 and 2, height 3: centroid at h/3 (4 + 2*2)/(4 + 2), I about it h^3 (a^2+4ab+b^2)/(36 (a+b)) / A
        let p = [(-2.0, 0.0), (2.0, 0.0), (1.0, 3.0), (-1.0, 3.0)].map(|(x, z)| Vec3::new(x, 5.0, -z));
        let q = Quadrangle::new(p).unwrap();
        assert!((q.author_origin - Vec3::new(0.0, -5.0, 4.0 / 3.0)).max_abs() < 1e-14);
        let ix = 27.0 * (16.0 + 32.0 + 4.0) / (36.0 * 6.0) / 9.0;
        let iz = 3.0 * (4.0f64.powi(3) + 2.0 * 16.0 + 4.0 * 4.0 + 8.0) / 48.0 / 9.0;
        let m = q.mass.moments_per_mass;
        assert!((m.x - ix).abs() < 1e-14, "{m:?} {ix}");
        assert!((m.z - iz).abs() < 1e-14, "{m:?} {iz}");
        assert!((m.y - ix - iz).abs() < 1e-14);
    }

    #[test]
    fn bad_corners_are_refused() {
        let p = [Vec3::ZERO, Vec3::X, Vec3::X + Vec3::Y, Vec3::Y];
        let with = |i: usize, v: Vec3| {
            let mut q = p;
            q[i] = v;
            Quadrangle::new(q)
        };
        assert!(matches!(with(2, Vec3::new(1.0, 1.0, 1e-3)), Err(Error::InvalidMesh { .. })));
        assert!(matches!(with(2, Vec3::new(0.2, 0.2, 0.0)), Err(Error::InvalidMesh { .. })));
        assert!(matches!(with(2, Vec3::new(0.5, 0.5, 0.0)), Err(Error::InvalidMesh { .. })));
        assert!(matches!(
            Quadrangle::new([p[0], p[2], p[1], p[3]]),
            Err(Error::Degenerate { .. } | Error::InvalidMesh { .. })
        ));
        assert!(matches!(with(1, p[0]), Err(Error::InvalidMesh { .. })));
        assert_eq!(Quadrangle::new([p[1]; 4]), Err(Error::Degenerate { object: "quadrangle".into(), rank: 0 }));
        assert!(matches!(with(1, Vec3::X * Real::NAN), Err(Error::NonFinite { .. })));
        assert!(matches!(with(1, Vec3::X * 1e60), Err(Error::OutOfRange { .. })));
    }
}
