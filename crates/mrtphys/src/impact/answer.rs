//! Stage 6 as a whole: the contacts of the step, in their order, each with the law that belongs to its pair.

use super::{Encounter, Party};
use crate::contact::collect::manifold;
use crate::contact::{Contact, ContactList, Other};
use crate::def::ImpactMode;
use crate::event::StepEvent;
use crate::ledger::Ledger;
use crate::math::{Real, Vec3, max};
use crate::model::{BodyType, Model};
use crate::state::{Line, State};
use crate::step::Recipe;
use crate::work::Work;

/// A contact is at rest, not an impact, where it approaches no faster than the fields alone can have made it within this
/// many steps: an inelastic pair then stays together instead of bouncing ever lower.
const RESTING_STEPS: Real = 2.0;
/// Sweeps over the contacts of piles at most; what is left is taken up in the next step.
const SWEEPS: usize = 64;
/// A contact in a pile is left alone below this part of the speed up to which it is at rest.
const STILL: Real = 1.0 / 64.0;

/// Answers the contacts of the step.
pub(crate) fn answer(recipe: &Recipe<'_>, state: &mut State, work: &mut Work, ledger: &mut Ledger) {
    work.events.clear();
    match recipe.model.settings.impact {
        ImpactMode::Sequential => answer_in_order(recipe, state, work, ledger),
        ImpactMode::Reflection => super::groups::answer_in_groups(recipe, state, work, ledger),
    }
}

/// One contact after the other; whether it approaches is asked when its turn comes.
fn answer_in_order(recipe: &Recipe<'_>, state: &mut State, work: &mut Work, ledger: &mut Ledger) {
    if super::bounces::is_all(recipe) {
        return work.bounces.answer(&mut state.lines, work.contacts.blocks(), &mut work.counters);
    }
    let contacts = work.contacts.take_ordered();
    let mut pairs = PairSurfaces::new(recipe.model);
    for contact in &contacts.list {
        answer_one(recipe, state, work, ledger, (contact, &contacts.points), &mut pairs);
    }
    settle_piles(recipe, state, work, ledger, &contacts, &mut pairs);
    work.contacts.give_back(contacts);
}

/// What presses on an inelastic contact comes through its neighbours, which may be answered after it: its pair is asked
/// again, without restitution because it has bounced in this step already, up and down the order, until all of a pile knows
/// that it lies on something. Every such impulse takes energy away. Elastic contacts are answered once a step.
fn settle_piles(
    recipe: &Recipe<'_>,
    state: &mut State,
    work: &mut Work,
    ledger: &mut Ledger,
    contacts: &ContactList,
    pairs: &mut PairSurfaces<'_>,
) {
    if work.accelerations.is_empty() {
        return;
    }
    let inelastic: Vec<&Contact> = contacts.list.iter().filter(|c| pairs.of(c).restitution < 1.0).collect();
    let count = inelastic.len();
    for sweep in 0..SWEEPS {
        let mut answered = false;
        for i in 0..count {
            let contact = inelastic[if sweep % 2 == 0 { count - 1 - i } else { i }];
            let still = STILL * resting_speed(recipe.dt, &work.accelerations, contact);
            let surface = PairSurface { restitution: 0.0, ..pairs.of(contact) };
            let found = encounter(recipe, state, &work.accelerations, contact, surface);
            if let Some(found) = found.filter(|e| e.approach() > still) {
                answer_found(recipe, state, work, ledger, (contact, &contacts.points), &found);
                answered = true;
            }
        }
        if !answered {
            break;
        }
    }
}

/// Answers one contact with the law of its pair.
pub(super) fn answer_one(
    recipe: &Recipe<'_>,
    state: &mut State,
    work: &mut Work,
    ledger: &mut Ledger,
    (contact, points): (&Contact, &[Vec3]),
    pairs: &mut PairSurfaces<'_>,
) {
    let surface = pairs.of(contact);
    if surface.is_smooth_bounce(recipe) {
        return bounce_smooth(recipe, state, work, contact);
    }
    let Some(found) = encounter(recipe, state, &work.accelerations, contact, surface) else { return };
    answer_found(recipe, state, work, ledger, (contact, points), &found);
}

/// Answers an approach: as an area at rest, or as an impact.
fn answer_found(
    recipe: &Recipe<'_>,
    state: &mut State,
    work: &mut Work,
    ledger: &mut Ledger,
    (contact, points): (&Contact, &[Vec3]),
    found: &Encounter,
) {
    let smooth = found.friction == 0.0 && recipe.law.is_frictionless_at_zero();
    if found.restitution == 0.0 && (smooth || recipe.law.is_dry_friction()) && contact.point_count > 1 {
        return settle_area(recipe, state, work, ledger, (contact, points), found);
    }
    respond(recipe, state, work, ledger, contact, found);
}

