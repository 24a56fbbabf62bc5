//! How simulated time follows real time (thesis, section 7.1).

use super::report::PaceReport;
use std::collections::VecDeque;
use std::time::{Duration, Instant};

/// Real-time mode of the Animation panel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RealTime {
    /// frames as fast as they can be computed
    Off,
    /// simulated time never runs ahead of real time; it may fall behind
    #[default]
    IfPossible,
    /// it does not fall behind either: after a slow frame the frames that are late are merged into one, with the physical
    /// steps of one
    Forced,
}

impl RealTime {
    /// All modes with the thesis's names.
    pub const ALL: [(RealTime, &'static str); 3] =
        [(RealTime::Off, "Off"), (RealTime::IfPossible, "If possible"), (RealTime::Forced, "Forced")];
}

/// Slowest and fastest simulated time \[simulated s per real s\].
pub const SPEEDS: std::ops::RangeInclusive<f64> = 1e-6..=1e6;
/// `If possible` makes up for at most one frame, and at most this much real time \[s\]: what is later is let go.
const CATCH_UP: f64 = 0.05;
/// `Forced` makes up for at most this much real time \[s\]: a computer that has slept does not wake with one giant step.
const MOST_LATE: f64 = 1.0;
/// Real time over which the rate of frames is averaged.
const RATE_WINDOW: Duration = Duration::from_secs(1);
/// Marks in that time lie this far apart, so that a fast simulation needs no more of them.
const MARK_EVERY: Duration = Duration::from_millis(10);
/// Frames slower than this \[s\] are blended into each other also where nothing else sets a pace.
const SLOW_FRAME: f64 = 0.02;
/// A picture never takes longer than this to blend \[s\].
const LONGEST_BLEND: f64 = 2.0;

/// When the next frame is to be made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Due {
    /// now: so many frames, merged into one where there are several
    Now(u32),
    /// not before then
    At(Instant),
}

/// Decides when frames are made. It never looks at a clock: every call says what time it is.
#[derive(Clone, Debug)]
pub struct Pace {
    mode: RealTime,
    speed: f64,
    fps: f64,
    /// when frame 0 of this run was due, and the number of the next; `None`: standing still
    run: Option<(Instant, f64)>,
    rate: Rate,
    skipped: u64,
    /// when the last frame was done, and the average time between two \[s\]
    latest: Option<(Instant, f64)>,
    since: Instant,
    blend: f64,
}

impl Pace {
    /// Standing still.
    pub fn new(fps: u32, now: Instant) -> Pace {
        Pace {
            mode: RealTime::default(),
            speed: 1.0,
            fps: f64::from(fps),
            run: None,
            rate: Rate::default(),
            skipped: 0,
            latest: None,
            since: now,
            blend: 0.0,
        }
    }

    /// Real time from frame to frame \[s\].
    fn period(&self) -> f64 {
        1.0 / (self.fps * self.speed)
    }

    /// Starts running: the first frame is due one period from now, because its end is one period of simulated time away.
    pub fn go(&mut self, now: Instant) {
        self.run = Some((now, 1.0));
        self.rate = Rate::default();
        self.latest = None;
    }

    /// Stands still.
    pub fn stop(&mut self) {
        self.run = None;
        self.latest = None;
    }

    /// The picture is to be what it is now: nothing is blended across a jump.
    pub fn jump(&mut self, now: Instant) {
        (self.since, self.blend) = (now, 0.0);
    }

    /// Begins to count skipped frames anew.
    pub fn forget_skipped(&mut self) {
        self.skipped = 0;
    }

    /// Sets the mode.
    pub fn set_mode(&mut self, mode: RealTime, now: Instant) {
        self.keeping_phase(now, |pace| pace.mode = mode);
    }

    /// Sets simulated seconds per real second.
    ///
    /// # Errors
    /// It is not a number in [`SPEEDS`].
    pub fn set_speed(&mut self, speed: f64, now: Instant) -> Result<(), String> {
        if !SPEEDS.contains(&speed) {
            let (low, high) = (SPEEDS.start(), SPEEDS.end());
            return Err(format!("speed = {speed} is out of range: {low} to {high} simulated seconds per real second"));
        }
        self.keeping_phase(now, |pace| pace.speed = speed);
        Ok(())
    }

