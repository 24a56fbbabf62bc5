//! The thesis's regular grid (section 5.3.2, 6.4.1, figure 4, appendix A.3): the scene's box is divided into equal cells,
//! every object is listed in all cells that its box meets, and only pairs of a common cell are compared, each pair once.
//!
//! What the thesis does with doubly linked lists and identifications left at the partners (mailboxes) is done here with
//! sorted keys: a pair is compared in the first of its common cells only, which needs no memory per pair and gives the same
//! pairs and the same count. Empty cells cost nothing, so that 1024 cells along each axis need no more memory than 4.

use super::scene::{Extent, Scene};
use super::{BoundsView, BroadPhase, Candidates, Cell};
use crate::bounds::Aabb;
use crate::math::{Real, Vec3};
use rayon::prelude::*;

/// Objects that meet more blocks than this are kept out of the lists; cells are compared by number instead.
const WIDE: u64 = 512;
/// Listings per object that are worth their memory, and listings that are always allowed.
const LISTINGS: u64 = 32;
const FREE_LISTINGS: u64 = 4096;

/// The thesis's regular grid.
///
/// Boundaries and bodies of infinite mass keep their places while the extent of the scene does not change; a change is
/// noticed by itself. Boundaries that reach to infinity are compared with every body, and so is a body that has crossed a
/// limit's face with that limit: no cell can answer for those.
///
/// Memory does not depend on the resolution. Objects much larger than a cell are not listed in all of its cells; their
/// ranges of cells are compared instead, and where nearly all objects are larger than a cell, neighbouring cells share a
/// list. Neither changes which pairs are compared.
#[derive(Clone, Debug, Default)]
pub struct RegularGrid {
    resolution: Option<u32>,
    scene: Scene,
    frame: Option<Frame>,
    /// cells of every object
    ranges: Vec<Range>,
    /// listings of immovable objects, kept while the frame stays: block in the upper half, object in the lower
    immovable: Vec<u64>,
    /// listings of all others
    movable: Vec<u64>,
    /// objects that are not listed because they meet too many blocks, ascending
    wide: Vec<u32>,
    /// how often the immovable objects have been sorted in
    sorted_in: u64,
}

/// The grid's place in space, and what the places of immovable objects depend on besides.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Frame {
    extent: Extent,
    resolution: u32,
    /// cells per length along each axis \[1/m\]
    density: Vec3,
    /// a list serves a block of `2^shift` cells along each axis
    shift: u32,
    epoch: u64,
    bodies: u32,
    boundaries: usize,
}

/// The cells an object meets, both ends included.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Range {
    low: [u16; 3],
    high: [u16; 3],
}

impl Range {
    const NONE: Range = Range { low: [u16::MAX; 3], high: [0; 3] };

    /// Whether the two have a common cell.
    #[inline]
    fn meets(&self, o: &Range) -> bool {
        (0..3).all(|k| self.low[k] <= o.high[k] && o.low[k] <= self.high[k])
    }

    /// Number of blocks of `2^shift` cells that the object meets.
    #[inline]
    fn blocks(&self, shift: u32) -> u64 {
        if self.low[0] > self.high[0] {
            return 0;
        }
        (0..3).map(|k| u64::from((self.high[k] >> shift) - (self.low[k] >> shift)) + 1).product()
    }

    /// First common block of two objects.
    #[inline]
    fn first_common(&self, o: &Range, shift: u32) -> u32 {
        let at = |k: usize| u32::from(self.low[k].max(o.low[k]) >> shift);
        block_key(at(0), at(1), at(2))
    }
}

/// Ten bits per axis: [`RegularGrid::MAX_RESOLUTION`] cells.
#[inline]
fn block_key(x: u32, y: u32, z: u32) -> u32 {
    (z << 20) | (y << 10) | x
}

impl Frame {
    /// Rounding is monotone, therefore boxes that meet have a common cell. An axis without extent has one cell.
    #[inline]
    fn cell(&self, x: Real, axis: usize) -> u16 {
        let place = (x - self.extent.bounds.min[axis]) * self.density[axis];
        // The conversion rounds towards zero and saturates; not a number (0 times infinity) becomes 0.
        (place as u32).min(self.resolution - 1) as u16
    }

    fn range(&self, b: &Aabb) -> Range {
        let row = |p: Vec3| [self.cell(p.x, 0), self.cell(p.y, 1), self.cell(p.z, 2)];
        Range { low: row(b.min), high: row(b.max) }
    }

