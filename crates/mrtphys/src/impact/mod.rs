//! Stage 6: impacts. A law says which impulse one contact exchanges; `sequential` and `reflection` say how many contacts at
//! once are answered.

// `!(x > 0.0)` is meant: it is true for NaN, which must never pass for an approach.
#![allow(clippy::neg_cmp_op_on_partial_ord)]

pub mod frictionless;
pub mod kurtenbach;
pub mod rough;
pub mod coulomb;
pub mod sequential;
pub mod reflection;
pub(crate) mod answer;
pub(crate) mod bounces;
pub(crate) mod groups;
mod area;
mod delassus;
mod cone;
#[cfg(test)]
mod tests;

use crate::def::FrictionLaw;
use crate::math::{Mat3, Real, Vec3};
use std::sync::Arc;

/// One of the two parties of an impact.
#[derive(Clone, Copy, Debug)]
pub struct Party {
    /// mass \[kg\]; infinite for what never moves
    pub mass: Real,
    /// 1/mass \[1/kg\], 0 for infinite mass
    pub inverse_mass: Real,
    /// inverse inertia tensor, world axes \[1/(kg m2)\]; zero for infinite mass
    pub inverse_inertia: Mat3,
    /// velocity of the centre of mass \[m/s\]
    pub v: Vec3,
    /// angular velocity \[rad/s\]
    pub w: Vec3,
    /// from the centre of mass to the contact point \[m\]
    pub r: Vec3,
    /// angular momentum about the centre of mass, world axes \[Js\]; zero for infinite mass. Only `kurtenbach` reads it
    pub angular_momentum: Vec3,
}

impl Party {
    /// What never moves.
    pub const IMMOVABLE: Party = Party {
        mass: Real::INFINITY,
        inverse_mass: 0.0,
        inverse_inertia: Mat3::ZERO,
        v: Vec3::ZERO,
        w: Vec3::ZERO,
        r: Vec3::ZERO,
        angular_momentum: Vec3::ZERO,
    };

    /// Velocity of the contact point, equation (22).
    #[inline]
    pub fn point_velocity(&self) -> Vec3 {
        self.v + self.w.cross(self.r)
    }

    /// Change of the contact point's velocity per impulse `j` at it: `j/m + (I^-1 (r x j)) x r`.
    #[inline]
    pub fn response(&self, j: Vec3) -> Vec3 {
        j * self.inverse_mass + (self.inverse_inertia * self.r.cross(j)).cross(self.r)
    }

    /// Upper bound of the contact point's speed, `|v| + |w| |r|` \[m/s\]: what its round-off is relative to.
    #[inline]
    fn speed_bound(&self) -> Real {
        self.v.length() + self.w.length() * self.r.length()
    }

    /// The rotational part of (53): `(r x n).I^-1 (r x n)`.
    #[inline]
    fn turning(&self, n: Vec3) -> Real {
        let arm = self.r.cross(n);
        arm.dot(self.inverse_inertia * arm)
    }
}

/// A velocity counts as an approach, where an answer is at stake, from this many relative roundings of the speeds in it.
pub(crate) const ROUND_OFF: Real = 8.0 * Real::EPSILON;

/// An impact about to happen.
#[derive(Clone, Copy, Debug)]
pub struct Encounter {
    /// first party
    pub a: Party,
    /// second party
    pub b: Party,
    /// unit normal from a to b
    pub normal: Vec3,
    /// the pair's friction coefficient
    pub friction: Real,
    /// the pair's coefficient of restitution
    pub restitution: Real,
    /// whether the pair was in contact in the step before
    pub persistent: bool,
}

impl Encounter {
    /// Velocity of a's contact point relative to b's \[m/s\].
    #[inline]
    pub fn relative_velocity(&self) -> Vec3 {
        self.a.point_velocity() - self.b.point_velocity()
    }

    /// Approach speed along the normal \[m/s\]; positive: they approach.
    #[inline]
    pub fn approach(&self) -> Real {
        self.relative_velocity().dot(self.normal)
    }

    /// `K j`: change of the relative velocity per impulse `j` on a and `-j` on b.
    #[inline]
    pub fn response(&self, j: Vec3) -> Vec3 {
        self.a.response(j) + self.b.response(j)
    }

