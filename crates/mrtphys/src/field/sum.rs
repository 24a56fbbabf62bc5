//! The sum of all fields, as they act in one step: who is where, whom each field acts on, what it weighs in the medium.
//!
//! Fields are added in the order in which they were made, and whatever is summed over bodies is summed in the order of
//! their creation, so that nothing depends on slots or on the number of threads.

use super::{FlowField, ForceField, Reach, Scope};
use crate::error::{Error, Result};
use crate::math::{Real, Vec3};
use crate::model::{BodyType, Model};
use crate::motion::FARTHEST;
use crate::par::{BLOCK, for_each_block};
use crate::state::{Line, State};
use rayon::prelude::*;
use std::fmt::Debug;
use std::sync::atomic::{AtomicBool, Ordering};

/// Potential energy \[J\] of all bodies in the conservative force fields, buoyancy included. A field carried by a body
/// counts once, as the potential of the bodies it acts on; bodies of infinite mass and those set aside do not count. It is
/// not finite if a user's field gives such a potential.
pub fn potential_energy(model: &Model, state: &State) -> Real {
    let fields = Fields::new(model, &state.lines);
    let x: Vec<Vec3> = state.lines.iter().map(|l| l.x).collect();
    in_order(model, &fields.potentials(&Place { lines: &state.lines, x: &x, v: &x }))
}

/// The part of [`potential_energy`] that the place of one body decides \[J\]: its own, and that of all where it carries a
/// field.
pub(crate) fn potential_round(model: &Model, state: &State, slot: usize) -> Real {
    if model.forces.iter().any(|f| f.reach.carrier == Some(slot as u32)) {
        return potential_energy(model, state);
    }
    let (line, body) = (&state.lines[slot], model.body(slot));
    if model.forces.is_empty() || !moves(line) {
        return 0.0;
    }
    let weight = body.mass * weight_in_medium(model, body);
    let acting =
        model.forces.iter().filter_map(|f| Acting::new(&*f.field, f.field.uniform(), &f.scope, &f.reach, &state.lines));
    let relative = |f: &Acting<dyn ForceField>| f.carrier.map_or(line.x, |carrier| line.x - state.lines[carrier].x);
    let potentials = acting.filter(|f| f.acts_on(slot)).filter_map(|f| f.field.potential(relative(&f)));
    potentials.fold(0.0, |sum, p| sum + weight * p)
}

/// What buoyancy leaves of a body's weight: 1 - density of the medium x volume / mass.
fn weight_in_medium(model: &Model, body: &BodyType) -> Real {
    let density = model.settings.medium_density;
    if density == 0.0 || body.mass == Real::INFINITY { 1.0 } else { 1.0 - density * body.volume / body.mass }
}

/// Acceleration \[m/s2\] of a body by all force fields, reactions of the fields it carries included; zero for infinite mass.
/// Not finite if a user's field gives such an acceleration.
pub fn acceleration_of(model: &Model, state: &State, slot: usize) -> Vec3 {
    let fields = Fields::new(model, &state.lines);
    let x: Vec<Vec3> = state.lines.iter().map(|l| l.x).collect();
    let place = Place { lines: &state.lines, x: &x, v: &x };
    let mut sum = Vec3::ZERO;
    for force in &fields.forces {
        sum += fields.pull(force, &place, slot).unwrap_or(Vec3::ZERO);
        if force.reacts && force.carrier == Some(slot) {
            let pulls: Vec<Vec3> = (0..x.len()).map(|i| fields.force(force, &place, i)).collect();
            sum -= fields.reaction(&pulls) * state.lines[slot].inverse_mass;
        }
    }
    sum
}

/// A field and what it acts on.
struct Acting<'a, F: ?Sized> {
    field: &'a F,
    number: usize,
    /// what it gives everywhere, if that is always the same
    uniform: Option<Vec3>,
    carrier: Option<usize>,
    only: Option<&'a [bool]>,
    reacts: bool,
}

impl<'a, F: ?Sized> Acting<'a, F> {
    /// `None`: its carrier is gone or set aside, and the field with it.
    fn new(
        field: &'a F,
        uniform: Option<Vec3>,
        scope: &Scope,
        reach: &'a Reach,
        lines: &[Line],
    ) -> Option<Acting<'a, F>> {
        let carrier = reach.carrier.map(|slot| slot as usize);
        let carried_by = |slot: usize| lines.get(slot).filter(|line| line.radius >= 0.0);
        if reach.gone || carrier.is_some_and(|slot| carried_by(slot).is_none()) {
            return None;
        }
        let reacts = !scope.without_reaction && carrier.is_some_and(|slot| lines[slot].inverse_mass > 0.0);
        Some(Acting { field, number: 0, uniform, carrier, only: reach.only.as_deref(), reacts })
    }

    fn numbered(self, number: usize) -> Acting<'a, F> {
        Acting { number, ..self }
    }

    fn acts_on(&self, slot: usize) -> bool {
        self.carrier != Some(slot) && self.only.is_none_or(|acts| acts.get(slot) == Some(&true))
    }

    fn everywhere(&self) -> bool {
        self.carrier.is_none() && self.only.is_none()
    }

    /// Place of a body relative to what carries the field.
    fn relative(&self, place: &Place, slot: usize) -> Vec3 {
        self.carrier.map_or(place.x[slot], |carrier| place.x[slot] - place.x[carrier])
    }
}

