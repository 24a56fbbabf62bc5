//! The recording: pictures of the latest frames, deeds, and states to begin again from.
//!
//! A frame is restored from the nearest state kept before it, by making its steps and deeds again: bit for bit, because a
//! world is deterministic. So states can be kept as rarely as memory asks for, and an edit costs no memory to speak of.

use super::machine::{Deed, Machine, Position, Still};
use super::report::Shot;
use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Duration;

/// Memory for a recording \[bytes\], beside the scene as it was loaded, which is always kept.
pub const BUDGET: usize = 512 << 20;
/// Part of it that is for pictures.
const SHOTS_PART: f64 = 0.75;
/// A stage takes about so much memory for a body \[bytes\].
const STAGE_BYTES: usize = 256;
/// At least so many pictures are kept, whatever they cost.
const FEWEST_SHOTS: usize = 2;
/// A state is kept when so much computing has passed since the last: restoring takes no longer until states are thinned.
const KEEP_AFTER: Duration = Duration::from_millis(250);
/// Or so many frames.
const KEEP_AFTER_FRAMES: u64 = 512;
/// Copying states may cost this part of the computing.
const COPYING_PART: u32 = 20;

/// A state kept.
pub struct Key {
    /// the state
    pub still: Arc<Still>,
    /// number of the first deed that it does not contain
    pub deeds: usize,
}

impl Key {
    /// Where it is.
    pub fn at(&self) -> Position {
        self.still.position()
    }
}

/// States of one world, in order of time.
#[derive(Default)]
pub struct Keys {
    list: Vec<Key>,
    bytes: usize,
    /// computing since the last
    spent: Duration,
    /// what making the last one took
    copying: Duration,
}

impl Keys {
    /// Whether it is time to keep a state.
    fn is_due(&self, now: Position, cost: Duration) -> bool {
        let frames = self.list.last().map_or(u64::MAX, |k| now.tick - k.at().tick);
        let enough = KEEP_AFTER.max(self.copying * COPYING_PART);
        frames > 0 && (self.spent + cost >= enough || frames >= KEEP_AFTER_FRAMES)
    }

    fn keep(&mut self, key: Key) {
        self.bytes += key.still.bytes();
        self.list.push(key);
        self.spent = Duration::ZERO;
    }

    /// Forgets what is no longer needed to restore frames from `first` on, then every second of the others until the rest
    /// fits; the newest and the one needed for `first` stay.
    fn thin(&mut self, first: u64, budget: usize) {
        let needed = self.list.partition_point(|k| k.at() <= Position { tick: first, done: 0 });
        self.list.drain(..needed.saturating_sub(1));
        self.count();
        while self.bytes > budget && self.list.len() > 2 {
            let last = self.list.len() - 1;
            let mut i = 0;
            self.list.retain(|_| {
                i += 1;
                i == 1 || i % 2 == 1 || i > last
            });
            self.count();
        }
    }

    fn count(&mut self) {
        self.bytes = self.list.iter().map(|k| k.still.bytes()).sum();
    }

    fn cut(&mut self, after: Position) {
        self.list.retain(|k| k.at() <= after);
        self.count();
    }

    /// The latest state to restore a frame from; with `warm`, one before it if there is any, so that a step is made and
    /// there are contacts to show.
    pub fn nearest(&self, tick: u64, warm: bool) -> Option<&Key> {
        let target = Position { tick, done: 0 };
        let end = self.list.partition_point(|k| k.at() <= target);
        let strictly = self.list.partition_point(|k| k.at().tick < tick);
        let i = if warm && strictly > 0 { strictly } else { end };
        self.list[..i.min(end)].last()
    }

    /// How many states are kept.
    pub fn len(&self) -> usize {
        self.list.len()
    }
}

/// A recording of a world and, where there is one, of its rival.
pub struct Tape {
    budget: usize,
    shots: VecDeque<Arc<Shot>>,
    /// memory of each, and of all \[bytes\]
    weights: VecDeque<usize>,
    shot_bytes: usize,
    /// what was done, in order; deeds are numbered, and those that are forgotten keep their numbers
    deeds: Vec<(Position, Deed)>,
    forgotten: usize,
    /// frames that stand for several: number of the frame before, and how many
    merged: Vec<(u64, u32)>,
    /// states of each world
    keys: [Keys; 2],
    /// the last frame made
    last: u64,
}

impl Tape {
    /// A recording that begins here.
    pub fn new(origin: Arc<Still>, budget: usize) -> Tape {
        let mut tape = Tape {
            budget,
            shots: VecDeque::new(),
            weights: VecDeque::new(),
            shot_bytes: 0,
            deeds: Vec::new(),
            forgotten: 0,
            merged: Vec::new(),
            keys: Default::default(),
            last: origin.position().tick,
        };
        tape.keys[0].keep(Key { still: origin, deeds: 0 });
        tape
    }

    /// First and last frame that can be gone to.
    pub fn range(&self) -> (u64, u64) {
        (self.shots.front().map_or(self.last, |s| s.tick).min(self.last), self.last)
    }

    /// The shots, oldest first.
    pub fn shots(&self) -> impl DoubleEndedIterator<Item = &Arc<Shot>> {
        self.shots.iter()
    }

    /// The recorded shot of a frame, or of the last one recorded before it.
    pub fn shot(&self, tick: u64) -> Option<&Arc<Shot>> {
        let end = self.shots.partition_point(|s| s.tick <= tick);
        end.checked_sub(1).map(|i| &self.shots[i])
    }

    /// Notes that a frame was made.
    pub fn made(&mut self, tick: u64) {
        self.last = self.last.max(tick);
    }

