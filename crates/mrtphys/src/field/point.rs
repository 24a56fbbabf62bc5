//! Attraction and repulsion by a point: gravitation, magnetism (thesis, section 4.2).

use super::ForceField;
use super::uniform::{finite, finite_vector};
use crate::error::{Error, Result};
use crate::math::{Real, Vec3, powi};

/// The acceleration strength/r^p towards a point. At the point itself, and so near that strength/r^p or the square of the
/// distance leaves the range of numbers, there is no direction to pull in: acceleration and potential are zero there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointField {
    point: Vec3,
    strength: Real,
    exponent: i32,
}

impl PointField {
    /// A field about `point` \[m\] (relative to the carrier's centre of mass, where a body carries it) of `strength`
    /// \[m^(p+1)/s2\], negative: it repels, falling off with the power `exponent`, p from -16 to 16;
    /// negative: it grows with the distance, -1 is a spring.
    ///
    /// [`Error::NonFinite`] for what is not a number, [`Error::OutOfRange`] for another exponent.
    pub fn new(point: Vec3, strength: Real, exponent: i32) -> Result<PointField> {
        finite_vector(point, "point field", "position")?;
        finite(strength, "point field", "strength")?;
        if !(-16..=16).contains(&exponent) {
            return Err(Error::OutOfRange {
                object: "point field".into(),
                field: "exponent",
                value: Real::from(exponent),
                expected: "an integer from -16 to 16",
            });
        }
        Ok(PointField { point, strength, exponent })
    }
}

impl ForceField for PointField {
    fn acceleration(&self, at: Vec3, _mass: Real) -> Vec3 {
        let d = self.point - at;
        let r = d.length();
        let power = powi(r, self.exponent.unsigned_abs());
        let size = if self.exponent >= 0 { self.strength / power } else { self.strength * power };
        let a = d * (size / r);
        if a.is_finite() { a } else { Vec3::ZERO }
    }

    /// -strength/((p - 1) r^(p-1)), the same as strength r^(1-p)/(1-p); strength times the logarithm of r for p = 1.
    fn potential(&self, at: Vec3) -> Option<Real> {
        let r = (at - self.point).length();
        let potential = match self.exponent {
            1 => self.strength * libm::log(r),
            p if p < 1 => self.strength * powi(r, (1 - p).unsigned_abs()) / Real::from(1 - p),
            p => -self.strength / (Real::from(p - 1) * powi(r, (p - 1).unsigned_abs())),
        };
        Some(if potential.is_finite() { potential } else { 0.0 })
    }
}
