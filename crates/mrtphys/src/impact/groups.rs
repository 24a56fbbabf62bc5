//! Simultaneous impacts: contacts that hang together through bodies that can move are answered at once.

use super::answer::{PairSurfaces, answer_one, count, encounter};
use super::reflection::{BUDGET, Group, GroupBody, GroupContact, reflect};
use crate::contact::collect::manifold;
use crate::contact::{Contact, Other};
use crate::event::StepEvent;
use crate::ledger::Ledger;
use crate::math::{Real, Vec3};
use crate::state::State;
use crate::step::Recipe;
use crate::work::Work;

/// Answers the contacts of the step group by group. A group with a single contact point is answered by the impact law like
/// any other impact; a larger one by generalized reflections, which are frictionless.
pub(super) fn answer_in_groups(recipe: &Recipe<'_>, state: &mut State, work: &mut Work, ledger: &mut Ledger) {
    let contacts = work.contacts.take_ordered();
    let mut pairs = PairSurfaces::new(recipe.model);
    for group in groups(recipe, state, &contacts.list) {
        let points: usize = group.iter().map(|&c| manifold(&contacts.list[c], &contacts.points).len()).sum();
        if points == 1 {
            let only = (&contacts.list[group[0]], &contacts.points[..]);
            answer_one(recipe, state, work, ledger, only, &mut pairs);
        } else {
            let chosen: Vec<&Contact> = group.iter().map(|&c| &contacts.list[c]).collect();
            reflect_group(recipe, state, work, ledger, (&chosen, &contacts.points), &mut pairs);
        }
    }
    work.contacts.give_back(contacts);
}

/// Contacts by group, groups and contacts in order of response. Fixed bodies and boundaries connect nothing.
fn groups(recipe: &Recipe<'_>, state: &State, contacts: &[Contact]) -> Vec<Vec<usize>> {
    let mut roots = Roots { parent: (0..state.lines.len() as u32).collect() };
    let fixed = &recipe.model.fixed;
    let moving = |c: &Contact| match c.b {
        Other::Body(b) if !fixed[b as usize] => Some(b),
        _ => None,
    };
    for c in contacts {
        if let Some(b) = moving(c)
            && !fixed[c.a as usize]
        {
            roots.join(c.a, b);
        }
    }
    let mut group_of = vec![u32::MAX; state.lines.len()];
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for (i, c) in contacts.iter().enumerate() {
        let mover = if fixed[c.a as usize] { moving(c) } else { Some(c.a) };
        let Some(mover) = mover else { continue };
        let root = roots.find(mover) as usize;
        if group_of[root] == u32::MAX {
            group_of[root] = groups.len() as u32;
            groups.push(Vec::new());
        }
        groups[group_of[root] as usize].push(i);
    }
    groups
}

/// Union-find whose roots are the smallest slots.
struct Roots {
    parent: Vec<u32>,
}

impl Roots {
    fn find(&mut self, mut i: u32) -> u32 {
        while self.parent[i as usize] != i {
            self.parent[i as usize] = self.parent[self.parent[i as usize] as usize];
            i = self.parent[i as usize];
        }
        i
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.find(a), self.find(b));
        self.parent[a.max(b) as usize] = a.min(b);
    }
}

fn reflect_group(
    recipe: &Recipe<'_>,
    state: &mut State,
    work: &mut Work,
    ledger: &mut Ledger,
    (contacts, points): (&[&Contact], &[Vec3]),
    pairs: &mut PairSurfaces<'_>,
) {
    let mut table = Members::default();
    let mut rows: Vec<(usize, Vec3)> = Vec::new();
    let mut entries = Vec::new();
    for (index, contact) in contacts.iter().enumerate() {
        let surface = pairs.of(contact);
        for &point in manifold(contact, points) {
            let at_point = Contact { point, ..**contact };
            // The encounter is asked for the restitution only: whether the contact is at rest.
            let restitution = encounter(recipe, state, &work.accelerations, &at_point, surface)
                .map_or(surface.restitution, |e| e.restitution);
            let a = table.member(recipe, state, contact.a);
            let b = match contact.b {
                Other::Body(slot) => Some(table.member(recipe, state, slot)),
                Other::Wall(_) => None,
            };
            let ra = point - table.position(state, a);
            let rb = b.map_or(Vec3::ZERO, |m| point - table.position(state, m));
            let (normal, wall_velocity) = (contact.normal, Vec3::ZERO);
            entries.push(GroupContact { a, b, normal, ra, rb, restitution, wall_velocity });
            rows.push((index, point));
        }
    }
    let before = table.bodies.clone();
    work.nothing_spins = false;
    let outcome = reflect(Group { bodies: &mut table.bodies, contacts: &entries }, BUDGET);
    work.counters.undecided += u64::from(!outcome.decided);
    if outcome.rounds == 0 {
        return;
    }
    for (member, &slot) in table.slots.iter().enumerate() {
        state.lines[slot as usize].v = table.bodies[member].v;
    }
    for ((&(index, point), entry), &size) in rows.iter().zip(&entries).zip(&outcome.impulses) {
        if size == 0.0 {
            continue;
        }
        let contact = contacts[index];
        count(work, contact);
        let impulse = contact.normal * -size;
        turn(state, &table, Some(entry.a), entry.ra, impulse);
        turn(state, &table, entry.b, entry.rb, -impulse);
        let energy_change = -size * contact.normal.dot(mean_relative_velocity(&before, &table.bodies, entry));
        ledger.restitution += energy_change;
        if recipe.record_events {
            let (a, b, normal) = (contact.a, contact.b, contact.normal);
            let event = StepEvent { a, b, point, normal, impulse_n: size, impulse_t: 0.0, energy_change };
            work.events.push(event);
        }
    }
}

/// Angular momentum is the state; the group works with angular velocities.
fn turn(state: &mut State, table: &Members, member: Option<usize>, arm: Vec3, impulse: Vec3) {
    if let Some(m) = member
        && table.bodies[m].is_movable()
    {
        state.spins[table.slots[m] as usize].l += arm.cross(impulse);
    }
}

/// Mean of the relative velocity of the contact point before and after: times the impulse, exactly the change of energy.
fn mean_relative_velocity(before: &[GroupBody], after: &[GroupBody], c: &GroupContact) -> Vec3 {
    let at =
        |bodies: &[GroupBody], m: Option<usize>, r: Vec3| m.map_or(Vec3::ZERO, |m| bodies[m].v + bodies[m].w.cross(r));
    let of = |bodies: &[GroupBody]| at(bodies, Some(c.a), c.ra) - at(bodies, c.b, c.rb);
    (of(before) + of(after)) * (0.5 as Real)
}

/// The bodies of a group; those of infinite mass take part with zero inverse mass.
#[derive(Default)]
struct Members {
    slots: Vec<u32>,
    bodies: Vec<GroupBody>,
}

impl Members {
    fn member(&mut self, recipe: &Recipe<'_>, state: &State, slot: u32) -> usize {
        let i = slot as usize;
        if let Some(m) = self.slots.iter().position(|&s| s == slot) {
            return m;
        }
        let (line, spin, inertia) = (&state.lines[i], &state.spins[i], &recipe.model.body(i).inertia);
        self.slots.push(slot);
        self.bodies.push(GroupBody {
            inverse_mass: line.inverse_mass,
            inverse_inertia: inertia.inverse_world(spin.q),
            v: line.v,
            w: inertia.angular_velocity(spin.q, spin.l),
        });
        self.slots.len() - 1
    }

    fn position(&self, state: &State, member: usize) -> Vec3 {
        state.lines[self.slots[member] as usize].x
    }
}
