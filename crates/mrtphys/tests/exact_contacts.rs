//! The exact pair routines on the library's own shapes: bodies cut into convex pieces must behave as if they were whole.

use mrtphys::bounds::placed_ball;
use mrtphys::narrow::pairs::{polyhedron_half_space, polyhedron_polyhedron, sphere_polyhedron};
use mrtphys::narrow::{Placed, Routine, Touches};
use mrtphys::shape::{LimitQuadrangle, Polyhedron, Shape, Sphere};
use mrtphys::{Mat3, Quat, Real, Vec3};
use proptest::prelude::*;
use std::sync::LazyLock;

fn seeded(cases: u32, seed: u64) -> ProptestConfig {
    let rng_seed = proptest::test_runner::RngSeed::Fixed(seed);
    ProptestConfig {
        cases,
        rng_seed,
        failure_persistence: None,
        max_global_rejects: 200_000,
        ..ProptestConfig::default()
    }
}

fn placed<'a>(shape: &'a dyn Shape, position: Vec3, rotation: &'a Mat3) -> Placed<'a> {
    let ball = placed_ball(&shape.bounding_sphere(), position, rotation);
    Placed { shape, position, rotation, ball, home_side: 0.0 }
}

fn contacts(routine: Routine, a: &Placed<'_>, b: &Placed<'_>) -> Touches {
    let mut out = Touches::default();
    routine(a, b, &mut out);
    for t in &out.list {
        assert!((t.normal.length() - 1.0).abs() < 4e-16 && t.depth >= 0.0 && t.point.is_finite() && t.point_count > 0);
    }
    out
}

/// The profile (x, y), counter-clockwise, drawn out along z from -depth to depth.
fn prism(profile: &[(Real, Real)], depth: Real) -> Polyhedron {
    let n = profile.len() as u32;
    let layer = |z: Real| profile.iter().map(move |&(x, y)| Vec3::new(x, y, z));
    let points: Vec<Vec3> = layer(-depth).chain(layer(depth)).collect();
    let mut faces: Vec<Vec<u32>> = vec![(0..n).rev().collect(), (n..2 * n).collect()];
    faces.extend((0..n).map(|i| vec![i, (i + 1) % n, n + (i + 1) % n, n + i]));
    Polyhedron::from_mesh(&points, &faces).unwrap()
}

/// A star with this many rays.
fn star(rays: usize, inner: Real) -> Vec<(Real, Real)> {
    (0..2 * rays)
        .map(|i| {
            let r = if i % 2 == 0 { 2.0 } else { inner };
            let angle = std::f64::consts::PI * i as Real / rays as Real;
            (r * libm::cos(angle), r * libm::sin(angle))
        })
        .collect()
}

const U: [(Real, Real); 8] =
    [(-1.5, -1.0), (1.5, -1.0), (1.5, 1.0), (0.5, 1.0), (0.5, 0.0), (-0.5, 0.0), (-0.5, 1.0), (-1.5, 1.0)];
const L: [(Real, Real); 6] = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 3.0), (0.0, 3.0)];
const CROSS: [(Real, Real); 12] = [
    (-1.0, -3.0),
    (1.0, -3.0),
    (1.0, -1.0),
    (3.0, -1.0),
    (3.0, 1.0),
    (1.0, 1.0),
    (1.0, 3.0),
    (-1.0, 3.0),
    (-1.0, 1.0),
    (-3.0, 1.0),
    (-3.0, -1.0),
    (-1.0, -1.0),
];

fn bodies() -> &'static [Polyhedron] {
    static ALL: LazyLock<Vec<Polyhedron>> = LazyLock::new(make_bodies);
    &ALL
}

fn make_bodies() -> Vec<Polyhedron> {
    let mut all = vec![prism(&U, 0.5), prism(&L, 0.5), prism(&CROSS, 0.5)];
    all.extend([3, 4, 5, 7].map(|rays| prism(&star(rays, 0.8), 0.5)));
    assert!(all.iter().all(|p| p.pieces().len() > 1));
    all
}

fn is_in(profile: &[(Real, Real)], x: Real, y: Real) -> bool {
    let n = profile.len();
    (0..n).fold(false, |inside, i| {
        let ((ax, ay), (bx, by)) = (profile[i], profile[(i + 1) % n]);
        inside != ((ay > y) != (by > y) && x < (bx - ax) * (y - ay) / (by - ay) + ax)
    })
}

