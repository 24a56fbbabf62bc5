//! On what a run was made.

use serde_json::{Value, json};

/// The machine, the compiler and the command of this run.
pub fn record(command: &str, threads: usize) -> Value {
    json!({
        "what": "machine",
        "cpu": field("/proc/cpuinfo", "model name"),
        "cores": std::thread::available_parallelism().map(usize::from).unwrap_or(0),
        "kernel": format!("{} {}", std::env::consts::OS, line("/proc/sys/kernel/osrelease")),
        "rustc": env!("MRTPHYS_BENCH_RUSTC"),
        "load": line("/proc/loadavg").split(' ').next().unwrap_or_default(),
        "threads": threads,
        "command": command,
    })
}

fn line(path: &str) -> String {
    std::fs::read_to_string(path).map(|text| text.trim().to_string()).unwrap_or_default()
}

fn field(path: &str, name: &str) -> String {
    let text = line(path);
    let value = text.lines().find_map(|l| l.strip_prefix(name)?.split_once(':'));
    value.map_or("unknown processor".into(), |(_, v)| v.trim().to_string())
}
