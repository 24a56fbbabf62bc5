//! Shapes against the reference vectors, closed forms and each other.

use mrtphys::error::Error;
use mrtphys::math::{Mat3, Quat, Real, Vec3};
use mrtphys::shape::polyhedron::ConvexPiece;
use mrtphys::shape::{Polyhedron, Shape, limit_box, smallest_enclosing_sphere};
use proptest::prelude::*;
use serde_json::Value;

fn vectors(name: &str) -> Value {
    let path = format!("{}/tests/vectors/{name}.json", env!("CARGO_MANIFEST_DIR"));
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

fn vec3(v: &Value) -> Vec3 {
    Vec3::new(v[0].as_f64().unwrap(), v[1].as_f64().unwrap(), v[2].as_f64().unwrap())
}

fn vec3s(v: &Value) -> Vec<Vec3> {
    v.as_array().unwrap().iter().map(vec3).collect()
}

fn v(x: Real, y: Real, z: Real) -> Vec3 {
    Vec3::new(x, y, z)
}

fn sin(x: Real) -> Real {
    mrtphys::math::sin_cos(x).0
}

fn cos(x: Real) -> Real {
    mrtphys::math::sin_cos(x).1
}

fn seeded(cases: u32, seed: u64) -> ProptestConfig {
    ProptestConfig {
        cases,
        failure_persistence: None,
        rng_seed: proptest::test_runner::RngSeed::Fixed(seed),
        ..ProptestConfig::default()
    }
}

#[test]
fn smallest_spheres_of_the_vectors() {
    let file = vectors("min_sphere");
    let cases = file["cases"].as_array().unwrap();
    assert!(cases.len() > 10);
    for case in cases {
        let points = vec3s(&case["points"]);
        let ball = smallest_enclosing_sphere(&points);
        let r = case["radius"].as_f64().unwrap();
        assert!((ball.radius - r).abs() <= 1e-9 * r, "{} {r}", ball.radius);
        assert!((ball.center - vec3(&case["center"])).length() <= 1e-9 * r);
        assert!(points.iter().all(|p| (*p - ball.center).length_squared() <= ball.radius * ball.radius));
    }
}

#[test]
fn limit_boxes_of_the_vectors() {
    for case in vectors("limit_box")["cases"].as_array().unwrap() {
        let (p1, p2) = (vec3(&case["p1"]), vec3(&case["p2"]));
        let faces = limit_box(p1.min(p2), p1.max(p2)).unwrap();
        let names: Vec<&str> = faces.iter().map(|f| f.0).collect();
        assert_eq!(names, ["-x", "+x", "-y", "+y", "-z", "+z"]);
        for ((_, position, face), want) in faces.iter().zip(case["quads"].as_array().unwrap()) {
            assert_eq!(face.normal(), vec3(&want["n"]));
            let r = want["r"].as_f64().unwrap();
            assert!((*position - vec3(&want["c"])).length() <= 1e-15 * r);
            for (c, w) in face.corners().iter().zip(vec3s(&want["p"])) {
                assert!((*c + *position - w).length() <= 1e-15 * r);
            }
            let ball = face.bounding_sphere();
            assert!((ball.radius - r).abs() <= 2e-15 * r && ball.center == Vec3::ZERO);
            let b = face.bounding_box(*position, &Mat3::IDENTITY);
            assert!((b.min - vec3(&want["lo"])).length() <= 1e-15 * r);
            assert!((b.max - vec3(&want["hi"])).length() <= 1e-15 * r);
        }
    }
}

/// Everything that must hold of any polyhedron.
fn check(body: &Polyhedron) {
    let size = body.bounding_sphere().radius;
    let mass = body.mass_properties().unwrap();
    // closed: corners - edges + faces, where coplanar polygons may leave extra edges, is checked on the pieces
    let sum: Real = body.pieces().iter().map(ConvexPiece::volume).sum();
    assert!((sum - mass.volume).abs() <= 1e-12 * mass.volume, "{sum} {}", mass.volume);
    let mut outer = 0.0;
    for piece in body.pieces() {
        check_piece(piece, size);
        for f in piece.faces.iter().filter(|f| !f.internal) {
            outer += area(&piece.corners, &f.corners);
            // an outer face lies on the body's surface, seen from the same side
            let mid = centre(&piece.corners, &f.corners);
            assert!(
                body.triangles().iter().any(|t| {
                    let t = t.map(|i| body.corners()[i as usize]);
                    let n = (t[1] - t[0]).cross(t[2] - t[0]).try_normalize().unwrap();
                    let inside =
                        (0..3).all(|k| (t[(k + 1) % 3] - t[k]).cross(mid - t[k]).dot(n) >= -1e-9 * size * size);
                    n.dot(f.normal) > 0.999 && (mid - t[0]).dot(n).abs() <= 1e-9 * size && inside
                }),
                "face of a piece is not on the surface"
            );
        }
    }
    let surface: Real = body.faces().iter().map(|f| area(body.corners(), &f.corners)).sum();
    assert!((outer - surface).abs() <= 1e-11 * surface, "{outer} {surface}");
    for f in body.faces() {
        for &c in &f.corners {
            assert!((f.normal.dot(body.corners()[c as usize]) - f.offset).abs() <= 1e-9 * size);
        }
    }
    // the centroid is the origin
    let (mut volume, mut first) = (0.0, Vec3::ZERO);
    for t in body.triangles() {
        let [a, b, c] = t.map(|i| body.corners()[i as usize]);
        let d = a.dot(b.cross(c));
        volume += d / 6.0;
        first += (a + b + c) * (d / 24.0);
    }
    assert!((volume - mass.volume).abs() <= 1e-9 * volume);
    assert!(first.length() <= 1e-13 * volume * size, "{first:?}");
    for c in body.corners() {
        assert!((*c - body.bounding_sphere().center).length_squared() <= size * size);
    }
}

/// Closed, convex, outward normals, Euler's formula, edges between faces that are not coplanar.
fn check_piece(piece: &ConvexPiece, size: Real) {
    let mut directed = Vec::new();
    for f in &piece.faces {
        assert!((f.normal.length() - 1.0).abs() < 1e-15);
        for i in 0..f.corners.len() {
            directed.push((f.corners[i], f.corners[(i + 1) % f.corners.len()]));
        }
        for c in &piece.corners {
            assert!(f.normal.dot(*c) - f.offset <= 1e-9 * size);
        }
    }
    directed.sort_unstable();
    assert!(directed.windows(2).all(|w| w[0] != w[1]));
    assert!(directed.iter().all(|&(a, b)| directed.binary_search(&(b, a)).is_ok()));
    assert_eq!(piece.corners.len() as i64 - directed.len() as i64 / 2 + piece.faces.len() as i64, 2);
    for e in &piece.edges {
        let [f, g] = e.faces.map(|f| &piece.faces[f as usize]);
        assert!(f.normal.cross(g.normal).length() > 1e-9);
        let i = f.corners.iter().position(|&c| c == e.ends[0]).unwrap();
        assert_eq!(f.corners[(i + 1) % f.corners.len()], e.ends[1], "the first face runs along the edge");
        assert!(g.corners.contains(&e.ends[0]) && g.corners.contains(&e.ends[1]));
    }
    assert!(
        piece
            .corners
            .iter()
            .all(|c| (*c - piece.ball.center).length_squared() <= piece.ball.radius * piece.ball.radius)
    );
}

fn area(corners: &[Vec3], rim: &[u32]) -> Real {
    let p = |i: usize| corners[rim[i % rim.len()] as usize] - corners[rim[0] as usize];
    ((0..rim.len()).map(|i| p(i).cross(p(i + 1))).sum::<Vec3>() * 0.5).length()
}

fn centre(corners: &[Vec3], rim: &[u32]) -> Vec3 {
    rim.iter().map(|&c| corners[c as usize]).sum::<Vec3>() / rim.len() as Real
}

/// Points and faces.
type Mesh = (Vec<Vec3>, Vec<Vec<u32>>);

/// A prism over a profile (counter-clockwise in x, y) from z = 0 to the depth.
fn prism(profile: &[(Real, Real)], depth: Real) -> Mesh {
    let n = profile.len() as u32;
    let mut points: Vec<Vec3> = profile.iter().map(|&(x, y)| v(x, y, 0.0)).collect();
    points.extend(profile.iter().map(|&(x, y)| v(x, y, depth)));
    let mut faces = vec![(0..n).rev().collect::<Vec<u32>>(), (n..2 * n).collect()];
    faces.extend((0..n).map(|i| vec![i, (i + 1) % n, n + (i + 1) % n, n + i]));
    (points, faces)
}

const U: [(Real, Real); 8] =
    [(0.0, 0.0), (3.0, 0.0), (3.0, 3.0), (2.0, 3.0), (2.0, 1.0), (1.0, 1.0), (1.0, 3.0), (0.0, 3.0)];

fn tensor(body: &Polyhedron) -> Mat3 {
    let m = body.mass_properties().unwrap();
    m.axes.to_matrix().conjugate_diagonal(m.moments_per_mass)
}

fn close(a: &Mat3, b: &Mat3, tolerance: Real) -> bool {
    (0..3).all(|i| (a.c[i] - b.c[i]).max_abs() <= tolerance)
}

#[test]
fn box_in_closed_form_and_from_its_mesh() {
    let size = v(1.0, 2.0, 3.0);
    let b = Polyhedron::cuboid(size).unwrap();
    check(&b);
    assert_eq!((b.kind(), b.is_convex(), b.author_origin()), ("box", true, Vec3::ZERO));
    assert_eq!((b.corners().len(), b.faces().len(), b.edges().len(), b.triangles().len()), (8, 6, 12, 12));
    let m = b.mass_properties().unwrap();
    assert_eq!((m.volume, m.moments_per_mass, m.axes), (6.0, v(13.0, 10.0, 5.0) / 12.0, Quat::IDENTITY));
    assert_eq!(b.bounding_sphere().center, Vec3::ZERO);
    assert!((b.bounding_sphere().radius - 0.5 * 14f64.sqrt()).abs() < 1e-14);

    let at = v(5.0, -7.0, 0.25);
    let (points, faces) = prism(&[(0.0, 0.0), (1.0, 0.0), (1.0, 2.0), (0.0, 2.0)], 3.0);
    let moved: Vec<Vec3> = points.iter().map(|&p| p + at).collect();
    for c in [Polyhedron::from_mesh(&moved, &faces).unwrap(), Polyhedron::convex_hull(&moved).unwrap()] {
        check(&c);
        let n = c.mass_properties().unwrap();
        assert!((n.volume - 6.0).abs() < 1e-14);
        assert!((n.moments_per_mass - m.moments_per_mass).max_abs() < 1e-15);
        assert_eq!((n.axes, c.kind(), c.edges().len()), (Quat::IDENTITY, "polyhedron", 12));
        assert!((c.author_origin() + at + size * 0.5).max_abs() < 1e-14);
    }
    // triangulated, with points in the middle of faces and edges: still six faces, twelve edges, eight corners
    let mut fine = Vec::new();
    for i in 0..27 {
        fine.push(v((i % 3) as Real, (i / 3 % 3) as Real, (i / 9) as Real));
    }
    let hull = Polyhedron::convex_hull(&fine).unwrap();
    assert_eq!((hull.corners().len(), hull.faces().len(), hull.edges().len()), (8, 6, 12));
    let cube = Polyhedron::cuboid(Vec3::splat(2.0)).unwrap().mass_properties().unwrap().moments_per_mass;
    assert!(cube.x == cube.y && cube.y == cube.z);
}

#[test]
fn subdivided_faces_are_one() {
    // a cube whose faces are given as 2 x 2 squares, each as two triangles
    let mut points = Vec::new();
    let mut faces = Vec::new();
    let mut number = |p: Vec3| {
        points.iter().position(|&q| q == p).unwrap_or_else(|| {
            points.push(p);
            points.len() - 1
        }) as u32
    };
    for axis in 0..3 {
        for high in [false, true] {
            for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let mut at = |a: i32, b: i32| {
                    let mut p = Vec3::ZERO;
                    p[axis] = if high { 2.0 } else { 0.0 };
                    p[(axis + 1) % 3] = a.into();
                    p[(axis + 2) % 3] = b.into();
                    number(p)
                };
                let q = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                let q = if high { q } else { [q[3], q[2], q[1], q[0]] };
                faces.extend([vec![q[0], q[1], q[2]], vec![q[0], q[2], q[3]]]);
            }
        }
    }
    let turn = Quat::from_axis_angle(v(0.6, 0.0, 0.8), 1.1).to_matrix();
    for rotation in [Mat3::IDENTITY, turn] {
        let turned: Vec<Vec3> = points.iter().map(|&p| rotation * p).collect();
        let b = Polyhedron::from_mesh(&turned, &faces).unwrap();
        check(&b);
        assert_eq!((b.corners().len(), b.faces().len(), b.edges().len()), (8, 6, 12));
        assert_eq!((b.triangles().len(), b.is_convex()), (12, true));
        let m = b.mass_properties().unwrap().moments_per_mass;
        assert!(m.x == m.y && m.y == m.z && (m.x - 4.0 / 6.0).abs() < 1e-14, "{m:?}");
    }
}

