//! What a session sees of its worlds, and what it tells.

use super::core::{Core, News, Task};
use super::lane::Lane;
use super::report::{Report, Side, Timeline};
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
            self.tape.push(self.lanes[0].shot.clone());
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
        let trail = self.trail();
        let restoring = self.restore.is_some();
        let mut trails = [trail, Vec::new()].into_iter();
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

    /// Poses of earlier frames, oldest first.
    fn trail(&self) -> Vec<Arc<Poses>> {
        let shot = &self.lanes[0].shot;
        let earlier = self.tape.shots().rev().skip_while(|s| s.tick >= shot.tick);
        let same = earlier.take_while(|s| Arc::ptr_eq(&s.stage, &shot.stage)).take(self.wish.trail);
        let mut trail: Vec<_> = same.map(|s| s.poses.clone()).collect();
        trail.reverse();
        trail
    }
}
