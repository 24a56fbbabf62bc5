//! The pair scan of a dense grid over lanes: a body is compared with eight places of a run at once. What is compared are
//! rounded centres, against a distance drawn out so far that every pair that meets passes (see
//! [`Frame::limit`](super::cells::Frame::limit)); the exact test comes after, so lanes decide the speed and no bit of the
//! result.
//!
//! The kernel is written once; AVX2 is chosen at run time where the processor has it.
#![allow(unsafe_code)]

#[cfg(target_arch = "x86_64")]
use crate::wide::has_avx2;

/// Places compared at once.
pub(super) const LANES: usize = 8;

/// Rounded centres in sorted order, and behind the last of them as many more of no meaning as there are lanes. Of every
/// coordinate the lower 16 bits are kept: the difference of two that are less than eight cells apart is right.
#[derive(Clone, Debug, Default)]
pub(super) struct Points {
    /// x in the lower half, y in the upper
    xy: Vec<u32>,
    z: Vec<u32>,
    count: usize,
}

impl Points {
    pub fn resize(&mut self, count: usize) {
        self.count = count;
        self.xy.resize(count + LANES, 0);
        self.z.resize(count + LANES, 0);
    }

    /// Coordinates, to be written.
    pub fn axes(&mut self) -> [&mut [u32]; 2] {
        [&mut self.xy[..self.count], &mut self.z[..self.count]]
    }
}

/// What the scan reads of a dense grid.
pub(super) struct Grid<'a> {
    /// for each cell, the place of its first body; one more at the end
    pub start: &'a [u32],
    /// cells along x and along x times y
    pub stride: [usize; 2],
    /// cells in sorted order
    pub cells: &'a [u32],
    /// centres in sorted order
    pub points: &'a Points,
    /// square of the distance up to which two rounded centres may belong to bodies that meet
    pub limit: i32,
}

/// The five runs of places that hold the later partners of the body at place `i` in cell `c`: the rest of its cell and the
/// cell after it, and the three cells of each of the four rows after its own.
#[inline(always)]
pub(super) fn runs(start: &[u32], [sx, sxy]: [usize; 2], i: usize, c: usize) -> [(u32, u32); 5] {
    assert!(c >= 1 && sx >= 1 && sxy >= sx && c + sxy + sx + 2 < start.len());
    // SAFETY: `c - 1` is not negative, and the largest index that is asked for is `c + sxy + sx + 2`, which is in range.
    let at = |cell: usize| unsafe { *start.get_unchecked(cell) };
    let row = |r: usize| (at(c + r - 1), at(c + r + 2));
    [(i as u32 + 1, at(c + 2)), row(sx), row(sxy - sx), row(sxy), row(sxy + sx)]
}

/// Appends the pairs of places that may meet, the first of them one of `first..last`. Returns the number of pairs of bodies in
/// the same or neighbouring cells.
pub(super) fn scan(grid: &Grid<'_>, first: usize, last: usize, near: &mut Vec<[u32; 2]>) -> u64 {
    #[cfg(target_arch = "x86_64")]
    if has_avx2() {
        // SAFETY: the processor has AVX2 and BMI2.
        return unsafe { scan_avx2(grid, first, last, near) };
    }
    scan_portable(grid, first, last, near)
}

