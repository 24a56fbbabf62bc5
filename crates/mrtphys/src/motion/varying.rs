//! Translation where fields vary from place to place or act on some bodies only. All bodies take each stage of the scheme
//! together, because a field may be carried by one of them.

use super::advance::{Gain, book, is_fine, set_aside};
use super::translation::{Drag, Moved, explicit_euler, parabola, semi_implicit_euler};
use crate::counters::Counters;
use crate::def::Integrator;
use crate::error::Result;
use crate::field::sum::{Fields, Place, Push, moves};
use crate::ledger::Ledger;
use crate::math::{Real, Vec3};
use crate::model::Model;
use crate::state::{Line, State};
use crate::work::Work;

/// Moves every body. A step in which a body is lost is taken anew without it, so that the others do not notice.
pub(super) fn translate(
    model: &Model,
    state: &mut State,
    work: &mut Work,
    drag: &Drag,
    ledger: &mut Ledger,
    counters: &mut Counters,
) -> Result<()> {
    // Each turn sets at least one body aside, so this ends.
    let (end, gains) = loop {
        let fields = Fields::new(model, &state.lines);
        let step = Step { model, fields, lines: &state.lines, drag };
        match step.take()? {
            Attempt::Done(end, gains) => break (end, gains),
            Attempt::Lost(slots) => set_aside(model, state, &slots, ledger, counters),
        }
    };
    for (slot, line) in state.lines.iter_mut().enumerate().filter(|(_, line)| moves(line)) {
        (line.x, line.v) = (end.x[slot], end.v[slot]);
    }
    book(model, &gains, ledger);
    work.accelerations.clear();
    if !model.forces.is_empty() {
        work.accelerations.extend(end.push.iter().map(|push| push.a));
    }
    Ok(())
}

/// How an attempt at a step ended.
enum Attempt {
    /// with everybody somewhere
    Done(End, Vec<Gain>),
    /// with these bodies nowhere
    Lost(Vec<u32>),
}

/// The bodies after the step.
struct End {
    x: Vec<Vec3>,
    v: Vec<Vec3>,
    push: Vec<Push>,
    /// what drag and the fields without potential did on the way \[J\]
    drag: Vec<Real>,
    work: Vec<Real>,
}

struct Step<'a> {
    model: &'a Model,
    fields: Fields<'a>,
    lines: &'a [Line],
    drag: &'a Drag,
}

