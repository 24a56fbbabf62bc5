//! Progress on stderr: one line that is rewritten on a terminal, a line every few seconds elsewhere.

use std::fmt;
use std::io::{IsTerminal, Write};
use std::time::{Duration, Instant};

/// Time between two lines on a terminal.
const REFRESH: Duration = Duration::from_millis(100);
/// Time between two lines in a file or a pipe.
const LOG_EVERY: Duration = Duration::from_secs(5);

/// Tells how far a run has come.
pub struct Progress {
    shown: bool,
    terminal: bool,
    started: Instant,
    due: Instant,
    steps_total: u64,
    line_open: bool,
}

impl Progress {
    /// Starts the clock.
    pub fn new(quiet: bool, steps_total: u64) -> Progress {
        let terminal = std::io::stderr().is_terminal();
        let started = Instant::now();
        let due = started + if terminal { REFRESH } else { LOG_EVERY };
        Progress { shown: !quiet, terminal, started, due, steps_total, line_open: false }
    }

    /// Wall time since the start \[s\].
    pub fn seconds(&self) -> f64 {
        self.started.elapsed().as_secs_f64()
    }

    /// After a step.
    pub fn tick(&mut self, steps: u64, time: f64) {
        if !self.shown {
            return;
        }
        let now = Instant::now();
        if now < self.due {
            return;
        }
        self.due = now + if self.terminal { REFRESH } else { LOG_EVERY };
        let line = line(steps, self.steps_total, time, self.seconds());
        let mut err = std::io::stderr().lock();
        let _ = if self.terminal { write!(err, "\r\x1b[2K{line}") } else { writeln!(err, "{line}") };
        let _ = err.flush();
        self.line_open = self.terminal;
    }

    /// Wipes the line, so that what follows starts on a clean one.
    pub fn clear(&mut self) {
        if std::mem::take(&mut self.line_open) {
            let _ = write!(std::io::stderr().lock(), "\r\x1b[2K");
        }
    }
}

fn line(steps: u64, total: u64, time: f64, wall: f64) -> String {
    let rate = steps as f64 / wall.max(1e-9);
    let percent = 100.0 * steps as f64 / total.max(1) as f64;
    let left = (total.saturating_sub(steps)) as f64 / rate.max(1e-9);
    format!("{percent:5.1} %  step {steps} of {total}  {time:.3} s simulated  {rate:.0} steps/s  {} left", Clock(left))
}

/// Seconds as a person reads them.
pub struct Clock(pub f64);

impl fmt::Display for Clock {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let s = self.0.round();
        if !s.is_finite() || s >= 1e9 {
            f.write_str("ages")
        } else if s < 100.0 {
            write!(f, "{s} s")
        } else {
            let (hours, minutes) = ((s / 3600.0).floor(), (s % 3600.0 / 60.0).floor());
            if hours > 0.0 { write!(f, "{hours} h {minutes} min") } else { write!(f, "{minutes} min {} s", s % 60.0) }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_says_how_far_and_how_long() {
        let text = line(120, 480, 0.25, 2.0);
        assert_eq!(text, " 25.0 %  step 120 of 480  0.250 s simulated  60 steps/s  6 s left");
    }

    #[test]
    fn durations_are_readable() {
        let text = |s| Clock(s).to_string();
        assert_eq!([text(0.2), text(99.0), text(100.0)], ["0 s", "99 s", "1 min 40 s"]);
        assert_eq!([text(3600.0), text(7384.0), text(1e12)], ["1 h 0 min", "2 h 3 min", "ages"]);
        assert_eq!(text(f64::NAN), "ages");
    }
}
