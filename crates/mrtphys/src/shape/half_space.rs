//! Limits of a scene (thesis, section 6.7): half-space, two-sided plane, limit quadrangle, limit box.

use super::{MassProperties, Shape};
use crate::bounds::Ball;
use crate::math::{Real, Vec3};

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
/// A half-space with a finite face, for bounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LimitQuadrangle {
    pub(crate) normal: Vec3,
    pub(crate) corners: [Vec3; 4],
    pub(crate) ball: Ball,
}
macro_rules! limit {
    ($t:ty, $kind:literal) => {
        impl $t {
            /// Unit normal, into the allowed side.
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
            fn mass_properties(&self) -> Option<MassProperties> {
                None
            }
        }
    };
}
limit!(HalfSpace, "half-space");
limit!(LimitPlane, "plane");
limit!(LimitQuadrangle, "limit-quadrangle");
/// The six faces of a box in the order -x, +x, -y, +y, -z, +z.
pub fn limit_box(_min: Vec3, _max: Vec3) -> crate::error::Result<[(&'static str, Vec3, LimitQuadrangle); 6]> {
    unimplemented!()
}

/// b
pub fn boundary_bounds(_s: &dyn Shape, _p: Vec3) -> crate::bounds::BoundaryBounds {
    unimplemented!()
}
