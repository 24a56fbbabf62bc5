//! Overlaps of inelastic bodies that would not leave each other by themselves are projected out, and the work is booked.
//! Elastic contacts are never touched: their overlap ends by itself, and a push would change the energy.

use super::{Contact, Other};
use crate::field::sum::potential_energy;
use crate::impact::answer::{PairSurfaces, all_is_elastic, resting_speed};
use crate::ledger::Ledger;
use crate::math::{Real, Vec3};
use crate::model::Model;
use crate::state::State;
use crate::step::Recipe;
use crate::work::Work;

/// Passes over the contacts: enough for a body held from several sides; what is left is taken up in the next step.
const PASSES: usize = 16;

/// Projects the overlaps out.
pub(crate) fn project(recipe: &Recipe<'_>, state: &mut State, work: &mut Work, ledger: &mut Ledger) {
    let model = recipe.model;
    if all_is_elastic(model) {
        return;
    }
    let mut pairs = PairSurfaces::new(model);
    let stuck: Vec<Contact> = work
        .contacts
        .ordered()
        .list
        .iter()
        .filter(|c| c.depth > 0.0 && pairs.of(c).restitution < 1.0 && is_stuck(recipe, state, c))
        .copied()
        .collect();
    if stuck.is_empty() {
        return;
    }
    let has_potential = !model.forces.is_empty();
    let before = if has_potential { potential_energy(model, state) } else { 0.0 };
    work.shifts.clear();
    work.shifts.resize(state.lines.len(), Vec3::ZERO);
    for _ in 0..PASSES {
        for contact in &stuck {
            push_apart(state, &mut work.shifts, contact, slack(recipe, &work.accelerations, contact));
        }
    }
    work.counters.projections += stuck.len() as u64;
    if has_potential {
        ledger.position_correction += potential_energy(model, state) - before;
    }
}

/// Whether the pair separates too slowly to leave its overlap within the next step.
fn is_stuck(recipe: &Recipe<'_>, state: &State, contact: &Contact) -> bool {
    let velocity = |slot: u32| point_velocity(recipe.model, state, slot, contact.point);
    let b = match contact.b {
        Other::Body(slot) => velocity(slot),
        Other::Wall(_) => Vec3::ZERO,
    };
    let separating = (b - velocity(contact.a)).dot(contact.normal);
    separating * recipe.dt < contact.depth
}

fn point_velocity(model: &Model, state: &State, slot: u32, point: Vec3) -> Vec3 {
    let i = slot as usize;
    let (line, spin) = (&state.lines[i], &state.spins[i]);
    let w = model.body(i).inertia.angular_velocity(spin.q, spin.l);
    line.v + w.cross(point - line.x)
}

/// The depth that two bodies at rest upon each other keep \[m\]: what the fields alone can close within the steps that count
/// as rest. Without it a pile that falls together onto its floor would lose its inner contacts, and each layer would learn
/// of the floor one step later than the one below. It vanishes with the square of the step. A contact with a boundary needs
/// none: the fall itself renews it.
fn slack(recipe: &Recipe<'_>, accelerations: &[Vec3], contact: &Contact) -> Real {
    match contact.b {
        Other::Body(_) => resting_speed(recipe.dt, accelerations, contact) * recipe.dt,
        Other::Wall(_) => 0.0,
    }
}

/// Moves the two apart along the normal by what is left of the overlap beyond the slack \[m\], in proportion to their inverse masses.
fn push_apart(state: &mut State, shifts: &mut [Vec3], contact: &Contact, slack: Real) {
    let a = contact.a as usize;
    let (shift_b, weight_b) = match contact.b {
        Other::Body(slot) => (shifts[slot as usize], state.lines[slot as usize].inverse_mass),
        Other::Wall(_) => (Vec3::ZERO, 0.0),
    };
    let weight_a = state.lines[a].inverse_mass;
    let depth = contact.depth + (shifts[a] - shift_b).dot(contact.normal) - slack;
    let weight = weight_a + weight_b;
    if !(depth > 0.0) || weight == 0.0 {
        return;
    }
    let mut shift = |slot: usize, by: Vec3| {
        shifts[slot] += by;
        state.lines[slot].x += by;
    };
    shift(a, contact.normal * (-depth * (weight_a / weight)));
    if let Other::Body(slot) = contact.b {
        shift(slot as usize, contact.normal * (depth * (weight_b / weight)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lighter_body_moves_more() {
        let line = |x: Real, w: Real| crate::state::Line {
            x: Vec3::new(x, 0.0, 0.0),
            radius: 1.0,
            v: Vec3::ZERO,
            inverse_mass: w,
        };
        let mut state = State { lines: vec![line(0.0, 1.0), line(1.5, 3.0)], ..State::default() };
        let contact = Contact {
            key: 0,
            a: 0,
            b: Other::Body(1),
            feature: 0,
            normal: Vec3::X,
            point: Vec3::ZERO,
            depth: 0.5,
            first_point: 0,
            point_count: 0,
        };
        let mut shifts = vec![Vec3::ZERO; 2];
        push_apart(&mut state, &mut shifts, &contact, 0.0);
        assert_eq!(state.lines[0].x.x, -0.125);
        assert_eq!(state.lines[1].x.x, 1.875);
        push_apart(&mut state, &mut shifts, &contact, 0.0);
        assert_eq!(state.lines[1].x.x, 1.875, "nothing is left to push");
    }
}
