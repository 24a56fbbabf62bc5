//! Digests and snapshots of the state.

pub mod digest;
pub mod snapshot;
