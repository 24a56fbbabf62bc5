//! The face of the library.
/// A world.
pub struct World {}