/// A contact area without restitution is answered at all its corners at once, so that the pressure finds its place in the
/// area: a block on an incline neither tips nor creeps.
fn settle_area(
    recipe: &Recipe<'_>,
    state: &mut State,
    work: &mut Work,
    ledger: &mut Ledger,
    (contact, points): (&Contact, &[Vec3]),
    found: &Encounter,
) {
    let points = manifold(contact, points);
    let center_b = match contact.b {
        Other::Body(slot) => state.lines[slot as usize].x,
        Other::Wall(_) => contact.point,
    };
    let centers = [state.lines[contact.a as usize].x, center_b];
    let Some(response) = super::area::settle(found, points, centers) else { return };
    work.nothing_spins = false;
    let (mut sum, mut moment_arm) = (Vec3::ZERO, Vec3::ZERO);
    for (&point, &impulse) in points.iter().zip(&response.impulses) {
        push(state, &Contact { point, ..*contact }, impulse);
        sum += impulse;
        moment_arm += point * impulse.dot(contact.normal);
    }
    count(work, contact);
    ledger.friction += response.friction_change;
    ledger.restitution += response.restitution_change;
    if recipe.record_events {
        let along = sum.dot(contact.normal);
        work.events.push(StepEvent {
            a: contact.a,
            b: contact.b,
            point: if along < 0.0 { moment_arm / along } else { contact.point },
            normal: contact.normal,
            impulse_n: -along,
            impulse_t: (sum - contact.normal * along).length(),
            energy_change: response.friction_change + response.restitution_change,
        });
    }
}

/// Answers an impact with the law.
fn respond(
    recipe: &Recipe<'_>,
    state: &mut State,
    work: &mut Work,
    ledger: &mut Ledger,
    contact: &Contact,
    encounter: &Encounter,
) {
    let Some(response) = super::sequential::respond(encounter, recipe.law) else { return };
    work.nothing_spins = false;
    push(state, contact, response.impulse_on_a);
    count(work, contact);
    work.counters.fallbacks += u64::from(response.fallback);
    ledger.friction += response.friction_change;
    ledger.restitution += response.restitution_change;
    if recipe.record_events {
        work.events.push(StepEvent {
            a: contact.a,
            b: contact.b,
            point: contact.point,
            normal: contact.normal,
            impulse_n: response.impulse_n,
            impulse_t: response.impulse_t,
            energy_change: response.energy_change,
        });
    }
}

/// Counts an impact.
pub(super) fn count(work: &mut Work, contact: &Contact) {
    work.counters.impacts += 1;
    work.counters.wall_impacts += u64::from(matches!(contact.b, Other::Wall(_)));
}

/// Elastic impact of two spheres, or of a sphere and what never moves, without friction.
fn bounce_smooth(recipe: &Recipe<'_>, state: &mut State, work: &mut Work, contact: &Contact) {
    let n = contact.normal;
    let a = state.lines[contact.a as usize];
    let b = match contact.b {
        Other::Body(slot) => Some(state.lines[slot as usize]),
        Other::Wall(_) => None,
    };
    let Some(Bounce { va, vb, j }) = bounce(&a, b.as_ref(), n) else { return };
    state.lines[contact.a as usize].v = va;
    if let Other::Body(slot) = contact.b {
        state.lines[slot as usize].v = vb;
    }
    count(work, contact);
    if recipe.record_events {
        let v_b = b.map_or(Vec3::ZERO, |b| b.v);
        let energy_change = 0.5 * j * ((a.v - v_b) + (va - vb)).dot(n);
        let (a, b, point) = (contact.a, contact.b, contact.point);
        work.events.push(StepEvent { a, b, point, normal: n, impulse_n: -j, impulse_t: 0.0, energy_change });
    }
}

/// An elastic impact without friction of two spheres.
pub(super) struct Bounce {
    /// velocities after it \[m/s\]
    pub va: Vec3,
    pub vb: Vec3,
    /// impulse on a along the normal \[Ns\]
    pub j: Real,
}

/// The impulse goes through both centres, so only velocities change. dp1 = -2 (v12 . n) / (1/m1 + 1/m2) n, equations (54),
/// (55). Without b: against what never moves. `None`: they do not approach, neither can move, or the answer is not finite.
#[inline]
pub(super) fn bounce(a: &Line, b: Option<&Line>, n: Vec3) -> Option<Bounce> {
    let (v_b, w_b) = b.map_or((Vec3::ZERO, 0.0), |b| (b.v, b.inverse_mass));
    let approach = (a.v - v_b).dot(n);
    let weight = a.inverse_mass + w_b;
    if !(approach > 0.0) || weight == 0.0 {
        return None;
    }
    let j = -2.0 * approach / weight;
    let (va, vb) = (a.v + n * (j * a.inverse_mass), v_b - n * (j * w_b));
    (va.is_finite() && vb.is_finite()).then_some(Bounce { va, vb, j })
}

/// Gives a the impulse and b the opposite, both at the contact point.
pub(super) fn push(state: &mut State, contact: &Contact, impulse: Vec3) {
    push_body(state, contact.a, contact.point, impulse);
    if let Other::Body(b) = contact.b {
        push_body(state, b, contact.point, -impulse);
    }
}

fn push_body(state: &mut State, slot: u32, point: Vec3, impulse: Vec3) {
    let line = &mut state.lines[slot as usize];
    if line.inverse_mass > 0.0 {
        line.v += impulse * line.inverse_mass;
        state.spins[slot as usize].l += (point - line.x).cross(impulse);
    }
}

