//! What a session does, without its thread: commands change it, `work` takes it one physical step further, `report` tells.

use super::command::{Command, Grip, Question, Studio, Wish};
use super::lane::Lane;
use super::machine::{Deed, Machine, Position, Still};
use super::pace::{Due, Pace, RealTime};
use super::tape::{BUDGET, Tape};
use super::{report::Recorded, restore::Restore};
use mrtphys::def::Settings;
use mrtphys_scene::Loaded;
use std::collections::VecDeque;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// What time it is.
pub type Clock = Box<dyn Fn() -> Instant + Send>;

/// Recording a frame may cost this part of computing it, where frames are made as fast as possible.
const LOOKING_PART: u32 = 5;

/// What is being done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Task {
    Stand,
    /// to the end of a frame, and so many more
    Frame(u32),
    /// so many physical steps
    Step(u32),
    Run,
}

/// When there is something to do again.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Next {
    /// at once
    Now,
    /// then
    At(Instant),
    /// when a command comes
    Never,
}

/// Whether there is something to tell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum News {
    /// nothing
    None,
    /// another frame
    Frame,
    /// the answer to a command
    Answer,
}

/// A session without its thread.
pub struct Core {
    pub(super) clock: Clock,
    pub(super) title: String,
    origin: Arc<Still>,
    /// the world, and its rival where there is one
    pub(super) lanes: Vec<Lane>,
    /// the settings when a rival was asked for, and those it was to have
    rival: Option<(Settings, Settings)>,
    pub(super) tape: Tape,
    pub(super) pace: Pace,
    pub(super) task: Task,
    pub(super) restore: Option<Restore>,
    /// commands that wait for the end of a frame or of restoring
    pub(super) queue: VecDeque<Command>,
    pub(super) wish: Wish,
    /// what the mouse holds
    pub(super) holding: Option<Grip>,
    pub(super) trouble: Option<String>,
    pub(super) troubles: u64,
    pub(super) number: u64,
    pub(super) news: News,
    /// what looking at the worlds takes, and what was computed since that was last done
    pub(super) look_cost: Duration,
    pub(super) since_look: Duration,
    pub(super) stride: u64,
    /// a deed was done at this frame, and its picture was not made again yet
    pub(super) edited: bool,
    /// whether the rival's state was the same when that was last asked, and whether anything happened since
    pub(super) agrees: Option<bool>,
    pub(super) is_unasked: bool,
}

impl Core {
    /// Standing still at the first frame.
    pub fn new(loaded: Loaded, clock: Clock) -> Core {
        Core::with_budget(loaded, clock, BUDGET)
    }

    /// With another amount of memory for the recording \[bytes\].
    pub fn with_budget(loaded: Loaded, clock: Clock, budget: usize) -> Core {
        let mut machine = Machine::new(loaded);
        let origin = Arc::new(Still::of(&mut machine));
        let pace = Pace::new(machine.world().settings().fps, clock());
        let title = machine.loaded.scene.title.clone();
        let lane = Lane::new(machine);
        let mut tape = Tape::new(origin.clone(), budget);
        tape.push(Recorded { shot: lane.shot.clone(), rival: None });
        Core {
            clock,
            title,
            origin,
            lanes: vec![lane],
            rival: None,
            tape,
            pace,
            task: Task::Stand,
            restore: None,
            queue: VecDeque::new(),
            wish: Wish::default(),
            holding: None,
            trouble: None,
            troubles: 0,
            number: 0,
            news: News::Answer,
            look_cost: Duration::ZERO,
            since_look: Duration::ZERO,
            stride: 1,
            edited: false,
            agrees: None,
            is_unasked: true,
        }
    }

    /// The world.
    pub fn loaded(&self) -> &Loaded {
        &self.lanes[0].machine.loaded
    }

    pub(super) fn now(&self) -> Instant {
        (self.clock)()
    }

    pub(super) fn position(&self) -> Position {
        self.lanes[0].machine.position()
    }

    /// Whether a frame is in progress.
    pub(super) fn is_inside(&self) -> bool {
        self.lanes.iter().any(|lane| lane.machine.is_inside())
    }

