//! Counts and times of one method in one scene.

use super::methods::Method;
use super::scenes::Arena;
use mrtphys::World;
use mrtphys::work::StageTimes;
use std::time::{Duration, Instant};

/// Steps per frame, as in the thesis.
pub const STEPS_PER_FRAME: u32 = 8;

/// Which steps are measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Which {
    /// all of them from the start, repeated until the times are good
    All {
        /// number of steps
        steps: u32,
    },
    /// windows spread evenly over the run. All methods give the same trajectory, so the broad phase made for speed moves the
    /// scene from window to window
    Windows {
        /// number of steps of the run
        steps: u32,
        /// number of windows
        windows: u32,
        /// measured steps in a window
        each: u32,
    },
}

impl Which {
    /// Number of steps that are measured.
    pub fn measured(self) -> u32 {
        match self {
            Which::All { steps } => steps,
            Which::Windows { windows, each, .. } => windows * each,
        }
    }
}

/// What a method did in a scene.
#[derive(Clone, Debug)]
pub struct Measured {
    /// the scene
    pub arena: Arena,
    /// the method
    pub method: Method,
    /// steps that were counted
    pub steps: u32,
    /// bounding-sphere tests in all of them
    pub sphere_tests: u64,
    /// of them, those that needed a special test
    pub detect_calls: u64,
    /// contacts found
    pub contacts: u64,
    /// bounding-sphere tests and special tests in the last steps of the frames, and the number of these: what the thesis's
    /// program showed
    pub shown: [u64; 3],
    /// the largest distance moved in a step, in diameters
    pub largest_step: f64,
    /// how often the run was repeated
    pub repetitions: u32,
    /// wall time of a step \[s\]: for each step the shortest of its repetitions, then the mean over the steps
    pub step_seconds: f64,
    /// mean over steps and repetitions \[s\]
    pub mean_seconds: f64,
    /// time of a stage in a step \[s\], taken as `step_seconds`
    pub stages: [f64; 6],
}

/// Names of the stages.
pub const STAGES: [&str; 6] = ["motion", "bounds", "broad", "narrow", "impact", "projection"];

/// Time of a step and of its stages.
type Times = [Duration; 7];

/// Sums over steps.
#[derive(Clone, Debug, Default)]
struct Sums {
    tests: u64,
    detects: u64,
    contacts: u64,
    shown: [u64; 3],
    /// shortest times of each step so far
    shortest: Vec<Times>,
    /// of all repetitions together
    spent: Duration,
    timed: u32,
    repetitions: u32,
}

impl Sums {
    /// Makes steps, counts them, and measures the times of the first repetition.
    fn count(&mut self, world: &mut World, steps: u32) -> Result<(), String> {
        for _ in 0..steps {
            let times = self.step(world)?;
            self.shortest.push(times);
            let c = world.counters();
            self.tests += c.sphere_tests;
            self.detects += c.detect_calls;
            self.contacts += c.contacts;
            if world.steps().is_multiple_of(u64::from(STEPS_PER_FRAME)) {
                let add = [c.sphere_tests, c.detect_calls, 1];
                self.shown = std::array::from_fn(|i| self.shown[i] + add[i]);
            }
        }
        Ok(())
    }

    /// Makes the latest steps again, for the sake of their times: the same work to the last bit.
    fn repeat(&mut self, world: &mut World, steps: u32) -> Result<(), String> {
        let first = self.shortest.len() - steps as usize;
        for i in first..self.shortest.len() {
            let times = self.step(world)?;
            self.shortest[i] = std::array::from_fn(|k| self.shortest[i][k].min(times[k]));
        }
        Ok(())
    }

    fn step(&mut self, world: &mut World) -> Result<Times, String> {
        let start = Instant::now();
        world.step().map_err(|e| e.to_string())?;
        let time = start.elapsed();
        self.spent += time;
        self.timed += 1;
        let &StageTimes { motion, bounds, broad, narrow, impact, projection } = world.stage_times();
        Ok([time, motion, bounds, broad, narrow, impact, projection])
    }

