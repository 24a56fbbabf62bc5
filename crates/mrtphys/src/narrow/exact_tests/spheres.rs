//! Spheres against polyhedra and quadrangles.

use super::bodies::*;
use crate::math::{Mat3, Real, Vec3};
use crate::narrow::pairs::{sphere_polyhedron, sphere_quadrangle};
use crate::shape::Polyhedron;

fn vector(v: &serde_json::Value) -> Vec3 {
    let x = |i: usize| v[i].as_f64().unwrap();
    Vec3::new(x(0), x(1), x(2))
}

fn read(name: &str) -> Vec<serde_json::Value> {
    let path = format!("{}/tests/vectors/{name}.json", env!("CARGO_MANIFEST_DIR"));
    let file: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    file["cases"].as_array().unwrap().clone()
}

#[test]
fn reference_vectors_polyhedron() {
    let mut hits = 0;
    for case in read("contact_sphere_polyhedron") {
        let corners: Vec<Vec3> = case["verts"].as_array().unwrap().iter().map(vector).collect();
        let p = hull(&corners);
        let (c, r) = (vector(&case["c"]), case["r"].as_f64().unwrap());
        let (s, i) = (ball(r), Mat3::IDENTITY);
        let t = contacts(sphere_polyhedron::touch, &placed(&s, c, &i), &placed(&p, Vec3::ZERO, &i));
        if case["hit"].is_null() {
            assert!(t.list.is_empty());
            continue;
        }
        hits += 1;
        let (closest, distance) = (vector(&case["closest"]), case["dist"].as_f64().unwrap());
        let inside = case["hit"]["inside"].as_bool().unwrap();
        let t = t.list[0];
        let depth = if inside { r + distance } else { r - distance };
        assert!((t.depth - depth).abs() < 1e-12, "{case}");
        assert!(close(t.normal, vector(&case["hit"]["N1"]), 1e-12), "{case}");
        let middle = 0.5 * (closest + c + t.normal * r);
        assert!(close(t.point, middle, 1e-12));
    }
    assert!(hits > 30);
}

#[test]
fn reference_vectors_quadrangle() {
    let mut hits = 0;
    for case in read("contact_sphere_quadrangle") {
        let q: Vec<Vec3> = case["quad"].as_array().unwrap().iter().map(vector).collect();
        let middle = q.iter().copied().sum::<Vec3>() / 4.0;
        let shape = quadrangle([q[0] - middle, q[1] - middle, q[2] - middle, q[3] - middle]);
        let (c, r) = (vector(&case["c"]), case["r"].as_f64().unwrap());
        let (s, i) = (ball(r), Mat3::IDENTITY);
        let t = contacts(sphere_quadrangle::touch, &placed(&s, c, &i), &placed(&shape, middle, &i));
        assert_eq!(t.list.is_empty(), case["hit"].is_null(), "{case}");
        if let Some(t) = t.list.first() {
            hits += 1;
            assert!(close(t.normal, vector(&case["hit"]["N1"]), 1e-10), "{case} {t:?}");
        }
    }
    assert!(hits > 10);
}

/// A point q of a convex body is the nearest to c exactly if no corner x lies beyond the plane through q across c - q:
/// (c - q) . (x - q) <= 0.
#[test]
fn nearest_points_of_convex_bodies_are_nearest() {
    let mut dice = Dice::new(21);
    let (mut near, mut inside, mut missed) = (0, 0, 0);
    for _ in 0..4000 {
        let p = any_body(&mut dice);
        let (r, at) = (dice.rotation(), dice.vector(1.0));
        let c = at + dice.direction() * dice.within(0.0, 2.0);
        let s = ball(dice.within(0.05, 0.8));
        let pp = placed(&p, at, &r);
        let t = contacts(sphere_polyhedron::touch, &placed(&s, c, &Mat3::IDENTITY), &pp);
        let local = r.transpose_mul(c - at);
        let faces = &p.pieces[0].faces;
        let height = faces.iter().map(|f| f.normal.dot(local) - f.offset).fold(Real::NEG_INFINITY, Real::max);
        let Some(t) = t.list.first() else {
            assert!(height > -1e-15);
            // A separating direction is proof: the one the nearest corner of a grid of directions gives must not fail.
            assert!(!some_point_is_nearer(&p, local, s.radius()), "missed");
            missed += 1;
            continue;
        };
        if height < 0.0 {
            inside += 1;
            assert!((t.depth - (s.radius() - height)).abs() < 1e-8);
            continue;
        }
        near += 1;
        let q = c + t.normal * (s.radius() - t.depth);
        let away = c - q;
        let local_q = r.transpose_mul(q - at);
        assert!(faces.iter().all(|f| f.normal.dot(local_q) - f.offset < 1e-12));
        assert!(p.corners.iter().all(|&x| away.dot(at + r * x - q) < 1e-12), "{t:?}");
    }
    assert!(near > 300 && inside > 300 && missed > 300, "{near} {inside} {missed}");
}

