//! Where a cell is: the frame that turns positions into cell coordinates.

use super::Extent;
use crate::bounds::Ball;
use crate::math::{Real, Vec3};

/// Edge of a cell as a multiple of the largest radius. Above 2 by more than what rounding can do to a coordinate of up to
/// 2^40 cells, so that partners are never two cells apart. Of 2.2, 2.8, 3.4 and 4.0 the smallest is 5 to 8 % slower than the
/// others for gases of n = 16 to 100, and these differ by less than the noise: fewer cells to sort against more bodies to compare.
const EDGE: Real = 3.4;

/// Cell coordinates are kept within +-2^40. Clamping keeps neighbours neighbours, so a body farther out only shares its cell
/// with others farther out.
const FARTHEST: Real = (1_u64 << 40) as Real;

/// What the sum of two radii is drawn out by, as a part of itself and per cell along the longest axis: see [`Frame::limit`].
const ROUNDED_TEST: Real = 1.0 / (1 << 20) as Real;
const ROUNDED_CENTER: Real = 1.0 / (1 << 21) as Real;

/// Positions to cell coordinates.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Frame {
    /// corner of cell (0, 0, 0) \[m\]
    pub origin: Vec3,
    /// edge of a cell \[m\]
    pub edge: Real,
    inverse_edge: Real,
    /// cells along each axis
    pub count: [i64; 3],
}

impl Frame {
    pub fn new(extent: &Extent, members: Option<&[u32]>, balls: &[Ball]) -> Frame {
        let edge = EDGE * extent.largest;
        let size = extent.centers.max - extent.centers.min;
        let cells = size / edge;
        let origin = if cells.max_abs() < FARTHEST { extent.centers.min } else { median(members, balls) };
        let inverse_edge = 1.0 / edge;
        let count = cells.to_array().map(|c| crate::math::min(c, FARTHEST).floor() as i64 + 1);
        Frame { origin, edge, inverse_edge, count }
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

    /// Coordinates, counted from 1, of the cell that holds a position inside the frame's box.
    ///
    /// Adding 1.5 2^52 rounds to a whole number and leaves it in the lowest bits, at a third of the cost of a conversion. What
    /// is exactly on a border may go to either side: all that matters is that two positions less than an edge apart are not
    /// two cells apart.
    #[inline(always)]
    pub fn inside(&self, x: Vec3) -> [u32; 3] {
        const SHIFT: Real = 1.5 * (1_u64 << 52) as Real;
        let q = (x - self.origin) * self.inverse_edge + Vec3::splat(0.5);
        let at = |c: Real, n: i64| ((c + SHIFT).to_bits() as u32).clamp(1, n as u32);
        [at(q.x, self.count[0]), at(q.y, self.count[1]), at(q.z, self.count[2])]
    }

    /// A centre inside the frame's box, rounded, in edges of a cell.
    #[inline(always)]
    pub fn rounded(&self, x: Vec3) -> [f32; 3] {
        ((x - self.origin) * self.inverse_edge).to_array().map(|c| c as f32)
    }

    /// Square of the distance beyond which rounded centres belong to bodies that do not meet, in edges of a cell.
    ///
    /// No two radii are more than twice the largest, 2/[`EDGE`] edges. A coordinate is below `most` edges, so rounding moves it by
    /// 2^-24 `most` at most, a difference of two by 2^-23 `most` and the distance by sqrt(3) 2^-23 `most`: the sum of the radii
    /// is drawn out by 2^-21 `most`. What the operations of the test round is 8 parts in 2^24 of the square: the sum is drawn
    /// out by 16 parts more.
    pub fn limit(&self) -> f32 {
        let most = self.count.into_iter().fold(1, i64::max);
        let sum = 2.0 / EDGE * (1.0 + ROUNDED_TEST) + most as Real * ROUNDED_CENTER;
        (sum * sum) as f32
    }

    /// Corner of a cell \[m\].
    pub fn corner(&self, c: [i64; 3]) -> Vec3 {
        self.origin + Vec3::new(c[0] as Real, c[1] as Real, c[2] as Real) * self.edge
    }
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