#[test]
fn tetrahedron_and_octahedron_in_closed_form() {
    let r = 1.7;
    let t = Polyhedron::tetrahedron(r).unwrap();
    check(&t);
    let edge = r * (8.0f64 / 3.0).sqrt();
    let m = t.mass_properties().unwrap();
    assert_eq!((t.kind(), t.faces().len(), t.edges().len()), ("tetrahedron", 4, 6));
    assert!((m.volume - edge.powi(3) / (6.0 * 2f64.sqrt())).abs() < 1e-14);
    assert!((m.moments_per_mass.x - edge * edge / 20.0).abs() < 1e-15);
    assert!(m.moments_per_mass.x == m.moments_per_mass.y && m.moments_per_mass.y == m.moments_per_mass.z);
    let s = r / 3f64.sqrt();
    assert_eq!(t.corners(), [v(s, s, s), v(s, -s, -s), v(-s, s, -s), v(-s, -s, s)]);
    assert!((t.bounding_sphere().radius - r).abs() < 4e-15 && t.bounding_sphere().center == Vec3::ZERO);
    // the same from its points, either way round
    let p = [t.corners()[0], t.corners()[1], t.corners()[2], t.corners()[3]];
    for q in [p, [p[0], p[2], p[1], p[3]]] {
        let u = Polyhedron::tetrahedron_from_points(q).unwrap();
        check(&u);
        let n = u.mass_properties().unwrap();
        assert!((n.volume - m.volume).abs() < 1e-14 && (n.moments_per_mass - m.moments_per_mass).max_abs() < 1e-15);
        assert!(n.moments_per_mass.x == n.moments_per_mass.y && n.moments_per_mass.y == n.moments_per_mass.z);
    }
    let flat = Polyhedron::tetrahedron_from_points([Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::X + Vec3::Y]);
    assert_eq!(flat, Err(Error::Degenerate { object: "tetrahedron".into(), rank: 2 }));
    // octahedron with edge a: sqrt 2/3 a^3, a^2/10
    let points = [Vec3::X, -Vec3::X, Vec3::Y, -Vec3::Y, Vec3::Z, -Vec3::Z];
    let o = Polyhedron::convex_hull(&points).unwrap();
    check(&o);
    let m = o.mass_properties().unwrap();
    assert!((m.volume - 4.0 / 3.0).abs() < 1e-15 && (m.moments_per_mass - Vec3::splat(0.2)).max_abs() < 1e-15);
    assert_eq!((o.faces().len(), o.edges().len(), o.corners()), (8, 12, &points[..]));
    for bad in [0.0, -1.0, 1e60] {
        assert!(matches!(Polyhedron::tetrahedron(bad), Err(Error::OutOfRange { .. })));
        assert!(matches!(Polyhedron::cuboid(v(1.0, bad, 1.0)), Err(Error::OutOfRange { .. })));
    }
    assert!(matches!(Polyhedron::tetrahedron(Real::NAN), Err(Error::NonFinite { .. })));
}

