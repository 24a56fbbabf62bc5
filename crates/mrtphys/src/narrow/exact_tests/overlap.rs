//! Overlap, depth and normal of polyhedra against the full list of axes, without culling.

use super::bodies::*;
use crate::math::{Mat3, Real, Vec3};
use crate::narrow::pairs::{polyhedron_polyhedron, polyhedron_quadrangle, quadrangle_quadrangle};
use crate::narrow::{Placed, Touches};
use crate::shape::Polyhedron;

fn corners(p: &Placed<'_>) -> Vec<Vec3> {
    let shape = p.shape.downcast::<Polyhedron>().unwrap();
    shape.corners.iter().map(|&c| p.position + *p.rotation * c).collect()
}

fn normals(p: &Placed<'_>) -> Vec<Vec3> {
    p.shape.downcast::<Polyhedron>().unwrap().pieces[0].faces.iter().map(|f| *p.rotation * f.normal).collect()
}

fn edges(p: &Placed<'_>) -> Vec<Vec3> {
    let piece = &p.shape.downcast::<Polyhedron>().unwrap().pieces[0];
    let along = |e: &[u32; 2]| piece.corners[e[1] as usize] - piece.corners[e[0] as usize];
    piece.edges.iter().map(|e| *p.rotation * along(&e.ends)).collect()
}

fn gap(a: &[Vec3], b: &[Vec3], n: Vec3) -> Real {
    let low = b.iter().map(|&x| n.dot(x)).fold(Real::INFINITY, Real::min);
    let high = a.iter().map(|&x| n.dot(x)).fold(Real::NEG_INFINITY, Real::max);
    low - high
}

/// The largest gap along any normal of a face or cross product of edges, either way round. The Minkowski difference of two
/// convex polyhedra is bounded by planes with these normals only.
fn largest_gap(a: &Placed<'_>, b: &Placed<'_>) -> Real {
    let (ca, cb) = (corners(a), corners(b));
    let crossed = edges(a).into_iter().flat_map(|u| edges(b).into_iter().map(move |v| u.cross(v)));
    let all = normals(a).into_iter().chain(normals(b)).chain(crossed);
    all.filter(|n| n.length() > 1e-6)
        .filter_map(Vec3::try_normalize)
        .flat_map(|n| [gap(&ca, &cb, n), gap(&ca, &cb, -n)])
        .fold(Real::NEG_INFINITY, Real::max)
}

/// How far a point is outside of a placed convex polyhedron.
fn outside(p: &Placed<'_>, x: Vec3) -> Real {
    let local = p.rotation.transpose_mul(x - p.position);
    let faces = &p.shape.downcast::<Polyhedron>().unwrap().pieces[0].faces;
    faces.iter().map(|f| f.normal.dot(local) - f.offset).fold(Real::NEG_INFINITY, Real::max)
}

fn check(a: &Placed<'_>, b: &Placed<'_>) -> Option<Real> {
    let expected = largest_gap(a, b);
    let touches = contacts(polyhedron_polyhedron::touch, a, b);
    if touches.list.is_empty() {
        assert!(expected > -1e-12, "missed an overlap of {expected}");
        return None;
    }
    assert!(expected < 1e-12, "contact across a gap of {expected}");
    assert_eq!(touches.list.len(), 1);
    let t = touches.list[0];
    assert!((t.depth + expected).abs() < 3e-9, "depth {} instead of {}", t.depth, -expected);
    let (ca, cb) = (corners(a), corners(b));
    assert!((gap(&ca, &cb, t.normal) + t.depth).abs() < 1e-13, "depth is not along the normal");
    let middle = 0.5
        * (ca.iter().map(|&x| t.normal.dot(x)).fold(Real::NEG_INFINITY, Real::max)
            + cb.iter().map(|&x| t.normal.dot(x)).fold(Real::INFINITY, Real::min));
    for &x in touches.points.iter().chain([&t.point]) {
        if touches.points.len() > 1 {
            assert!((t.normal.dot(x) - middle).abs() < 1e-13, "not half-way between the surfaces");
        }
        // Half-way and above each other: no further from either body than the overlap is deep.
        assert!(outside(a, x) <= t.depth + 1e-12 && outside(b, x) <= t.depth + 1e-12, "off the bodies: {t:?}");
    }
    check_swapped(a, b, &touches);
    Some(t.depth)
}

