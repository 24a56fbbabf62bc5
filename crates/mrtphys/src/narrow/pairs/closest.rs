//! Closest points of segments, triangles and polyhedra.

use crate::math::{ROUNDING, Real, Vec3};
use crate::shape::Polyhedron;

/// The point of a segment closest to `p`.
pub(crate) fn on_segment(p: Vec3, a: Vec3, b: Vec3) -> Vec3 {
    let d = b - a;
    let along = (p - a).dot(d);
    let whole = d.length_squared();
    if along <= 0.0 {
        a
    } else if along >= whole {
        b
    } else {
        a + d * (along / whole)
    }
}

/// The point of a triangle closest to `p`: the foot of the perpendicular where that lies inside, else the closest of the
/// three sides. A foot that round-off puts outside both of two neighbours is found on their common side.
pub(crate) fn on_triangle(p: Vec3, [a, b, c]: [Vec3; 3]) -> Vec3 {
    let n = (b - a).cross(c - a);
    let nn = n.length_squared();
    let within = |u: Vec3, v: Vec3| (v - u).cross(p - u).dot(n) >= 0.0;
    if nn > 0.0 && within(a, b) && within(b, c) && within(c, a) {
        return p - n * ((p - a).dot(n) / nn);
    }
    nearer(p, nearer(p, on_segment(p, a, b), on_segment(p, b, c)), on_segment(p, c, a))
}

/// The nearer of two points; the first where they are equally near.
fn nearer(p: Vec3, u: Vec3, v: Vec3) -> Vec3 {
    if (v - p).length_squared() < (u - p).length_squared() { v } else { u }
}

/// The point of a surface closest to some point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Nearest {
    /// the point \[m\]
    pub point: Vec3,
    /// squared distance \[m2\]
    pub squared: Real,
    /// a direction out of the body there, not normalized
    pub outward: Vec3,
    /// edge i: 2 i; triangle i: 2 i + 1
    pub feature: u32,
}

/// The point of a polyhedron's surface closest to `p`, in the polyhedron's coordinates: first over the edges, then over the
/// faces (thesis, section 6.6.2). The foot on a face beats the edges of that face only, not those of others, so distances are
/// compared. `None` for a polyhedron without surface.
pub(crate) fn on_polyhedron(poly: &Polyhedron, p: Vec3) -> Option<Nearest> {
    let mut best: Option<Nearest> = None;
    let corner = |i: u32| poly.corners[i as usize];
    for (i, e) in poly.edges.iter().enumerate() {
        let point = on_segment(p, corner(e.ends[0]), corner(e.ends[1]));
        let normal = |f: u32| poly.faces[f as usize].normal;
        offer(&mut best, p, point, 2 * i as u32, || normal(e.faces[0]) + normal(e.faces[1]));
    }
    // On an edge, as far as round-off can tell: a face beside it would win or lose by chance.
    let size = poly.ball.radius + p.length();
    if best.is_some_and(|b| is_round_off(b.squared.sqrt(), size)) {
        return best;
    }
    for (i, t) in poly.triangles.iter().enumerate() {
        let [a, b, c] = t.map(corner);
        offer(&mut best, p, on_triangle(p, [a, b, c]), 2 * i as u32 + 1, || (b - a).cross(c - a));
    }
    best
}

/// Takes a point that is nearer to `p` than the best so far.
fn offer(best: &mut Option<Nearest>, p: Vec3, point: Vec3, feature: u32, outward: impl Fn() -> Vec3) {
    let squared = (point - p).length_squared();
    if best.is_none_or(|b| squared < b.squared) {
        *best = Some(Nearest { point, squared, outward: outward(), feature });
    }
}

/// Whether a point is in a polyhedron or on its surface, in the polyhedron's coordinates.
pub(crate) fn holds(poly: &Polyhedron, p: Vec3) -> bool {
    let behind = |piece: &crate::shape::polyhedron::ConvexPiece| {
        !piece.faces.is_empty() && piece.faces.iter().all(|f| f.normal.dot(p) <= f.offset)
    };
    poly.pieces.iter().any(behind)
}

/// Whether a distance between points of coordinates up to `size` is nothing but round-off, so that it has no direction.
pub(crate) fn is_round_off(distance: Real, size: Real) -> bool {
    distance <= 64.0 * ROUNDING * size
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRIANGLE: [Vec3; 3] = [Vec3::ZERO, Vec3::new(4.0, 0.0, 0.0), Vec3::new(0.0, 3.0, 0.0)];

    #[test]
    fn every_region_of_a_triangle() {
        for (p, q) in [
            ([1.0, 1.0, 5.0], [1.0, 1.0, 0.0]),
            ([-1.0, -2.0, 1.0], [0.0, 0.0, 0.0]),
            ([6.0, -1.0, 1.0], [4.0, 0.0, 0.0]),
            ([-1.0, 9.0, -1.0], [0.0, 3.0, 0.0]),
            ([2.0, -3.0, 0.5], [2.0, 0.0, 0.0]),
            ([-3.0, 2.0, 0.0], [0.0, 2.0, 0.0]),
            ([2.0 + 3.0, 1.5 + 4.0, 7.0], [2.0, 1.5, 0.0]),
        ] {
            let found = on_triangle(p.into(), TRIANGLE);
            assert!((found - Vec3::from(q)).length() < 1e-15, "{p:?}: {found:?}, not {q:?}");
        }
    }

    #[test]
    fn degenerate_segments_and_triangles_are_points_and_segments() {
        let p = Vec3::new(1.0, 2.0, 3.0);
        assert_eq!(on_segment(p, Vec3::X, Vec3::X), Vec3::X);
        assert_eq!(on_triangle(p, [Vec3::X; 3]), Vec3::X);
        assert_eq!(on_triangle(Vec3::new(0.5, 1.0, 0.0), [Vec3::ZERO, Vec3::X, Vec3::X * 2.0]), Vec3::X * 0.5);
    }
}