#[test]
fn u_shape_is_the_sum_of_its_boxes() {
    let (points, faces) = prism(&U, 2.0);
    let u = Polyhedron::from_mesh(&points, &faces).unwrap();
    check(&u);
    assert_eq!((u.pieces().len(), u.faces().len(), u.edges().len()), (3, 10, 24));
    // three boxes (size, centre), mass by volume, each with its own inertia and Steiner's term
    let boxes = [
        (v(3.0, 1.0, 2.0), v(1.5, 0.5, 1.0)),
        (v(1.0, 2.0, 2.0), v(0.5, 2.0, 1.0)),
        (v(1.0, 2.0, 2.0), v(2.5, 2.0, 1.0)),
    ];
    let volume: Real = boxes.iter().map(|(s, _)| s.x * s.y * s.z).sum();
    let center = boxes.iter().map(|(s, c)| *c * (s.x * s.y * s.z)).sum::<Vec3>() / volume;
    let mut j = Vec3::ZERO;
    for (s, c) in boxes {
        let d = c - center;
        let sq = |a: Real, b: Real| a * a + b * b;
        let own = v(sq(s.y, s.z), sq(s.z, s.x), sq(s.x, s.y)) / 12.0;
        j += (own + v(sq(d.y, d.z), sq(d.z, d.x), sq(d.x, d.y))) * (s.x * s.y * s.z / volume);
    }
    let m = u.mass_properties().unwrap();
    assert!((m.volume - volume).abs() < 1e-13);
    assert!((u.author_origin() + center).max_abs() < 1e-14);
    assert!(close(&tensor(&u), &Mat3::diagonal(j), 1e-14), "{:?} {j:?}", tensor(&u));
    // cuts are inside: two internal faces on each of the two cuts
    let cuts: Vec<Real> = u
        .pieces()
        .iter()
        .flat_map(|p| p.faces.iter().filter(|f| f.internal).map(|f| area(&p.corners, &f.corners)))
        .collect();
    assert!((cuts.iter().sum::<Real>() - 8.0).abs() < 1e-12, "{cuts:?}");
}

