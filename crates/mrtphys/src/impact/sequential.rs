//! One contact after the other: what an impact does to its pair, and to the ledger.

use super::{Encounter, ImpactLaw};
use crate::math::{Real, Vec3};

/// What one answered contact does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Response {
    /// impulse on a \[Ns\]; b receives the opposite
    pub impulse_on_a: Vec3,
    /// the frictionless impulse stands in for the law's own
    pub fallback: bool,
    /// normal impulse \[Ns\], positive: the two are pushed apart
    pub impulse_n: Real,
    /// length of the tangential impulse \[Ns\]
    pub impulse_t: Real,
    /// change of the pair's kinetic energy \[J\]: j . (v_before + v_after)/2, summed over the two contact points. Exact for any
    /// impulse at a point, because the point's velocity changes linearly with it
    pub energy_change: Real,
    /// the part of `energy_change` that the tangential impulse causes \[J\]
    pub friction_change: Real,
    /// the part of `energy_change` that the normal impulse causes \[J\]
    pub restitution_change: Real,
}

/// Answers one contact by a law. `None`: the pair does not approach, neither party can move, the law leaves the pair alone,
/// or the answer is not a finite number.
pub fn respond(encounter: &Encounter, law: &dyn ImpactLaw) -> Option<Response> {
    if !(encounter.approach() > 0.0) {
        return None;
    }
    let impulse = law.impulse(encounter)?;
    let j = impulse.on_a;
    let before = encounter.relative_velocity();
    let mean = before + encounter.response(j) * 0.5;
    let n = encounter.normal;
    let along = j.dot(n);
    let normal = n * along;
    let tangential = j - normal;
    let restitution_change = along * mean.dot(n);
    let friction_change = tangential.dot(mean - n * mean.dot(n));
    let response = Response {
        impulse_on_a: j,
        fallback: impulse.fallback,
        impulse_n: -along,
        impulse_t: tangential.length(),
        energy_change: restitution_change + friction_change,
        friction_change,
        restitution_change,
    };
    (j.is_finite() && response.energy_change.is_finite()).then_some(response)
}

/// The frictionless impulse between bodies that it cannot turn (spheres, `r` along `n`), for the hot loop: its size along `n`
/// \[Ns\], so that a receives `-j n` and b `+j n`. `n` is the unit normal from a to b, `e` the restitution. `None`: they do not
/// approach, neither can move, or the impulse overflows.
///
/// The operations are those of [`super::frictionless::Frictionless`] in the same order, so for parties without rotation the
/// two give the same bits.
#[inline]
pub fn frictionless_spheres(n: Vec3, v: [Vec3; 2], inverse_mass: [Real; 2], e: Real) -> Option<Real> {
    let approach = (v[0] - v[1]).dot(n);
    if !(approach > 0.0) {
        return None;
    }
    let j = (1.0 + e) * approach / (inverse_mass[0] + inverse_mass[1]);
    (j < Real::INFINITY).then_some(j)
}
