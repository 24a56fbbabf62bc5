//! The inner problem of a generalized reflection: `minimise x.A.x/2 - b.x over x >= 0`, A symmetric and positive semidefinite.
//!
//! Lawson and Hanson's active-set method (Solving Least Squares Problems, 1974, chapter 23) on the normal equations, with a
//! factor L D L^T of the free block that grows row by row. It ends at the exact solution of the free block, so that the
//! optimality gap is round-off. Linearly dependent contacts (four corners of a box on a plane, one contact twice) need no
//! special care in principle: a column in the span of the free ones has no gradient left, so it never enters; what round-off
//! lets through shows up as a vanishing pivot and is passed over. No square roots: powers of two pass through exactly.

use crate::math::Real;

/// A pivot below this fraction of its diagonal entry is round-off: the column depends on the free ones.
const DEPENDENT: Real = 64.0 * Real::EPSILON;

/// A dense problem and what its solution needs; the memory is reused.
#[derive(Default)]
pub(super) struct Cone {
    /// number of unknowns
    n: usize,
    /// A by rows
    pub a: Vec<Real>,
    /// right side
    pub b: Vec<Real>,
    /// the solution
    pub x: Vec<Real>,
    /// indices of the free unknowns, in order of entry
    free: Vec<usize>,
    /// unknowns that may not enter for now
    barred: Vec<bool>,
    /// row k of L, without the unit diagonal, starts at k(k-1)/2
    l: Vec<Real>,
    /// D
    d: Vec<Real>,
    /// solution of the free block
    s: Vec<Real>,
    /// multiplications done since the last reset
    pub work: u64,
}

impl Cone {
    /// Makes room for `n` unknowns; A and b are zero.
    pub fn reset(&mut self, n: usize) {
        self.n = n;
        self.work = 0;
        for (vector, length) in [(&mut self.a, n * n), (&mut self.b, n), (&mut self.x, n)] {
            vector.clear();
            vector.resize(length, 0.0);
        }
        self.free.clear();
        self.l.clear();
        self.d.clear();
        self.barred.clear();
        self.barred.resize(n, false);
    }

    /// Solves for x. Finite by construction: each entry lowers the objective, and their number is capped besides, because
    /// round-off knows no theorems; x is feasible whenever it stops.
    pub fn solve(&mut self) {
        for _ in 0..3 * self.n + 8 {
            let Some(k) = self.steepest() else { return };
            if !self.append(k) {
                self.barred[k] = true;
                continue;
            }
            if !self.descend() {
                return;
            }
        }
    }

    /// Row `k` of the residual b - A x, and the round-off in it.
    fn residual(&self, k: usize) -> (Real, Real) {
        let row = &self.a[k * self.n..(k + 1) * self.n];
        let (mut r, mut size) = (self.b[k], self.b[k].abs());
        for &i in &self.free {
            let t = row[i] * self.x[i];
            r -= t;
            size += t.abs();
        }
        (r, size * Real::EPSILON * 8.0)
    }

    /// The bound unknown whose entry lowers the objective most for a unit step in the metric, r^2/A_kk; the first among equals.
    fn steepest(&mut self) -> Option<usize> {
        let mut best: Option<(usize, Real)> = None;
        for k in 0..self.n {
            let diagonal = self.a[k * self.n + k];
            if self.barred[k] || !(diagonal > 0.0) || self.free.contains(&k) {
                continue;
            }
            let (r, noise) = self.residual(k);
            let gain = r * r / diagonal;
            if r > noise && best.is_none_or(|(_, g)| gain > g) {
                best = Some((k, gain));
            }
        }
        self.work += (self.n * (self.free.len() + 1)) as u64;
        best.map(|(k, _)| k)
    }

    /// Adds `k` to the free block's factor; false, and unchanged, if it depends on the block.
    fn append(&mut self, k: usize) -> bool {
        let m = self.free.len();
        let start = self.l.len();
        let row = k * self.n;
        // Forward substitution: y = L^-1 a_k; the new row of L is y/D, its pivot a_kk - y.y/D.
        for i in 0..m {
            let mut y = self.a[row + self.free[i]];
            let base = i * i.wrapping_sub(1) / 2;
            for j in 0..i {
                y -= self.l[base + j] * self.l[start + j];
            }
            self.l.push(y);
        }
        let mut pivot = self.a[row + k];
        for i in 0..m {
            let y = self.l[start + i];
            let scaled = y / self.d[i];
            pivot -= y * scaled;
            self.l[start + i] = scaled;
        }
        self.work += (m * m / 2 + 2 * m + 1) as u64;
        if !(pivot > DEPENDENT * self.a[row + k]) {
            self.l.truncate(start);
            return false;
        }
        self.d.push(pivot);
        self.free.push(k);
        true
    }

    /// Solves the free block for right side `s`, in place.
    fn substitute(&mut self) {
        let m = self.free.len();
        for i in 0..m {
            let base = i * i.wrapping_sub(1) / 2;
            for j in 0..i {
                self.s[i] -= self.l[base + j] * self.s[j];
            }
        }
        for i in 0..m {
            self.s[i] /= self.d[i];
        }
        for i in (0..m).rev() {
            let base = i * i.wrapping_sub(1) / 2;
            for j in 0..i {
                self.s[j] -= self.l[base + j] * self.s[i];
            }
        }
        self.work += (m * m) as u64;
    }

    /// Solution of the free block into `s`, once refined: the residual of the first solution is solved for again.
    fn solve_free(&mut self) {
        let m = self.free.len();
        self.s.clear();
        self.s.extend(self.free.iter().map(|&k| self.b[k]));
        self.substitute();
        let first = self.s.clone();
        for (s, &k) in self.s.iter_mut().zip(&self.free) {
            let row = &self.a[k * self.n..(k + 1) * self.n];
            *s = self.free.iter().zip(&first).fold(self.b[k], |r, (&l, x)| r - row[l] * x);
        }
        self.work += (m * m) as u64;
        self.substitute();
        for (s, first) in self.s.iter_mut().zip(&first) {
            *s += first;
        }
    }