fn star(points: usize) -> Vec<(Real, Real)> {
    (0..2 * points)
        .map(|i| {
            let a = std::f64::consts::PI * i as Real / points as Real;
            let r = if i % 2 == 0 { 2.0 } else { 0.8 };
            (r * cos(a), r * sin(a))
        })
        .collect()
}

/// A cube with a smaller box taken out of the middle of one of its edges' middles: a notch, with a face that has a bay.
fn notched_box() -> Mesh {
    // outer cube 0..4, notch x 1..3, y 2..4 (open at the top), z 3..4 (open at the front)
    let points = vec![
        v(0.0, 0.0, 0.0),
        v(4.0, 0.0, 0.0),
        v(4.0, 4.0, 0.0),
        v(0.0, 4.0, 0.0),
        v(0.0, 0.0, 4.0),
        v(4.0, 0.0, 4.0),
        v(4.0, 4.0, 4.0),
        v(0.0, 4.0, 4.0),
        v(1.0, 4.0, 4.0),
        v(3.0, 4.0, 4.0),
        v(1.0, 2.0, 4.0),
        v(3.0, 2.0, 4.0),
        v(1.0, 4.0, 3.0),
        v(3.0, 4.0, 3.0),
        v(1.0, 2.0, 3.0),
        v(3.0, 2.0, 3.0),
    ];
    let faces = vec![
        vec![0, 3, 2, 1],
        vec![0, 1, 5, 4],
        vec![0, 4, 7, 3],
        vec![1, 2, 6, 5],
        vec![4, 5, 6, 9, 11, 10, 8, 7],
        vec![3, 7, 8, 12, 13, 9, 6, 2],
        vec![12, 14, 15, 13],
        vec![8, 10, 14, 12],
        vec![9, 13, 15, 11],
        vec![10, 11, 15, 14],
    ];
    (points, faces)
}