fn any_rotation() -> impl Strategy<Value = Mat3> {
    (-1.0..1.0f64, -1.0..1.0f64, 0.2..1.0f64, 0.0..6.0f64).prop_map(|(x, y, z, angle)| {
        Quat::from_axis_angle(Vec3::new(x, y, z).try_normalize().unwrap(), angle).to_matrix()
    })
}

proptest! {
    #![proptest_config(seeded(1000, 1))]

    /// A small box on the flat top of a body of many pieces: wherever it stands, one contact with the box's own face, the
    /// top's normal and no spin. Cuts below it must not show.
    #[test]
    fn cuts_below_a_box_do_not_show(which in 0..7usize, x in -2.5..2.5f64, y in -2.5..2.5f64, turn in 0.0..6.0f64,
                                    depth in 1e-9..0.03f64, r in any_rotation(), swap: bool) {
        let profiles: Vec<Vec<(Real, Real)>> = [U.to_vec(), L.to_vec(), CROSS.to_vec()].into_iter()
            .chain([3, 4, 5, 7].map(|rays| star(rays, 0.8))).collect();
        let body = &bodies()[which];
        let small = Polyhedron::cuboid(Vec3::splat(0.2)).unwrap();
        let about = Quat::from_axis_angle(Vec3::Z, turn).to_matrix();
        // Steady: not only the corners but a ring round them is on the top.
        let on_top = (0..32).all(|i| {
            let a = std::f64::consts::PI * i as Real / 16.0;
            is_in(&profiles[which], x + 0.16 * libm::cos(a), y + 0.16 * libm::sin(a))
        });
        prop_assume!(on_top);
        let at = body.author_origin() + Vec3::new(x, y, 0.6 - depth);
        let attitude = r * about;
        let (pb, ps) = (placed(body, Vec3::ZERO, &r), placed(&small, r * at, &attitude));
        let t = if swap { contacts(polyhedron_polyhedron::touch, &ps, &pb) } else { contacts(polyhedron_polyhedron::touch, &pb, &ps) };
        prop_assert_eq!(t.list.len(), 1, "{:?}", t.list);
        let touch = t.list[0];
        let out = if swap { -touch.normal } else { touch.normal };
        prop_assert!((out - r * Vec3::Z).length() < 1e-12, "{:?}", touch);
        prop_assert!((touch.depth - depth).abs() < 1e-12 && t.points.len() == 4, "{:?} {:?}", touch, t.points);
        prop_assert!((touch.point - ps.position).cross(touch.normal).length() < 1e-12);
    }

    /// A small sphere on the flat top: one contact, straight down, whatever is cut below.
    #[test]
    fn cuts_below_a_sphere_do_not_show(which in 0..7usize, x in -2.5..2.5f64, y in -2.5..2.5f64, height in -0.3..0.19f64,
                                       r in any_rotation()) {
        let profiles: Vec<Vec<(Real, Real)>> = [U.to_vec(), L.to_vec(), CROSS.to_vec()].into_iter()
            .chain([3, 4, 5, 7].map(|rays| star(rays, 0.8))).collect();
        let body = &bodies()[which];
        prop_assume!(height.abs() > 1e-9);
        let clear = height.abs() + 0.01;
        let on_top = (0..64).all(|i| {
            let a = std::f64::consts::PI * i as Real / 32.0;
            is_in(&profiles[which], x + clear * libm::cos(a), y + clear * libm::sin(a))
        });
        prop_assume!(on_top);
        let s = Sphere::new(0.2).unwrap();
        let at = r * (body.author_origin() + Vec3::new(x, y, 0.5 + height));
        let t = contacts(sphere_polyhedron::touch, &placed(&s, at, &Mat3::IDENTITY), &placed(body, Vec3::ZERO, &r));
        prop_assert_eq!(t.list.len(), 1, "{:?}", t.list);
        prop_assert!((t.list[0].normal + r * Vec3::Z).length() < 1e-12, "{:?}", t.list);
        prop_assert!((t.list[0].depth - (0.2 - height)).abs() < 1e-12, "{:?}", t.list);
    }

    /// Against spheres a body of pieces is its surface: the deepest contact is with the nearest point of all its triangles.
    #[test]
    fn the_deepest_contact_is_the_nearest_point(which in 0..7usize, x in -3.5..3.5f64, y in -3.5..3.5f64, z in -1.2..1.2f64,
                                                radius in 0.1..0.8f64) {
        let body = &bodies()[which];
        let c = body.author_origin() + Vec3::new(x, y, z);
        let s = Sphere::new(radius).unwrap();
        let t = contacts(sphere_polyhedron::touch, &placed(&s, c, &Mat3::IDENTITY), &placed(body, Vec3::ZERO, &Mat3::IDENTITY));
        let triangle = |t: &[u32; 3]| t.map(|i| body.corners()[i as usize]);
        let distance = body.triangles().iter().map(|t| distance_to_triangle(c, triangle(t))).fold(Real::INFINITY, Real::min);
        let winding: Real = body.triangles().iter().map(|t| solid_angle(c, triangle(t))).sum();
        let inside = winding > 2.0 * std::f64::consts::PI;
        prop_assume!(distance > 1e-6 && (distance - radius).abs() > 1e-9);
        prop_assert_eq!(!t.list.is_empty(), inside || distance < radius);
        let deepest = t.list.iter().map(|t| t.depth).fold(Real::NEG_INFINITY, Real::max);
        if inside {
            prop_assert!((deepest - radius - distance).abs() < 1e-8, "{} {}", deepest - radius, distance);
            prop_assert_eq!(t.list.len(), 1);
        } else if distance < radius {
            prop_assert!((deepest - radius + distance).abs() < 1e-12, "{} {}", radius - deepest, distance);
        }
    }
}

