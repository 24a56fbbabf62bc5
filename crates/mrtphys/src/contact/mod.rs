//! Stage 5: contacts of a step, sorted into the order in which they are answered.

pub mod memory;
pub mod let_back;
pub mod collect;
pub mod found;
pub mod project;

use crate::math::{Real, Vec3};

/// The second party of a contact, inside a step: a body's slot, or a boundary's index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Other {
    /// slot of a body
    Body(u32),
    /// index of a boundary
    Wall(u32),
}

/// A contact of the step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// sorts contacts into the order of response
    pub key: u64,
    /// slot of the first body
    pub a: u32,
    /// the other party
    pub b: Other,
    /// which features touch
    pub feature: u32,
    /// unit normal from a to b
    pub normal: Vec3,
    /// contact point \[m\], world coordinates
    pub point: Vec3,
    /// depth of the overlap \[m\]
    pub depth: Real,
    /// first of its points in [`ContactList::points`]
    pub first_point: u32,
    /// number of its points; 0: only `point`
    pub point_count: u32,
}

/// The contacts of a step with their manifold points.
#[derive(Clone, Debug, Default)]
pub struct ContactList {
    /// contacts in order of response
    pub list: Vec<Contact>,
    /// manifold points \[m\], world coordinates
    pub points: Vec<Vec3>,
}
