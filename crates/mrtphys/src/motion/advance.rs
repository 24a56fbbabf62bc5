//! The motion stage: fields, translation, free rotation.
//!
//! Energy is measured only where the motion is not exact: under uniform fields without a medium the parabola loses nothing,
//! and measuring would book round-off. Where it is measured, each body's change is kept apart and summed in the order of
//! creation.

use super::rotation::rotate_free;
use super::translation::{Drag, Moved, explicit_euler, parabola, semi_implicit_euler};
use super::varying;
use crate::bounds::{Ball, Fastest, faster};
use crate::counters::Counters;
use crate::def::Integrator;
use crate::error::Result;
use crate::field::sum::{Fields, in_order, moves, potential_energy};
use crate::ledger::Ledger;
use crate::math::{Real, Vec3};
use crate::model::Model;
use crate::par::{for_each_block, for_each_block2};
use crate::state::{Line, Spin, State};
use crate::wide::{self, Loop};
use crate::work::Work;
use rayon::prelude::*;

/// Farthest from the origin that a body may be \[m\]: squares of larger distances leave the range of numbers.
pub const FARTHEST: Real = 1e150;

/// Moves and turns every body for `dt` \[s\]; bodies of infinite mass and those set aside stay. `work.accelerations` then
/// holds every body's acceleration by the force fields at its new place; it is empty where there are none.
///
/// A body whose motion is no longer finite, or leads farther than [`FARTHEST`], is set aside: it stays where it was, without
/// velocity and spin, its radius becomes -1, it is counted, and its energy leaves through `created_removed`. The others
/// move, to the last bit, as if it had not been there.
///
/// # Errors
/// [`Error::Callback`](crate::Error::Callback) if a field gives what is not finite. If that field is the same everywhere,
/// nothing has changed; else `state`, `ledger` and `counters` are half-way, and the caller undoes the step.
pub fn advance(
    model: &Model,
    state: &mut State,
    work: &mut Work,
    dt: Real,
    ledger: &mut Ledger,
    counters: &mut Counters,
) -> Result<()> {
    work.placed = None;
    if dt == 0.0 || state.lines.is_empty() {
        work.accelerations.clear();
        return Ok(());
    }
    let settings = &model.settings;
    let drag = Drag::new(settings.viscosity, dt);
    let fields = Fields::new(model, &state.lines);
    fields.check_uniform()?;
    let force = fields.uniform_force();
    let flow = if drag.is_void() { Some(Vec3::ZERO) } else { fields.uniform_flow() };
    let closed = settings.integrator != Integrator::RungeKutta4 || drag.is_void();
    let uniform = force.zip(flow).filter(|_| closed);
    let no_force = fields.no_force();
    // Where nothing spins and nothing has been given spin since, there is nothing to look at.
    let spun_out = if work.nothing_spins { Vec::new() } else { turn(model, &mut state.spins, &drag, ledger) };
    work.nothing_spins = work.nothing_spins || state.spins.par_iter().all(|spin| spin.l == Vec3::ZERO);
    set_aside(model, state, &spun_out, ledger, counters);
    let Some((accelerations, flow)) = uniform else {
        return varying::translate(model, state, work, &drag, ledger, counters);
    };
    let lost = if no_force && drag.is_void() && model.all_spheres {
        drift_and_place(&mut state.lines, work, dt)
    } else if no_force && drag.is_void() {
        drift(&mut state.lines, dt)
    } else {
        fall(model, &mut state.lines, &accelerations, flow, &drag, ledger)
    };
    if !lost.is_empty() {
        work.placed = None;
        set_aside(model, state, &lost, ledger, counters);
    }
    if no_force {
        work.accelerations.clear();
        return Ok(());
    }
    let lines = &state.lines;
    work.accelerations.resize(lines.len(), Vec3::ZERO);
    for_each_block(&mut work.accelerations, |first, block| {
        for (i, a) in block.iter_mut().enumerate() {
            let slot = first + i;
            *a = if moves(&lines[slot]) { accelerations[model.type_of[slot] as usize] } else { Vec3::ZERO };
        }
    });
    Ok(())
}

/// Whether a body may be there with this velocity. Comparisons with NaN are false.
#[inline]
pub(super) fn is_fine(x: Vec3, v: Vec3) -> bool {
    let near = (x.x.abs() <= FARTHEST) & (x.y.abs() <= FARTHEST) & (x.z.abs() <= FARTHEST);
    near & (v.x.abs() < Real::INFINITY) & (v.y.abs() < Real::INFINITY) & (v.z.abs() < Real::INFINITY)
}

