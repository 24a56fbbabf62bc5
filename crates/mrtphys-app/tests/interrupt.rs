//! Interrupts: what was reached is written, and can be gone on from.
#![cfg(unix)]

mod common;
use common::{Done, Folder, csv};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

fn wait_until(what: &str, mut done: impl FnMut() -> bool) {
    let start = Instant::now();
    while !done() {
        assert!(start.elapsed() < Duration::from_secs(60), "waited in vain: {what}");
        std::thread::sleep(Duration::from_millis(10));
    }
}

fn interrupted(folder: &Folder, args: &str, signal: &str) -> Done {
    let mut command = folder.command();
    command.args(args.split_whitespace()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    let size = || std::fs::metadata(folder.path("t.csv")).map_or(0, |m| m.len());
    wait_until("frames in the trajectory", || size() > 100_000);
    let sent = Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap();
    assert!(sent.success());
    wait_until("the end", || child.try_wait().unwrap().is_some());
    Done::from(child.wait_with_output().unwrap())
}

#[test]
fn an_interrupted_run_keeps_everything_and_can_be_gone_on_from() {
    let folder = Folder::with_scenes("interrupt");
    let args =
        "run gas.toml --quiet --seconds 1000000 --events e.csv --trajectory t.csv --report r.json --snapshot s.snap";
    for signal in ["-INT", "-TERM"] {
        let done = interrupted(&folder, args, signal).expect(130);
        assert!(done.out.contains("interrupted"), "{}", done.out);
        let r = folder.json("r.json");
        assert_eq!(r["interrupted"], true);
        let (steps, frames) = (r["steps"].as_u64().unwrap(), r["frames"].as_u64().unwrap());
        assert!(steps > 0 && frames == steps / 8, "{steps} {frames}");
        assert_eq!(r["time"].as_f64().unwrap(), steps as f64 / 480.0);
        let impacts = r["counters"]["impacts"].as_u64().unwrap();
        assert_eq!(csv(&folder.text("e.csv")).len() as u64, impacts + 1, "no event is lost or cut off");
        assert_eq!(csv(&folder.text("t.csv")).len() as u64, (frames + 1) * 27 + 1);
        let end = frames + 2;
        let rest = folder.report(&format!("gas.toml --resume s.snap --frames {end}"));
        let whole = folder.report(&format!("gas.toml --frames {end}"));
        assert_eq!((&rest["state_hash"], &rest["frames"]), (&whole["state_hash"], &whole["frames"]));
        std::fs::remove_file(folder.path("t.csv")).unwrap();
    }
}
