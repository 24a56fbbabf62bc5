//! Times and their middle.

use cpu_time::ProcessTime;
use std::time::{Duration, Instant};

/// The middle of some numbers, the mean of the two middle ones for an even count; `None` of none.
pub fn median(values: &[f64]) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let n = sorted.len();
    match n {
        0 => None,
        _ => Some(0.5 * (sorted[(n - 1) / 2] + sorted[n / 2])),
    }
}

/// Greatest less smallest, as a part of the median; `None` for fewer than two numbers.
pub fn spread(values: &[f64]) -> Option<f64> {
    let (low, high) = values.iter().fold((f64::MAX, f64::MIN), |(l, h), &x| (l.min(x), h.max(x)));
    (values.len() > 1).then(|| Some((high - low) / median(values)?))?
}

/// What is kept of the times of some steps \[s\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Times {
    /// median of the steps
    pub median: f64,
    /// mean of the steps
    pub mean: f64,
    /// from the first step's begin to the last one's end
    pub total: f64,
}

impl Times {
    /// Those of the steps, with the time of all together.
    pub fn of(steps: &[f64], total: Duration) -> Times {
        let mean = steps.iter().sum::<f64>() / steps.len() as f64;
        Times { median: median(steps).unwrap_or(f64::NAN), mean, total: total.as_secs_f64() }
    }
}

/// Both clocks.
pub struct Clock {
    cpu: ProcessTime,
    wall: Instant,
}

impl Clock {
    /// Starts them.
    ///
    /// # Errors
    /// The system has no clock of the time that a process computes, in words.
    pub fn start() -> Result<Clock, String> {
        let cpu = ProcessTime::try_now().map_err(|e| format!("the clock of the processor time: {e}"))?;
        Ok(Clock { cpu, wall: Instant::now() })
    }

    /// Time that all threads of this process computed, and time that went by.
    pub fn read(&self) -> (Duration, Duration) {
        (self.cpu.elapsed(), self.wall.elapsed())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_is_the_middle() {
        assert_eq!(median(&[]), None);
        assert_eq!(median(&[3.0]), Some(3.0));
        assert_eq!(median(&[9.0, 1.0, 2.0]), Some(2.0));
        assert_eq!(median(&[9.0, 1.0, 2.0, 4.0]), Some(3.0));
        assert_eq!(spread(&[2.0]), None);
        assert_eq!(spread(&[9.0, 1.0, 2.0]), Some(4.0));
    }
}
