//! What a session tells: plain data, made on its thread.

use super::pace::RealTime;
use mrtphys::bounds::Aabb;
use mrtphys::broad::Cell;
use mrtphys::contact::Contact;
use mrtphys::counters::Counters;
use mrtphys::def::Settings;
use mrtphys::event::ImpactEvent;
use mrtphys::ledger::{Energy, Ledger};
use mrtphys::world::Body;
use mrtphys::{BodyId, Vec3};
use mrtphys_view::{Poses, Stage};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// The state at the end of a frame, as a picture needs it.
#[derive(Clone)]
pub struct Shot {
    /// its number in the recording: counts every frame made since the scene was loaded, whatever the frame rate
    pub tick: u64,
    /// the frame counter: begins anew when the frame rate is set
    pub frame: u64,
    /// simulated time \[s\]
    pub time: f64,
    /// what the bodies look like; the same `Arc` until bodies come or go
    pub stage: Arc<Stage>,
    /// where they are, in the order of the stage
    pub poses: Arc<Poses>,
}

/// What happened in one frame, for plots; in several, where there were very many since the last report.
#[derive(Clone, Debug, Default)]
pub struct Sample {
    /// number in the recording
    pub tick: u64,
    /// simulated time \[s\]
    pub time: f64,
    /// energy \[J\]
    pub energy: Energy,
    /// ledger \[J\]
    pub ledger: Ledger,
    /// momentum \[Ns\]
    pub momentum: Vec3,
    /// angular momentum about the origin \[Js\]
    pub angular_momentum: Vec3,
    /// energy before the first step \[J\]
    pub initial_energy: Energy,
    /// frames it stands for; 0: an edit, or steps of a frame that is not complete
    pub frames: u64,
    /// counts of its steps together
    pub counts: Counters,
    /// physical steps
    pub steps: u64,
    /// simulated time \[s\]
    pub duration: f64,
    /// computing time
    pub cost: Duration,
}

/// The numbers on the panel.
#[derive(Clone, Debug, Default)]
pub struct Numbers {
    /// settings as they are
    pub settings: Settings,
    /// frame counter
    pub frame: u64,
    /// simulated time \[s\]
    pub time: f64,
    /// physical steps made
    pub steps: u64,
    /// bodies
    pub bodies: usize,
    /// energy now \[J\]
    pub energy: Energy,
    /// energy at the start \[J\]
    pub initial_energy: Energy,
    /// where every joule went \[J\]
    pub ledger: Ledger,
    /// momentum \[Ns\]
    pub momentum: Vec3,
    /// angular momentum about the origin \[Js\]
    pub angular_momentum: Vec3,
    /// counts of the last step
    pub counters: Counters,
    /// counts over all steps
    pub totals: Counters,
    /// largest distance moved in a step, in diameters
    pub largest_step: f64,
    /// computing time of the last frame
    pub cost: Duration,
    /// wall time of each stage of a step, by name, averaged over the latest steps
    pub stages: Vec<(&'static str, Duration)>,
    /// gravity's vector of the first uniform or earth-gravity field, if there is one \[m/s2\]
    pub gravity: Option<Vec3>,
}

/// What was wished for.
#[derive(Clone, Debug, Default)]
pub struct Extras {
    /// contacts of the last step: point, normal, depth
    pub contacts: Vec<Contact>,
    /// impacts since the last report, the latest where there are very many
    pub impacts: Vec<ImpactEvent>,
    /// velocity \[m/s\] and angular velocity \[rad/s\] of every body, in the order of the stage
    pub velocities: Vec<(Vec3, Vec3)>,
    /// boxes of every body, in the order of the stage
    pub boxes: Vec<Aabb>,
    /// cells of the broad phase
    pub cells: Vec<Cell>,
    /// mass \[kg\] and speed \[m/s\] of every movable body
    pub speeds: Vec<(f64, f64)>,
    /// earlier frames, oldest first; only those with the same stage
    pub trail: Vec<Arc<Poses>>,
    /// the selected body
    pub selected: Option<(BodyId, String, Body)>,
}

/// A world beside another, or alone.
#[derive(Clone)]
pub struct Side {
    /// the frame before `shot`: pictures lie between the two
    pub before: Arc<Shot>,
    /// the newest frame
    pub shot: Arc<Shot>,
    /// its numbers
    pub numbers: Numbers,
    /// what was wished for
    pub extras: Extras,
    /// what happened in each frame since the last report that was taken
    pub samples: Vec<Sample>,
}

/// How time passes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PaceReport {
    /// mode
    pub real_time: RealTime,
    /// simulated seconds per real second
    pub speed: f64,
    /// frames per real second that were reached
    pub fps_reached: f64,
    /// frames skipped in forced real time
    pub skipped: u64,
    /// when `shot` began to be shown, and how long it takes the picture to get there from `before`; zero: at once
    pub since: Instant,
    /// see `since`
    pub blend: Duration,
}

impl PaceReport {
    /// How far the picture is from `before` to `shot` now, 0 to 1.
    pub fn part(&self, now: Instant) -> f64 {
        let blend = self.blend.as_secs_f64();
        if blend > 0.0 { (now.saturating_duration_since(self.since).as_secs_f64() / blend).min(1.0) } else { 1.0 }
    }
}

/// The recording.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Timeline {
    /// first frame that can be gone back to
    pub first: u64,
    /// last frame made
    pub last: u64,
    /// where we are
    pub now: u64,
    /// frames from one that is recorded to the next: more than 1 where frames are made so fast that recording every one
    /// would slow them down noticeably. Those between can be gone to as well
    pub stride: u64,
    /// whether the state at `now` is still being computed: the picture is already right, the numbers are not
    pub restoring: bool,
}

/// Everything a window shows.
#[derive(Clone)]
pub struct Report {
    /// counts the reports
    pub number: u64,
    /// title of the scene
    pub title: String,
    /// whether it runs
    pub running: bool,
    /// how time passes
    pub pace: PaceReport,
    /// the recording
    pub timeline: Timeline,
    /// the world, and its rival where there is one
    pub sides: Vec<Side>,
    /// whether the rival's state is the same bit for bit; `None`: there is none
    pub rival_agrees: Option<bool>,
    /// what went wrong last: an edit that was refused, or a simulation that stopped
    pub trouble: Option<String>,
    /// how often something went wrong: tells the same trouble again from trouble that is still shown
    pub troubles: u64,
}
