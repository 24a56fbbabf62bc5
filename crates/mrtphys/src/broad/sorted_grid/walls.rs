//! Boundaries never enter the cells: most bodies are told clear of all of them by one comparison with a box.

use super::super::{BoundsView, Candidates};
use crate::bounds::{Aabb, Ball, BoundaryBounds};
use crate::math::{Real, Vec3, max};

/// Reports every body that reaches behind a limit or meets a bounded one, and every body with each two-sided plane.
pub(super) fn find(view: &BoundsView<'_>, out: &mut Candidates) {
    if view.boundaries.is_empty() {
        return;
    }
    let clear = clear_box(view.boundaries);
    let size = max(clear.min.max_abs(), clear.max.max_abs());
    // Where a side is open, bodies may be anywhere: none is told clear by the box.
    let allowance = if size.is_finite() { 64.0 * Real::EPSILON * size } else { Real::INFINITY };
    for (slot, ball) in view.balls.iter().enumerate() {
        if ball.is_empty() || is_clear(&clear, allowance, ball) || view.is_fixed(slot as u32) {
            continue;
        }
        out.sphere_tests += view.boundaries.len() as u64;
        for (wall, bounds) in view.boundaries.iter().enumerate() {
            if reaches(bounds, ball) {
                out.walls.push([slot as u32, wall as u32]);
            }
        }
    }
}

fn reaches(bounds: &BoundaryBounds, ball: &Ball) -> bool {
    match bounds.behind {
        Some(_) => bounds.reaches_behind(ball),
        None => bounds.reaches(ball),
    }
}

/// A ball inside of this box reaches no boundary. Empty where a boundary is not an axis-parallel half-space.
fn clear_box(boundaries: &[BoundaryBounds]) -> Aabb {
    let mut clear = Aabb::EVERYWHERE;
    for b in boundaries {
        let Some((normal, offset)) = b.behind else { return Aabb::EMPTY };
        let axis = [Vec3::X, Vec3::Y, Vec3::Z].into_iter().position(|a| normal == a || normal == -a);
        let Some(axis) = axis else { return Aabb::EMPTY };
        if normal[axis] > 0.0 {
            clear.min[axis] = max(clear.min[axis], offset);
        } else {
            clear.max[axis] = crate::math::min(clear.max[axis], -offset);
        }
    }
    clear
}

#[inline(always)]
fn is_clear(clear: &Aabb, allowance: Real, ball: &Ball) -> bool {
    // The same differences as `reaches_behind` makes, and at least its allowance for rounding: inside of the box no
    // coordinate is larger than `size`.
    let r: Real = ball.radius * (1.0 + 64.0 * Real::EPSILON) + allowance;
    let c = ball.center;
    (c.x - clear.min.x > r)
        & (clear.max.x - c.x > r)
        & (c.y - clear.min.y > r)
        & (clear.max.y - c.y > r)
        & (c.z - clear.min.z > r)
        & (clear.max.z - c.z > r)
}