/// Distance to a triangle, by the foot on its plane or the nearest of its sides.
fn distance_to_triangle(c: Vec3, [p, q, r]: [Vec3; 3]) -> Real {
    let n = (q - p).cross(r - p).try_normalize().unwrap();
    let foot = c - n * n.dot(c - p);
    let inner = |a: Vec3, b: Vec3| (b - a).cross(foot - a).dot(n) >= 0.0;
    if inner(p, q) && inner(q, r) && inner(r, p) {
        return (c - foot).length();
    }
    let side = |a: Vec3, b: Vec3| {
        let t = ((c - a).dot(b - a) / (b - a).dot(b - a)).clamp(0.0, 1.0);
        (a + (b - a) * t - c).length()
    };
    side(p, q).min(side(q, r)).min(side(r, p))
}

/// Solid angle of a triangle (van Oosterom and Strackee 1983): the sum over a closed surface is 4 pi inside, 0 outside.
fn solid_angle(c: Vec3, corners: [Vec3; 3]) -> Real {
    let [p, q, r] = corners.map(|x| x - c);
    let (lp, lq, lr) = (p.length(), q.length(), r.length());
    let above = p.dot(q.cross(r));
    let below = lp * lq * lr + p.dot(q) * lr + q.dot(r) * lp + r.dot(p) * lq;
    2.0 * libm::atan2(above, below)
}

/// Symmetric bodies of many pieces fall flat on a wall and on a box without turning.
#[test]
fn flat_landings_of_bodies_of_pieces_give_no_spin() {
    let ground = Polyhedron::cuboid(Vec3::new(20.0, 20.0, 1.0)).unwrap();
    let corners = [(-9.0, -9.0), (9.0, -9.0), (9.0, 9.0), (-9.0, 9.0)].map(|(x, y)| Vec3::new(x, y, 0.0));
    let (_, wall) = LimitQuadrangle::new(corners, Vec3::Z).unwrap();
    for body in bodies().iter().enumerate().filter(|(i, _)| *i != 1).map(|(_, b)| b) {
        for k in 0..40 {
            let turn = Quat::from_axis_angle(Vec3::Z, 0.37 * k as Real).to_matrix();
            let at = Vec3::new(0.3, -0.2, 0.5 - 0.01);
            let pb = placed(body, at, &turn);
            // From the hull of the body's outline, the U's point is beside its centre of mass: compare with the plain sum.
            let expected = expected_point(body, &turn, at);
            let t = contacts(polyhedron_half_space::touch, &pb, &placed(&wall, Vec3::ZERO, &Mat3::IDENTITY));
            assert_eq!(t.list.len(), 1);
            assert!((t.list[0].point - expected).cross(Vec3::Z).length() < 1e-14, "{:?} {expected:?}", t.list[0]);
            let on = placed(&ground, Vec3::new(0.0, 0.0, -0.5), &Mat3::IDENTITY);
            let t = contacts(polyhedron_polyhedron::touch, &pb, &on);
            assert_eq!(t.list.len(), 1, "{:?}", t.list);
            assert!(
                (t.list[0].depth - 0.01).abs() < 1e-12 && (t.list[0].normal + Vec3::Z).length() < 1e-12,
                "{:?}",
                t.list
            );
            assert!((t.list[0].point - expected).cross(Vec3::Z).length() < 1e-13, "{:?} {expected:?}", t.list[0]);
        }
    }
}

