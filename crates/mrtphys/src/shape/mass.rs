//! Mass properties of homogeneous bodies.

use crate::math::{Quat, Real, Vec3};

/// Volume and inertia of a homogeneous shape whose centre of mass is the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassProperties {
    /// volume \[m3\]
    pub volume: Real,
    /// principal moments of inertia per mass \[m2\]
    pub moments_per_mass: Vec3,
    /// rotation from the principal axes into the shape's axes
    pub axes: Quat,
}

/// p
pub fn principal(_t: &crate::math::Mat3) -> crate::error::Result<(Vec3, Quat)> {
    unimplemented!()
}
