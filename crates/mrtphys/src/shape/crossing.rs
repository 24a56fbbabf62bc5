//! Whether a surface meets itself where it should not. Exact: every decision is the sign of a determinant.

use super::hull::{above, exact_points};
use super::planar::{in_triangle, segments_meet};
use crate::bounds::Aabb;
use crate::math::{Real, Vec3};
use robust::{Coord, Coord3D, orient2d};

/// The first pair of triangles of a closed mesh that have more in common than the corners and edges they share: they
/// cross, touch, or lie on each other. Boxes sorted along the longest axis are compared first; O(n^2) at worst.
pub(super) fn first_crossing(corners: &[Vec3], triangles: &[[u32; 3]]) -> Option<(usize, usize)> {
    let exact = exact_points(corners);
    let boxes: Vec<Aabb> = triangles.iter().map(|t| Aabb::of_points(t.iter().map(|&i| corners[i as usize]))).collect();
    // along the longest axis, where fewest overlap
    let whole = boxes.iter().fold(Aabb::EMPTY, |a, b| a.union(b));
    let extent = whole.max - whole.min;
    let axis = (1..3).fold(0, |a, k| if extent[k] > extent[a] { k } else { a });
    let mut order: Vec<usize> = (0..triangles.len()).collect();
    order.sort_by(|&i, &j| boxes[i].min[axis].total_cmp(&boxes[j].min[axis]).then(i.cmp(&j)));
    let mut found: Option<(usize, usize)> = None;
    for (k, &i) in order.iter().enumerate() {
        for &j in order[k + 1..].iter().take_while(|&&j| boxes[j].min[axis] <= boxes[i].max[axis]) {
            let pair = (i.min(j), i.max(j));
            if boxes[i].meets(&boxes[j])
                && found.is_none_or(|f| pair < f)
                && triangles_meet(&exact, triangles[pair.0], triangles[pair.1])
            {
                found = Some(pair);
            }
        }
    }
    found
}

/// Whether two triangles have a point in common beyond the corners and the edge they share.
fn triangles_meet(p: &[Coord3D<Real>], s: [u32; 3], t: [u32; 3]) -> bool {
    let shared: Vec<u32> = s.iter().copied().filter(|c| t.contains(c)).collect();
    let corners = |t: [u32; 3]| t.map(|i| p[i as usize]);
    match shared.len() {
        0 => (0..3).any(|k| {
            segment_meets(p[s[k] as usize], p[s[(k + 1) % 3] as usize], corners(t))
                || segment_meets(p[t[k] as usize], p[t[(k + 1) % 3] as usize], corners(s))
        }),
        1 => {
            // An intersection that reaches beyond the common corner leaves one of the triangles through its far edge.
            let far = |t: [u32; 3]| {
                let k = t.iter().position(|&c| c == shared[0]).unwrap_or(0);
                (p[t[(k + 1) % 3] as usize], p[t[(k + 2) % 3] as usize])
            };
            let ((a, b), (c, d)) = (far(s), far(t));
            segment_meets(a, b, corners(t)) || segment_meets(c, d, corners(s))
        }
        2 => {
            let lone = |t: [u32; 3]| t.iter().copied().find(|c| !shared.contains(c)).map(|c| p[c as usize]);
            match (lone(s), lone(t)) {
                (Some(a), Some(b)) => folded(p[shared[0] as usize], p[shared[1] as usize], a, b),
                _ => true,
            }
        }
        _ => true,
    }
}

/// Whether the triangles u, v, a and u, v, b lie on each other.
fn folded(u: Coord3D<Real>, v: Coord3D<Real>, a: Coord3D<Real>, b: Coord3D<Real>) -> bool {
    if above(u, v, a, b) != 0.0 {
        return false;
    }
    let [u, v, a, b] = flat([u, v, a], [u, v, a, b]);
    (orient2d(u, v, a) > 0.0) == (orient2d(u, v, b) > 0.0)
}