/// Centroid of the sides of the convex hull of the lower corners, sides weighted by length: a side is a pair of corners with
/// all others on its left.
fn expected_point(body: &Polyhedron, turn: &Mat3, at: Vec3) -> Vec3 {
    let low: Vec<Vec3> = body.corners().iter().map(|&c| at + *turn * c).filter(|p| p.z < 0.1).collect();
    let (mut sum, mut total) = (Vec3::ZERO, 0.0);
    for &p in &low {
        for &q in low.iter().filter(|&&q| q != p) {
            let left = |r: &Vec3| (q - p).cross(*r - p).z;
            let reaches_furthest = low.iter().all(|r| left(r) > 1e-12 || (*r - p).dot(*r - q) <= 1e-12);
            if low.iter().all(|r| left(r) >= -1e-12) && reaches_furthest {
                let length = (q - p).length();
                sum += (p + q) * (0.5 * length);
                total += length;
            }
        }
    }
    sum / total
}

/// Overlap of two bodies of pieces: decided by the faces and edges of all pairs of pieces, without any culling.
#[test]
fn bodies_of_pieces_meet_where_their_pieces_do() {
    let all = bodies();
    let mut state = 7u64;
    let mut random = |low: Real, high: Real| {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        low + (high - low) * (state >> 11) as Real / (1u64 << 53) as Real
    };
    let (mut hits, mut misses) = (0, 0);
    for k in 0..150 {
        let (a, b) = (&all[k % all.len()], &all[(k / 7) % all.len()]);
        let mut rotation = || {
            let axis = Vec3::new(random(-1.0, 1.0), random(-1.0, 1.0), random(0.1, 1.0)).try_normalize().unwrap();
            Quat::from_axis_angle(axis, random(0.0, 6.0)).to_matrix()
        };
        let (ra, rb) = (rotation(), rotation());
        let at = Vec3::new(random(-3.0, 3.0), random(-3.0, 3.0), random(-2.0, 2.0));
        let t = contacts(polyhedron_polyhedron::touch, &placed(a, Vec3::ZERO, &ra), &placed(b, at, &rb));
        let mut overlaps: Vec<Real> = Vec::new();
        for p in a.pieces() {
            for q in b.pieces() {
                let gap = largest_gap((p, &ra, Vec3::ZERO), (q, &rb, at));
                assert!(gap.abs() > 1e-9, "too close to call");
                if gap < 0.0 {
                    overlaps.push(-gap);
                }
            }
        }
        assert!(t.list.len() <= overlaps.len() && t.list.is_empty() == overlaps.is_empty(), "{k}");
        if overlaps.is_empty() {
            misses += 1;
        } else {
            hits += 1;
        }
        let mut features: Vec<u32> = t.list.iter().map(|t| t.feature).collect();
        features.sort_unstable();
        features.dedup();
        assert_eq!(features.len(), t.list.len(), "features must differ");
    }
    assert!(hits > 30 && misses > 30, "{hits} {misses}");
}

type PlacedPiece<'a> = (&'a mrtphys::shape::polyhedron::ConvexPiece, &'a Mat3, Vec3);

fn largest_gap(a: PlacedPiece<'_>, b: PlacedPiece<'_>) -> Real {
    let corners = |(p, r, at): PlacedPiece<'_>| p.corners.iter().map(|&c| at + *r * c).collect::<Vec<_>>();
    let normals = |(p, r, _): PlacedPiece<'_>| p.faces.iter().map(|f| *r * f.normal).collect::<Vec<_>>();
    let edges = |(p, r, _): PlacedPiece<'_>| {
        let along = |e: [u32; 2]| p.corners[e[1] as usize] - p.corners[e[0] as usize];
        p.edges.iter().map(|e| *r * along(e.ends)).collect::<Vec<_>>()
    };
    let (ca, cb, eb) = (corners(a), corners(b), edges(b));
    let mut axes = normals(a);
    axes.extend(normals(b));
    axes.extend(edges(a).iter().flat_map(|u| eb.iter().map(move |v| u.cross(*v))).filter(|n| n.length() > 1e-6));
    let gap = |n: Vec3| {
        let low = cb.iter().map(|&x| n.dot(x)).fold(Real::INFINITY, Real::min);
        low - ca.iter().map(|&x| n.dot(x)).fold(Real::NEG_INFINITY, Real::max)
    };
    axes.into_iter().filter_map(Vec3::try_normalize).flat_map(|n| [gap(n), gap(-n)]).fold(Real::NEG_INFINITY, Real::max)
}