    /// Sets frames per second of simulated time.
    pub fn set_fps(&mut self, fps: u32, now: Instant) {
        if f64::from(fps) != self.fps {
            self.keeping_phase(now, |pace| pace.fps = f64::from(fps.max(1)));
        }
    }

    /// Changes how fast time passes: the part of a frame that has passed stays what it is, so that a slider that is being
    /// dragged does not hold time up. Being late is forgotten.
    fn keeping_phase(&mut self, now: Instant, change: impl FnOnce(&mut Pace)) {
        let left = self.run.map(|run| (-self.late(run, now) / self.period()).clamp(0.0, 1.0));
        change(self);
        if let Some(left) = left {
            self.restart_run(now, -left * self.period());
        }
        self.rate = Rate::default();
    }

    /// How late the next frame is \[s\]; negative: how long it has time.
    fn late(&self, (start, next): (Instant, f64), now: Instant) -> f64 {
        let since =
            now.saturating_duration_since(start).as_secs_f64() - start.saturating_duration_since(now).as_secs_f64();
        since - next * self.period()
    }

    /// From now on the next frame is late by this \[s\].
    fn restart_run(&mut self, now: Instant, late: f64) {
        let start = if late > 0.0 {
            now.checked_sub(Duration::from_secs_f64(late)).unwrap_or(now)
        } else {
            now + Duration::from_secs_f64((-late).min(1e9))
        };
        self.run = Some((start, 0.0));
    }

    /// What to do now. Standing still, nothing is ever due: then the answer is a year away.
    pub fn due(&self, now: Instant) -> Due {
        let Some(run) = self.run else { return Due::At(now + Duration::from_secs(31_536_000)) };
        if self.mode == RealTime::Off {
            return Due::Now(1);
        }
        let (late, period) = (self.late(run, now), self.period());
        if late < 0.0 {
            // Rounded up: whoever waits until then finds the frame due.
            return Due::At(now + Duration::from_secs_f64((-late).min(1e9)) + Duration::from_nanos(1));
        }
        if self.mode == RealTime::IfPossible {
            return Due::Now(1);
        }
        Due::Now(((late.min(MOST_LATE) / period) as u32).saturating_add(1))
    }

    /// A frame is done that stands for so many.
    pub fn made(&mut self, merged: u32, now: Instant) {
        self.skipped += u64::from(merged.saturating_sub(1));
        self.rate.count(now);
        let own = self.period() * f64::from(merged);
        let average = match self.latest {
            None => own,
            Some((then, average)) => {
                let interval = now.saturating_duration_since(then).as_secs_f64();
                if average > 0.0 { average + 0.25 * (interval - average) } else { interval }
            }
        };
        self.blend = match self.mode {
            RealTime::Off if self.latest.is_none() || average < SLOW_FRAME => 0.0,
            RealTime::Off => average,
            RealTime::IfPossible | RealTime::Forced => average.max(own),
        }
        .min(LONGEST_BLEND);
        self.latest = Some((now, average));
        self.since = now;
        let Some((start, next)) = self.run else { return };
        let run = (start, next + f64::from(merged));
        self.run = Some(run);
        let bound = match self.mode {
            // Nothing is owed when another mode is chosen later.
            RealTime::Off => return self.restart_run(now, -self.period()),
            RealTime::IfPossible => CATCH_UP.min(self.period()),
            RealTime::Forced => MOST_LATE,
        };
        if self.late(run, now) > bound {
            self.restart_run(now, bound);
        }
    }

    /// What is shown of it.
    pub fn report(&self) -> PaceReport {
        PaceReport {
            real_time: self.mode,
            speed: self.speed,
            fps_reached: self.rate.reached(),
            skipped: self.skipped,
            since: self.since,
            blend: Duration::from_secs_f64(self.blend),
        }
    }
}

/// Frames per real second, averaged over about a second. The first frame starts the clock and is not counted: what came
/// before it (making the world, a pause) is no frame's time.
#[derive(Clone, Debug, Default)]
struct Rate {
    count: u64,
    marks: VecDeque<(Instant, u64)>,
    latest: Option<(Instant, u64)>,
}

impl Rate {
    fn count(&mut self, now: Instant) {
        self.count += 1;
        self.latest = Some((now, self.count));
        if self.marks.back().is_none_or(|m| now.saturating_duration_since(m.0) >= MARK_EVERY) {
            self.marks.push_back((now, self.count));
        }
        // The last mark before the window stays: slow frames are averaged over two at least.
        while self.marks.len() > 2 && now.saturating_duration_since(self.marks[1].0) >= RATE_WINDOW {
            self.marks.pop_front();
        }
    }