    fn measured(&self, arena: Arena, method: Method, largest_step: f64) -> Measured {
        let steps = self.shortest.len().max(1) as f64;
        let mean = |k: usize| self.shortest.iter().map(|t| t[k]).sum::<Duration>().as_secs_f64() / steps;
        Measured {
            arena,
            method,
            steps: self.shortest.len() as u32,
            sphere_tests: self.tests,
            detect_calls: self.detects,
            contacts: self.contacts,
            shown: self.shown,
            largest_step,
            repetitions: self.repetitions,
            step_seconds: mean(0),
            mean_seconds: self.spent.as_secs_f64() / f64::from(self.timed.max(1)),
            stages: std::array::from_fn(|k| mean(k + 1)),
        }
    }
}

/// How long runs are repeated for the sake of their times.
#[derive(Clone, Copy, Debug)]
pub struct Patience {
    /// runs are repeated until they have taken this long together
    pub time: Duration,
    /// and at most so often
    pub most: u32,
}

impl Patience {
    /// Whether so many repetitions since then are enough.
    fn is_over(self, repetitions: u32, start: Instant) -> bool {
        repetitions >= self.most || start.elapsed() >= self.time
    }
}

/// Runs a scene from its start. Counts are the same in each repetition.
///
/// # Errors
/// The scene cannot be made, or the library fails.
pub fn all_steps(arena: Arena, method: Method, steps: u32, patience: Patience) -> Result<Measured, String> {
    let mut sums = Sums::default();
    let start = Instant::now();
    loop {
        let mut world = arena.build()?;
        method.apply(&mut world, arena.n()).map_err(|e| e.to_string())?;
        match sums.repetitions {
            0 => sums.count(&mut world, steps)?,
            _ => sums.repeat(&mut world, steps)?,
        }
        sums.repetitions += 1;
        if patience.is_over(sums.repetitions, start) {
            return Ok(sums.measured(arena, method, world.largest_step()));
        }
    }
}

/// Measures methods in windows of one run.
///
/// # Errors
/// The scene cannot be made, or the library fails.
pub fn in_windows(arena: Arena, cases: &[(Method, Which)], patience: Patience) -> Result<Vec<Measured>, String> {
    let fail = |e: mrtphys::Error| e.to_string();
    let mut world = arena.build()?;
    let mut sums = vec![Sums::default(); cases.len()];
    let visits = visits(cases);
    // A case's patience is shared by its windows; at least one repetition of each is made.
    let windows = |i: usize| visits.iter().filter(|v| v.1 == i).count().max(1) as u32;
    for &(at, i, each) in &visits {
        Method::Sorted.apply(&mut world, arena.n()).map_err(fail)?;
        while world.steps() < u64::from(at) {
            world.step().map_err(fail)?;
        }
        let here = world.snapshot();
        let share = Patience { time: patience.time / windows(i), ..patience };
        let (start, mut repetitions) = (Instant::now(), 0);
        while repetitions == 0 || !share.is_over(repetitions, start) {
            cases[i].0.apply(&mut world, arena.n()).map_err(fail)?;
            if cases[i].0 != Method::Spheres {
                // What remembers the last step must have one to remember.
                world.step().map_err(fail)?;
            }
            match repetitions {
                0 => sums[i].count(&mut world, each)?,
                _ => sums[i].repeat(&mut world, each)?,
            }
            repetitions += 1;
            world.restore(&here).map_err(fail)?;
        }
        // The fewest that any window had.
        sums[i].repetitions = if sums[i].repetitions == 0 { repetitions } else { sums[i].repetitions.min(repetitions) };
    }
    let largest = world.largest_step();
    Ok(sums.iter().zip(cases).map(|(sums, (method, _))| sums.measured(arena, *method, largest)).collect())
}

/// Steps before each window, its case and its length, in the order of the run.
fn visits(cases: &[(Method, Which)]) -> Vec<(u32, usize, u32)> {
    let mut visits = Vec::new();
    for (i, (_, which)) in cases.iter().enumerate() {
        if let Which::Windows { steps, windows, each } = *which {
            visits.extend((0..windows).map(|w| ((2 * w + 1) * steps / (2 * windows), i, each)));
        }
    }
    visits.sort_unstable();
    visits
}
