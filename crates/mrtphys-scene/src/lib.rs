//! Scenes: a text that a person can write, read with errors that say where and what, made into a world, and written back.
//!
//! [`Scene::load`] reads, [`Scene::build`] makes the world, [`to_toml`] writes. The language is documented in
//! `docs/manual/scene-language.md`; [`schema`] is its JSON schema.
#![warn(missing_docs)]

// From text to a description.
mod source;
mod diagnostics;
mod format;
mod parse;
pub mod scene;

// From the description to a world.
pub mod table;
mod lattice;
mod random;
mod field;
mod build;
mod names;

// And back.
mod write;
mod schema;
mod gallery;

pub use build::Loaded;
pub use diagnostics::{Diagnostic, Diagnostics, MOST_REPORTED, Place};
pub use gallery::{gallery, gallery_scene};
pub use lattice::LatticePoint;
pub use names::{BOX_FACES, Names};
pub use parse::MOST_VALUES;
pub use random::Random;
pub use scene::{MOST_BODIES, Scene};
pub use schema::schema;
pub use source::{LARGEST_TEXT, Source, Span};
pub use write::to_toml;