#[test]
fn non_convex_bodies_in_pieces() {
    let l = [(0.0, 0.0), (3.0, 0.0), (3.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)];
    let plus = [
        (1.0, 0.0),
        (2.0, 0.0),
        (2.0, 1.0),
        (3.0, 1.0),
        (3.0, 2.0),
        (2.0, 2.0),
        (2.0, 3.0),
        (1.0, 3.0),
        (1.0, 2.0),
        (0.0, 2.0),
        (0.0, 1.0),
        (1.0, 1.0),
    ];
    let cases: Vec<(&str, Mesh, std::ops::RangeInclusive<usize>)> = vec![
        ("L", prism(&l, 1.0), 2..=2),
        ("U", prism(&U, 1.0), 3..=3),
        ("plus", prism(&plus, 1.0), 3..=3),
        ("star", prism(&star(5), 0.5), 4..=6),
        ("star of 12", prism(&star(12), 0.5), 7..=16),
        ("notch", notched_box(), 3..=4),
    ];
    let turn = Quat::from_axis_angle(v(2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0), 0.83).to_matrix();
    for (name, (points, faces), count) in cases {
        for (rotation, shift) in [(Mat3::IDENTITY, Vec3::ZERO), (turn, v(10.0, -20.0, 5.0))] {
            let p: Vec<Vec3> = points.iter().map(|&p| rotation * p + shift).collect();
            let body = Polyhedron::from_mesh(&p, &faces).unwrap_or_else(|e| panic!("{name}: {e}"));
            println!("{name}: {} pieces", body.pieces().len());
            check(&body);
            assert!(count.contains(&body.pieces().len()), "{name}: {}", body.pieces().len());
            assert!(!body.is_convex());
        }
    }
}

/// A square ring: the top is an annulus, so it must be given as four quadrangles and stays them.
fn ring() -> Mesh {
    let mut points = Vec::new();
    for z in [0.0, 1.0] {
        for r in [2.0, 1.0] {
            points.extend([v(-r, -r, z), v(r, -r, z), v(r, r, z), v(-r, r, z)]);
        }
    }
    let mut faces = Vec::new();
    for i in 0..4u32 {
        let j = (i + 1) % 4;
        faces.push(vec![i, j, 8 + j, 8 + i]);
        faces.push(vec![4 + j, 4 + i, 12 + i, 12 + j]);
        faces.push(vec![8 + i, 8 + j, 12 + j, 12 + i]);
        faces.push(vec![j, i, 4 + i, 4 + j]);
    }
    (points, faces)
}

#[test]
fn ring_with_a_hole_through() {
    let (points, faces) = ring();
    let body = Polyhedron::from_mesh(&points, &faces).unwrap();
    check(&body);
    assert_eq!((body.pieces().len(), body.edges().len()), (4, 24));
    assert_eq!(body.mass_properties().unwrap().volume, 12.0);
}

fn refused(points: &[Vec3], faces: &[Vec<u32>], face: Option<usize>, why: &str) {
    match Polyhedron::from_mesh(points, faces) {
        Err(Error::InvalidMesh { face: f, reason, .. }) => {
            assert!(reason.contains(why), "{reason}");
            assert!(face.is_none() || face == f, "{f:?}: {reason}");
        }
        other => panic!("{why}: {other:?}"),
    }
}