fn check_swapped(a: &Placed<'_>, b: &Placed<'_>, touches: &Touches) {
    let swapped = contacts(polyhedron_polyhedron::touch, b, a);
    let (t, s) = (touches.list[0], swapped.list[0]);
    assert!(close(t.normal, -s.normal, 1e-15), "{t:?} {s:?}");
    assert!(close(t.point, s.point, 1e-12), "{t:?} {s:?}");
    assert!((t.depth - s.depth).abs() < 1e-15);
}

#[test]
fn depth_is_the_least_over_all_axes() {
    let mut dice = Dice::new(1);
    let (mut hits, mut misses, mut deep) = (0, 0, 0);
    for _ in 0..3000 {
        let (a, b) = (any_body(&mut dice), any_body(&mut dice));
        let (ra, rb) = (dice.rotation(), dice.rotation());
        let at = dice.vector(3.0);
        let distance = dice.within(0.0, 2.0);
        let b_at = at + dice.direction() * distance;
        match check(&placed(&a, at, &ra), &placed(&b, b_at, &rb)) {
            Some(depth) => {
                hits += 1;
                deep += (depth > 0.5) as u32;
            }
            None => misses += 1,
        }
    }
    assert!(hits > 500 && misses > 500 && deep > 100, "{hits} {misses} {deep}");
}

#[test]
fn bodies_inside_bodies_leave_by_the_shortest_way() {
    let mut dice = Dice::new(2);
    for _ in 0..500 {
        let (a, b) = (any_body(&mut dice), any_body(&mut dice));
        let tiny = hull(&b.corners.iter().map(|&c| c * 0.01).collect::<Vec<_>>());
        let (ra, rb) = (dice.rotation(), dice.rotation());
        let at = ra * (a.corners.iter().copied().sum::<Vec3>() / a.corners.len() as Real) + dice.vector(0.02);
        assert!(check(&placed(&a, Vec3::ZERO, &ra), &placed(&tiny, at, &rb)).is_some());
    }
}

#[test]
fn moved_apart_by_the_depth_they_just_touch() {
    let mut dice = Dice::new(3);
    let mut count = 0;
    while count < 1000 {
        let (a, b) = (any_body(&mut dice), any_body(&mut dice));
        let (ra, rb) = (dice.rotation(), dice.rotation());
        let at = dice.direction() * dice.within(0.2, 1.5);
        let pa = placed(&a, Vec3::ZERO, &ra);
        let Some(t) = contacts(polyhedron_polyhedron::touch, &pa, &placed(&b, at, &rb)).list.first().copied() else {
            continue;
        };
        count += 1;
        let apart = at + t.normal * (t.depth * (1.0 + 1e-9) + 1e-12);
        assert!(contacts(polyhedron_polyhedron::touch, &pa, &placed(&b, apart, &rb)).list.is_empty());
        let near = at + t.normal * (t.depth * (1.0 - 1e-9) - 1e-12);
        check(&pa, &placed(&b, near, &rb)).expect("still touching");
    }
}

