//! Where every joule went. Each stage books the change of energy that it measured itself, so that
//! `energy now = energy at the start + sum of the entries` is a check of the whole simulator, not an identity.

use crate::math::{Real, Vec3};

/// Energies of a world \[J\].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    /// kinetic energy of translation, equation (16)
    pub linear: Real,
    /// kinetic energy of rotation, equation (29)
    pub rotational: Real,
    /// potential energy in the conservative force fields
    pub potential: Real,
}

/// What a closed system keeps, of all bodies together: [`World::sums`](crate::World::sums).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sums {
    /// energies \[J\]
    pub energy: Energy,
    /// momentum \[Ns\], equation (11)
    pub momentum: Vec3,
    /// angular momentum about the origin \[Js\], equation (20) and the spins
    pub angular_momentum: Vec3,
}

impl Energy {
    /// Sum of the three \[J\].
    pub fn total(&self) -> Real {
        self.linear + self.rotational + self.potential
    }

    /// Kinetic energy, linear and rotational \[J\].
    pub fn kinetic(&self) -> Real {
        self.linear + self.rotational
    }
}

/// Energy that entered (positive) or left (negative) the bodies since the start, by cause \[J\].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ledger {
    /// lost to friction in impacts (tangential part of the impulse)
    pub friction: Real,
    /// lost to restitution below 1 (normal part of the impulse)
    pub restitution: Real,
    /// given to or taken from the medium by viscosity
    pub drag: Real,
    /// work of force fields that have no potential (a vortex), and of fields moved by a body without reaction
    pub work_of_fields: Real,
    /// work of projecting overlaps out
    pub position_correction: Real,
    /// what the integrator gained or lost against the exact motion
    pub integration: Real,
    /// work of bodies of infinite mass that move
    pub moving_bodies: Real,
    /// changes made from outside: velocities, masses, positions or fields set by the user
    pub user: Real,
    /// energy of bodies created after the start, minus that of bodies removed
    pub created_removed: Real,
}

impl Ledger {
    /// The entries with their names, in the order of the report.
    pub fn entries(&self) -> [(&'static str, Real); 9] {
        [
            ("friction", self.friction),
            ("restitution", self.restitution),
            ("drag", self.drag),
            ("work_of_fields", self.work_of_fields),
            ("position_correction", self.position_correction),
            ("integration", self.integration),
            ("moving_bodies", self.moving_bodies),
            ("user", self.user),
            ("created_removed", self.created_removed),
        ]
    }

    /// Sum of all entries \[J\].
    pub fn sum(&self) -> Real {
        self.entries().iter().map(|e| e.1).sum()
    }

    /// Sum of the absolute values of all entries \[J\]: the scale against which the residual is judged.
    pub fn sum_abs(&self) -> Real {
        self.entries().iter().map(|e| e.1.abs()).sum()
    }
}