    /// What there is to tell, and whether this is a good moment: not in the middle of a frame.
    pub fn news(&self) -> (News, bool) {
        (self.news, !self.is_inside() || self.task == Task::Stand || self.restore.is_some())
    }

    /// Does as it is told. What changes a world waits for the end of the frame where a rival must be changed at the same
    /// time, and for a frame to be restored that was asked for before.
    pub fn obey(&mut self, command: Command) {
        let nothing_new = match &command {
            Command::Wish(wish) => *wish == self.wish,
            Command::Hold(grip) => *grip == self.holding && self.queue.is_empty(),
            _ => false,
        };
        if nothing_new {
            return;
        }
        self.news = News::Answer;
        let waits = match &command {
            Command::Restart
            | Command::Go(_)
            | Command::Frame
            | Command::Step
            | Command::RealTime(_)
            | Command::Speed(_)
            | Command::Wish(_) => false,
            Command::Seek(_) | Command::Back => !self.queue.is_empty(),
            Command::Rival(_) => self.must_wait() || self.is_inside(),
            Command::Fps(_) | Command::StepsPerFrame(_) | Command::Edit { .. } | Command::Hold(_) | Command::Ask(_) => {
                self.must_wait()
            }
        };
        if waits { self.queue.push_back(command) } else { self.act(command) }
    }

    fn must_wait(&self) -> bool {
        self.restore.is_some() || !self.queue.is_empty() || (self.lanes.len() > 1 && self.is_inside())
    }

    fn act(&mut self, command: Command) {
        let now = self.now();
        match command {
            Command::Go(on) => self.go(on),
            Command::Frame => self.begin_task(true),
            Command::Step => self.begin_task(false),
            Command::Back => {
                let tick = self.restore.as_ref().map_or(self.position().tick, |r| r.target);
                let inside = self.restore.is_none() && self.position().done > 0;
                self.seek(if inside { tick } else { tick.saturating_sub(1) });
            }
            Command::Seek(tick) => self.seek(tick),
            Command::Restart => self.restart(),
            Command::Fps(fps) => self.do_deed(Deed::Fps(fps), false),
            Command::StepsPerFrame(steps) => self.do_deed(Deed::StepsPerFrame(steps), false),
            Command::RealTime(mode) => self.pace.set_mode(mode, now),
            Command::Speed(speed) => {
                if let Err(e) = self.pace.set_speed(speed, now) {
                    self.complain(e);
                }
            }
            Command::Edit { change, structural } => self.do_deed(Deed::Change(change), structural),
            Command::Wish(wish) => self.set_wish(wish),
            Command::Hold(grip) => self.hold(grip),
            Command::Rival(settings) => self.set_rival(settings),
            Command::Ask(question) => self.answer(question),
        }
    }

    /// Says what went wrong.
    pub fn complain(&mut self, what: String) {
        self.trouble = Some(what);
        self.troubles += 1;
        self.news = News::Answer;
    }

    fn go(&mut self, on: bool) {
        if on && self.task != Task::Run {
            self.trouble = None;
            self.pace.go(self.now());
        }
        if !on {
            self.stand();
        }
        self.task = if on { Task::Run } else { Task::Stand };
    }

    /// Stands still from now on.
    pub(super) fn stand(&mut self) {
        self.withdraw();
        self.pace.stop();
        self.task = Task::Stand;
    }

    /// A frame of which no step was made yet is not in progress.
    fn withdraw(&mut self) {
        // A world that has ended its frame is not to be waited for in vain.
        let fresh = |lane: &Lane| lane.machine.is_inside() && lane.machine.position().done == 0;
        if self.restore.is_none() && self.lanes.iter().all(fresh) {
            self.lanes.iter_mut().for_each(|lane| lane.machine.withdraw());
        }
    }

    /// One more frame or step, beside those that were asked for already and are not made yet.
    fn begin_task(&mut self, frame: bool) {
        let task = match (self.task, frame) {
            (Task::Frame(n), true) => Task::Frame(n + 1),
            (Task::Step(n), false) => Task::Step(n + 1),
            (_, true) => Task::Frame(0),
            (_, false) => Task::Step(1),
        };
        self.stand();
        self.trouble = None;
        self.task = task;
    }