    /// Records a shot; one of the same frame is replaced.
    pub fn push(&mut self, shot: Arc<Shot>) {
        self.made(shot.tick);
        let place = self.shots.partition_point(|s| s.tick < shot.tick);
        if self.shots.get(place).is_some_and(|s| s.tick == shot.tick) {
            self.drop_shot(place);
        }
        // A stage is shared by the frames from it on.
        let before = place.checked_sub(1).map(|i| &self.shots[i]);
        let new_stage = before.is_some_and(|s| !Arc::ptr_eq(&s.stage, &shot.stage));
        let bytes = bytes(&shot) + if new_stage { shot.stage.body_count() * STAGE_BYTES } else { 0 };
        self.shot_bytes += bytes;
        self.shots.insert(place, shot);
        self.weights.insert(place, bytes);
        let most = (self.budget as f64 * SHOTS_PART) as usize;
        while self.shot_bytes > most && self.shots.len() > FEWEST_SHOTS {
            self.drop_shot(0);
        }
    }

    fn drop_shot(&mut self, place: usize) {
        self.shots.remove(place);
        self.shot_bytes -= self.weights.remove(place).unwrap_or(0);
    }

    /// Keeps a state of each world if it is time, and forgets what nobody can ask for any more. `cost`: what was computed
    /// since the last call. `clock` is asked how long copying takes.
    pub fn keep<'a>(
        &mut self,
        machines: impl Iterator<Item = &'a mut Machine>,
        cost: Duration,
        clock: &dyn Fn() -> std::time::Instant,
    ) {
        let mut kept = false;
        let deeds = self.deeds_made();
        for (keys, machine) in self.keys.iter_mut().zip(machines) {
            if keys.is_due(machine.position(), cost) {
                let start = clock();
                keys.keep(Key { still: Arc::new(Still::of(machine)), deeds });
                keys.copying = clock().saturating_duration_since(start);
                kept = true;
            } else {
                keys.spent += cost;
            }
        }
        if kept {
            self.forget();
        }
    }

    /// Begins the recording of a rival.
    pub fn begin_rival(&mut self, rival: &mut Machine) {
        self.keys[1] = Keys::default();
        // There may be deeds to come, if this is a frame that was gone back to.
        let deeds = self.deeds_after(rival.position());
        self.keys[1].keep(Key { still: Arc::new(Still::of(rival)), deeds });
    }

    /// Ends it.
    pub fn end_rival(&mut self) {
        self.keys[1] = Keys::default();
    }

    fn forget(&mut self) {
        let first = self.range().0;
        let budget = (self.budget as f64 * (1.0 - SHOTS_PART)) as usize;
        let share = if self.keys[1].len() > 0 { budget / 2 } else { budget };
        self.keys.iter_mut().for_each(|keys| keys.thin(first, share));
        let starts = || self.keys.iter().filter_map(|keys| keys.list.first());
        let Some(needed) = starts().map(|k| k.deeds).min() else { return };
        let start = starts().map(|k| k.at().tick).min().unwrap_or(0);
        self.deeds.drain(..needed - self.forgotten);
        self.forgotten = needed;
        let gone = self.merged.partition_point(|(tick, _)| *tick < start);
        self.merged.drain(..gone);
    }

    /// Writes a deed down that was done here. Of hands that hold the same body at the same place only the last counts.
    pub fn note(&mut self, at: Position, deed: Deed) {
        if let (Some((then, Deed::Hold { grip: Some(old), standing })), Deed::Hold { grip: Some(new), standing: now }) =
            (self.deeds.last(), &deed)
            && (*then, old.body, old.point, standing) == (at, new.body, new.point, now)
            && self.keys.iter().all(|keys| keys.list.last().is_none_or(|k| k.deeds < self.deeds_made()))
        {
            self.deeds.pop();
        }
        self.deeds.push((at, deed));
    }

    /// Writes down that the frame after this one stands for several.
    pub fn note_merged(&mut self, tick: u64, merged: u32) {
        if self.merged.last().is_some_and(|m| m.0 == tick) {
            self.merged.pop();
        }
        if merged > 1 {
            self.merged.push((tick, merged));
        }
    }

    /// How many frames the one after this one stands for.
    pub fn merged(&self, tick: u64) -> u32 {
        self.merged.binary_search_by_key(&tick, |m| m.0).map_or(1, |i| self.merged[i].1)
    }

    /// Number of the next deed.
    fn deeds_made(&self) -> usize {
        self.forgotten + self.deeds.len()
    }

    /// Number of the first deed after a place.
    pub fn deeds_after(&self, at: Position) -> usize {
        self.forgotten + self.deeds.partition_point(|(then, _)| *then <= at)
    }

    /// A deed.
    pub fn deed(&self, number: usize) -> Option<&(Position, Deed)> {
        self.deeds.get(number.checked_sub(self.forgotten)?)
    }

    /// Memory it may take \[bytes\].
    pub fn budget(&self) -> usize {
        self.budget
    }

    /// Forgets everything after here. In the middle of a frame, the frame itself goes on.
    pub fn cut(&mut self, here: Position) {
        while self.shots.back().is_some_and(|s| s.tick > here.tick) {
            self.drop_shot(self.shots.len() - 1);
        }
        self.deeds.retain(|(at, _)| *at <= here);
        self.merged.retain(|(tick, _)| *tick < here.tick || (*tick == here.tick && here.done > 0));
        self.keys.iter_mut().for_each(|keys| keys.cut(here));
        self.last = self.last.min(here.tick);
    }

    /// The states of a world: 0 the world, 1 its rival.
    pub fn keys(&self, lane: usize) -> &Keys {
        &self.keys[lane]
    }
}

/// About how much memory a shot takes.
fn bytes(shot: &Shot) -> usize {
    200 + shot.poses.positions.len() * 24 + shot.poses.orientations.len() * 32
}