    /// Box of a block.
    fn bounds(&self, key: u32) -> Aabb {
        let (low, high) = (self.extent.bounds.min, self.extent.bounds.max);
        let edge = |k: usize, cell: u32| {
            let part = Real::from(cell.min(self.resolution)) / Real::from(self.resolution);
            low[k] * (1.0 - part) + high[k] * part
        };
        let at = |k: usize| (key >> (10 * k)) & 1023;
        let corner = |d: u32| {
            Vec3::new(
                edge(0, (at(0) + d) << self.shift),
                edge(1, (at(1) + d) << self.shift),
                edge(2, (at(2) + d) << self.shift),
            )
        };
        Aabb { min: corner(0), max: corner(1) }
    }
}

impl RegularGrid {
    /// Most cells along an axis.
    pub const MAX_RESOLUTION: u32 = 1024;

    /// A grid with so many cells along each axis of the scene, 1 to [`Self::MAX_RESOLUTION`] (what lies outside is brought
    /// to the nearer end); `None`: twice the cube root of the number of bodies, the thesis's `Grid 2n`, within the same
    /// limits.
    pub fn new(resolution: Option<u32>) -> Self {
        RegularGrid { resolution: resolution.map(|n| n.clamp(1, Self::MAX_RESOLUTION)), ..Self::default() }
    }

    /// Cells along each axis for so many bodies.
    pub fn resolution_for(&self, bodies: usize) -> u32 {
        let twice_root = 2.0 * libm::round(libm::cbrt(bodies as Real));
        self.resolution.unwrap_or((twice_root as u32).clamp(1, Self::MAX_RESOLUTION))
    }

    /// The frame of this step, with the last step's block size.
    fn frame_of(&self, view: &BoundsView<'_>) -> Frame {
        let extent = self.scene.extent;
        let resolution = self.resolution_for(view.balls.len());
        let size = extent.bounds.max - extent.bounds.min;
        let density = |size: Real| {
            let cells = Real::from(resolution) / size;
            if size > 0.0 && cells.is_finite() { cells } else { 0.0 }
        };
        Frame {
            extent,
            resolution,
            density: Vec3::new(density(size.x), density(size.y), density(size.z)),
            shift: self.frame.map_or(0, |f| f.shift),
            epoch: view.epoch,
            bodies: self.scene.bodies,
            boundaries: view.boundaries.len(),
        }
    }

    /// Finds the cells of all objects, of immovable ones only if the frame is not the last step's.
    fn place(&mut self, view: &BoundsView<'_>) {
        let mut frame = self.frame_of(view);
        let kept = self.frame == Some(frame);
        self.ranges.resize(self.scene.objects(), Range::NONE);
        for object in 0..self.scene.objects() {
            if !kept || !self.scene.is_immovable(view, object as u32) {
                let listed = self.scene.listed_box(view, object, frame.extent.reach);
                self.ranges[object] = listed.map_or(Range::NONE, |b| frame.range(&b));
            }
        }
        frame.shift = self.block_shift(frame.resolution);
        let kept = self.frame == Some(frame);
        self.frame = Some(frame);
        if !kept {
            self.sorted_in += 1;
            let mut listings = std::mem::take(&mut self.immovable);
            self.list(view, true, frame.shift, &mut listings);
            self.immovable = listings;
        }
        let mut listings = std::mem::take(&mut self.movable);
        self.list(view, false, frame.shift, &mut listings);
        self.movable = listings;
        self.wide.clear();
        let ranges = self.ranges.iter().enumerate();
        self.wide.extend(ranges.filter(|(_, r)| r.blocks(frame.shift) > WIDE).map(|(k, _)| k as u32));
    }

    /// The smallest block for which the work stays in proportion to the number of objects, or else the cheapest.
    fn block_shift(&self, resolution: u32) -> u32 {
        let objects = self.ranges.len() as u64;
        let mut best = (u64::MAX, 0);
        for shift in 0..=10 {
            best = best.min((self.cost(resolution, shift), shift));
            if best.0 <= LISTINGS * objects + FREE_LISTINGS {
                break;
            }
        }
        best.1
    }

    /// Estimate of the work with this block, in listings: a comparison of two ranges costs an eighth of a listing. Lists
    /// are taken as equally long, an object that is not listed is compared with every other.
    fn cost(&self, resolution: u32, shift: u32) -> u64 {
        let (mut listings, mut wide) = (0u64, 0u64);
        for range in &self.ranges {
            match range.blocks(shift) {
                n if n > WIDE => wide += 1,
                n => listings += n,
            }
        }
        let along = u64::from(((resolution - 1) >> shift) + 1);
        let lists = (along * along * along).min(listings).max(1);
        let comparisons =
            u128::from(listings) * u128::from(listings / lists) + u128::from(wide) * self.ranges.len() as u128;
        listings + u64::try_from(comparisons / 8).unwrap_or(u64::MAX / 2)
    }