/// Sum of fields of which every one is the same everywhere, for all bodies.
fn total<F: ?Sized>(fields: &[Acting<F>]) -> Option<Vec3> {
    fields.iter().try_fold(Vec3::ZERO, |sum, f| f.uniform.filter(|_| f.everywhere()).map(|value| sum + value))
}

/// Where the bodies are, and how they move, at one moment of a step.
#[derive(Clone, Copy)]
pub(crate) struct Place<'a> {
    /// for the masses
    pub lines: &'a [Line],
    /// positions \[m\]
    pub x: &'a [Vec3],
    /// velocities \[m/s\]
    pub v: &'a [Vec3],
}

impl Place<'_> {
    /// Whether the body moves at all, and is somewhere. Comparisons with NaN are false.
    pub fn is_there(&self, slot: usize) -> bool {
        let x = self.x[slot];
        moves(&self.lines[slot]) & (x.x.abs() <= FARTHEST) & (x.y.abs() <= FARTHEST) & (x.z.abs() <= FARTHEST)
    }
}

/// Whether a body moves: it has a mass, and was not set aside.
#[inline]
pub(crate) fn moves(line: &Line) -> bool {
    line.inverse_mass > 0.0 && line.radius >= 0.0
}

/// What the fields do to a body.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Push {
    /// acceleration by the force fields \[m/s2\]
    pub a: Vec3,
    /// velocity of the medium \[m/s\]
    pub u: Vec3,
    /// power of the fields without potential and of those carried along without reaction \[W\]
    pub power: Real,
}

/// All fields of a step.
pub(crate) struct Fields<'a> {
    model: &'a Model,
    forces: Vec<Acting<'a, dyn ForceField>>,
    flows: Vec<Acting<'a, dyn FlowField>>,
    /// 1 - density x volume / mass, by type
    weights: Vec<Real>,
}

