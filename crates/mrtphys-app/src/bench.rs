//! `mrtphys bench`: the benchmarks of the bench crate; `mrtphys bench peers` compares with the peers that were built in.

use crate::exit::{Failure, Outcome};
use std::ffi::OsString;

/// Runs the benchmarks.
pub fn bench(args: &[OsString]) -> Outcome {
    let args: Vec<String> = args.iter().map(|a| a.to_string_lossy().into_owned()).collect();
    let result = match args.split_first() {
        Some((word, rest)) if word == "peers" => mrtphys_bench::compare::run(rest, &["bench", "peers"]),
        _ => mrtphys_bench::command::run(&args),
    };
    result.map_err(Failure::Wrong)
}
