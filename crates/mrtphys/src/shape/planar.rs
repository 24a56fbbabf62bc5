//! Polygons in a plane of space: area, planarity, simplicity, triangulation, cutting.

use super::wide::{Wide, difference};
use crate::math::{Real, Vec3, max, min};
use robust::{Coord, orient2d};

/// The area vector of a closed polygon (M. Newell): along its normal, as long as its area.
pub(super) fn area_vector(polygon: &[Vec3]) -> Vec3 {
    let Some(&o) = polygon.first() else { return Vec3::ZERO };
    polygon.windows(2).map(|w| (w[0] - o).cross(w[1] - o)).sum::<Vec3>() * 0.5
}

/// The area vector in twice the precision: the normal of a face 10^8 times as long as wide, which lies askew, would be off
/// by more than its width otherwise.
pub(super) fn area_vector_wide(polygon: &[Vec3]) -> Vec3 {
    let Some(&o) = polygon.first() else { return Vec3::ZERO };
    let mut sum = [Wide::ZERO; 3];
    for w in polygon.windows(2) {
        let (a, b) = (difference(w[0], o), difference(w[1], o));
        for (i, s) in sum.iter_mut().enumerate() {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            *s = *s + (a[j] * b[k] - a[k] * b[j]);
        }
    }
    Vec3::new(sum[0].round(), sum[1].round(), sum[2].round()) * 0.5
}

/// Offset of the plane with this normal through a polygon: the middle of the range that its corners span, so that an
/// exactly plane polygon has exactly its offset.
pub(super) fn plane_offset(normal: Vec3, polygon: &[Vec3]) -> Real {
    let (low, high) = polygon.iter().fold((Real::INFINITY, Real::NEG_INFINITY), |(low, high), p| {
        let d = normal.dot(*p);
        (min(low, d), max(high, d))
    });
    low + 0.5 * (high - low)
}

/// The polygon without its largest dimension along the normal, counter-clockwise if it was so seen against the normal.
pub(super) fn project(polygon: &[Vec3], normal: Vec3) -> Vec<Coord<Real>> {
    let a = normal.abs();
    let axis = if a.x >= a.y && a.x >= a.z { 0 } else { 1 + usize::from(a.z > a.y) };
    let (mut i, mut j) = ((axis + 1) % 3, (axis + 2) % 3);
    if normal[axis] < 0.0 {
        (i, j) = (j, i);
    }
    polygon.iter().map(|p| Coord { x: p[i], y: p[j] }).collect()
}

fn between(a: Coord<Real>, b: Coord<Real>, p: Coord<Real>) -> bool {
    p.x >= min(a.x, b.x) && p.x <= max(a.x, b.x) && p.y >= min(a.y, b.y) && p.y <= max(a.y, b.y)
}

/// Whether two segments have a point in common, exactly.
pub(super) fn segments_meet(a: Coord<Real>, b: Coord<Real>, c: Coord<Real>, d: Coord<Real>) -> bool {
    let (ac, ad) = (orient2d(a, b, c), orient2d(a, b, d));
    let (ca, cb) = (orient2d(c, d, a), orient2d(c, d, b));
    let opposite = |s: Real, t: Real| (s > 0.0 && t < 0.0) || (s < 0.0 && t > 0.0);
    (opposite(ac, ad) && opposite(ca, cb))
        || (ac == 0.0 && between(a, b, c))
        || (ad == 0.0 && between(a, b, d))
        || (ca == 0.0 && between(c, d, a))
        || (cb == 0.0 && between(c, d, b))
}

/// Whether p lies in the closed triangle a, b, c (counter-clockwise), exactly.
pub(super) fn in_triangle(p: Coord<Real>, [a, b, c]: [Coord<Real>; 3]) -> bool {
    orient2d(a, b, p) >= 0.0 && orient2d(b, c, p) >= 0.0 && orient2d(c, a, p) >= 0.0
}

/// Whether a polygon runs round once, turning left at all corners. O(k), exact: a polygon that always turns left runs
/// round as often as it has leftmost corners.
pub(super) fn is_convex_ring(p: &[Coord<Real>]) -> bool {
    let n = p.len();
    let before = |a: Coord<Real>, b: Coord<Real>| a.x < b.x || (a.x == b.x && a.y < b.y);
    let leftmost = (0..n).filter(|&i| before(p[i], p[(i + 1) % n]) && before(p[i], p[(i + n - 1) % n])).count();
    leftmost == 1 && is_strictly_convex(p)
}

/// Whether a polygon neither crosses nor touches itself. O(k^2), exact.
pub(super) fn is_simple(p: &[Coord<Real>]) -> bool {
    let n = p.len();
    for i in 0..n {
        let (a, b) = (p[i], p[(i + 1) % n]);
        let c = p[(i + 2) % n];
        // neighbours meet in their common corner only, unless the second runs back
        if orient2d(a, b, c) == 0.0 && (between(a, b, c) || between(b, c, a)) {
            return false;
        }
        for j in i + 2..n {
            if (j + 1) % n != i && segments_meet(a, b, p[j], p[(j + 1) % n]) {
                return false;
            }
        }
    }
    true
}

