//! Simultaneous impacts: generalized reflections (Smith, Kaufman, Vouga, Tamstorf, Grinspun: Reflections on simultaneous
//! impact, ACM Transactions on Graphics 31(4), 106, 2012). They let the far ball of a cradle break away, keep a symmetric
//! break symmetric, conserve energy and momentum, and push only.
//!
//! A round: u = G^T v are the approach speeds, recomputed from the velocities (accumulated in contact space they lose 1e-8 at
//! a mass ratio of 1e8). Of the contacts V that approach, take the impulses that would stop them,
//!
//! `lambda = argmin over lambda >= 0 of |v - M^-1 G lambda|` in the kinetic metric,
//!
//! and reflect the velocities along d = M^-1 G lambda:
//!
//! `v' = v - c d`, `c = 2 lambda.u / (d.M d)`.
//!
//! For c = 2 lambda.u/|d|^2 this is a reflection in a hyperplane, an isometry of the kinetic metric for *any* d: energy is
//! exact to round-off even where lambda is not. Rounds go on until no contact approaches. They end after finitely many
//! wherever the velocities have a direction in which all contacts separate (Vouga et al., Phil. Trans. R. Soc. A 2017).
//!
//! What is added here:
//! - **Parts.** Contacts of V that share no movable body are answered as parts of their own; they commute.
//! - **Restitution.** The 2 becomes 1 + e. Where a part's contacts differ, e is their mean weighted by lambda_k u_k: it lies
//!   between them, and the energy changes by `-(1 - e^2)/2 (lambda.u)^2/|d|^2`, never upwards. A contact of e = 0 that rests
//!   joins the inner problem, so that a part of such contacts is stopped in one round (Moreau's impact law).
//! - **Inelastic collapse.** With e < 1, rounds may follow each other for ever while the approach dies out. After
//!   [`PATIENCE`] rounds per contact, contacts with e < 1 are answered with the limit of that sequence: e = 0, all at once.
//! - **Jams.** A ball wedged between two fixed walls without a gap has no direction in which all contacts separate: it would
//!   rattle for ever. When rounds drag on, the contacts that took part are searched for a positive combination of columns that
//!   vanishes (by Gordan's theorem the only obstacle). Those contacts are frozen: their velocities stay as the last reflection
//!   left them, everything else is carried on. Energy is conserved, and the group counts as undecided.

use super::cone::Cone;
use super::delassus::{Column, Direction, assemble, sweep};
use crate::math::{Mat3, Real, Vec3};

/// A body of a group.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroupBody {
    /// 1/mass \[1/kg\]; 0: it never moves
    pub inverse_mass: Real,
    /// inverse inertia tensor, world axes \[1/(kg m2)\]; zero for what never turns
    pub inverse_inertia: Mat3,
    /// velocity of the centre of mass \[m/s\]
    pub v: Vec3,
    /// angular velocity \[rad/s\]
    pub w: Vec3,
}

impl GroupBody {
    /// Whether an impulse changes its motion.
    #[inline]
    pub fn is_movable(&self) -> bool {
        self.inverse_mass > 0.0 || self.inverse_inertia != Mat3::ZERO
    }
}

/// A contact of a group.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroupContact {
    /// the first body
    pub a: usize,
    /// the second; `None`: something immovable
    pub b: Option<usize>,
    /// unit normal from a to b
    pub normal: Vec3,
    /// from a's centre of mass to the contact point \[m\]
    pub ra: Vec3,
    /// from b's centre of mass to the contact point \[m\]; without meaning where b is `None`
    pub rb: Vec3,
    /// the pair's coefficient of restitution, 0 to 1
    pub restitution: Real,
    /// velocity of the immovable party at the contact point \[m/s\]; without meaning where b is a body
    pub wall_velocity: Vec3,
}

/// Bodies and the contacts that hang together through them. Immovable bodies' velocities are taken as zero.
#[derive(Debug)]
pub struct Group<'a> {
    /// the bodies, whose velocities are changed
    pub bodies: &'a mut [GroupBody],
    /// the contacts; the order matters only to the last bits
    pub contacts: &'a [GroupContact],
}

