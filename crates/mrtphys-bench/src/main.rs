//! `mrtphys-bench`: the benchmarks, or after the word `experiment` the experiment, as a program of its own.

use std::process::ExitCode;

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let result = match args.split_first() {
        Some((command, rest)) if command == "experiment" => mrtphys_bench::experiment::run(rest),
        _ => mrtphys_bench::command::run(&args),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("mrtphys-bench: {message}");
            ExitCode::from(1)
        }
    }
}
