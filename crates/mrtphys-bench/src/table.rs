//! Measurements as text.

use crate::measure::Measurement;
use std::fmt::Write;

/// Head of the table.
pub fn head() -> String {
    format!(
        "{:<14} {:>8} {:>6} {:>10} {:>10} {:>8}  {:<46} {:>9} {:>11} {:>6} {:>6} {:>4}  {}",
        "scene",
        "bodies",
        "steps",
        "ms/step",
        "mean ms",
        "ns/body",
        "share of the stages",
        "E/E0 - 1",
        "collisions/s",
        "/theory",
        "step/d",
        "out",
        "state hash"
    )
}

/// A line of the table.
pub fn line(m: &Measurement) -> String {
    let total: f64 = m.stages.iter().map(|s| s.1.as_secs_f64()).sum();
    let mut shares = String::new();
    for (name, time) in &m.stages {
        let share = 100.0 * time.as_secs_f64() / total;
        if share >= 0.5 {
            let _ = write!(shares, "{name} {share:.0}% ");
        }
    }
    format!(
        "{:<14} {:>8} {:>6} {:>10.4} {:>10.4} {:>8.1}  {:<46} {:>9.1e} {:>11.4e} {:>6.3} {:>6.2} {:>4}  {}",
        m.scene,
        m.bodies,
        m.steps,
        1e3 * m.step_seconds,
        1e3 * m.mean_seconds,
        1e9 * m.step_seconds / m.bodies as f64,
        shares.trim_end(),
        m.energy_error,
        m.collisions_per_second,
        m.collisions_per_second / m.theory,
        m.largest_step,
        m.escaped,
        m.state_hash
    )
}
