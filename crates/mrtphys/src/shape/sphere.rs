//! The sphere (thesis, sections 6.6.1 and A.17).

use super::{MassProperties, Shape};
use crate::bounds::{Aabb, Ball};
use crate::error::{Error, Result};
use crate::math::{Mat3, Quat, Real, Vec3};
use std::sync::Arc;

/// A homogeneous sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    radius: Real,
}

impl Sphere {
    /// A sphere of this radius \[m\].
    ///
    /// # Errors
    /// The radius must lie between [`SMALLEST_SIZE`](super::SMALLEST_SIZE) and [`LARGEST_SIZE`](super::LARGEST_SIZE).
    pub fn new(radius: Real) -> Result<Sphere> {
        if !radius.is_finite() {
            return Err(Error::NonFinite { object: "sphere".into(), field: "radius" });
        }
        if !(super::SMALLEST_SIZE..=super::LARGEST_SIZE).contains(&radius) {
            return Err(Error::OutOfRange {
                object: "sphere".into(),
                field: "radius",
                value: radius,
                expected: super::SIZE_RANGE,
            });
        }
        Ok(Sphere { radius })
    }

    /// Radius \[m\].
    #[inline]
    pub fn radius(&self) -> Real {
        self.radius
    }
}

impl Shape for Sphere {
    fn kind(&self) -> &'static str {
        "sphere"
    }

    fn bounding_sphere(&self) -> Ball {
        Ball { center: Vec3::ZERO, radius: self.radius }
    }

    fn bounding_box(&self, position: Vec3, _rotation: &Mat3) -> Aabb {
        Aabb::of_ball(&Ball { center: position, radius: self.radius })
    }

    /// J = 2/5 m r^2 about every axis, equation (24).
    fn mass_properties(&self) -> Option<MassProperties> {
        let r = self.radius;
        Some(MassProperties {
            volume: 4.0 / 3.0 * std::f64::consts::PI * r * r * r,
            moments_per_mass: Vec3::splat(0.4 * r * r),
            axes: Quat::IDENTITY,
        })
    }
}

impl From<Sphere> for Arc<dyn Shape> {
    fn from(s: Sphere) -> Arc<dyn Shape> {
        Arc::new(s)
    }
}