    /// `B(n) = n.K.n` for a unit vector, equation (53) \[1/kg\].
    #[inline]
    pub fn inverse_effective_mass(&self, n: Vec3) -> Real {
        self.a.inverse_mass + self.b.inverse_mass + (self.a.turning(n) + self.b.turning(n))
    }

    /// Whether one of the two never moves.
    #[inline]
    pub fn has_immovable(&self) -> bool {
        self.a.inverse_mass == 0.0 || self.b.inverse_mass == 0.0
    }

    /// `-(1 + e) (v12.n)/B(n) n`: with e = 1 it conserves kinetic energy for every unit vector `n`, (50) to (53), with e < 1 it
    /// never adds any. `None` where it is not finite (two immovable parties, overflow).
    #[inline]
    fn impulse_along(&self, n: Vec3) -> Option<Vec3> {
        let j = n * (-(1.0 + self.restitution) * self.relative_velocity().dot(n) / self.inverse_effective_mass(n));
        j.is_finite().then_some(j)
    }

    /// The impulse along the normal, for an approaching pair; `None` for any other.
    #[inline]
    fn frictionless_impulse(&self) -> Option<Vec3> {
        if self.approach() > 0.0 { self.impulse_along(self.normal) } else { None }
    }

    /// Round-off of the approach speed after the impulse `j` \[m/s\].
    fn round_off(&self, j: Vec3) -> Real {
        ROUND_OFF * (self.a.speed_bound() + self.b.speed_bound() + self.response(j).length())
    }

    /// The impulse along the direction that a friction law chooses. The frictionless one instead where there is no friction,
    /// and, marked as a fallback, where there is no direction or the pair would go on approaching: that one always separates.
    fn guarded_along(&self, direction: impl FnOnce(&Encounter) -> Option<Vec3>) -> Option<Impulse> {
        let frictionless = self.frictionless_impulse()?;
        if self.friction == 0.0 {
            return Some(Impulse { on_a: frictionless, fallback: false });
        }
        if let Some(on_a) = direction(self).and_then(|n| self.impulse_along(n)) {
            let after = self.approach() + self.response(on_a).dot(self.normal);
            if after <= 0.0 || after <= self.round_off(on_a) {
                return Some(Impulse { on_a, fallback: false });
            }
        }
        Some(Impulse { on_a: frictionless, fallback: true })
    }
}

/// What a law answers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impulse {
    /// impulse on a \[Ns\]; b receives the opposite
    pub on_a: Vec3,
    /// the law's own impulse would have left the pair approaching, so this is the frictionless one
    pub fallback: bool,
}

/// An impact law. It is asked only about pairs that approach.
pub trait ImpactLaw: Send + Sync + std::fmt::Debug {
    /// Name as in scenes.
    fn name(&self) -> &str;

    /// The impulse; `None`: the pair is left alone.
    fn impulse(&self, encounter: &Encounter) -> Option<Impulse>;

    /// Whether a pair without friction gets exactly the frictionless impulse -(1 + e) (v12 . n)/B(n) n, as in all laws of the
    /// thesis: smooth spheres are then answered without asking.
    fn is_frictionless_at_zero(&self) -> bool {
        false
    }

    /// Whether the law is dry friction: a tangential impulse of at most the friction coefficient times the normal one. Contact
    /// areas that come to rest are then answered corner by corner at once.
    fn is_dry_friction(&self) -> bool {
        false
    }

    /// Whether [`Encounter::persistent`] must be known: the state then remembers which pairs were in contact.
    fn needs_contact_memory(&self) -> bool {
        false
    }
}

/// Makes the law that is asked for.
pub fn make(law: FrictionLaw) -> Arc<dyn ImpactLaw> {
    match law {
        FrictionLaw::Frictionless => Arc::new(frictionless::Frictionless),
        FrictionLaw::Kurtenbach => Arc::new(kurtenbach::Kurtenbach),
        FrictionLaw::KurtenbachLiteral => Arc::new(kurtenbach::KurtenbachLiteral),
        FrictionLaw::Velocity => Arc::new(kurtenbach::VelocityWeights),
        FrictionLaw::Rough => Arc::new(rough::Rough),
        FrictionLaw::Coulomb => Arc::new(coulomb::Coulomb),
    }
}
