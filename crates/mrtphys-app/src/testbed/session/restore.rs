//! Going to another frame of the recording.

use super::core::{Core, News};
use super::machine::Position;

/// A frame on its way back.
pub struct Restore {
    /// its number
    pub target: u64,
    /// for each world, the number of the deed that comes next; `None`: it is there
    next: Vec<Option<usize>>,
}

impl Core {
    /// Goes to a frame: its picture at once, its state as soon as it is computed again.
    pub(super) fn seek(&mut self, tick: u64) {
        self.stand();
        if self.restore.is_none() {
            self.look_again();
        }
        let (first, last) = self.tape.range();
        let target = tick.clamp(first, last);
        let now = self.now();
        self.pace.jump(now);
        if self.restore.is_none() && self.position() == (Position { tick: target, done: 0 }) && !self.is_inside() {
            return;
        }
        if let Some(shot) = self.tape.shot(target).cloned() {
            self.lanes[0].show(shot);
        }
        let under_way = self.restore.take().map(|r| r.next);
        self.set_out(target, under_way, true);
    }

    /// Goes to a frame from a state kept, not from where the worlds are.
    pub(super) fn return_to(&mut self, target: u64) {
        self.restore = None;
        self.set_out(target, None, false);
    }

    /// `trusted`: the worlds may go on from where they are.
    fn set_out(&mut self, target: u64, under_way: Option<Vec<Option<usize>>>, trusted: bool) {
        let warm = self.wish.contacts || self.wish.cells;
        let goal = Position { tick: target, done: 0 };
        let mut next = Vec::new();
        for (i, lane) in self.lanes.iter_mut().enumerate() {
            let here = lane.machine.position();
            let key = self.tape.keys(i).nearest(target, warm);
            let own = match &under_way {
                Some(next) => next[i],
                None => Some(self.tape.deeds_after(here)),
            };
            // A world that is between the best state kept and the goal goes on from where it is.
            let nearer = trusted && here <= goal && key.is_some_and(|k| k.at() <= here) && !(warm && here == goal);
            match (own, key) {
                (Some(deed), Some(_)) if nearer => next.push(Some(deed)),
                (_, Some(key)) => {
                    lane.machine = key.still.awake();
                    next.push(Some(key.deeds));
                }
                // From before there was a rival: it is made anew.
                (_, None) => next.push(None),
            }
        }
        self.restore = Some(Restore { target, next });
    }

    /// One physical step on the way; at the end, everything is as it was then.
    pub(super) fn restore_on(&mut self) {
        let Some(restore) = &mut self.restore else { return };
        let goal = Position { tick: restore.target, done: 0 };
        for (lane, next) in self.lanes.iter_mut().zip(&mut restore.next) {
            let Some(number) = next else { continue };
            let machine = &mut lane.machine;
            while let Some((at, deed)) = self.tape.deed(*number)
                && *at == machine.position()
            {
                // What was refused then is refused now.
                let _ = machine.apply(deed);
                *number += 1;
            }
            let here = machine.position();
            if here >= goal {
                machine.withdraw();
                continue;
            }
            if !machine.is_inside() {
                machine.begin(self.tape.merged(here.tick));
            }
            if let Err(e) = machine.step() {
                let message = format!("frame {} could not be restored: {e}", goal.tick);
                self.restore = None;
                self.restored();
                return self.complain(message);
            }
            return;
        }
        self.restore = None;
        self.restored();
    }

    fn restored(&mut self) {
        let reached = self.position().tick;
        let now = self.now();
        let fps = self.loaded().world.settings().fps;
        self.pace.set_fps(fps, now);
        self.pace.jump(now);
        if self.lanes.len() > 1 && self.tape.keys(1).nearest(reached, false).is_none() {
            self.fork();
        }
        let recorded = self.lanes[0].shot.tick == reached;
        for (i, lane) in self.lanes.iter_mut().enumerate() {
            lane.forget();
            // Only the world's own picture was recorded. A rival's bodies may be those of another time.
            lane.is_seen = i == 0 && recorded;
            lane.restage = i > 0;
        }
        self.is_unasked = true;
        self.listen();
        self.news = News::Answer;
    }
}
