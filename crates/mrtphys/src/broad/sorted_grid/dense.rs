//! All cells of the scene's box, with a counting sort.

use super::cells::Frame;
use super::{Found, run};
use crate::bounds::{Aabb, Ball};
use crate::broad::{BoundsView, Cell};
use crate::math::Vec3;

/// Bodies sorted by cell, x running fastest.
#[derive(Clone, Debug, Default)]
pub(super) struct Dense {
    frame: Frame,
    /// cells along x and along x times y, with a border of empty cells round the box so that no neighbour is out of range
    stride: [usize; 2],
    /// for each cell, the place of its first body; two more at the end
    start: Vec<u32>,
    /// cell of each body, in the order in which they came
    cell_of: Vec<u32>,
    /// bounding spheres in sorted order
    balls: Vec<Ball>,
    /// slots in sorted order
    slots: Vec<u32>,
    /// cells in sorted order
    cells: Vec<u32>,
}

impl Dense {
    pub fn len(&self) -> usize {
        self.slots.len()
    }

    /// Slots in sorted order.
    pub fn slots(&self) -> &[u32] {
        &self.slots
    }

    pub fn rebuild(&mut self, frame: Frame, members: Option<&[u32]>, balls: &[Ball]) {
        self.frame = frame;
        let [nx, ny, nz] = frame.count.map(|c| c as usize + 2);
        self.stride = [nx, nx * ny];
        self.start.clear();
        self.start.resize(nx * ny * nz + 2, 0);
        match members {
            None => self.sort(balls.len(), |k| k as u32, balls),
            Some(m) => self.sort(m.len(), |k| m[k], balls),
        }
    }

    /// Counting sort. `start[c + 2]` counts the bodies of cell c; summed up, `start[c + 1]` is where cell c starts, and moves
    /// on as bodies of cell c find their places, so that at last `start[c]` is where cell c starts.
    fn sort(&mut self, count: usize, slot: impl Fn(usize) -> u32, balls: &[Ball]) {
        let frame = self.frame;
        let [sx, sxy] = self.stride;
        self.cell_of.clear();
        self.cell_of.extend((0..count).map(|k| {
            let [x, y, z] = frame.inside(balls[slot(k) as usize].center);
            let c = (x + 1) as usize + (y + 1) as usize * sx + (z + 1) as usize * sxy;
            self.start[c + 2] += 1;
            c as u32
        }));
        let mut sum = 0;
        for s in &mut self.start {
            sum += *s;
            *s = sum;
        }
        self.balls.resize(count, Ball::EMPTY);
        self.slots.resize(count, 0);
        self.cells.resize(count, 0);
        for (k, &c) in self.cell_of.iter().enumerate() {
            let place = &mut self.start[c as usize + 1];
            let at = *place as usize;
            *place += 1;
            self.balls[at] = balls[slot(k) as usize];
            self.slots[at] = slot(k);
            self.cells[at] = c;
        }
    }

    /// Pairs whose first body is one of the sorted `first..last`: the rest of its cell and the cell after it, and the three
    /// cells of each of the four rows after its own.
    pub fn scan(&self, first: usize, last: usize, view: &BoundsView<'_>, found: &mut Found) {
        if view.fixed.is_empty() {
            return self.scan_moving(first, last, found);
        }
        for i in first..last {
            let (slot, ball) = (self.slots[i], self.balls[i]);
            for (from, to) in self.runs(i) {
                run((slot, &ball), self.others(from, to), view, found);
            }
        }
    }

    /// The five runs of places that hold the later partners of a body.
    #[inline(always)]
    fn runs(&self, i: usize) -> [(usize, usize); 5] {
        let [sx, sxy] = self.stride;
        let c = self.cells[i] as usize;
        let row = |r: usize| (self.start[c + r - 1] as usize, self.start[c + r + 2] as usize);
        [(i + 1, self.start[c + 2] as usize), row(sx), row(sxy - sx), row(sxy), row(sxy + sx)]
    }

    /// The scan where every body can move, with hardly a branch that depends on where bodies are: runs are mostly empty or of
    /// one body, and guessing which costs more than writing down two candidates and taking back what was too many.
    fn scan_moving(&self, first: usize, last: usize, found: &mut Found) {
        let mut list = std::mem::take(&mut found.candidates);
        let mut len = 0;
        for i in first..last {
            let runs = self.runs(i);
            let total: usize = runs.iter().map(|(from, to)| to - from).sum();
            if list.len() < len + total + 2 {
                list.resize((len + total + 2).max(2 * list.len()).max(1024), (0, 0));
            }
            for (from, to) in runs {
                list[len] = (i as u32, from as u32);
                list[len + 1] = (i as u32, from as u32 + 1);
                for k in 2..(to - from).max(2) {
                    list[len + k] = (i as u32, (from + k) as u32);
                }
                len += to - from;
            }
        }
        found.tests += len as u64;
        self.filter(&list[..len], found);
        found.candidates = list;
    }

    /// Keeps the candidates that meet: the expression of [`Ball::meets`].
    fn filter(&self, list: &[(u32, u32)], found: &mut Found) {
        let start = found.pairs.len();
        found.pairs.resize(start + list.len(), [0, 0]);
        let (out, mut hits) = (&mut found.pairs[start..], 0);
        for &(i, k) in list {
            let (a, b) = (&self.balls[i as usize], &self.balls[k as usize]);
            let d = a.center - b.center;
            let r = a.radius + b.radius;
            out[hits] = [i, k];
            hits += usize::from(d.length_squared() <= r * r);
        }
        for pair in &mut out[..hits] {
            *pair = pair.map(|place| self.slots[place as usize]);
        }
        found.pairs.truncate(start + hits);
    }

    /// The bodies of a run of places.
    #[inline(always)]
    fn others(&self, from: usize, to: usize) -> impl ExactSizeIterator<Item = (u32, &Ball)> {
        self.slots[from..to].iter().copied().zip(&self.balls[from..to])
    }

    /// Pairs of a body that is not in this grid and no larger than the largest in it.
    pub fn query(&self, slot: u32, view: &BoundsView<'_>, found: &mut Found) {
        let ball = &view.balls[slot as usize];
        let at = self.frame.coordinates(ball.center);
        let [nx, ny, nz] = self.frame.count;
        // Bodies of the grid lie in the cells 0..n; one outside by more than a cell meets none of them.
        if at[0] < -1 || at[1] < -1 || at[2] < -1 || at[0] > nx || at[1] > ny || at[2] > nz {
            return;
        }
        let low = |c: i64| (c - 1).max(0) as usize + 1;
        let high = |c: i64, n: i64| (c + 1).min(n - 1) as usize + 1;
        for z in low(at[2])..=high(at[2], nz) {
            for y in low(at[1])..=high(at[1], ny) {
                let row = y * self.stride[0] + z * self.stride[1];
                let from = self.start[row + low(at[0])] as usize;
                let to = self.start[row + high(at[0], nx) + 1] as usize;
                run((slot, ball), self.others(from, to), view, found);
            }
        }
    }

    pub fn cells(&self, depth: u32, out: &mut Vec<Cell>) {
        let [sx, sxy] = self.stride;
        for c in 0..self.start.len().saturating_sub(2) {
            let objects = self.start[c + 1] - self.start[c];
            if objects > 0 {
                let min = self.frame.corner([(c % sx) as i64 - 1, (c % sxy / sx) as i64 - 1, (c / sxy) as i64 - 1]);
                let bounds = Aabb { min, max: min + Vec3::splat(self.frame.edge) };
                out.push(Cell { bounds, depth, objects });
            }
        }
    }
}
