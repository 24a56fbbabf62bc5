//! The broad phase made for speed: bodies are counting-sorted into cells a little larger than the largest diameter, so that
//! a body's partners are in its own cell and the 26 round it; half of them are looked at, as five runs of neighbouring cells
//! in sorted order. Bodies of very different size go to levels of their own, one per factor of four in radius. Where the
//! cells of the scene's box would be many more than the bodies, only occupied cells are kept, sorted by their coordinates:
//! no hash, so no input makes it slow.
//!
//! (Counting-sorted cell lists: algorithms of molecular dynamics, e.g. Rapaport 2004, section 3.4. Hierarchical grids:
//! Ericson 2005, section 7.2.)

mod blocks;
mod cells;
mod dense;
mod lanes;
mod sparse;
mod survey;

use super::{BoundsView, BroadPhase, Candidates, Cell};
use crate::bounds::{Aabb, Ball};
use crate::math::{Real, Vec3, max, min};
use crate::par;
use blocks::Parts;
use cells::Frame;
use dense::Dense;
use sparse::Sparse;
use survey::Seen;

/// Radii within a level differ at most by this factor.
const LEVEL_RATIO: Real = 4.0;
/// Cells per body up to which all cells of the scene's box are kept.
const DENSE_CELLS_PER_BODY: usize = 16;
/// Cells that are always affordable.
const DENSE_CELLS_MIN: usize = 4096;
/// Sorted bodies in a block of the pair scan.
const SCAN_BLOCK: usize = 1024;

/// Counting-sorted cells, see the module's text.
#[derive(Clone, Debug, Default)]
pub struct SortedGrid {
    levels: Vec<Level>,
    outputs: Vec<Found>,
    seen: Vec<Seen>,
    /// what was seen at the last time
    last: Option<Last>,
}

/// What tells where bodies will be: that they were there a step before.
#[derive(Clone, Copy, Debug)]
struct Last {
    epoch: u64,
    extent: Extent,
}

/// Bodies of similar radius.
#[derive(Clone, Debug, Default)]
struct Level {
    /// slots of its bodies; unused where one level holds all
    members: Vec<u32>,
    largest: Real,
    index: Index,
}

#[derive(Clone, Debug)]
enum Index {
    Dense(Dense),
    Sparse(Sparse),
}

impl Default for Index {
    fn default() -> Index {
        Index::Dense(Dense::default())
    }
}

/// Pairs found by one block of the scan.
#[derive(Clone, Debug, Default)]
struct Found {
    pairs: Vec<[u32; 2]>,
    /// scratch: places of bodies that may meet
    near: Vec<[u32; 2]>,
    tests: u64,
}

impl BroadPhase for SortedGrid {
    fn name(&self) -> String {
        "sorted-grid".into()
    }

    fn find(&mut self, view: &BoundsView<'_>, out: &mut Candidates) {
        self.sort(view, out);
        for level in 0..self.levels.len() {
            self.scan_level(level, view, out);
            for coarser in 0..level {
                self.scan_across(level, coarser, view, out);
            }
        }
    }

    fn spatial_order(&self) -> &[u32] {
        match &self.levels[..] {
            [Level { members, index: Index::Dense(dense), .. }] if members.is_empty() => dense.slots(),
            _ => &[],
        }
    }

    fn cells(&self) -> Vec<Cell> {
        let mut out = Vec::new();
        for (depth, level) in self.levels.iter().enumerate() {
            match &level.index {
                Index::Dense(d) => d.cells(depth as u32, &mut out),
                Index::Sparse(s) => s.cells(depth as u32, &mut out),
            }
        }
        out
    }
}

impl SortedGrid {
    /// Surveys all bodies and sorts them into cells: in one pass where they are where they were at the last time.
    fn sort(&mut self, view: &BoundsView<'_>, out: &mut Candidates) {
        let extent = match self.foreseen(view) {
            Some((frame, dense)) => {
                let (extent, holds) = dense.survey_and_rebuild(frame, view, Parts::of(view.balls.len()), out);
                if !holds {
                    self.build(extent, view);
                }
                extent
            }
            None => {
                let extent = survey::survey(view, &mut self.seen, out);
                self.build(extent, view);
                extent
            }
        };
        self.last = extent.map(|extent| Last { epoch: view.epoch, extent });
    }

