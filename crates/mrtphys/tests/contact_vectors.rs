//! The thesis's pair routines against the reference contacts, all of them called through the pair table.

mod things;

use mrtphys::narrow::{Touch, Touches};
use mrtphys::shape::LimitPlane;
use mrtphys::{Mat3, Vec3};
use serde_json::Value;
use things::*;

#[test]
fn sphere_and_sphere() {
    for case in cases(include_str!("vectors/contact_sphere_sphere.json")) {
        for by in Move::all() {
            let [a, b] =
                [("c1", "r1"), ("c2", "r2")].map(|(c, r)| Thing::sphere(vec3(&case[c]), number(&case[r])).moved(&by));
            // A moved grazing contact is a matter of round-off.
            if case["note"].as_str().is_some_and(|n| n.starts_with("touching")) && by.shift != Vec3::ZERO {
                continue;
            }
            if case["note"].as_str().is_some_and(|n| n.starts_with("coincident")) {
                let found = contacts_in_order(&a, &b);
                assert!((found.list[0].normal.length() - 1.0).abs() < 1e-15 && found.list[0].depth == 2.0);
                continue;
            }
            let found = contacts(&a, &b);
            match &case["hit"] {
                Value::Null => assert!(found.list.is_empty()),
                hit => two_points(&found, hit, number(&hit["depth"]), &by),
            }
        }
    }
}

#[test]
fn sphere_and_polyhedron() {
    let mut inside = 0;
    for case in cases(include_str!("vectors/contact_sphere_polyhedron.json")) {
        for by in Move::all() {
            let sphere = Thing::sphere(vec3(&case["c"]), number(&case["r"])).moved(&by);
            let polyhedron = Thing::polyhedron(&case["verts"], &case["faces"]).moved(&by);
            let found = contacts(&sphere, &polyhedron);
            match &case["hit"] {
                Value::Null => assert!(found.list.is_empty()),
                hit => {
                    let sign = if hit["inside"] == true { -1.0 } else { 1.0 };
                    inside += usize::from(hit["inside"] == true);
                    two_points(&found, hit, number(&case["r"]) - sign * number(&hit["dist"]), &by);
                }
            }
        }
    }
    assert!(inside > 30);
}

#[test]
fn sphere_and_quadrangle() {
    for case in cases(include_str!("vectors/contact_sphere_quadrangle.json")) {
        for by in Move::all() {
            let sphere = Thing::sphere(vec3(&case["c"]), number(&case["r"])).moved(&by);
            let found = contacts(&sphere, &Thing::quadrangle(&case["quad"]).moved(&by));
            match &case["hit"] {
                Value::Null => assert!(found.list.is_empty()),
                hit => two_points(&found, hit, number(&case["r"]) - number(&hit["dist"]), &by),
            }
        }
    }
}

/// The half-space, and the two-sided plane of the same side: as it stands, and turned round with the home side below.
fn walls(case: &Value, by: &Move) -> [Thing; 3] {
    let (point, normal) = (vec3(&case["P"]), vec3(&case["N"]));
    let plane =
        |normal: Vec3, home_side: f64| Thing { home_side, ..Thing::new(LimitPlane::new(normal).unwrap(), point) };
    [Thing::half_space(point, normal), plane(normal, 1.0), plane(-normal, -1.0)].map(|w| w.moved(by))
}

/// Compares the one contact with the reference's single point.
#[track_caller]
fn one_point(found: &Touches, case: &Value, depth: impl Fn(&Value) -> f64, by: &Move) {
    match &case["hit"] {
        Value::Null => assert!(found.list.is_empty()),
        hit => {
            let [touch] = found.list.as_slice() else { panic!("{found:?}, not {hit}") };
            near(touch.normal, by.rotation * vec3(&hit["N1"]));
            near(touch.point, by.point(vec3(&hit["P1"])));
            assert_eq!(found.points, [touch.point]);
            assert!((touch.depth - depth(hit)).abs() < TOLERANCE);
        }
    }
}

#[test]
fn half_space_and_sphere() {
    for case in cases(include_str!("vectors/contact_halfspace_sphere.json")) {
        for by in Move::all() {
            let r = number(&case["r"]);
            let sphere = Thing::sphere(vec3(&case["c"]), r).moved(&by);
            for wall in walls(&case, &by) {
                one_point(&contacts(&sphere, &wall), &case, |hit| r - number(&hit["d"]), &by);
            }
        }
    }
}

#[test]
fn half_space_and_polyhedron() {
    for case in cases(include_str!("vectors/contact_halfspace_polyhedron.json")) {
        for by in Move::all() {
            let body = any_polyhedron(&case["verts"]).moved(&by);
            for wall in walls(&case, &by) {
                one_point(&contacts(&body, &wall), &case, |hit| -number(&hit["d"]), &by);
            }
        }
    }
}

