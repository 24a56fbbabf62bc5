//! How far a run goes: whole steps, and a shortened last one where the end falls between two. Time is never accumulated:
//! it is step / (fps x steps per frame), and the steps are counted.

/// Where a run ends, counted from the start of the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum End {
    /// after this time \[s\]
    Seconds(f64),
    /// after this number of frames
    Frames(u64),
}

/// The grid of time: frames per second, and physical steps per frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Beat {
    /// frames per second \[1/s\]
    pub fps: u32,
    /// physical steps per frame
    pub steps_per_frame: u32,
}

impl Beat {
    /// Steps per second \[1/s\].
    pub fn rate(self) -> u64 {
        u64::from(self.fps) * u64::from(self.steps_per_frame)
    }
}

/// Length of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Length {
    /// 1 / (fps x steps per frame)
    Full,
    /// the shortened last one \[s\]
    Rest(f64),
}

/// The steps still to make, in order.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    steps_per_frame: u64,
    /// full steps behind us, counted from where `full` is counted
    done: u64,
    full: u64,
    rest: f64,
}

/// Largest number of steps that a double counts exactly.
const MOST_STEPS: f64 = (1u64 << 53) as f64;

impl Plan {
    /// The steps from (`steps`, `time`) to the end; none if the end is behind.
    ///
    /// A world that has only made full steps at this beat goes on in the same grid, so that a run in two parts makes the
    /// steps of a run in one. Otherwise (the beat was changed, or the run before ended with a shortened step) the grid
    /// starts anew at `time`.
    pub fn new(end: End, beat: Beat, steps: u64, time: f64) -> Result<Plan, String> {
        let rate = beat.rate();
        let steps_per_frame = u64::from(beat.steps_per_frame);
        let (full, rest) = match end {
            End::Seconds(seconds) => split(seconds, rate)?,
            End::Frames(frames) => (steps_of(frames, steps_per_frame)?, 0.0),
        };
        if time == steps as f64 / rate as f64 {
            let (full, rest) = if steps > full { (steps, 0.0) } else { (full, rest) };
            return Ok(Plan { steps_per_frame, done: steps, full, rest });
        }
        let end_time = match end {
            End::Seconds(seconds) => seconds,
            End::Frames(frames) => frames as f64 / f64::from(beat.fps),
        };
        // Below round-off of the end there is nothing left to do.
        let left = end_time - time;
        let left = if left > 4.0 * f64::EPSILON * end_time { left } else { 0.0 };
        let (full, rest) = split(left, rate)?;
        Ok(Plan { steps_per_frame, done: 0, full, rest })
    }

    /// Steps still to make, the shortened one included.
    pub fn steps_left(&self) -> u64 {
        self.full - self.done + u64::from(self.rest > 0.0)
    }

    /// The next step, and whether a frame ends with it.
    pub fn next(&mut self) -> Option<(Length, bool)> {
        if self.done < self.full {
            self.done += 1;
            let last = self.done == self.full && self.rest == 0.0;
            return Some((Length::Full, last || self.done.is_multiple_of(self.steps_per_frame)));
        }
        if self.rest > 0.0 {
            return Some((Length::Rest(std::mem::take(&mut self.rest)), true));
        }
        None
    }
}

/// Frames that lie completely behind (`steps`, `time`).
pub fn frames_behind(beat: Beat, steps: u64, time: f64) -> u64 {
    if time == steps as f64 / beat.rate() as f64 {
        steps / u64::from(beat.steps_per_frame)
    } else {
        // Another beat, or a shortened step: what fits into the time, a frame that lacks a rounding error counted.
        (time * f64::from(beat.fps) * (1.0 + 4.0 * f64::EPSILON)) as u64
    }
}

fn steps_of(frames: u64, steps_per_frame: u64) -> Result<u64, String> {
    frames
        .checked_mul(steps_per_frame)
        .filter(|&n| n as f64 <= MOST_STEPS)
        .ok_or_else(|| format!("{frames} frames of {steps_per_frame} steps are more than 2^53 steps"))
}

/// Full steps that fit into a time, and the rest \[s\]. A time such as 0.1 s is a rounded decimal, and its product with
/// the rate is rounded again: within four units in the last place a whole number of steps is meant.
fn split(seconds: f64, rate: u64) -> Result<(u64, f64), String> {
    check_seconds(seconds)?;
    let steps = seconds * rate as f64;
    if steps > MOST_STEPS {
        return Err(format!("{seconds} s at {rate} steps per second are more than 2^53 steps"));
    }
    let nearest = steps.round();
    if (nearest / rate as f64 - seconds).abs() <= 4.0 * f64::EPSILON * seconds {
        return Ok((nearest as u64, 0.0));
    }
    let full = steps.floor();
    Ok((full as u64, seconds - full / rate as f64))
}

