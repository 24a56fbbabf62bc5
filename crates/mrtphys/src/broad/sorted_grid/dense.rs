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
    /// for each cell, the place of its first body; one more at the end
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

    pub fn rebuild(&mut self, frame: Frame, members: Option<&[u32]>, balls: &[Ball]) {
        self.frame = frame;
        let [nx, ny, nz] = frame.count.map(|c| c as usize + 2);
        self.stride = [nx, nx * ny];
        self.start.clear();
        self.start.resize(nx * ny * nz + 1, 0);
        match members {
            None => self.sort(balls.len(), |k| k as u32, balls),
            Some(m) => self.sort(m.len(), |k| m[k], balls),
        }
    }

    /// Counting sort. `start[c + 1]` counts the bodies of cell c, then holds the end of cell c - 1 and is moved on as bodies
    /// of cell c find their places, so that at last `start[c]` is where cell c starts.
    fn sort(&mut self, count: usize, slot: impl Fn(usize) -> u32, balls: &[Ball]) {
        let frame = self.frame;
        let [sx, sxy] = self.stride;
        self.cell_of.clear();
        self.cell_of.extend((0..count).map(|k| {
            let [x, y, z] = frame.inside(balls[slot(k) as usize].center);
            ((x + 1) as usize + (y + 1) as usize * sx + (z + 1) as usize * sxy) as u32
        }));
        for &c in &self.cell_of {
            self.start[c as usize] += 1;
        }
        let mut sum = 0;
        for s in &mut self.start {
            sum += std::mem::replace(s, sum);
        }
        self.balls.resize(count, Ball::EMPTY);
        self.slots.resize(count, 0);
        self.cells.resize(count, 0);
        for k in 0..count {
            let c = self.cell_of[k];
            let place = self.start[c as usize] as usize;
            self.start[c as usize] += 1;
            self.balls[place] = balls[slot(k) as usize];
            self.slots[place] = slot(k);
            self.cells[place] = c;
        }
        // Every start has moved to its cell's end, which is the next cell's start.
        self.start.rotate_right(1);
        self.start[0] = 0;
    }

    /// Pairs whose first body is one of the sorted `first..last`: the rest of its cell and the cell after it, and the three
    /// cells of each of the four rows after its own.
    pub fn scan(&self, first: usize, last: usize, view: &BoundsView<'_>, found: &mut Found) {
        let [sx, sxy] = self.stride;
        let rows = [sx, sxy - sx, sxy, sxy + sx];
        for i in first..last {
            let (slot, ball, cell) = (self.slots[i], self.balls[i], self.cells[i] as usize);
            run((slot, &ball), self.others(i + 1, self.start[cell + 2] as usize), view, found);
            for row in rows {
                let from = self.start[cell + row - 1] as usize;
                let to = self.start[cell + row + 2] as usize;
                run((slot, &ball), self.others(from, to), view, found);
            }
        }
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
        for c in 0..self.start.len().saturating_sub(1) {
            let objects = self.start[c + 1] - self.start[c];
            if objects > 0 {
                let min = self.frame.corner([(c % sx) as i64 - 1, (c % sxy / sx) as i64 - 1, (c / sxy) as i64 - 1]);
                let bounds = Aabb { min, max: min + Vec3::splat(self.frame.edge) };
                out.push(Cell { bounds, depth, objects });
            }
        }
    }
}