/// How a group was answered.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outcome {
    /// rounds that were needed
    pub rounds: u64,
    /// whether no contact approaches any more. If not, the velocities are those that the last round left: each round by itself
    /// conserves energy and momentum
    pub decided: bool,
    /// normal impulse of each contact \[Ns\], never negative: a received `-impulse * normal`
    pub impulses: Vec<Real>,
    /// contacts that were frozen, because nothing can separate all of them
    pub jammed: usize,
}

/// The budget of the design: contact answers per group.
pub const BUDGET: u64 = 1_000_000;

/// Rounds per contact after which rounds count as dragging on.
pub const PATIENCE: u64 = 8;

/// Multiplications per unit of budget that the inner problems may cost together. Up to a dozen contacts cost less than that.
const WORK_PER_ANSWER: u64 = 1000;

/// Largest inner problem that is solved by factors of a dense matrix.
const DENSE_LIMIT: usize = 256;

/// Answers all contacts of a group at once. `budget`: contact answers, see [`BUDGET`]; the rounds end after
/// `budget / number of contacts`. A group with a number that is not finite is left as it was, undecided.
///
/// # Panics
/// If a contact names a body that is not there.
pub fn reflect(group: Group<'_>, budget: u64) -> Outcome {
    let Group { bodies, contacts } = group;
    let mut rounds = Rounds::new(bodies, contacts, budget);
    let before: Vec<GroupBody> = bodies.to_vec();
    let limit = (budget / (contacts.len() as u64).max(1)).max(1);
    let patience = PATIENCE * contacts.len() as u64 + 64;
    let mut next_search = patience;
    loop {
        rounds.look(bodies);
        if rounds.overflow {
            break;
        }
        if rounds.active.is_empty() {
            rounds.outcome.decided = rounds.outcome.jammed == 0 || !rounds.frozen_approach(bodies);
            break;
        }
        if rounds.outcome.rounds >= limit || rounds.work_left == 0 {
            break;
        }
        if rounds.outcome.rounds >= next_search {
            rounds.search_jam(bodies);
            next_search *= 2;
            rounds.outcome.rounds += 1;
            continue;
        }
        rounds.collapse = rounds.outcome.rounds >= patience;
        rounds.answer(bodies);
        rounds.outcome.rounds += 1;
    }
    let finite = |b: &GroupBody| b.v.is_finite() && b.w.is_finite();
    if rounds.overflow || !bodies.iter().all(finite) || !rounds.outcome.impulses.iter().all(|j| j.is_finite()) {
        bodies.copy_from_slice(&before);
        return Outcome { impulses: vec![0.0; contacts.len()], ..Outcome::default() };
    }
    rounds.outcome
}

/// The state of the rounds.
struct Rounds<'a> {
    contacts: &'a [GroupContact],
    columns: Vec<Column>,
    outcome: Outcome,
    /// multiplications left
    work_left: u64,
    /// a number is not finite
    overflow: bool,
    /// contacts with e < 1 are answered as e = 0
    collapse: bool,
    /// approach speed of each contact in this round
    approach: Vec<Real>,
    /// contacts that approach
    active: Vec<usize>,
    /// contacts of e = 0 that rest and join those that approach
    resting: Vec<usize>,
    /// contacts that are not answered any more
    frozen: Vec<bool>,
    /// contacts that were answered since the last search for jams
    answered: Vec<bool>,
    /// forest of bodies that hang together in this round
    parent: Vec<usize>,
    /// the change of velocity of the part in hand
    direction: Direction,
    cone: Cone,
}

