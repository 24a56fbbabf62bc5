//! Stage 1a: force fields and flow fields (thesis, chapter 4). A field is one file; the sum of all acts on every body.

pub mod gravity;
pub mod uniform;
pub mod point;
pub mod vortex;
pub mod flow;
pub mod sum;

pub use flow::{SinkFlow, UniformFlow, VortexFlow};
pub use gravity::EarthGravity;
pub use point::PointField;
pub use uniform::UniformField;
pub use vortex::VortexField;

use crate::id::BodyId;
use crate::math::{Real, Vec3};
use std::fmt::Debug;
use std::sync::Arc;

/// A field of acceleration. Positions are relative to the carrier's centre of mass where the field is carried by a body.
pub trait ForceField: Debug + Send + Sync {
    /// Acceleration \[m/s2\] of a body of this mass at this place.
    fn acceleration(&self, at: Vec3, mass: Real) -> Vec3;

    /// Potential energy per mass \[J/kg\]; `None`: the field has no potential, and its work is booked instead.
    fn potential(&self, at: Vec3) -> Option<Real>;

    /// The acceleration, where it is the same everywhere and for every mass: motion is then exact.
    fn uniform(&self) -> Option<Vec3> {
        None
    }
}

/// A field of flow: the motion of the medium.
pub trait FlowField: Debug + Send + Sync {
    /// Velocity of the medium \[m/s\] at a place.
    fn velocity(&self, at: Vec3) -> Vec3;

    /// The velocity, where it is the same everywhere.
    fn uniform(&self) -> Option<Vec3> {
        None
    }
}

/// Which bodies a field acts on, and what carries it.
#[derive(Clone, Debug, Default)]
pub struct Scope {
    /// the body that carries the field; `None`: it stands still
    pub carrier: Option<BodyId>,
    /// the bodies it acts on; `None`: all
    pub only: Option<Vec<BodyId>>,
    /// a field carried by a body of finite mass acts back on it unless this is set
    pub without_reaction: bool,
}

/// A scope as slots: the world makes it anew whenever bodies come, go or change their slots.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reach {
    /// slot of the carrier
    pub carrier: Option<u32>,
    /// by slot, whether the field acts there; `None`: everywhere
    pub only: Option<Vec<bool>>,
    /// the carrier is gone, and the field with it
    pub gone: bool,
}

/// A force field in its place.
#[derive(Clone, Debug)]
pub struct PlacedForce {
    /// the field
    pub field: Arc<dyn ForceField>,
    /// what it acts on
    pub scope: Scope,
    /// the same, as slots
    pub reach: Reach,
}

/// A flow field in its place.
#[derive(Clone, Debug)]
pub struct PlacedFlow {
    /// the field
    pub field: Arc<dyn FlowField>,
    /// what it acts on
    pub scope: Scope,
    /// the same, as slots
    pub reach: Reach,
}
