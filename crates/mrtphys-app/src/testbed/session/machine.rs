//! What a recording repeats: a world with the frame it is in the middle of, changed by deeds and by steps. The same deeds at
//! the same places between the same steps give the same bits.

use super::command::{Change, Grip};
use super::hold::Hand;
use mrtphys::def::Settings;
use mrtphys::{Error, Real, World};
use mrtphys_scene::{Loaded, Names, Scene};
use std::sync::Arc;

/// A place in the recording: frames made, and steps made of the next.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Position {
    /// frames made
    pub tick: u64,
    /// physical steps made of the frame that comes next
    pub done: u32,
}

/// A change from outside.
pub enum Deed {
    /// an edit
    Change(Change),
    /// frames per second
    Fps(u32),
    /// physical steps per frame
    StepsPerFrame(u32),
    /// the hand takes hold, moves or lets go; in a standing world the body follows at once
    Hold { grip: Option<Grip>, standing: bool },
}

/// A frame in progress.
#[derive(Clone, Copy, Debug)]
struct Plan {
    /// physical steps it has
    steps: u32,
    /// their length \[s\], where it is not that of the settings
    dt: Option<Real>,
    /// frames merged into it
    merged: u32,
}

/// A world and where it is.
pub struct Machine {
    /// the world, its names and its scene
    pub loaded: Loaded,
    /// the frame counter: begins anew when the frame rate is set
    pub frame: u64,
    tick: u64,
    done: u32,
    plan: Option<Plan>,
    hand: Option<Hand>,
    /// the settings that are a rival's own, whatever the world's become
    own: Option<(Settings, Settings)>,
    /// names and scene as of the last state kept, while they have not changed
    rest: Option<Arc<(Names, Scene)>>,
}

impl Machine {
    /// At the beginning.
    pub fn new(loaded: Loaded) -> Machine {
        Machine { loaded, frame: 0, tick: 0, done: 0, plan: None, hand: None, own: None, rest: None }
    }

    /// Where it is.
    pub fn position(&self) -> Position {
        Position { tick: self.tick, done: self.done }
    }

    /// Whether it is in the middle of a frame.
    pub fn is_inside(&self) -> bool {
        self.plan.is_some()
    }

    /// The world.
    pub fn world(&self) -> &World {
        &self.loaded.world
    }

    /// Begins a frame that stands for so many: their time is divided into the steps of one (thesis, section 7.1).
    pub fn begin(&mut self, merged: u32) {
        let s = self.loaded.world.settings();
        let dt = Real::from(merged) / (Real::from(s.fps) * Real::from(s.steps_per_frame));
        self.plan = Some(Plan { steps: s.steps_per_frame, dt: (merged > 1).then_some(dt), merged });
        self.done = 0;
    }

    /// Takes back that a frame was begun, if no step of it was made.
    pub fn withdraw(&mut self) {
        if self.done == 0 {
            self.plan = None;
        }
    }

    /// One physical step of the frame in progress; whether that ended it.
    ///
    /// # Errors
    /// A field of the user's failed: everything is what it was.
    pub fn step(&mut self) -> Result<bool, Error> {
        let Some(plan) = self.plan else { return Ok(true) };
        let world = &mut self.loaded.world;
        let before = self.hand.as_mut().and_then(|hand| hand.pull(world, plan.dt.unwrap_or(world.time_step())));
        let made = match plan.dt {
            None => world.step(),
            Some(dt) => world.step_by(dt),
        };
        if let Err(e) = made {
            before.into_iter().for_each(|state| state.put_back(world));
            return Err(e);
        }
        self.done += 1;
        if self.done >= plan.steps {
            self.end();
        }
        Ok(self.plan.is_none())
    }

    /// How many frames the one in progress stands for.
    pub fn merged(&self) -> u32 {
        self.plan.map_or(1, |p| p.merged)
    }

    fn end(&mut self) {
        self.frame += u64::from(self.merged());
        self.tick += 1;
        self.done = 0;
        self.plan = None;
    }

    /// Changes the world. A frame in progress whose steps would have changed their length ends here, early.
    ///
    /// # Errors
    /// What was wrong with it.
    pub fn apply(&mut self, deed: &Deed) -> Result<(), String> {
        let old = self.loaded.world.settings().clone();
        let result = match deed {
            Deed::Change(change) => {
                self.rest = None;
                change(&mut self.loaded)
            }
            Deed::Fps(fps) => self.set(|s| s.fps = *fps),
            Deed::StepsPerFrame(steps) => self.set(|s| s.steps_per_frame = *steps),
            Deed::Hold { grip, standing } => self.hold(*grip, *standing),
        };
        let kept = self.keep_own();
        let new = self.loaded.world.settings();
        let (fps, steps) = (old.fps != new.fps, old.steps_per_frame != new.steps_per_frame);
        if (fps || steps) && self.plan.is_some() {
            self.end();
        }
        if fps || (matches!(deed, Deed::Fps(_)) && result.is_ok()) {
            self.frame = 0;
        }
        result.and(kept)
    }

