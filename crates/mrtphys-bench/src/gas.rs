//! The gases that are measured: n^3 bodies of radius 0.23/n on a jittered lattice in the unit cube, speeds of 1 m/s, numbered
//! in shuffled order so that no broad phase profits from the lattice.

use crate::peers::scene::{NeutralBody, NeutralShape, SceneData};
use mrtphys::shape::{Polyhedron, Shape, Sphere};
use mrtphys::{BodyDef, BroadPhaseKind, Result, Settings, Surface, Vec3, World};
use std::sync::Arc;

/// Shape of the bodies of a gas.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GasShape {
    /// spheres
    Spheres,
    /// regular tetrahedra with the same circumradius
    Tetrahedra,
}

/// A gas.
#[derive(Clone, Copy, Debug)]
pub struct GasSpec {
    /// shape
    pub shape: GasShape,
    /// bodies along an edge
    pub n: u32,
    /// steps per second
    pub rate: u32,
    /// broad phase
    pub broad_phase: BroadPhaseKind,
}

/// A gas away from its walls.
struct Bulk {
    /// volume and surface of the box that centres can reach \[m3\], \[m2\]
    volume: f64,
    surface: f64,
    /// bodies per volume \[1/m3\]
    density: f64,
    /// part of the volume that bodies fill
    eta: f64,
}

/// Radius times n.
const RADIUS: f64 = 0.23;

impl GasSpec {
    /// Name, as on the command line: `spheres-16`.
    pub fn name(&self) -> String {
        let shape = match self.shape {
            GasShape::Spheres => "spheres",
            GasShape::Tetrahedra => "tetrahedra",
        };
        format!("{shape}-{}", self.n)
    }

    /// Radius of the bounding sphere \[m\].
    pub fn radius(&self) -> f64 {
        RADIUS / f64::from(self.n)
    }

    /// Number of bodies.
    pub fn bodies(&self) -> usize {
        (self.n as usize).pow(3)
    }

    /// Makes the world.
    ///
    /// # Errors
    /// None for a specification with n and rate above 0.
    pub fn build(&self) -> Result<World> {
        let settings =
            Settings { fps: self.rate, steps_per_frame: 1, broad_phase: self.broad_phase, ..Settings::default() };
        let mut world = World::new(settings)?;
        world.add_box("box", Vec3::ZERO, Vec3::splat(1.0), Surface::default())?;
        let shape: Arc<dyn Shape> = match self.shape {
            GasShape::Spheres => Arc::new(Sphere::new(self.radius())?),
            GasShape::Tetrahedra => Arc::new(Polyhedron::tetrahedron(self.radius())?),
        };
        for (position, velocity) in self.start() {
            world.add_body(BodyDef { position, velocity, ..BodyDef::new(shape.clone()) })?;
        }
        Ok(world)
    }

    /// Positions \[m\] and velocities \[m/s\] at the start, in the order of the bodies' numbers.
    pub fn start(&self) -> Vec<(Vec3, Vec3)> {
        let mut random = Random(0x6d72_7470_6879_7321);
        let mut places: Vec<u32> = (0..self.n.pow(3)).collect();
        for i in (1..places.len()).rev() {
            places.swap(i, random.below(i as u64 + 1) as usize);
        }
        let cell = 1.0 / f64::from(self.n);
        let free = 0.5 * cell - self.radius();
        let place = |place: u32| {
            let at = |k: u32| (f64::from(k % self.n) + 0.5) * cell;
            let lattice = Vec3::new(at(place / (self.n * self.n)), at(place / self.n), at(place));
            let jitter = Vec3::new(random.signed(), random.signed(), random.signed()) * (0.9 * free);
            (lattice + jitter, random.direction())
        };
        places.into_iter().map(place).collect()
    }

    /// The gas without an engine, for comparisons. Tetrahedra get what the gas that is measured alone lacks: any orientation,
    /// and as much energy of rotation as of translation.
    pub fn data(&self) -> SceneData {
        let mut random = Random(0x6f72_6965_6e74_2121);
        let r = self.radius();
        let third = r / 3f64.sqrt();
        let corners = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
        let shape = match self.shape {
            GasShape::Spheres => NeutralShape::Sphere { radius: r },
            GasShape::Tetrahedra => NeutralShape::Hull { points: corners.map(|p| p.map(|x: f64| x * third)).to_vec() },
        };
        let body = |(p, v): (Vec3, Vec3)| {
            let (orientation, spin) = match self.shape {
                GasShape::Spheres => ([0.0, 0.0, 0.0, 1.0], Vec3::ZERO),
                // I = m 2/5 s^2, s = r / sqrt 3, about every axis.
                GasShape::Tetrahedra => (random.orientation(), random.direction() * (1.0 / (third * 0.4f64.sqrt()))),
            };
            NeutralBody {
                shape: 0,
                fixed: false,
                position: [p.x, p.y, p.z],
                orientation,
                velocity: [v.x, v.y, v.z],
                spin: [spin.x, spin.y, spin.z],
            }
        };
        SceneData {
            dt: 1.0 / f64::from(self.rate),
            unit: 0.5 / f64::from(self.n),
            restitution: 1.0,
            friction: 0.0,
            gravity: [0.0; 3],
            container: Some(([0.0; 3], [1.0; 3])),
            shapes: vec![shape],
            bodies: self.start().into_iter().map(body).collect(),
        }
    }

