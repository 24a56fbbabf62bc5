//! Algorithm III of the thesis (section 5.2.3): move for a physical step, detect, respond. START HERE.
//!
//! Collisions of a step are taken as simultaneous at its end. What a body passes through within a step goes unseen
//! (requirement 4); `World::largest_step` says how far that can be.

use super::Recipe;
use crate::bounds;
use crate::contact::{collect, project};
use crate::counters::Counters;
use crate::error::Result;
use crate::impact::answer;
use crate::math::max;
use crate::motion;
use crate::state::State;
use crate::work::Work;
use crate::world::Books;
use std::time::Instant;

/// One step. On an error the state is what it was.
pub(crate) fn step(recipe: &Recipe<'_>, state: &mut State, work: &mut Work, books: &mut Books) -> Result<()> {
    let model = recipe.model;
    let start = Instant::now();
    let mut let_back = std::mem::take(&mut state.let_back);
    collect::settle_planes(model, state, &mut let_back);
    state.let_back = let_back;
    move_all(recipe, state, work, books)?;
    let moved = Instant::now();
    let fastest = bounds::place(model, state, work);
    books.largest_step = max(books.largest_step, 0.5 * fastest.sqrt() * recipe.dt);
    let bounded = Instant::now();
    collect::find_candidates(model, work);
    let candidates = Instant::now();
    let mut let_back = std::mem::take(&mut state.let_back);
    collect::collect(model, state, &mut let_back, work);
    state.let_back = let_back;
    let contacts = Instant::now();
    answer::answer(recipe, state, work, &mut books.ledger);
    let answered = Instant::now();
    project::project(recipe, state, work, &mut books.ledger);
    if recipe.law.needs_contact_memory() {
        state.contacts.remember(&work.contacts.list);
    }
    let times = &mut work.stages;
    times.motion = moved - start;
    times.bounds = bounded - moved;
    times.broad = candidates - bounded;
    times.narrow = contacts - candidates;
    times.impact = answered - contacts;
    times.projection = answered.elapsed();
    Ok(())
}

/// The motion, undone if a field of the user's failed half-way.
fn move_all(recipe: &Recipe<'_>, state: &mut State, work: &mut Work, books: &mut Books) -> Result<()> {
    let model = recipe.model;
    let may_fail = model.forces.iter().any(|f| f.field.uniform().is_none())
        || model.flows.iter().any(|f| f.field.uniform().is_none());
    let before = may_fail.then(|| (state.clone(), books.ledger));
    let mut counters = Counters::default();
    let result = motion::advance(model, state, work, recipe.dt, &mut books.ledger, &mut counters);
    work.counters += counters;
    if let (Err(_), Some((old, ledger))) = (&result, before) {
        *state = old;
        books.ledger = ledger;
    }
    result
}
