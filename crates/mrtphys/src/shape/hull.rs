//! Convex hulls with exact predicates.
//!
//! Quickhull (C. Barber, D. Dobkin, H. Huhdanpaa, "The quickhull algorithm for convex hulls", ACM Trans. Math. Softw. 22
//! (1996), 469-483), but every decision is the exact sign of a determinant (J. Shewchuk, "Adaptive precision floating-point
//! arithmetic and fast robust geometric predicates", 1997), so that no tolerance is needed: a point sees a facet if it is
//! strictly above it. The facets that a point sees are then a disc whatever the input, its rim is one simple cycle, and
//! exactly coplanar points need no perturbation: a point in the plane of a facet does not see it, sees its neighbours
//! instead, and leaves coplanar triangles, which are merged at the end.

use crate::error::{Error, Result};
use crate::math::{Real, Vec3};
use robust::{Coord, Coord3D, orient2d, orient3d};

/// Most points a hull is made of.
pub const MAX_POINTS: usize = 1_000_000;
const NONE: u32 = u32::MAX;

/// A convex hull: plane polygons over the points given.
#[derive(Clone, Debug, PartialEq)]
pub struct Hull {
    /// the faces: numbers of the points given, counter-clockwise seen from outside; exactly coplanar triangles are one
    /// face, and no corner lies on the line of its neighbours
    pub faces: Vec<Vec<u32>>,
}

/// The convex hull of some points, exact: duplicates, points inside, on faces or on edges are no corners of it; every
/// point lies on or behind the plane of every face.
///
/// Coordinates below 2^-200 of the largest count as zero: products of three of them would underflow.
///
/// # Errors
/// [`Error::TooFewPoints`] below four, [`Error::LimitExceeded`] above [`MAX_POINTS`], [`Error::NonFinite`],
/// [`Error::OutOfRange`] for sizes beyond [`LARGEST_SIZE`](super::LARGEST_SIZE) and
/// [`SMALLEST_SIZE`](super::SMALLEST_SIZE), [`Error::Degenerate`] for points that span no volume.
pub fn convex_hull(points: &[Vec3]) -> Result<Hull> {
    let object = || "convex hull".to_string();
    if points.len() < 4 {
        return Err(Error::TooFewPoints { object: object(), given: points.len(), needed: 4 });
    }
    if points.len() > MAX_POINTS {
        let (given, limit) = (points.len() as u64, MAX_POINTS as u64);
        return Err(Error::LimitExceeded { object: object(), what: "points", given, limit });
    }
    super::check_points("convex hull", points)?;
    let exact = exact_points(points);
    let start = simplex(&exact).map_err(|rank| Error::Degenerate { object: object(), rank })?;
    let mut q = Quickhull::new(&exact, start);
    q.run();
    Ok(Hull { faces: q.merged_faces() })
}

/// Coordinates for exact predicates: scaled by a power of two to at most 1, and cut off where products would underflow.
pub(super) fn exact_points(points: &[Vec3]) -> Vec<Coord3D<Real>> {
    let largest = points.iter().fold(0.0, |m, p| crate::math::max(m, p.max_abs()));
    let scale = if largest > 0.0 { 1.0 / super::power_of_two(largest) } else { 1.0 };
    let cut = |x: Real| if (x * scale).abs() < 6.3e-61 { 0.0 } else { x * scale };
    points.iter().map(|p| Coord3D { x: cut(p.x), y: cut(p.y), z: cut(p.z) }).collect()
}

/// How far `d` is above the plane of a, b, c (seen counter-clockwise from above), up to a factor; the sign is exact.
#[inline]
pub(super) fn above(a: Coord3D<Real>, b: Coord3D<Real>, c: Coord3D<Real>, d: Coord3D<Real>) -> Real {
    -orient3d(a, b, c, d)
}

/// Whether three points lie on a line, exactly: they do in all three projections.
fn collinear(a: Coord3D<Real>, b: Coord3D<Real>, c: Coord3D<Real>) -> bool {
    let flat = |p: fn(Coord3D<Real>) -> Coord<Real>| orient2d(p(a), p(b), p(c)) == 0.0;
    flat(|p| Coord { x: p.x, y: p.y }) && flat(|p| Coord { x: p.y, y: p.z }) && flat(|p| Coord { x: p.z, y: p.x })
}

