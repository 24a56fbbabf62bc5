//! What a session sees of its worlds, and what it tells.

use super::core::{Core, News, Task};
use super::lane::Lane;
use super::report::{Recorded, Report, Shot, Side, Timeline};
use mrtphys_view::Poses;
use std::sync::Arc;
use std::time::Duration;

impl Core {
    /// Makes the picture of a frame again whose bodies were changed, before it is left.
    pub(super) fn look_again(&mut self) {
        let worth_it = self.task != Task::Run || self.lanes.iter().any(|lane| lane.restage);
        if self.edited && worth_it && !self.is_inside() {
            self.look(false);
        }
        self.edited = false;
    }

    /// Looks at the worlds, and records what is seen if it is a whole frame.
    pub(super) fn look(&mut self, follows: bool) {
        let start = self.now();
        let old = self.tape.shots().next_back().map(|s| s.tick);
        let is_new = !self.lanes[0].is_seen;
        self.lanes.iter_mut().filter(|lane| !lane.is_seen).for_each(|lane| lane.look(follows));
        if is_new && !self.is_inside() {
            let shot = self.lanes[0].shot.clone();
            let rival = self.lanes.get(1).map(|lane| lane.shot.clone()).filter(|r| r.tick == shot.tick);
            self.tape.push(Recorded { shot, rival });
            let tick = self.position().tick;
            // Nothing is learned from a frame that was gone back to, or looked at again.
            self.stride = old.and_then(|old| tick.checked_sub(old)).filter(|&n| n > 0).unwrap_or(self.stride);
        }
        self.look_cost = self.now().saturating_duration_since(start);
        self.since_look = Duration::ZERO;
        self.edited = false;
    }

    /// Tells how things are.
    pub fn report(&mut self) -> Report {
        let inside = self.is_inside();
        let may_look = self.restore.is_none() && (!inside || self.task == Task::Stand);
        if may_look && self.lanes.iter().any(|lane| !lane.is_seen) {
            self.look(false);
            if self.task == Task::Stand {
                self.pace.jump(self.now());
            }
        }
        if may_look && !inside && self.is_unasked && self.lanes.len() > 1 {
            let hash = |lane: &Lane| lane.machine.world().state_hash();
            self.is_unasked = false;
            self.agrees = Some(hash(&self.lanes[0]) == hash(&self.lanes[1]));
        }
        let restoring = self.restore.is_some();
        let mut trails = [self.trail(0), self.trail(1)].into_iter();
        let wish = &self.wish;
        let sides = self.lanes.iter_mut().map(|lane| {
            let trail = trails.next().unwrap_or_default();
            if restoring { lane.last_side() } else { lane.side(wish, trail) }
        });
        let sides = sides.collect();
        self.tell(sides)
    }

    /// The last that is known, without asking the worlds anything.
    pub fn last_report(&mut self) -> Report {
        let sides = self.lanes.iter_mut().map(Lane::last_side).collect();
        self.tell(sides)
    }

    fn tell(&mut self, sides: Vec<Side>) -> Report {
        self.number += 1;
        self.news = News::None;
        let (first, last) = self.tape.range();
        let now = self.restore.as_ref().map_or(self.position().tick, |r| r.target);
        Report {
            number: self.number,
            title: self.title.clone(),
            running: self.task == Task::Run,
            pace: self.pace.report(),
            timeline: Timeline { first, last, now, stride: self.stride, restoring: self.restore.is_some() },
            rival_agrees: if sides.len() > 1 { self.agrees } else { None },
            sides,
            trouble: self.trouble.clone(),
            troubles: self.troubles,
        }
    }

    /// Poses of a world's earlier frames, oldest first.
    fn trail(&self, lane: usize) -> Vec<Arc<Poses>> {
        let Some(Lane { shot, .. }) = self.lanes.get(lane) else { return Vec::new() };
        let earlier = self.tape.frames().rev().skip_while(|f| f.shot.tick >= shot.tick);
        trail(earlier, lane, shot, self.wish.trail)
    }
}

/// Poses of a world's frames before one, oldest first: as many as asked for, and only those with the same stage. `earlier`: the
/// recording before it, backwards.
pub fn trail<'a>(
    earlier: impl Iterator<Item = &'a Recorded>,
    lane: usize,
    shot: &Shot,
    most: usize,
) -> Vec<Arc<Poses>> {
    let own = earlier.map_while(|f| f.side(lane)).take_while(|s| Arc::ptr_eq(&s.stage, &shot.stage));
    let mut trail: Vec<_> = own.take(most).map(|s| s.poses.clone()).collect();
    trail.reverse();
    trail
}