    /// Sorted listings of the movable or of the immovable objects.
    fn list(&self, view: &BoundsView<'_>, immovable: bool, shift: u32, listings: &mut Vec<u64>) {
        listings.clear();
        for (object, range) in self.ranges.iter().enumerate() {
            let blocks = range.blocks(shift);
            if blocks == 0 || blocks > WIDE || self.scene.is_immovable(view, object as u32) != immovable {
                continue;
            }
            let span = |k: usize| u32::from(range.low[k] >> shift)..=u32::from(range.high[k] >> shift);
            for z in span(2) {
                for y in span(1) {
                    for x in span(0) {
                        listings.push((u64::from(block_key(x, y, z)) << 32) | object as u64);
                    }
                }
            }
        }
        // No two listings are equal, so there is one sorted order.
        listings.par_sort_unstable();
    }

    /// Compares the pairs of every list.
    fn compare_lists(&self, view: &BoundsView<'_>, shift: u32, out: &mut Candidates) {
        let mut still = self.immovable.as_slice();
        for list in self.movable.chunk_by(|a, b| a >> 32 == b >> 32) {
            let key = (list[0] >> 32) as u32;
            still = &still[still.partition_point_near(key)..];
            let partners = &still[..still.partition_point_near(key + 1)];
            for (k, &a) in list.iter().enumerate() {
                let a = a as u32;
                let range = self.ranges[a as usize];
                for &b in list[k + 1..].iter().chain(partners) {
                    let b = b as u32;
                    let other = &self.ranges[b as usize];
                    let here = range.first_common(other, shift) == key;
                    if here && (shift == 0 || range.meets(other)) {
                        self.scene.test(view, a, b, out);
                    }
                }
            }
        }
    }

    /// Compares the objects that are not listed with everything that has a common cell with them.
    fn compare_wide(&self, view: &BoundsView<'_>, out: &mut Candidates) {
        for (k, &a) in self.wide.iter().enumerate() {
            let range = self.ranges[a as usize];
            let still = self.scene.is_immovable(view, a);
            for (b, other) in self.ranges.iter().enumerate() {
                let b = b as u32;
                if !range.meets(other) || a == b || (still && self.scene.is_immovable(view, b)) {
                    continue;
                }
                // Two of a kind: compared when the first one's turn came.
                if self.wide[..k].binary_search(&b).is_err() {
                    self.scene.test(view, a, b, out);
                }
            }
        }
    }
}

/// Search in sorted listings for places that are mostly near the front.
trait Near {
    /// Number of listings of blocks below `key`.
    fn partition_point_near(&self, key: u32) -> usize;
}

impl Near for [u64] {
    fn partition_point_near(&self, key: u32) -> usize {
        let below = |l: &u64| ((l >> 32) as u32) < key;
        let mut end = 1;
        while end < self.len() && below(&self[end - 1]) {
            end *= 2;
        }
        let end = end.min(self.len());
        self[..end].partition_point(below)
    }
}

impl BroadPhase for RegularGrid {
    fn name(&self) -> String {
        crate::def::BroadPhaseKind::RegularGrid { resolution: self.resolution }.to_string()
    }

    fn wants_boxes(&self) -> bool {
        true
    }

    fn find(&mut self, view: &BoundsView<'_>, out: &mut Candidates) {
        let walls_before = out.walls.len();
        self.scene.survey(view);
        self.place(view);
        let shift = self.frame.map_or(0, |f| f.shift);
        self.compare_lists(view, shift, out);
        self.compare_wide(view, out);
        self.scene.finish(view, walls_before, out);
    }

    /// The occupied cells. Objects that meet more than 512 cells (large limits) are not counted in them.
    fn cells(&self) -> Vec<Cell> {
        let Some(frame) = self.frame else { return Vec::new() };
        let mut keys: Vec<u32> = self.movable.iter().chain(&self.immovable).map(|l| (l >> 32) as u32).collect();
        keys.sort_unstable();
        let cells = keys.chunk_by(|a, b| a == b);
        cells.map(|k| Cell { bounds: frame.bounds(k[0]), depth: 0, objects: k.len() as u32 }).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Ball, BoundaryBounds};

