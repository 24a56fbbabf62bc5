//! What kinetic theory says of a scene that is a gas: equal spheres that bounce elastically in a box, with nothing else.

use mrtphys::shape::{LimitQuadrangle, Sphere};
use mrtphys::{Real, Vec3, World};
use std::f64::consts::PI;

/// Above this part of the volume the theory, of first order at the walls, is not good to some percent.
const DENSEST: Real = 0.2;
/// Fewer bodies are no gas.
const FEWEST: usize = 32;

/// A gas of hard spheres in a box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gas {
    bodies: usize,
    radius: Real,
    mass: Real,
    /// edges of the box \[m\]
    edges: Vec3,
}

impl Gas {
    /// The gas that a world is; `None`: it is none.
    pub fn of(world: &World) -> Option<Gas> {
        let s = world.settings();
        if s.viscosity != 0.0
            || world.body_count() < FEWEST
            || world.forces().iter().any(|f| f.field.uniform() != Some(Vec3::ZERO))
        {
            return None;
        }
        let edges = the_box(world)?;
        let mut found: Option<(Real, Real)> = None;
        for id in world.bodies() {
            let body = world.body(id).ok()?;
            let radius = body.shape.downcast::<Sphere>()?.radius();
            let good = body.mass.is_finite() && body.surface.restitution == 1.0;
            if !good || *found.get_or_insert((radius, body.mass)) != (radius, body.mass) {
                return None;
            }
        }
        let (radius, mass) = found?;
        let gas = Gas { bodies: world.body_count(), radius, mass, edges };
        (gas.part_of_volume() <= DENSEST).then_some(gas)
    }

    fn part_of_volume(&self) -> Real {
        let volume = self.edges.x * self.edges.y * self.edges.z;
        self.bodies as Real * 4.0 / 3.0 * PI * self.radius.powi(3) / volume
    }

    /// Impacts between bodies in a second, when they have this energy of translation \[J\] and their speeds are distributed as
    /// Maxwell and Boltzmann say.
    ///
    /// A body meets w = 4 rho sigma^2 g sqrt(pi kT/m) others in a second, where kT = 2 E/(3 N) and g = (1 - eta/2)/(1 - eta)^3
    /// is the density of pairs at contact (Enskog; Carnahan and Starling 1969). Centres have the box less a skin of one radius:
    /// volume V and surface A. To first order in the density rho the walls attract: over a wall at a distance z of centres from
    /// the skin the density is rho (1 + rho pi (sigma - z)^2 (2 sigma + z)/3), whose integral gives N = rho (V + A rho pi/4
    /// sigma^4); and they cut a part (sigma - z)/(2 sigma) off the sphere on which partners lie: pairs are those of the volume
    /// V - A sigma/4 + 2 A rho sigma^4 0.95 pi/6.
    pub fn collisions_per_second(&self, linear_energy: Real) -> Real {
        let n = self.bodies as Real;
        let sigma = 2.0 * self.radius;
        let e = self.edges - Vec3::splat(sigma);
        let (volume, surface) = (e.x * e.y * e.z, 2.0 * (e.x * e.y + e.y * e.z + e.z * e.x));
        let mut density = n / volume;
        // A contraction at these densities: fifty rounds are more than enough.
        for _ in 0..50 {
            density = n / (volume + surface * density * PI / 4.0 * sigma.powi(4));
        }
        let eta = density * PI / 6.0 * sigma.powi(3);
        let g = (1.0 - 0.5 * eta) / (1.0 - eta).powi(3);
        let heat = 2.0 * linear_energy / (3.0 * n * self.mass);
        let w = 4.0 * density * sigma * sigma * g * (PI * heat).sqrt();
        let pairs = volume - surface * sigma / 4.0 + 2.0 * surface * density * sigma.powi(4) * 0.95 * PI / 6.0;
        0.5 * density * w * pairs
    }
}

/// Edges of the box that six walls make; `None`: the boundaries are something else, or not elastic.
fn the_box(world: &World) -> Option<Vec3> {
    let boundaries = world.boundaries();
    if boundaries.len() != 6 {
        return None;
    }
    let (mut low, mut high) = ([None; 3], [None; 3]);
    for id in boundaries {
        let b = world.boundary(id).ok()?;
        if b.surface.restitution != 1.0 {
            return None;
        }
        let normal = b.shape.downcast::<LimitQuadrangle>()?.normal();
        let axis = (0..3).find(|&k| normal[k].abs() == 1.0)?;
        let side = if normal[axis] > 0.0 { &mut low } else { &mut high };
        side[axis] = Some(b.position[axis]);
    }
    let edge = |k: usize| Some(high[k]? - low[k]?).filter(|e: &Real| *e > 0.0);
    Some(Vec3::new(edge(0)?, edge(1)?, edge(2)?))
}

#[cfg(test)]
mod tests {
    use super::*;
    use mrtphys::def::{BroadPhaseKind, Settings};
    use mrtphys::field::{EarthGravity, Scope};
    use mrtphys::{BodyDef, Surface};
    use mrtphys_bench::{GasShape, GasSpec};
    use std::sync::Arc;

    fn spec(n: u32, shape: GasShape) -> GasSpec {
        GasSpec { shape, n, rate: 64, broad_phase: BroadPhaseKind::SortedGrid }
    }

    #[test]
    fn the_rate_is_the_bench_s() {
        for n in [4, 8, 16] {
            let spec = spec(n, GasShape::Spheres);
            let world = spec.build().unwrap();
            let gas = Gas::of(&world).unwrap();
            let energy = world.energy().linear;
            let mean_square = 2.0 * energy / spec.bodies() as Real;
            let (a, b) = (gas.collisions_per_second(energy), spec.collisions_per_second(mean_square));
            assert!((a / b - 1.0).abs() < 1e-12, "{n}: {a} {b}");
        }
    }

    #[test]
    fn what_is_no_gas_has_no_rate() {
        assert_eq!(Gas::of(&spec(8, GasShape::Tetrahedra).build().unwrap()), None);
        assert_eq!(Gas::of(&spec(2, GasShape::Spheres).build().unwrap()), None, "too few");
        let gas = || spec(4, GasShape::Spheres).build().unwrap();
        assert!(Gas::of(&gas()).is_some());
        let mut falling = gas();
        falling.add_force(Arc::new(EarthGravity::default()), Scope::default()).unwrap();
        assert_eq!(Gas::of(&falling), None);
        let mut slow = gas();
        slow.set_settings(Settings { viscosity: 0.5, ..slow.settings().clone() }).unwrap();
        assert_eq!(Gas::of(&slow), None);
        let mut mixed = gas();
        mixed.add_body(BodyDef::new(Sphere::new(0.01).unwrap())).unwrap();
        assert_eq!(Gas::of(&mixed), None);
        let mut soft = gas();
        let id = soft.bodies().next().unwrap();
        soft.set_surface(id, Surface { restitution: 0.9, ..Surface::default() }).unwrap();
        assert_eq!(Gas::of(&soft), None);
    }
}
