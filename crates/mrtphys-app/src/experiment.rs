//! `mrtphys experiment`: the thesis's comparison, made by the bench crate.

use crate::exit::{Failure, Outcome};
use std::ffi::OsString;

/// Runs the experiment.
pub fn experiment(args: &[OsString], quiet: bool) -> Outcome {
    let mut args: Vec<String> = args.iter().map(|a| a.to_string_lossy().into_owned()).collect();
    if quiet {
        args.push("--quiet".into());
    }
    mrtphys_bench::experiment::run(&args).map_err(Failure::Wrong)
}
