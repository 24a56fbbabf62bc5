//! Time-stepping algorithms. Only they order the stages.

pub mod fixed_step;

use crate::impact::ImpactLaw;
use crate::math::Real;
use crate::model::Model;

/// What a step is told.
#[derive(Clone, Copy)]
pub struct Recipe<'a> {
    /// what it reads
    pub model: &'a Model,
    /// the impact law
    pub law: &'a dyn ImpactLaw,
    /// length of the step \[s\]
    pub dt: Real,
    /// whether impacts are written down one by one
    pub record_events: bool,
}
