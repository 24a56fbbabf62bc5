//! Flow primitives: uniform wind, vortex, point suction (thesis, section 4.1).

use super::FlowField;
use super::uniform::{direction, finite, finite_vector};
use super::vortex::swirl;
use crate::error::Result;
use crate::math::{Real, Vec3};
use std::f64::consts::PI;

/// The same velocity everywhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UniformFlow {
    velocity: Vec3,
}

impl UniformFlow {
    /// A wind of this velocity \[m/s\]. [`Error::NonFinite`](crate::Error::NonFinite) for what is not a number.
    pub fn new(velocity: Vec3) -> Result<UniformFlow> {
        finite_vector(velocity, "uniform flow", "velocity")?;
        Ok(UniformFlow { velocity })
    }
}

impl FlowField for UniformFlow {
    fn velocity(&self, _at: Vec3) -> Vec3 {
        self.velocity
    }

    fn uniform(&self) -> Option<Vec3> {
        Some(self.velocity)
    }
}

/// A line vortex: velocity Gamma/(2 pi |d|^2) axis x d at the distance d from the axis; zero on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VortexFlow {
    point: Vec3,
    axis: Vec3,
    circulation: Real,
}

impl VortexFlow {
    /// A vortex round the line through `point` \[m\] along `axis` (of any length) with `circulation` Gamma \[m2/s\].
    /// [`Error::NonFinite`](crate::Error::NonFinite) for what is not a number,
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) for an axis of no length.
    pub fn new(point: Vec3, axis: Vec3, circulation: Real) -> Result<VortexFlow> {
        finite_vector(point, "vortex flow", "point")?;
        finite(circulation, "vortex flow", "circulation")?;
        Ok(VortexFlow { point, axis: direction(axis, "vortex flow")?, circulation })
    }
}

impl FlowField for VortexFlow {
    fn velocity(&self, at: Vec3) -> Vec3 {
        swirl(self.axis, at - self.point) * (self.circulation / (2.0 * PI))
    }
}

/// Suction by a point: velocity S/(4 pi r^2) towards it, so that S flows in through every sphere about it. Zero at the point
/// itself, and so near that the velocity leaves the range of numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SinkFlow {
    point: Vec3,
    strength: Real,
}

impl SinkFlow {
    /// Suction at `point` \[m\] of `strength` S \[m3/s\]; negative: a source. [`Error::NonFinite`](crate::Error::NonFinite)
    /// for what is not a number.
    pub fn new(point: Vec3, strength: Real) -> Result<SinkFlow> {
        finite_vector(point, "sink flow", "point")?;
        finite(strength, "sink flow", "strength")?;
        Ok(SinkFlow { point, strength })
    }
}

impl FlowField for SinkFlow {
    fn velocity(&self, at: Vec3) -> Vec3 {
        let d = self.point - at;
        let rr = d.length_squared();
        let u = d * (self.strength / (4.0 * PI) / rr / rr.sqrt());
        if u.is_finite() { u } else { Vec3::ZERO }
    }
}
