//! `mrtphys-bench`: the benchmarks as a program of its own. Its first word says which: `peers`, this engine and its peers side
//! by side; `alone`, this engine by itself; `experiment`, the thesis's experiment. Without such a word it is `peers` where any
//! peer was built, `alone` elsewhere.

use std::process::ExitCode;

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let result = match args.split_first() {
        Some((word, rest)) if word == "experiment" => mrtphys_bench::experiment::run(rest),
        Some((word, rest)) if word == "alone" => mrtphys_bench::command::run(rest),
        Some((word, rest)) if word == "peers" => mrtphys_bench::compare::run(rest, &["peers"]),
        _ if mrtphys_bench::peers::any_built() => mrtphys_bench::compare::run(&args, &["peers"]),
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
