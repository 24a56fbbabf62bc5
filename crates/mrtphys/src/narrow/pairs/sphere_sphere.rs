//! Two spheres, or whatever is taken as its bounding sphere (thesis, section 6.3.6). Exact for spheres.

use crate::bounds::Ball;
use crate::math::{Real, Vec3, max};
use crate::narrow::{Placed, Touches};

/// How two balls touch.
pub(crate) struct Meeting {
    /// from the first centre to the second
    pub normal: Vec3,
    /// the point of the first ball that is deepest in the second \[m\]
    pub p1: Vec3,
    /// the point of the second ball that is deepest in the first \[m\]
    pub p2: Vec3,
    /// overlap along the normal \[m\]
    pub depth: Real,
}

impl Meeting {
    /// Half-way between the two surfaces on the line of centres \[m\].
    #[inline]
    pub fn middle(&self) -> Vec3 {
        (self.p1 + self.p2) * 0.5
    }
}

/// The normal of two balls whose centres coincide. Nothing tells one direction from another; a fixed one keeps the result
/// defined and the same on every machine.
pub(crate) const CONCENTRIC_NORMAL: Vec3 = Vec3::X;

/// Whether and how two balls meet; touching counts. Unbounded and empty balls meet nothing here: they have no surface.
#[inline]
pub(crate) fn meet(a: &Ball, b: &Ball) -> Option<Meeting> {
    if !a.meets(b) || !(a.radius + b.radius).is_finite() {
        return None;
    }
    let d = b.center - a.center;
    let normal = d.try_normalize().unwrap_or(CONCENTRIC_NORMAL);
    let p1 = a.center + normal * a.radius;
    let p2 = b.center - normal * b.radius;
    let depth = max(a.radius + b.radius - d.length(), 0.0);
    Some(Meeting { normal, p1, p2, depth })
}

/// One contact, half-way between the two surfaces on the line of centres: with one common point an impact keeps the angular
/// momentum, with or without friction.
pub fn touch(a: &Placed<'_>, b: &Placed<'_>, out: &mut Touches) {
    if let Some(m) = meet(&a.ball, &b.ball) {
        let point = m.middle();
        out.push(m.normal, point, m.depth, 0, &[point]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ball(x: f64, y: f64, z: f64, radius: f64) -> Ball {
        Ball { center: Vec3::new(x, y, z), radius }
    }

    #[test]
    fn concentric_balls_have_a_defined_normal() {
        let m = meet(&ball(1.0, 2.0, 3.0, 1.0), &ball(1.0, 2.0, 3.0, 0.5)).unwrap();
        assert_eq!((m.normal, m.depth), (CONCENTRIC_NORMAL, 1.5));
        let m = meet(&ball(0.0, 0.0, 0.0, 0.0), &ball(0.0, 0.0, 0.0, 0.0)).unwrap();
        assert_eq!((m.normal, m.depth), (CONCENTRIC_NORMAL, 0.0));
    }

    #[test]
    fn unbounded_empty_and_unordered_balls_meet_nothing() {
        let unit = ball(0.0, 0.0, 0.0, 1.0);
        assert!(meet(&unit, &unit).is_some());
        assert!(meet(&unit, &ball(0.0, 0.0, 0.0, f64::INFINITY)).is_none());
        assert!(meet(&unit, &Ball::EMPTY).is_none());
        assert!(meet(&unit, &ball(f64::NAN, 0.0, 0.0, 1.0)).is_none());
    }

    #[test]
    fn scaling_by_powers_of_two_is_exact() {
        let (a, b) = (ball(0.1, -0.7, 0.3, 0.9), ball(0.4, 0.2, -0.35, 0.77));
        let m = meet(&a, &b).unwrap();
        for k in [-40, -3, 17, 40] {
            let s = libm::ldexp(1.0, k);
            let scaled = |b: &Ball| Ball { center: b.center * s, radius: b.radius * s };
            let t = meet(&scaled(&a), &scaled(&b)).unwrap();
            assert_eq!((t.normal, t.p1, t.p2, t.depth), (m.normal, m.p1 * s, m.p2 * s, m.depth * s), "2^{k}");
        }
    }
}
