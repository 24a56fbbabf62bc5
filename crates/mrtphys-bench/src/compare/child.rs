//! The process that serves one engine: a line with a command comes in, a line of JSON goes out.

use super::session::Session;
use super::stats::Times;
use crate::peers::scene::SceneData;
use crate::peers::{EngineKind, Margin, Setup};
use serde_json::{Value, json};
use std::io::{BufRead, Write};
use std::path::Path;

/// Stack of a thread in bytes: Jolt goes deep among a million bodies. What is not used is not taken.
const STACK: usize = 1 << 28;

/// Serves until there are no more commands.
///
/// # Errors
/// What is wrong with the arguments, or what the engine reports: in words, which go out as the last line too.
pub fn serve(args: &[String]) -> Result<(), String> {
    let [engine, margin, threads, path] = args else { return Err("not for use by hand".into()) };
    let kind = EngineKind::named(engine).ok_or("no such engine")?;
    let margin = if margin == name(Margin::Thin) { Margin::Thin } else { Margin::Default };
    let threads: usize = threads.parse().map_err(|_| "no number of threads")?;
    // The engine is made and run within a pool of that many threads: engines that use one take it from there.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).stack_size(STACK);
    let pool = pool.build().map_err(|e| e.to_string())?;
    let result = pool.install(|| answer_all(kind, Setup { margin, threads }, Path::new(path)));
    if let Err(why) = &result {
        answer(&json!({ "error": why }))?;
    }
    result
}

/// Name of a margin in records and arguments.
pub fn name(margin: Margin) -> &'static str {
    match margin {
        Margin::Default => "default",
        Margin::Thin => "thin",
    }
}

fn answer_all(kind: EngineKind, setup: Setup, path: &Path) -> Result<(), String> {
    let scene = SceneData::read(path)?;
    let engine = kind.create(&scene, setup)?;
    let mut session = Session::new(scene, engine)?;
    answer(&json!({ "version": session.engine().version(), "settings": session.engine().settings() }))?;
    for line in std::io::stdin().lock().lines() {
        let line = line.map_err(|e| e.to_string())?;
        answer(&obey(&mut session, &line)?)?;
    }
    Ok(())
}

fn obey(session: &mut Session, line: &str) -> Result<Value, String> {
    let (command, steps) = line.split_once(' ').unwrap_or((line, "0"));
    let steps: u64 = steps.parse().map_err(|_| format!("'{line}' is no command"))?;
    match command {
        "time" => {
            let burst = session.time(steps)?;
            let times = |t: Times| json!({ "median": t.median, "mean": t.mean, "total": t.total });
            Ok(json!({ "cpu": times(burst.cpu), "wall": times(burst.wall) }))
        }
        "watch" => {
            let w = session.watch(steps)?;
            Ok(json!({
                "steps": w.steps, "body_steps": w.body_steps, "changes": w.changes, "moved": w.moved, "speed": w.speed,
            }))
        }
        "run" => session.run(steps).map(|()| json!({})),
        "truth" => {
            let t = session.truth();
            let (pairs, worst) = (t.overlaps.pairs, t.overlaps.worst);
            Ok(json!({ "energy": t.energy, "escaped": t.escaped, "pairs": pairs, "worst": worst }))
        }
        _ => Err(format!("'{line}' is no command")),
    }
}

/// A line on stdout. What C libraries may print there does not begin with a brace.
fn answer(value: &Value) -> Result<(), String> {
    let mut out = std::io::stdout().lock();
    writeln!(out, "{value}").and_then(|()| out.flush()).map_err(|e| format!("stdout: {e}"))
}