    /// The frame that the bodies will be in if they are where they were, and what they are then sorted in. Cells do not depend on
    /// the frame where it is anchored, so what is counted does not depend on what was foreseen.
    fn foreseen(&mut self, view: &BoundsView<'_>) -> Option<(Frame, &mut Dense)> {
        let extent = self.last.filter(|last| last.epoch == view.epoch && last.extent.count == view.balls.len())?.extent;
        match &mut self.levels[..] {
            [Level { members, index: Index::Dense(dense), .. }] if members.is_empty() => {
                let frame = Frame::new(&extent, None, view.balls);
                (frame.is_anchored() && frame.cells_within(affordable(extent.count))).then_some((frame, dense))
            }
            _ => None,
        }
    }

    /// Sorts all bodies into levels, coarsest first, and each level into cells.
    fn build(&mut self, extent: Option<Extent>, view: &BoundsView<'_>) {
        let Some(extent) = extent else { return self.levels.clear() };
        if extent.is_one_level() && extent.count == view.balls.len() {
            self.levels.resize_with(1, Level::default);
            self.levels[0].members.clear();
            self.levels[0].largest = extent.largest;
            self.levels[0].index.rebuild(&extent, None, view.balls);
            return;
        }
        self.levels.clear();
        let mut order: Vec<u32> =
            (0..view.balls.len() as u32).filter(|&i| !view.balls[i as usize].is_empty()).collect();
        order.sort_by(|&a, &b| view.balls[b as usize].radius.total_cmp(&view.balls[a as usize].radius));
        let mut rest = &order[..];
        while let Some(&first) = rest.first() {
            let largest = view.balls[first as usize].radius;
            let count = rest.partition_point(|&i| view.balls[i as usize].radius * LEVEL_RATIO >= largest);
            let members = rest[..count.max(1)].to_vec();
            rest = &rest[members.len()..];
            let mut level = Level { members, largest, index: Index::default() };
            if let Some(extent) = Extent::of_members(view.balls, &level.members) {
                level.index.rebuild(&extent, Some(&level.members), view.balls);
            }
            self.levels.push(level);
        }
    }

    /// Pairs within a level.
    fn scan_level(&mut self, level: usize, view: &BoundsView<'_>, out: &mut Candidates) {
        let index = &self.levels[level].index;
        let scan = |first: usize, last: usize, found: &mut Found| match index {
            Index::Dense(d) => d.scan(first, last, view, found),
            Index::Sparse(s) => s.scan(first, last, view, found),
        };
        run_blocks(&mut self.outputs, index.len(), out, scan);
    }

    /// Pairs of a body of this level with one of a coarser level.
    fn scan_across(&mut self, level: usize, coarser: usize, view: &BoundsView<'_>, out: &mut Candidates) {
        let index = &self.levels[coarser].index;
        let members = &self.levels[level].members;
        let scan = |first: usize, last: usize, found: &mut Found| {
            for &slot in &members[first..last] {
                match index {
                    Index::Dense(d) => d.query(slot, view, found),
                    Index::Sparse(s) => s.query(slot, view, found),
                }
            }
        };
        run_blocks(&mut self.outputs, members.len(), out, scan);
    }
}

/// Runs a scan over blocks and puts their pairs together in the order of the blocks.
fn run_blocks(
    outputs: &mut Vec<Found>,
    count: usize,
    out: &mut Candidates,
    scan: impl Fn(usize, usize, &mut Found) + Sync,
) {
    let used = par::ranges_into(count, SCAN_BLOCK, outputs, |range, found| {
        found.pairs.clear();
        found.tests = 0;
        scan(range.start, range.end, found);
    });
    for found in &mut outputs[..used] {
        out.pairs.extend_from_slice(&found.pairs);
        out.sphere_tests += found.tests;
    }
}

