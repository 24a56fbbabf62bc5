//! Steps and frames, and questions about contacts without a step.

use super::World;
use crate::bounds;
use crate::contact::{Other, collect};
use crate::counters::Counters;
use crate::error::{Error, Result};
use crate::event::{ImpactEvent, Partner};
use crate::id::BoundaryId;
use crate::math::Real;
use crate::par;
use crate::step::{self, Recipe};
use rayon::prelude::*;

/// Scenes with fewer bodies stay in the first cache in any order.
const SORT_FROM: usize = 2000;
/// Steps after which storage has lost its order so far that sorting it again pays.
const SORT_EVERY: u64 = 16;

/// Two things that overlap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Overlap {
    /// first body
    pub a: crate::id::BodyId,
    /// the other
    pub b: Partner,
    /// depth along the contact normal \[m\]
    pub depth: Real,
}

impl World {
    /// One physical step.
    ///
    /// # Errors
    /// A field of the user's gave a value that is not finite; the world is then what it was before the step.
    pub fn step(&mut self) -> Result<()> {
        let dt = self.time_step();
        self.advance_by(dt, true)
    }

    /// One step of another length \[s\]; 0: nothing happens.
    ///
    /// # Errors
    /// The length is negative, not finite, denormal or above 1e9 s; or as [`step`](World::step).
    pub fn step_by(&mut self, dt: Real) -> Result<()> {
        if dt == 0.0 {
            return Ok(());
        }
        if !dt.is_finite() {
            return Err(Error::NonFinite { object: "step".into(), field: "dt" });
        }
        if !(Real::MIN_POSITIVE..=1e9).contains(&dt) {
            let expected = "0, or 2.2e-308 to 1e9 s";
            return Err(Error::OutOfRange { object: "step".into(), field: "dt", value: dt, expected });
        }
        self.advance_by(dt, false)
    }

    /// One frame: as many physical steps as the settings say.
    ///
    /// # Errors
    /// As [`step`](World::step); the steps before the failing one have been made.
    pub fn frame(&mut self) -> Result<()> {
        (0..self.model.settings.steps_per_frame).try_for_each(|_| self.step())
    }

    /// Stores the bodies in the order in which the broad phase last found them in space: neighbours in space become
    /// neighbours in memory. Done by itself for large scenes; it changes no result.
    pub fn sort_storage(&mut self) {
        let order = self.work.broad.as_ref().map_or(&[][..], |b| b.spatial_order()).to_vec();
        if order.len() != self.state.lines.len() {
            return;
        }
        let (model, state) = (&mut self.model, &mut self.state);
        let spare = &mut self.work.spare;
        permute(&mut state.lines, &order, &mut spare.lines);
        permute(&mut state.spins, &order, &mut spare.spins);
        permute(&mut model.type_of, &order, &mut spare.numbers);
        permute(&mut model.serial, &order, &mut spare.numbers);
        permute(&mut model.fixed, &order, &mut spare.flags);
        self.ids.permute(&order);
        model.epoch += 1;
        self.work.storage_is_new = false;
    }

    /// A step. It is made within the pool of threads: from outside, every loop would wake its threads anew.
    fn advance_by(&mut self, dt: Real, full: bool) -> Result<()> {
        if rayon::current_thread_index().is_some() || par::is_alone(self.state.lines.len()) {
            return self.advance_here(dt, full);
        }
        rayon::scope(|_| self.advance_here(dt, full))
    }

    fn advance_here(&mut self, dt: Real, full: bool) -> Result<()> {
        let in_disorder = self.work.storage_is_new || self.state.clock.steps.is_multiple_of(SORT_EVERY);
        if self.state.lines.len() >= SORT_FROM && in_disorder {
            self.sort_storage();
        }
        self.refresh_scopes();
        if self.books.initial.is_none() {
            self.books.initial = Some(self.energy());
        }
        self.work.counters = Counters::default();
        let mut clock = self.state.clock;
        if full {
            let s = &self.model.settings;
            clock.tick(u64::from(s.fps) * u64::from(s.steps_per_frame));
        } else {
            clock.tick_by(dt);
        }
        let recipe = Recipe { model: &self.model, law: &*self.law, dt, record_events: self.recording };
        step::fixed_step::step(&recipe, &mut self.state, &mut self.work, &mut self.books)?;
        self.state.clock = clock;
        self.books.totals += self.work.counters;
        self.collect_events();
        Ok(())
    }

    /// Names the parties of the step's impacts by handles.
    fn collect_events(&mut self) {
        let time = self.state.clock.time();
        for e in &self.work.events {
            self.events.push_back(ImpactEvent {
                time,
                a: self.ids.id(e.a as usize, self.tag),
                b: partner(&self.ids, self.tag, e.b),
                point: e.point,
                normal: e.normal,
                impulse_n: e.impulse_n,
                impulse_t: e.impulse_t,
                energy_change: e.energy_change,
            });
        }
    }

    /// Everything that overlaps now by more than round-off, in order of response; touching is no overlap. For `check`.
    pub fn overlaps(&mut self) -> Vec<Overlap> {
        let counters = self.work.counters;
        bounds::place(&self.model, &self.state, &mut self.work);
        collect::find_candidates(&self.model, &mut self.work);
        let mut let_back = self.state.let_back.clone();
        collect::collect(&self.model, &self.state, &mut let_back, &mut self.work);
        self.work.counters = counters;
        let found = self.work.contacts.ordered().list.iter().filter(|c| {
            let size = self.state.lines[c.a as usize].radius.abs() + self.state.lines[c.a as usize].x.max_abs();
            c.depth > 64.0 * Real::EPSILON * size
        });
        found
            .map(|c| Overlap {
                a: self.ids.id(c.a as usize, self.tag),
                b: partner(&self.ids, self.tag, c.b),
                depth: c.depth,
            })
            .collect()
    }
}

/// What is at `order[k]` goes to k; the old memory is kept for the next time.
fn permute<T: Copy + Send + Sync>(items: &mut Vec<T>, order: &[u32], spare: &mut Vec<T>) {
    order.par_iter().map(|&slot| items[slot as usize]).collect_into_vec(spare);
    std::mem::swap(items, spare);
}

fn partner(ids: &super::ids::IdTable, world: u32, other: Other) -> Partner {
    match other {
        Other::Body(slot) => Partner::Body(ids.id(slot as usize, world)),
        Other::Wall(index) => Partner::Boundary(BoundaryId { index, world }),
    }
}
