//! The scenes: the gallery's cubes and larger ones by the same rule, and clusters in a large box.

use mrtphys::field::{ForceField, Scope};
use mrtphys::{Vec3, World};
use mrtphys_scene::scene::{Content, ShapeDesc};
use mrtphys_scene::{Random, Scene, gallery_scene};
use std::fmt::Write;
use std::sync::Arc;

/// Largest number along an edge for which the gallery has a scene.
const GALLERY: u32 = 8;
/// Clusters in a scene: 2^3 of them with (n/2)^3 bodies each make n^3.
pub const CLUSTERS: u32 = 8;

/// A scene that is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Arena {
    /// n^3 bodies spread evenly over the unit cube: the thesis's
    Cube {
        /// bodies along an edge
        n: u32,
    },
    /// n^3 bodies in eight clusters of 1 m in a cube with this edge \[m\]
    Clusters {
        /// cube root of the number of bodies; even
        n: u32,
        /// edge of the box \[m\], at least 6
        edge: f64,
    },
}

impl Arena {
    /// Cube root of the number of bodies.
    pub fn n(self) -> u32 {
        match self {
            Arena::Cube { n } | Arena::Clusters { n, .. } => n,
        }
    }

    /// Number of movable bodies.
    pub fn bodies(self) -> u64 {
        u64::from(self.n()).pow(3)
    }

    /// Edge of the box \[m\].
    pub fn edge(self) -> f64 {
        match self {
            Arena::Cube { .. } => 1.0,
            Arena::Clusters { edge, .. } => edge,
        }
    }

    /// Name in the tables.
    pub fn name(self) -> String {
        match self {
            Arena::Cube { n } => format!("thesis/cube-{n}"),
            Arena::Clusters { n, edge } => format!("clusters-{n}-in-{edge}"),
        }
    }

    /// Makes the world.
    ///
    /// # Errors
    /// What the scene language says; none for the scenes of the experiment.
    pub fn build(self) -> Result<World, String> {
        match self {
            Arena::Cube { n } => Ok(cube(n)?.build().map_err(|e| e.to_string())?.world),
            Arena::Clusters { n, edge } => {
                let centers = centers(edge);
                let text = clusters_text(n, edge, &centers);
                let scene = Scene::from_text(&self.name(), &text).map_err(|e| e.to_string())?;
                let mut world = scene.build().map_err(|e| e.to_string())?.world;
                world.add_force(Arc::new(Traps { centers }), Scope::default()).map_err(|e| e.to_string())?;
                Ok(world)
            }
        }
    }
}

/// The gallery's scene of n^3 bodies, or what its rule (r = 0.3/n) makes of the largest one.
pub fn cube(n: u32) -> Result<Scene, String> {
    let name = format!("thesis/cube-{n}");
    if let Some(text) = gallery_scene(&name) {
        return Scene::from_text(&name, text).map_err(|e| e.to_string());
    }
    enlarged(n)
}

/// The gallery's largest cube with n bodies along an edge instead.
fn enlarged(n: u32) -> Result<Scene, String> {
    let name = format!("thesis/cube-{GALLERY}");
    let text = gallery_scene(&name).ok_or(format!("the gallery has no scene '{name}'"))?;
    let mut scene = Scene::from_text(&name, text).map_err(|e| e.to_string())?;
    for content in &mut scene.contents {
        let Content::Lattice(lattice) = content else { continue };
        lattice.count = [n; 3];
        for body in &mut lattice.bodies {
            match &mut body.shape {
                ShapeDesc::Sphere { radius } => *radius = 0.3 / f64::from(n),
                ShapeDesc::Tetrahedron { circumradius } => *circumradius = 0.3 / f64::from(n),
                _ => return Err(format!("'{name}' has bodies of another shape")),
            }
        }
    }
    Ok(scene)
}

/// Middles of the clusters: at random, so that no grid and no tree is favoured by its cell borders; 1 m from the walls, and
/// 1.25 m from each other along some axis, so that the lattices of 1 m do not overlap. Boxes from 6 m on have room for that.
fn centers(edge: f64) -> Vec<Vec3> {
    let mut random = Random::new(1998);
    let mut found: Vec<Vec3> = Vec::new();
    while found.len() < CLUSTERS as usize {
        let mut along = || 1.0 + random.unit() * (edge - 2.0);
        let place = Vec3::new(along(), along(), along());
        if found.iter().all(|c| (*c - place).max_abs() >= 1.25) {
            found.push(place);
        }
    }
    found
}

