//! Contacts that the reference cases leave out: no direction, containment, strangers, limits, both modes.

mod things;

use mrtphys::bounds::Ball;
use mrtphys::def::ContactMode;
use mrtphys::narrow::Touches;
use mrtphys::narrow::kinds::Kinds;
use mrtphys::shape::{LimitPlane, Polyhedron, Quadrangle, Shape, limit_box};
use mrtphys::{Quat, Vec3};
use things::*;

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

/// Whatever touches a half-space touches a limit quadrangle and a two-sided plane in the same way.
#[test]
fn limits_are_half_spaces() {
    let corners = [Vec3::ZERO, Vec3::X, Vec3::X + Vec3::Y * 2.0, Vec3::Y];
    let tilt = Quat::from_axis_angle(Vec3::new(0.6, 0.0, 0.8), 0.7).to_matrix();
    for mode in [ContactMode::Exact, ContactMode::Thesis] {
        for (name, position, face) in limit_box(Vec3::splat(-1.0), Vec3::new(1.0, 2.0, 3.0)).unwrap() {
            let normal = face.normal();
            let wall = Thing::half_space(position, normal);
            let turned = Thing { home_side: -1.0, ..Thing::new(LimitPlane::new(-normal).unwrap(), position) };
            let limits = [Thing::new(face, position), turned];
            for beyond in [-0.3, 0.1, 0.2, 9.0] {
                for shape in 0..3 {
                    let mut body = match shape {
                        0 => Thing::sphere(Vec3::ZERO, 0.25),
                        1 => unit_box(Vec3::new(0.25, 0.5, 0.125)),
                        _ => Thing::authored(Quadrangle::new(corners).unwrap()),
                    };
                    body.rotation = tilt;
                    body.position = position - normal * beyond;
                    let expected = contacts_by(mode, &body, &wall);
                    assert_eq!(expected.list.len(), usize::from(beyond > 0.0 || shape > 0), "{name}");
                    for limit in &limits {
                        let found = contacts_by(mode, &body, limit);
                        assert_eq!((&found.list, &found.points), (&expected.list, &expected.points), "{name}");
                    }
                }
            }
        }
    }
}

/// An L, of two convex pieces: a sphere in its notch is outside, one in its corner inside.
#[test]
fn sphere_and_a_polyhedron_with_a_notch() {
    let outline = [(0.0, 0.0), (4.0, 0.0), (4.0, 1.0), (1.0, 1.0), (1.0, 4.0), (0.0, 4.0)];
    let layer = |z: f64| outline.iter().map(move |&(x, y)| Vec3::new(x, y, z));
    let corners: Vec<Vec3> = layer(0.0).chain(layer(1.0)).collect();
    let mut faces: Vec<Vec<u32>> = vec![(0..6).rev().collect(), (6..12).collect()];
    faces.extend((0..6).map(|i| vec![i, (i + 1) % 6, (i + 1) % 6 + 6, i + 6]));
    let shape = Polyhedron::from_mesh(&corners, &faces).unwrap();
    assert!(!shape.is_convex());
    let body = Thing::authored(shape);
    for (center, radius, expected) in [
        (Vec3::new(2.0, 1.5, 0.5), 0.75, Some((Vec3::Y, 0.25))),
        (Vec3::new(1.25, 3.0, 0.5), 0.5, Some((Vec3::X, 0.25))),
        (Vec3::new(2.0, 2.0, 0.5), 0.75, None),
        (Vec3::new(0.5, 0.375, 0.5), 0.25, Some((-Vec3::Y, 0.625))),
        (Vec3::new(0.75, 2.0, 0.5), 0.5, Some((Vec3::X, 0.75))),
    ] {
        for mode in [ContactMode::Thesis, ContactMode::Exact] {
            let found = contacts_by(mode, &body, &Thing::sphere(center, radius));
            let first = found.list.first().map(|t| (t.normal, t.depth));
            match (first, expected) {
                (None, None) => {}
                (Some(f), Some(e)) => {
                    near(f.0, e.0);
                    assert!((f.1 - e.1).abs() < TOLERANCE, "{center:?}: {f:?}, not {e:?}");
                }
                _ => panic!("{center:?}: {first:?}, not {expected:?}"),
            }
        }
    }
}
