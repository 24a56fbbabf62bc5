//! The contacts of a group as columns of one matrix: `u = G^T v`, `A = G^T M^-1 G` (Delassus's operator).

use super::cone::Cone;
use super::reflection::{GroupBody, GroupContact};
use crate::math::{Real, Vec3};

/// One body's part in a contact's column.
#[derive(Clone, Copy)]
struct Side {
    /// the body
    body: usize,
    /// impulse on it per unit of normal impulse, turned round: the gradient of the approach speed
    linear: Vec3,
    /// the same for its angular momentum \[m\]
    angular: Vec3,
    /// lever arm \[m\]
    reach: Real,
}

/// A contact as a column of G. What never moves has no side.
pub(super) struct Column {
    sides: [Option<Side>; 2],
    /// approach speed that the second party's own, prescribed motion takes off \[m/s\]
    offset: Real,
    /// size of that motion, for round-off \[m/s\]
    offset_size: Real,
    /// A_kk \[1/kg\]
    pub diagonal: Real,
}

impl Column {
    /// The column of a contact.
    pub fn new(contact: &GroupContact, bodies: &[GroupBody]) -> Column {
        let side = |body: usize, n: Vec3, r: Vec3| {
            let movable = bodies[body].is_movable();
            movable.then(|| Side { body, linear: n, angular: r.cross(n), reach: r.length() })
        };
        let a = side(contact.a, contact.normal, contact.ra);
        let b = contact.b.and_then(|b| side(b, -contact.normal, contact.rb));
        let mut column = Column {
            sides: [a, b],
            offset: contact.normal.dot(contact.wall_velocity),
            offset_size: contact.wall_velocity.length(),
            diagonal: 0.0,
        };
        // Only an immovable second party has a motion of its own.
        if contact.b.is_some() {
            (column.offset, column.offset_size) = (0.0, 0.0);
        }
        column.diagonal = column.coupling(&column, bodies);
        column
    }

    /// The movable bodies that it touches.
    pub fn bodies(&self) -> impl Iterator<Item = usize> + '_ {
        self.sides.iter().flatten().map(|s| s.body)
    }

    /// Approach speed, and what is round-off in it \[m/s\].
    pub fn approach(&self, bodies: &[GroupBody]) -> (Real, Real) {
        let (mut u, mut size) = (0.0, 0.0);
        for s in self.sides.iter().flatten() {
            let b = &bodies[s.body];
            u += s.linear.dot(b.v) + s.angular.dot(b.w);
            size += b.v.length() + b.w.length() * s.reach;
        }
        (u - self.offset, super::ROUND_OFF * (size + self.offset_size))
    }

    /// A_kl: approach speed that one unit of impulse at `other` takes off here \[1/kg\].
    fn coupling(&self, other: &Column, bodies: &[GroupBody]) -> Real {
        let mut sum = 0.0;
        for s in self.sides.iter().flatten() {
            for o in other.sides.iter().flatten().filter(|o| o.body == s.body) {
                let b = &bodies[s.body];
                sum += b.inverse_mass * s.linear.dot(o.linear) + s.angular.dot(b.inverse_inertia * o.angular);
            }
        }
        sum
    }

    /// Adds the impulse `x` (per unit of which `linear`, `angular`) to the bodies' sums.
    fn scatter(&self, x: Real, impulses: &mut [[Vec3; 2]]) {
        for s in self.sides.iter().flatten() {
            impulses[s.body][0] += s.linear * x;
            impulses[s.body][1] += s.angular * x;
        }
    }
}

/// Fills the dense problem of some columns.
pub(super) fn assemble(
    cone: &mut Cone,
    columns: &[Column],
    members: &[usize],
    approach: &[Real],
    bodies: &[GroupBody],
) {
    let n = members.len();
    cone.reset(n);
    for (i, &k) in members.iter().enumerate() {
        cone.b[i] = approach[k];
        cone.a[i * n + i] = columns[k].diagonal;
        for (j, &l) in members.iter().enumerate().take(i) {
            let coupling = columns[k].coupling(&columns[l], bodies);
            cone.a[i * n + j] = coupling;
            cone.a[j * n + i] = coupling;
        }
    }
    cone.work += (n * n) as u64 * 4;
}

/// `M^-1 G x` on the touched bodies: the change of velocity that the impulses x take off.
pub(super) struct Direction {
    /// sums of impulses (linear, angular) by body; zero between uses
    impulses: Vec<[Vec3; 2]>,
    /// the touched bodies, ascending, each once
    touched: Vec<usize>,
}

impl Direction {
    /// For this many bodies.
    pub fn new(bodies: usize) -> Direction {
        Direction { impulses: vec![[Vec3::ZERO; 2]; bodies], touched: Vec::new() }
    }

    /// Gathers the impulses of some columns; returns `|M^-1 G x|^2` in the kinetic metric \[J\], from the very numbers that
    /// [`Direction::apply`] uses.
    pub fn gather(&mut self, columns: &[Column], members: &[usize], x: &[Real], bodies: &[GroupBody]) -> Real {
        self.touched.clear();
        for (&k, &x) in members.iter().zip(x) {
            columns[k].scatter(x, &mut self.impulses);
            self.touched.extend(columns[k].bodies());
        }
        self.touched.sort_unstable();
        self.touched.dedup();
        let one = |&k: &usize| {
            let [p, l] = self.impulses[k];
            bodies[k].inverse_mass * p.dot(p) + l.dot(bodies[k].inverse_inertia * l)
        };
        self.touched.iter().map(one).sum()
    }

