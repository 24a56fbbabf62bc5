//! One look at every body: how far the bodies reach, and which of them reach a boundary. Boundaries never enter the cells: most
//! bodies are told clear of all of them by one comparison with a box.

use super::super::{BoundsView, Candidates};
use super::Extent;
use crate::bounds::{Aabb, Ball, BoundaryBounds};
use crate::math::{Real, Vec3, max, min};
use crate::par;
use crate::wide::{self, Loop};
use std::ops::Range;

/// What was seen of some bodies.
#[derive(Clone, Debug, Default)]
pub(super) struct Seen {
    extent: Extent,
    /// slots of bodies that the box does not tell clear
    near: Vec<u32>,
    walls: Vec<[u32; 2]>,
    tests: u64,
}

/// Reports every body that reaches behind a limit or meets a bounded one, and every body with each two-sided plane. Returns
/// the extent of all bodies that are not empty; `None`: there is none.
pub(super) fn survey(view: &BoundsView<'_>, seen: &mut Vec<Seen>, out: &mut Candidates) -> Option<Extent> {
    let clear = Clear::of(view.boundaries);
    let blocks = par::ranges_into(view.balls.len(), par::stream_block(view.balls.len()), seen, |range, seen| {
        seen.clear();
        seen.look(&clear, range, view);
    });
    Seen::report(seen[..blocks].iter(), out)
}

impl Seen {
    pub fn clear(&mut self) {
        self.extent = Extent::default();
        self.walls.clear();
        self.tests = 0;
    }

    /// Puts together what was seen of all bodies.
    pub fn report<'a>(all: impl Iterator<Item = &'a Seen>, out: &mut Candidates) -> Option<Extent> {
        let mut extent = Extent::default();
        for some in all {
            extent.join(&some.extent);
            out.walls.extend_from_slice(&some.walls);
            out.sphere_tests += some.tests;
        }
        (extent.count > 0).then_some(extent)
    }

    /// Looks at some more bodies.
    pub fn look(&mut self, clear: &Clear, range: Range<usize>, view: &BoundsView<'_>) {
        self.near.clear();
        let balls = &view.balls[range.clone()];
        let (low, high) = wide::run(LookOver { clear, balls, first: range.start as u32, near: &mut self.near });
        let extent = if low[3] >= 0.0 { Extent::between(low, high, balls.len()) } else { Extent::of(balls) };
        self.extent.join(&extent);
        for &slot in &self.near {
            let ball = &view.balls[slot as usize];
            if ball.is_empty() || view.is_fixed(slot) {
                continue;
            }
            self.tests += view.boundaries.len() as u64;
            for (wall, bounds) in view.boundaries.iter().enumerate() {
                if reaches(bounds, ball) {
                    self.walls.push([slot, wall as u32]);
                }
            }
        }
    }
}

/// Finds the least and the largest of three coordinates and the radius of some balls, and notes the slots, counted from `first`,
/// of those that are not told clear of the boundaries.
struct LookOver<'a> {
    clear: &'a Clear,
    balls: &'a [Ball],
    first: u32,
    near: &'a mut Vec<u32>,
}

impl Loop for LookOver<'_> {
    type Output = ([Real; 4], [Real; 4]);

    #[inline(always)]
    fn run(self) -> ([Real; 4], [Real; 4]) {
        // Four numbers a ball, side by side: what processors compare at once.
        let (mut low, mut high) = ([Real::INFINITY; 4], [Real::NEG_INFINITY; 4]);
        for (k, ball) in self.balls.iter().enumerate() {
            let four = [ball.center.x, ball.center.y, ball.center.z, ball.radius];
            for axis in 0..4 {
                low[axis] = min(low[axis], four[axis]);
                high[axis] = max(high[axis], four[axis]);
            }
            if !self.clear.holds(&four) {
                self.near.push(self.first + k as u32);
            }
        }
        (low, high)
    }
}

fn reaches(bounds: &BoundaryBounds, ball: &Ball) -> bool {
    match bounds.behind {
        Some(_) => bounds.reaches_behind(ball),
        None => bounds.reaches(ball),
    }
}

/// Where no boundary is reached.
pub(super) struct Clear {
    /// a ball inside of this box reaches no boundary; empty where a boundary is not an axis-parallel half-space. The fourth
    /// axis, that of the radius, is without end
    min: [Real; 4],
    max: [Real; 4],
    /// how far inside it must be beyond its radius \[m\]
    allowance: Real,
}

impl Clear {
    pub fn of(boundaries: &[BoundaryBounds]) -> Clear {
        let bounds = clear_box(boundaries);
        let size = max(bounds.min.max_abs(), bounds.max.max_abs());
        // Where a side is open, bodies may be anywhere: none is told clear by the box. Without boundaries all are clear.
        let allowance = match (boundaries.is_empty(), size.is_finite()) {
            (true, _) => 0.0,
            (false, true) => 64.0 * Real::EPSILON * size,
            (false, false) => Real::INFINITY,
        };
        let four = |v: Vec3, w: Real| [v.x, v.y, v.z, w];
        Clear { min: four(bounds.min, Real::NEG_INFINITY), max: four(bounds.max, Real::INFINITY), allowance }
    }

    /// Whether a ball, its centre and its radius, is told clear.
    #[inline(always)]
    fn holds(&self, ball: &[Real; 4]) -> bool {
        // The same differences as `reaches_behind` makes, and at least its allowance for rounding: inside of the box no
        // coordinate is larger than `size`.
        let r: Real = ball[3] * (1.0 + 64.0 * Real::EPSILON) + self.allowance;
        let clear = |axis: usize| (ball[axis] - self.min[axis] > r) & (self.max[axis] - ball[axis] > r);
        clear(0) & clear(1) & clear(2) & clear(3)
    }
}

/// The box between the boundaries, see [`Clear`].
fn clear_box(boundaries: &[BoundaryBounds]) -> Aabb {
    let mut clear = Aabb::EVERYWHERE;
    for b in boundaries {
        let Some((normal, offset)) = b.behind else { return Aabb::EMPTY };
        let axis = [Vec3::X, Vec3::Y, Vec3::Z].into_iter().position(|a| normal == a || normal == -a);
        let Some(axis) = axis else { return Aabb::EMPTY };
        if normal[axis] > 0.0 {
            clear.min[axis] = max(clear.min[axis], offset);
        } else {
            clear.max[axis] = min(clear.max[axis], -offset);
        }
    }
    clear
}
