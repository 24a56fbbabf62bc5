//! The testbed: see a scene, steer it, take it with you (thesis, chapter 7).
//!
//! [`session`] is what happens: a world on a thread of its own, steered by commands, telling what there is to show. It
//! knows nothing of a window, and its tests need none. [`window`] shows it.

pub mod session;
mod window;

pub use window::open;
