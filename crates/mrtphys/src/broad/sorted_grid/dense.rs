//! All cells of the scene's box, with a counting sort that any number of threads can share: every block of bodies counts how many
//! of its own are in each cell, sums over cells and blocks give each block its first place in each cell, and there it puts its
//! bodies. Blocks come in their order within a cell, so the order is that of one plain counting sort whatever the blocks are.
//! Where the storage is in spatial order, a block is in few of the cells, and counts only those.

use super::blocks::{Block, CellRange, Cells, Parts, Placing};
use super::cells::Frame;
use super::lanes::{self, Points};
use super::survey::{Clear, Seen};
use super::{Extent, Found, run};
use crate::bounds::{Aabb, Ball};
use crate::broad::{BoundsView, Candidates, Cell};
use crate::cache::prefetch;
use crate::math::Vec3;
use crate::par;
use rayon::prelude::*;
use std::ops::Range;

/// Pairs by which the exact test asks ahead for their bounding spheres.
const AHEAD: usize = 16;

/// Bodies sorted by cell, x running fastest.
#[derive(Clone, Debug, Default)]
pub(super) struct Dense {
    frame: Frame,
    /// cells along x and along x times y, with empty cells between the rows and after the last so that no neighbour is out of
    /// range
    stride: [usize; 2],
    /// for each cell, the place of its first body; one more at the end
    start: Vec<u32>,
    /// slots in sorted order
    slots: Vec<u32>,
    /// cells in sorted order
    cells: Vec<u32>,
    /// centres in sorted order, rounded
    points: Points,
    /// bodies on their way
    blocks: Vec<Block>,
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
        let count = members.map_or(balls.len(), <[u32]>::len);
        self.resize(frame, count);
        let placing = self.placing(members, balls, parts);
        let place = |range: Range<usize>, block: &mut Block| block.place(&placing, range, None);
        let blocks = par::ranges_into(count, parts.block, &mut self.blocks, place);
        self.sort(&placing, blocks);
    }

    /// Surveys all bodies and sorts them into the cells of a frame that was made before they moved. Returns their extent, and
    /// whether they are in its cells; the survey holds in any case.
    pub fn survey_and_rebuild(
        &mut self,
        frame: Frame,
        view: &BoundsView<'_>,
        parts: Parts,
        out: &mut Candidates,
    ) -> (Option<Extent>, bool) {
        let (count, clear) = (view.balls.len(), Clear::of(view.boundaries));
        self.resize(frame, count);
        let placing = self.placing(None, view.balls, parts);
        let place = |range: Range<usize>, block: &mut Block| block.place(&placing, range, Some((&clear, view)));
        let blocks = par::ranges_into(count, parts.block, &mut self.blocks, place);
        let extent = Seen::report(self.blocks[..blocks].iter().map(|block| &block.seen), out);
        let holds = extent.as_ref().is_some_and(|e| e.count == count && e.is_one_level() && frame.holds(e));
        if holds {
            self.sort(&placing, blocks);
        }
        (extent, holds)
    }

    fn resize(&mut self, frame: Frame, count: usize) {
        self.frame = frame;
        let [nx, ny, nz] = frame.count.map(|c| c as usize);
        let row = nx + 1;
        self.stride = [row, row * (ny + 1)];
        // The last neighbour of the last cell, and the cell after it.
        let cells = nz * self.stride[1] + (ny + 1) * row + nx + 2;
        self.start.resize(cells + 1, 0);
        self.slots.resize(count, 0);
        self.cells.resize(count, 0);
        self.points.resize(count);
        self.start[0] = 0;
    }

    fn placing<'a>(&self, members: Option<&'a [u32]>, balls: &'a [Ball], parts: Parts) -> Placing<'a> {
        let total = self.start.len() - 1;
        let ranges = self.slots.len().div_ceil(parts.block).max(1);
        let ranges = parts.widest.map(|widest| (total.div_ceil(ranges), widest));
        Placing { cells: Cells::new(self.frame, self.stride), members, balls, ranges }
    }

    fn sort(&mut self, placing: &Placing<'_>, blocks: usize) {
        match placing.ranges {
            Some((range, _)) if !self.blocks[..blocks].iter().any(|block| block.scattered) => {
                self.sort_apart(range, blocks)
            }
            _ => self.sort_at_once(blocks),
        }
    }

    /// With one count for all. `start[c + 1]` counts the bodies of cell c; summed up, it is where cell c starts, and moves on as
    /// bodies of cell c find their places, so that at last it is where the next cell starts.
    fn sort_at_once(&mut self, blocks: usize) {
        let (blocks, start) = (&self.blocks[..blocks], &mut self.start[1..]);
        // All of one length: one check for all.
        let n = self.slots.len();
        let [xy, z] = self.points.axes();
        let (slots, cells, xy, z) = (&mut self.slots[..n], &mut self.cells[..n], &mut xy[..n], &mut z[..n]);
        start.fill(0);
        for block in blocks {
            block.came.iter().for_each(|e| start[e.cell as usize] += 1);
        }
        let mut sum = 0;
        for s in start.iter_mut() {
            sum += std::mem::replace(s, sum);
        }
        for e in blocks.iter().flat_map(|block| &block.came) {
            let place = &mut start[e.cell as usize];
            let at = *place as usize;
            *place += 1;
            slots[at] = e.slot;
            cells[at] = e.cell;
            xy[at] = e.xy;
            z[at] = e.z;
        }
    }

    /// With the counts that the blocks have made, in ranges of so many cells.
    fn sort_apart(&mut self, range: usize, blocks: usize) {
        let blocks = &mut self.blocks[..blocks];
        let total = self.start.len() - 1;
        self.start[total] = self.slots.len() as u32;
        let mut first_place = 0;
        let starts = self.start[..total].chunks_mut(range).enumerate();
        let mut ranges: Vec<CellRange<'_>> = starts
            .map(|(k, start)| {
                let task = CellRange { first_place, start, counts: Vec::new() };
                first_place += blocks.iter().map(|b| b.in_range.get(k).copied().unwrap_or(0)).sum::<u32>();
                task
            })
            .collect();
        for block in blocks.iter_mut() {
            let (mut rest, mut next) = (&mut block.counts[..], block.low as usize);
            while !rest.is_empty() {
                let length = (range - next % range).min(rest.len());
                let here = par::cut(&mut rest, length);
                ranges[next / range].counts.push((next % range, here));
                next += length;
            }
        }
        ranges.into_par_iter().for_each(CellRange::sum_up);
        let [xy, z] = self.points.axes();
        let arrays = [&mut self.slots[..], &mut self.cells[..], xy, z].map(par::as_atomic);
        blocks.par_iter_mut().for_each(|block| block.put(arrays));
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
            limit: Frame::limit(),
        };
        let mut near = std::mem::take(&mut found.near);
        near.clear();
        found.tests += lanes::scan(&grid, first, last, &mut near);
        for (n, &[i, k]) in near.iter().enumerate() {
            if let Some(next) = near.get(n + AHEAD) {
                next.iter().for_each(|&place| prefetch(&view.balls[self.slots[place as usize] as usize]));
            }
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
        // Cells that hold bodies are 0..n; a body outside by more than a cell meets none of them.
        let range = |axis: usize| {
            let (c, n) = (at[axis] - self.frame.first[axis], self.frame.count[axis]);
            (c - 1).max(0)..(c + 2).min(n)
        };
        let (x, y, z) = (range(0), range(1), range(2));
        if x.is_empty() {
            return;
        }
        for z in z {
            for y in y.clone() {
                let cell = |x: i64| x as usize + 1 + (y as usize + 1) * self.stride[0] + z as usize * self.stride[1];
                let (from, to) = (self.start[cell(x.start)], self.start[cell(x.end)]);
                run((slot, ball), self.others(from as usize, to as usize, view), view, found);
            }
        }
    }

    pub fn cells(&self, depth: u32, out: &mut Vec<Cell>) {
        let [sx, sxy] = self.stride;
        for c in 0..self.start.len().saturating_sub(1) {
            let objects = self.start[c + 1] - self.start[c];
            if objects > 0 {
                let min = self.frame.corner([(c % sx) as i64 - 1, (c % sxy / sx) as i64 - 1, (c / sxy) as i64]);
                let bounds = Aabb { min, max: min + Vec3::splat(self.frame.edge) };
                out.push(Cell { bounds, depth, objects });
            }
        }
    }
}

#[cfg(test)]
mod tests;
