//! Things to bring into contact, and the reference cases that say how.
#![allow(dead_code, reason = "each test file uses its part")]

use mrtphys::bounds::{Ball, placed_ball};
use mrtphys::def::ContactMode;
use mrtphys::narrow::kinds::Kinds;
use mrtphys::narrow::{Placed, Touch, Touches};
use mrtphys::shape::{HalfSpace, Polyhedron, Quadrangle, Shape, Sphere};
use mrtphys::{Mat3, Quat, Vec3};
use serde_json::Value;

pub const TOLERANCE: f64 = 1e-11;

/// A shape where it is.
pub struct Thing {
    pub shape: Box<dyn Shape>,
    pub position: Vec3,
    pub rotation: Mat3,
    pub home_side: f64,
}

impl Thing {
    pub fn new(shape: impl Shape, position: Vec3) -> Thing {
        Thing { shape: Box::new(shape), position, rotation: Mat3::IDENTITY, home_side: 0.0 }
    }

    pub fn sphere(center: Vec3, radius: f64) -> Thing {
        Thing::new(Sphere::new(radius).unwrap(), center)
    }

    pub fn half_space(point: Vec3, normal: Vec3) -> Thing {
        Thing::new(HalfSpace::new(normal).unwrap(), point)
    }

    /// In the author's coordinates, as given.
    pub fn authored(shape: impl Shape) -> Thing {
        let position = -shape.author_origin();
        Thing::new(shape, position)
    }

    pub fn quadrangle(corners: &Value) -> Thing {
        let c = points(corners);
        Thing::authored(Quadrangle::new([c[0], c[1], c[2], c[3]]).unwrap())
    }

    pub fn polyhedron(corners: &Value, faces: &Value) -> Thing {
        let faces: Vec<Vec<u32>> = serde_json::from_value(faces.clone()).unwrap();
        Thing::authored(Polyhedron::from_mesh(&points(corners), &faces).unwrap())
    }

    /// The same, moved and turned as a whole about the origin.
    pub fn moved(mut self, by: &Move) -> Thing {
        self.position = by.point(self.position);
        self.rotation = by.rotation * self.rotation;
        self
    }

    pub fn placed(&self) -> Placed<'_> {
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
pub struct Move {
    pub rotation: Mat3,
    pub shift: Vec3,
}

impl Move {
    pub fn all() -> [Move; 3] {
        let turned = |axis: Vec3, angle: f64| Quat::from_axis_angle(axis.try_normalize().unwrap(), angle).to_matrix();
        [
            Move { rotation: Mat3::IDENTITY, shift: Vec3::ZERO },
            Move { rotation: turned(Vec3::new(1.0, -2.0, 0.5), 2.3), shift: Vec3::new(0.7, -3.1, 1.9) },
            Move { rotation: turned(Vec3::new(0.1, 0.2, -1.0), -0.8), shift: Vec3::ZERO },
        ]
    }

    pub fn point(&self, p: Vec3) -> Vec3 {
        self.rotation * p + self.shift
    }
}

/// The contacts of two things, in both orders: one must be the other turned round.
pub fn contacts(a: &Thing, b: &Thing) -> Touches {
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

pub fn vec3(v: &Value) -> Vec3 {
    Vec3::new(v[0].as_f64().unwrap(), v[1].as_f64().unwrap(), v[2].as_f64().unwrap())
}

pub fn points(v: &Value) -> Vec<Vec3> {
    v.as_array().unwrap().iter().map(vec3).collect()
}

pub fn number(v: &Value) -> f64 {
    v.as_f64().unwrap()
}

pub fn cases(text: &str) -> Vec<Value> {
    let all: Value = serde_json::from_str(text).unwrap();
    let found = all["cases"].as_array().unwrap().clone();
    assert!(found.len() >= 40);
    found
}

#[track_caller]
pub fn near(ours: Vec3, reference: Vec3) {
    assert!((ours - reference).length() < TOLERANCE, "{ours:?}, not {reference:?}");
}

/// Compares the one contact with the reference's: two points, their midpoint, the first normal, the depth.
#[track_caller]
pub fn two_points(found: &Touches, hit: &Value, depth: f64, by: &Move) {
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

/// In this order only: the normal of coincident spheres does not turn round with the order.
pub fn contacts_in_order(a: &Thing, b: &Thing) -> Touches {
    contacts_by(ContactMode::Thesis, a, b)
}

/// By the routines of this mode, in this order only.
pub fn contacts_by(mode: ContactMode, a: &Thing, b: &Thing) -> Touches {
    let kinds = Kinds::standard(mode);
    let id = |t: &Thing| kinds.id(t.shape.kind()).unwrap();
    let mut out = Touches::default();
    kinds.resolve().lookup(id(a), id(b)).call(&a.placed(), &b.placed(), &mut out);
    out
}

/// Corners of a tetrahedron or of a box whose corner numbers count in binary.
pub fn any_polyhedron(corners: &Value) -> Thing {
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

pub fn unit_box(half: Vec3) -> Thing {
    let corner = |i: u32| half.mul_elements(Vec3::new(sign(i & 4), sign(i & 2), sign(i & 1)));
    let corners: Vec<Vec3> = (0..8).map(corner).collect();
    let faces =
        [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]].map(|f| f.to_vec());
    Thing::authored(Polyhedron::from_mesh(&corners, &faces).unwrap())
}

pub fn sign(bit: u32) -> f64 {
    if bit == 0 { -1.0 } else { 1.0 }
}
