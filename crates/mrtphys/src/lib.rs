//! Rigid-body collision detection and response that conserves what physics conserves.
//!
//! ```
//! use mrtphys::field::{EarthGravity, Scope};
//! use mrtphys::shape::{Polyhedron, Sphere};
//! use mrtphys::{BodyDef, Settings, Surface, Vec3, World};
//! use std::sync::Arc;
//!
//! let mut world = World::new(Settings::default())?;
//! world.add_box("room", Vec3::ZERO, Vec3::splat(1.0), Surface::default())?;
//! world.add_force(Arc::new(EarthGravity::default()), Scope::default())?;
//! world.add_body(BodyDef {
//!     position: Vec3::new(0.5, 0.5, 0.5),
//!     velocity: Vec3::new(1.0, 0.0, 0.3),
//!     ..BodyDef::new(Sphere::new(0.1)?)
//! })?;
//! let tumbling = world.add_body(BodyDef {
//!     position: Vec3::new(0.2, 0.2, 0.2),
//!     angular_velocity: Vec3::new(3.0, 2.0, 1.0),
//!     ..BodyDef::new(Polyhedron::tetrahedron(0.1)?)
//! })?;
//! for _ in 0..600 {
//!     world.frame()?; // a sixtieth of a second, in eight steps
//! }
//! println!("{} impacts, the tetrahedron is at {:?}", world.totals().impacts, world.body(tumbling)?.position);
//! // Elastic impacts conserve energy to round-off, spheres and polyhedra alike.
//! let (now, start) = (world.energy().total(), world.initial_energy().total());
//! assert!((now / start - 1.0).abs() < 1e-12);
//! # Ok::<(), mrtphys::Error>(())
//! ```
//!
//! The modules below are listed in reading order: the face of the library first, then what a step reads, changes and
//! scribbles on, then the stages of a step in the order in which they run.
#![warn(missing_docs)]

// The face: create, step, query, snapshot.
mod cache;
mod wide;
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
pub use error::{Error, Result};
pub use id::{BodyId, BoundaryId, FieldId};
pub use math::{Mat3, Quat, Real, Vec3};
pub use world::World;