    fn set(&mut self, change: impl FnOnce(&mut Settings)) -> Result<(), String> {
        let mut settings = self.loaded.world.settings().clone();
        change(&mut settings);
        self.loaded.world.set_settings(settings).map_err(|e| e.to_string())
    }

    fn hold(&mut self, grip: Option<Grip>, standing: bool) -> Result<(), String> {
        self.hand = None;
        let Some(grip) = grip else { return Ok(()) };
        let hand = Hand::new(grip, &self.loaded)?;
        if standing {
            hand.carry(&mut self.loaded.world)?;
        }
        self.hand = Some(hand);
        Ok(())
    }

    /// The body that is held.
    pub fn held(&self) -> Option<Grip> {
        self.hand.as_ref().map(|hand| hand.grip)
    }

    /// Another world from the same state, whose own settings are `wanted` wherever that differs from `common`, now and
    /// later. The frame rate is always common.
    ///
    /// # Errors
    /// A setting is out of range, or one that is fixed when a world is made.
    pub fn rival(&self, common: &Settings, wanted: &Settings) -> Result<Machine, String> {
        let wanted = Settings { fps: common.fps, ..wanted.clone() };
        let mut loaded = self.loaded.clone();
        let settings = with_own(loaded.world.settings(), common, &wanted);
        loaded.world.set_settings(settings).map_err(|e| format!("rival: {e}"))?;
        let Machine { frame, tick, done, plan, hand, .. } = self;
        let own = Some((common.clone(), wanted));
        Ok(Machine {
            loaded,
            frame: *frame,
            tick: *tick,
            done: *done,
            plan: *plan,
            hand: hand.clone(),
            own,
            rest: self.rest.clone(),
        })
    }

    fn keep_own(&mut self) -> Result<(), String> {
        let Some((common, wanted)) = &self.own else { return Ok(()) };
        let now = self.loaded.world.settings();
        let kept = with_own(now, common, wanted);
        if kept == *now {
            return Ok(());
        }
        self.loaded.world.set_settings(kept).map_err(|e| format!("rival: {e}"))
    }
}

/// The settings `now`, but where `wanted` was given another value than `common`, that one.
fn with_own(now: &Settings, common: &Settings, wanted: &Settings) -> Settings {
    fn choose<T: PartialEq + Clone>(now: &T, common: &T, wanted: &T) -> T {
        if common == wanted { now.clone() } else { wanted.clone() }
    }
    macro_rules! settings {
        ($($field:ident),+) => {
            Settings { $($field: choose(&now.$field, &common.$field, &wanted.$field)),+ }
        };
    }
    settings!(
        algorithm,
        broad_phase,
        friction_law,
        impact,
        contact,
        inertia,
        integrator,
        fps,
        steps_per_frame,
        viscosity,
        viscous_spin,
        medium_density
    )
}

/// A machine kept: what it takes to go on from here. Names and scene are shared with other states while nobody edits them.
pub struct Still {
    world: World,
    rest: Arc<(Names, Scene)>,
    frame: u64,
    tick: u64,
    done: u32,
    plan: Option<Plan>,
    hand: Option<Hand>,
    own: Option<(Settings, Settings)>,
}

impl Still {
    /// A copy of a machine.
    pub fn of(machine: &mut Machine) -> Still {
        let Machine { loaded, frame, tick, done, plan, hand, own, rest } = machine;
        let rest = rest.get_or_insert_with(|| Arc::new((loaded.names.clone(), loaded.scene.clone()))).clone();
        let world = loaded.world.clone();
        Still {
            world,
            rest,
            frame: *frame,
            tick: *tick,
            done: *done,
            plan: *plan,
            hand: hand.clone(),
            own: own.clone(),
        }
    }

    /// A machine that goes on from here.
    pub fn awake(&self) -> Machine {
        let (names, scene) = (*self.rest).clone();
        Machine {
            loaded: Loaded { world: self.world.clone(), names, scene },
            frame: self.frame,
            tick: self.tick,
            done: self.done,
            plan: self.plan,
            hand: self.hand.clone(),
            own: self.own.clone(),
            rest: Some(self.rest.clone()),
        }
    }

    /// Where it is.
    pub fn position(&self) -> Position {
        Position { tick: self.tick, done: self.done }
    }

    /// About how much memory it takes \[bytes\]: measured by what a body's parts are large.
    pub fn bytes(&self) -> usize {
        const FIXED: usize = 16 << 10;
        const PER_BODY: usize = 160;
        FIXED + self.world.body_count() * PER_BODY + self.world.contact_memory().len() * 8
    }
}
