//! This project's engine, behind the interface of the comparison.

use super::scene::{NeutralBody, SceneData, Triple};
use super::{Engine, Setup, State};
use mrtphys::field::{Scope, UniformField};
use mrtphys::{BodyDef, BodyId, Mass, Quat, Settings, Surface, Vec3, World};
use std::sync::Arc;

struct Ours {
    world: World,
    ids: Vec<BodyId>,
}

/// Puts a scene into a world. Unlike the peers it is given the scene in metres: it has no absolute tolerance. It steps with
/// the threads of the pool in which it is called.
///
/// # Errors
/// What the world reports, in words.
pub fn create(scene: &SceneData, _: Setup) -> Result<Box<dyn Engine>, String> {
    let words = |e: mrtphys::Error| e.to_string();
    let rate = (1.0 / scene.dt).round();
    if (rate * scene.dt - 1.0).abs() > 1e-12 {
        return Err(format!("steps of {} s: not a whole number of them in a second", scene.dt));
    }
    let settings = Settings { fps: rate as u32, steps_per_frame: 1, ..Settings::default() };
    let mut world = World::new(settings).map_err(words)?;
    let surface = Surface { friction: scene.friction, restitution: scene.restitution, ..Surface::default() };
    if let Some((low, high)) = scene.container {
        world.add_box("container", vector(low), vector(high), surface).map_err(words)?;
    }
    if scene.gravity != [0.0; 3] {
        let field = UniformField::new(vector(scene.gravity)).map_err(words)?;
        world.add_force(Arc::new(field), Scope::default()).map_err(words)?;
    }
    let shapes = scene.shapes.iter().map(|s| Ok((s.ours()?, s.mass()?.0))).collect::<Result<Vec<_>, String>>()?;
    let mut ids = Vec::with_capacity(scene.bodies.len());
    for body in &scene.bodies {
        let (shape, mass) = shapes[body.shape as usize].clone();
        let mass = if body.fixed { Mass::Infinite } else { Mass::Value(mass) };
        let def = BodyDef { mass, surface, ..BodyDef::new(shape) };
        ids.push(world.add_body(placed(body, def)).map_err(words)?);
    }
    Ok(Box::new(Ours { world, ids }))
}

fn placed(body: &NeutralBody, def: BodyDef) -> BodyDef {
    let [x, y, z, w] = body.orientation;
    BodyDef {
        position: vector(body.position),
        orientation: Quat { x, y, z, w },
        velocity: vector(body.velocity),
        angular_velocity: vector(body.spin),
        ..def
    }
}

fn vector([x, y, z]: Triple) -> Vec3 {
    Vec3::new(x, y, z)
}

impl Engine for Ours {
    fn version(&self) -> String {
        env!("CARGO_PKG_VERSION").into()
    }

    fn settings(&self) -> String {
        "defaults: double precision, scene in metres, half-spaces as walls".into()
    }

    fn step(&mut self) -> Result<(), String> {
        self.world.step().map_err(|e| e.to_string())
    }

    fn read(&self, state: &mut State) {
        state.clear();
        for &id in &self.ids {
            let Ok(body) = self.world.body(id) else { continue };
            let (p, q, v, w) = (body.position, body.orientation, body.velocity, body.angular_velocity);
            state.push([p.x, p.y, p.z], [q.x, q.y, q.z, q.w], [v.x, v.y, v.z], [w.x, w.y, w.z]);
        }
    }
}
