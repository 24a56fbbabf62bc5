//! One measured run.

use crate::gas::GasSpec;
use mrtphys::counters::Counters;
use mrtphys::work::StageTimes;
use mrtphys::{Result, World};
use std::time::{Duration, Instant};

/// What a run showed.
#[derive(Clone, Debug)]
pub struct Measurement {
    /// name of the scene
    pub scene: String,
    /// number of bodies
    pub bodies: usize,
    /// steps that were timed
    pub steps: usize,
    /// median wall time of a step \[s\]
    pub step_seconds: f64,
    /// mean wall time of a step \[s\]: it includes the steps that now and then sort the storage
    pub mean_seconds: f64,
    /// sums of the stages over the timed steps
    pub stages: [(&'static str, Duration); 6],
    /// E/E0 - 1 at the end
    pub energy_error: f64,
    /// impacts between bodies per second, over the timed steps
    pub collisions_per_second: f64,
    /// the same by kinetic theory
    pub theory: f64,
    /// bodies whose centre left the cube by more than their radius
    pub escaped: usize,
    /// largest distance moved in a step, in diameters
    pub largest_step: f64,
    /// state hash at the end
    pub state_hash: String,
}

/// How long to measure.
#[derive(Clone, Copy, Debug)]
pub struct Window {
    /// simulated time before the timed steps \[s\]
    pub warm_up: f64,
    /// simulated time of the timed steps \[s\]
    pub timed: f64,
}

/// Runs a gas and measures it.
///
/// # Errors
/// Those of the world; none for gases.
pub fn measure(spec: &GasSpec, window: Window) -> Result<Measurement> {
    let mut world = spec.build()?;
    let rate = f64::from(spec.rate);
    let start_energy = world.energy().total();
    for _ in 0..(window.warm_up * rate).round() as usize {
        world.step()?;
    }
    let steps = ((window.timed * rate).round() as usize).max(1);
    let before = *world.totals();
    let mut times = Vec::with_capacity(steps);
    let mut stages = StageTimes::default();
    for _ in 0..steps {
        let start = Instant::now();
        world.step()?;
        times.push(start.elapsed());
        add(&mut stages, world.stage_times());
    }
    let mean_seconds = times.iter().sum::<Duration>().as_secs_f64() / steps as f64;
    times.sort_unstable();
    let mean_square = 2.0 * world.energy().linear / spec.bodies() as f64;
    Ok(Measurement {
        scene: spec.name(),
        bodies: spec.bodies(),
        steps,
        step_seconds: times[times.len() / 2].as_secs_f64(),
        mean_seconds,
        stages: [
            ("motion", stages.motion),
            ("bounds", stages.bounds),
            ("broad", stages.broad),
            ("narrow", stages.narrow),
            ("impact", stages.impact),
            ("projection", stages.projection),
        ],
        energy_error: world.energy().total() / start_energy - 1.0,
        collisions_per_second: pair_impacts(&before, world.totals()) as f64 / (steps as f64 / rate),
        theory: spec.collisions_per_second(mean_square),
        escaped: escaped(&world)?,
        largest_step: world.largest_step(),
        state_hash: world.state_hash(),
    })
}

fn pair_impacts(before: &Counters, after: &Counters) -> u64 {
    (after.impacts - after.wall_impacts) - (before.impacts - before.wall_impacts)
}

fn add(sum: &mut StageTimes, s: &StageTimes) {
    sum.motion += s.motion;
    sum.bounds += s.bounds;
    sum.broad += s.broad;
    sum.narrow += s.narrow;
    sum.impact += s.impact;
    sum.projection += s.projection;
}

fn escaped(world: &World) -> Result<usize> {
    let mut count = 0;
    for id in world.bodies() {
        let body = world.body(id)?;
        let r = body.shape.bounding_sphere().radius;
        let outside = |x: f64| x < -r || x > 1.0 + r;
        let p = body.position;
        count += usize::from(outside(p.x) || outside(p.y) || outside(p.z));
    }
    Ok(count)
}
