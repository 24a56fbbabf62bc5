//! Rough bodies: the impulse that would stop the contact point, its tangential part weighted by friction.

use super::{Encounter, ImpactLaw, Impulse};
use crate::math::{Real, Vec3};

/// `q = K^-1 v12` is the impulse that stops the contact point; the law acts along `(q.N) N + phi (q - (q.N) N)` with the
/// energy balance of (52) and (53). At phi = 1 the relative velocity of the contact point is turned back, v12' = -e v12:
/// Garwin's superball (American Journal of Physics 37, 88, 1969). Between spheres the pair always separates; in general the
/// guard answers with the frictionless impulse where it would not. Galilei-invariant; e as in [`super::kurtenbach`].
#[derive(Clone, Copy, Debug)]
pub struct Rough;

impl ImpactLaw for Rough {
    fn is_frictionless_at_zero(&self) -> bool {
        true
    }

    fn name(&self) -> &str {
        "rough"
    }

    fn impulse(&self, e: &Encounter) -> Option<Impulse> {
        e.guarded_along(direction)
    }
}

/// The direction of the impulse.
pub(super) fn direction(e: &Encounter) -> Option<Vec3> {
    let q = solve(e, e.relative_velocity())?;
    let perpendicular = e.normal * q.dot(e.normal);
    (perpendicular + (q - perpendicular) * e.friction).try_normalize()
}

/// `K^-1 v` by elimination without square roots (L D L^T). K is symmetric and, with one finite mass, positive definite.
fn solve(e: &Encounter, v: Vec3) -> Option<Vec3> {
    let (x, y, z) = (e.response(Vec3::X), e.response(Vec3::Y), e.response(Vec3::Z));
    let d0 = x.x;
    let (l1, l2) = (x.y / d0, x.z / d0);
    let d1 = y.y - l1 * l1 * d0;
    let l12 = (y.z - l1 * l2 * d0) / d1;
    let d2 = z.z - l2 * l2 * d0 - l12 * l12 * d1;
    if !(d0 > 0.0 && d1 > 0.0 && d2 > 0.0 && (d0 + d1 + d2) < Real::INFINITY) {
        return None;
    }
    let a = v.x;
    let b = v.y - l1 * a;
    let c = v.z - l2 * a - l12 * b;
    let qz = c / d2;
    let qy = b / d1 - l12 * qz;
    let qx = a / d0 - l1 * qy - l2 * qz;
    Some(Vec3::new(qx, qy, qz))
}
