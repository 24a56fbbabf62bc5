//! Where a cell is: the frame that turns positions into cell coordinates.

use super::Extent;
use crate::bounds::Ball;
use crate::math::{Real, Vec3, max};

/// Edge of a cell as a multiple of the largest radius. Above 2 by more than what rounding can do to a coordinate of up to
/// 2^40 cells, so that partners are never two cells apart. For gases of n = 8 to 100, of 2.8, 3.4, 3.8 and 4.3 the third is 3 to
/// 5 % faster than its neighbours: fewer cells to sort against more bodies to compare.
const EDGE: Real = 3.8;

/// Cell coordinates are kept within +-2^40. Clamping keeps neighbours neighbours, so a body farther out only shares its cell
/// with others farther out.
const FARTHEST: Real = (1_u64 << 40) as Real;
/// Up to so many cells from the world's origin, cells are counted from there: then it depends on nothing but its place in which
/// cell a body is.
const NEAR: Real = (1_u64 << 36) as Real;
/// How far the box of cells reaches beyond the extent it is made for, in edges: bodies may move a little before it is too
/// small.
const SPARE: Real = 0.125;

/// Bits behind the point of a [`Place`].
const FRACTION: u32 = 12;
/// Adding it to a number of cells leaves that number in the lowest bits, with [`FRACTION`] bits behind the point.
const SHIFT: Real = 1.5 * (1_u64 << (52 - FRACTION)) as Real;

/// Positions to cell coordinates.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Frame {
    /// where coordinates are counted from \[m\]
    pub origin: Vec3,
    /// edge of a cell \[m\]
    pub edge: Real,
    pub inverse_edge: Real,
    /// lowest coordinates of a cell
    pub first: [i64; 3],
    /// cells along each axis
    pub count: [i64; 3],
}

/// A position in a frame, in 2^-[`FRACTION`] edges, the lower 64 bits of a whole number.
pub(super) type Place = [u64; 3];

impl Frame {
    pub fn new(extent: &Extent, members: Option<&[u32]>, balls: &[Ball]) -> Frame {
        let edge = EDGE * extent.largest;
        let inverse_edge = 1.0 / edge;
        let Extent { centers, .. } = extent;
        let origin = if max(centers.min.max_abs(), centers.max.max_abs()) * inverse_edge <= NEAR {
            Vec3::ZERO
        } else if (centers.max - centers.min).max_abs() / edge < FARTHEST {
            centers.min
        } else {
            median(members, balls)
        };
        let spare = Vec3::splat(SPARE);
        let clamped = |q: Vec3| q.to_array().map(|c| c.floor().clamp(-FARTHEST, FARTHEST) as i64);
        let first = clamped((centers.min - origin) * inverse_edge - spare);
        let last = clamped((centers.max - origin) * inverse_edge + spare);
        Frame { origin, edge, inverse_edge, first, count: [0, 1, 2].map(|axis| last[axis] - first[axis] + 1) }
    }

    /// Whether cells are counted from the world's origin: then every such frame has the same cells for the same largest radius,
    /// only more of them or fewer.
    pub fn is_anchored(&self) -> bool {
        self.origin == Vec3::ZERO
    }

    /// Whether all bodies of this extent are in the frame's cells wherever they are rounded to, and these of the right size.
    pub fn holds(&self, extent: &Extent) -> bool {
        let rounding = Vec3::splat(self.edge / Real::from(1_u32 << (FRACTION - 1)));
        let inside = |x: Vec3| {
            let at = self.coordinates(x);
            (0..3).all(|axis| (0..self.count[axis]).contains(&(at[axis] - self.first[axis])))
        };
        let Extent { centers, largest, .. } = extent;
        self.edge == EDGE * *largest && inside(centers.min - rounding) && inside(centers.max + rounding)
    }

    /// Whether all cells together are at most so many.
    pub fn cells_within(&self, limit: usize) -> bool {
        let mut total: usize = 1;
        self.count.iter().all(|&c| {
            total = total.saturating_mul(usize::try_from(c).unwrap_or(usize::MAX));
            total <= limit
        })
    }

    /// Coordinates of the cell that holds a position, clamped into [-2^40, 2^40].
    #[inline]
    pub fn coordinates(&self, x: Vec3) -> [i64; 3] {
        let q = (x - self.origin) * self.inverse_edge;
        q.to_array().map(|c| c.floor().clamp(-FARTHEST, FARTHEST) as i64)
    }

    /// A position within 2^36 cells from the origin. What is exactly on a border may go to either side: all that matters is that
    /// two positions less than an edge apart are not two cells apart.
    ///
    /// Adding [`SHIFT`] rounds and leaves the number in the lowest bits, at a third of the cost of a conversion.
    #[inline(always)]
    pub fn place(&self, x: Vec3) -> Place {
        let q = (x - self.origin) * self.inverse_edge + Vec3::splat(SHIFT);
        q.to_array().map(Real::to_bits)
    }

    /// Square of the distance of two places beyond which bodies do not meet.
    ///
    /// No two radii together are more than twice the largest, 2/[`EDGE`] edges. Rounding moves a coordinate by half a unit, and
    /// by 2^-53 of up to 2^36 edges, 1/32 of a unit, before that: a difference of two by less than 1.1, and the distance by
    /// less than 2. The third unit is for the roundings of this line and of the exact test.
    pub fn limit() -> i32 {
        let sum = (2.0 / EDGE * Real::from(1_u32 << FRACTION)).ceil() as i32 + 3;
        sum * sum
    }

    /// Corner of a cell, counted from the frame's first \[m\].
    pub fn corner(&self, c: [i64; 3]) -> Vec3 {
        let at = |axis: usize| (self.first[axis] + c[axis]) as Real;
        self.origin + Vec3::new(at(0), at(1), at(2)) * self.edge
    }
}

/// The cell of a coordinate of a [`Place`], its lower 32 bits.
#[inline(always)]
pub(super) fn cell_of(coordinate: u64) -> u32 {
    (coordinate >> FRACTION) as u32
}

/// Median position, axis by axis, of an even sample: where the bulk of the bodies is when some are very far away.
fn median(members: Option<&[u32]>, balls: &[Ball]) -> Vec3 {
    const SAMPLE: usize = 1023;
    let total = members.map_or(balls.len(), <[u32]>::len);
    let stride = total.div_ceil(SAMPLE).max(1);
    let slot = |k: usize| members.map_or(k, |m| m[k] as usize);
    let sample: Vec<Vec3> =
        (0..total).step_by(stride).map(|k| &balls[slot(k)]).filter(|b| !b.is_empty()).map(|b| b.center).collect();
    let mut out = Vec3::ZERO;
    for axis in 0..3 {
        let mut values: Vec<Real> = sample.iter().map(|v| v[axis]).collect();
        values.sort_by(Real::total_cmp);
        out[axis] = values.get(values.len() / 2).copied().unwrap_or(0.0);
    }
    out
}
