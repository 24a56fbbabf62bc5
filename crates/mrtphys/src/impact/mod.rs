//! Stage 6: impacts. A law says which impulse one contact exchanges; `sequential` and `reflection` say how many contacts at
//! once are answered.

pub mod frictionless;
pub mod kurtenbach;
pub mod rough;
pub mod coulomb;
pub mod sequential;
pub mod reflection;
pub mod answer;
pub(crate) mod groups;

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
}

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
