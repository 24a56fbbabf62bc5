//! `mrtphys bench`: where the benchmarks are hooked in.

use crate::exit::{Failure, Outcome};
use std::ffi::OsString;

/// Runs the benchmarks.
pub fn bench(_args: &[OsString]) -> Outcome {
    Err(Failure::not_yet("'bench'", "'mrtphys run SCENE' reports steps per second and the state hash"))
}