impl Index {
    fn len(&self) -> usize {
        match self {
            Index::Dense(d) => d.len(),
            Index::Sparse(s) => s.len(),
        }
    }

    fn rebuild(&mut self, extent: &Extent, members: Option<&[u32]>, balls: &[Ball]) {
        let frame = Frame::new(extent, members, balls);
        if frame.cells_within(affordable(extent.count)) {
            if !matches!(self, Index::Dense(_)) {
                *self = Index::default();
            }
            if let Index::Dense(d) = self {
                d.rebuild(frame, members, balls, Parts::of(extent.count));
            }
        } else {
            if !matches!(self, Index::Sparse(_)) {
                *self = Index::Sparse(Sparse::default());
            }
            if let Index::Sparse(s) = self {
                s.rebuild(frame, members, balls);
            }
        }
    }
}

/// Cells of which all are kept for so many bodies. With the empty ones round thin boxes their numbers stay below 2^32.
fn affordable(bodies: usize) -> usize {
    (DENSE_CELLS_PER_BODY * bodies).clamp(DENSE_CELLS_MIN, 1 << 29)
}

/// Box of the centres and range of the radii of some bodies.
#[derive(Clone, Copy, Debug)]
struct Extent {
    centers: Aabb,
    smallest: Real,
    largest: Real,
    count: usize,
}

impl Default for Extent {
    fn default() -> Extent {
        Extent { centers: Aabb::EMPTY, smallest: Real::INFINITY, largest: 0.0, count: 0 }
    }
}

impl Extent {
    /// From the least and the largest of three coordinates and the radius.
    fn between(low: [Real; 4], high: [Real; 4], count: usize) -> Extent {
        let centers = Aabb { min: Vec3::new(low[0], low[1], low[2]), max: Vec3::new(high[0], high[1], high[2]) };
        Extent { centers, smallest: low[3], largest: high[3], count }
    }

    /// Whether one size of cells is right for all.
    fn is_one_level(&self) -> bool {
        self.smallest * LEVEL_RATIO >= self.largest
    }

    fn join(&mut self, o: &Extent) {
        self.centers = self.centers.union(&o.centers);
        self.smallest = min(self.smallest, o.smallest);
        self.largest = max(self.largest, o.largest);
        self.count += o.count;
    }

    fn add(&mut self, ball: &Ball) {
        if !ball.is_empty() {
            self.centers.min = self.centers.min.min(ball.center);
            self.centers.max = self.centers.max.max(ball.center);
            self.smallest = min(self.smallest, ball.radius);
            self.largest = max(self.largest, ball.radius);
            self.count += 1;
        }
    }

    fn of(balls: &[Ball]) -> Extent {
        let mut extent = Extent::default();
        balls.iter().for_each(|b| extent.add(b));
        extent
    }

    fn of_members(balls: &[Ball], members: &[u32]) -> Option<Extent> {
        let mut extent = Extent::default();
        members.iter().for_each(|&i| extent.add(&balls[i as usize]));
        (extent.count > 0).then_some(extent)
    }
}

/// Compares a body with a run of others and reports those it meets. Two fixed bodies are never compared.
#[inline(always)]
fn run<'a>(
    (slot, ball): (u32, &Ball),
    others: impl ExactSizeIterator<Item = (u32, &'a Ball)>,
    view: &BoundsView<'_>,
    found: &mut Found,
) {
    if view.is_fixed(slot) {
        for (other, other_ball) in others.filter(|&(other, _)| !view.is_fixed(other)) {
            found.tests += 1;
            test((slot, ball), (other, other_ball), found);
        }
        return;
    }
    found.tests += others.len() as u64;
    others.for_each(|other| test((slot, ball), other, found));
}

/// Reports a pair if the two balls, neither of which is empty, meet: the expression of [`Ball::meets`].
#[inline(always)]
fn test((a, ball_a): (u32, &Ball), (b, ball_b): (u32, &Ball), found: &mut Found) {
    let d = ball_a.center - ball_b.center;
    let r = ball_a.radius + ball_b.radius;
    if d.length_squared() <= r * r {
        found.pairs.push([a, b]);
    }
}
