//! Limits of a scene (thesis, section 6.7): half-space, two-sided plane, limit quadrangle, limit box.

use super::quadrangle::checked_normal;
use super::{MassProperties, Shape, enclosing};
use crate::bounds::{Aabb, Ball, BoundaryBounds, placed_ball};
use crate::error::{Error, Result};
use crate::math::{Mat3, Real, Vec3, max};
use std::sync::Arc;

/// Everything behind a plane through the origin is forbidden.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfSpace {
    pub(crate) normal: Vec3,
}

/// A plane through the origin that reflects from both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LimitPlane {
    pub(crate) normal: Vec3,
}

/// A half-space with a finite face, for bounds. The origin is the centre of the face's smallest enclosing sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LimitQuadrangle {
    pub(crate) normal: Vec3,
    pub(crate) corners: [Vec3; 4],
    pub(crate) ball: Ball,
}

/// A limit perpendicular to the plane of its corners, to this part of the corners' extent.
const PERPENDICULAR: Real = 1e-9;

/// The unit vector, or an error for the zero vector and what is not finite.
fn unit(object: &str, normal: Vec3) -> Result<Vec3> {
    if !normal.is_finite() {
        return Err(Error::NonFinite { object: object.into(), field: "normal" });
    }
    let refuse = || Error::OutOfRange { object: object.into(), field: "normal", value: 0.0, expected: "not zero" };
    normal.try_normalize().ok_or_else(refuse)
}

macro_rules! unbounded {
    ($t:ident, $kind:literal, $side:literal) => {
        impl $t {
            #[doc = concat!("With this normal, of any length, ", $side, ".")]
            ///
            /// # Errors
            /// [`Error::NonFinite`], or [`Error::OutOfRange`] for the zero vector.
            pub fn new(normal: Vec3) -> Result<$t> {
                Ok($t { normal: unit($kind, normal)? })
            }

            #[doc = concat!("Unit normal, ", $side, ".")]
            #[inline]
            pub fn normal(&self) -> Vec3 {
                self.normal
            }
        }

        impl Shape for $t {
            fn kind(&self) -> &'static str {
                $kind
            }
            fn bounding_sphere(&self) -> Ball {
                Ball { center: Vec3::ZERO, radius: Real::INFINITY }
            }
            fn bounding_box(&self, _position: Vec3, _rotation: &Mat3) -> Aabb {
                Aabb::EVERYWHERE
            }
            fn mass_properties(&self) -> Option<MassProperties> {
                None
            }
        }

        impl From<$t> for Arc<dyn Shape> {
            fn from(s: $t) -> Arc<dyn Shape> {
                Arc::new(s)
            }
        }
    };
}
unbounded!(HalfSpace, "half-space", "into the allowed side");
unbounded!(LimitPlane, "plane", "to either side");

impl LimitQuadrangle {
    /// From four corners \[m\] in order round the face and the normal into the allowed side, of any length. Returns the
    /// centre of the corners' smallest enclosing sphere too: the position at which the boundary is placed.
    ///
    /// # Errors
    /// Those of [`Quadrangle::new`](super::Quadrangle::new) for the corners, of [`HalfSpace::new`] for the normal, and
    /// [`Error::OutOfRange`] for a normal that is not perpendicular to the corners' plane (to 10^-9 of their extent).
    pub fn new(points: [Vec3; 4], normal: Vec3) -> Result<(Vec3, LimitQuadrangle)> {
        let object = "limit-quadrangle";
        let normal = unit(object, normal)?;
        checked_normal(object, &points)?;
        let size = super::extent(&points);
        let center = enclosing::smallest_enclosing_sphere(&points).center;
        let corners = points.map(|p| p - center);
        let off = corners.iter().fold(0.0, |m, c| max(m, normal.dot(*c).abs()));
        if off > PERPENDICULAR * size {
            let expected = "a normal perpendicular to the plane of the points: corners off its plane, per extent";
            return Err(Error::OutOfRange { object: object.into(), field: "normal", value: off / size, expected });
        }
        Ok((center, LimitQuadrangle { normal, corners, ball: enclosing::around(&corners, Vec3::ZERO) }))
    }

