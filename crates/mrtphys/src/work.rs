//! Scratch: dropping it between steps changes nothing.

use crate::bounds::{Aabb, Ball};
use crate::broad::{BroadPhase, Candidates};
use crate::contact::found::FoundContacts;
use crate::counters::Counters;
use crate::event::StepEvent;
use crate::impact::bounces::Bounces;
use crate::math::{Mat3, Real, Vec3};
use crate::state::{Line, Spin};
use std::time::Duration;

/// Scratch of a world.
#[derive(Default)]
pub struct Work {
    /// acceleration of each body by the force fields at the end of the motion \[m/s2\]; empty where there are none
    pub accelerations: Vec<Vec3>,
    /// no body has spin, and none has been given any since that was seen
    pub nothing_spins: bool,
    /// bodies were made since the storage was last sorted
    pub storage_is_new: bool,
    /// what [`place`](crate::bounds::place) would return, where the motion has found `balls` on its way and nothing has changed
    /// since
    pub placed: Option<Real>,
    /// rotation matrix of each body, by slot; empty where every body is a sphere
    pub rotations: Vec<Mat3>,
    /// bounding spheres in place
    pub balls: Vec<Ball>,
    /// bounding boxes in place, where the broad phase wants them
    pub boxes: Vec<Aabb>,
    /// the broad phase with its memory
    pub broad: Option<Box<dyn BroadPhase>>,
    /// candidate pairs
    pub candidates: Candidates,
    /// contacts of the step
    pub contacts: FoundContacts,
    /// memory for answering smooth elastic contacts
    pub bounces: Bounces,
    /// impacts of the step, where they are recorded
    pub events: Vec<StepEvent>,
    /// how far each body was pushed out of overlaps in this step \[m\]; empty until the first push
    pub shifts: Vec<Vec3>,
    /// memory for sorting the storage
    pub spare: Spare,
    /// counts of the last step
    pub counters: Counters,
    /// time spent in each stage of the last step
    pub stages: StageTimes,
}

/// Memory that sorting the storage needs, kept from one time to the next.
#[derive(Clone, Debug, Default)]
pub struct Spare {
    /// for the translations
    pub lines: Vec<Line>,
    /// for the rotations
    pub spins: Vec<Spin>,
    /// for numbers by slot
    pub numbers: Vec<u32>,
    /// for flags by slot
    pub flags: Vec<bool>,
}

/// Wall time per stage. Measured only where asked for: it never influences a result.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StageTimes {
    /// fields and motion
    pub motion: Duration,
    /// bounding spheres and boxes
    pub bounds: Duration,
    /// candidate pairs
    pub broad: Duration,
    /// contacts
    pub narrow: Duration,
    /// impulses
    pub impact: Duration,
    /// overlaps projected out
    pub projection: Duration,
}
