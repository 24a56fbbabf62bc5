//! The comparison: this engine and its peers on the same scenes, in one run, speed beside truth.
//!
//! Every engine runs in a process of its own, this same program started again, so that one that fails loses nothing of the
//! others. Within a scene they take turns: a burst of steps each, round after round, so that what else goes on at the machine
//! strikes all alike. Every result is written to a file of JSON lines as soon as it is there; the tables are made from that
//! file alone.

pub mod check;
mod child;
mod conductor;
mod figures;
mod machine;
mod options;
pub mod overlap;
mod report;
mod results;
pub mod scenes;
pub mod session;
pub mod stats;

pub use options::HELP;

use options::Options;
use serde_json::Value;
use std::fs::File;
use std::io::{BufRead, BufReader, Write};
use std::path::Path;

/// First argument of a process that serves one engine.
const SERVE: &str = "--serve";

/// Runs the comparison with the arguments that follow its name. `again` are the arguments with which this program comes here
/// once more.
///
/// # Errors
/// What is wrong with the arguments or the files, in words. An engine that fails is a result, not an error.
pub fn run(args: &[String], again: &[&str]) -> Result<(), String> {
    if args.first().is_some_and(|a| a == SERVE) {
        return child::serve(&args[1..]);
    }
    if args.iter().any(|a| a == "--help" || a == "-h") {
        print!("{HELP}");
        return Ok(());
    }
    let options = Options::parse(args)?;
    let records = match &options.from {
        Some(path) => read_records(path)?,
        None => measure(&options, args, again)?,
    };
    let tables = report::tables(&records);
    if let Some(path) = &options.markdown {
        let pictures = figures::write(path, &figures::all(&records))?;
        report::splice(path, &(pictures + &tables))?;
    }
    say(&tables)
}

fn measure(options: &Options, args: &[String], again: &[&str]) -> Result<Vec<Value>, String> {
    let folder = &options.folder;
    std::fs::create_dir_all(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let path = folder.join("results.jsonl");
    let file = File::create(&path).map_err(|e| format!("{}: {e}", path.display()))?;
    let mut log = Log { file, records: Vec::new(), scene: String::new() };
    let command = [&["mrtphys-bench".to_string()], args].concat().join(" ");
    log.put(machine::record(&command, options.threads))?;
    say(&format!("results as they come: {}", path.display()))?;
    for scene in &options.scenes {
        conductor::conduct(scene, options, again, &mut log)?;
        say(&report::details(&log.records, &scene.name))?;
    }
    Ok(log.records)
}

/// The results, in a file and at hand.
struct Log {
    file: File,
    records: Vec<Value>,
    /// name of the scene under way
    scene: String,
}

impl Log {
    fn put(&mut self, record: Value) -> Result<(), String> {
        writeln!(self.file, "{record}").and_then(|()| self.file.flush()).map_err(|e| format!("results: {e}"))?;
        self.records.push(record);
        Ok(())
    }
}

fn read_records(path: &Path) -> Result<Vec<Value>, String> {
    let words = |e: &dyn std::fmt::Display| format!("{}: {e}", path.display());
    let file = File::open(path).map_err(|e| words(&e))?;
    let mut records = Vec::new();
    for line in BufReader::new(file).lines() {
        // The last line of a run that was broken off may be half a line.
        if let Ok(record) = serde_json::from_str(&line.map_err(|e| words(&e))?) {
            records.push(record);
        }
    }
    Ok(records)
}

/// Text on stdout. A closed pipe ends the run in words.
fn say(text: &str) -> Result<(), String> {
    writeln!(std::io::stdout().lock(), "{text}").map_err(|e| format!("stdout: {e}"))
}
