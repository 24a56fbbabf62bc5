//! A swirl of force about an axis.

use super::ForceField;
use super::uniform::{direction, finite, finite_vector};
use crate::error::Result;
use crate::math::{Real, Vec3};

/// Acceleration round an axis, counter-clockwise seen from its tip, inversely proportional to the distance d from it:
/// strength (axis x d)/|d|^2. Zero on the axis. It has no potential: a turn round the axis gains 2 pi strength per mass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VortexField {
    point: Vec3,
    axis: Vec3,
    strength: Real,
}

impl VortexField {
    /// A vortex round the line through `point` \[m\] along `axis` (of any length) with `strength` \[m2/s2\], which is the
    /// acceleration times the distance. [`Error::NonFinite`](crate::Error::NonFinite) for what is not a number,
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) for an axis of no length.
    pub fn new(point: Vec3, axis: Vec3, strength: Real) -> Result<VortexField> {
        finite_vector(point, "vortex field", "point")?;
        finite(strength, "vortex field", "strength")?;
        Ok(VortexField { point, axis: direction(axis, "vortex field")?, strength })
    }
}

impl ForceField for VortexField {
    fn acceleration(&self, at: Vec3, _mass: Real) -> Vec3 {
        swirl(self.axis, at - self.point) * self.strength
    }

    fn potential(&self, _at: Vec3) -> Option<Real> {
        None
    }
}

/// (axis x d)/|d|^2 for the part d of `r` across the unit vector `axis` \[1/m\]; zero on the axis, and where it is no number.
pub(super) fn swirl(axis: Vec3, r: Vec3) -> Vec3 {
    // |axis x r| = |d|, so the cross product serves for both.
    let across = axis.cross(r);
    let swirl = across / across.length_squared();
    if swirl.is_finite() { swirl } else { Vec3::ZERO }
}
