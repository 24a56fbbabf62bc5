//! Any sequence of calls leaves a world whose numbers are numbers.
#![no_main]

use arbitrary::Arbitrary;
use libfuzzer_sys::fuzz_target;
use mrtphys::field::{EarthGravity, Scope};
use mrtphys::shape::{Polyhedron, Shape, Sphere};
use mrtphys::{BodyDef, Mass, Settings, Surface, Vec3, World};
use std::sync::Arc;

#[derive(Arbitrary, Debug)]
enum Call {
    Add { kind: u8, at: [f32; 3], velocity: [f32; 3], size: f32, mass: f32 },
    Remove(u8),
    Move(u8, [f64; 3]),
    Push(u8, [f64; 3]),
    Spin(u8, [f64; 3]),
    SetMass(u8, f64),
    Gravity(f64),
    Step,
    Sort,
    Save,
    Restore,
}

fn vector<T: Copy + Into<f64>>(v: [T; 3]) -> Vec3 {
    Vec3::new(v[0].into(), v[1].into(), v[2].into())
}

fuzz_target!(|calls: Vec<Call>| {
    let mut world = World::new(Settings::default()).expect("settings");
    world.add_box("box", Vec3::splat(-2.0), Vec3::splat(2.0), Surface::default()).expect("box");
    let (mut ids, mut saved) = (Vec::new(), world.snapshot());
    for call in calls.into_iter().take(64) {
        let pick = |i: u8| ids.get(usize::from(i) % ids.len().max(1)).copied();
        match call {
            Call::Add { kind, at, velocity, size, mass } => {
                let shape: Option<Arc<dyn Shape>> = match kind % 3 {
                    0 => Sphere::new(size.into()).ok().map(|s| Arc::new(s) as _),
                    1 => Polyhedron::tetrahedron(size.into()).ok().map(|s| Arc::new(s) as _),
                    _ => Polyhedron::cuboid(Vec3::splat(size.into())).ok().map(|s| Arc::new(s) as _),
                };
                if let Some(shape) = shape {
                    let (position, velocity) = (vector(at), vector(velocity));
                    let def = BodyDef { position, velocity, mass: Mass::Value(mass.into()), ..BodyDef::new(shape) };
                    ids.extend(world.add_body(def));
                }
            }
            Call::Remove(i) => drop(pick(i).map(|id| world.remove_body(id))),
            Call::Move(i, to) => drop(pick(i).map(|id| world.set_position(id, vector(to)))),
            Call::Push(i, v) => drop(pick(i).map(|id| world.set_velocity(id, vector(v)))),
            Call::Spin(i, w) => drop(pick(i).map(|id| world.set_angular_velocity(id, vector(w)))),
            Call::SetMass(i, m) => drop(pick(i).map(|id| world.set_mass(id, Mass::Value(m)))),
            Call::Gravity(g) => {
                if let Ok(field) = EarthGravity::new(g) {
                    let _ = world.add_force(Arc::new(field), Scope::default());
                }
            }
            Call::Step => drop(world.step()),
            Call::Sort => world.sort_storage(),
            Call::Save => saved = world.snapshot(),
            Call::Restore => drop(world.restore(&saved)),
        }
        for id in world.bodies() {
            let body = world.body(id).expect("a body of the world");
            assert!(body.position.is_finite() && body.velocity.is_finite() && body.angular_momentum.is_finite());
        }
    }
});