    fn view<'a>(balls: &'a [Ball], fixed: &'a [bool], boundaries: &'a [BoundaryBounds], epoch: u64) -> BoundsView<'a> {
        BoundsView { balls, boxes: &[], fixed, boundaries, epoch }
    }

    fn search(grid: &mut RegularGrid, view: &BoundsView<'_>) -> Candidates {
        let mut out = Candidates::default();
        grid.find(view, &mut out);
        out
    }

    /// Small and large balls in the cube from 0 to 1.
    fn balls(n: usize, large: Real, spread: Real) -> Vec<Ball> {
        let part = |k: usize, by: Real| (k as Real * by).fract();
        let ball = |k: usize| Ball {
            center: Vec3::new(part(k, 0.754_877), part(k, 0.569_840), part(k, 0.245_122)),
            radius: large * crate::math::powi(part(k, 0.618_034), 4) + spread,
        };
        (0..n).map(ball).collect()
    }

    /// Pairs that share a cell, from the definition: cell by cell.
    fn pairs_of_a_common_cell(grid: &RegularGrid, view: &BoundsView<'_>) -> u64 {
        let n = grid.ranges.len();
        let mut count = 0;
        for a in 0..n {
            for b in a + 1..n {
                let both = grid.scene.is_immovable(view, a as u32) && grid.scene.is_immovable(view, b as u32);
                let common = (0..3).all(|k| {
                    let (a, b) = (&grid.ranges[a], &grid.ranges[b]);
                    (a.low[k]..=a.high[k]).any(|cell| (b.low[k]..=b.high[k]).contains(&cell))
                });
                count += u64::from(common && !both);
            }
        }
        count
    }

    #[test]
    fn neither_blocks_nor_wide_objects_change_the_count() {
        let (mut blocks, mut wide) = (0, 0);
        for (n, large, spread) in [(300, 0.02, 0.001), (300, 0.5, 0.01), (200, 0.01, 0.05), (40, 0.4, 0.0)] {
            let balls = balls(n, large, spread);
            let fixed: Vec<bool> = (0..n).map(|k| k % 5 == 0).collect();
            for resolution in [1, 3, 16, 60, 250, 1024] {
                let mut grid = RegularGrid::new(Some(resolution));
                let view = view(&balls, &fixed, &[], 0);
                let out = search(&mut grid, &view);
                assert_eq!(out.sphere_tests, pairs_of_a_common_cell(&grid, &view), "{n} {large} {resolution}");
                blocks += grid.frame.unwrap().shift;
                wide += grid.wide.len();
                assert!((grid.movable.len() + grid.immovable.len()) as u64 <= LISTINGS * n as u64 + FREE_LISTINGS);
            }
        }
        assert!(blocks > 0 && wide > 0, "both must have come up");
    }

    #[test]
    fn immovable_objects_are_sorted_in_once_while_the_extent_stays() {
        let face = Aabb { min: Vec3::splat(-1.0), max: Vec3::splat(2.0) };
        let wall = BoundaryBounds { ball: Ball { center: Vec3::splat(0.5), radius: 3.0 }, face, behind: None };
        let mut all = balls(50, 0.1, 0.01);
        let fixed: Vec<bool> = (0..50).map(|k| k % 3 == 0).collect();
        let mut grid = RegularGrid::new(None);
        for step in 0..5 {
            all[1].center.x = 0.1 * step as Real;
            search(&mut grid, &view(&all, &fixed, &[wall], 0));
            assert_eq!(grid.sorted_in, 1);
        }
        search(&mut grid, &view(&all, &fixed, &[wall], 1));
        assert_eq!(grid.sorted_in, 2, "a new epoch");
        all[1].center.x = 5.0;
        search(&mut grid, &view(&all, &fixed, &[wall], 1));
        assert_eq!(grid.sorted_in, 3, "another extent");
        assert_eq!(grid.immovable.len(), grid.immovable.iter().collect::<std::collections::BTreeSet<_>>().len());
    }

    #[test]
    fn objects_on_the_border_of_cells_are_in_both() {
        // Eight cells of length 1: a box from 2 to 3 meets cells 2 and 3, the one from 3 to 4 cells 3 and 4.
        let ball = |x: Real, radius: Real| Ball { center: Vec3::new(x, 0.0, 0.0), radius };
        let all = [ball(2.5, 0.5), ball(3.5, 0.5), ball(4.5, 0.25), ball(0.25, 0.25), ball(7.5, 0.5)];
        let mut grid = RegularGrid::new(Some(8));
        let out = search(&mut grid, &view(&all, &[], &[], 0));
        let along: Vec<_> = grid.ranges.iter().map(|r| (r.low[0], r.high[0])).collect();
        assert_eq!(along, [(2, 3), (3, 4), (4, 4), (0, 0), (7, 7)]);
        assert_eq!((out.sphere_tests, out.pairs), (2, vec![[0, 1]]));
    }

    #[test]
    fn cells_are_where_the_objects_are() {
        let all = balls(100, 0.0, 0.01);
        let mut grid = RegularGrid::new(None);
        search(&mut grid, &view(&all, &[], &[], 0));
        let cells = grid.cells();
        assert!(!cells.is_empty());
        for ball in &all {
            let (own, mut listed) = (Aabb::of_ball(ball), 0);
            for cell in &cells {
                listed += u32::from(cell.bounds.meets(&own));
            }
            assert!((1..=27).contains(&listed));
        }
        assert_eq!(cells.iter().map(|c| c.objects as usize).sum::<usize>(), grid.movable.len());
    }
}
