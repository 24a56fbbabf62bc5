//! Earth gravity (thesis, section 6.2 and appendix A.6).

use super::ForceField;
use super::uniform::finite;
use crate::error::Result;
use crate::math::{Real, Vec3};

/// Gravity near the ground: the acceleration (0, -g, 0) everywhere and for every mass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EarthGravity {
    g: Real,
}

impl EarthGravity {
    /// Standard gravity \[m/s2\], as in the thesis.
    pub const STANDARD: Real = 9.80665;

    /// Gravity of `g` \[m/s2\]; negative: upwards. [`Error::NonFinite`](crate::Error::NonFinite) for what is not a number.
    pub fn new(g: Real) -> Result<EarthGravity> {
        finite(g, "earth gravity", "g")?;
        Ok(EarthGravity { g })
    }

    /// g \[m/s2\].
    pub fn g(&self) -> Real {
        self.g
    }

    /// Sets g \[m/s2\]; errors as [`EarthGravity::new`], and then g stays what it was.
    pub fn set_g(&mut self, g: Real) -> Result<()> {
        *self = EarthGravity::new(g)?;
        Ok(())
    }
}

impl Default for EarthGravity {
    fn default() -> EarthGravity {
        EarthGravity { g: EarthGravity::STANDARD }
    }
}

impl ForceField for EarthGravity {
    fn acceleration(&self, _at: Vec3, _mass: Real) -> Vec3 {
        Vec3::new(0.0, -self.g, 0.0)
    }

    fn potential(&self, at: Vec3) -> Option<Real> {
        Some(self.g * at.y)
    }

    fn uniform(&self) -> Option<Vec3> {
        Some(Vec3::new(0.0, -self.g, 0.0))
    }
}
