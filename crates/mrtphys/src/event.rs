//! Impacts, written down one by one.

use crate::id::{BodyId, BoundaryId};
use crate::math::{Real, Vec3};

/// The second party of an impact.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Partner {
    /// a body
    Body(BodyId),
    /// a boundary
    Boundary(BoundaryId),
}

/// One impact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImpactEvent {
    /// time \[s\]: the end of the step, for `fixed-step`
    pub time: Real,
    /// first body
    pub a: BodyId,
    /// second body, or the boundary
    pub b: Partner,
    /// contact point \[m\], world coordinates
    pub point: Vec3,
    /// unit normal from a to b
    pub normal: Vec3,
    /// normal impulse \[Ns\]
    pub impulse_n: Real,
    /// tangential impulse \[Ns\]
    pub impulse_t: Real,
    /// change of the pair's kinetic energy by this impact, j . (v_before + v_after) / 2 summed over the pair \[J\]
    pub energy_change: Real,
}

/// An impact inside a step: parties by slot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepEvent {
    /// slot of the first body
    pub a: u32,
    /// the other party
    pub b: crate::contact::Other,
    /// contact point \[m\]
    pub point: Vec3,
    /// unit normal from a to b
    pub normal: Vec3,
    /// normal impulse \[Ns\]
    pub impulse_n: Real,
    /// tangential impulse \[Ns\]
    pub impulse_t: Real,
    /// change of the pair's kinetic energy \[J\]
    pub energy_change: Real,
}