#[test]
fn invalid_meshes_are_refused_by_name() {
    let (points, faces) = prism(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)], 1.0);
    let with = |f: usize, corners: Vec<u32>| {
        let mut g = faces.clone();
        g[f] = corners;
        g
    };
    assert!(Polyhedron::from_mesh(&points, &faces).is_ok());
    refused(&points, &with(2, vec![0, 1, 5, 99]), Some(2), "point 99 does not exist");
    refused(&points, &with(2, vec![0, 1, 5, 1]), Some(2), "point 1 is used twice");
    refused(&points, &with(2, vec![0, 1]), Some(2), "2 corners");
    refused(&points, &faces[1..], None, "open");
    let mut more = faces.clone();
    more.push(vec![0, 1, 6]);
    refused(&points, &more, None, "more than two faces");
    refused(&points, &with(2, vec![4, 5, 1, 0]), None, "same direction");
    let inside_out: Vec<Vec<u32>> = faces.iter().map(|f| f.iter().rev().copied().collect()).collect();
    refused(&points, &inside_out, None, "inside out");
    let mut bent = points.clone();
    bent[0].z = 0.01;
    refused(&bent, &faces, Some(0), "not plane");
    let mut p = points.clone();
    p.push(v(0.5, 0.0, 0.0));
    p.push(v(0.25, 0.0, 0.0));
    refused(&p, &with(2, vec![0, 8, 9]), Some(2), "no area");
    p[8] = p[0];
    refused(&p, &with(2, vec![8, 1, 5, 4]), None, "coincide");
    let bow = [v(0.0, 0.0, 0.0), v(2.0, 1.0, 0.0), v(2.0, 0.0, 0.0), v(0.0, 2.0, 0.0), v(0.0, 0.0, 1.0)];
    let pyramid = vec![vec![3, 2, 1, 0], vec![0, 1, 4], vec![1, 2, 4], vec![2, 3, 4], vec![3, 0, 4]];
    refused(&bow, &pyramid, Some(0), "outline meets itself");
    // two separate boxes; two tetrahedra that touch in a point
    let mut two = points.clone();
    two.extend(points.iter().map(|&p| p + Vec3::X * 5.0));
    let mut both = faces.clone();
    both.extend(faces.iter().map(|f| f.iter().map(|c| c + 8).collect::<Vec<u32>>()));
    refused(&two, &both, Some(6), "several surfaces");
    let tip = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X, -Vec3::Y, -Vec3::Z];
    let up = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    let down = [[0, 4, 5], [0, 6, 4], [0, 5, 6], [4, 6, 5]];
    let touching: Vec<Vec<u32>> = up.iter().chain(&down).map(|t| t.to_vec()).collect();
    refused(&tip, &touching, None, "touch in point 0");
    // a spike pushed through the opposite face of a tetrahedron
    let pierced = [v(0.0, 0.0, 0.0), v(4.0, 0.0, 0.0), v(0.0, 4.0, 0.0), v(0.0, 0.0, 4.0), v(1.0, 1.0, -1.0)];
    let spike = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 4], [2, 3, 4], [3, 1, 4]].map(|t| t.to_vec());
    refused(&pierced, &spike, None, "meets itself");
    // a double-sided triangle
    let flat = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
    refused(&flat, &[vec![0, 1, 2], vec![0, 2, 1]], None, "no volume");
    let mut bad = points.clone();
    bad[3].y = Real::NAN;
    assert!(matches!(Polyhedron::from_mesh(&bad, &faces), Err(Error::NonFinite { .. })));
    let huge: Vec<Vec3> = points.iter().map(|&p| p * 1e60).collect();
    assert!(matches!(Polyhedron::from_mesh(&huge, &faces), Err(Error::OutOfRange { .. })));
    assert!(matches!(Polyhedron::from_mesh(&points[..2], &faces), Err(Error::TooFewPoints { .. })));
    assert!(Polyhedron::from_mesh(&points, &[]).is_err());
}

#[test]
fn sizes_needles_and_many_corners() {
    for s in [1e-50, 1e-23, 1e49] {
        let p: Vec<Vec3> = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z].iter().map(|&p| p * s).collect();
        let b = Polyhedron::convex_hull(&p).unwrap();
        let m = b.mass_properties().unwrap();
        assert!((m.volume / s / s / s - 1.0 / 6.0).abs() < 1e-15);
        assert!((m.moments_per_mass.min(Vec3::splat(1e300)) / s / s).max_abs() < 1.0);
    }
    // a needle 1 : 10^6 askew, a prism of 240 sides
    let turn = Quat::from_axis_angle(v(2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0), 0.83).to_matrix();
    let profile: Vec<(Real, Real)> = (0..240)
        .map(|i| {
            let a = i as Real * std::f64::consts::PI / 120.0;
            (cos(a) * 1e-6, sin(a) * 1e-6)
        })
        .collect();
    let (points, faces) = prism(&profile, 1.0);
    let area = 120.0 * sin(std::f64::consts::PI / 120.0) * 1e-12;
    for rotation in [Mat3::IDENTITY, turn] {
        let p: Vec<Vec3> = points.iter().map(|&p| rotation * p).collect();
        for b in [Polyhedron::from_mesh(&p, &faces).unwrap(), Polyhedron::convex_hull(&p).unwrap()] {
            let m = b.mass_properties().unwrap();
            assert!((m.volume / area - 1.0).abs() < 1e-8, "{} {area}", m.volume);
            assert_eq!((b.faces().len(), b.edges().len(), b.is_convex()), (242, 720, true));
            let mut j = m.moments_per_mass.to_array();
            j.sort_by(Real::total_cmp);
            assert!((j[2] - 1.0 / 12.0).abs() < 1e-12 && j[0] < 1e-11 && j[0] > 0.0, "{j:?}");
        }
    }
    let lattice: Vec<Vec3> = (0..40_000)
        .map(|i| {
            let z = 1.0 - 2.0 * (i as Real + 0.5) / 40_000.0;
            let (s, c) = mrtphys::math::sin_cos(2.399963229728653 * i as Real);
            v((1.0 - z * z).sqrt() * c, (1.0 - z * z).sqrt() * s, z)
        })
        .collect();
    assert!(matches!(Polyhedron::convex_hull(&lattice), Err(Error::LimitExceeded { what: "corners", .. })));
}