/// Whether all corners of a simple counter-clockwise polygon turn left, exactly.
pub(super) fn is_strictly_convex(p: &[Coord<Real>]) -> bool {
    let n = p.len();
    (0..n).all(|i| orient2d(p[i], p[(i + 1) % n], p[(i + 2) % n]) > 0.0)
}

/// Distance, as part of the polygon's extent, that a diagonal keeps from the other corners where it can.
const CLEARANCE: Real = 1e-9;

/// Triangles of a simple counter-clockwise polygon, as corner numbers: a fan from the first corner where the polygon is
/// strictly convex, else by clipping ears (G. Meisters, 1975), exact. Diagonals keep clear of other corners if possible: on
/// a face that is plane only to rounding, a diagonal through a corner would cut into the faces at that corner. `None` where
/// no ear is left: the polygon was not simple.
pub(super) fn triangulate(p: &[Coord<Real>]) -> Option<Vec<[u32; 3]>> {
    if p.len() < 3 {
        return None;
    }
    if is_strictly_convex(p) {
        return Some((1..p.len() as u32 - 1).map(|i| [0, i, i + 1]).collect());
    }
    let margin = CLEARANCE * p.iter().fold(0.0, |m, c| max(m, max((c.x - p[0].x).abs(), (c.y - p[0].y).abs())));
    let mut left: Vec<u32> = (0..p.len() as u32).collect();
    let mut triangles = Vec::with_capacity(p.len() - 2);
    while left.len() > 3 {
        let n = left.len();
        let ear =
            (0..n).find(|&i| is_ear(p, &left, i, margin)).or_else(|| (0..n).find(|&i| is_ear(p, &left, i, 0.0)))?;
        triangles.push([left[(ear + n - 1) % n], left[ear], left[(ear + 1) % n]]);
        left.remove(ear);
    }
    let [a, b, c] = [left[0], left[1], left[2]];
    if orient2d(p[a as usize], p[b as usize], p[c as usize]) <= 0.0 {
        return None;
    }
    triangles.push([a, b, c]);
    Some(triangles)
}

/// Whether the corner and its neighbours form a triangle that no other corner is in, or within the margin of.
fn is_ear(p: &[Coord<Real>], left: &[u32], corner: usize, margin: Real) -> bool {
    let n = left.len();
    let at = |i: usize| p[left[i % n] as usize];
    let t = [at(corner + n - 1), at(corner), at(corner + 1)];
    let length = |a: Coord<Real>, b: Coord<Real>| ((b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y)).sqrt();
    let reach: [Real; 3] = std::array::from_fn(|k| margin * length(t[k], t[(k + 1) % 3]));
    let near = |q| (0..3).all(|k| orient2d(t[k], t[(k + 1) % 3], q) >= -reach[k]);
    orient2d(t[0], t[1], t[2]) > max(reach[0], reach[1]) && (2..n - 1).all(|k| !near(at(corner + k)))
}

/// The parts of a convex polygon in front of and behind a plane; corners within the tolerance are on it. A part without
/// corners off the plane is empty.
pub(super) fn cut(polygon: &[Vec3], normal: Vec3, offset: Real, tolerance: Real) -> (Vec<Vec3>, Vec<Vec3>) {
    let side: Vec<i8> = polygon.iter().map(|&p| classify(normal.dot(p) - offset, tolerance)).collect();
    if !side.contains(&1) {
        return (vec![], if side.contains(&-1) { polygon.to_vec() } else { vec![] });
    }
    if !side.contains(&-1) {
        return (polygon.to_vec(), vec![]);
    }
    let (mut front, mut back) = (Vec::new(), Vec::new());
    let n = polygon.len();
    for i in 0..n {
        let j = (i + 1) % n;
        if side[i] >= 0 {
            front.push(polygon[i]);
        }
        if side[i] <= 0 {
            back.push(polygon[i]);
        }
        if side[i] * side[j] < 0 {
            let x = crossing(polygon[i], polygon[j], normal, offset);
            front.push(x);
            back.push(x);
        }
    }
    (front, back)
}

/// +1 in front, -1 behind, 0 within the tolerance.
pub(super) fn classify(distance: Real, tolerance: Real) -> i8 {
    if distance > tolerance {
        1
    } else if distance < -tolerance {
        -1
    } else {
        0
    }
}

/// Where an edge crosses a plane: the same bits from both of its faces, which run through it in opposite directions.
fn crossing(a: Vec3, b: Vec3, normal: Vec3, offset: Real) -> Vec3 {
    let (a, b) = if a.to_array() <= b.to_array() { (a, b) } else { (b, a) };
    let (da, db) = (normal.dot(a) - offset, normal.dot(b) - offset);
    a + (b - a) * (da / (da - db))
}

