//! The thesis's pair routines against the reference contacts, all of them called through the pair table.

use mrtphys::bounds::{Ball, placed_ball};
use mrtphys::def::ContactMode;
use mrtphys::narrow::kinds::Kinds;
use mrtphys::narrow::{Placed, Touch, Touches};
use mrtphys::shape::{HalfSpace, LimitPlane, Polyhedron, Quadrangle, Shape, Sphere};
use mrtphys::{Mat3, Quat, Vec3};
use serde_json::Value;

const TOLERANCE: f64 = 1e-11;

/// A shape where it is.
struct Thing {
    shape: Box<dyn Shape>,
    position: Vec3,
    rotation: Mat3,
    home_side: f64,
}

impl Thing {
    fn new(shape: impl Shape, position: Vec3) -> Thing {
        Thing { shape: Box::new(shape), position, rotation: Mat3::IDENTITY, home_side: 0.0 }
    }

    fn sphere(center: Vec3, radius: f64) -> Thing {
        Thing::new(Sphere::new(radius).unwrap(), center)
    }

    fn half_space(point: Vec3, normal: Vec3) -> Thing {
        Thing::new(HalfSpace::new(normal).unwrap(), point)
    }

    /// In the author's coordinates, as given.
    fn authored(shape: impl Shape) -> Thing {
        let position = -shape.author_origin();
        Thing::new(shape, position)
    }

    fn quadrangle(corners: &Value) -> Thing {
        let c = points(corners);
        Thing::authored(Quadrangle::new([c[0], c[1], c[2], c[3]]).unwrap())
    }

    fn polyhedron(corners: &Value, faces: &Value) -> Thing {
        let faces: Vec<Vec<u32>> = serde_json::from_value(faces.clone()).unwrap();
        Thing::authored(Polyhedron::from_mesh(&points(corners), &faces).unwrap())
    }

    /// The same, moved and turned as a whole about the origin.
    fn moved(mut self, by: &Move) -> Thing {
        self.position = by.point(self.position);
        self.rotation = by.rotation * self.rotation;
        self
    }

    fn placed(&self) -> Placed<'_> {
        let local = self.shape.bounding_sphere();
        let ball = match local.radius.is_finite() {
            true => placed_ball(&local, self.position, &self.rotation),
            false => Ball { center: self.position, radius: local.radius },
        };
        Placed {
            shape: self.shape.as_ref(),
            position: self.position,
            rotation: &self.rotation,
            ball,
            home_side: self.home_side,
        }
    }
}

/// A rigid motion of a whole case.
struct Move {
    rotation: Mat3,
    shift: Vec3,
}

impl Move {
    fn all() -> [Move; 3] {
        let turned = |axis: Vec3, angle: f64| Quat::from_axis_angle(axis.try_normalize().unwrap(), angle).to_matrix();
        [
            Move { rotation: Mat3::IDENTITY, shift: Vec3::ZERO },
            Move { rotation: turned(Vec3::new(1.0, -2.0, 0.5), 2.3), shift: Vec3::new(0.7, -3.1, 1.9) },
            Move { rotation: turned(Vec3::new(0.1, 0.2, -1.0), -0.8), shift: Vec3::ZERO },
        ]
    }

    fn point(&self, p: Vec3) -> Vec3 {
        self.rotation * p + self.shift
    }
}

/// The contacts of two things, in both orders: one must be the other turned round.
fn contacts(a: &Thing, b: &Thing) -> Touches {
    let kinds = Kinds::standard(ContactMode::Thesis);
    let table = kinds.resolve();
    let id = |t: &Thing| kinds.id(t.shape.kind()).unwrap();
    let (mut out, mut back) = (Touches::default(), Touches::default());
    table.lookup(id(a), id(b)).call(&a.placed(), &b.placed(), &mut out);
    table.lookup(id(b), id(a)).call(&b.placed(), &a.placed(), &mut back);
    back.flip_from(0);
    let differs = |(s, t): (&Touch, &Touch)| {
        (s.normal - t.normal).length() > 1e-12 || (s.point - t.point).length() > 1e-12 || (s.depth - t.depth).abs() > 1e-12
    };
    // Not for a quadrangle and a quadrangle, of which the second is taken as its bounding sphere; not used here.
    assert_eq!(out.list.len(), back.list.len());
    assert!(!out.list.iter().zip(&back.list).any(differs), "{out:?}\n{back:?}");
    out
}

