//! The bodies of a lattice. The order of the draws is part of the scene language (`docs/manual/scene-language.md`).

use crate::random::Random;
use crate::scene::LatticeDesc;
use mrtphys::math::{Real, Vec3};

/// A body of a lattice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LatticePoint {
    /// which of the lattice's kinds of bodies
    pub kind: usize,
    /// centre of mass \[m\]
    pub center: Vec3,
    /// velocity \[m/s\]
    pub velocity: Vec3,
    /// angular velocity \[rad/s\]
    pub angular_velocity: Vec3,
}

impl LatticeDesc {
    /// The seed of its stream: its own, or the scene's plus its place among the lattices.
    pub fn stream_seed(&self, scene_seed: u64) -> u64 {
        self.seed.unwrap_or(scene_seed.wrapping_add(self.place))
    }

    /// Its bodies in order, k fastest. `reach`: for each kind of body, the largest distance of a point of it from its centre
    /// of mass \[m\]; the free gap of jitter is what it leaves of the cell.
    pub fn points<'a>(&'a self, scene_seed: u64, reach: &'a [Real]) -> impl Iterator<Item = LatticePoint> + 'a {
        let mut random = Random::new(self.stream_seed(scene_seed));
        let [nx, ny, nz] = self.count;
        let places = (0..nx).flat_map(move |i| (0..ny).flat_map(move |j| (0..nz).map(move |k| [i, j, k])));
        places.map(move |place| {
            let kind = place.iter().map(|&n| n as usize).sum::<usize>() % self.bodies.len().max(1);
            let reach = reach.get(kind).copied().unwrap_or(0.0);
            LatticePoint {
                kind,
                center: self.center(place) + self.displacement(reach, &mut random),
                velocity: drawn(self.speed, &mut random),
                angular_velocity: drawn(self.spin, &mut random),
            }
        })
    }

    /// min + (i + 1/2) (max - min) / count.
    fn center(&self, place: [u32; 3]) -> Vec3 {
        let along = |i: usize| {
            let (low, high) = (self.min.to_array()[i], self.max.to_array()[i]);
            low + (Real::from(place[i]) + 0.5) * (high - low) / Real::from(self.count[i])
        };
        Vec3::new(along(0), along(1), along(2))
    }

    /// (u - 1/2) jitter gap along x, y and z: for jitter up to 1, a body stays in its cell.
    fn displacement(&self, reach: Real, random: &mut Random) -> Vec3 {
        if self.jitter == 0.0 {
            return Vec3::ZERO;
        }
        let mut along = |i: usize| {
            let cell = (self.max.to_array()[i] - self.min.to_array()[i]) / Real::from(self.count[i]);
            let gap = mrtphys::math::max(cell - 2.0 * reach, 0.0);
            (random.unit() - 0.5) * self.jitter * gap
        };
        Vec3::new(along(0), along(1), along(2))
    }
}

/// Nothing is drawn for the length 0.
fn drawn(length: Real, random: &mut Random) -> Vec3 {
    if length == 0.0 { Vec3::ZERO } else { random.direction(length) }
}