    /// Takes `c` times the change off the velocities of the bodies gathered last, and clears the sums.
    pub fn apply(&mut self, c: Real, bodies: &mut [GroupBody]) {
        for &k in &self.touched {
            let [p, l] = std::mem::take(&mut self.impulses[k]);
            let b = &mut bodies[k];
            b.v -= p * (c * b.inverse_mass);
            b.w -= (b.inverse_inertia * l) * c;
        }
    }

    /// Clears the sums of the bodies gathered last.
    pub fn clear(&mut self) {
        for &k in &self.touched {
            self.impulses[k] = [Vec3::ZERO; 2];
        }
    }
}

/// The same problem as [`Cone`]'s for groups too large for a dense matrix: sweeps of projected Gauss-Seidel, forward and
/// backward, accelerated as nonlinear conjugate gradients (Silcowitz, Niebe and Erleben, Vriphys 2009), matrix-free. Ends when
/// a sweep changes nothing to `1e-12` of the approach speeds in the kinetic metric, or when `limit` multiplications are spent.
/// Returns what was spent. A loose answer costs symmetry, never energy.
pub(super) fn sweep(
    columns: &[Column],
    members: &[usize],
    approach: &[Real],
    bodies: &[GroupBody],
    x: &mut Vec<Real>,
    limit: u64,
) -> u64 {
    const ENOUGH: Real = 1e-12;
    let n = members.len();
    let mut change = vec![[Vec3::ZERO; 2]; bodies.len()];
    x.clear();
    x.resize(n, 0.0);
    let mut momentum = vec![0.0; n];
    let mut before = vec![0.0; n];
    let mut last_norm: Real = 0.0;
    let mut spent = 0;
    let add = |change: &mut [[Vec3; 2]], k: usize, dx: Real| {
        for s in columns[k].sides.iter().flatten() {
            let b = &bodies[s.body];
            change[s.body][0] += s.linear * (dx * b.inverse_mass);
            change[s.body][1] += (b.inverse_inertia * s.angular) * dx;
        }
    };
    let start: Real = members.iter().map(|&k| approach[k] * approach[k] / columns[k].diagonal).sum();
    while spent < limit {
        before.copy_from_slice(x);
        for step in 0..2 * n {
            let i = if step < n { step } else { 2 * n - 1 - step };
            let c = &columns[members[i]];
            let mut r = approach[members[i]];
            for s in c.sides.iter().flatten() {
                r -= s.linear.dot(change[s.body][0]) + s.angular.dot(change[s.body][1]);
            }
            let new = crate::math::max(0.0, x[i] + r / c.diagonal);
            add(&mut change, members[i], new - x[i]);
            x[i] = new;
        }
        spent += 120 * n as u64;
        let norm: Real = (0..n).map(|i| (x[i] - before[i]) * (x[i] - before[i]) * columns[members[i]].diagonal).sum();
        if !(norm > ENOUGH * ENOUGH * start) {
            break;
        }
        let beta = if last_norm > 0.0 { norm / last_norm } else { 2.0 };
        for i in 0..n {
            let step = x[i] - before[i];
            if beta > 1.0 {
                momentum[i] = step;
                continue;
            }
            let new = crate::math::max(0.0, x[i] + beta * momentum[i]);
            momentum[i] = beta * momentum[i] + step;
            add(&mut change, members[i], new - x[i]);
            x[i] = new;
        }
        last_norm = norm;
    }
    spent
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Mat3;

    /// Both solvers on one problem: a sheet of touching balls, all squeezed, with a corner contact given twice.
    #[test]
    fn sweeps_find_what_the_factors_find() {
        let n = 9;
        let mut seed = 1u64;
        let mut next = || {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (seed >> 11) as Real / (1u64 << 53) as Real
        };
        let mut bodies = Vec::new();
        let mut contacts = Vec::new();
        for i in 0..n * n {
            let x = Vec3::new((i % n) as Real - 4.0, (i / n) as Real - 4.0, 0.0);
            let inertia = Mat3::diagonal(Vec3::splat(2.5));
            let v = Vec3::new(next(), next(), next()) - x * 0.3;
            bodies.push(GroupBody { inverse_mass: 0.1 + next(), inverse_inertia: inertia, v, w: Vec3::X * next() });
            let contact = |b: usize, n: Vec3| GroupContact {
                a: i,
                b: Some(b),
                normal: n,
                ra: n,
                rb: -n,
                restitution: 1.0,
                wall_velocity: Vec3::ZERO,
            };
            if i % n + 1 < n {
                contacts.push(contact(i + 1, Vec3::X));
            }
            if i / n + 1 < n {
                contacts.push(contact(i + n, Vec3::Y));
            }
        }
        contacts.push(contacts[0]);
        let columns: Vec<Column> = contacts.iter().map(|c| Column::new(c, &bodies)).collect();
        let approach: Vec<Real> = columns.iter().map(|c| c.approach(&bodies).0).collect();
        let members: Vec<usize> = (0..contacts.len()).collect();
        let mut cone = Cone::default();
        assemble(&mut cone, &columns, &members, &approach, &bodies);
        cone.solve();
        assert!(cone.gap() < 1e-12);
        let mut x = Vec::new();
        let spent = sweep(&columns, &members, &approach, &bodies, &mut x, 1 << 30);
        assert!(spent < 1 << 26, "{spent}");
        let velocities = |x: &[Real]| {
            let mut after = bodies.clone();
            let mut direction = Direction::new(bodies.len());
            direction.gather(&columns, &members, x, &bodies);
            direction.apply(1.0, &mut after);
            after
        };
        for (a, b) in velocities(&x).iter().zip(&velocities(&cone.x)) {
            assert!((a.v - b.v).length() < 1e-11 && (a.w - b.w).length() < 1e-11, "{a:?} {b:?}");
        }
    }
}
