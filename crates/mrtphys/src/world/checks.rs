//! Checks of what a user fills in: each error names the object and the field.

use crate::def::{InertiaMode, Mass, Surface};
use crate::error::{Error, Result};
use crate::math::{Mat3, Quat, Real, Vec3};
use crate::model::Inertia;
use crate::shape::{self, Shape};

/// The largest coordinate a body may be given \[m\]: squares of distances stay finite.
pub const LARGEST_COORDINATE: Real = 1e150;

pub(super) fn energy_factor(field: &'static str, wanted: Real, present: Real) -> Result<Real> {
    let object = || "body".to_string();
    if !wanted.is_finite() {
        return Err(Error::NonFinite { object: object(), field });
    }
    if wanted < 0.0 {
        return Err(Error::OutOfRange { object: object(), field, value: wanted, expected: "not negative" });
    }
    if present <= 0.0 {
        let expected = "a body that moves, so that there is a direction to scale";
        return Err(Error::OutOfRange { object: object(), field, value: present, expected });
    }
    Ok((wanted / present).sqrt())
}

pub(super) fn check_vector(object: &str, field: &'static str, v: Vec3) -> Result<()> {
    if !v.is_finite() {
        return Err(Error::NonFinite { object: object.into(), field });
    }
    if v.max_abs() > LARGEST_COORDINATE {
        let value = v.max_abs();
        return Err(Error::OutOfRange { object: object.into(), field, value, expected: "at most 1e150 in size" });
    }
    Ok(())
}

/// Angular momentum of a spin, if it is a number.
pub(super) fn checked_spin(object: &str, inertia: &Inertia, orientation: Quat, angular_velocity: Vec3) -> Result<Vec3> {
    let l = inertia.angular_momentum(orientation, angular_velocity);
    if l.is_finite() {
        return Ok(l);
    }
    let (field, value) = ("angular_velocity", angular_velocity.max_abs());
    let expected = "small enough for the angular momentum to be a finite number";
    Err(Error::OutOfRange { object: object.into(), field, value, expected })
}

pub(super) fn checked_orientation(object: &str, q: Quat) -> Result<Quat> {
    if !q.is_finite() {
        return Err(Error::NonFinite { object: object.into(), field: "orientation" });
    }
    // A unit quaternion to round-off is kept bit for bit, so that a state that was written down reads back as it was.
    if (q.dot(q) - 1.0).abs() <= 16.0 * Real::EPSILON {
        return Ok(q);
    }
    q.try_normalize().ok_or(Error::OutOfRange {
        object: object.into(),
        field: "orientation",
        value: 0.0,
        expected: "a quaternion that is not zero",
    })
}

pub(super) fn check_surface(object: &str, s: &Surface) -> Result<()> {
    let check = |field, value: Real, high: Real, expected| {
        if !value.is_finite() {
            return Err(Error::NonFinite { object: object.into(), field });
        }
        if !(0.0..=high).contains(&value) {
            return Err(Error::OutOfRange { object: object.into(), field, value, expected });
        }
        Ok(())
    };
    check("friction", s.friction, 1e6, "0 to 1, or any size up to 1e6 for 'coulomb'")?;
    check("restitution", s.restitution, 1.0, "0 to 1")
}

pub(super) fn mass_value(object: &str, mass: Mass, volume: Real) -> Result<Real> {
    const SMALLEST: Real = 1e-100;
    const LARGEST: Real = 1e100;
    let (field, given, value) = match mass {
        Mass::Infinite => return Ok(Real::INFINITY),
        Mass::Value(m) => ("mass", m, m),
        Mass::Density(d) => ("density", d, d * volume),
    };
    if given.is_nan() || (given.is_infinite() && field == "density") {
        return Err(Error::NonFinite { object: object.into(), field });
    }
    let expected = match mass {
        Mass::Density(_) if volume == 0.0 => "a mass instead: the shape has no volume",
        _ => "positive, giving a mass from 1e-100 to 1e100 kg (a body of infinite mass is a fixed one)",
    };
    if !(SMALLEST..=LARGEST).contains(&value) {
        return Err(Error::OutOfRange { object: object.into(), field, value: given, expected });
    }
    Ok(value)
}

pub(super) fn given_inertia(object: &str, tensor: &Mat3) -> Result<Inertia> {
    let (moments, axes) = shape::mass::principal(tensor).map_err(|e| match e {
        Error::InvalidInertia { reason, .. } => Error::InvalidInertia { object: object.into(), reason },
        other => other,
    })?;
    Ok(Inertia::new(moments, axes))
}

/// The inertia of the homogeneous shape, or the thesis's assumption 3: J = 2/5 m r^2 with the bounding radius, equation (28).
pub(super) fn homogeneous_inertia(object: &str, shape: &dyn Shape, mass: Real, mode: InertiaMode) -> Result<Inertia> {
    let inertia = match (mode, shape.mass_properties()) {
        (InertiaMode::Full, Some(p)) => Inertia::new(p.moments_per_mass * mass, p.axes),
        _ => {
            let r = shape.bounding_sphere().radius;
            Inertia::new(Vec3::splat(0.4 * mass * r * r), Quat::IDENTITY)
        }
    };
    usable(object, inertia)
}

/// Refuses an inertia whose moments or their reciprocals have lost their digits.
pub(super) fn usable(object: &str, inertia: Inertia) -> Result<Inertia> {
    let normal = |m: Real| m.is_normal() && m > 0.0 && (1.0 / m).is_normal();
    if normal(inertia.moments.x) && normal(inertia.moments.y) && normal(inertia.moments.z) {
        return Ok(inertia);
    }
    Err(Error::InvalidInertia { object: object.into(), reason: "a moment is too small or too large to compute with" })
}
