//! Stage 1b: motion between impacts. `translation` carries the integrators, `rotation` the free rotation, which conserves
//! energy and world angular momentum to round-off for any inertia tensor at any spin.

mod elliptic;
pub mod rotation;
pub mod translation;
pub mod advance;
mod varying;

pub use advance::{FARTHEST, advance};
pub use rotation::rotate_free;