/// Four points that span a volume, as large as is easily had, the last one below the first three; or the rank.
fn simplex(p: &[Coord3D<Real>]) -> std::result::Result<[u32; 4], usize> {
    let v = |i: usize| Vec3::new(p[i].x, p[i].y, p[i].z);
    let farthest = |measure: &dyn Fn(usize) -> Real| {
        (0..p.len()).fold((0, -1.0), |best, i| if measure(i) > best.1 { (i, measure(i)) } else { best }).0
    };
    let a = farthest(&|i| (v(i) - v(0)).length_squared());
    let b = farthest(&|i| (v(i) - v(a)).length_squared());
    if p[a] == p[b] {
        return Err(0);
    }
    let mut c = farthest(&|i| (v(i) - v(a)).cross(v(b) - v(a)).length_squared());
    if collinear(p[a], p[b], p[c]) {
        c = (0..p.len()).find(|&i| !collinear(p[a], p[b], p[i])).ok_or(1usize)?;
    }
    let d = farthest(&|i| above(p[a], p[b], p[c], p[i]).abs());
    let height = above(p[a], p[b], p[c], p[d]);
    if height == 0.0 {
        return Err(2);
    }
    let (b, c) = if height < 0.0 { (b, c) } else { (c, b) };
    Ok([a as u32, b as u32, c as u32, d as u32])
}

/// A triangle of the growing hull.
struct Facet {
    corners: [u32; 3],
    /// the facet across the edge from corner i to corner i + 1
    across: [u32; 3],
    /// points that see this facet and were not given to another
    outside: Vec<u32>,
    /// the highest of them, and its height up to a factor
    highest: (u32, Real),
    alive: bool,
    seen_by: u32,
}

struct Quickhull<'a> {
    points: &'a [Coord3D<Real>],
    facets: Vec<Facet>,
    /// facets with points outside, first in, first out
    queue: std::collections::VecDeque<u32>,
    /// the new facet that starts at a corner of the rim
    starts_at: Vec<u32>,
}

