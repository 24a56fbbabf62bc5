//! All cells of the scene's box, with a counting sort in two stages that any number of threads can share: blocks of bodies
//! are dealt out to slabs (runs of consecutive cells), then each slab sorts what it was dealt by cell. Both are stable, so
//! the order is that of one plain counting sort whatever the blocks and slabs are.

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
    /// where blocks of bodies are dealt out to slabs
    dealt: Vec<Dealt>,
}

/// A block of bodies, dealt out to slabs.
#[derive(Clone, Debug, Default)]
struct Dealt {
    /// what was seen of them on the way
    seen: Seen,
    /// bodies in the order in which they came
    came: Vec<Entry>,
    /// bodies, slab by slab; unused where there is one slab
    entries: Vec<Entry>,
    /// where each slab ends in `entries`
    ends: Vec<u32>,
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

/// What dealing reads.
#[derive(Clone, Copy)]
struct Dealer<'a> {
    cells: Cells,
    members: Option<&'a [u32]>,
    balls: &'a [Ball],
    /// slabs of `1 << shift` cells
    shift: u32,
    slabs: usize,
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
    type Output = ();

    #[inline(always)]
    fn run(self) {
        for (k, (entry, ball)) in self.came.iter_mut().zip(self.balls).enumerate() {
            *entry = self.cells.entry(self.first + k as u32, ball.center);
        }
    }
}

impl Dealt {
    /// The bodies of a slab.
    fn of_slab(&self, slab: usize) -> &[Entry] {
        let first = if slab == 0 { 0 } else { self.ends[slab - 1] as usize };
        &self.entries[first..self.ends[slab] as usize]
    }

    /// Places the bodies of a range and deals them out. With `clear` they are surveyed on the way.
    fn deal(&mut self, dealer: &Dealer<'_>, range: Range<usize>, clear: Option<(&Clear, &BoundsView<'_>)>) {
        self.came.resize(range.len(), Entry::default());
        self.seen.clear();
        for first in range.clone().step_by(CHUNK) {
            let chunk = first..(first + CHUNK).min(range.end);
            if let Some((clear, view)) = clear {
                self.seen.look(clear, chunk.clone(), view);
            }
            let came = &mut self.came[chunk.start - range.start..chunk.end - range.start];
            match dealer.members {
                None => wide::run(PlaceAll {
                    cells: &dealer.cells,
                    first: chunk.start as u32,
                    balls: &dealer.balls[chunk],
                    came,
                }),
                Some(members) => {
                    for (entry, &slot) in came.iter_mut().zip(&members[chunk]) {
                        *entry = dealer.cells.entry(slot, dealer.balls[slot as usize].center);
                    }
                }
            }
        }
        if dealer.slabs > 1 {
            self.deal_out(dealer);
        }
    }

    /// A counting sort by slab.
    fn deal_out(&mut self, dealer: &Dealer<'_>) {
        self.entries.resize(self.came.len(), Entry::default());
        self.ends.clear();
        self.ends.resize(dealer.slabs, 0);
        for entry in &self.came {
            self.ends[(entry.cell >> dealer.shift) as usize] += 1;
        }
        let mut sum = 0;
        for end in &mut self.ends {
            sum += std::mem::replace(end, sum);
        }
        // What was the start of each slab moves on to its end.
        for &entry in &self.came {
            let place = &mut self.ends[(entry.cell >> dealer.shift) as usize];
            self.entries[*place as usize] = entry;
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
    points: [&'a mut [u32]; 2],
}

impl Slab<'_> {
    /// Counting sort. `start[c]` counts the bodies of cell c; summed up, it is where cell c starts, and moves on as bodies of
    /// cell c find their places, so that at last it is where the next cell starts.
    fn sort<'e>(self, blocks: impl Iterator<Item = &'e [Entry]> + Clone) {
        let Slab { first_cell, first_place, start, slots, cells, points: [xy, z] } = self;
        // All of one length: one check for all.
        let n = slots.len();
        let (cells, xy, z) = (&mut cells[..n], &mut xy[..n], &mut z[..n]);
        start.fill(0);
        for e in blocks.clone().flatten() {
            start[(e.cell - first_cell) as usize] += 1;
        }
        let mut sum = first_place;
        for s in start.iter_mut() {
            sum += std::mem::replace(s, sum);
        }
        for e in blocks.flatten() {
            let place = &mut start[(e.cell - first_cell) as usize];
            let at = (*place - first_place) as usize;
            *place += 1;
            slots[at] = e.slot;
            cells[at] = e.cell;
            xy[at] = e.xy;
            z[at] = e.z;
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
        let dealer = self.dealer(members, balls, parts);
        let blocks =
            par::ranges_into(count, parts.block, &mut self.dealt, |range, dealt| dealt.deal(&dealer, range, None));
        self.sort_slabs(&dealer, blocks);
    }

    /// Surveys all bodies and sorts them into the cells of a frame that was made before they moved. `None`: they are not in its
    /// cells; the survey holds all the same.
    pub fn survey_and_rebuild(
        &mut self,
        frame: Frame,
        view: &BoundsView<'_>,
        parts: Parts,
        out: &mut Candidates,
    ) -> (Option<Extent>, bool) {
        let (count, clear) = (view.balls.len(), Clear::of(view.boundaries));
        self.resize(frame, count);
        let dealer = self.dealer(None, view.balls, parts);
        let blocks = par::ranges_into(count, parts.block, &mut self.dealt, |range, dealt| {
            dealt.deal(&dealer, range, Some((&clear, view)));
        });
        let extent = Seen::report(self.dealt[..blocks].iter().map(|dealt| &dealt.seen), out);
        let holds = extent.as_ref().is_some_and(|e| e.count == count && e.is_one_level() && frame.holds(e));
        if holds {
            self.sort_slabs(&dealer, blocks);
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

    fn dealer<'a>(&self, members: Option<&'a [u32]>, balls: &'a [Ball], parts: Parts) -> Dealer<'a> {
        let total = self.start.len() - 1;
        let cells_per_slab = total.div_ceil((self.slots.len() / parts.slab).max(1)).next_power_of_two();
        let shift = cells_per_slab.trailing_zeros();
        let slabs = total.div_ceil(cells_per_slab);
        Dealer { cells: Cells::new(self.frame, self.stride), members, balls, shift, slabs }
    }

    /// Sorts every slab, each into its own part of the arrays.
    fn sort_slabs(&mut self, dealer: &Dealer<'_>, blocks: usize) {
        let dealt = &self.dealt[..blocks];
        let mut start = &mut self.start[1..];
        let total = start.len();
        let (mut slots, mut cells, mut points) = (&mut self.slots[..], &mut self.cells[..], self.points.axes());
        if dealer.slabs == 1 {
            let task = Slab { first_cell: 0, first_place: 0, start, slots, cells, points };
            return task.sort(dealt.iter().map(|block| &block.came[..]));
        }
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
            task.sort(dealt.iter().map(|block| block.of_slab(slab)));
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
