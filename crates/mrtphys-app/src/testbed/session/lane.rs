//! One of the worlds that are simulated side by side, and what is seen of it.

use super::command::Wish;
use super::extras;
use super::machine::Machine;
use super::report::{Extras, Numbers, Sample, Shot, Side};
use mrtphys::Error;
use mrtphys::counters::Counters;
use mrtphys::event::ImpactEvent;
use mrtphys::work::StageTimes;
use mrtphys_view::{Poses, Stage};
use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Duration;

/// More impacts than these between two reports, and the oldest are left out.
pub const MOST_IMPACTS: usize = 4096;
/// More samples than these between two reports, and neighbours are merged in pairs.
pub const MOST_SAMPLES: usize = 2048;
/// Weight of the latest step in the average time of a stage.
const STAGE_WEIGHT: f64 = 1.0 / 16.0;

/// A world that is stepped, and looked at now and then.
pub struct Lane {
    /// the world and where it is
    pub machine: Machine,
    /// what its bodies look like
    pub stage: Arc<Stage>,
    /// the picture before the newest
    pub before: Arc<Shot>,
    /// the newest picture
    pub shot: Arc<Shot>,
    /// whether the newest picture is of the state as it is
    pub is_seen: bool,
    /// computing time of the frame in progress
    pub running_cost: Duration,
    /// computing time of the last frame
    pub frame_cost: Duration,
    /// bodies came, went or changed their looks since the stage was made
    pub restage: bool,
    stages: [f64; 6],
    samples: Vec<Sample>,
    impacts: VecDeque<ImpactEvent>,
    numbers: Numbers,
    seen: Seen,
}

/// What there was when the last sample was made, and what happened since.
#[derive(Clone, Copy, Default)]
struct Seen {
    totals: Counters,
    steps: u64,
    time: f64,
    cost: Duration,
    frames: u64,
}

impl Lane {
    /// Looks at a world for the first time.
    pub fn new(machine: Machine) -> Lane {
        Lane::on(machine, None)
    }

    /// With a stage on which the same bodies stand.
    pub fn on(machine: Machine, stage: Option<Arc<Stage>>) -> Lane {
        let same = stage.filter(|s| s.body_count() == machine.world().body_count());
        let stage = same.unwrap_or_else(|| Arc::new(Stage::new(&machine.loaded)));
        let shot = Arc::new(shot_of(&machine, &stage));
        let mut lane = Lane {
            machine,
            stage,
            before: shot.clone(),
            shot,
            is_seen: true,
            running_cost: Duration::ZERO,
            frame_cost: Duration::ZERO,
            restage: false,
            stages: [0.0; 6],
            samples: Vec::new(),
            impacts: VecDeque::new(),
            numbers: Numbers::default(),
            seen: Seen::default(),
        };
        lane.forget();
        lane
    }

    /// What happened so far is no part of a sample to come: after a jump to another frame.
    pub fn forget(&mut self) {
        self.machine.loaded.world.drain_events().for_each(drop);
        let world = self.machine.world();
        self.seen = Seen { totals: *world.totals(), steps: world.steps(), time: world.time(), ..Seen::default() };
        self.samples.clear();
        self.impacts.clear();
        self.samples.push(self.sample());
    }

    /// One physical step; whether that ended a frame.
    ///
    /// # Errors
    /// As [`Machine::step`].
    pub fn step(&mut self, clock: &dyn Fn() -> std::time::Instant) -> Result<bool, Error> {
        let start = clock();
        let ended = self.machine.step();
        let cost = clock().saturating_duration_since(start);
        self.running_cost += cost;
        self.seen.cost += cost;
        self.is_seen = false;
        let times = stage_seconds(self.machine.world().stage_times());
        for (average, (_, now)) in self.stages.iter_mut().zip(times) {
            *average = if *average > 0.0 { *average + STAGE_WEIGHT * (now - *average) } else { now };
        }
        self.impacts.extend(self.machine.loaded.world.drain_events());
        let extra = self.impacts.len().saturating_sub(MOST_IMPACTS);
        self.impacts.drain(..extra);
        if matches!(ended, Ok(true)) {
            self.frame_ended();
        }
        ended
    }

    /// Books a frame that has ended.
    pub fn frame_ended(&mut self) {
        self.frame_cost = std::mem::take(&mut self.running_cost);
        self.seen.frames += 1;
    }

