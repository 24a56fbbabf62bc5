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

pub use half_space::{HalfSpace, LimitPlane, LimitQuadrangle, limit_box};
pub use mass::MassProperties;
pub use polyhedron::Polyhedron;
pub use quadrangle::Quadrangle;
pub use sphere::Sphere;

use crate::bounds::{Aabb, Ball};
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