proptest! {
    #![proptest_config(seeded(60, 3))]

    #[test]
    fn hulls_hold_their_points_and_turn_with_them(
        raw in prop::collection::vec((-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64), 6..40),
        axis in (-1.0..1.0f64, -1.0..1.0f64, 0.1..1.0f64),
        angle in 0.0..6.0f64,
        k in -40..40i32,
    ) {
        let points: Vec<Vec3> = raw.iter().map(|&(x, y, z)| v(x, y, z)).collect();
        let b = Polyhedron::convex_hull(&points).unwrap();
        check(&b);
        prop_assert!(b.is_convex());
        for f in b.faces() {
            for p in &points {
                prop_assert!(f.normal.dot(*p + b.author_origin()) <= f.offset + 1e-12);
            }
        }
        // the hull of the hull
        let again = Polyhedron::convex_hull(b.corners()).unwrap();
        prop_assert_eq!(again.author_origin(), Vec3::ZERO);
        prop_assert_eq!(again.corners(), b.corners());
        prop_assert_eq!(again.faces().len(), b.faces().len());
        // turned
        let axis = v(axis.0, axis.1, axis.2).try_normalize().unwrap();
        let r = Quat::from_axis_angle(axis, angle).to_matrix();
        let turned: Vec<Vec3> = points.iter().map(|&p| r * p).collect();
        let t = Polyhedron::convex_hull(&turned).unwrap();
        let want = r * tensor(&b) * r.transpose();
        prop_assert!(close(&tensor(&t), &want, 1e-13));
        let (mb, mt) = (b.mass_properties().unwrap(), t.mass_properties().unwrap());
        prop_assert!((mb.volume - mt.volume).abs() <= 1e-13);
        // scaled by a power of two: the same bits
        let s = libm::ldexp(1.0, k);
        let scaled: Vec<Vec3> = points.iter().map(|&p| p * s).collect();
        let c = Polyhedron::convex_hull(&scaled).unwrap();
        prop_assert_eq!(c.triangles(), b.triangles());
        prop_assert_eq!(c.mass_properties().unwrap().volume, mb.volume * s * s * s);
        prop_assert_eq!(c.mass_properties().unwrap().moments_per_mass, mb.moments_per_mass * s * s);
        prop_assert_eq!(c.mass_properties().unwrap().axes, mb.axes);
        prop_assert_eq!(c.bounding_sphere().radius, b.bounding_sphere().radius * s);
        prop_assert!(c.corners().iter().zip(b.corners()).all(|(x, y)| *x == *y * s));
    }

    /// Prisms over random star-shaped profiles, turned: pieces, skin and cuts all fit, and scaling keeps the bits.
    #[test]
    fn random_prisms_in_pieces(radii in prop::collection::vec(0.3..2.0f64, 5..14), angle in 0.0..6.0f64, k in -40..40i32) {
        let n = radii.len();
        let profile: Vec<(Real, Real)> = radii.iter().enumerate().map(|(i, r)| {
            let a = std::f64::consts::TAU * i as Real / n as Real;
            (r * cos(a), r * sin(a))
        }).collect();
        let (points, faces) = prism(&profile, 0.7);
        let r = Quat::from_axis_angle(v(2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0), angle).to_matrix();
        let points: Vec<Vec3> = points.iter().map(|&p| r * p).collect();
        let b = Polyhedron::from_mesh(&points, &faces).unwrap();
        check(&b);
        let s = libm::ldexp(1.0, k);
        let scaled: Vec<Vec3> = points.iter().map(|&p| p * s).collect();
        let c = Polyhedron::from_mesh(&scaled, &faces).unwrap();
        prop_assert_eq!(c.pieces().len(), b.pieces().len());
        for (p, q) in c.pieces().iter().zip(b.pieces()) {
            prop_assert!(p.corners.iter().zip(&q.corners).all(|(x, y)| *x == *y * s));
            prop_assert_eq!(&p.edges, &q.edges);
            prop_assert!(p.faces.iter().zip(&q.faces).all(|(f, g)| f.internal == g.internal && f.normal == g.normal));
        }
    }
}

