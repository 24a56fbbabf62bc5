//! All cells of the scene's box, with a counting sort that any number of threads can share: every block of bodies counts how many
//! of its own are in each cell, sums over cells and blocks give each block its first place in each cell, and there it puts its
//! bodies. Blocks come in their order within a cell, so the order is that of one plain counting sort whatever the blocks are.
//! Where the storage is in spatial order, a block is in few of the cells, and counts only those.

use super::cells::{Frame, cell_of};
use super::lanes::{self, Points};
use super::survey::{Clear, Seen};
use super::{Extent, Found, run};
use crate::bounds::{Aabb, Ball};
use crate::broad::{BoundsView, Candidates, Cell};
use crate::cache::prefetch;
use crate::math::Vec3;
use crate::par;
use crate::wide::{self, Loop};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::atomic::AtomicU32;
use std::sync::atomic::Ordering::Relaxed;

/// How a sort is cut into parts. The result does not depend on it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Parts {
    /// bodies in a block
    pub block: usize,
    /// cells of which a block may count for itself; `None`: there is one count for all
    pub widest: Option<usize>,
}

impl Parts {
    /// Parts of so many bodies: a few blocks for each thread. Few bodies and threads alone are faster with one count for all.
    pub fn of(count: usize) -> Parts {
        let threads = rayon::current_num_threads();
        if threads == 1 || count < FEW {
            return Parts { block: FEW, widest: None };
        }
        let block = (count / (BLOCKS_PER_THREAD * threads)).max(SMALLEST);
        Parts { block, widest: Some(WIDEST + WIDEST_PER_BODY * block) }
    }
}

/// Bodies up to which one thread sorts all: several gain nothing.
const FEW: usize = 8192;
/// Bodies in a block at least.
const SMALLEST: usize = 1024;
const BLOCKS_PER_THREAD: usize = 2;
/// Cells that a block may count in: so many, and so many for each of its bodies.
const WIDEST: usize = 1 << 16;
const WIDEST_PER_BODY: usize = 16;

/// Bodies looked at and then placed at a time: their bounding spheres stay in the first cache in between.
const CHUNK: usize = 512;

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

/// A block of bodies on their way.
#[derive(Clone, Debug, Default)]
struct Block {
    /// what was seen of them
    seen: Seen,
    /// bodies in the order in which they came
    came: Vec<Entry>,
    /// the lowest of their cells
    low: u32,
    /// for each cell from there on, how many of them are in it; then, the place of the next of them
    counts: Vec<u32>,
    /// how many of them are in each range of cells
    in_range: Vec<u32>,
    /// they are in too many cells to count by themselves
    scattered: bool,
}

/// A body on its way to its cell.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
struct Entry {
    cell: u32,
    slot: u32,
    /// lower 16 bits of the rounded centre's coordinates, see [`Points`]
    xy: u32,
    z: u32,
}

/// What placing reads.
#[derive(Clone, Copy)]
struct Placing<'a> {
    cells: Cells,
    members: Option<&'a [u32]>,
    balls: &'a [Ball],
    /// where every block counts for itself: cells in a range, and the most that it counts of
    ranges: Option<(usize, usize)>,
}

/// What turns a position into a cell's number. Cells count from 1 along x and y and from 0 along z.
#[derive(Clone, Copy, Debug)]
struct Cells {
    frame: Frame,
    /// lower 32 bits of the coordinates of the cell that would be (0, 0, 0)
    first: [u32; 3],
    last: [u32; 3],
    stride: [u32; 2],
}

impl Cells {
    fn new(frame: Frame, stride: [usize; 2]) -> Cells {
        let [x, y, z] = frame.first.map(|c| c as u32);
        let [nx, ny, nz] = frame.count.map(|c| c as u32);
        let first = [x.wrapping_sub(1), y.wrapping_sub(1), z];
        Cells { frame, first, last: [nx, ny, nz.wrapping_sub(1)], stride: stride.map(|s| s as u32) }
    }

    /// A body outside the frame goes to one of its cells all the same.
    #[inline(always)]
    fn entry(&self, slot: u32, center: Vec3) -> Entry {
        let place = self.frame.place(center);
        let at = |axis: usize| cell_of(place[axis]).wrapping_sub(self.first[axis]).min(self.last[axis]);
        let cell = at(0) + at(1) * self.stride[0] + at(2) * self.stride[1];
        let low = |axis: usize| u32::from(place[axis] as u16);
        Entry { cell, slot, xy: low(0) | low(1) << 16, z: low(2) }
    }
}

