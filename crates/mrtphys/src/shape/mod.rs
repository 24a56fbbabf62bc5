//! Shapes: one file each. A shape is geometry in its own coordinates with the centre of mass at the origin; it knows its
//! kind, its bounds and its mass properties. Contacts between shapes are the business of the pair routines.

pub mod mass;
pub mod enclosing;
pub mod hull;
pub mod decompose;
pub mod sphere;
pub mod polyhedron;
pub mod quadrangle;
pub mod half_space;
pub(crate) mod cell;
pub(crate) mod crossing;
pub(crate) mod edges;
pub(crate) mod planar;
pub(crate) mod surface;
pub(crate) mod wide;

pub use enclosing::smallest_enclosing_sphere;
pub use half_space::{HalfSpace, LimitPlane, LimitQuadrangle, boundary_bounds, limit_box};
pub use mass::MassProperties;
pub use polyhedron::Polyhedron;
pub use quadrangle::Quadrangle;
pub use sphere::Sphere;

use crate::bounds::{Aabb, Ball};
use crate::error::{Error, Result};
use crate::math::{Mat3, Real, Vec3};
use std::any::Any;
use std::fmt::Debug;

/// Smallest size of a shape \[m\]: volumes and moments of anything smaller would underflow.
pub const SMALLEST_SIZE: Real = 1e-50;
/// Largest size of a shape \[m\]: volumes and moments of anything larger would overflow.
pub const LARGEST_SIZE: Real = 1e50;
pub(crate) const SIZE_RANGE: &str = "a size from 1e-50 to 1e50 m";

/// The geometry of a body or a boundary. Implement it for a shape of your own, register its kind, and declare pair routines
/// for it: `examples/custom_shape.rs`.
pub trait Shape: Any + Debug + Send + Sync {
    /// Name of the shape's kind, as registered in [`Kinds`](crate::narrow::kinds::Kinds).
    fn kind(&self) -> &'static str;

    /// Smallest enclosing sphere, in the shape's own coordinates; infinite radius: unbounded.
    fn bounding_sphere(&self) -> Ball;

    /// Axis-parallel box of the placed shape, world coordinates. Unless overridden, that of the bounding sphere.
    fn bounding_box(&self, position: Vec3, rotation: &Mat3) -> Aabb {
        let ball = self.bounding_sphere();
        Aabb::of_ball(&Ball { center: position + *rotation * ball.center, radius: ball.radius })
    }

    /// Volume, centre of mass and inertia for density 1; `None` for what has none (a plane). The centre of mass must be the
    /// origin of the shape's coordinates.
    fn mass_properties(&self) -> Option<MassProperties>;

    /// Volume \[m3\]. Unless overridden, that of the mass properties.
    fn volume(&self) -> Real {
        self.mass_properties().map_or(0.0, |m| m.volume)
    }

    /// Where the origin of the author's coordinates lies in the shape's own (whose origin is the centre of mass).
    fn author_origin(&self) -> Vec3 {
        Vec3::ZERO
    }
}

impl dyn Shape {
    /// The shape as its concrete type.
    #[inline]
    pub fn downcast<T: Shape>(&self) -> Option<&T> {
        (self as &dyn Any).downcast_ref::<T>()
    }
}

/// The largest extent of some points along an axis \[m\]; zero for none.
pub(crate) fn extent(points: &[Vec3]) -> Real {
    if points.is_empty() {
        return 0.0;
    }
    let b = Aabb::of_points(points.iter().copied());
    (b.max - b.min).max_abs()
}

/// The power of two at or below `x` (positive and finite): dividing by it is exact, and what is computed from the quotient
/// scales exactly when a scene is scaled by a power of two.
pub(crate) fn power_of_two(x: Real) -> Real {
    libm::ldexp(1.0, libm::ilogb(x))
}

/// That the points are finite, and that their extent and their distance from the author's origin are sizes we can compute
/// with.
pub(crate) fn check_points(object: &str, points: &[Vec3]) -> Result<Real> {
    if !points.iter().all(|p| p.is_finite()) {
        return Err(Error::NonFinite { object: object.into(), field: "points" });
    }
    let size = extent(points);
    let refuse = |field, value| Err(Error::OutOfRange { object: object.into(), field, value, expected: SIZE_RANGE });
    if size > 0.0 && !(SMALLEST_SIZE..=LARGEST_SIZE).contains(&size) {
        return refuse("size", size);
    }
    let distance = points.iter().fold(0.0, |m, p| crate::math::max(m, p.max_abs()));
    if distance > LARGEST_SIZE {
        return refuse("points", distance);
    }
    Ok(size)
}

/// That a length is one we can compute with.
pub(crate) fn check_size(object: &str, field: &'static str, value: Real) -> Result<()> {
    if !value.is_finite() {
        return Err(Error::NonFinite { object: object.into(), field });
    }
    if !(SMALLEST_SIZE..=LARGEST_SIZE).contains(&value) {
        return Err(Error::OutOfRange { object: object.into(), field, value, expected: SIZE_RANGE });
    }
    Ok(())
}