impl<'a> Fields<'a> {
    /// The fields as they act on these bodies.
    pub fn new(model: &'a Model, lines: &[Line]) -> Fields<'a> {
        let forces = model.forces.iter().enumerate();
        let flows = model.flows.iter().enumerate();
        Fields {
            model,
            forces: forces
                .filter_map(|(i, f)| {
                    Some(Acting::new(&*f.field, f.field.uniform(), &f.scope, &f.reach, lines)?.numbered(i))
                })
                .collect(),
            flows: flows
                .filter_map(|(i, f)| {
                    Some(Acting::new(&*f.field, f.field.uniform(), &f.scope, &f.reach, lines)?.numbered(i))
                })
                .collect(),
            weights: model.types.iter().map(|t| weight_in_medium(model, t)).collect(),
        }
    }

    /// Whether there are no forces.
    pub fn no_force(&self) -> bool {
        self.forces.is_empty()
    }

    /// [`Error::Callback`] where a field that is the same everywhere is not finite. Asked before anything has moved: such
    /// fields cannot fail later.
    pub fn check_uniform(&self) -> Result<()> {
        for force in &self.forces {
            checked(force.uniform.unwrap_or_default(), "force", force.number, force.field)?;
        }
        for flow in &self.flows {
            checked(flow.uniform.unwrap_or_default(), "flow", flow.number, flow.field)?;
        }
        Ok(())
    }

    /// The acceleration of each type of body, if it is the same everywhere and for all bodies of the type.
    pub fn uniform_force(&self) -> Option<Vec<Vec3>> {
        let sum = total(&self.forces)?;
        Some(self.weights.iter().map(|&weight| sum * weight).collect())
    }

    /// The velocity of the medium, if it is the same everywhere and for all bodies.
    pub fn uniform_flow(&self) -> Option<Vec3> {
        total(&self.flows)
    }

    /// What all fields do to every body. [`Error::Callback`] where one of them gives what is not finite.
    pub fn push(&self, place: &Place, with_flow: bool) -> Result<Vec<Push>> {
        let mut out = vec![Push::default(); place.lines.len()];
        for force in &self.forces {
            self.add_force(force, place, &mut out)?;
        }
        for flow in self.flows.iter().filter(|_| with_flow) {
            each(&mut out, |slot, push| {
                if place.is_there(slot) && flow.acts_on(slot) {
                    push.u += flow.uniform.unwrap_or_else(|| flow.field.velocity(flow.relative(place, slot)));
                }
                push.u.is_finite()
            })
            .map_err(|()| not_finite("flow", flow.number, flow.field))?;
        }
        Ok(out)
    }

    fn add_force(&self, force: &Acting<dyn ForceField>, place: &Place, out: &mut [Push]) -> Result<()> {
        // The rate at which a field's own place moves does work unless the carrier pays for it.
        let carried_along = force.carrier.filter(|&c| !force.reacts && moves(&place.lines[c])).map(|c| place.v[c]);
        let conservative = force.field.potential(Vec3::X).is_some();
        each(out, |slot, push| {
            let Some(a) = self.pull(force, place, slot) else { return true };
            push.a += a;
            let mass = self.model.body(slot).mass;
            if !conservative {
                push.power += mass * a.dot(place.v[slot]);
            } else if let Some(v) = carried_along {
                push.power += mass * a.dot(v);
            }
            a.is_finite()
        })
        .map_err(|()| not_finite("force", force.number, force.field))?;
        if let Some(carrier) = force.carrier.filter(|_| force.reacts) {
            let forces: Vec<Vec3> =
                (0..out.len()).into_par_iter().with_min_len(BLOCK).map(|i| self.force(force, place, i)).collect();
            let reaction = self.reaction(&forces) * -place.lines[carrier].inverse_mass;
            out[carrier].a += reaction;
            if !conservative {
                out[carrier].power += self.model.body(carrier).mass * reaction.dot(place.v[carrier]);
            }
        }
        Ok(())
    }

    /// Acceleration of a body by one field; `None`: it does not act on it.
    fn pull(&self, force: &Acting<dyn ForceField>, place: &Place, slot: usize) -> Option<Vec3> {
        if !place.is_there(slot) || !force.acts_on(slot) {
            return None;
        }
        let at = force.relative(place, slot);
        // The carrier itself is nowhere: this attempt at the step will be given up.
        if !at.is_finite() {
            return None;
        }
        let weight = self.weights[self.model.type_of[slot] as usize];
        let a = force.uniform.unwrap_or_else(|| force.field.acceleration(at, self.model.body(slot).mass));
        Some(a * weight)
    }

    /// Force of one field on a body \[N\].
    fn force(&self, force: &Acting<dyn ForceField>, place: &Place, slot: usize) -> Vec3 {
        self.pull(force, place, slot).map_or(Vec3::ZERO, |a| a * self.model.body(slot).mass)
    }

    /// Sum of forces in the order of the bodies' creation. Adding the zeros of bodies set aside changes no bit.
    fn reaction(&self, forces: &[Vec3]) -> Vec3 {
        match creation_order(self.model) {
            None => forces.iter().fold(Vec3::ZERO, |sum, &f| sum + f),
            Some(order) => order.iter().fold(Vec3::ZERO, |sum, &slot| sum + forces[slot as usize]),
        }
    }

    /// Potential energy of every body \[J\].
    pub fn potentials(&self, place: &Place) -> Vec<Real> {
        (0..place.lines.len())
            .into_par_iter()
            .with_min_len(BLOCK)
            .map(|slot| if place.is_there(slot) { self.potential(place, slot) } else { 0.0 })
            .collect()
    }

    fn potential(&self, place: &Place, slot: usize) -> Real {
        let weight = self.model.body(slot).mass * self.weights[self.model.type_of[slot] as usize];
        let acting = self.forces.iter().filter(|f| f.acts_on(slot));
        acting.filter_map(|f| f.field.potential(f.relative(place, slot))).fold(0.0, |sum, p| sum + weight * p)
    }
}

/// Runs over all bodies in parallel blocks; an error if any of them said so.
fn each(out: &mut [Push], f: impl Fn(usize, &mut Push) -> bool + Sync) -> std::result::Result<(), ()> {
    let failed = AtomicBool::new(false);
    for_each_block(out, |first, block| {
        if !block.iter_mut().enumerate().fold(true, |fine, (i, push)| f(first + i, push) && fine) {
            failed.store(true, Ordering::Relaxed);
        }
    });
    if failed.into_inner() { Err(()) } else { Ok(()) }
}

fn checked(value: Vec3, what: &str, number: usize, field: &(impl Debug + ?Sized)) -> Result<()> {
    if value.is_finite() { Ok(()) } else { Err(not_finite(what, number, field)) }
}

fn not_finite(what: &str, number: usize, field: &(impl Debug + ?Sized)) -> Error {
    Error::Callback { object: format!("{what} field {number} ({field:?})") }
}

/// Slots in the order of creation; `None`: that is the order of the slots.
fn creation_order(model: &Model) -> Option<Vec<u32>> {
    if model.serial.is_sorted() {
        return None;
    }
    Some(model.order())
}

/// Sum of one number per slot in the order of creation, with Neumaier's compensation: a million bodies add no round-off.
pub(crate) fn in_order(model: &Model, values: &[Real]) -> Real {
    match creation_order(model) {
        None => compensated(values.iter().copied()),
        Some(order) => compensated(order.iter().map(|&slot| values[slot as usize])),
    }
}

/// Sum with compensation (Neumaier, Z. angew. Math. Mech. 54 (1974) 39): the error of every addition is kept beside it.
fn compensated(values: impl Iterator<Item = Real>) -> Real {
    let (mut sum, mut lost) = (0.0, 0.0);
    for v in values {
        let next: Real = sum + v;
        lost += if sum.abs() >= v.abs() { (sum - next) + v } else { (v - next) + sum };
        sum = next;
    }
    sum + lost
}
