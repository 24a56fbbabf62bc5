//! All cells of the scene's box, with a counting sort in two stages that any number of threads can share: blocks of bodies
//! are dealt out to slabs (runs of consecutive cells), then each slab sorts what it was dealt by cell. Both are stable, so
//! the order is that of one plain counting sort whatever the blocks and slabs are.

use super::cells::Frame;
use super::lanes::{self, Points};
use super::{Found, run};
use crate::bounds::{Aabb, Ball};
use crate::broad::{BoundsView, Cell};
use crate::math::Vec3;
use crate::par;
use rayon::prelude::*;
use std::ops::Range;

/// How a sort is cut into parts. The result does not depend on it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Parts {
    /// bodies in a block
    pub block: usize,
    /// bodies in a slab, about
    pub slab: usize,
}

impl Parts {
    /// Parts of so many bodies: small enough for the cache of a core together with their cells, and enough of them for some
    /// threads; but few bodies make a single slab, which is sorted without being dealt out.
    pub fn of(count: usize) -> Parts {
        const LARGEST: usize = 4096;
        let few = count < 2 * LARGEST;
        let size = if few { 2 * LARGEST } else { (count / 32).clamp(LARGEST / 4, LARGEST) };
        Parts { block: size, slab: size }
    }
}

/// Bodies sorted by cell, x running fastest.
#[derive(Clone, Debug, Default)]
pub(super) struct Dense {
    frame: Frame,
    /// cells along x and along x times y, with a border of empty cells round the box so that no neighbour is out of range
    stride: [usize; 2],
    /// for each cell, the place of its first body; two more at the end
    start: Vec<u32>,
    /// slots in sorted order
    slots: Vec<u32>,
    /// cells in sorted order
    cells: Vec<u32>,
    /// centres in sorted order, rounded
    points: Points,
    /// where blocks of bodies are dealt out to slabs
    dealt: Vec<Dealt>,
}

/// A block of bodies, dealt out to slabs.
#[derive(Clone, Debug, Default)]
struct Dealt {
    /// cell of each body, in the order in which they came
    cell_of: Vec<u32>,
    /// bodies, slab by slab; unused where there is one slab
    entries: Vec<Entry>,
    /// where each slab ends in `entries`
    ends: Vec<u32>,
}

/// A body on its way to its cell.
#[derive(Clone, Copy, Debug, Default)]
struct Entry {
    cell: u32,
    slot: u32,
    /// see [`Frame::rounded`]
    point: [f32; 3],
}

/// What dealing reads.
struct Dealer<'a> {
    frame: Frame,
    stride: [u32; 2],
    members: Option<&'a [u32]>,
    balls: &'a [Ball],
    /// slabs of `1 << shift` cells
    shift: u32,
    slabs: usize,
    /// bodies in a block
    block: usize,
}

impl Dealer<'_> {
    #[inline(always)]
    fn slot(&self, k: usize) -> u32 {
        self.members.map_or(k as u32, |m| m[k])
    }

    #[inline(always)]
    fn cell(&self, k: usize) -> u32 {
        let [x, y, z] = self.frame.inside(self.balls[self.slot(k) as usize].center);
        x + y * self.stride[0] + z * self.stride[1]
    }

    #[inline(always)]
    fn entry(&self, k: usize, cell: u32) -> Entry {
        let slot = self.slot(k);
        Entry { cell, slot, point: self.frame.rounded(self.balls[slot as usize].center) }
    }
}

impl Dealt {
    /// The bodies of a slab.
    fn of_slab(&self, slab: usize) -> &[Entry] {
        let first = if slab == 0 { 0 } else { self.ends[slab - 1] as usize };
        &self.entries[first..self.ends[slab] as usize]
    }

    /// Deals out the bodies of a range.
    fn deal(&mut self, dealer: &Dealer<'_>, range: Range<usize>) {
        self.cell_of.clear();
        self.cell_of.extend(range.clone().map(|k| dealer.cell(k)));
        if dealer.slabs == 1 {
            return;
        }
        self.entries.resize(range.len(), Entry::default());
        self.ends.clear();
        self.ends.resize(dealer.slabs, 0);
        for &cell in &self.cell_of {
            self.ends[(cell >> dealer.shift) as usize] += 1;
        }
        let mut sum = 0;
        for end in &mut self.ends {
            sum += std::mem::replace(end, sum);
        }
        // What was the start of each slab moves on to its end.
        for (k, &cell) in range.zip(&self.cell_of) {
            let place = &mut self.ends[(cell >> dealer.shift) as usize];
            self.entries[*place as usize] = dealer.entry(k, cell);
            *place += 1;
        }
    }
}

/// What a slab writes: its part of everything that is sorted.
struct Slab<'a> {
    first_cell: u32,
    first_place: u32,
    /// starts of the cells after each of its own
    start: &'a mut [u32],
    slots: &'a mut [u32],
    cells: &'a mut [u32],
    points: [&'a mut [f32]; 3],
}

impl Slab<'_> {
    /// Counting sort. `start[c]` counts the bodies of cell c; summed up, it is where cell c starts, and moves on as bodies of
    /// cell c find their places, so that at last it is where the next cell starts.
    fn sort(self, in_cells: impl Iterator<Item = u32>, entries: impl Iterator<Item = Entry>) {
        let Slab { first_cell, first_place, start, slots, cells, points: [x, y, z] } = self;
        // All of one length: one check for all.
        let n = slots.len();
        let (cells, x, y, z) = (&mut cells[..n], &mut x[..n], &mut y[..n], &mut z[..n]);
        start.fill(0);
        in_cells.for_each(|cell| start[(cell - first_cell) as usize] += 1);
        let mut sum = first_place;
        for s in start.iter_mut() {
            sum += std::mem::replace(s, sum);
        }
        entries.for_each(|e| {
            let place = &mut start[(e.cell - first_cell) as usize];
            let at = (*place - first_place) as usize;
            *place += 1;
            slots[at] = e.slot;
            cells[at] = e.cell;
            [x[at], y[at], z[at]] = e.point;
        });
    }
}