    fn reached(&self) -> f64 {
        let (Some(first), Some(last)) = (self.marks.front(), self.latest) else { return 0.0 };
        let seconds = last.0.saturating_duration_since(first.0).as_secs_f64();
        if seconds > 0.0 { (last.1 - first.1) as f64 / seconds } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Runs with frames that take so long \[s\]; returns when each was done and how many it stands for.
    fn run(pace: &mut Pace, start: Instant, seconds: f64, cost: impl Fn(usize) -> f64) -> Vec<(f64, u32)> {
        let mut now = start;
        let mut made = Vec::new();
        pace.go(now);
        while (now - start).as_secs_f64() < seconds {
            match pace.due(now) {
                Due::At(then) => {
                    assert!(then > now);
                    now = then;
                }
                Due::Now(merged) => {
                    now += Duration::from_secs_f64(cost(made.len()));
                    pace.made(merged, now);
                    made.push(((now - start).as_secs_f64(), merged));
                }
            }
        }
        made
    }

    fn pace(mode: RealTime) -> (Pace, Instant) {
        let now = Instant::now();
        let mut pace = Pace::new(50, now);
        pace.set_mode(mode, now);
        (pace, now)
    }

    #[test]
    fn off_makes_frames_as_fast_as_they_come() {
        let (mut pace, now) = pace(RealTime::Off);
        let made = run(&mut pace, now, 2.0, |_| 0.001);
        assert!((1999..=2001).contains(&made.len()), "{}", made.len());
        assert!((pace.report().fps_reached - 1000.0).abs() < 1.0, "{}", pace.report().fps_reached);
        assert_eq!((pace.report().blend, pace.report().skipped), (Duration::ZERO, 0));
    }

    #[test]
    fn off_blends_frames_that_are_slow() {
        let (mut pace, now) = pace(RealTime::Off);
        run(&mut pace, now, 10.0, |_| 0.2);
        assert!((pace.report().blend.as_secs_f64() - 0.2).abs() < 0.01);
    }

    #[test]
    fn if_possible_never_runs_ahead() {
        let (mut pace, now) = pace(RealTime::IfPossible);
        let made = run(&mut pace, now, 5.0, |i| if i % 7 == 0 { 0.015 } else { 0.001 });
        for (i, (time, merged)) in made.iter().enumerate() {
            assert!((i + 1) as f64 * 0.02 <= *time, "frame {i} at {time}");
            assert_eq!(*merged, 1);
        }
        assert!((249..=250).contains(&made.len()), "{}", made.len());
        assert!((pace.report().fps_reached - 50.0).abs() < 1.0);
    }

    #[test]
    fn if_possible_falls_behind_and_does_not_hurry_after() {
        let (mut pace, now) = pace(RealTime::IfPossible);
        let made = run(&mut pace, now, 3.0, |i| if i == 20 { 1.0 } else { 0.001 });
        let late = made[20].0;
        let hurried = made.iter().filter(|(t, _)| *t > late && *t < late + 0.02 * 0.99).count();
        assert!(hurried <= 2, "{hurried}: one that is due, and one that is made up for");
        let after = made.iter().filter(|(t, _)| *t > late && *t <= late + 1.0).count();
        assert!((49..=51).contains(&after), "{after} frames in the second after");
    }

    #[test]
    fn a_slow_simulation_runs_as_fast_as_it_can_if_possible() {
        let (mut pace, now) = pace(RealTime::IfPossible);
        let made = run(&mut pace, now, 5.0, |_| 0.1);
        assert!((49..=50).contains(&made.len()), "{}", made.len());
        assert!((pace.report().fps_reached - 10.0).abs() < 0.1);
        assert!((pace.report().blend.as_secs_f64() - 0.1).abs() < 0.01, "the picture moves on until the next frame");
    }

    #[test]
    fn forced_merges_the_frames_that_are_late() {
        let (mut pace, now) = pace(RealTime::Forced);
        let made = run(&mut pace, now, 5.0, |_| 0.1);
        let mut frames = 0;
        for (i, (time, merged)) in made.iter().enumerate() {
            frames += merged;
            let simulated = f64::from(frames) * 0.02;
            assert!(simulated <= *time, "ahead: {simulated} s at {time}");
            assert!(simulated > time - 0.1 - 0.02 - 1e-9, "frame {i}: {simulated} s at {time}");
        }
        assert_eq!(made[1].1, 5, "0.1 s at 50 frames per second");
        assert_eq!(pace.report().skipped, made.iter().map(|m| u64::from(m.1) - 1).sum::<u64>());
    }

    #[test]
    fn forced_does_not_make_up_for_a_computer_that_slept() {
        let (mut pace, now) = pace(RealTime::Forced);
        let made = run(&mut pace, now, 200.0, |i| if i == 3 { 100.0 } else { 0.001 });
        assert_eq!(made[4].1, 51, "a second and the frame that is due");
        assert!(made[5..].iter().all(|m| m.1 == 1));
    }

    #[test]
    fn forced_with_time_to_spare_merges_nothing() {
        let (mut pace, now) = pace(RealTime::Forced);
        let made = run(&mut pace, now, 2.0, |_| 0.01);
        assert!(made.iter().all(|m| m.1 == 1));
        assert_eq!(pace.report().skipped, 0);
    }

    #[test]
    fn slow_motion_stretches_time() {
        let (mut pace, now) = pace(RealTime::IfPossible);
        pace.set_speed(0.1, now).unwrap();
        let made = run(&mut pace, now, 5.0, |_| 0.001);
        assert!((24..=25).contains(&made.len()), "{}", made.len());
        assert!((pace.report().blend.as_secs_f64() - 0.2).abs() < 1e-6);
        for wrong in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e7] {
            assert!(pace.set_speed(wrong, now).is_err());
            assert_eq!(pace.report().speed, 0.1);
        }
    }