/// What the law is told of a contact; `None` where nothing can respond.
pub(super) fn encounter(
    recipe: &Recipe<'_>,
    state: &State,
    accelerations: &[Vec3],
    contact: &Contact,
    surface: PairSurface,
) -> Option<Encounter> {
    let a = party(recipe.model, state, contact.a, contact.point);
    let b = match contact.b {
        Other::Body(slot) => party(recipe.model, state, slot, contact.point),
        Other::Wall(_) => Party::IMMOVABLE,
    };
    let mut encounter = Encounter {
        a,
        b,
        normal: contact.normal,
        friction: surface.friction,
        restitution: surface.restitution,
        persistent: recipe.law.needs_contact_memory() && state.contacts.holds(contact.key),
    };
    let approach = encounter.approach();
    if !(approach > 0.0) {
        return None;
    }
    if surface.restitution < 1.0 && approach <= resting_speed(recipe.dt, accelerations, contact) {
        encounter.restitution = 0.0;
    }
    Some(encounter)
}

/// The approach speed up to which a contact is at rest \[m/s\].
///
/// Inside a pile two neighbours are accelerated alike; what presses them together is that others hold one of them back, and
/// that turns the pull of the fields into any direction. So the larger acceleration counts, wherever it points.
pub(crate) fn resting_speed(dt: Real, accelerations: &[Vec3], contact: &Contact) -> Real {
    let of = |slot: u32| accelerations.get(slot as usize).map_or(0.0, |a| a.length());
    let b = match contact.b {
        Other::Body(slot) => of(slot),
        Other::Wall(_) => 0.0,
    };
    RESTING_STEPS * max(of(contact.a), b) * dt
}

fn party(model: &Model, state: &State, slot: u32, point: Vec3) -> Party {
    let i = slot as usize;
    let (body, line, spin) = (model.body(i), &state.lines[i], &state.spins[i]);
    if line.inverse_mass == 0.0 {
        return Party::IMMOVABLE;
    }
    Party {
        mass: body.mass,
        inverse_mass: line.inverse_mass,
        inverse_inertia: body.inertia.inverse_world(spin.q),
        v: line.v,
        w: body.inertia.angular_velocity(spin.q, spin.l),
        angular_momentum: spin.l,
        r: point - line.x,
    }
}

/// Surface values of a pair.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PairSurface {
    pub friction: Real,
    pub restitution: Real,
    /// both are spheres, or a sphere and a boundary: without friction no torque can act
    pub spheres: bool,
}

impl PairSurface {
    /// Whether contacts of the pair are answered by [`bounce`].
    pub fn is_smooth_bounce(&self, recipe: &Recipe<'_>) -> bool {
        self.friction == 0.0 && recipe.law.is_frictionless_at_zero() && self.spheres && self.restitution == 1.0
    }
}

/// Whether no pair can have a restitution below 1: every rule of combination makes 1 of two ones.
pub(crate) fn all_is_elastic(model: &Model) -> bool {
    model
        .types
        .iter()
        .map(|t| &t.surface)
        .chain(model.boundaries.iter().map(|b| &b.surface))
        .all(|s| s.restitution == 1.0)
}

/// Surface values of pairs of types; consecutive contacts mostly ask for the same.
pub(crate) struct PairSurfaces<'a> {
    model: &'a Model,
    last: Option<((u32, u32), PairSurface)>,
}

/// Marks a boundary among type numbers.
const WALL: u32 = 1 << 31;

impl<'a> PairSurfaces<'a> {
    pub fn new(model: &'a Model) -> Self {
        PairSurfaces { model, last: None }
    }

    pub fn of(&mut self, contact: &Contact) -> PairSurface {
        let type_a = self.model.type_of[contact.a as usize];
        let key_b = match contact.b {
            Other::Body(slot) => self.model.type_of[slot as usize],
            Other::Wall(index) => index | WALL,
        };
        if let Some((key, surface)) = self.last
            && key == (type_a, key_b)
        {
            return surface;
        }
        let surface = self.compute(type_a, key_b);
        self.last = Some(((type_a, key_b), surface));
        surface
    }

    fn compute(&self, type_a: u32, key_b: u32) -> PairSurface {
        let a: &BodyType = &self.model.types[type_a as usize];
        let (b_surface, b_sphere) = if key_b & WALL != 0 {
            (self.model.boundaries[(key_b ^ WALL) as usize].surface, true)
        } else {
            let b = &self.model.types[key_b as usize];
            (b.surface, b.is_plain_sphere())
        };
        let friction = a.surface.friction_combine.of_pair(b_surface.friction_combine);
        let restitution = a.surface.restitution_combine.of_pair(b_surface.restitution_combine);
        let friction = friction.apply(a.surface.friction, b_surface.friction);
        PairSurface {
            friction,
            restitution: restitution.apply(a.surface.restitution, b_surface.restitution),
            spheres: a.is_plain_sphere() && b_sphere,
        }
    }
}