fn vec3(v: &Value) -> Vec3 {
    Vec3::new(v[0].as_f64().unwrap(), v[1].as_f64().unwrap(), v[2].as_f64().unwrap())
}

fn points(v: &Value) -> Vec<Vec3> {
    v.as_array().unwrap().iter().map(vec3).collect()
}

fn number(v: &Value) -> f64 {
    v.as_f64().unwrap()
}

fn cases(text: &str) -> Vec<Value> {
    let all: Value = serde_json::from_str(text).unwrap();
    let found = all["cases"].as_array().unwrap().clone();
    assert!(found.len() >= 40);
    found
}

#[track_caller]
fn near(ours: Vec3, reference: Vec3) {
    assert!((ours - reference).length() < TOLERANCE, "{ours:?}, not {reference:?}");
}

/// Compares the one contact with the reference's: two points, their midpoint, the first normal, the depth.
#[track_caller]
fn two_points(found: &Touches, hit: &Value, depth: f64, by: &Move) {
    let [touch] = found.list.as_slice() else { panic!("{found:?}, not {hit}") };
    let (p1, p2) = (by.point(vec3(&hit["P1"])), by.point(vec3(&hit["P2"])));
    near(touch.normal, by.rotation * vec3(&hit["N1"]));
    near(touch.point, (p1 + p2) * 0.5);
    assert_eq!((touch.first_point, touch.point_count), (0, 2));
    let (u, v) = (found.points[0], found.points[1]);
    let either = ((u - p1).length() + (v - p2).length()).min((u - p2).length() + (v - p1).length());
    assert!(either < TOLERANCE, "{u:?} and {v:?}, not {p1:?} and {p2:?}");
    assert!((touch.depth - depth).abs() < TOLERANCE, "{}, not {depth}", touch.depth);
}

#[test]
fn sphere_and_sphere() {
    for case in cases(include_str!("vectors/contact_sphere_sphere.json")) {
        for by in Move::all() {
            let [a, b] = [("c1", "r1"), ("c2", "r2")].map(|(c, r)| Thing::sphere(vec3(&case[c]), number(&case[r])).moved(&by));
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

/// In this order only: the normal of coincident spheres does not turn round with the order.
fn contacts_in_order(a: &Thing, b: &Thing) -> Touches {
    let kinds = Kinds::standard(ContactMode::Thesis);
    let id = |t: &Thing| kinds.id(t.shape.kind()).unwrap();
    let mut out = Touches::default();
    kinds.resolve().lookup(id(a), id(b)).call(&a.placed(), &b.placed(), &mut out);
    out
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
    let plane = |normal: Vec3, home_side: f64| Thing {
        home_side,
        ..Thing::new(LimitPlane::new(normal).unwrap(), point)
    };
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

/// Corners of a tetrahedron or of a box whose corner numbers count in binary.
fn any_polyhedron(corners: &Value) -> Thing {
    let c = points(corners);
    if c.len() == 4 {
        return Thing::authored(Polyhedron::tetrahedron_from_points([c[0], c[1], c[2], c[3]]).unwrap());
    }
    let right_handed = (c[1] - c[0]).cross(c[2] - c[0]).dot(c[4] - c[0]) > 0.0;
    let mut faces: Vec<Vec<u32>> =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]].map(|f| f.to_vec()).into();
    if !right_handed {
        faces.iter_mut().for_each(|f| f.reverse());
    }
    Thing::authored(Polyhedron::from_mesh(&c, &faces).unwrap())
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