/// Whether a length of a run is one.
pub fn check_seconds(seconds: f64) -> Result<(), String> {
    if seconds == 0.0 || (seconds.is_normal() && seconds > 0.0) {
        Ok(())
    } else {
        Err(format!("{seconds} is not a length of time: a finite number of seconds, not negative, is needed"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BEAT: Beat = Beat { fps: 60, steps_per_frame: 8 };

    fn all(mut plan: Plan) -> Vec<(Length, bool)> {
        std::iter::from_fn(|| plan.next()).collect()
    }

    #[test]
    fn a_tenth_of_a_second_is_48_steps_and_6_frames() {
        let plan = Plan::new(End::Seconds(0.1), BEAT, 0, 0.0).unwrap();
        assert_eq!(plan.steps_left(), 48);
        let steps = all(plan);
        assert!(steps.iter().all(|s| s.0 == Length::Full));
        let ends: Vec<_> = steps.iter().enumerate().filter(|(_, s)| s.1).map(|(i, _)| i + 1).collect();
        assert_eq!(ends, [8, 16, 24, 32, 40, 48]);
    }

    #[test]
    fn the_last_step_and_frame_are_shortened() {
        // 0.0123 s x 480/s = 5.904 steps
        let steps = all(Plan::new(End::Seconds(0.0123), BEAT, 0, 0.0).unwrap());
        assert_eq!(steps.len(), 6);
        assert!(steps[..5].iter().all(|s| *s == (Length::Full, false)));
        assert_eq!(steps[5], (Length::Rest(0.0123 - 5.0 / 480.0), true));
        // 1.01 s = 484.8 steps: 60 frames of 8 and one of 4.8
        let steps = all(Plan::new(End::Seconds(1.01), BEAT, 0, 0.0).unwrap());
        assert_eq!(steps.len(), 485);
        assert_eq!(steps.iter().filter(|s| s.1).count(), 61);
    }

    #[test]
    fn decimals_that_mean_whole_steps_are_whole() {
        // n/10 and n/60 s written in decimal; 0.7 * 480 is 335.99999999999994 in doubles
        for n in 1..20_000u64 {
            for (seconds, steps) in [(n as f64 / 10.0, 48 * n), (n as f64 / 60.0, 8 * n), (n as f64 * 0.1, 48 * n)] {
                let plan = Plan::new(End::Seconds(seconds), BEAT, 0, 0.0).unwrap();
                assert_eq!((plan.full, plan.rest), (steps, 0.0), "{seconds} s");
            }
        }
    }

    #[test]
    fn a_fraction_of_a_step_stays_one_far_from_the_start() {
        let plan = Plan::new(End::Seconds(1e6 + 0.001), BEAT, 0, 0.0).unwrap();
        assert_eq!(plan.full, 480_000_000);
        assert!((plan.rest - 0.001).abs() < 1e-9);
    }

    #[test]
    fn a_run_in_two_parts_makes_the_steps_of_one() {
        let whole = all(Plan::new(End::Seconds(0.0523), BEAT, 0, 0.0).unwrap());
        for first in 0..=whole.len() - 1 {
            let time = first as f64 / 480.0;
            let second = all(Plan::new(End::Seconds(0.0523), BEAT, first as u64, time).unwrap());
            assert_eq!(second, whole[first..], "after {first} steps");
        }
    }

    #[test]
    fn after_a_shortened_step_the_rest_is_made_up() {
        // 6 steps to 0.0123 s; then on to 0.1 s: 0.0877 s x 480/s = 42.096 steps
        let plan = Plan::new(End::Seconds(0.1), BEAT, 6, 0.0123).unwrap();
        assert_eq!(plan.steps_left(), 43);
        assert!((plan.rest - 0.096 / 480.0).abs() < 1e-15);
        // another beat
        let plan = Plan::new(End::Frames(6), Beat { fps: 60, steps_per_frame: 4 }, 24, 0.05).unwrap();
        assert_eq!(all(plan).len(), 12);
        assert_eq!(frames_behind(Beat { fps: 60, steps_per_frame: 4 }, 24, 0.05), 3);
    }

    #[test]
    fn an_end_that_is_behind_needs_no_step() {
        assert_eq!(Plan::new(End::Frames(2), BEAT, 48, 0.1).unwrap().steps_left(), 0);
        assert_eq!(Plan::new(End::Seconds(0.0), BEAT, 0, 0.0).unwrap().steps_left(), 0);
        assert_eq!(Plan::new(End::Seconds(0.01), BEAT, 6, 0.0123).unwrap().steps_left(), 0);
        assert_eq!(Plan::new(End::Seconds(0.0123), BEAT, 6, 0.0123).unwrap().steps_left(), 0);
    }

    #[test]
    fn what_is_no_length_of_time_is_refused() {
        for seconds in [-1.0, f64::NAN, f64::INFINITY, -f64::INFINITY, 1e-310, 1e300] {
            assert!(Plan::new(End::Seconds(seconds), BEAT, 0, 0.0).is_err(), "{seconds}");
        }
        assert!(Plan::new(End::Frames(u64::MAX), BEAT, 0, 0.0).is_err());
        assert!(Plan::new(End::Frames(1 << 52), BEAT, 0, 0.0).is_err());
    }
}