#[test]
fn half_space_and_quadrangle() {
    for case in cases(include_str!("vectors/contact_halfspace_quadrangle.json")) {
        for by in Move::all() {
            let body = Thing::quadrangle(&case["verts"]).moved(&by);
            for wall in walls(&case, &by) {
                one_point(&contacts(&body, &wall), &case, |hit| -number(&hit["d"]), &by);
            }
        }
    }
}

/// P is the centre of an axis-parallel box, so it does not turn with the case: only as it stands, and shifted.
#[test]
fn polyhedron_and_polyhedron() {
    let mut contained = 0;
    let shift = |v: Vec3| Move { rotation: Mat3::IDENTITY, shift: v };
    for case in cases(include_str!("vectors/contact_polyhedron_polyhedron.json")) {
        for by in [shift(Vec3::ZERO), shift(Vec3::new(0.5, -2.0, 1.25))] {
            let [a, b] = [("v1", "f1"), ("v2", "f2")].map(|(v, f)| Thing::polyhedron(&case[v], &case[f]).moved(&by));
            near(a.position, by.point(vec3(&case["S1"])));
            near(b.position, by.point(vec3(&case["S2"])));
            let found = contacts(&a, &b);
            assert_eq!(!found.list.is_empty(), case["convex_overlap"] == true);
            for touch in &found.list {
                let overlap = overlap_along(touch.normal, &case["v1"], &case["v2"]);
                assert!(touch.depth > 0.0 && (touch.depth - overlap).abs() < TOLERANCE);
            }
            match &case["hit"] {
                Value::Null => contained += found.list.len(),
                hit => {
                    near(found.list[0].point, by.point(vec3(&hit["P"])));
                    near(found.list[0].normal, vec3(&hit["N1"]));
                }
            }
        }
    }
    // The reference has one case of containment, which the thesis's routine does not see.
    assert_eq!(contained, 2);
}

/// How far the first set of points reaches past the start of the second, along the direction.
fn overlap_along(direction: Vec3, first: &Value, second: &Value) -> f64 {
    let along = |v: &Value| points(v).iter().map(|p| direction.dot(*p)).collect::<Vec<f64>>();
    along(first).into_iter().fold(f64::NEG_INFINITY, f64::max) - along(second).into_iter().fold(f64::INFINITY, f64::min)
}

fn scaled(v: &Value, by: f64) -> Value {
    match v {
        Value::Array(a) => a.iter().map(|x| scaled(x, by)).collect(),
        Value::Number(n) => Value::from(n.as_f64().unwrap() * by),
        other => other.clone(),
    }
}

/// Scaling all lengths by a power of two scales the contacts exactly, to the last bit.
#[test]
fn contacts_scale_by_powers_of_two() {
    type Make = fn(&Value, f64) -> (Thing, Thing);
    let makes: [(&str, Make); 5] = [
        (include_str!("vectors/contact_sphere_sphere.json"), |c, s| {
            (
                Thing::sphere(vec3(&c["c1"]) * s, number(&c["r1"]) * s),
                Thing::sphere(vec3(&c["c2"]) * s, number(&c["r2"]) * s),
            )
        }),
        (include_str!("vectors/contact_sphere_polyhedron.json"), |c, s| {
            (
                Thing::sphere(vec3(&c["c"]) * s, number(&c["r"]) * s),
                Thing::polyhedron(&scaled(&c["verts"], s), &c["faces"]),
            )
        }),
        (include_str!("vectors/contact_sphere_quadrangle.json"), |c, s| {
            (Thing::sphere(vec3(&c["c"]) * s, number(&c["r"]) * s), Thing::quadrangle(&scaled(&c["quad"], s)))
        }),
        (include_str!("vectors/contact_halfspace_polyhedron.json"), |c, s| {
            (any_polyhedron(&scaled(&c["verts"], s)), Thing::half_space(vec3(&c["P"]) * s, vec3(&c["N"])))
        }),
        (include_str!("vectors/contact_polyhedron_polyhedron.json"), |c, s| {
            (Thing::polyhedron(&scaled(&c["v1"], s), &c["f1"]), Thing::polyhedron(&scaled(&c["v2"], s), &c["f2"]))
        }),
    ];
    for (text, make) in makes {
        for case in cases(text) {
            let (a, b) = make(&case, 1.0);
            let plain = contacts_in_order(&a, &b);
            for k in [-40, 3, 40] {
                let s = (2.0f64).powi(k);
                let (a, b) = make(&case, s);
                let found = contacts_in_order(&a, &b);
                assert_eq!(found.list.len(), plain.list.len());
                for (t, u) in found.list.iter().zip(&plain.list) {
                    let expected = Touch { point: u.point * s, depth: u.depth * s, ..*u };
                    assert_eq!(*t, expected, "2^{k}");
                }
                assert!(found.points.iter().zip(&plain.points).all(|(p, q)| *p == *q * s));
            }
        }
    }
}
