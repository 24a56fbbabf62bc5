//! Ctrl-C. The first asks the run to end after the current step and to write what was reached; the second ends the program.

use crate::exit::{Failure, INTERRUPTED, Outcome};
use std::sync::atomic::{AtomicBool, Ordering};

static ASKED: AtomicBool = AtomicBool::new(false);

/// From now on an interrupt (or a request to terminate) is a question that [`asked`] answers.
pub fn listen() -> Outcome {
    let handler = || {
        if ASKED.swap(true, Ordering::Relaxed) {
            std::process::exit(i32::from(INTERRUPTED));
        }
    };
    ctrlc::set_handler(handler).map_err(|e| Failure::Stopped(format!("cannot listen to interrupts: {e}")))
}

/// Whether an interrupt has arrived.
pub fn asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}