impl<'a> Rounds<'a> {
    fn new(bodies: &[GroupBody], contacts: &'a [GroupContact], budget: u64) -> Rounds<'a> {
        let n = contacts.len();
        Rounds {
            contacts,
            columns: contacts.iter().map(|c| Column::new(c, bodies)).collect(),
            outcome: Outcome { impulses: vec![0.0; n], ..Outcome::default() },
            work_left: budget.saturating_mul(WORK_PER_ANSWER),
            overflow: false,
            collapse: false,
            approach: vec![0.0; n],
            active: Vec::new(),
            resting: Vec::new(),
            frozen: vec![false; n],
            answered: vec![false; n],
            parent: (0..bodies.len()).collect(),
            direction: Direction::new(bodies.len()),
            cone: Cone::default(),
        }
    }

    /// Sees which contacts approach.
    fn look(&mut self, bodies: &[GroupBody]) {
        self.active.clear();
        self.resting.clear();
        for (k, column) in self.columns.iter().enumerate() {
            if self.frozen[k] || !(column.diagonal > 0.0) {
                continue;
            }
            let (u, noise) = column.approach(bodies);
            self.approach[k] = u;
            self.overflow |= !(u.is_finite() && noise.is_finite());
            let e = self.contacts[k].restitution;
            if u > noise {
                self.active.push(k);
            } else if (e == 0.0 && u >= -noise) || (self.collapse && e < 1.0) {
                self.resting.push(k);
            }
        }
    }

    /// Whether a contact that was frozen approaches.
    fn frozen_approach(&self, bodies: &[GroupBody]) -> bool {
        self.columns.iter().zip(&self.frozen).any(|(column, &frozen)| {
            let (u, noise) = column.approach(bodies);
            frozen && u > noise
        })
    }

    /// Root of a body's tree.
    fn root(&mut self, mut body: usize) -> usize {
        while self.parent[body] != body {
            self.parent[body] = self.parent[self.parent[body]];
            body = self.parent[body];
        }
        body
    }

    /// The parts of this round: lists of contacts, ascending, those that rest included; ordered by their first contact.
    fn parts(&mut self) -> Vec<Vec<usize>> {
        let mut members: Vec<usize> = self.active.iter().chain(&self.resting).copied().collect();
        members.sort_unstable();
        for &k in &members {
            for body in self.columns[k].bodies() {
                self.parent[body] = body;
            }
        }
        for &k in &members {
            let mut ends = self.columns[k].bodies();
            if let (Some(a), Some(b)) = (ends.next(), ends.next()) {
                drop(ends);
                let (a, b) = (self.root(a), self.root(b));
                let (low, high) = if a < b { (a, b) } else { (b, a) };
                self.parent[high] = low;
            }
        }
        let mut labelled: Vec<(usize, usize)> = Vec::with_capacity(members.len());
        for &k in &members {
            let first = self.columns[k].bodies().next();
            if let Some(body) = first {
                labelled.push((self.root(body), k));
            }
        }
        labelled.sort_unstable();
        let mut parts: Vec<Vec<usize>> =
            labelled.chunk_by(|a, b| a.0 == b.0).map(|part| part.iter().map(|&(_, k)| k).collect()).collect();
        parts.retain(|part: &Vec<usize>| part.iter().any(|k| self.active.binary_search(k).is_ok()));
        parts
    }

    /// One round.
    fn answer(&mut self, bodies: &mut [GroupBody]) {
        if let [k] = self.active[..]
            && self.resting.is_empty()
        {
            self.answer_part(&[k], bodies);
            return;
        }
        for part in self.parts() {
            self.answer_part(&part, bodies);
        }
    }

    /// Reflects the velocities of one part.
    fn answer_part(&mut self, members: &[usize], bodies: &mut [GroupBody]) {
        let mut x = std::mem::take(&mut self.cone.x);
        if let [k] = *members {
            x.clear();
            x.push(self.approach[k] / self.columns[k].diagonal);
            self.work_left = self.work_left.saturating_sub(1);
        } else if members.len() <= DENSE_LIMIT {
            self.cone.x = x;
            assemble(&mut self.cone, &self.columns, members, &self.approach, bodies);
            self.cone.solve();
            x = std::mem::take(&mut self.cone.x);
            self.work_left = self.work_left.saturating_sub(self.cone.work);
        } else {
            // A tenth of what is left each time: a loose first answer leaves room to go on.
            let spent = sweep(&self.columns, members, &self.approach, bodies, &mut x, self.work_left / 10);
            self.work_left = self.work_left.saturating_sub(spent.max(1));
        }
        let square = self.direction.gather(&self.columns, members, &x, bodies);
        let gain: Real = members.iter().zip(&x).map(|(&k, x)| x * self.approach[k]).sum();
        // At the inner problem's solution the quotient is 1; where it underflows, only that is left to say.
        let quotient = if square > Real::MIN_POSITIVE { gain / square } else { 1.0 };
        let c = (1.0 + self.restitution(members, &x)) * quotient;
        self.overflow |= !c.is_finite();
        let c = if c.is_finite() && c > 0.0 { c } else { 0.0 };
        self.direction.apply(c, bodies);
        for (&k, x) in members.iter().zip(&x) {
            self.outcome.impulses[k] += c * x;
            self.answered[k] |= *x > 0.0;
        }
        self.cone.x = x;
    }

    /// The part's restitution: the contacts' own where they agree, else their mean weighted by lambda_k u_k.
    fn restitution(&self, members: &[usize], x: &[Real]) -> Real {
        let own = |k: usize| self.contacts[k].restitution;
        if self.collapse && members.iter().any(|&k| own(k) < 1.0) {
            return 0.0;
        }
        let (mut sum, mut weights) = (0.0, 0.0);
        let (mut least, mut most): (Real, Real) = (1.0, 0.0);
        for (&k, x) in members.iter().zip(x) {
            let weight = x * self.approach[k];
            if weight > 0.0 {
                sum += weight * own(k);
                weights += weight;
                least = crate::math::min(least, own(k));
                most = crate::math::max(most, own(k));
            }
        }
        if !(weights > 0.0) {
            // Everything underflowed: the least of them is safe.
            return members.iter().fold(1.0, |e, &k| crate::math::min(e, own(k)));
        }
        if least >= most { most } else { (sum / weights).clamp(least, most) }
    }

    /// Looks for contacts that cannot all separate, among the elastic ones answered lately, and freezes them.
    ///
    /// The point of least length in the convex hull of the columns (scaled to unit length) is zero iff some non-negative
    /// combination vanishes. It is `argmin |G y|^2 + (sum y - 1)^2 over y >= 0`, up to its length: the inner problem again.
    fn search_jam(&mut self, bodies: &[GroupBody]) {
        let answered = std::mem::replace(&mut self.answered, vec![false; self.contacts.len()]);
        let members: Vec<usize> = (0..answered.len()).filter(|&k| answered[k] && !self.frozen[k]).collect();
        let n = members.len();
        if !(2..=DENSE_LIMIT).contains(&n) {
            return;
        }
        assemble(&mut self.cone, &self.columns, &members, &self.approach, bodies);
        // Relative to the largest diagonal, so that nothing here depends on the unit of mass.
        let largest = members.iter().fold(0.0, |m, &k| crate::math::max(m, self.columns[k].diagonal));
        let scale: Vec<Real> = members.iter().map(|&k| (self.columns[k].diagonal / largest).sqrt()).collect();
        for i in 0..n {
            for j in 0..n {
                let a = &mut self.cone.a[i * n + j];
                *a = *a / largest / (scale[i] * scale[j]) + 1.0;
            }
            self.cone.b[i] = 1.0;
        }
        self.cone.solve();
        self.work_left = self.work_left.saturating_sub(self.cone.work);
        let y: Vec<Real> = self.cone.x.iter().zip(&scale).map(|(y, s)| y / s).collect();
        let total: Real = self.cone.x.iter().sum();
        let square = self.direction.gather(&self.columns, &members, &y, bodies) / largest;
        self.direction.clear();
        // The hull's distance from zero, against the round-off of a sum of n unit columns.
        let tolerance = super::ROUND_OFF * 8.0 * n as Real * total;
        if square <= tolerance * tolerance {
            for (&k, &y) in members.iter().zip(&y) {
                if y > 0.0 {
                    self.frozen[k] = true;
                    self.outcome.jammed += 1;
                }
            }
        }
    }
}
