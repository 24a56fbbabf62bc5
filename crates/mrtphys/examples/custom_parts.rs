//! A field, an impact law and a broad phase of one's own, made outside of the crate.
//!
//!     cargo run --release -p mrtphys --example custom_parts

use mrtphys::broad::{BoundsView, BroadPhase, Candidates};
use mrtphys::field::{ForceField, Scope};
use mrtphys::impact::{Encounter, ImpactLaw, Impulse};
use mrtphys::shape::Sphere;
use mrtphys::{BodyDef, Settings, Surface, Vec3, World};
use std::sync::Arc;

/// A spring to the origin: a = -k x.
#[derive(Debug)]
struct Spring {
    stiffness_per_mass: f64,
}

impl ForceField for Spring {
    fn acceleration(&self, at: Vec3, _mass: f64) -> Vec3 {
        at * -self.stiffness_per_mass
    }

    fn potential(&self, at: Vec3) -> Option<f64> {
        Some(0.5 * self.stiffness_per_mass * at.length_squared())
    }
}

/// Takes half of the approach speed away, whatever the surfaces say.
#[derive(Debug)]
struct HalfDead;

impl ImpactLaw for HalfDead {
    fn name(&self) -> &str {
        "half-dead"
    }

    fn impulse(&self, e: &Encounter) -> Option<Impulse> {
        let weight = e.response(e.normal).dot(e.normal);
        Some(Impulse { on_a: e.normal * (-1.5 * e.approach() / weight), fallback: false })
    }
}

/// Sorts along x and compares with those that can still be reached.
struct Sweep;

impl BroadPhase for Sweep {
    fn name(&self) -> String {
        "sweep".into()
    }

    fn find(&mut self, view: &BoundsView<'_>, out: &mut Candidates) {
        let left = |i: u32| view.balls[i as usize].center.x - view.balls[i as usize].radius;
        let mut order: Vec<u32> =
            (0..view.balls.len() as u32).filter(|&i| !view.balls[i as usize].is_empty()).collect();
        order.sort_by(|&a, &b| left(a).total_cmp(&left(b)));
        for (k, &a) in order.iter().enumerate() {
            let ball = &view.balls[a as usize];
            let right = ball.center.x + ball.radius;
            for &b in order[k + 1..].iter().take_while(|&&b| left(b) <= right) {
                out.sphere_tests += 1;
                if ball.meets(&view.balls[b as usize]) && !(view.is_fixed(a) && view.is_fixed(b)) {
                    out.pairs.push([a, b]);
                }
            }
            for (wall, bounds) in view.boundaries.iter().enumerate() {
                out.sphere_tests += 1;
                if bounds.reaches(ball) {
                    out.walls.push([a, wall as u32]);
                }
            }
        }
    }
}

fn make() -> Result<World, Box<dyn std::error::Error>> {
    let mut world = World::new(Settings { fps: 64, steps_per_frame: 8, ..Settings::default() })?;
    world.add_force(Arc::new(Spring { stiffness_per_mass: 4.0 }), Scope::default())?;
    world.add_box("box", Vec3::splat(-1.0), Vec3::splat(1.0), Surface::default())?;
    for i in 0..27_u32 {
        let at = |k: u32| f64::from(k % 3) * 0.5 - 0.5;
        let position = Vec3::new(at(i), at(i / 3) + 0.01 * f64::from(i), at(i / 9));
        world.add_body(BodyDef {
            position,
            velocity: Vec3::new(at(i / 9), 0.3, at(i)),
            ..BodyDef::new(Sphere::new(0.1)?)
        })?;
    }
    Ok(world)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (mut standard, mut swept, mut dead) = (make()?, make()?, make()?);
    swept.set_broad_phase(Box::new(Sweep));
    dead.set_impact_law(Arc::new(HalfDead));
    for _ in 0..640 {
        standard.frame()?;
        swept.frame()?;
        dead.frame()?;
    }
    println!("standard {}\nswept    {}", standard.state_hash(), swept.state_hash());
    assert_eq!(standard.state_hash(), swept.state_hash(), "a broad phase never changes the trajectory");
    let kinetic = |w: &World| w.energy().kinetic();
    println!("kinetic energy: elastic {:.4} J, half-dead {:.4} J", kinetic(&standard), kinetic(&dead));
    println!("half-dead ledger: restitution {:.4} J", dead.ledger().restitution);
    assert!(dead.ledger().restitution < 0.0);
    Ok(())
}
