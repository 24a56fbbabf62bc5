//! What a snapshot must hold: everything that the future depends on, and nothing else.

use crate::contact::let_back::LetBack;
use crate::contact::memory::ContactMemory;
use crate::math::{Quat, Real, Vec3};

/// Translation of a body: one cache line.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub struct Line {
    /// position of the centre of mass \[m\]
    pub x: Vec3,
    /// radius of the bounding sphere \[m\]; below zero: the body was set aside because its motion was no longer finite
    pub radius: Real,
    /// velocity of the centre of mass \[m/s\]
    pub v: Vec3,
    /// 1/mass \[1/kg\]; 0: infinite mass
    pub inverse_mass: Real,
}

/// Rotation of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Spin {
    /// orientation
    pub q: Quat,
    /// angular momentum about the centre of mass \[Js\], world axes: constant in free rotation
    pub l: Vec3,
}

/// Simulated time. Never accumulated: an anchor, and a whole number of equal steps since.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Clock {
    /// physical steps since the world was made
    pub steps: u64,
    /// time of the anchor \[s\]
    pub anchor: Real,
    /// full steps since the anchor
    pub since_anchor: u64,
    /// steps per second since the anchor: fps x steps per frame
    pub rate: u64,
}

impl Clock {
    /// Time \[s\].
    pub fn time(&self) -> Real {
        if self.since_anchor == 0 { self.anchor } else { self.anchor + self.since_anchor as Real / self.rate as Real }
    }

    /// One full step at this rate.
    pub fn tick(&mut self, rate: u64) {
        if self.rate != rate {
            self.anchor = self.time();
            self.since_anchor = 0;
            self.rate = rate;
        }
        self.since_anchor += 1;
        self.steps += 1;
    }

    /// One step of another length \[s\]: the anchor moves.
    pub fn tick_by(&mut self, dt: Real) {
        self.anchor = self.time() + dt;
        self.since_anchor = 0;
        self.steps += 1;
    }
}

/// What a step changes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct State {
    /// time
    pub clock: Clock,
    /// translation, by slot
    pub lines: Vec<Line>,
    /// rotation, by slot
    pub spins: Vec<Spin>,
    /// pairs in contact in the last step, where the friction law asks for it
    pub contacts: ContactMemory,
    /// bodies that have crossed a two-sided plane
    pub let_back: LetBack,
}
