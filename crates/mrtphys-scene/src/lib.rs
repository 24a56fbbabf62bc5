//! Scenes: a text that a person can write, read with errors that say where and what, made into a world, and written back.
//!
//! [`Scene::load`] reads, [`Scene::build`] makes the world, [`to_toml`] writes. The language is documented in
//! `docs/manual/scene-language.md`; [`schema`] is its JSON schema.
//!
//! ```
//! use mrtphys_scene::{Scene, to_toml};
//!
//! let text = "
//!     format = 1
//!     [[force_field]]
//!     kind = 'earth-gravity'
//!     [[boundary]]
//!     kind = 'half-space'
//!     normal = [0, 1, 0]
//!     [[body]]
//!     name = 'ball'
//!     shape = { kind = 'sphere', radius = 0.1 }
//!     position = [0, 1, 0]
//! ";
//! let scene = Scene::from_text("ball.toml", text)?; // or Scene::load(path)
//! let mut loaded = scene.build()?;
//! for _ in 0..60 {
//!     loaded.world.frame()?;
//! }
//! let ball = loaded.names.body("ball").expect("a name of the scene");
//! println!("after {} s the ball is at {:?}", loaded.world.time(), loaded.world.body(ball)?.position);
//! println!("{}", to_toml(&loaded)?); // the scene that it is now
//!
//! // What is wrong is said with line and column.
//! let wrong = Scene::from_text("wrong.toml", "format = 1\nbodi = 3\n").unwrap_err();
//! assert_eq!(wrong.list[0].headline(), "wrong.toml:2:1: scene: unknown key 'bodi', did you mean 'body'?");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
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