    /// Impacts between bodies per second of a gas of hard spheres, by kinetic theory with the walls to first order in the
    /// density; `mean_square_speed` \[m2/s2\] = 3 kT/m. For other shapes: that of their bounding spheres.
    ///
    /// In bulk N w / 2 with w = 4 rho sigma^2 g sqrt(pi kT/m), g = (1 - eta/2)/(1 - eta)^3 (Enskog; Carnahan and Starling
    /// 1969). Centres share the cube less a skin of one radius: volume V, surface A. Near a wall the density is
    /// rho (1 + rho w(z)), w(z) = pi (sigma - z)^2 (2 sigma + z)/3 being the part of the exclusion sphere behind the wall, so
    /// that N = rho (V + A rho pi/4 sigma^4); and within sigma of a wall a part (sigma - z)/(2 sigma) of the contact sphere
    /// is cut off: the pairs are those of a volume V - A sigma/4 + 2 A rho sigma^4 (0.95 pi/6), the integrals over z.
    pub fn collisions_per_second(&self, mean_square_speed: f64) -> f64 {
        use std::f64::consts::PI;
        let sigma = 2.0 * self.radius();
        let Bulk { volume, surface, density, eta } = self.bulk();
        let g = (1.0 - 0.5 * eta) / (1.0 - eta).powi(3);
        let w = 4.0 * density * sigma * sigma * g * (PI * mean_square_speed / 3.0).sqrt();
        let pairs = volume - surface * sigma / 4.0 + 2.0 * surface * density * sigma.powi(4) * 0.95 * PI / 6.0;
        0.5 * density * w * pairs
    }

    /// Impacts on the walls per second of the same gas: A rho_w sqrt(kT / 2 pi m), where the density at the wall is
    /// rho_w = p / kT (contact theorem) with the pressure of Carnahan and Starling (1969).
    pub fn wall_impacts_per_second(&self, mean_square_speed: f64) -> f64 {
        let Bulk { surface, density, eta, .. } = self.bulk();
        let compressibility = (1.0 + eta + eta * eta - eta.powi(3)) / (1.0 - eta).powi(3);
        surface * density * compressibility * (mean_square_speed / (6.0 * std::f64::consts::PI)).sqrt()
    }

    /// Steps per second in which a body changes its velocity: impacts with others and with walls, several in a step counted
    /// once as impacts fall at random.
    pub fn changes_per_body_second(&self, mean_square_speed: f64) -> f64 {
        let impacts =
            2.0 * self.collisions_per_second(mean_square_speed) + self.wall_impacts_per_second(mean_square_speed);
        let (rate, per_body) = (f64::from(self.rate), impacts / self.bodies() as f64);
        rate * -(-per_body / rate).exp_m1()
    }

    fn bulk(&self) -> Bulk {
        use std::f64::consts::PI;
        let bodies = self.bodies() as f64;
        let sigma = 2.0 * self.radius();
        let edge = 1.0 - sigma;
        let (volume, surface) = (edge.powi(3), 6.0 * edge * edge);
        let mut density = bodies / volume;
        for _ in 0..50 {
            density = bodies / (volume + surface * density * PI / 4.0 * sigma.powi(4));
        }
        Bulk { volume, surface, density, eta: density * PI / 6.0 * sigma.powi(3) }
    }
}

/// SplitMix64 (Steele, Lea, Flood 2014): the same numbers on every machine.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, n: u64) -> u64 {
        ((u128::from(self.next()) * u128::from(n)) >> 64) as u64
    }

    /// Uniform in [-1, 1).
    fn signed(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// A turn by any angle about any axis, all turns equally likely: uniform on the unit quaternions.
    fn orientation(&mut self) -> [f64; 4] {
        loop {
            let q = [self.signed(), self.signed(), self.signed(), self.signed()];
            let square: f64 = q.iter().map(|x| x * x).sum();
            if (0.01..=1.0).contains(&square) {
                return q.map(|x| x / square.sqrt());
            }
        }
    }

    /// Uniform on the unit sphere.
    fn direction(&mut self) -> Vec3 {
        loop {
            let v = Vec3::new(self.signed(), self.signed(), self.signed());
            if (0.01..=1.0).contains(&v.length_squared()) {
                return v / v.length();
            }
        }
    }
}