#[test]
fn touching_counts() {
    let (a, i) = (cuboid(0.5, 0.5, 0.5), Mat3::IDENTITY);
    for (at, normal) in [
        (Vec3::new(1.0, 0.25, 0.0), Vec3::X),
        (Vec3::new(-1.0, 0.0, 0.0), -Vec3::X),
        (Vec3::new(1.0, 1.0, 0.0), Vec3::new(1.0, 1.0, 0.0).try_normalize().unwrap()),
        (Vec3::new(1.0, -1.0, 1.0), Vec3::new(1.0, -1.0, 1.0).try_normalize().unwrap()),
    ] {
        let t = contacts(polyhedron_polyhedron::touch, &placed(&a, Vec3::ZERO, &i), &placed(&a, at, &i));
        assert_eq!(t.list.len(), 1, "{at:?}");
        assert!(t.list[0].depth < 1e-15 && close(t.list[0].normal, normal, 1e-15), "{at:?} {t:?}");
        let apart = at * (1.0 + 4.0 * Real::EPSILON);
        assert!(
            contacts(polyhedron_polyhedron::touch, &placed(&a, Vec3::ZERO, &i), &placed(&a, apart, &i)).list.is_empty()
        );
    }
}

/// Corner on corner, edge on parallel edge, diagonal overlap: several normals are equally good, and none may turn a body
/// that comes straight.
#[test]
fn symmetric_meetings_give_no_spin() {
    let i = Mat3::IDENTITY;
    let a = cuboid(0.5, 0.5, 0.5);
    let along = |v: Vec3| v.try_normalize().unwrap();
    let quarter = crate::math::Quat::from_axis_angle(Vec3::Z, std::f64::consts::FRAC_PI_4).to_matrix();
    let tip = Vec3::new(0.99 * 0.5 * std::f64::consts::SQRT_2 * 2.0, 0.0, 0.0);
    let cases = [
        ("corner on corner", &i, Vec3::new(0.9, 0.9, 0.9)),
        ("diagonal", &i, Vec3::new(-0.9, 0.0, 0.9)),
        ("edge on edge", &quarter, tip),
    ];
    for (name, r, at) in cases {
        let t = contacts(polyhedron_polyhedron::touch, &placed(&a, Vec3::ZERO, r), &placed(&a, at, r));
        assert_eq!(t.list.len(), 1, "{name}");
        let t = t.list[0];
        assert!(close(t.normal, along(at), 1e-15), "{name}: {t:?}");
        assert!(
            t.point.cross(t.normal).length() < 1e-15 && (t.point - at).cross(t.normal).length() < 1e-15,
            "{name}: {t:?}"
        );
    }
}

/// An edge that meets a face along its whole length, the body above balanced on it.
#[test]
fn an_edge_flat_on_a_face_gives_no_spin() {
    let (a, b) = (cuboid(2.0, 0.5, 2.0), cuboid(0.5, 0.5, 0.5));
    let quarter = crate::math::Quat::from_axis_angle(Vec3::Z, std::f64::consts::FRAC_PI_4).to_matrix();
    for depth in [0.0, 1e-13, 1e-6, 0.01, 0.1] {
        let up = Vec3::new(0.25, 0.5 + std::f64::consts::FRAC_1_SQRT_2 - depth - 1e-16, 0.5);
        let t =
            contacts(polyhedron_polyhedron::touch, &placed(&a, Vec3::ZERO, &Mat3::IDENTITY), &placed(&b, up, &quarter));
        let t = t.list[0];
        assert!(close(t.normal, Vec3::Y, 1e-15) && (t.depth - depth).abs() < 1e-15);
        assert!((t.point - up).cross(t.normal).length() < 1e-14, "{depth}: {t:?}");
    }
}

#[test]
fn identical_poses_have_a_defined_result() {
    let mut dice = Dice::new(4);
    for _ in 0..200 {
        let a = any_body(&mut dice);
        let r = dice.rotation();
        let at = dice.vector(2.0);
        let p = placed(&a, at, &r);
        let t = contacts(polyhedron_polyhedron::touch, &p, &p);
        assert_eq!(t.list.len(), 1);
        assert!((t.list[0].depth + largest_gap(&p, &p)).abs() < 3e-9);
        assert_eq!(t.list, contacts(polyhedron_polyhedron::touch, &p, &p).list);
    }
}