/// An octahedron, every triangle divided into n x n, pushed out to a sphere.
fn globe(n: usize) -> Mesh {
    let mut points: Vec<Vec3> = Vec::new();
    let mut faces = Vec::new();
    let mut number = |p: Vec3| {
        points.iter().position(|&q| q == p).unwrap_or_else(|| {
            points.push(p);
            points.len() - 1
        }) as u32
    };
    for octant in 0..8 {
        let sign = |bit: usize| if octant >> bit & 1 == 1 { -1.0 } else { 1.0 };
        let mut at = |i: usize, j: usize| {
            number(v(sign(0) * i as Real, sign(1) * j as Real, sign(2) * (n - i - j) as Real) + Vec3::ZERO)
        };
        let mut add = |a: [u32; 3]| {
            let odd = (octant as u32).count_ones() % 2 == 1;
            faces.push(if odd { vec![a[0], a[2], a[1]] } else { a.to_vec() });
        };
        for i in 0..n {
            for j in 0..n - i {
                add([at(i, j), at(i + 1, j), at(i, j + 1)]);
                if i + j + 1 < n {
                    add([at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
                }
            }
        }
    }
    (points.iter().map(|p| p.try_normalize().unwrap()).collect(), faces)
}

/// Bumpy bodies: star-shaped, with reflex edges in all directions.
#[test]
fn bumpy_globes_in_pieces() {
    let mut seed = 12345u64;
    let mut random = || {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (seed >> 40) as Real / (1u64 << 24) as Real
    };
    for n in [1, 2, 2, 2, 3, 3, 4, 8, 24] {
        let (mut points, faces) = globe(n);
        for p in &mut points {
            *p = *p * (0.6 + 0.8 * random());
        }
        let body = Polyhedron::from_mesh(&points, &faces);
        if n == 24 {
            assert!(matches!(body, Err(Error::LimitExceeded { what: "convex pieces", .. })), "{body:?}");
            continue;
        }
        let body = body.unwrap();
        println!("{} faces: {} pieces", faces.len(), body.pieces().len());
        check(&body);
    }
}

#[test]
fn regular_bodies_stay_regular_when_turned() {
    let (cube, tetrahedron) = (Polyhedron::cuboid(Vec3::splat(1.0)).unwrap(), Polyhedron::tetrahedron(1.0).unwrap());
    for i in 0..200 {
        let axis = v(1.0, 0.3 * i as Real, 2.0 - 0.1 * i as Real).try_normalize().unwrap();
        let r = Quat::from_axis_angle(axis, 0.37 * i as Real).to_matrix();
        for body in [&cube, &tetrahedron] {
            let turned: Vec<Vec3> = body.corners().iter().map(|&c| r * c).collect();
            let turned = Polyhedron::convex_hull(&turned).unwrap();
            let m = turned.mass_properties().unwrap();
            assert!(m.moments_per_mass.x == m.moments_per_mass.y && m.moments_per_mass.y == m.moments_per_mass.z);
            assert_eq!((m.axes, turned.faces().len()), (Quat::IDENTITY, body.faces().len()));
        }
    }
}

proptest! {
    #![proptest_config(seeded(3000, 4))]

    /// Whatever comes in: an error or a body that is sound, never a panic.
    #[test]
    fn nonsense_is_answered(
        raw in prop::collection::vec((-2..3i32, -2..3i32, -2..3i32), 0..7),
        faces in prop::collection::vec(prop::collection::vec(0..7u32, 0..5), 0..8),
        stretch in prop_oneof![Just(1.0), Just(1e-9), Just(1e-14), Just(1e30)],
    ) {
        let points: Vec<Vec3> = raw.iter().map(|&(x, y, z)| v(x.into(), y.into(), Real::from(z) * stretch)).collect();
        if let Ok(b) = Polyhedron::from_mesh(&points, &faces) {
            check(&b);
        }
        if let Ok(b) = Polyhedron::convex_hull(&points) {
            prop_assert!(b.is_convex() && b.volume() > 0.0 && b.corners().len() >= 4);
        }
    }

    /// An octahedron whose corners wander: often not convex, often crossing itself, sometimes flat.
    #[test]
    fn wandering_octahedra(raw in prop::array::uniform6((-2..3i32, -2..3i32, -2..3i32))) {
        let base = [Vec3::Z, Vec3::X, Vec3::Y, -Vec3::X, -Vec3::Y, -Vec3::Z];
        let points: Vec<Vec3> =
            base.iter().zip(raw).map(|(&b, (x, y, z))| b * 2.0 + v(x.into(), y.into(), z.into())).collect();
        let faces = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1], [5, 2, 1], [5, 3, 2], [5, 4, 3], [5, 1, 4]];
        let faces = faces.map(|t| t.to_vec());
        match Polyhedron::from_mesh(&points, &faces) {
            Ok(b) => check(&b),
            Err(e) => prop_assert!(matches!(e, Error::InvalidMesh { .. }), "{e}"),
        }
    }
}