/// The scan for every processor.
pub(super) fn scan_portable(grid: &Grid<'_>, first: usize, last: usize, near: &mut Vec<[u32; 2]>) -> u64 {
    scan_over::<Portable>(grid, first, last, near)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,bmi2")]
fn scan_avx2(grid: &Grid<'_>, first: usize, last: usize, near: &mut Vec<[u32; 2]>) -> u64 {
    scan_over::<Avx2>(grid, first, last, near)
}

/// Runs of a body: the rest of its cell and the next, and four rows.
const ROWS: usize = 4;
/// Bodies whose runs are found before any is compared, and whose findings are written down before they are looked at: guessing
/// whether a body has any costs more.
const BATCH: usize = 64;

/// One way to compare a centre with others.
trait Lanes {
    /// What is the same in every lane.
    type Spread: Copy;

    fn spread(value: u32) -> Self::Spread;

    /// One bit for each of eight places from `from` on: whether the centre may be within the limit of the one there.
    ///
    /// # Safety
    /// `from` is not above the number of points.
    unsafe fn near(center: [Self::Spread; 2], limit: Self::Spread, points: &Points, from: u32) -> u32;

    /// The same for four runs, in the order of [`place_of_bit`].
    ///
    /// # Safety
    /// As [`near`](Lanes::near), for each.
    unsafe fn near_rows(center: [Self::Spread; 2], limit: Self::Spread, points: &Points, from: [u32; ROWS]) -> u32;
}

/// Row and place in it of a bit: the lower four places of all rows, then the upper four.
#[inline(always)]
fn place_of_bit(bit: u32) -> (usize, u32) {
    (bit as usize / 4 % ROWS, bit % 4 + bit / 16 * 4)
}

/// What is known of a batch of bodies before they are compared.
struct Batch {
    /// where the runs of the rows begin, and where all five end, that of the own cell first
    from: [[u32; BATCH]; ROWS],
    to: [[u32; BATCH]; ROWS + 1],
    /// the places that belong to the runs, as bits: of the rows, and of the own cell
    rows: [u32; BATCH],
    own: [u32; BATCH],
}

/// What became of a batch.
#[derive(Default)]
struct Tally {
    tests: u32,
    longest: u32,
    /// the last place at which a run begins
    last: u32,
}

impl Batch {
    /// Finds the runs of the bodies at `first..first + cells.len()`.
    #[inline(always)]
    fn find_runs(&mut self, start: &[u32], stride: [usize; 2], first: usize, cells: &[u32]) -> Tally {
        for (k, &cell) in cells.iter().enumerate().take(BATCH) {
            let [own, rows @ ..] = runs(start, stride, first + k, cell as usize);
            self.to[0][k] = own.1;
            for (row, (from, to)) in rows.into_iter().enumerate() {
                (self.from[row][k], self.to[row + 1][k]) = (from, to);
            }
        }
        // Behind the last body all runs are empty: the loop below is always of the same length.
        for k in cells.len()..BATCH {
            self.to[0][k] = (first + k + 1) as u32;
            (0..ROWS).for_each(|row| (self.from[row][k], self.to[row + 1][k]) = (0, 0));
        }
        let mut tally = Tally::default();
        for k in 0..BATCH {
            let own = self.to[0][k] - (first + k + 1) as u32;
            let (mut sum, mut longest, mut bits, mut last) = (own, own, 0, tally.last);
            for row in 0..ROWS {
                let from = self.from[row][k];
                let length = self.to[row + 1][k] - from;
                let eight = (1_u32 << (length % 32)) - 1;
                bits |= (eight & 0xf | (eight & 0xf0) << 12) << (4 * row);
                sum += length;
                longest = longest.max(length);
                last = last.max(from);
            }
            // A longer run is looked at elsewhere.
            let fits = u32::from(longest <= LANES as u32).wrapping_neg();
            self.rows[k] = bits & fits;
            self.own[k] = ((1_u32 << (own % 32)) - 1) & 0xff & fits;
            tally.tests += sum;
            tally.longest = tally.longest.max(longest);
            tally.last = last;
        }
        tally
    }

    fn is_long(&self, k: usize, first: usize) -> bool {
        let longest = |row: usize| self.to[row + 1][k] - self.from[row][k];
        let own = self.to[0][k] - (first + k + 1) as u32;
        (0..ROWS).map(longest).fold(own, u32::max) > LANES as u32
    }

    /// The place that a bit of what was found for body `k`, at place `i`, stands for.
    #[inline(always)]
    fn place(&self, k: usize, i: u32, bit: u32) -> u32 {
        if bit as usize >= ROWS * LANES {
            return i + 1 + bit - (ROWS * LANES) as u32;
        }
        let (row, place) = place_of_bit(bit);
        self.from[row][k] + place
    }
}

#[inline(always)]
fn scan_over<L: Lanes>(grid: &Grid<'_>, first: usize, last: usize, near: &mut Vec<[u32; 2]>) -> u64 {
    let &Grid { start, stride, cells, points, limit } = grid;
    assert!(first <= last && last <= points.count);
    let limit = L::spread(limit as u32);
    let mut tests = 0_u64;
    let mut batch = Batch { from: [[0; BATCH]; ROWS], to: [[0; BATCH]; ROWS + 1], rows: [0; BATCH], own: [0; BATCH] };
    let mut marked = ([0_u32; BATCH], [0_u64; BATCH]);
    for first in (first..last).step_by(BATCH) {
        let count = BATCH.min(last - first);
        let tally = batch.find_runs(start, stride, first, &cells[first..first + count]);
        assert!(tally.last as usize <= points.count);
        tests += u64::from(tally.tests);
        let own = (&points.xy[first..first + count], &points.z[first..first + count]);
        let mut found = 0;
        for (k, (&xy, &z)) in own.0.iter().zip(own.1).enumerate().take(BATCH) {
            let center = [L::spread(xy), L::spread(z)];
            let from = [0, 1, 2, 3].map(|row| batch.from[row][k]);
            // SAFETY: no run begins after `tally.last`, and the own one begins at most at `last`; neither is above the count.
            let (rows, own) = unsafe {
                (L::near_rows(center, limit, points, from), L::near(center, limit, points, (first + k + 1) as u32))
            };
            let marks = u64::from(rows & batch.rows[k]) | u64::from(own & batch.own[k]) << (ROWS * LANES);
            (marked.0[found % BATCH], marked.1[found % BATCH]) = (k as u32, marks);
            found += usize::from(marks != 0);
        }
        for (&k, &marks) in marked.0.iter().zip(&marked.1).take(found) {
            let (mut marks, i) = (marks, first as u32 + k);
            while marks != 0 {
                near.push([i, batch.place(k as usize % BATCH, i, marks.trailing_zeros())]);
                marks &= marks - 1;
            }
        }
        if tally.longest > LANES as u32 {
            (0..count).filter(|&k| batch.is_long(k, first)).for_each(|k| long_runs(grid, first + k, near));
        }
    }
    tests
}

/// Where a run is longer than there are lanes.
#[inline(never)]
#[cold]
fn long_runs(grid: &Grid<'_>, i: usize, near: &mut Vec<[u32; 2]>) {
    let points = grid.points;
    for (from, to) in runs(grid.start, grid.stride, i, grid.cells[i] as usize) {
        let far = |place: u32| points.square(i, place as usize) > grid.limit;
        near.extend((from..to).filter(|&place| !far(place)).map(|place| [i as u32, place]));
    }
}

impl Points {
    /// Square of the distance of two places, right for bodies in neighbouring cells.
    #[inline(always)]
    fn square(&self, i: usize, k: usize) -> i32 {
        let square = |a: u32, b: u32| {
            let d = i32::from((a as i16).wrapping_sub(b as i16));
            d * d
        };
        // Two squares of 2^15 are the sum that is too large: of places behind a run, whose bits are not looked at.
        let plane = square(self.xy[k], self.xy[i]).wrapping_add(square(self.xy[k] >> 16, self.xy[i] >> 16));
        plane.wrapping_add(square(self.z[k], self.z[i]))
    }
}

/// For every processor.
struct Portable;

impl Lanes for Portable {
    type Spread = u32;

    #[inline(always)]
    fn spread(value: u32) -> u32 {
        value
    }

    #[inline(always)]
    unsafe fn near([xy, z]: [u32; 2], limit: u32, points: &Points, from: u32) -> u32 {
        let lanes = from as usize..from as usize + LANES;
        let (pxy, pz) = (&points.xy[lanes.clone()], &points.z[lanes]);
        let square = |a: u32, b: u32| {
            let d = i32::from((a as i16).wrapping_sub(b as i16));
            d * d
        };
        let mut bits = 0;
        for k in 0..LANES {
            let plane = square(pxy[k], xy).wrapping_add(square(pxy[k] >> 16, xy >> 16));
            let apart = plane.wrapping_add(square(pz[k], z)) > limit as i32;
            bits |= u32::from(!apart) << k;
        }
        bits
    }

    #[inline(always)]
    unsafe fn near_rows(center: [u32; 2], limit: u32, points: &Points, from: [u32; ROWS]) -> u32 {
        let mut bits = 0;
        for (row, from) in from.into_iter().enumerate() {
            // SAFETY: the caller's.
            let eight = unsafe { Self::near(center, limit, points, from) };
            bits |= (eight & 0xf | (eight & 0xf0) << 12) << (4 * row);
        }
        bits
    }
}

/// For processors with AVX2. Only [`scan_avx2`] uses it.
#[cfg(target_arch = "x86_64")]
struct Avx2;

#[cfg(target_arch = "x86_64")]
impl Avx2 {
    /// Ones in the lanes of the places that are not within the limit.
    ///
    /// # Safety
    /// The processor has AVX2, and `from` is not above the number of points.
    #[inline(always)]
    unsafe fn apart(
        [xy, z]: [std::arch::x86_64::__m256i; 2],
        limit: std::arch::x86_64::__m256i,
        points: &Points,
        from: u32,
    ) -> std::arch::x86_64::__m256i {
        use std::arch::x86_64::*;
        debug_assert!(from as usize <= points.count);
        // SAFETY: each axis holds `count + LANES` numbers (`resize` alone sets either), so eight of them from `from` on are
        // there.
        unsafe {
            let from_there = |axis: &Vec<u32>| _mm256_loadu_si256(axis.as_ptr().add(from as usize).cast());
            let dxy = _mm256_sub_epi16(xy, from_there(&points.xy));
            let dz = _mm256_sub_epi16(z, from_there(&points.z));
            let square = _mm256_add_epi32(_mm256_madd_epi16(dxy, dxy), _mm256_madd_epi16(dz, dz));
            _mm256_cmpgt_epi32(square, limit)
        }
    }
}

#[cfg(target_arch = "x86_64")]
impl Lanes for Avx2 {
    type Spread = std::arch::x86_64::__m256i;

    #[inline(always)]
    fn spread(value: u32) -> Self::Spread {
        // SAFETY: called from `scan_avx2` alone, so the processor has AVX2.
        unsafe { std::arch::x86_64::_mm256_set1_epi32(value as i32) }
    }

    #[inline(always)]
    unsafe fn near(center: [Self::Spread; 2], limit: Self::Spread, points: &Points, from: u32) -> u32 {
        use std::arch::x86_64::*;
        // SAFETY: called from `scan_avx2` alone, so the processor has AVX2; the rest is the caller's.
        unsafe { !_mm256_movemask_ps(_mm256_castsi256_ps(Avx2::apart(center, limit, points, from))) as u32 & 0xff }
    }

    #[inline(always)]
    unsafe fn near_rows(center: [Self::Spread; 2], limit: Self::Spread, points: &Points, from: [u32; ROWS]) -> u32 {
        use std::arch::x86_64::*;
        // SAFETY: as above.
        unsafe {
            let [a, b, c, d] = from.map(|from| Avx2::apart(center, limit, points, from));
            // Both halves of the registers are packed by themselves: this is the order of `place_of_bit`.
            let bytes = _mm256_packs_epi16(_mm256_packs_epi32(a, b), _mm256_packs_epi32(c, d));
            !_mm256_movemask_epi8(bytes) as u32
        }
    }
}