#[test]
fn scaling_by_powers_of_two_scales_the_result_exactly() {
    let mut dice = Dice::new(5);
    let mut hits = 0;
    for _ in 0..500 {
        let (a, b) = (any_body(&mut dice), any_body(&mut dice));
        let (ra, rb) = (dice.rotation(), dice.rotation());
        let (pa, pb) = (dice.vector(1.0), dice.vector(1.0));
        let plain = contacts(polyhedron_polyhedron::touch, &placed(&a, pa, &ra), &placed(&b, pb, &rb));
        hits += plain.list.len();
        for k in [-40, 40, 160] {
            let s = libm::ldexp(1.0, k);
            let (a, b) = (scaled(&a, s), scaled(&b, s));
            let big = contacts(polyhedron_polyhedron::touch, &placed(&a, pa * s, &ra), &placed(&b, pb * s, &rb));
            assert_eq!(plain.list.len(), big.list.len());
            for (t, u) in plain.list.iter().zip(&big.list) {
                assert_eq!((t.normal, t.point * s, t.depth * s, t.feature), (u.normal, u.point, u.depth, u.feature));
            }
            assert!(plain.points.iter().zip(&big.points).all(|(p, q)| *p * s == *q));
        }
    }
    assert!(hits > 200);
}

fn scaled(p: &Polyhedron, s: Real) -> Polyhedron {
    let mut p = p.clone();
    p.corners.iter_mut().for_each(|c| *c = *c * s);
    p.ball.center = p.ball.center * s;
    p.ball.radius *= s;
    for piece in &mut p.pieces {
        piece.corners.iter_mut().for_each(|c| *c = *c * s);
        piece.faces.iter_mut().for_each(|f| f.offset *= s);
        piece.ball.center = piece.ball.center * s;
        piece.ball.radius *= s;
    }
    p
}

#[test]
fn quadrangles_are_thin_and_two_sided() {
    let (q, b, i) = (plate(1.0, 1.0), cuboid(0.25, 0.25, 0.25), Mat3::IDENTITY);
    for (y, sign) in [(0.2, 1.0), (-0.2, -1.0), (0.25, 1.0), (-0.25, -1.0)] {
        let at = Vec3::new(0.5, y, -0.5);
        let t = contacts(polyhedron_quadrangle::touch, &placed(&b, at, &i), &placed(&q, Vec3::ZERO, &i));
        assert_eq!(t.list.len(), 1);
        assert_eq!(t.list[0].normal, Vec3::Y * -sign);
        assert!((t.list[0].depth - (0.25 - y.abs())).abs() < 1e-16 && t.points.len() == 4);
        assert!((t.list[0].point - at).cross(Vec3::Y).length() < 1e-16);
    }
    let above = placed(&b, Vec3::new(0.0, 0.2500001, 0.0), &i);
    assert!(contacts(polyhedron_quadrangle::touch, &above, &placed(&q, Vec3::ZERO, &i)).list.is_empty());
    let beside = placed(&b, Vec3::new(1.2500001, 0.0, 0.0), &i);
    assert!(contacts(polyhedron_quadrangle::touch, &beside, &placed(&q, Vec3::ZERO, &i)).list.is_empty());
    // The box half-way through the plate's rim: pushed off sideways, not up or down.
    let rim = placed(&b, Vec3::new(1.2, 0.01, 0.0), &i);
    let t = contacts(polyhedron_quadrangle::touch, &rim, &placed(&q, Vec3::ZERO, &i)).list[0];
    assert!(close(t.normal, -Vec3::X, 1e-15) && (t.depth - 0.05).abs() < 1e-15);
}

