//! Scenes that several tests share.
#![allow(dead_code, reason = "each test file uses its own part")]

use mrtphys::shape::{Polyhedron, Shape, Sphere};
use mrtphys::{BodyDef, Settings, Surface, Vec3, World};
use std::sync::Arc;

/// SplitMix64: the same numbers on every machine.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in [-1, 1).
    pub fn signed(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    pub fn vector(&mut self) -> Vec3 {
        Vec3::new(self.signed(), self.signed(), self.signed())
    }

    pub fn direction(&mut self) -> Vec3 {
        loop {
            let v = self.vector();
            if (0.01..=1.0).contains(&v.length_squared()) {
                return v / v.length();
            }
        }
    }
}

/// Shapes of the gases that the proof asks for, each within a sphere of radius r.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    Spheres,
    Tetrahedra,
    Boxes,
    UShapes,
}

pub const KINDS: [Kind; 4] = [Kind::Spheres, Kind::Tetrahedra, Kind::Boxes, Kind::UShapes];

impl Kind {
    pub fn shape(self, r: f64) -> Arc<dyn Shape> {
        match self {
            Kind::Spheres => Arc::new(Sphere::new(r).unwrap()),
            Kind::Tetrahedra => Arc::new(Polyhedron::tetrahedron(r).unwrap()),
            Kind::Boxes => {
                let sides = Vec3::new(1.0, 0.7, 0.4);
                Arc::new(Polyhedron::cuboid(sides * (2.0 * r / sides.length())).unwrap())
            }
            Kind::UShapes => Arc::new(u_shape(r)),
        }
    }
}

/// A U profile of three bars, drawn out into a prism, within a sphere of radius about r.
pub fn u_shape(r: f64) -> Polyhedron {
    let profile =
        [(-0.6, -0.6), (0.6, -0.6), (0.6, 0.6), (0.3, 0.6), (0.3, -0.2), (-0.3, -0.2), (-0.3, 0.6), (-0.6, 0.6)];
    let n = profile.len() as u32;
    let at = |z: f64| profile.iter().map(move |&(x, y)| Vec3::new(x, y, z) * r);
    let points: Vec<Vec3> = at(-0.3).chain(at(0.3)).collect();
    let mut faces: Vec<Vec<u32>> = vec![(0..n).rev().collect(), (n..2 * n).collect()];
    faces.extend((0..n).map(|i| vec![i, (i + 1) % n, (i + 1) % n + n, i + n]));
    Polyhedron::from_mesh(&points, &faces).unwrap()
}

/// n^3 bodies of one kind on a jittered lattice in the unit cube, speed 1 m/s, radius 0.23/n, some spin; lengths and speeds
/// times `scale`.
pub fn gas(kind: Kind, n: u32, settings: Settings, scale: f64) -> World {
    let mut world = World::new(settings).unwrap();
    world.add_box("box", Vec3::ZERO, Vec3::splat(scale), Surface::default()).unwrap();
    let r = 0.23 / f64::from(n);
    let shape = kind.shape(r * scale);
    let mut random = Random(42);
    for i in 0..n.pow(3) {
        let at = |k: u32| (f64::from(k % n) + 0.5) / f64::from(n);
        let lattice = Vec3::new(at(i / (n * n)), at(i / n), at(i));
        let jitter = random.vector() * (0.9 * (0.5 / f64::from(n) - r));
        let spin = if kind == Kind::Spheres { Vec3::ZERO } else { random.direction() * f64::from(n) };
        world
            .add_body(BodyDef {
                position: (lattice + jitter) * scale,
                velocity: random.direction() * scale,
                angular_velocity: spin,
                orientation: mrtphys::Quat::from_axis_angle(random.direction(), 2.0 * random.signed()),
                ..BodyDef::new(shape.clone())
            })
            .unwrap();
    }
    world
}

/// Residual of the ledger, as a multiple of its bound 1e-12 (largest kinetic energy + sum of |entries| + range of the
/// potential).
pub fn residual(world: &World, largest_kinetic: f64, potential_range: f64) -> f64 {
    let ledger = world.ledger();
    let off = world.energy().total() - world.initial_energy().total() - ledger.sum();
    off.abs() / (1e-12 * (largest_kinetic + ledger.sum_abs() + potential_range))
}
