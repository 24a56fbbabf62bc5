//! Occupied cells only, sorted by their coordinates.

use super::cells::Frame;
use super::{Found, run};
use crate::bounds::{Aabb, Ball};
use crate::broad::{BoundsView, Cell};
use crate::math::Vec3;

/// Bits of a cell coordinate, which lies within +-2^40.
const BITS: u32 = 42;
const MIDDLE: i64 = 1 << 41;

/// Bodies sorted by cell, x running fastest.
#[derive(Clone, Debug, Default)]
pub(super) struct Sparse {
    frame: Frame,
    /// key of each body's cell, ascending, and its slot
    keys: Vec<(u128, u32)>,
    /// bounding spheres in sorted order
    balls: Vec<Ball>,
}

fn key(c: [i64; 3]) -> u128 {
    let bits = |v: i64| u128::from((v + MIDDLE) as u64);
    (bits(c[2]) << (2 * BITS)) | (bits(c[1]) << BITS) | bits(c[0])
}

fn coordinates(key: u128) -> [i64; 3] {
    let part = |shift: u32| ((key >> shift) as u64 & ((1 << BITS) - 1)) as i64 - MIDDLE;
    [part(0), part(BITS), part(2 * BITS)]
}

impl Sparse {
    pub fn len(&self) -> usize {
        self.keys.len()
    }

    pub fn rebuild(&mut self, frame: Frame, members: Option<&[u32]>, balls: &[Ball]) {
        self.frame = frame;
        let of = |slot: u32| (key(frame.coordinates(balls[slot as usize].center)), slot);
        self.keys.clear();
        match members {
            None => self.keys.extend((0..balls.len() as u32).map(of)),
            Some(m) => self.keys.extend(m.iter().copied().map(of)),
        }
        self.keys.sort_unstable();
        self.balls.clear();
        self.balls.extend(self.keys.iter().map(|&(_, slot)| balls[slot as usize]));
    }

    /// Pairs whose first body is one of the sorted `first..last`.
    pub fn scan(&self, first: usize, last: usize, view: &BoundsView<'_>, found: &mut Found) {
        const ROWS: [[i64; 2]; 4] = [[1, 0], [-1, 1], [0, 1], [1, 1]];
        let mut cell = u128::MAX;
        let mut runs = [(0, 0); 4];
        let mut own_end = 0;
        for i in first..last {
            let (k, slot) = self.keys[i];
            if k != cell {
                cell = k;
                let [x, y, z] = coordinates(k);
                own_end = self.after([x + 1, y, z], i);
                for (bounds, [dy, dz]) in runs.iter_mut().zip(ROWS) {
                    let from = self.place([x - 1, y + dy, z + dz]);
                    *bounds = (from, self.after([x + 1, y + dy, z + dz], from));
                }
            }
            let ball = self.balls[i];
            run((slot, &ball), self.others(i + 1, own_end), view, found);
            for (from, to) in runs {
                run((slot, &ball), self.others(from, to), view, found);
            }
        }
    }

    /// Place of the first body in a cell not before this one.
    fn place(&self, c: [i64; 3]) -> usize {
        let wanted = key(c);
        self.keys.partition_point(|&(k, _)| k < wanted)
    }

    /// Place after the last body in a cell not after this one, looked for from a place before it.
    fn after(&self, c: [i64; 3], from: usize) -> usize {
        let wanted = key(c);
        // Runs are short: a few steps find the end sooner than a bisection.
        for (k, entry) in self.keys.iter().enumerate().skip(from).take(16) {
            if entry.0 > wanted {
                return k;
            }
        }
        from + self.keys[from..].partition_point(|&(k, _)| k <= wanted)
    }

    /// The bodies of a run of places.
    #[inline(always)]
    fn others(&self, from: usize, to: usize) -> impl ExactSizeIterator<Item = (u32, &Ball)> {
        self.keys[from..to].iter().map(|k| k.1).zip(&self.balls[from..to])
    }

    /// Pairs of a body that is not in this grid and no larger than the largest in it.
    pub fn query(&self, slot: u32, view: &BoundsView<'_>, found: &mut Found) {
        let ball = &view.balls[slot as usize];
        let [x, y, z] = self.frame.coordinates(ball.center);
        for dz in -1..=1 {
            for dy in -1..=1 {
                let from = self.place([x - 1, y + dy, z + dz]);
                let to = self.after([x + 1, y + dy, z + dz], from);
                run((slot, ball), self.others(from, to), view, found);
            }
        }
    }

    pub fn cells(&self, depth: u32, out: &mut Vec<Cell>) {
        for run in self.keys.chunk_by(|a, b| a.0 == b.0) {
            let min = self.frame.corner(coordinates(run[0].0));
            let bounds = Aabb { min, max: min + Vec3::splat(self.frame.edge) };
            out.push(Cell { bounds, depth, objects: run.len() as u32 });
        }
    }
}