/// Points of the plane of a triangle without the coordinate along which the triangle is seen largest; the triangle
/// becomes counter-clockwise.
fn flat<const N: usize>(t: [Coord3D<Real>; 3], points: [Coord3D<Real>; N]) -> [Coord<Real>; N] {
    let views: [fn(Coord3D<Real>) -> Coord<Real>; 3] =
        [|p| Coord { x: p.x, y: p.y }, |p| Coord { x: p.y, y: p.z }, |p| Coord { x: p.z, y: p.x }];
    let area = |k: usize| orient2d(views[k](t[0]), views[k](t[1]), views[k](t[2]));
    let best = (1..3).fold(0, |b, k| if area(k).abs() > area(b).abs() { k } else { b });
    let flip = area(best) < 0.0;
    points.map(views[best]).map(|c| if flip { Coord { x: c.y, y: c.x } } else { c })
}

/// Whether a segment and a closed triangle have a point in common.
fn segment_meets(a: Coord3D<Real>, b: Coord3D<Real>, t: [Coord3D<Real>; 3]) -> bool {
    let (sa, sb) = (above(t[0], t[1], t[2], a), above(t[0], t[1], t[2], b));
    if (sa > 0.0 && sb > 0.0) || (sa < 0.0 && sb < 0.0) {
        return false;
    }
    if sa == 0.0 && sb == 0.0 {
        let [a, b, t0, t1, t2] = flat(t, [a, b, t[0], t[1], t[2]]);
        return in_triangle(a, [t0, t1, t2])
            || segments_meet(a, b, t0, t1)
            || segments_meet(a, b, t1, t2)
            || segments_meet(a, b, t2, t0);
    }
    let turn: [Real; 3] = std::array::from_fn(|k| above(a, b, t[k], t[(k + 1) % 3]));
    turn.iter().all(|&s| s >= 0.0) || turn.iter().all(|&s| s <= 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn meet(s: [[Real; 3]; 3], t: [[Real; 3]; 3]) -> bool {
        // equal points are the same corner
        let mut corners: Vec<Vec3> = Vec::new();
        let mut number = |p: [Real; 3]| {
            let p = Vec3::from(p);
            corners.iter().position(|&c| c == p).unwrap_or_else(|| {
                corners.push(p);
                corners.len() - 1
            }) as u32
        };
        let (s, t) = (s.map(&mut number), t.map(&mut number));
        let both = first_crossing(&corners, &[s, t]).is_some();
        assert_eq!(both, first_crossing(&corners, &[[t[1], t[2], t[0]], [s[2], s[1], s[0]]]).is_some());
        both
    }

    #[test]
    fn pairs_of_triangles() {
        let t = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        // no common corner: crossing, touching, apart, coplanar inside, coplanar apart
        assert!(meet(t, [[0.2, 0.2, -1.0], [0.2, 0.2, 1.0], [2.0, 2.0, 0.0]]));
        assert!(meet(t, [[0.2, 0.2, 0.0], [0.2, 0.2, 1.0], [2.0, 2.0, 1.0]]));
        assert!(!meet(t, [[0.2, 0.2, 0.01], [0.2, 0.2, 1.0], [2.0, 2.0, 1.0]]));
        assert!(meet(t, [[0.2, 0.2, 0.0], [0.3, 0.2, 0.0], [0.2, 0.3, 0.0]]));
        assert!(!meet(t, [[2.0, 0.2, 0.0], [3.0, 0.2, 0.0], [2.0, 0.3, 0.0]]));
        // one common corner: only there; through the other; coplanar beside and on each other
        assert!(!meet(t, [[0.0, 0.0, 0.0], [-1.0, 0.0, 1.0], [-1.0, 1.0, 1.0]]));
        assert!(meet(t, [[0.0, 0.0, 0.0], [0.5, 0.2, 0.5], [0.2, 0.5, -0.5]]));
        assert!(!meet(t, [[0.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]]));
        assert!(meet(t, [[0.0, 0.0, 0.0], [0.5, 0.1, 0.0], [0.1, 0.5, 0.0]]));
        // a common edge: a roof, flat, folded back
        assert!(!meet(t, [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.1]]));
        assert!(!meet(t, [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, -1.0, 0.0]]));
        assert!(meet(t, [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.3, 0.5, 0.0]]));
        assert!(meet(t, t));
    }
}