    /// Begins again with the scene as it was loaded; what waited to be done would have been undone.
    fn restart(&mut self) {
        let now = self.now();
        let stage = self.tape.recorded(0).map(|f| f.shot.stage.clone());
        self.queue.clear();
        (self.restore, self.trouble, self.holding, self.stride) = (None, None, None, 1);
        let budget = self.tape.budget();
        self.tape = Tape::new(self.origin.clone(), budget);
        let machine = self.origin.awake();
        let fps = machine.world().settings().fps;
        self.lanes = vec![Lane::on(machine, stage)];
        self.tape.push(Recorded { shot: self.lanes[0].shot.clone(), rival: None });
        self.pace.set_fps(fps, now);
        self.pace.forget_skipped();
        self.pace.jump(now);
        if self.task == Task::Run {
            self.pace.go(now);
        } else {
            self.stand();
        }
        self.fork();
        self.listen();
    }

    fn set_wish(&mut self, wish: Wish) {
        self.wish = wish;
        self.listen();
    }

    /// Impacts are written down only while somebody wants to know.
    pub(super) fn listen(&mut self) {
        let on = self.wish.impacts;
        self.lanes.iter_mut().for_each(|lane| lane.wish_impacts(on));
    }

    fn hold(&mut self, grip: Option<Grip>) {
        self.holding = grip;
        let standing = self.task == Task::Stand;
        self.do_deed(Deed::Hold { grip, standing }, false);
    }

    fn answer(&mut self, question: Question) {
        let frames = || self.tape.frames().cloned().collect();
        question(&Studio { loaded: &self.lanes[0].machine.loaded, frames: &frames });
    }

    /// Changes the worlds, here and now.
    fn do_deed(&mut self, deed: Deed, structural: bool) {
        self.withdraw();
        let here = self.position();
        let inside = self.is_inside();
        if let Deed::Change(change) = &deed
            && self.tape.range().1 > here.tick
            && !inside
            && let Err(e) = change(&mut self.lanes[0].machine.loaded.clone())
        {
            // What comes after is not given up for a change that is refused.
            return self.complain(e);
        }
        if !inside {
            self.tape.cut(here);
        }
        let mut results = self.lanes.iter_mut().map(|lane| lane.machine.apply(&deed));
        let first = results.next().unwrap_or(Ok(()));
        let second = results.next().unwrap_or(Ok(()));
        self.tape.note(here, deed);
        match first.and(second.map_err(|e| format!("in the rival: {e}"))) {
            Ok(()) => self.trouble = None,
            Err(e) => self.complain(e),
        }
        for lane in &mut self.lanes {
            lane.is_seen = false;
            lane.restage |= structural;
        }
        self.is_unasked = true;
        self.edited = !inside;
        let fps = self.loaded().world.settings().fps;
        self.pace.set_fps(fps, self.now());
        if self.position().tick > here.tick {
            // A frame that the deed ended early is a frame, too.
            self.lanes.iter_mut().for_each(Lane::frame_ended);
            self.frame_done(1);
        }
    }

    fn set_rival(&mut self, settings: Option<Settings>) {
        self.rival = settings.map(|wanted| (self.loaded().world.settings().clone(), wanted));
        self.trouble = None;
        self.fork();
        self.listen();
    }

    /// Makes the rival from the world as it is.
    pub(super) fn fork(&mut self) {
        self.lanes.truncate(1);
        self.tape.end_rival();
        (self.agrees, self.is_unasked) = (None, true);
        let Some((common, wanted)) = &self.rival else { return };
        match self.lanes[0].machine.rival(common, wanted) {
            Ok(mut machine) => {
                self.tape.begin_rival(&mut machine);
                let stage = self.lanes[0].stage.clone();
                self.lanes.push(Lane::on(machine, Some(stage)));
            }
            Err(e) => {
                self.rival = None;
                self.complain(e);
            }
        }
    }

