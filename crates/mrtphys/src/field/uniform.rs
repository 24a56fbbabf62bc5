//! The uniform field.

use super::ForceField;
use crate::error::{Error, Result};
use crate::math::{Real, Vec3};

/// The same acceleration everywhere and for every mass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UniformField {
    acceleration: Vec3,
}

impl UniformField {
    /// A field of this acceleration \[m/s2\]. [`Error::NonFinite`] for what is not a number.
    pub fn new(acceleration: Vec3) -> Result<UniformField> {
        finite_vector(acceleration, "uniform field", "acceleration")?;
        Ok(UniformField { acceleration })
    }
}

impl ForceField for UniformField {
    fn acceleration(&self, _at: Vec3, _mass: Real) -> Vec3 {
        self.acceleration
    }

    fn potential(&self, at: Vec3) -> Option<Real> {
        Some(-self.acceleration.dot(at))
    }

    fn uniform(&self) -> Option<Vec3> {
        Some(self.acceleration)
    }
}

/// The number, if it is finite.
pub(super) fn finite(value: Real, object: &str, field: &'static str) -> Result<Real> {
    if value.is_finite() { Ok(value) } else { Err(Error::NonFinite { object: object.into(), field }) }
}

/// The vector, if it is finite.
pub(super) fn finite_vector(value: Vec3, object: &str, field: &'static str) -> Result<Vec3> {
    if value.is_finite() { Ok(value) } else { Err(Error::NonFinite { object: object.into(), field }) }
}

/// The unit vector along `axis`, which must be finite and not zero.
pub(super) fn direction(axis: Vec3, object: &str) -> Result<Vec3> {
    finite_vector(axis, object, "axis")?;
    axis.try_normalize().ok_or_else(|| Error::OutOfRange {
        object: object.into(),
        field: "axis",
        value: 0.0,
        expected: "a vector that is not zero",
    })
}
