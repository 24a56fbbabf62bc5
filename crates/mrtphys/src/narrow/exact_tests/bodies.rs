//! Bodies for the tests, built the slow way: every plane through three points that has all others on one side is a face.

use crate::bounds::Ball;
use crate::math::{Mat3, Quat, Real, Vec3};
use crate::narrow::{Placed, Routine, Touches};
use crate::shape::polyhedron::{ConvexPiece, Edge, Face};
use crate::shape::{HalfSpace, MassProperties, Polyhedron, Quadrangle, Shape, Sphere};

/// Numbers that look random and are the same every time (Marsaglia's xorshift).
pub struct Dice(u64);

impl Dice {
    pub fn new(seed: u64) -> Dice {
        Dice(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }
    pub fn unit(&mut self) -> Real {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as Real / (1u64 << 53) as Real
    }
    pub fn within(&mut self, low: Real, high: Real) -> Real {
        low + (high - low) * self.unit()
    }
    pub fn vector(&mut self, size: Real) -> Vec3 {
        Vec3::new(self.within(-size, size), self.within(-size, size), self.within(-size, size))
    }
    pub fn direction(&mut self) -> Vec3 {
        loop {
            let v = self.vector(1.0);
            if v.length() > 0.1 && v.length() < 1.0 {
                return v.try_normalize().unwrap();
            }
        }
    }
    pub fn rotation(&mut self) -> Mat3 {
        let axis = self.direction();
        Quat::from_axis_angle(axis, self.within(0.0, 6.0)).to_matrix()
    }
}

/// The convex hull of a few points as a piece; faces on one of the given planes (point, normal) are internal.
pub fn piece(points: &[Vec3], cuts: &[(Vec3, Vec3)]) -> ConvexPiece {
    let mut faces: Vec<Face> = Vec::new();
    let size = points.iter().map(|p| p.length()).fold(0.0, Real::max);
    let count = points.len();
    for (i, j, k) in (0..count).flat_map(|i| (0..count).flat_map(move |j| (0..count).map(move |k| (i, j, k)))) {
        let Some(normal) = (points[j] - points[i]).cross(points[k] - points[i]).try_normalize() else { continue };
        let offset = normal.dot(points[i]);
        let is_new = faces.iter().all(|f| f.normal.dot(normal) < 1.0 - 1e-12);
        if is_new && points.iter().all(|p| normal.dot(*p) <= offset + 1e-12 * size) {
            let mut on: Vec<u32> = (0..count as u32)
                .filter(|&p| (normal.dot(points[p as usize]) - offset).abs() <= 1e-12 * size)
                .collect();
            let middle = on.iter().map(|&p| points[p as usize]).sum::<Vec3>() / on.len() as Real;
            let (u, v) = (normal.any_perpendicular(), normal.cross(normal.any_perpendicular()));
            let angle = |p: u32| {
                let d = points[p as usize] - middle;
                libm::atan2(v.dot(d), u.dot(d))
            };
            on.sort_by(|&p, &q| angle(p).total_cmp(&angle(q)));
            let internal =
                cuts.iter().any(|(p, n)| n.dot(normal) > 1.0 - 1e-12 && (n.dot(*p) - offset).abs() < 1e-12 * size);
            faces.push(Face { corners: on, normal, offset, internal });
        }
    }
    let mut edges = Vec::new();
    for (f, face) in faces.iter().enumerate() {
        for (g, other) in faces.iter().enumerate().skip(f + 1) {
            let shared: Vec<u32> = face.corners.iter().copied().filter(|c| other.corners.contains(c)).collect();
            if let [p, q] = shared[..] {
                edges.push(Edge { ends: [p, q], faces: [f as u32, g as u32] });
            }
        }
    }
    assert_eq!(points.len() + faces.len(), edges.len() + 2, "Euler");
    ConvexPiece { corners: points.to_vec(), faces, edges, ball: ball_of(points) }
}

pub fn ball_of(points: &[Vec3]) -> Ball {
    let center = points.iter().copied().sum::<Vec3>() / points.len() as Real;
    Ball { center, radius: points.iter().map(|p| (*p - center).length()).fold(0.0, Real::max) * (1.0 + 1e-15) }
}

const NO_MASS: MassProperties =
    MassProperties { volume: 1.0, moments_per_mass: Vec3::splat(1.0), axes: Quat::IDENTITY };

pub fn polyhedron(pieces: Vec<ConvexPiece>) -> Polyhedron {
    let corners: Vec<Vec3> = pieces.iter().flat_map(|p| p.corners.iter().copied()).collect();
    Polyhedron {
        ball: ball_of(&corners),
        corners,
        triangles: Vec::new(),
        faces: Vec::new(),
        edges: Vec::new(),
        pieces,
        mass: NO_MASS,
        author_origin: Vec3::ZERO,
        kind: "polyhedron",
    }
}

pub fn hull(points: &[Vec3]) -> Polyhedron {
    polyhedron(vec![piece(points, &[])])
}

pub fn box_points(low: Vec3, high: Vec3) -> Vec<Vec3> {
    let pick = |bit: usize, l: Real, h: Real| if bit == 0 { l } else { h };
    (0..8)
        .map(|i| Vec3::new(pick(i & 1, low.x, high.x), pick(i & 2, low.y, high.y), pick(i & 4, low.z, high.z)))
        .collect()
}

/// A box with these half edges.
pub fn cuboid(x: Real, y: Real, z: Real) -> Polyhedron {
    hull(&box_points(Vec3::new(-x, -y, -z), Vec3::new(x, y, z)))
}

/// A box of several boxes (low, high corner), and the planes at which they are cut.
pub fn boxes(parts: &[(Vec3, Vec3)], cuts: &[(Vec3, Vec3)]) -> Polyhedron {
    polyhedron(parts.iter().map(|(l, h)| piece(&box_points(*l, *h), cuts)).collect())
}

/// A random tetrahedron, box, or hull of a few points on a sphere.
pub fn any_body(dice: &mut Dice) -> Polyhedron {
    match (dice.unit() * 3.0) as u32 {
        0 => loop {
            let p: Vec<Vec3> = (0..4).map(|_| dice.vector(1.0)).collect();
            if (p[1] - p[0]).cross(p[2] - p[0]).dot(p[3] - p[0]).abs() > 0.2 {
                let middle = p.iter().copied().sum::<Vec3>() / 4.0;
                return hull(&p.iter().map(|q| *q - middle).collect::<Vec<_>>());
            }
        },
        1 => cuboid(dice.within(0.2, 1.0), dice.within(0.2, 1.0), dice.within(0.2, 1.0)),
        _ => {
            let count = 6 + (dice.unit() * 8.0) as usize;
            hull(&(0..count).map(|_| dice.direction()).collect::<Vec<_>>())
        }
    }
}

pub fn quadrangle(corners: [Vec3; 4]) -> Quadrangle {
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).try_normalize().unwrap();
    Quadrangle { corners, normal, ball: ball_of(&corners), mass: NO_MASS, author_origin: Vec3::ZERO }
}

