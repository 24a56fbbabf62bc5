//! Clipping of faces into contact areas.
//!
//! A contact area is a convex polygon in a plane perpendicular to the contact's normal: what reaches over the reference
//! plane, projected along the normal, clipped against the sides of the reference face (Sutherland and Hodgman 1974). Its
//! corners are the manifold; the centroid of its edges, each weighted by its length, is the point at which the impact acts.
//! Weighted by length, because then corners that rounding doubles or that lie on an edge count for nothing.

use super::sat::{FLAT, Solid};
use crate::math::{Real, Vec3};

/// Memory of the clipping, kept from call to call.
#[derive(Clone, Debug, Default)]
pub(crate) struct ClipScratch {
    /// the area
    pub area: Vec<Vec3>,
    /// the polygon that clips it
    pub frame: Vec<Vec3>,
    spare: Vec<Vec3>,
    flat: Vec<(Real, Real, Vec3)>,
}

/// Centroid of the edges of a polygon, each weighted by its length; the middle of two points; the point itself. Zero for
/// none.
pub(crate) fn perimeter_centroid(points: &[Vec3]) -> Vec3 {
    match points {
        [] => Vec3::ZERO,
        [p] => *p,
        [p, q] => 0.5 * (*p + *q),
        _ => {
            let mut sum = Vec3::ZERO;
            let mut total = 0.0;
            let mut from = points[points.len() - 1];
            for &to in points {
                let length = (to - from).length();
                sum += (from + to) * length;
                total += length;
                from = to;
            }
            if total > 0.0 { sum / (2.0 * total) } else { points[0] }
        }
    }
}

/// Puts the points in order round their convex hull seen against the unit normal `n` (counter-clockwise from its tip), and
/// drops those inside (Andrew's monotone chain). The points should lie in a plane perpendicular to `n`. Points within
/// `tolerance` \[m\] of each other are one: between two that differ by rounding there is no direction, and the chain would
/// follow it.
pub(crate) fn order_round(points: &mut Vec<Vec3>, n: Vec3, tolerance: Real, scratch: &mut Vec<(Real, Real, Vec3)>) {
    if points.len() < 2 {
        return;
    }
    let u = n.any_perpendicular();
    let v = n.cross(u);
    scratch.clear();
    scratch.extend(points.iter().map(|&p| (u.dot(p), v.dot(p), p)));
    scratch.sort_unstable_by(|p, q| p.0.total_cmp(&q.0).then(p.1.total_cmp(&q.1)));
    let mut kept = 0;
    for i in 0..scratch.len() {
        let p = scratch[i];
        let before = scratch[..kept].iter().rev().take_while(|q| p.0 - q.0 <= tolerance);
        if before.into_iter().all(|q| (p.1 - q.1).abs() > tolerance) {
            scratch[kept] = p;
            kept += 1;
        }
    }
    scratch.truncate(kept);
    points.clear();
    let turns_left = |a: Vec3, b: Vec3, c: Vec3| {
        let (p, q) = (b - a, c - a);
        u.dot(p) * v.dot(q) - v.dot(p) * u.dot(q) > 0.0
    };
    let add = |points: &mut Vec<Vec3>, start: usize, p: Vec3| {
        while points.len() >= start + 2 && !turns_left(points[points.len() - 2], points[points.len() - 1], p) {
            points.pop();
        }
        points.push(p);
    };
    for &(_, _, p) in scratch.iter() {
        add(points, 0, p);
    }
    let start = points.len() - 1;
    for &(_, _, p) in scratch.iter().rev().skip(1) {
        add(points, start, p);
    }
    if points.len() > 1 {
        points.pop();
    }
}

/// Drops corners that coincide with their neighbour and corners in the middle of an edge, within `tolerance` \[m\].
pub(crate) fn clean(points: &mut Vec<Vec3>, tolerance: Real) {
    let apart = |p: Vec3, q: Vec3| (p - q).length_squared() > tolerance * tolerance;
    let mut kept = 0;
    for i in 0..points.len() {
        let p = points[i];
        if kept == 0 || apart(p, points[kept - 1]) {
            points[kept] = p;
            kept += 1;
        }
    }
    while kept > 1 && !apart(points[kept - 1], points[0]) {
        kept -= 1;
    }
    points.truncate(kept);
    let mut i = 0;
    while i < points.len() && points.len() > 2 {
        let count = points.len();
        let (before, p, after) = (points[(i + count - 1) % count], points[i], points[(i + 1) % count]);
        let chord = after - before;
        let side = p - before;
        let between = side.dot(chord) > 0.0 && (after - p).dot(chord) > 0.0;
        if between && side.cross(chord).length() <= tolerance * chord.length() {
            points.remove(i);
        } else {
            i += 1;
        }
    }
}

