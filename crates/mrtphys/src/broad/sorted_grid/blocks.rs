//! Bodies on their way into the cells of a dense grid: blocks of them are looked at, placed, counted and put where they belong.

use super::cells::{Frame, cell_of};
use super::survey::{Clear, Seen};
use crate::bounds::Ball;
use crate::broad::BoundsView;
use crate::math::Vec3;
use crate::wide::{self, Loop};
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

/// A block of bodies on their way.
#[derive(Clone, Debug, Default)]
pub(super) struct Block {
    /// what was seen of them
    pub seen: Seen,
    /// bodies in the order in which they came
    pub came: Vec<Entry>,
    /// the lowest of their cells
    pub low: u32,
    /// for each cell from there on, how many of them are in it; then, the place of the next of them
    pub counts: Vec<u32>,
    /// how many of them are in each range of cells
    pub in_range: Vec<u32>,
    /// they are in too many cells to count by themselves
    pub scattered: bool,
}

/// A body on its way to its cell.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub(super) struct Entry {
    pub cell: u32,
    pub slot: u32,
    /// lower 16 bits of the rounded centre's coordinates, see [`Points`]
    pub xy: u32,
    pub z: u32,
}

/// What placing reads.
#[derive(Clone, Copy)]
pub(super) struct Placing<'a> {
    pub cells: Cells,
    pub members: Option<&'a [u32]>,
    pub balls: &'a [Ball],
    /// where every block counts for itself: cells in a range, and the most that it counts of
    pub ranges: Option<(usize, usize)>,
}

/// What turns a position into a cell's number. Cells count from 1 along x and y and from 0 along z.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cells {
    frame: Frame,
    /// lower 32 bits of the coordinates of the cell that would be (0, 0, 0)
    first: [u32; 3],
    last: [u32; 3],
    stride: [u32; 2],
}

impl Cells {
    pub fn new(frame: Frame, stride: [usize; 2]) -> Cells {
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
    pub balls: &'a [Ball],
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
    pub fn place(&mut self, placing: &Placing<'_>, range: Range<usize>, clear: Option<(&Clear, &BoundsView<'_>)>) {
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
    pub fn put(&mut self, [slots, cells, xy, z]: [&[AtomicU32]; 4]) {
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
pub(super) struct CellRange<'a> {
    pub first_place: u32,
    pub start: &'a mut [u32],
    pub counts: Vec<(usize, &'a mut [u32])>,
}

impl CellRange<'_> {
    /// From counts to places: where each cell starts, and in it each block.
    pub fn sum_up(self) {
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