impl Step<'_> {
    fn take(&self) -> Result<Attempt> {
        let x: Vec<Vec3> = self.lines.iter().map(|l| l.x).collect();
        let v: Vec<Vec3> = self.lines.iter().map(|l| l.v).collect();
        let start = self.place(&x, &v);
        // Classical stages are accurate, and stable, while drag is slow; what is stiffer, the exact exponential takes.
        let smooth = self.drag.rate * self.drag.dt <= 1.0;
        let end = match self.model.settings.integrator {
            Integrator::RungeKutta4 if smooth => self.runge_kutta(&start)?,
            Integrator::RungeKutta4 if self.drag.is_rigid() => self.streamline(&start, true)?,
            Integrator::Parabola | Integrator::RungeKutta4 if self.drag.is_rigid() => self.streamline(&start, false)?,
            Integrator::Parabola | Integrator::RungeKutta4 => self.verlet(&start)?,
            Integrator::ExplicitEuler => self.euler(&start, explicit_euler)?,
            Integrator::SemiImplicitEuler => self.euler(&start, semi_implicit_euler)?,
        };
        let nowhere = |&slot: &usize| moves(&self.lines[slot]) && !is_fine(end.x[slot], end.v[slot]);
        let lost: Vec<u32> = (0..x.len()).filter(nowhere).map(|slot| slot as u32).collect();
        if !lost.is_empty() {
            return Ok(Attempt::Lost(lost));
        }
        let gains = self.gains(&start, &end);
        Ok(Attempt::Done(end, gains))
    }

    fn place<'b>(&'b self, x: &'b [Vec3], v: &'b [Vec3]) -> Place<'b> {
        Place { lines: self.lines, x, v }
    }

    fn push(&self, x: &[Vec3], v: &[Vec3]) -> Result<Vec<Push>> {
        self.fields.push(&self.place(x, v), !self.drag.is_void())
    }

    fn mass(&self, slot: usize) -> Real {
        if moves(&self.lines[slot]) { self.model.body(slot).mass } else { 0.0 }
    }

    /// Velocity Verlet with exact drag: positions with the acceleration and flow at the start, velocities with the means of
    /// start and end. Second order; exact where fields do not vary; symplectic without drag.
    ///
    /// Drag is the loss that the exact motion under those means would have had: dE - m a.dx.
    fn verlet(&self, start: &Place) -> Result<End> {
        let first = self.push(start.x, start.v)?;
        let along = |slot: usize| {
            let (x, v, p) = (start.x[slot], start.v[slot], first[slot]);
            if self.drag.is_void() {
                parabola::<true>(x, v, p.a, p.u, self.drag)
            } else {
                parabola::<false>(x, v, p.a, p.u, self.drag)
            }
        };
        let predicted: Vec<Moved> = (0..start.x.len()).map(along).collect();
        let x: Vec<Vec3> = predicted.iter().map(|m| m.x).collect();
        let v: Vec<Vec3> = predicted.iter().map(|m| m.v).collect();
        let last = self.push(&x, &v)?;
        let mut end = self.end(x, v, last, &first);
        for (slot, p) in first.iter().enumerate() {
            let (q, v) = (end.push[slot], start.v[slot]);
            let (a, u) = ((p.a + q.a) * 0.5, (p.u + q.u) * 0.5);
            let next = if self.drag.is_void() { v + a * self.drag.dt } else { self.drag.velocity(v, a, u) };
            end.v[slot] = next;
            if !self.drag.is_void() {
                let kinetic = 0.5 * (next - v).dot(next + v);
                end.drag[slot] = self.mass(slot) * (kinetic - a.dot(self.drag.way(v, a, u)));
            }
        }
        Ok(end)
    }

    fn euler(&self, start: &Place, scheme: fn(Vec3, Vec3, Vec3, Vec3, &Drag) -> Moved) -> Result<End> {
        let first = self.push(start.x, start.v)?;
        let step = |slot: usize| scheme(start.x[slot], start.v[slot], first[slot].a, first[slot].u, self.drag);
        let moved: Vec<Moved> = (0..start.x.len()).map(step).collect();
        let x: Vec<Vec3> = moved.iter().map(|m| m.x).collect();
        let v: Vec<Vec3> = moved.iter().map(|m| m.v).collect();
        let last = self.push(&x, &v)?;
        let mut end = self.end(x, v, last, &first);
        for (slot, m) in moved.iter().enumerate() {
            end.drag[slot] = 0.5 * self.mass(slot) * (m.v - m.undamped).dot(m.v + m.undamped);
        }
        Ok(end)
    }

    /// An end whose work of fields is the mean power of start and end, times the time: as accurate as a scheme of second
    /// order needs it.
    fn end(&self, x: Vec<Vec3>, v: Vec<Vec3>, push: Vec<Push>, first: &[Push]) -> End {
        let work = first.iter().zip(&push).map(|(p, q)| 0.5 * self.drag.dt * (p.power + q.power)).collect();
        End { drag: vec![0.0; x.len()], work, x, v, push }
    }

    /// The classical scheme; the work of drag and of fields without potential is integrated along with the motion.
    fn runge_kutta(&self, start: &Place) -> Result<End> {
        let (n, dt, k) = (start.x.len(), self.drag.dt, self.drag.rate);
        let (mut x, mut v) = (start.x.to_vec(), start.v.to_vec());
        let (mut dx, mut dv) = (vec![Vec3::ZERO; n], vec![Vec3::ZERO; n]);
        let (mut drag, mut work) = (vec![0.0; n], vec![0.0; n]);
        // Weight of the stage in the mean, and how far the next one lies ahead.
        for (weight, ahead) in [(1.0, 0.5), (2.0, 0.5), (2.0, 1.0), (1.0, 0.0)] {
            let push = self.push(&x, &v)?;
            for slot in (0..n).filter(|&slot| moves(&self.lines[slot])) {
                let resistance = (push[slot].u - v[slot]) * k;
                let (rate, a) = (v[slot], push[slot].a + resistance);
                dx[slot] += rate * weight;
                dv[slot] += a * weight;
                drag[slot] += self.mass(slot) * resistance.dot(rate) * (weight * dt / 6.0);
                work[slot] += push[slot].power * (weight * dt / 6.0);
                x[slot] = start.x[slot] + rate * (ahead * dt);
                v[slot] = start.v[slot] + a * (ahead * dt);
            }
        }
        for slot in 0..n {
            x[slot] = start.x[slot] + dx[slot] * (dt / 6.0);
            v[slot] = start.v[slot] + dv[slot] * (dt / 6.0);
        }
        let push = self.push(&x, &v)?;
        Ok(End { x, v, push, drag, work })
    }

    /// Viscosity 1: bodies go with the flow, x' = u(x), by Heun's scheme or the classical one, and have its velocity.
    fn streamline(&self, start: &Place, classical: bool) -> Result<End> {
        let dt = self.drag.dt;
        let stages: &[(Real, Real)] =
            if classical { &[(1.0, 0.5), (2.0, 0.5), (2.0, 1.0), (1.0, 0.0)] } else { &[(3.0, 1.0), (3.0, 0.0)] };
        let mut x = start.x.to_vec();
        let mut dx = vec![Vec3::ZERO; x.len()];
        let mut first = None;
        for &(weight, ahead) in stages {
            let push = self.push(&x, start.v)?;
            for slot in (0..x.len()).filter(|&slot| moves(&self.lines[slot])) {
                dx[slot] += push[slot].u * weight;
                x[slot] = start.x[slot] + push[slot].u * (ahead * dt);
            }
            first.get_or_insert(push);
        }
        for slot in 0..x.len() {
            x[slot] = start.x[slot] + dx[slot] * (dt / 6.0);
        }
        let push = self.push(&x, start.v)?;
        let v = push.iter().map(|p| p.u).collect();
        Ok(self.end(x, v, push, &first.unwrap_or_default()))
    }

    /// What the step gained in kinetic and potential energy, by cause: what is neither drag nor work of fields without
    /// potential is the scheme's. A rigid medium holds the bodies: there the scheme has nothing to lose.
    fn gains(&self, start: &Place, end: &End) -> Vec<Gain> {
        let before = self.fields.potentials(start);
        let after = self.fields.potentials(&self.place(&end.x, &end.v));
        let of = |slot: usize| {
            if !moves(&self.lines[slot]) {
                return Gain::default();
            }
            let (v, w) = (start.v[slot], end.v[slot]);
            let total = 0.5 * self.mass(slot) * (w - v).dot(w + v) + (after[slot] - before[slot]);
            let rest = total - end.work[slot];
            if self.drag.is_rigid() {
                return Gain { drag: rest, integration: 0.0, fields: end.work[slot] };
            }
            Gain { drag: end.drag[slot], integration: rest - end.drag[slot], fields: end.work[slot] }
        };
        (0..end.x.len()).map(of).collect()
    }
}