    #[test]
    fn a_slider_that_is_dragged_does_not_hold_time_up() {
        let (mut pace, start) = pace(RealTime::IfPossible);
        pace.go(start);
        let (mut now, mut made) = (start, 0);
        for i in 0..1000 {
            now += Duration::from_millis(5);
            pace.set_speed(if i % 2 == 0 { 1.0 } else { 0.9 }, now).unwrap();
            while let Due::Now(n) = pace.due(now) {
                pace.made(n, now);
                made += 1;
            }
        }
        // 5 s at a mean speed of 0.95 and 50 frames per second, each a little later for waiting for the next event.
        assert!((200..=240).contains(&made), "{made} frames in 5 s");
    }

    #[test]
    fn the_first_frame_is_no_part_of_the_rate() {
        let (mut pace, now) = pace(RealTime::Off);
        run(&mut pace, now, 3.5, |i| if i == 0 { 3.0 } else { 0.01 });
        assert!((pace.report().fps_reached - 100.0).abs() < 1.0, "{}", pace.report().fps_reached);
    }

    #[test]
    fn standing_still_nothing_is_due() {
        let (mut pace, now) = pace(RealTime::Off);
        assert!(matches!(pace.due(now), Due::At(_)));
        pace.go(now);
        assert_eq!(pace.due(now), Due::Now(1));
        pace.stop();
        assert!(matches!(pace.due(now), Due::At(_)));
    }

    #[test]
    fn nothing_is_owed_after_off() {
        let (mut pace, start) = pace(RealTime::Off);
        let mut now = start;
        pace.go(now);
        for _ in 0..100 {
            now += Duration::from_millis(200);
            pace.made(1, now);
        }
        pace.set_mode(RealTime::Forced, now);
        assert!(!matches!(pace.due(now), Due::Now(2..)), "{:?}", pace.due(now));
    }

    #[test]
    fn any_frame_rate_is_survived() {
        for fps in [1, 1_000_000_000] {
            for mode in [RealTime::IfPossible, RealTime::Forced] {
                let now = Instant::now();
                let mut pace = Pace::new(fps, now);
                pace.set_mode(mode, now);
                pace.set_speed(*SPEEDS.end(), now).unwrap();
                pace.go(now);
                let Due::Now(n) = pace.due(now + Duration::from_secs(5)) else { panic!("a frame is due") };
                pace.made(n, now + Duration::from_secs(5));
            }
        }
    }
}