    /// Moves x to the free block's solution; on the way, unknowns that would turn negative are bound again. False if the
    /// solution is not finite.
    fn descend(&mut self) -> bool {
        loop {
            self.solve_free();
            if !self.s.iter().all(|s| s.is_finite()) {
                return false;
            }
            let mut step = 1.0;
            let mut leaves = usize::MAX;
            for (i, &k) in self.free.iter().enumerate() {
                if self.s[i] <= 0.0 {
                    let x = self.x[k];
                    let t = if x > 0.0 { x / (x - self.s[i]) } else { 0.0 };
                    if leaves == usize::MAX || t < step {
                        (step, leaves) = (t, i);
                    }
                }
            }
            for (i, &k) in self.free.iter().enumerate() {
                let x = self.x[k];
                let moved = if leaves == usize::MAX { self.s[i] } else { x + step * (self.s[i] - x) };
                self.x[k] = if moved > 0.0 { moved } else { 0.0 };
            }
            if leaves == usize::MAX {
                return true;
            }
            self.release(leaves);
            if self.free.is_empty() {
                return true;
            }
        }
    }

    /// Binds the unknown at place `i` of the free block: the factor's rows from there on are made anew.
    fn release(&mut self, i: usize) {
        let gone = self.free[i];
        self.x[gone] = 0.0;
        // A newcomer that leaves at once came in by round-off alone; after another's leaving, what was dependent may be so no more.
        let newcomer = i + 1 == self.free.len();
        self.barred.iter_mut().for_each(|b| *b = false);
        self.barred[gone] = newcomer;
        let rest = self.free.split_off(i);
        self.d.truncate(i);
        self.l.truncate(i * i.wrapping_sub(1) / 2);
        for &k in &rest[1..] {
            if !self.append(k) {
                self.x[k] = 0.0;
            }
        }
    }

    /// Relative duality gap of x, with the infeasibility of the dual counted in full: `sum of |x_k r_k| + max(r_k, 0)^2/A_kk`
    /// over `b.x`.
    #[cfg(test)]
    pub fn gap(&self) -> Real {
        let mut gap = 0.0;
        let mut size = 0.0;
        for k in 0..self.n {
            let (mut r, diagonal) = (self.b[k], self.a[k * self.n + k]);
            for i in 0..self.n {
                r -= self.a[k * self.n + i] * self.x[i];
            }
            gap += (self.x[k] * r).abs();
            if r > 0.0 && diagonal > 0.0 {
                gap += r * r / diagonal;
            }
            size += self.b[k] * self.x[k];
        }
        if size > 0.0 { gap / size } else { gap }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A = G^T G of `n` columns in `rank` dimensions, b = G^T v, pseudo-random.
    fn problem(cone: &mut Cone, n: usize, rank: usize, mut seed: u64) {
        let mut next = || {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (seed >> 11) as Real / (1u64 << 52) as Real - 1.0
        };
        let g: Vec<Real> = (0..n * rank).map(|_| next()).collect();
        let v: Vec<Real> = (0..rank).map(|_| next()).collect();
        cone.reset(n);
        for i in 0..n {
            for j in 0..n {
                cone.a[i * n + j] = (0..rank).map(|k| g[i * rank + k] * g[j * rank + k]).sum();
            }
            cone.b[i] = (0..rank).map(|k| g[i * rank + k] * v[k]).sum();
        }
    }

    #[test]
    fn duality_gap_is_round_off_also_for_dependent_columns() {
        let mut cone = Cone::default();
        for (n, rank) in [(1, 1), (2, 3), (4, 3), (8, 6), (20, 6), (60, 12), (200, 150), (256, 40)] {
            for seed in 0..8 {
                problem(&mut cone, n, rank, seed * 977 + n as u64);
                cone.solve();
                assert!(cone.gap() < 1e-12, "{n} {rank} {seed}: {}", cone.gap());
                assert!(cone.x.iter().all(|&x| x >= 0.0));
            }
        }
    }

    /// A jam whose right side is no velocity's, by a little: with column 2 = -(column 0 + column 1) and b off by 1e-10, the
    /// objective falls for ever along (1, 1, 1). The answer must stay that of the independent columns.
    #[test]
    fn jammed_columns_do_not_blow_up_on_round_off() {
        let mut cone = Cone::default();
        for seed in 0..200 {
            problem(&mut cone, 6, 6, seed);
            let n = cone.n;
            for k in (0..n).filter(|&k| k != 2) {
                let sum = -(cone.a[k * n] + cone.a[k * n + 1]);
                (cone.a[k * n + 2], cone.a[2 * n + k]) = (sum, sum);
            }
            cone.a[2 * n + 2] = -(cone.a[2] + cone.a[n + 2]);
            cone.b[2] = -(cone.b[0] + cone.b[1]) + 1e-10 * (cone.b[0].abs() + cone.b[1].abs());
            cone.solve();
            let largest = cone.x.iter().fold(0.0, |m: Real, &x| crate::math::max(m, x));
            assert!(largest < 1e3, "{seed}: {:?}", cone.x);
        }
    }

    #[test]
    fn one_contact_twice_is_one_contact() {
        let mut cone = Cone::default();
        cone.reset(3);
        cone.a.fill(2.0);
        cone.b.fill(3.0);
        cone.solve();
        assert_eq!(cone.x.iter().sum::<Real>(), 1.5);
    }
}
