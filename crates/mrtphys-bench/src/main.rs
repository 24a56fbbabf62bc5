//! `mrtphys-bench`: the benchmarks as a program of its own.

use std::process::ExitCode;

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    match mrtphys_bench::command::run(&args) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("mrtphys-bench: {message}");
            ExitCode::from(1)
        }
    }
}