    /// Makes a picture and a sample of the state as it is. `follows`: the picture may be blended with the one before.
    pub fn look(&mut self, follows: bool) {
        let gone = self.stage.body_count() != self.machine.world().body_count();
        if std::mem::take(&mut self.restage) || gone {
            self.stage = Arc::new(Stage::new(&self.machine.loaded));
        }
        let shot = Arc::new(shot_of(&self.machine, &self.stage));
        let same_stage = Arc::ptr_eq(&shot.stage, &self.shot.stage);
        let old = std::mem::replace(&mut self.shot, shot);
        self.before = if follows && same_stage { old } else { self.shot.clone() };
        let sample = self.sample();
        let world = self.machine.world();
        self.seen = Seen { totals: *world.totals(), steps: world.steps(), time: world.time(), ..Seen::default() };
        self.samples.push(sample);
        thin(&mut self.samples);
        self.is_seen = true;
    }

    /// Shows a picture of the recording.
    pub fn show(&mut self, shot: Arc<Shot>) {
        self.stage = shot.stage.clone();
        (self.before, self.shot) = (shot.clone(), shot);
        self.restage = false;
    }

    fn sample(&self) -> Sample {
        let world = self.machine.world();
        let (now, then) = (world.totals().to_array(), self.seen.totals.to_array());
        Sample {
            tick: self.machine.position().tick,
            time: world.time(),
            energy: world.energy(),
            ledger: *world.ledger(),
            momentum: world.momentum(),
            angular_momentum: world.angular_momentum(),
            initial_energy: world.initial_energy(),
            frames: self.seen.frames,
            counts: Counters::from_array(std::array::from_fn(|i| now[i].wrapping_sub(then[i]))),
            steps: world.steps().wrapping_sub(self.seen.steps),
            duration: world.time() - self.seen.time,
            cost: self.seen.cost,
        }
    }

    /// What is told of it. Samples and impacts are told once.
    pub fn side(&mut self, wish: &Wish, trail: Vec<Arc<Poses>>) -> Side {
        self.count();
        let mut told = extras::extras(&self.machine.loaded, &self.stage, wish);
        told.impacts = self.impacts.drain(..).collect();
        told.trail = trail;
        self.told(told)
    }

    /// The last that was told, without asking the world anything.
    pub fn last_side(&mut self) -> Side {
        self.told(Extras::default())
    }

    fn told(&mut self, extras: Extras) -> Side {
        Side {
            before: self.before.clone(),
            shot: self.shot.clone(),
            numbers: self.numbers.clone(),
            extras,
            samples: std::mem::take(&mut self.samples),
        }
    }

    /// Brings the numbers up to date. Sums over all bodies are those of the last sample.
    fn count(&mut self) {
        let world = self.machine.world();
        let n = &mut self.numbers;
        n.settings = world.settings().clone();
        (n.frame, n.time) = (self.shot.frame, self.shot.time);
        (n.steps, n.bodies) = (world.steps(), world.body_count());
        if let Some(s) = self.samples.last() {
            (n.energy, n.initial_energy, n.ledger) = (s.energy, s.initial_energy, s.ledger);
            (n.momentum, n.angular_momentum) = (s.momentum, s.angular_momentum);
        }
        (n.counters, n.totals, n.largest_step) = (*world.counters(), *world.totals(), world.largest_step());
        n.cost = self.frame_cost;
        let names = stage_seconds(&StageTimes::default()).map(|s| s.0);
        n.stages = names.into_iter().zip(self.stages.map(Duration::from_secs_f64)).collect();
        n.gravity = world.forces().iter().find_map(|f| f.field.uniform());
    }

    /// Whether impacts are to be written down.
    pub fn wish_impacts(&mut self, on: bool) {
        self.machine.loaded.world.record_events(on);
        if !on {
            self.impacts.clear();
            self.machine.loaded.world.drain_events().for_each(drop);
        }
    }
}

fn shot_of(machine: &Machine, stage: &Arc<Stage>) -> Shot {
    let mut poses = Poses::default();
    stage.read(machine.world(), &mut poses);
    let (tick, frame, time) = (machine.position().tick, machine.frame, machine.world().time());
    Shot { tick, frame, time, stage: stage.clone(), poses: Arc::new(poses) }
}

fn stage_seconds(t: &StageTimes) -> [(&'static str, f64); 6] {
    [
        ("motion", t.motion),
        ("bounds", t.bounds),
        ("broad", t.broad),
        ("narrow", t.narrow),
        ("impact", t.impact),
        ("projection", t.projection),
    ]
    .map(|(name, time)| (name, time.as_secs_f64()))
}

/// Merges neighbours where there are too many: counts and times are summed, the state is that of the later.
pub fn thin(samples: &mut Vec<Sample>) {
    if samples.len() <= MOST_SAMPLES {
        return;
    }
    let merged = samples.chunks(2).map(|pair| match pair {
        [a, b] => {
            let mut both = b.clone();
            both.counts += a.counts;
            both.frames += a.frames;
            both.steps += a.steps;
            both.duration += a.duration;
            both.cost += a.cost;
            both
        }
        alone => alone[0].clone(),
    });
    *samples = merged.collect();
}
