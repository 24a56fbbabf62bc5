//! Algorithm III of the thesis (section 5.2.3): move for a physical step, detect, respond. START HERE.
//!
//! Collisions of a step are taken as simultaneous at its end. What a body passes through within a step goes unseen
//! (requirement 4); `World::largest_step` says how far that can be.

use super::Recipe;
use crate::bounds;
use crate::contact::let_back::LetBack;
use crate::contact::{collect, project};
use crate::counters::Counters;
use crate::error::Result;
use crate::impact::answer;
use crate::math::max;
use crate::model::Model;
use crate::motion;
use crate::state::State;
use crate::work::Work;
use crate::world::Books;
use std::time::{Duration, Instant};

/// One step. On an error the state is what it was.
pub(crate) fn step(recipe: &Recipe<'_>, state: &mut State, work: &mut Work, books: &mut Books) -> Result<()> {
    let model = recipe.model;
    let mut watch = Stopwatch(Instant::now());
    move_all(recipe, state, work, books)?;
    work.stages.motion = watch.lap();
    let fastest = bounds::place(model, state, work);
    books.largest_step = max(books.largest_step, 0.5 * fastest.sqrt() * recipe.dt);
    work.stages.bounds = watch.lap();
    collect::find_candidates(model, work);
    work.stages.broad = watch.lap();
    collect_contacts(model, state, work);
    work.stages.narrow = watch.lap();
    answer::answer(recipe, state, work, &mut books.ledger);
    work.stages.impact = watch.lap();
    project::project(recipe, state, work, &mut books.ledger);
    // A law without memory leaves none: what was in contact long ago is news when another law asks again.
    let remembered = recipe.law.needs_contact_memory();
    state.contacts.remember(work.contacts.blocks().take_while(|_| remembered).flatten());
    work.stages.projection = watch.lap();
    Ok(())
}

/// The motion, undone if a field of the user's failed. Two-sided planes learn first where every body is at home.
fn move_all(recipe: &Recipe<'_>, state: &mut State, work: &mut Work, books: &mut Books) -> Result<()> {
    let model = recipe.model;
    let homes = state.let_back.clone();
    with_let_back(state, |state, let_back| collect::settle_planes(model, state, let_back));
    // A field that is the same everywhere fails before anything has moved.
    let may_fail_half_way = model.forces.iter().any(|f| f.field.uniform().is_none())
        || model.flows.iter().any(|f| f.field.uniform().is_none());
    let before = may_fail_half_way.then(|| (state.clone(), books.ledger));
    let mut counters = Counters::default();
    let result = motion::advance(model, state, work, recipe.dt, &mut books.ledger, &mut counters);
    work.counters += counters;
    if result.is_err() {
        if let Some((old, ledger)) = before {
            *state = old;
            books.ledger = ledger;
        }
        state.let_back = homes;
    }
    result
}

fn collect_contacts(model: &Model, state: &mut State, work: &mut Work) {
    with_let_back(state, |state, let_back| collect::collect(model, state, let_back, work));
}

/// Lends the let-back memory out beside the rest of the state.
fn with_let_back(state: &mut State, f: impl FnOnce(&State, &mut LetBack)) {
    let mut let_back = std::mem::take(&mut state.let_back);
    f(state, &mut let_back);
    state.let_back = let_back;
}

/// Time since the last lap.
struct Stopwatch(Instant);

impl Stopwatch {
    fn lap(&mut self) -> Duration {
        let now = Instant::now();
        now - std::mem::replace(&mut self.0, now)
    }
}
