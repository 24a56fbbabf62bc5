//! How a command ends: the exit statuses of the interface contract.

use std::fmt;
use std::process::ExitCode;

/// Exit status of an interrupted run (128 + SIGINT).
pub const INTERRUPTED: u8 = 130;

/// Why a command did not do what it was asked to.
#[derive(Debug)]
pub enum Failure {
    /// The scene, an option or a file given is wrong: exit status 1. Nothing was simulated.
    Wrong(String),
    /// Something gave way while the command worked (the simulation, a disk, a pipe): exit status 2.
    Stopped(String),
    /// The user interrupted; what was reached has been written: exit status 130.
    Interrupted,
}

/// The result of a command.
pub type Outcome<T = ()> = Result<T, Failure>;

impl Failure {
    /// A part of the contract that this version does not have yet, with what to do instead.
    pub fn not_yet(what: impl fmt::Display, instead: &str) -> Failure {
        Failure::Wrong(format!("{what}: not in this version; {instead}"))
    }

    /// The exit status.
    pub fn status(&self) -> u8 {
        match self {
            Failure::Wrong(_) => 1,
            Failure::Stopped(_) => 2,
            Failure::Interrupted => INTERRUPTED,
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Failure::Wrong(text) | Failure::Stopped(text) => f.write_str(text),
            Failure::Interrupted => f.write_str("interrupted"),
        }
    }
}

/// Says on stderr what went wrong, and gives the exit status.
pub fn finish(outcome: Outcome) -> ExitCode {
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            complain(&failure.to_string());
            ExitCode::from(failure.status())
        }
    }
}

/// A message on stderr, `error:` before it unless it brings its own. A closed stderr is no reason to panic.
pub fn complain(text: &str) {
    use std::io::Write;
    let text = text.trim_end();
    let prefix = if text.starts_with("error") { "" } else { "error: " };
    let _ = writeln!(std::io::stderr().lock(), "{prefix}{text}");
}

/// A warning on stderr. Warnings are shown under `--quiet` too: they are not progress.
pub fn warn(text: &str) {
    use std::io::Write;
    let _ = writeln!(std::io::stderr().lock(), "warning: {text}");
}
