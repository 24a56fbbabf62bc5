//! A contact area that comes to rest: the corners of the area share the pressure and the friction.
//!
//! An inelastic flat contact cannot be answered at one point: friction at the foot of a block turns the block unless the
//! pressure moves to the lower edge. The corners exchange normal impulses p_k >= 0 and tangential ones |t_k| <= mu p_k so
//! that no corner approaches and none slips while its cone allows it: projected Gauss-Seidel over the corners, impulses
//! accumulated (Moreau 1988; Jean 1999). One area at a time; areas that lean on each other wait for the next step.

use super::{Encounter, Party};
use crate::math::{Real, Vec3};

/// Sweeps over the corners at most.
const SWEEPS: usize = 64;
/// Sweeps end when no corner's velocity changes by more than this part of the approach.
const STILL: Real = 1e-13;

/// What an area exchanged.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct AreaResponse {
    /// impulse on the first body, by corner \[Ns\]
    pub impulses: Vec<Vec3>,
    /// change of kinetic energy by the normal parts \[J\]
    pub restitution_change: Real,
    /// change of kinetic energy by the tangential parts \[J\]
    pub friction_change: Real,
}

/// Velocities of the two bodies, as the sweeps change them.
struct Pair {
    a: Party,
    b: Party,
}

impl Pair {
    /// Velocity of a relative to b at a corner.
    fn velocity(&self, corner: &Corner) -> Vec3 {
        let at = |p: &Party, r: Vec3| p.v + p.w.cross(r);
        at(&self.a, corner.ra) - at(&self.b, corner.rb)
    }

    fn push(&mut self, corner: &Corner, impulse: Vec3) {
        let give = |p: &mut Party, r: Vec3, j: Vec3| {
            p.v += j * p.inverse_mass;
            p.w += p.inverse_inertia * r.cross(j);
        };
        give(&mut self.a, corner.ra, impulse);
        give(&mut self.b, corner.rb, -impulse);
    }
}

struct Corner {
    ra: Vec3,
    rb: Vec3,
    tangents: [Vec3; 2],
    /// velocity per impulse along the normal and the larger of those along the tangents
    weights: [Real; 2],
    pressure: Real,
    friction: [Real; 2],
}

impl Corner {
    fn new(e: &Encounter, ra: Vec3, rb: Vec3) -> Corner {
        let first = e.normal.any_perpendicular();
        let tangents = [first, e.normal.cross(first)];
        let at = |p: &Party, r: Vec3| Party { r, ..*p };
        let (a, b) = (at(&e.a, ra), at(&e.b, rb));
        let weight = |d: Vec3| (a.response(d) + b.response(d)).dot(d);
        let slip = crate::math::max(weight(tangents[0]), weight(tangents[1]));
        // The sum of the two bounds the larger eigenvalue of the tangential block, so that each sweep takes energy away.
        let cross = (a.response(tangents[0]) + b.response(tangents[0])).dot(tangents[1]).abs();
        Corner { ra, rb, tangents, weights: [weight(e.normal), slip + cross], pressure: 0.0, friction: [0.0; 2] }
    }

    fn impulse(&self, normal: Vec3) -> Vec3 {
        self.tangents[0] * self.friction[0] + self.tangents[1] * self.friction[1] - normal * self.pressure
    }
}

/// Lets the corners of an area come to rest. `encounter`: the pair, its normal from a to b and its friction coefficient;
/// `points`: the corners in world coordinates, `centers` the two centres of mass. `None`: nothing approaches, or the numbers
/// are not finite.
pub(super) fn settle(encounter: &Encounter, points: &[Vec3], centers: [Vec3; 2]) -> Option<AreaResponse> {
    let e = encounter;
    let mut corners: Vec<Corner> = points.iter().map(|&p| Corner::new(e, p - centers[0], p - centers[1])).collect();
    let mut pair = Pair { a: e.a, b: e.b };
    let before: Vec<Vec3> = corners.iter().map(|c| pair.velocity(c)).collect();
    let scale = before.iter().fold(0.0, |m, v| crate::math::max(m, v.dot(e.normal)));
    if !(scale > 0.0) {
        return None;
    }
    for _ in 0..SWEEPS {
        let mut largest: Real = 0.0;
        for corner in &mut corners {
            largest = crate::math::max(largest, sweep_corner(&mut pair, corner, e));
        }
        if largest <= STILL * scale {
            break;
        }
    }
    let mut out = AreaResponse { impulses: Vec::new(), restitution_change: 0.0, friction_change: 0.0 };
    for (corner, before) in corners.iter().zip(before) {
        let mean = (before + pair.velocity(corner)) * 0.5;
        let impulse = corner.impulse(e.normal);
        let normal_part = e.normal * -corner.pressure;
        out.restitution_change += normal_part.dot(mean);
        out.friction_change += (impulse - normal_part).dot(mean);
        out.impulses.push(impulse);
    }
    out.impulses.iter().all(|j| j.is_finite()).then_some(out)
}

/// One corner: first the normal, then friction within the cone of the pressure it has now. Returns the change of velocity.
fn sweep_corner(pair: &mut Pair, corner: &mut Corner, e: &Encounter) -> Real {
    let approach = pair.velocity(corner).dot(e.normal);
    let pressure = crate::math::max(corner.pressure + approach / corner.weights[0], 0.0);
    let step = pressure - corner.pressure;
    corner.pressure = pressure;
    pair.push(corner, e.normal * -step);
    let slip = pair.velocity(corner);
    let wanted = [0, 1].map(|k| corner.friction[k] - slip.dot(corner.tangents[k]) / corner.weights[1]);
    let limit = e.friction * corner.pressure;
    let size = (wanted[0] * wanted[0] + wanted[1] * wanted[1]).sqrt();
    let cut = if size > limit { limit / size } else { 1.0 };
    let friction = wanted.map(|w| w * cut);
    let change = [0, 1].map(|k| friction[k] - corner.friction[k]);
    corner.friction = friction;
    pair.push(corner, corner.tangents[0] * change[0] + corner.tangents[1] * change[1]);
    let moved = crate::math::max(change[0].abs(), change[1].abs()) * corner.weights[1];
    crate::math::max(step.abs() * corner.weights[0], moved)
}
