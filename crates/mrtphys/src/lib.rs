//! Rigid-body collision detection and response that conserves what physics conserves.
//!
//! The modules below are listed in reading order: the face of the library first, then what a step reads, changes and
//! scribbles on, then the stages of a step in the order in which they run.
#![warn(missing_docs)]

// The face: create, step, query, snapshot.
pub mod world;
pub mod def;
pub mod id;
pub mod error;

// What a step reads, what it changes, what it scribbles on.
pub mod model;
pub mod state;
pub mod work;

// The recipe, then its stages in order.
pub mod step;
pub mod field;
pub mod motion;
pub mod bounds;
pub mod broad;
pub mod narrow;
pub mod contact;
pub mod impact;

// What is written down on the way.
pub mod ledger;
pub mod event;
pub mod counters;
pub mod record;

// What everything is made of.
pub mod shape;
pub mod math;
pub mod par;

pub use def::*;
pub use error::Error;
pub use id::{BodyId, BoundaryId, FieldId};
pub use math::{Mat3, Quat, Real, Vec3};
pub use world::World;