fn some_point_is_nearer(p: &Polyhedron, c: Vec3, radius: Real) -> bool {
    let piece = &p.pieces[0];
    let near = |x: Vec3| (x - c).length() < radius - 1e-12;
    piece.faces.iter().any(|f| {
        let k = f.corners.len();
        let corner = |i: usize| piece.corners[f.corners[i] as usize];
        (1..k - 1).any(|i| {
            (0..=12).any(|u| {
                (0..=12 - u).any(|v| {
                    let (s, t) = (u as Real / 12.0, v as Real / 12.0);
                    near(corner(0) * (1.0 - s - t) + corner(i) * s + corner(i + 1) * t)
                })
            })
        })
    })
}

fn notch() -> Polyhedron {
    let v = Vec3::new;
    let cuts = [(Vec3::ZERO, Vec3::Y), (Vec3::ZERO, -Vec3::Y)];
    boxes(&[(v(-2.0, -1.0, -2.0), v(2.0, 0.0, 2.0)), (v(-2.0, 0.0, -2.0), v(0.0, 2.0, 2.0))], &cuts)
}

#[test]
fn a_sphere_in_a_notch_touches_both_walls() {
    let (l, s, i) = (notch(), ball(0.5), Mat3::IDENTITY);
    let lp = placed(&l, Vec3::ZERO, &i);
    let t = contacts(sphere_polyhedron::touch, &placed(&s, Vec3::new(0.45, 0.4, 0.0), &i), &lp);
    assert_eq!(t.list.len(), 2);
    let mut found: Vec<(Vec3, Real)> = t.list.iter().map(|t| (t.normal, t.depth)).collect();
    found.sort_by(|p, q| p.1.total_cmp(&q.1));
    assert!(close(found[0].0, -Vec3::X, 1e-15) && (found[0].1 - 0.05).abs() < 1e-15, "{found:?}");
    assert!(close(found[1].0, -Vec3::Y, 1e-15) && (found[1].1 - 0.1).abs() < 1e-15, "{found:?}");
    assert_ne!(t.list[0].feature, t.list[1].feature);
    // On the floor beside the wall there is one contact; over the cut between the pieces as well.
    let t = contacts(sphere_polyhedron::touch, &placed(&s, Vec3::new(1.0, 0.4, 0.0), &i), &lp);
    assert_eq!(t.list.len(), 1);
    for y in [-0.5, -0.1, 0.0, 0.1, 0.5] {
        let t = contacts(sphere_polyhedron::touch, &placed(&s, Vec3::new(-2.4, y, 0.3), &i), &lp);
        assert_eq!(t.list.len(), 1, "{y}: {t:?}");
        assert!(close(t.list[0].normal, Vec3::X, 1e-15) && (t.list[0].depth - 0.1).abs() < 1e-15, "{y}: {t:?}");
    }
}

