//! `mrtphys bench`: the benchmarks of the bench crate.

use crate::exit::{Failure, Outcome};
use std::ffi::OsString;

/// Runs the benchmarks.
pub fn bench(args: &[OsString]) -> Outcome {
    let args: Vec<String> = args.iter().map(|a| a.to_string_lossy().into_owned()).collect();
    mrtphys_bench::command::run(&args).map_err(Failure::Wrong)
}