/// Merges convex polygons of one plane over whole common edges as long as the result is convex (S. Hertel, K. Mehlhorn,
/// 1983). Corners are equal if their coordinates are.
pub(super) fn merge_convex(mut polygons: Vec<Vec<Vec3>>, normal: Vec3, tolerance: Real) -> Vec<Vec<Vec3>> {
    let mut i = 0;
    while i < polygons.len() {
        let joined = (i + 1..polygons.len())
            .find_map(|j| join(&polygons[i], &polygons[j], normal, tolerance).map(|merged| (j, merged)));
        match joined {
            Some((j, merged)) => {
                polygons[i] = merged;
                polygons.remove(j);
                i = 0;
            }
            None => i += 1,
        }
    }
    polygons
}

/// The union of two convex polygons with a common edge, if it is convex.
fn join(a: &[Vec3], b: &[Vec3], normal: Vec3, tolerance: Real) -> Option<Vec<Vec3>> {
    let (n, m) = (a.len(), b.len());
    for i in 0..n {
        for j in 0..m {
            if a[i] != b[(j + 1) % m] || a[(i + 1) % n] != b[j] {
                continue;
            }
            // a from behind the common edge round to it, then b's other corners
            let mut all: Vec<Vec3> = (1..=n).map(|k| a[(i + k) % n]).collect();
            all.extend((2..m).map(|k| b[(j + k) % m]));
            return convex_ring(all, normal, tolerance);
        }
    }
    None
}

/// The ring without corners on the line of their neighbours, if it is convex.
fn convex_ring(ring: Vec<Vec3>, normal: Vec3, tolerance: Real) -> Option<Vec<Vec3>> {
    let n = ring.len();
    let mut kept = Vec::with_capacity(n);
    for i in 0..n {
        let (p, c, s) = (ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]);
        let chord = (s - p).try_normalize()?;
        // distance of the corner from the chord of its neighbours, positive to the outside
        match classify((c - p).dot(chord.cross(normal)), tolerance) {
            1 => kept.push(c),
            0 if (c - p).dot(chord) > 0.0 && (s - c).dot(chord) > 0.0 => {}
            _ => return None,
        }
    }
    (kept.len() >= 3).then_some(kept)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn coords(p: &[(Real, Real)]) -> Vec<Coord<Real>> {
        p.iter().map(|&(x, y)| Coord { x, y }).collect()
    }

    fn area(p: &[Coord<Real>], t: &[[u32; 3]]) -> Real {
        t.iter().map(|t| t.map(|i| p[i as usize])).map(|[a, b, c]| 0.5 * orient2d(a, b, c)).sum()
    }

    #[test]
    fn triangulation_covers_the_polygon() {
        let u = [(0.0, 0.0), (3.0, 0.0), (3.0, 3.0), (2.0, 3.0), (2.0, 1.0), (1.0, 1.0), (1.0, 3.0), (0.0, 3.0)];
        let p = coords(&u);
        let t = triangulate(&p).unwrap();
        assert_eq!((t.len(), area(&p, &t)), (6, 7.0));
        // corners in the middle of edges
        let q = coords(&[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (0.0, 1.0)]);
        let t = triangulate(&q).unwrap();
        assert_eq!((t.len(), area(&q, &t)), (4, 2.0));
        assert!(is_simple(&p) && is_simple(&q));
    }

    #[test]
    fn polygons_that_cross_or_touch_themselves() {
        let pentagram = coords(&[(0.0, 3.0), (-2.0, -3.0), (3.0, 1.0), (-3.0, 1.0), (2.0, -3.0)]);
        assert!(is_strictly_convex(&pentagram) && !is_convex_ring(&pentagram) && !is_simple(&pentagram));
        assert!(is_convex_ring(&coords(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])));
        assert!(!is_simple(&coords(&[(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)])));
        assert!(!is_simple(&coords(&[(0.0, 0.0), (2.0, 0.0), (1.0, 0.0), (1.0, 1.0)])));
        assert!(!is_simple(&coords(&[(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (1.0, 0.0), (0.0, 2.0)])));
    }

    #[test]
    fn cutting_and_joining() {
        let square = [Vec3::ZERO, Vec3::X, Vec3::X + Vec3::Y, Vec3::Y];
        let (f, b) = cut(&square, Vec3::X, 0.25, 1e-9);
        assert_eq!((area_vector(&f).z, area_vector(&b).z), (0.75, 0.25));
        assert_eq!(cut(&square, Vec3::X, 1.0, 1e-9), (vec![], square.to_vec()));
        let whole = merge_convex(vec![f.clone(), b], Vec3::Z, 1e-9);
        assert_eq!((whole.len(), whole[0].len(), area_vector(&whole[0]).z), (1, 4, 1.0));
        // an L is not convex
        let top = vec![Vec3::Y, Vec3::new(0.25, 1.0, 0.0), Vec3::new(0.25, 2.0, 0.0), Vec3::Y * 2.0];
        assert_eq!(merge_convex(vec![square.to_vec(), top], Vec3::Z, 1e-9).len(), 2);
    }
}