/// Eight lattices of 1 m with (n/2)^3 spheres and tetrahedra each, by the thesis cubes' rule: r = 0.3 of the spacing.
fn clusters_text(n: u32, edge: f64, centers: &[Vec3]) -> String {
    let along = n / 2;
    let radius = 0.3 / f64::from(along);
    let mut text = format!(
        "format = 1\n[simulation]\nseconds = 10.0\nfps = 8\nsteps_per_frame = 8\n\
         [[boundary]]\nkind = \"box\"\nmin = [0, 0, 0]\nmax = [{edge}, {edge}, {edge}]\n"
    );
    for c in centers {
        let (low, high) = (*c - Vec3::splat(0.5), *c + Vec3::splat(0.5));
        let _ = write!(
            text,
            "[[lattice]]\ncount = [{along}, {along}, {along}]\nmin = [{}, {}, {}]\nmax = [{}, {}, {}]\nspeed = 0.5\n\
             body = [ {{ shape = {{ kind = \"sphere\", radius = {radius} }} }},\n\
             {{ shape = {{ kind = \"tetrahedron\", circumradius = {radius} }} }} ]\n",
            low.x, low.y, low.z, high.x, high.y, high.z
        );
    }
    text
}

/// What keeps the clusters together: every body is pulled to the nearest middle as by a spring of 1 s^-2.
///
/// In equilibrium the mean square of a coordinate is kT/m over 1 s^-2. A lattice of 1 m that starts with 0.5 m/s
/// has 1/12 m2 and kT/m = 0.25/3 = 1/12 m2/s2: it neither spreads nor shrinks, but for the room that bodies deny each other.
#[derive(Clone, Debug)]
struct Traps {
    centers: Vec<Vec3>,
}

impl Traps {
    /// From a place to the nearest middle.
    fn way(&self, at: Vec3) -> Vec3 {
        let nearer = |best: Vec3, c: &Vec3| {
            let way = *c - at;
            if way.length_squared() < best.length_squared() { way } else { best }
        };
        self.centers[1..].iter().fold(self.centers[0] - at, nearer)
    }
}

impl ForceField for Traps {
    fn acceleration(&self, at: Vec3, _mass: f64) -> Vec3 {
        self.way(at)
    }

    fn potential(&self, at: Vec3) -> Option<f64> {
        Some(0.5 * self.way(at).length_squared())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rule_makes_the_scenes_of_the_gallery() {
        for n in 2..=GALLERY {
            let (ours, gallery) = (enlarged(n).unwrap(), cube(n).unwrap());
            let hash = |scene: &Scene| {
                let mut world = scene.build().unwrap().world;
                world.frame().unwrap();
                world.state_hash()
            };
            assert_eq!(cube(n).unwrap().contents[0].count(), u64::from(n).pow(3));
            assert_eq!(hash(&ours), hash(&gallery));
        }
    }

    #[test]
    fn clusters_stay_together() {
        let mut world = Arena::Clusters { n: 8, edge: 16.0 }.build().unwrap();
        assert_eq!(world.bodies().count(), 512);
        let centers = centers(16.0);
        let spread = |world: &World| {
            let traps = Traps { centers: centers.clone() };
            world.bodies().map(|id| traps.way(world.body(id).unwrap().position).length_squared()).sum::<f64>() / 512.0
        };
        let before = spread(&world);
        for _ in 0..40 {
            world.frame().unwrap();
        }
        // Three coordinates of 1/12 (less 1/16 of it, for four bodies on an edge); bodies deny each other some room.
        assert!((before - 0.25 * 15.0 / 16.0).abs() < 1e-9, "{before}");
        let after = spread(&world);
        assert!((0.2..0.4).contains(&after), "{after}");
        assert!((world.energy().total() / world.initial_energy().total() - 1.0).abs() < 1e-3);
    }
}
