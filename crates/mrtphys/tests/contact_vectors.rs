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
        (s.normal - t.normal).length() > 1e-12
            || (s.point - t.point).length() > 1e-12
            || (s.depth - t.depth).abs() > 1e-12
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

fn unit_box(half: Vec3) -> Thing {
    let corner = |i: u32| half.mul_elements(Vec3::new(sign(i & 4), sign(i & 2), sign(i & 1)));
    let corners: Vec<Vec3> = (0..8).map(corner).collect();
    let faces =
        [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]].map(|f| f.to_vec());
    Thing::authored(Polyhedron::from_mesh(&corners, &faces).unwrap())
}

fn sign(bit: u32) -> f64 {
    if bit == 0 { -1.0 } else { 1.0 }
}

/// The closest point has no direction where it is the centre itself: the surface's own normal.
#[test]
fn sphere_centre_on_the_surface() {
    let cube = unit_box(Vec3::splat(1.0));
    let diagonal = Vec3::new(1.0, 0.0, 1.0).try_normalize().unwrap();
    for (center, normal) in [
        (Vec3::new(1.0, 0.25, -0.5), Vec3::X),
        (Vec3::new(-0.3, -1.0, 0.1), -Vec3::Y),
        (Vec3::new(1.0, 0.3, 1.0), diagonal),
        (Vec3::new(1.0 + 1e-16, 0.3, 1.0), diagonal),
        (Vec3::new(0.2, 0.1, 1.0 - 1e-16), Vec3::Z),
    ] {
        let found = contacts(&cube, &Thing::sphere(center, 0.5));
        near(found.list[0].normal, normal);
        assert!((found.list[0].depth - 0.5).abs() < TOLERANCE);
    }
    let flat = Thing::authored(Quadrangle::new([Vec3::ZERO, Vec3::X, Vec3::X + Vec3::Y, Vec3::Y]).unwrap());
    let found = contacts(&flat, &Thing::sphere(Vec3::new(0.5, 0.25, 0.0), 0.5));
    near(found.list[0].normal, Vec3::Z);
    assert_eq!(found.list[0].depth, 0.5);
}

/// One polyhedron in the other: the inner one leaves by the nearest face, and the impact goes through its centre.
#[test]
fn contained_polyhedra() {
    let mut inner = unit_box(Vec3::splat(0.25));
    inner.position = Vec3::new(0.25, -1.25, 0.5);
    inner.rotation = Quat::from_axis_angle(Vec3::Y, 0.5).to_matrix();
    let outer = unit_box(Vec3::new(3.0, 2.0, 2.5));
    let found = contacts(&outer, &inner);
    near(found.list[0].normal, -Vec3::Y);
    near(found.list[0].point, Vec3::new(0.25, -2.0, 0.5));
    assert!((found.list[0].depth - 1.0).abs() < TOLERANCE);
}

/// Both collision radii in one direction, or none at all: the line of centres, or at last a fixed direction.
#[test]
fn no_bisector() {
    let cube = || unit_box(Vec3::splat(1.0));
    let same = contacts_in_order(&cube(), &unit_box(Vec3::new(0.5, 2.0, 0.5)));
    assert!((same.list[0].normal.length() - 1.0).abs() < 1e-15 && same.list[0].depth > 0.0);
    let mut beside = unit_box(Vec3::new(8.0, 0.25, 0.25));
    beside.position = Vec3::new(-6.9, 0.0, 0.0);
    let found = contacts(&cube(), &beside);
    assert!(found.list[0].normal.is_finite() && (found.list[0].normal.length() - 1.0).abs() < 1e-15);
}

/// Of corners that are equally deep the first is reported.
#[test]
fn flat_landing_takes_the_first_corner() {
    let mut cube = unit_box(Vec3::splat(0.5));
    cube.position = Vec3::new(3.0, 0.375, -1.0);
    let found = contacts(&cube, &Thing::half_space(Vec3::ZERO, Vec3::Y));
    assert_eq!((found.list[0].feature, found.list[0].depth), (0, 0.125));
    assert_eq!(found.list[0].point, Vec3::new(2.5, -0.125, -1.5));
}

/// A plane of which nobody knows on which side the partner is at home: that of its centre.
#[test]
fn plane_without_memory() {
    for (height, expected) in [(0.25, Vec3::Y), (-0.25, -Vec3::Y), (0.0, Vec3::Y)] {
        let plane = Thing::new(LimitPlane::new(Vec3::Y).unwrap(), Vec3::ZERO);
        let found = contacts(&plane, &Thing::sphere(Vec3::new(1.0, height, 0.0), 0.5));
        assert_eq!(found.list[0].normal, expected);
        assert_eq!(found.list[0].depth, 0.5 - height.abs());
    }
}

/// A shape of a user's, of a kind below one of this crate's, whose geometry no routine knows.
#[derive(Debug)]
struct Stranger(&'static str, f64);

impl Shape for Stranger {
    fn kind(&self) -> &'static str {
        self.0
    }
    fn bounding_sphere(&self) -> Ball {
        Ball { center: Vec3::ZERO, radius: self.1 }
    }
    fn mass_properties(&self) -> Option<mrtphys::shape::MassProperties> {
        None
    }
}

#[test]
fn strangers_are_their_bounding_spheres() {
    let sphere = Thing::sphere(Vec3::new(1.0, 0.0, 0.0), 0.5);
    for mode in [ContactMode::Exact, ContactMode::Thesis] {
        let kinds = Kinds::standard(mode);
        let table = kinds.resolve();
        for (a, name) in kinds.iter() {
            let name: &'static str = Box::leak(name.to_owned().into_boxed_str());
            for (b, other) in kinds.iter() {
                let partners = [
                    Thing::new(Stranger(Box::leak(other.to_owned().into_boxed_str()), 0.75), Vec3::X),
                    unit_box(Vec3::splat(1.0)),
                ];
                for partner in &partners {
                    for radius in [0.75, f64::INFINITY] {
                        let mut out = Touches::default();
                        let stranger = Thing::new(Stranger(name, radius), Vec3::ZERO);
                        table.lookup(a, b).call(&stranger.placed(), &partner.placed(), &mut out);
                        assert!(out.list.iter().all(|t| t.normal.is_finite() && t.point.is_finite() && t.depth >= 0.0));
                    }
                }
            }
        }
        let id = |n: &str| kinds.id(n).unwrap();
        for name in ["polyhedron", "quadrangle", "half-space", "plane"] {
            let mut out = Touches::default();
            let stranger = Thing::new(Stranger(name, 0.75), Vec3::ZERO);
            table.lookup(id(name), id("sphere")).call(&stranger.placed(), &sphere.placed(), &mut out);
            assert_eq!((out.list[0].normal, out.list[0].depth), (Vec3::X, 0.25), "{name}");
        }
    }
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