impl<'a> Quickhull<'a> {
    fn new(points: &'a [Coord3D<Real>], [a, b, c, d]: [u32; 4]) -> Quickhull<'a> {
        let mut q =
            Quickhull { points, facets: Vec::new(), queue: Default::default(), starts_at: vec![NONE; points.len()] };
        q.add([a, b, c], [2, 3, 1]);
        q.add([a, c, d], [0, 3, 2]);
        q.add([a, d, b], [1, 3, 0]);
        q.add([b, d, c], [2, 1, 0]);
        let all: Vec<u32> = (0..points.len() as u32).collect();
        q.distribute(all, 0);
        q
    }

    fn add(&mut self, corners: [u32; 3], across: [u32; 3]) {
        self.facets.push(Facet { corners, across, outside: vec![], highest: (NONE, 0.0), alive: true, seen_by: NONE });
    }

    fn height(&self, facet: u32, point: u32) -> Real {
        let [a, b, c] = self.facets[facet as usize].corners.map(|i| self.points[i as usize]);
        above(a, b, c, self.points[point as usize])
    }

    /// Gives every point to the first facet from `first` on that it sees. A point that sees none is inside: were it to see
    /// an old facet and none of the new ones, the two facets at some rim edge would both be seen, and with them the new
    /// facet between.
    fn distribute(&mut self, points: Vec<u32>, first: usize) {
        for p in points {
            for f in first..self.facets.len() {
                let h = self.height(f as u32, p);
                if h > 0.0 {
                    let facet = &mut self.facets[f];
                    if facet.outside.is_empty() {
                        self.queue.push_back(f as u32);
                    }
                    facet.outside.push(p);
                    if h > facet.highest.1 {
                        facet.highest = (p, h);
                    }
                    break;
                }
            }
        }
    }

    fn run(&mut self) {
        while let Some(f) = self.queue.pop_front() {
            if self.facets[f as usize].alive {
                self.take(f);
            }
        }
    }

    /// Takes the highest point of a facet into the hull.
    fn take(&mut self, from: u32) {
        let apex = self.facets[from as usize].highest.0;
        let mut seen = vec![from];
        self.facets[from as usize].seen_by = apex;
        let mut rim = Vec::new();
        let mut next = 0;
        while next < seen.len() {
            let f = seen[next];
            next += 1;
            for k in 0..3 {
                let g = self.facets[f as usize].across[k];
                if self.facets[g as usize].seen_by == apex {
                    continue;
                }
                if self.height(g, apex) > 0.0 {
                    self.facets[g as usize].seen_by = apex;
                    seen.push(g);
                } else {
                    let corners = self.facets[f as usize].corners;
                    rim.push((corners[k], corners[(k + 1) % 3], g));
                }
            }
        }
        let first = self.facets.len() as u32;
        for (i, &(u, v, g)) in rim.iter().enumerate() {
            self.add([u, v, apex], [g, NONE, NONE]);
            self.starts_at[u as usize] = first + i as u32;
            let back = &mut self.facets[g as usize];
            for k in 0..3 {
                if back.corners[k] == v && back.corners[(k + 1) % 3] == u {
                    back.across[k] = first + i as u32;
                }
            }
        }
        for (i, &(_, v, _)) in rim.iter().enumerate() {
            let (this, after) = (first + i as u32, self.starts_at[v as usize]);
            self.facets[this as usize].across[1] = after;
            self.facets[after as usize].across[2] = this;
        }
        let mut orphans = Vec::new();
        for f in seen {
            let facet = &mut self.facets[f as usize];
            facet.alive = false;
            orphans.append(&mut std::mem::take(&mut facet.outside));
        }
        orphans.retain(|&p| p != apex);
        self.distribute(orphans, first as usize);
    }

    /// Merges exactly coplanar triangles and drops corners in the middle of edges. A corner is where at least three planes
    /// meet; the others lie on an edge (two) or inside a face (one).
    fn merged_faces(&self) -> Vec<Vec<u32>> {
        let n = self.facets.len();
        let mut face = vec![NONE; n];
        let mut count = 0;
        for seed in 0..n {
            if !self.facets[seed].alive || face[seed] != NONE {
                continue;
            }
            let mut stack = vec![seed as u32];
            face[seed] = count;
            while let Some(f) = stack.pop() {
                for g in self.facets[f as usize].across {
                    let coplanar =
                        || self.facets[g as usize].corners.iter().all(|&c| self.height(seed as u32, c) == 0.0);
                    if face[g as usize] == NONE && coplanar() {
                        face[g as usize] = count;
                        stack.push(g);
                    }
                }
            }
            count += 1;
        }
        // One boundary edge leaves each corner of a face: the number of faces at a corner is the number of such edges.
        let mut edges: Vec<(u32, u32, u32)> = Vec::new();
        let mut faces_at = vec![0u32; self.points.len()];
        for (f, facet) in self.facets.iter().enumerate().filter(|(_, f)| f.alive) {
            for k in 0..3 {
                if face[facet.across[k] as usize] != face[f] {
                    edges.push((face[f], facet.corners[k], facet.corners[(k + 1) % 3]));
                    faces_at[facet.corners[k] as usize] += 1;
                }
            }
        }
        edges.sort_unstable();
        edges.chunk_by(|a, b| a.0 == b.0).map(|rim| chain(rim, &faces_at)).collect()
    }
}

/// The corners of a face in order, from its boundary edges sorted by their first corner.
fn chain(rim: &[(u32, u32, u32)], faces_at: &[u32]) -> Vec<u32> {
    let mut corners = Vec::with_capacity(rim.len());
    let mut at = rim[0].1;
    for _ in 0..rim.len() {
        if faces_at[at as usize] >= 3 {
            corners.push(at);
        }
        at = rim[rim.partition_point(|e| e.1 < at)].2;
    }
    corners
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn euler(h: &Hull) -> i64 {
        let mut corners: Vec<u32> = h.faces.iter().flatten().copied().collect();
        let ends = corners.len() as i64;
        corners.sort_unstable();
        corners.dedup();
        corners.len() as i64 - ends / 2 + h.faces.len() as i64
    }

    /// Closed, Euler 2, every point exactly on or behind every face, every corner of a face exactly on it.
    fn check(points: &[Vec3]) -> Hull {
        let h = convex_hull(points).unwrap();
        assert_eq!(euler(&h), 2);
        let mut edges: Vec<(u32, u32)> = Vec::new();
        for f in &h.faces {
            assert!(f.len() >= 3);
            edges.extend((0..f.len()).map(|i| (f[i], f[(i + 1) % f.len()])));
        }
        edges.sort_unstable();
        assert!(edges.windows(2).all(|w| w[0] != w[1]));
        assert!(edges.iter().all(|&(u, v)| edges.binary_search(&(v, u)).is_ok()));
        let p = exact_points(points);
        for f in &h.faces {
            for i in 0..f.len() {
                let [a, b, c] = [f[i], f[(i + 1) % f.len()], f[(i + 2) % f.len()]].map(|i| p[i as usize]);
                assert!(!collinear(a, b, c));
                for (j, &q) in p.iter().enumerate() {
                    let s = above(a, b, c, q);
                    assert!(s <= 0.0 && (s == 0.0 || !f.contains(&(j as u32))));
                }
            }
        }
        h
    }

    fn cube() -> Vec<Vec3> {
        (0..8).map(|i| Vec3::new((i & 1) as Real, (i >> 1 & 1) as Real, (i >> 2) as Real)).collect()
    }

    #[test]
    fn cube_with_points_on_edges_faces_and_inside() {
        let mut points: Vec<Vec3> = Vec::new();
        for i in 0..125 {
            points.push(Vec3::new((i % 5) as Real, (i / 5 % 5) as Real, (i / 25) as Real));
        }
        points.extend(points.clone());
        let h = check(&points);
        assert_eq!(h.faces.len(), 6);
        assert!(h.faces.iter().all(|f| f.len() == 4));
    }

    #[test]
    fn degenerate_input_is_refused_by_rank() {
        let rank = |p: &[Vec3]| match convex_hull(p) {
            Err(Error::Degenerate { rank, .. }) => rank,
            other => panic!("{other:?}"),
        };
        let p = Vec3::new(0.1, 0.2, 0.3);
        assert_eq!(rank(&[p; 5]), 0);
        assert_eq!(rank(&[p, p * 2.0, p * 4.0, p * 8.0]), 1);
        assert_eq!(rank(&[Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::X + Vec3::Y, Vec3::ZERO]), 2);
        for n in 0..4 {
            let e = convex_hull(&cube()[..n]);
            assert_eq!(e, Err(Error::TooFewPoints { object: "convex hull".into(), given: n, needed: 4 }));
        }
        let mut c = cube();
        c[3].y = Real::INFINITY;
        assert!(matches!(convex_hull(&c), Err(Error::NonFinite { .. })));
        let tiny: Vec<Vec3> = cube().iter().map(|&p| p * 1e-60).collect();
        assert!(matches!(convex_hull(&tiny), Err(Error::OutOfRange { .. })));
        assert!(matches!(convex_hull(&vec![p; MAX_POINTS + 1]), Err(Error::LimitExceeded { .. })));
    }

    #[test]
    fn any_size_and_needles() {
        for s in [1e-50, 1e-23, 1e50] {
            let t: Vec<Vec3> = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z].iter().map(|&p| p * s).collect();
            assert_eq!(check(&t).faces.len(), 4);
        }
        let needle: Vec<Vec3> = cube().iter().map(|&p| Vec3::new(p.x, p.y * 1e-6, p.z * 1e-6)).collect();
        assert_eq!(check(&needle).faces.len(), 6);
        let slab: Vec<Vec3> = cube().iter().map(|&p| Vec3::new(p.x, p.y * 1e-6, p.z)).collect();
        assert_eq!(check(&slab).faces.len(), 6);
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 120, failure_persistence: None, rng_seed: proptest::test_runner::RngSeed::Fixed(2), ..ProptestConfig::default() })]
        /// Lattice points are full of coplanar and collinear sets; a rotation turns them into nearly coplanar ones.
        #[test]
        fn lattice_points(raw in prop::collection::vec((-2..3i32, -2..3i32, -2..3i32), 4..40), turned: bool) {
            let q = crate::math::Quat::from_axis_angle(Vec3::new(0.6, 0.0, 0.8), 0.7);
            let points: Vec<Vec3> = raw.iter().map(|&(x, y, z)| {
                let p = Vec3::new(x.into(), y.into(), z.into());
                if turned { q.rotate(p) } else { p }
            }).collect();
            if convex_hull(&points).is_ok() {
                let h = check(&points);
                // the hull of the corners is the same hull
                let mut corners: Vec<u32> = h.faces.iter().flatten().copied().collect();
                corners.sort_unstable();
                corners.dedup();
                let again = check(&corners.iter().map(|&c| points[c as usize]).collect::<Vec<_>>());
                let key = |f: &Vec<u32>| { let mut f = f.clone(); f.sort_unstable(); f };
                let mut a: Vec<_> = h.faces.iter().map(key).collect();
                let mut b: Vec<_> =
                    again.faces.iter().map(|f| key(&f.iter().map(|&c| corners[c as usize]).collect())).collect();
                a.sort();
                b.sort();
                prop_assert_eq!(a, b);
            }
        }
    }

    #[test]
    fn a_hundred_thousand_points_on_a_sphere() {
        let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
        let n = 100_000;
        let points: Vec<Vec3> = (0..n)
            .map(|i| {
                let z = 1.0 - 2.0 * (i as Real + 0.5) / n as Real;
                let (s, c) = crate::math::sin_cos(golden * i as Real);
                let r = (1.0 - z * z).sqrt();
                Vec3::new(r * c, r * s, z)
            })
            .collect();
        let start = std::time::Instant::now();
        let h = convex_hull(&points).unwrap();
        println!("hull of 1e5 points: {:?}", start.elapsed());
        assert_eq!(euler(&h), 2);
        assert!(h.faces.len() > 199_000);
    }
}