#[test]
fn quadrangles_meet_quadrangles() {
    let (q, i) = (plate(1.0, 1.0), Mat3::IDENTITY);
    let upright = Mat3::from_columns(Vec3::Y, -Vec3::X, Vec3::Z);
    let flat = placed(&q, Vec3::ZERO, &i);
    let t = contacts(quadrangle_quadrangle::touch, &placed(&q, Vec3::new(0.1, 0.9, 0.2), &upright), &flat).list[0];
    assert!(close(t.normal, -Vec3::Y, 1e-15) && (t.depth - 0.1).abs() < 1e-15);
    assert!(close(t.point, Vec3::new(0.1, -0.05, 0.1), 1e-15), "{t:?}");
    // In one plane: rim to rim.
    let beside = placed(&q, Vec3::new(1.9, 0.0, 0.5), &i);
    let t = contacts(quadrangle_quadrangle::touch, &flat, &beside).list[0];
    assert!(close(t.normal, Vec3::X, 1e-15) && (t.depth - 0.1).abs() < 1e-15);
    assert!(close(t.point, Vec3::new(0.95, 0.0, 0.25), 1e-15), "{t:?}");
    assert!(contacts(quadrangle_quadrangle::touch, &flat, &placed(&q, Vec3::new(2.001, 0.0, 0.5), &i)).list.is_empty());
    assert!(contacts(quadrangle_quadrangle::touch, &flat, &placed(&q, Vec3::new(0.5, 0.001, 0.5), &i)).list.is_empty());
    assert!(contacts(quadrangle_quadrangle::touch, &flat, &flat).list.len() == 1);
}

/// Every contact of random quadrangles lies on the true depth of a thin slab in the limit of no thickness.
#[test]
fn quadrangles_are_the_limit_of_slabs() {
    let mut dice = Dice::new(6);
    let mut hits = 0;
    for _ in 0..1000 {
        let (x, z) = (dice.within(0.3, 1.0), dice.within(0.3, 1.0));
        let (q, slab) = (plate(x, z), cuboid(x, 1e-7, z));
        let b = any_body(&mut dice);
        let (rq, rb, at) = (dice.rotation(), dice.rotation(), dice.vector(0.8));
        let thin = contacts(polyhedron_quadrangle::touch, &placed(&b, at, &rb), &placed(&q, Vec3::ZERO, &rq));
        let thick = contacts(polyhedron_polyhedron::touch, &placed(&b, at, &rb), &placed(&slab, Vec3::ZERO, &rq));
        assert_eq!(thin.list.len(), thick.list.len());
        for (t, u) in thin.list.iter().zip(&thick.list) {
            hits += 1;
            assert!((t.depth - u.depth).abs() < 3e-7, "{t:?} {u:?}");
        }
    }
    assert!(hits > 200);
}

#[test]
fn what_is_not_a_number_touches_nothing() {
    let (b, q, i) = (cuboid(0.5, 0.5, 0.5), plate(1.0, 1.0), Mat3::IDENTITY);
    let (s, w) = (ball(0.5), wall(Vec3::Y));
    let nowhere = Vec3::new(0.0, Real::NAN, 0.0);
    let shapes: [&dyn crate::shape::Shape; 4] = [&b, &q, &s, &w];
    let routines: [crate::narrow::Routine; 7] = [
        polyhedron_polyhedron::touch,
        polyhedron_quadrangle::touch,
        quadrangle_quadrangle::touch,
        crate::narrow::pairs::polyhedron_half_space::touch,
        crate::narrow::pairs::quadrangle_half_space::touch,
        crate::narrow::pairs::sphere_polyhedron::touch,
        crate::narrow::pairs::sphere_quadrangle::touch,
    ];
    // Shapes that a routine is not for, too: no contact or a finite one, never a panic.
    for routine in routines {
        for first in shapes {
            for second in shapes {
                let t = contacts(routine, &placed(first, nowhere, &i), &placed(second, Vec3::ZERO, &i));
                assert!(t.list.is_empty(), "{t:?}");
                contacts(routine, &placed(first, Vec3::ZERO, &i), &placed(second, Vec3::ZERO, &i));
            }
        }
    }
}