/// Keeps what lies at or below the plane s . x = limit; `s` need not be a unit vector, `tolerance` is in its units.
fn clip_by_plane(points: &mut Vec<Vec3>, spare: &mut Vec<Vec3>, s: Vec3, limit: Real, tolerance: Real) {
    spare.clear();
    let Some(&last) = points.last() else { return };
    let mut from = last;
    let mut from_height = s.dot(from) - limit;
    for &to in points.iter() {
        let height = s.dot(to) - limit;
        let crosses =
            (from_height > tolerance && height < -tolerance) || (from_height < -tolerance && height > tolerance);
        if crosses {
            spare.push(from + (to - from) * (from_height / (from_height - height)));
        }
        if height <= tolerance {
            spare.push(to);
        }
        from = to;
        from_height = height;
    }
    std::mem::swap(points, spare);
}

impl ClipScratch {
    /// Clips the area against the sides of the frame, a polygon counter-clockwise seen from the tip of the unit vector
    /// `axis`; a frame of two corners clips at its ends, a frame of one corner leaves that corner.
    pub fn clip_by_frame(&mut self, axis: Vec3, size: Real) {
        let tolerance = FLAT * size;
        match self.frame.as_slice() {
            [] => self.area.clear(),
            [p] => {
                let p = *p;
                if !self.area.is_empty() {
                    self.area.clear();
                    self.area.push(p);
                }
            }
            [p, q] => {
                let along = *q - *p;
                let slack = tolerance * along.length();
                clip_by_plane(&mut self.area, &mut self.spare, along, along.dot(*q), slack);
                clip_by_plane(&mut self.area, &mut self.spare, -along, -along.dot(*p), slack);
            }
            corners => {
                let mut from = corners[corners.len() - 1];
                for &to in corners {
                    let side = (to - from).cross(axis);
                    let slack = tolerance * side.length();
                    clip_by_plane(&mut self.area, &mut self.spare, side, side.dot(from), slack);
                    from = to;
                }
            }
        }
    }

    /// Makes the area the convex hull of itself seen along `n`, without doubled corners.
    pub fn round_area(&mut self, n: Vec3, size: Real) {
        order_round(&mut self.area, n, FLAT * size, &mut self.flat);
        clean(&mut self.area, FLAT * size);
    }

    /// Drops doubled corners of the area.
    pub fn clean_area(&mut self, size: Real) {
        clean(&mut self.area, FLAT * size);
    }

    /// Makes the frame the convex hull of itself seen along `n`, without doubled corners.
    pub fn round_frame(&mut self, n: Vec3, size: Real) {
        order_round(&mut self.frame, n, FLAT * size, &mut self.flat);
        clean(&mut self.frame, FLAT * size);
    }
}

/// What of a piece lies at or below the plane n . x = limit (within `tolerance`): its corners there and the points in
/// which its edges cross, all projected on the plane n . x = `level`. `shift` leads to the piece's coordinates.
pub(crate) fn project_cap(
    solid: &Solid<'_>,
    shift: Vec3,
    (n, limit, level): (Vec3, Real, Real),
    tolerance: Real,
    out: &mut Vec<Vec3>,
) {
    out.clear();
    for &c in &solid.turned.corners {
        let p = c + shift;
        let height = n.dot(p);
        if height <= limit + tolerance {
            out.push(p + n * (level - height));
        }
    }
    for e in &solid.topology.edges {
        let p = solid.turned.corners[e.ends[0] as usize] + shift;
        let q = solid.turned.corners[e.ends[1] as usize] + shift;
        let (hp, hq) = (n.dot(p) - limit, n.dot(q) - limit);
        if (hp > tolerance && hq < -tolerance) || (hp < -tolerance && hq > tolerance) {
            let x = p + (q - p) * (hp / (hp - hq));
            out.push(x + n * (level - n.dot(x)));
        }
    }
}