/// Motion of bodies on which nothing acts: x += v dt. Returns the slots of those that cannot go on.
fn drift(lines: &mut [Line], dt: Real) -> Vec<u32> {
    let lost = Lost::default();
    for_each_block(lines, |first, block| {
        for (i, line) in block.iter_mut().enumerate() {
            drift_one(line, dt, || lost.add(first + i));
        }
    });
    lost.slots()
}

/// The same for spheres, which are all their bounds: those are found on the way, while each body is at hand.
fn drift_and_place(lines: &mut [Line], work: &mut Work, dt: Real) -> Vec<u32> {
    let (lost, fastest) = (Lost::default(), Fastest::default());
    work.balls.resize(lines.len(), Ball::EMPTY);
    for_each_block2(lines, &mut work.balls, |first, lines, balls| {
        fastest.note(wide::run(DriftAndPlace { lines, balls, dt, lost: |k| lost.add(first + k) }));
    });
    work.placed = Some(fastest.get());
    lost.slots()
}

/// The loop of [`drift_and_place`] over a block; it returns the largest of [`faster`].
struct DriftAndPlace<'a, F> {
    lines: &'a mut [Line],
    balls: &'a mut [Ball],
    dt: Real,
    /// is told the numbers of those that cannot go on
    lost: F,
}

impl<F: Fn(usize)> Loop for DriftAndPlace<'_, F> {
    type Output = Real;

    #[inline(always)]
    fn run(self) -> Real {
        let mut largest = 0.0;
        for (k, (line, ball)) in self.lines.iter_mut().zip(self.balls).enumerate() {
            drift_one(line, self.dt, || (self.lost)(k));
            *ball = Ball { center: line.x, radius: line.radius };
            largest = faster(largest, line);
        }
        largest
    }
}

#[inline(always)]
fn drift_one(line: &mut Line, dt: Real, lost: impl FnOnce()) {
    if !moves(line) {
        return;
    }
    let x = line.x + line.v * dt;
    // Nearly always one comparison is enough: where the sum is small so is each, and a velocity that is not finite leads to a
    // place that is not.
    if x.x.abs() + x.y.abs() + x.z.abs() <= FARTHEST || is_fine(x, line.v) {
        line.x = x;
    } else {
        lost();
    }
}

/// Slots of bodies that cannot go on, gathered from all blocks.
#[derive(Default)]
struct Lost(std::sync::Mutex<Vec<u32>>);

impl Lost {
    #[cold]
    fn add(&self, slot: usize) {
        // A poisoned lock still holds the list: what is in it was whole before the panic elsewhere.
        self.0.lock().unwrap_or_else(std::sync::PoisonError::into_inner).push(slot as u32);
    }

    /// In ascending order, whatever the order of the blocks was.
    fn slots(self) -> Vec<u32> {
        let mut slots = self.0.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
        slots.sort_unstable();
        slots
    }
}

/// What a body's motion gained, by cause \[J\].
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Gain {
    pub drag: Real,
    pub integration: Real,
    pub fields: Real,
}

/// Books the gains of all bodies.
pub(super) fn book(model: &Model, gains: &[Gain], ledger: &mut Ledger) {
    let sum = |of: fn(&Gain) -> Real| in_order(model, &gains.iter().map(of).collect::<Vec<Real>>());
    ledger.drag += sum(|g| g.drag);
    ledger.integration += sum(|g| g.integration);
    ledger.work_of_fields += sum(|g| g.fields);
}