    /// Takes everything one physical step further, if it is time.
    pub fn work(&mut self) -> Next {
        if self.restore.is_some() {
            self.restore_on();
            return Next::Now;
        }
        if self.is_inside() && (!matches!(self.task, Task::Stand | Task::Step(_)) || !self.queue.is_empty()) {
            self.step_one();
            return Next::Now;
        }
        if let Some(command) = if self.is_inside() { None } else { self.queue.pop_front() } {
            self.act(command);
            self.news = News::Answer;
            return Next::Now;
        }
        match self.task {
            Task::Stand => return Next::Never,
            Task::Step(n) => self.step_all(n),
            Task::Frame(_) => self.begin(1),
            Task::Run => match self.pace.due(self.now()) {
                Due::Now(merged) => self.begin(merged),
                Due::At(then) => return Next::At(then),
            },
        }
        Next::Now
    }

    /// Begins a frame; what came after in the recording is replaced.
    fn begin(&mut self, merged: u32) {
        let here = self.position();
        self.look_again();
        if self.holding.is_none() && self.lanes[0].machine.held().is_some() {
            // The hand of a frame that was gone back to.
            self.do_deed(Deed::Hold { grip: None, standing: false }, false);
        }
        self.tape.cut(here);
        self.tape.note_merged(here.tick, merged);
        self.lanes.iter_mut().for_each(|lane| lane.machine.begin(merged));
    }

    /// One physical step of one world; they take turns in going first, so that neither always finds the other's data in
    /// the cache.
    fn step_one(&mut self) {
        let merged = self.lanes.iter().map(|lane| lane.machine.merged()).max().unwrap_or(1);
        let count = self.lanes.len();
        let first = (self.position().tick % 2) as usize;
        let Some(i) = (0..count).map(|k| (k + first) % count).find(|&i| self.lanes[i].machine.is_inside()) else {
            return;
        };
        if self.step_lane(i) && !self.is_inside() {
            self.frame_done(merged);
        }
    }

    /// Whether it went well.
    fn step_lane(&mut self, i: usize) -> bool {
        let result = self.lanes[i].step(&*self.clock);
        self.is_unasked = true;
        match result {
            Ok(_) => true,
            Err(e) => {
                let who = if i == 0 { "" } else { "in the rival: " };
                self.stand();
                self.complain(format!("{who}{e}; the simulation stands still before that step"));
                false
            }
        }
    }

    /// One physical step of every world.
    fn step_all(&mut self, count: u32) {
        if !self.is_inside() {
            self.begin(1);
        }
        self.task = if count > 1 { Task::Step(count - 1) } else { Task::Stand };
        self.news = News::Answer;
        self.pace.jump(self.now());
        let went_well = (0..self.lanes.len()).all(|i| !self.lanes[i].machine.is_inside() || self.step_lane(i));
        if went_well && !self.is_inside() {
            self.frame_done(1);
        }
    }

    fn frame_done(&mut self, merged: u32) {
        let now = self.now();
        let running = self.task == Task::Run;
        if running {
            self.pace.made(merged, now);
        } else {
            self.pace.jump(now);
        }
        let tick = self.position().tick;
        self.tape.made(tick);
        let cost: Duration = self.lanes.iter().map(|lane| lane.frame_cost).sum();
        self.since_look += cost;
        let off = self.pace.report().real_time == RealTime::Off;
        let restage = self.lanes.iter().any(|lane| lane.restage);
        if !running || !off || restage || self.since_look >= self.look_cost * LOOKING_PART {
            self.look(running && !self.pace.report().blend.is_zero());
        }
        self.tape.keep(self.lanes.iter_mut().map(|lane| &mut lane.machine), cost, &*self.clock);
        match self.task {
            Task::Frame(0) => self.task = Task::Stand,
            Task::Frame(n) => self.task = Task::Frame(n - 1),
            Task::Stand | Task::Step(_) | Task::Run => {}
        }
        self.news = if running { self.news.max(News::Frame) } else { News::Answer };
    }
}

impl Core {
    /// Goes on after a panic: at the last whole frame, standing still, saying what happened.
    pub fn recover(&mut self, message: &str) {
        self.queue.clear();
        self.stand();
        self.restore = None;
        // Where the worlds were when it happened, nobody knows.
        let target = self.tape.range().1;
        self.return_to(target);
        self.complain(message.into());
    }
}