#[test]
fn inside_a_body_of_pieces_the_cut_is_no_way_out() {
    let (l, s, i) = (notch(), ball(0.1), Mat3::IDENTITY);
    let lp = placed(&l, Vec3::ZERO, &i);
    // Just below and above the cut, in the middle of both pieces.
    for y in [-0.05, 0.0, 0.05] {
        let t = contacts(sphere_polyhedron::touch, &placed(&s, Vec3::new(-0.75, y, 0.0), &i), &lp).list;
        assert_eq!(t.len(), 1);
        // The wall x = 0 ends at the floor; below, the way out to the reflex edge is the shortest.
        let below = if y < 0.0 { -y } else { 0.0 };
        let out = Vec3::new(0.75, below, 0.0);
        assert!((t[0].depth - (0.1 + out.length())).abs() < 1e-12, "{y}: {t:?}");
        assert!(close(t[0].normal, -out.try_normalize().unwrap(), 1e-12), "{y}: {t:?}");
    }
    let t = contacts(sphere_polyhedron::touch, &placed(&s, Vec3::new(-0.3, 1.0, 0.0), &i), &lp).list;
    assert!(close(t[0].normal, -Vec3::X, 1e-15) && (t[0].depth - 0.4).abs() < 1e-15);
}

#[test]
fn centres_on_the_surface_and_in_the_middle_are_defined() {
    let (b, s, i) = (cuboid(0.5, 0.5, 0.5), ball(0.25), Mat3::IDENTITY);
    let bp = placed(&b, Vec3::ZERO, &i);
    let at = |c: Vec3| contacts(sphere_polyhedron::touch, &placed(&s, c, &i), &bp).list[0];
    for (c, n) in [
        (Vec3::new(0.5, 0.1, 0.2), Vec3::X),
        (Vec3::new(0.5, 0.5, 0.2), Vec3::new(1.0, 1.0, 0.0)),
        (Vec3::new(0.5, 0.5, -0.5), Vec3::new(1.0, 1.0, -1.0)),
        (Vec3::new(0.5 + 1e-16, 0.5 + 1e-16, 0.2), Vec3::new(1.0, 1.0, 0.0)),
    ] {
        let t = at(c);
        assert!(close(t.normal, -n.try_normalize().unwrap(), 1e-14) && (t.depth - 0.25).abs() < 1e-15, "{c:?} {t:?}");
    }
    let t = at(Vec3::ZERO);
    assert!(t.depth == 0.75 && t.normal.max_abs() == 1.0);
    // Touching from outside, then one rounding further off.
    assert_eq!(at(Vec3::new(0.0, 0.75, 0.0)).depth, 0.0);
    let off = placed(&s, Vec3::new(0.0, 0.75 * (1.0 + Real::EPSILON), 0.0), &i);
    assert!(contacts(sphere_polyhedron::touch, &off, &bp).list.is_empty());
}

#[test]
fn sphere_on_quadrangle_faces_rims_and_plane() {
    let (q, s, i) = (plate(1.0, 1.0), ball(0.5), Mat3::IDENTITY);
    let qp = placed(&q, Vec3::ZERO, &i);
    let at = |c: Vec3| contacts(sphere_quadrangle::touch, &placed(&s, c, &i), &qp).list.first().copied();
    for (c, normal, depth) in [
        (Vec3::new(0.2, 0.3, 0.1), -Vec3::Y, 0.2),
        (Vec3::new(0.2, -0.3, 0.1), Vec3::Y, 0.2),
        (Vec3::new(0.2, 0.0, 0.1), -Vec3::Y, 0.5),
        (Vec3::new(1.3, 0.0, 0.1), -Vec3::X, 0.2),
        (Vec3::new(1.24, 0.32, 0.1), Vec3::new(-0.6, -0.8, 0.0), 0.1),
    ] {
        let t = at(c).unwrap();
        assert!(close(t.normal, normal, 1e-14) && (t.depth - depth).abs() < 1e-15, "{c:?} {t:?}");
        assert!((t.point - c).cross(t.normal).length() < 1e-15);
    }
    assert!(at(Vec3::new(1.31, 0.4, 0.1)).is_none() && at(Vec3::new(0.0, 0.51, 0.0)).is_none());
    assert!(at(Vec3::new(1.0, 0.0, 1.0)).unwrap().normal.is_finite());
}