/// Motion under an acceleration that is constant for each type of body, in a uniform flow.
fn fall(model: &Model, lines: &mut [Line], a: &[Vec3], u: Vec3, drag: &Drag, ledger: &mut Ledger) -> Vec<u32> {
    let lost = Lost::default();
    let integrator = model.settings.integrator;
    let exact = matches!(integrator, Integrator::Parabola | Integrator::RungeKutta4);
    let step = match (integrator, drag.is_void()) {
        (Integrator::ExplicitEuler, _) => explicit_euler,
        (Integrator::SemiImplicitEuler, _) => semi_implicit_euler,
        // The classical Runge-Kutta scheme is exact for polynomials up to the fourth degree: here it is the parabola.
        (_, true) => parabola::<true>,
        (_, false) => parabola::<false>,
    };
    let one = |slot: usize, line: &mut Line| -> Gain {
        if !moves(line) {
            return Gain::default();
        }
        let a = a[model.type_of[slot] as usize];
        let (x, v) = (line.x, line.v);
        let moved = step(x, v, a, u, drag);
        if !is_fine(moved.x, moved.v) {
            lost.add(slot);
            return Gain::default();
        }
        (line.x, line.v) = (moved.x, moved.v);
        gain(model.body(slot).mass, (x, v), a, &moved, exact)
    };
    if exact && drag.is_void() {
        for_each_block(lines, |first, block| {
            for (i, line) in block.iter_mut().enumerate() {
                one(first + i, line);
            }
        });
    } else {
        let mut gains = vec![Gain::default(); lines.len()];
        for_each_block2(lines, &mut gains, |first, lines, gains| {
            lines.iter_mut().zip(gains).enumerate().for_each(|(i, (line, gain))| *gain = one(first + i, line));
        });
        book(model, &gains, ledger);
    }
    lost.slots()
}

/// Gain of kinetic energy over the work m a.dx of a uniform field: all of it drag where the motion is exact; else drag is
/// what braking took, and the rest is the scheme's.
fn gain(mass: Real, (x, v): (Vec3, Vec3), a: Vec3, moved: &Moved, exact: bool) -> Gain {
    let total = mass * (0.5 * (moved.v - v).dot(moved.v + v) - a.dot(moved.x - x));
    if exact {
        return Gain { drag: total, ..Gain::default() };
    }
    let drag = 0.5 * mass * (moved.v - moved.undamped).dot(moved.v + moved.undamped);
    Gain { drag, integration: total - drag, fields: 0.0 }
}

/// Turns every body that spins. Returns the slots of those whose spin is no longer finite, unchanged.
///
/// With viscous spin L decays as v does, L(t) = L e^-z. The equations of motion are homogeneous: turning with a smaller L is
/// turning more slowly on the same path, so the orientation is that of free rotation after the time t f1(z).
fn turn(model: &Model, spins: &mut [Spin], drag: &Drag, ledger: &mut Ledger) -> Vec<u32> {
    let lost = Lost::default();
    let braked = model.settings.viscous_spin && !drag.is_void();
    let (time, decay) = if braked { (drag.reach, drag.decay) } else { (drag.dt, 1.0) };
    let one = |slot: usize, spin: &mut Spin| -> Gain {
        if spin.l == Vec3::ZERO {
            return Gain::default();
        }
        let inertia = &model.body(slot).inertia;
        let (q, l) = (rotate_free(spin.q, spin.l, inertia, time), spin.l * decay);
        if !(q.is_finite() && l.is_finite()) {
            lost.add(slot);
            return Gain::default();
        }
        let drag = if braked { inertia.energy(q, l) - inertia.energy(spin.q, spin.l) } else { 0.0 };
        *spin = Spin { q, l };
        Gain { drag, ..Gain::default() }
    };
    if braked {
        let mut gains = vec![Gain::default(); spins.len()];
        for_each_block2(spins, &mut gains, |first, spins, gains| {
            spins.iter_mut().zip(gains).enumerate().for_each(|(i, (spin, gain))| *gain = one(first + i, spin));
        });
        book(model, &gains, ledger);
    } else {
        for_each_block(spins, |first, block| {
            for (i, spin) in block.iter_mut().enumerate() {
                one(first + i, spin);
            }
        });
    }
    lost.slots()
}

/// Sets bodies aside.
///
/// Their energy is what the world's energy loses with them. Where that is no number either, there is nothing to book: the
/// world's energy was no number before.
pub(super) fn set_aside(model: &Model, state: &mut State, slots: &[u32], ledger: &mut Ledger, counters: &mut Counters) {
    for &slot in slots {
        let slot = slot as usize;
        if state.lines[slot].radius < 0.0 {
            continue;
        }
        let body = model.body(slot);
        let potential = |state: &State| if model.forces.is_empty() { 0.0 } else { potential_energy(model, state) };
        let with = potential(state);
        let (line, spin) = (state.lines[slot], state.spins[slot]);
        state.lines[slot] = Line { v: Vec3::ZERO, radius: -1.0, ..line };
        state.spins[slot].l = Vec3::ZERO;
        let kinetic = 0.5 * body.mass * line.v.length_squared() + body.inertia.energy(spin.q, spin.l);
        let energy = kinetic + (with - potential(state));
        if energy.is_finite() {
            ledger.created_removed -= energy;
        }
        counters.quarantined += 1;
    }
}
