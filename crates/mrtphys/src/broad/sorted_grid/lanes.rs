//! The pair scan of a dense grid over lanes: a body is compared with eight places of a run at once. What is compared are
//! rounded centres, against a distance drawn out so far that every pair that meets passes (see
//! [`Frame`](super::cells::Frame)); the exact test comes after, so lanes decide the speed and no bit of the result.
//!
//! The kernel is written once; AVX2 is chosen at run time where the processor has it. This is the only module of the simulator
//! with `unsafe` in it.
#![allow(unsafe_code)]

/// Places compared at once.
pub(super) const LANES: usize = 8;

/// Rounded centres in sorted order, and behind the last of them as many more of no meaning as there are lanes.
#[derive(Clone, Debug, Default)]
pub(super) struct Points {
    x: Vec<f32>,
    y: Vec<f32>,
    z: Vec<f32>,
    count: usize,
}

impl Points {
    pub fn resize(&mut self, count: usize) {
        self.count = count;
        for axis in [&mut self.x, &mut self.y, &mut self.z] {
            axis.resize(count + LANES, 0.0);
        }
    }

    /// Coordinates, to be written.
    pub fn axes(&mut self) -> [&mut [f32]; 3] {
        let n = self.count;
        [&mut self.x[..n], &mut self.y[..n], &mut self.z[..n]]
    }
}

/// What the scan reads of a dense grid.
pub(super) struct Grid<'a> {
    /// for each cell, the place of its first body; two more at the end
    pub start: &'a [u32],
    /// cells along x and along x times y
    pub stride: [usize; 2],
    /// cells in sorted order
    pub cells: &'a [u32],
    /// centres in sorted order
    pub points: &'a Points,
    /// square of the distance up to which two rounded centres may belong to bodies that meet
    pub limit: f32,
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
    if std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("bmi2") {
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

/// One way to compare a centre with eight others.
trait Lanes {
    /// A number, the same in every lane.
    type Spread: Copy;

    fn spread(value: f32) -> Self::Spread;

    /// One bit for each of eight places from `from` on: whether the centre may be within the limit of the one there. What is
    /// no number may.
    fn near(center: [Self::Spread; 3], limit: Self::Spread, points: &Points, from: u32) -> u32;
}

/// Bodies whose findings are written down before they are looked at: guessing whether a body has any costs more.
const BATCH: usize = 64;

#[inline(always)]
fn scan_over<L: Lanes>(grid: &Grid<'_>, first: usize, last: usize, near: &mut Vec<[u32; 2]>) -> u64 {
    let &Grid { start, stride, cells, points, limit } = grid;
    let limit = L::spread(limit);
    let mut tests = 0_usize;
    let mut marked = [(0_u32, 0_u64); BATCH];
    for batch in (first..last).step_by(BATCH) {
        let end = (batch + BATCH).min(last);
        let own = (&cells[batch..end], &points.x[batch..end], &points.y[batch..end], &points.z[batch..end]);
        let mut count = 0;
        for k in 0..end - batch {
            let i = batch + k;
            let runs = runs(start, stride, i, own.0[k] as usize);
            let center = [L::spread(own.1[k]), L::spread(own.2[k]), L::spread(own.3[k])];
            let lengths = runs.map(|(from, to)| to - from);
            tests += lengths.iter().sum::<u32>() as usize;
            // Up to 8, a length plus 7 is below 16.
            if lengths.iter().fold(0, |all, length| all | (length + LANES as u32 - 1)) >= 2 * LANES as u32 {
                long_runs::<L>(grid, i, near);
                continue;
            }
            let mut marks = 0;
            for (k, (&(from, _), length)) in runs.iter().zip(lengths).enumerate() {
                let bits = L::near(center, limit, points, from) & !(u32::MAX << length);
                marks |= u64::from(bits) << (k * LANES);
            }
            marked[count % BATCH] = (i as u32, marks);
            count += usize::from(marks != 0);
        }
        for &(i, mut marks) in &marked[..count] {
            let runs = runs(start, stride, i as usize, cells[i as usize] as usize);
            while marks != 0 {
                let bit = marks.trailing_zeros();
                marks &= marks - 1;
                near.push([i, runs[bit as usize / LANES].0 + bit % LANES as u32]);
            }
        }
    }
    tests as u64
}

/// Where a run is longer than there are lanes.
#[inline(never)]
#[cold]
fn long_runs<L: Lanes>(grid: &Grid<'_>, i: usize, near: &mut Vec<[u32; 2]>) {
    let points = grid.points;
    let center = [&points.x, &points.y, &points.z].map(|axis| L::spread(axis[i]));
    for (from, to) in runs(grid.start, grid.stride, i, grid.cells[i] as usize) {
        for place in (from..to).step_by(LANES) {
            let bits = L::near(center, L::spread(grid.limit), points, place);
            for k in (0..LANES as u32).filter(|k| bits >> k & 1 == 1 && place + k < to) {
                near.push([i as u32, place + k]);
            }
        }
    }
}

/// For every processor.
struct Portable;

impl Lanes for Portable {
    type Spread = f32;

    #[inline(always)]
    fn spread(value: f32) -> f32 {
        value
    }

    #[inline(always)]
    fn near([x, y, z]: [f32; 3], limit: f32, points: &Points, from: u32) -> u32 {
        let lanes = from as usize..from as usize + LANES;
        let (px, py, pz) = (&points.x[lanes.clone()], &points.y[lanes.clone()], &points.z[lanes]);
        let mut bits = 0;
        for k in 0..LANES {
            let (dx, dy, dz) = (px[k] - x, py[k] - y, pz[k] - z);
            let apart = dx * dx + dy * dy + dz * dz > limit;
            bits |= u32::from(!apart) << k;
        }
        bits
    }
}

/// For processors with AVX2. Only [`scan_avx2`] uses it.
#[cfg(target_arch = "x86_64")]
struct Avx2;

#[cfg(target_arch = "x86_64")]
impl Lanes for Avx2 {
    type Spread = std::arch::x86_64::__m256;

    #[inline(always)]
    fn spread(value: f32) -> Self::Spread {
        // SAFETY: called from `scan_avx2` alone, so the processor has AVX2.
        unsafe { std::arch::x86_64::_mm256_set1_ps(value) }
    }

    #[inline(always)]
    fn near([x, y, z]: [Self::Spread; 3], limit: Self::Spread, points: &Points, from: u32) -> u32 {
        use std::arch::x86_64::*;
        let from = from as usize;
        assert!(from <= points.count);
        // SAFETY: called from `scan_avx2` alone, so the processor has AVX2. Each axis holds `count + LANES` numbers (`resize`
        // alone sets either), so eight of them from `from <= count` on are there.
        unsafe {
            let from_there = |axis: &Vec<f32>| _mm256_loadu_ps(axis.as_ptr().add(from));
            let dx = _mm256_sub_ps(from_there(&points.x), x);
            let dy = _mm256_sub_ps(from_there(&points.y), y);
            let dz = _mm256_sub_ps(from_there(&points.z), z);
            let plane = _mm256_add_ps(_mm256_mul_ps(dx, dx), _mm256_mul_ps(dy, dy));
            let square = _mm256_add_ps(plane, _mm256_mul_ps(dz, dz));
            _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_NGT_UQ>(square, limit)) as u32
        }
    }
}
