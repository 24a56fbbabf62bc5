//! The thesis's friction heuristic, sections 3.8.4 and 3.8.5: the impulse keeps the frictionless law's energy balance, (52)
//! and (53), but acts along a direction that is tilted from the normal by the friction coefficient phi.
//!
//! The direction is the only thing in which the laws differ. Energy is right for every direction, so it says nothing about
//! whether the direction is sensible; separation does, and it is not guaranteed by any of the printed forms. The guarded laws
//! therefore answer with the frictionless impulse where their own would leave the pair approaching. They also do so where the
//! pair was in contact in the step before: in an edge of a box, at grazing incidence, the tangential impulse of one wall would
//! otherwise drive a sphere deeper into the other, step after step.
//!
//! Restitution: `dp1 = -(1 + e) (v12.n)/B(n) n`. At e = 1 that is the thesis's law; below, the energy changes by
//! `-(1 - e^2)/2 (v12.n)^2/B(n)`, which is never positive, whatever the direction.

use super::{Encounter, ImpactLaw, Impulse, Party};
use crate::math::{Real, Vec3};

/// Momentum of the contact point, equations (38) to (40): `p + (L x r)/r^2`, r from the centre of mass to the point.
///
/// The formula is singular for a contact at the centre of mass. Below some ulps of the radius of gyration, k^2 = |L|/(m |w|),
/// r is nothing but round-off and its direction means nothing: there the spin contributes no momentum.
fn point_momentum(party: &Party) -> Vec3 {
    const FLOOR: Real = 64.0 * Real::EPSILON * Real::EPSILON * 64.0;
    let linear = party.v * party.mass;
    let r2 = party.r.length_squared();
    let spin = party.angular_momentum;
    if !(party.mass * party.w.length() * r2 > FLOOR * spin.length()) {
        return linear;
    }
    let rotational = spin.cross(party.r) / r2;
    if rotational.is_finite() { linear + rotational } else { linear }
}

/// The sensible reading of (59) to (62): `|p.N| N + phi (p - (p.N) N)`, p the difference of the point momenta, N from a to b.
/// The absolute value keeps the direction of the normal part where p points backwards (a rear-end hit on a slow heavy body).
pub(super) fn thesis_direction(e: &Encounter) -> Option<Vec3> {
    let p = point_momentum(&e.a) - point_momentum(&e.b);
    let along = p.dot(e.normal);
    let tangential = p - e.normal * along;
    (e.normal * along.abs() + tangential * e.friction).try_normalize()
}

/// Equations (59) to (62) to the letter, with N2 = -N: `|p.N2| N2 + phi (p - |p.N2| N2)`.
fn literal_direction(e: &Encounter) -> Option<Vec3> {
    let p = point_momentum(&e.a) - point_momentum(&e.b);
    let n2 = -e.normal;
    let perpendicular = n2 * p.dot(n2).abs();
    let parallel = p - perpendicular;
    (perpendicular + parallel * e.friction).try_normalize()
}

/// Equations (63) to (65): `(v.N) N + phi (v - (v.N) N)`, not normalized.
pub(super) fn weighted_velocity(e: &Encounter) -> Vec3 {
    let v = e.relative_velocity();
    let perpendicular = e.normal * v.dot(e.normal);
    perpendicular + (v - perpendicular) * e.friction
}

/// What both guarded laws share: no friction for a pair that was in contact in the step before.
fn guarded(e: &Encounter, direction: impl FnOnce(&Encounter) -> Option<Vec3>) -> Option<Impulse> {
    if e.persistent {
        return super::frictionless::Frictionless.impulse(e);
    }
    e.guarded_along(direction)
}

/// The thesis's law in its sensible reading: momentum weights, (59) to (62), between bodies; velocity weights, (63) to (66),
/// with A = v.N_inf, against infinite mass. Guarded (see the module). Not Galilei-invariant: momentum depends on the frame.
#[derive(Clone, Copy, Debug)]
pub struct Kurtenbach;

impl ImpactLaw for Kurtenbach {
    fn is_frictionless_at_zero(&self) -> bool {
        true
    }

    fn name(&self) -> &str {
        "kurtenbach"
    }

    fn impulse(&self, e: &Encounter) -> Option<Impulse> {
        if e.has_immovable() {
            guarded(e, |e| weighted_velocity(e).try_normalize())
        } else {
            guarded(e, thesis_direction)
        }
    }

    fn needs_contact_memory(&self) -> bool {
        true
    }
}

/// Equations (59) to (70) as printed, for comparison. Not guarded: the pair may go on approaching (77 % of random impacts),
/// and (67) loses energy at every frictional contact with infinite mass: `-2 phi (1 - phi) v_par^2/B` at e = 1.
///
/// Where the printed direction is 0/0, the frictionless impulse answers, marked as a fallback.
#[derive(Clone, Copy, Debug)]
pub struct KurtenbachLiteral;

impl KurtenbachLiteral {
    /// The impulse on a as printed, for approaching and for separating pairs; `None` where the formula is 0/0 or overflows.
    pub(super) fn printed(e: &Encounter) -> Option<Vec3> {
        if !e.has_immovable() {
            return e.impulse_along(literal_direction(e)?);
        }
        // (65) to (70). N_inf points into the wall and dp_inf is what the wall receives: p1' = p1 - dp_inf.
        let v = weighted_velocity(e);
        let n = v.try_normalize()?;
        let j = n * (-(1.0 + e.restitution) * v.length() / e.inverse_effective_mass(n));
        j.is_finite().then_some(j)
    }
}

impl ImpactLaw for KurtenbachLiteral {
    fn is_frictionless_at_zero(&self) -> bool {
        true
    }

    fn name(&self) -> &str {
        "kurtenbach-literal"
    }

    fn impulse(&self, e: &Encounter) -> Option<Impulse> {
        let frictionless = e.frictionless_impulse()?;
        if e.friction == 0.0 {
            return Some(Impulse { on_a: frictionless, fallback: false });
        }
        match Self::printed(e) {
            Some(on_a) => Some(Impulse { on_a, fallback: false }),
            None => Some(Impulse { on_a: frictionless, fallback: true }),
        }
    }
}

/// Velocity weights, (63) to (66) with A = v.N, for every pair: the Galilei-invariant form that (59) to (62) should tend to
/// for m2 to infinity. Guarded (see the module).
#[derive(Clone, Copy, Debug)]
pub struct VelocityWeights;

impl ImpactLaw for VelocityWeights {
    fn is_frictionless_at_zero(&self) -> bool {
        true
    }

    fn name(&self) -> &str {
        "velocity"
    }

    fn impulse(&self, e: &Encounter) -> Option<Impulse> {
        guarded(e, |e| weighted_velocity(e).try_normalize())
    }

    fn needs_contact_memory(&self) -> bool {
        true
    }
}