/// A rectangle in the plane y = 0 with these half edges, normal up.
pub fn plate(x: Real, z: Real) -> Quadrangle {
    quadrangle([Vec3::new(-x, 0.0, -z), Vec3::new(-x, 0.0, z), Vec3::new(x, 0.0, z), Vec3::new(x, 0.0, -z)])
}

pub fn ball(radius: Real) -> Sphere {
    Sphere::new(radius).unwrap()
}

pub fn wall(normal: Vec3) -> HalfSpace {
    HalfSpace { normal }
}

pub fn placed<'a>(shape: &'a dyn Shape, position: Vec3, rotation: &'a Mat3) -> Placed<'a> {
    let ball = crate::bounds::placed_ball(&shape.bounding_sphere(), position, rotation);
    Placed { shape, position, rotation, ball, home_side: 0.0 }
}

pub fn contacts(routine: Routine, a: &Placed<'_>, b: &Placed<'_>) -> Touches {
    let mut out = Touches::default();
    routine(a, b, &mut out);
    for t in &out.list {
        assert!((t.normal.length() - 1.0).abs() < 4e-16, "unit normal {:?}", t.normal);
        assert!(t.depth >= 0.0 && t.point.is_finite() && t.point_count > 0, "{t:?}");
    }
    out
}

pub fn close(a: Vec3, b: Vec3, tolerance: Real) -> bool {
    (a - b).length() <= tolerance
}