impl Dense {
    pub fn len(&self) -> usize {
        self.slots.len()
    }

    /// Slots in sorted order.
    pub fn slots(&self) -> &[u32] {
        &self.slots
    }

    pub fn rebuild(&mut self, frame: Frame, members: Option<&[u32]>, balls: &[Ball], parts: Parts) {
        self.frame = frame;
        let [nx, ny, nz] = frame.count.map(|c| c as usize + 2);
        self.stride = [nx, nx * ny];
        let (total, count) = (nx * ny * nz, members.map_or(balls.len(), <[u32]>::len));
        let cells_per_slab = total.div_ceil((count / parts.slab).max(1)).next_power_of_two();
        let shift = cells_per_slab.trailing_zeros();
        let slabs = total.div_ceil(cells_per_slab);
        let stride = self.stride.map(|s| s as u32);
        let dealer = Dealer { frame, stride, members, balls, shift, slabs, block: parts.block };
        let blocks = par::ranges_into(count, parts.block, &mut self.dealt, |range, dealt| dealt.deal(&dealer, range));
        self.start.resize(total + 2, 0);
        self.slots.resize(count, 0);
        self.cells.resize(count, 0);
        self.points.resize(count);
        self.start[0] = 0;
        self.start[total + 1] = count as u32;
        self.sort_slabs(&dealer, blocks, total);
    }

    /// Sorts every slab, each into its own part of the arrays.
    fn sort_slabs(&mut self, dealer: &Dealer<'_>, blocks: usize, total: usize) {
        let dealt = &self.dealt[..blocks];
        let mut start = &mut self.start[1..=total];
        if dealer.slabs == 1 {
            let points = self.points.axes();
            let task =
                Slab { first_cell: 0, first_place: 0, start, slots: &mut self.slots, cells: &mut self.cells, points };
            let in_cells = dealt.iter().flat_map(|block| block.cell_of.iter().copied());
            let entries = dealt.iter().enumerate().flat_map(|(b, block)| {
                let first = b * dealer.block;
                block.cell_of.iter().enumerate().map(move |(k, &cell)| dealer.entry(first + k, cell))
            });
            return task.sort(in_cells, entries);
        }
        let (mut slots, mut cells, mut points) = (&mut self.slots[..], &mut self.cells[..], self.points.axes());
        let (cells_per_slab, mut first_place) = (1 << dealer.shift, 0);
        let of_slab = |slab: usize| {
            let first_cell = slab * cells_per_slab;
            let count = dealt.iter().map(|block| block.of_slab(slab).len()).sum::<usize>();
            let task = Slab {
                first_cell: first_cell as u32,
                first_place: first_place as u32,
                start: par::cut(&mut start, cells_per_slab.min(total - first_cell)),
                slots: par::cut(&mut slots, count),
                cells: par::cut(&mut cells, count),
                points: points.each_mut().map(|axis| par::cut(axis, count)),
            };
            first_place += count;
            task
        };
        let tasks: Vec<Slab<'_>> = (0..dealer.slabs).map(of_slab).collect();
        tasks.into_par_iter().enumerate().for_each(|(slab, task)| {
            let in_cells = dealt.iter().flat_map(|block| block.of_slab(slab).iter().map(|e| e.cell));
            task.sort(in_cells, dealt.iter().flat_map(|block| block.of_slab(slab).iter().copied()));
        });
    }

    /// Pairs whose first body is one of the sorted `first..last`: the rest of its cell and the cell after it, and the three
    /// cells of each of the four rows after its own.
    pub fn scan(&self, first: usize, last: usize, view: &BoundsView<'_>, found: &mut Found) {
        if view.fixed.is_empty() {
            return self.scan_moving(first, last, view, found);
        }
        for i in first..last {
            let slot = self.slots[i];
            let ball = view.balls[slot as usize];
            for (from, to) in self.runs(i) {
                run((slot, &ball), self.others(from as usize, to as usize, view), view, found);
            }
        }
    }

    /// The five runs of places that hold the later partners of a body.
    #[inline(always)]
    fn runs(&self, i: usize) -> [(u32, u32); 5] {
        lanes::runs(&self.start, self.stride, i, self.cells[i] as usize)
    }

    /// The scan where every body can move. Rounded centres are compared first, many at a time; the few pairs that may meet
    /// are then asked exactly.
    fn scan_moving(&self, first: usize, last: usize, view: &BoundsView<'_>, found: &mut Found) {
        let grid = lanes::Grid {
            start: &self.start,
            stride: self.stride,
            cells: &self.cells,
            points: &self.points,
            limit: self.frame.limit(),
        };
        let mut near = std::mem::take(&mut found.near);
        near.clear();
        found.tests += lanes::scan(&grid, first, last, &mut near);
        for &[i, k] in &near {
            let (a, b) = (self.slots[i as usize], self.slots[k as usize]);
            if view.balls[a as usize].meets(&view.balls[b as usize]) {
                found.pairs.push([a, b]);
            }
        }
        found.near = near;
    }

    /// The bodies of a run of places.
    #[inline(always)]
    fn others<'a>(
        &'a self,
        from: usize,
        to: usize,
        view: &'a BoundsView<'_>,
    ) -> impl ExactSizeIterator<Item = (u32, &'a Ball)> {
        self.slots[from..to].iter().map(|&slot| (slot, &view.balls[slot as usize]))
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
                run((slot, ball), self.others(from, to, view), view, found);
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

#[cfg(test)]
mod tests;