/// Finds the cells of bodies whose slots are counted from `first`.
struct PlaceAll<'a> {
    cells: &'a Cells,
    first: u32,
    balls: &'a [Ball],
    came: &'a mut [Entry],
}

impl Loop for PlaceAll<'_> {
    /// the lowest and the highest of the cells
    type Output = [u32; 2];

    #[inline(always)]
    fn run(self) -> [u32; 2] {
        let [mut low, mut high] = [u32::MAX, 0];
        for (k, (entry, ball)) in self.came.iter_mut().zip(self.balls).enumerate() {
            *entry = self.cells.entry(self.first + k as u32, ball.center);
            (low, high) = (low.min(entry.cell), high.max(entry.cell));
        }
        [low, high]
    }
}

impl Block {
    /// Places the bodies of a range. With `clear` they are surveyed on the way.
    fn place(&mut self, placing: &Placing<'_>, range: Range<usize>, clear: Option<(&Clear, &BoundsView<'_>)>) {
        self.came.resize(range.len(), Entry::default());
        self.seen.clear();
        let [mut low, mut high] = [u32::MAX, 0];
        for first in range.clone().step_by(CHUNK) {
            let chunk = first..(first + CHUNK).min(range.end);
            if let Some((clear, view)) = clear {
                self.seen.look(clear, chunk.clone(), view);
            }
            let came = &mut self.came[chunk.start - range.start..chunk.end - range.start];
            match placing.members {
                None => {
                    let (cells, first) = (&placing.cells, chunk.start as u32);
                    let ends = wide::run(PlaceAll { cells, first, balls: &placing.balls[chunk], came });
                    (low, high) = (low.min(ends[0]), high.max(ends[1]));
                }
                Some(members) => {
                    for (entry, &slot) in came.iter_mut().zip(&members[chunk]) {
                        *entry = placing.cells.entry(slot, placing.balls[slot as usize].center);
                        (low, high) = (low.min(entry.cell), high.max(entry.cell));
                    }
                }
            }
        }
        if let Some(ranges) = placing.ranges {
            self.count(ranges, low.min(high), high);
        }
    }

    /// Counts the bodies in each cell, from the lowest to the highest, and in ranges of so many cells.
    fn count(&mut self, (range, widest): (usize, usize), low: u32, high: u32) {
        self.low = low;
        let width = (high - low + 1) as usize;
        self.scattered = width > widest;
        self.counts.clear();
        self.in_range.clear();
        if self.scattered {
            return;
        }
        self.counts.resize(width, 0);
        for e in &self.came {
            self.counts[(e.cell - low) as usize] += 1;
        }
        let mut rest = &self.counts[..];
        let mut next = low as usize;
        self.in_range.resize(next / range, 0);
        while !rest.is_empty() {
            let (here, after) = rest.split_at((range - next % range).min(rest.len()));
            self.in_range.push(here.iter().sum());
            (rest, next) = (after, next + here.len());
        }
    }

    /// Puts the bodies at their places.
    fn put(&mut self, [slots, cells, xy, z]: [&[AtomicU32]; 4]) {
        // All of one length: one check for all.
        let n = slots.len();
        let (cells, xy, z, low) = (&cells[..n], &xy[..n], &z[..n], self.low);
        for e in &self.came {
            let next = &mut self.counts[(e.cell - low) as usize];
            let at = *next as usize;
            *next += 1;
            slots[at].store(e.slot, Relaxed);
            cells[at].store(e.cell, Relaxed);
            xy[at].store(e.xy, Relaxed);
            z[at].store(e.z, Relaxed);
        }
    }
}

/// A range of cells and what blocks have counted in it, each from a cell of the range on.
struct CellRange<'a> {
    first_place: u32,
    start: &'a mut [u32],
    counts: Vec<(usize, &'a mut [u32])>,
}

impl CellRange<'_> {
    /// From counts to places: where each cell starts, and in it each block.
    fn sum_up(self) {
        let CellRange { first_place, start, mut counts } = self;
        start.fill(0);
        for (from, counts) in &mut counts {
            for (sum, count) in start[*from..].iter_mut().zip(counts.iter_mut()) {
                let before = *sum;
                *sum += *count;
                *count = before;
            }
        }
        let mut place = first_place;
        for count in start.iter_mut() {
            place += std::mem::replace(count, place);
        }
        for (from, counts) in counts {
            for (first, before) in start[from..].iter().zip(counts) {
                *before += first;
            }
        }
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
        let arrays = [&mut self.slots[..], &mut self.cells[..], xy, z].map(|a| &*par::as_atomic(a));
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
