//! A world that lives on a thread of its own: commands go in, reports come out. Drawing never waits for physics, nor
//! physics for drawing.

// The contract is wider than what the window happens to use.
#![allow(dead_code, unused_imports)]

// The contract.
mod command;
mod report;

// How time passes.
mod pace;
mod time_code;

// The worlds, how they are changed, seen and recorded.
mod machine;
mod hold;
mod lane;
mod extras;
mod tape;
mod core;
mod restore;
mod telling;
mod worker;
#[cfg(test)]
mod tests;

pub use command::{Command, Grip, Studio, Wish};
pub use pace::RealTime;
pub use report::{Extras, Numbers, PaceReport, Report, Sample, Shot, Side, Timeline};
pub use time_code::time_code;

use mrtphys_scene::{Diagnostics, Scene};
use std::sync::mpsc::Sender;
use std::thread::JoinHandle;

/// A scene that is being simulated. Dropping it ends the thread.
pub struct Session {
    commands: Option<Sender<Command>>,
    mailbox: worker::Mailbox,
    thread: Option<JoinHandle<()>>,
    report: Report,
}

impl Session {
    /// Builds the scene's world and starts its thread, standing still at the first frame. `wake` is called from that
    /// thread whenever there is a new report.
    ///
    /// # Errors
    /// The world cannot be made: what is wrong with the scene, and where.
    pub fn start(scene: Scene, wake: impl Fn() + Send + 'static) -> Result<Session, Diagnostics> {
        worker::start(scene, Box::new(wake))
    }

    /// Steers. Commands take effect in their order, between two physical steps.
    pub fn send(&self, command: Command) {
        if let Some(commands) = &self.commands {
            // A thread that is gone has said why in its last report.
            let _ = commands.send(command);
        }
    }

    /// Changes the world (and its rival, if there is one): between two steps, also while running. What `change` says went
    /// wrong appears as the report's trouble. `structural`: bodies come or go, or look different.
    pub fn edit(
        &self,
        structural: bool,
        change: impl Fn(&mut mrtphys_scene::Loaded) -> Result<(), String> + Send + 'static,
    ) {
        self.send(Command::Edit { change: Box::new(change), structural });
    }

    /// Takes the newest report, if there is one since the last call.
    pub fn poll(&mut self) -> bool {
        self.mailbox.take(&mut self.report)
    }

    /// The newest report.
    pub fn report(&self) -> &Report {
        &self.report
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        self.commands = None;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}