    /// Unit normal, into the allowed side.
    #[inline]
    pub fn normal(&self) -> Vec3 {
        self.normal
    }

    /// Corners of the face \[m\], about its position.
    #[inline]
    pub fn corners(&self) -> &[Vec3; 4] {
        &self.corners
    }
}

impl Shape for LimitQuadrangle {
    fn kind(&self) -> &'static str {
        "limit-quadrangle"
    }
    /// Of the face, not of what it forbids: [`boundary_bounds`] says what lies behind.
    fn bounding_sphere(&self) -> Ball {
        self.ball
    }
    /// Of the face, flat.
    fn bounding_box(&self, position: Vec3, rotation: &Mat3) -> Aabb {
        Aabb::of_points(self.corners.iter().map(|&c| position + *rotation * c))
    }
    fn mass_properties(&self) -> Option<MassProperties> {
        None
    }
}

impl From<LimitQuadrangle> for Arc<dyn Shape> {
    fn from(s: LimitQuadrangle) -> Arc<dyn Shape> {
        Arc::new(s)
    }
}

/// The six faces of the box between two corners \[m\], normals inward, in the order -x, +x, -y, +y, -z, +z: name, position
/// (centre of the face's smallest enclosing sphere) and face. On the face across an axis, the corners go from the lower
/// corner to the higher along the first of the two other axes, then along the second, then back.
///
/// # Errors
/// [`Error::NonFinite`]; [`Error::OutOfRange`] where `min` is not below `max`, or for sizes that shapes cannot have.
pub fn limit_box(min: Vec3, max: Vec3) -> Result<[(&'static str, Vec3, LimitQuadrangle); 6]> {
    let object = "box limits";
    if !min.is_finite() || !max.is_finite() {
        return Err(Error::NonFinite { object: object.into(), field: "corners" });
    }
    for axis in 0..3 {
        if min[axis] >= max[axis] {
            let field = ["x", "y", "z"][axis];
            let value = max[axis] - min[axis];
            return Err(Error::OutOfRange {
                object: object.into(),
                field,
                value,
                expected: "a minimum below the maximum",
            });
        }
    }
    super::check_points(object, &[min, max])?;
    let face = |axis: usize, high: bool| {
        // the two free axes in ascending order
        let (u, v) = ((axis == 0) as usize, if axis == 2 { 1 } else { 2 });
        let corner = |fu: bool, fv: bool| {
            let mut p = if high { max } else { min };
            p[u] = if fu { max[u] } else { min[u] };
            p[v] = if fv { max[v] } else { min[v] };
            p
        };
        let mut normal = Vec3::ZERO;
        normal[axis] = if high { -1.0 } else { 1.0 };
        let corners = [corner(false, false), corner(true, false), corner(true, true), corner(false, true)];
        LimitQuadrangle::new(corners, normal)
    };
    let named = |name, axis, high| face(axis, high).map(|(position, quadrangle)| (name, position, quadrangle));
    Ok([
        named("-x", 0, false)?,
        named("+x", 0, true)?,
        named("-y", 1, false)?,
        named("+y", 1, true)?,
        named("-z", 2, false)?,
        named("+z", 2, true)?,
    ])
}

/// Bounds of a boundary of this shape, placed at a position \[m\] without rotation: infinite for half-spaces and planes;
/// of the face, and of what lies behind it, for limit quadrangles; those of the shape for everything bounded.
pub fn boundary_bounds(shape: &dyn Shape, position: Vec3) -> BoundaryBounds {
    let rotation = Mat3::IDENTITY;
    let normal = shape
        .downcast::<HalfSpace>()
        .map(|h| h.normal)
        .or_else(|| shape.downcast::<LimitQuadrangle>().map(|q| q.normal));
    BoundaryBounds {
        ball: placed_ball(&shape.bounding_sphere(), position, &rotation),
        face: shape.bounding_box(position, &rotation),
        behind: normal.map(|n| (n, n.dot(position))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normals_are_checked_and_normalized() {
        assert_eq!(HalfSpace::new(Vec3::new(0.0, 2e-200, 0.0)).unwrap().normal(), Vec3::Y);
        assert_eq!(LimitPlane::new(Vec3::new(3.0, 0.0, 4.0)).unwrap().normal(), Vec3::new(0.6, 0.0, 0.8));
        assert!(matches!(HalfSpace::new(Vec3::ZERO), Err(Error::OutOfRange { field: "normal", .. })));
        for bad in [Real::NAN, Real::INFINITY] {
            for axis in 0..3 {
                let mut n = Vec3::new(1.0, 1.0, 1.0);
                n[axis] = bad;
                assert!(matches!(HalfSpace::new(n), Err(Error::NonFinite { .. })));
                assert!(matches!(LimitPlane::new(n), Err(Error::NonFinite { .. })));
            }
        }
        let p = [Vec3::ZERO, Vec3::X, Vec3::X + Vec3::Y, Vec3::Y];
        assert!(LimitQuadrangle::new(p, -Vec3::Z).is_ok());
        assert!(matches!(LimitQuadrangle::new(p, Vec3::new(0.0, 1e-3, 1.0)), Err(Error::OutOfRange { .. })));
        assert!(LimitQuadrangle::new([p[0], p[2], p[1], p[3]], Vec3::Z).is_err());
    }

    #[test]
    fn empty_and_inverted_boxes_are_refused() {
        let one = Vec3::splat(1.0);
        assert!(limit_box(Vec3::ZERO, one).is_ok());
        assert!(matches!(limit_box(Vec3::ZERO, Vec3::new(1.0, 0.0, 1.0)), Err(Error::OutOfRange { field: "y", .. })));
        assert!(matches!(limit_box(one, Vec3::ZERO), Err(Error::OutOfRange { field: "x", .. })));
        assert!(matches!(limit_box(Vec3::ZERO, one * Real::NAN), Err(Error::NonFinite { .. })));
        assert!(limit_box(Vec3::ZERO, one * 1e60).is_err());
    }

    #[test]
    fn bounds_of_boundaries() {
        let at = Vec3::new(0.0, 3.0, 0.0);
        let b = boundary_bounds(&HalfSpace::new(Vec3::Y).unwrap(), at);
        assert_eq!((b.ball.radius, b.face, b.behind), (Real::INFINITY, Aabb::EVERYWHERE, Some((Vec3::Y, 3.0))));
        let b = boundary_bounds(&LimitPlane::new(Vec3::Y).unwrap(), at);
        assert_eq!((b.ball.radius, b.face, b.behind), (Real::INFINITY, Aabb::EVERYWHERE, None));
        let (name, position, q) = limit_box(Vec3::ZERO, Vec3::splat(2.0)).unwrap()[3];
        let b = boundary_bounds(&q, position);
        assert_eq!((name, b.behind), ("+y", Some((-Vec3::Y, -2.0))));
        assert_eq!(b.face, Aabb { min: Vec3::new(0.0, 2.0, 0.0), max: Vec3::splat(2.0) });
        assert_eq!(b.ball.center, Vec3::new(1.0, 2.0, 1.0));
        let b = boundary_bounds(&super::super::Sphere::new(0.5).unwrap(), at);
        assert_eq!((b.ball, b.behind), (Ball { center: at, radius: 0.5 }, None));
        assert_eq!(b.face, Aabb { min: Vec3::new(-0.5, 2.5, -0.5), max: Vec3::new(0.5, 3.5, 0.5) });
    }

    #[test]
    fn kinds() {
        assert_eq!(HalfSpace::new(Vec3::X).unwrap().kind(), "half-space");
        assert_eq!(LimitPlane::new(Vec3::X).unwrap().kind(), "plane");
    }
}
