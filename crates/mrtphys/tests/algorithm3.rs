//! Algorithm III against runs made independently of this project: `vectors/algorithm3.json` and the bouncing balls of
//! `vectors/motion.json`.

use mrtphys::event::Partner;
use mrtphys::field::{Scope, UniformField};
use mrtphys::shape::{HalfSpace, Sphere};
use mrtphys::{BodyDef, BoundaryDef, ContactMode, Integrator, Mass, Settings, Surface, Vec3, World};
use serde_json::Value;
use std::sync::Arc;

fn load(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

fn vector(v: &Value) -> Vec3 {
    let at = |i: usize| v[i].as_f64().unwrap();
    Vec3::new(at(0), at(1), at(2))
}

/// Events that must agree before round-off has grown too large to compare.
const STRICT: usize = 25;

#[test]
fn events_are_those_of_the_independent_run() {
    let data = load(include_str!("vectors/algorithm3.json"));
    for case in data["cases"].as_array().unwrap() {
        for contact in [ContactMode::Thesis, ContactMode::Exact] {
            let mut world = make(case, contact);
            let first = world.boundaries().next().unwrap();
            world.record_events(true);
            let mut found = Vec::new();
            for step in 1.. {
                world.step().unwrap();
                let ids: Vec<_> = world.bodies().collect();
                let number = |id| ids.iter().position(|i| *i == id).unwrap() as u64;
                let walls: Vec<_> = world.boundaries().collect();
                let events: Vec<_> = world.drain_events().collect();
                for e in events {
                    found.push(match e.b {
                        Partner::Body(b) => (step, number(e.a), None, number(b)),
                        Partner::Boundary(b) => {
                            let wall = walls.iter().position(|w| *w == b).unwrap() as u64;
                            (step, number(e.a), Some(()), wall)
                        }
                    });
                }
                if found.len() > STRICT {
                    break;
                }
            }
            assert!(world.boundary(first).unwrap().name.ends_with("-x"));
            let mut wanted: Vec<_> = case["events"].as_array().unwrap()[..STRICT].iter().map(expected).collect();
            let mut found = found[..STRICT].to_vec();
            if contact == ContactMode::Exact {
                // Exact order answers boundaries after pairs; within a step these scenes do not care.
                wanted.sort_unstable();
                found.sort_unstable();
            }
            assert_eq!(found, wanted, "{contact}");
        }
    }
}

fn expected(e: &Value) -> (u64, u64, Option<()>, u64) {
    let step = e[0].as_u64().unwrap();
    let body = e[1].as_u64().unwrap();
    match e[2].as_array() {
        None => (step, body, None, e[2].as_u64().unwrap()),
        Some(w) => (step, body, Some(()), 2 * w[1].as_u64().unwrap() + w[2].as_u64().unwrap()),
    }
}

fn make(case: &Value, contact: ContactMode) -> World {
    let rate = 1.0 / case["dt"].as_f64().unwrap();
    let settings = Settings {
        fps: rate as u32,
        steps_per_frame: 1,
        contact,
        integrator: Integrator::ExplicitEuler,
        ..Settings::default()
    };
    let mut world = World::new(settings).unwrap();
    world.add_box("box", Vec3::ZERO, Vec3::splat(1.0), Surface::default()).unwrap();
    let bodies = case["bodies"].as_array().unwrap();
    for b in bodies {
        world
            .add_body(BodyDef {
                position: vector(&b["x"]),
                velocity: vector(&b["v"]),
                mass: Mass::Value(b["m"].as_f64().unwrap()),
                ..BodyDef::new(Sphere::new(b["r"].as_f64().unwrap()).unwrap())
            })
            .unwrap();
    }
    let a = vector(&bodies[0]["a"]);
    if a != Vec3::ZERO {
        world.add_force(Arc::new(UniformField::new(a).unwrap()), Scope::default()).unwrap();
    }
    world
}

#[test]
fn bouncing_balls_end_where_the_integrator_says() {
    let data = load(include_str!("vectors/motion.json"));
    for case in data["bounce"].as_array().unwrap() {
        let number = |key: &str| case[key].as_f64().unwrap();
        let integrator = match case["scheme"].as_str().unwrap() {
            "explicit" => Integrator::ExplicitEuler,
            "semi" => Integrator::SemiImplicitEuler,
            _ => Integrator::Parabola,
        };
        let fps = (1.0 / number("dt")) as u32;
        let mut world = World::new(Settings { fps, steps_per_frame: 1, integrator, ..Settings::default() }).unwrap();
        world
            .add_boundary(BoundaryDef {
                name: "floor".into(),
                shape: Arc::new(HalfSpace::new(Vec3::Y).unwrap()),
                position: Vec3::ZERO,
                surface: Surface::default(),
            })
            .unwrap();
        let g = UniformField::new(Vec3::new(0.0, -9.80665, 0.0)).unwrap();
        world.add_force(Arc::new(g), Scope::default()).unwrap();
        let ball = world
            .add_body(BodyDef {
                position: Vec3::new(0.0, number("h"), 0.0),
                ..BodyDef::new(Sphere::new(number("r")).unwrap())
            })
            .unwrap();
        world.record_events(true);
        let mut bounces = Vec::new();
        for step in 1..=case["steps"].as_u64().unwrap() {
            world.step().unwrap();
            if world.drain_events().next().is_some() {
                bounces.push(step);
            }
        }
        let wanted: Vec<u64> = case["bounce_steps"].as_array().unwrap().iter().map(|s| s.as_u64().unwrap()).collect();
        assert_eq!(bounces, wanted, "{integrator}");
        let body = world.body(ball).unwrap();
        assert!((body.position.y - number("y_end")).abs() < 1e-11, "{integrator}: {}", body.position.y);
        assert!((body.velocity.y - number("v_end")).abs() < 1e-11, "{integrator}: {}", body.velocity.y);
        let booked = world.ledger().integration;
        assert!((booked - number("predicted_energy_change")).abs() < 1e-9, "{integrator}: booked {booked}");
    }
}
