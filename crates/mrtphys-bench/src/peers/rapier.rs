//! Rapier, behind the interface of the comparison.

use super::scene::{NeutralBody, NeutralShape, SceneData};
use super::{Engine, Margin, Scale, Setup, State};
use rapier3d::math::{Pose, Rotation, Vector};
use rapier3d::prelude::*;

struct Rapier {
    world: PhysicsWorld,
    handles: Vec<RigidBodyHandle>,
    scale: Scale,
    settings: String,
}

/// Puts a scene into Rapier. It steps with one thread, or with the feature `rapier-parallel` with those of the pool in
/// which it is called.
///
/// # Errors
/// More threads than it was built for, or a shape that Rapier does not take, in words.
pub(super) fn create(scene: &SceneData, setup: Setup) -> Result<Box<dyn Engine>, String> {
    let parallel = cfg!(feature = "rapier-parallel");
    if setup.threads > 1 && !parallel {
        return Err("Rapier has one thread as it is built here: build with the feature rapier-parallel".into());
    }
    let scale = Scale::of(scene);
    let mut world = PhysicsWorld::new();
    world.gravity = vector(scale.vector(scene.gravity));
    let parameters = &mut world.integration_parameters;
    parameters.dt = scene.dt as f32;
    parameters.normalized_max_linear_velocity = f32::MAX;
    if setup.margin == Margin::Thin {
        parameters.normalized_prediction_distance = 0.001;
    }
    let prediction = if setup.margin == Margin::Thin { "0.001" } else { "0.02" };
    let surface = |c: ColliderBuilder| c.friction(scene.friction as f32).restitution(scene.restitution as f32);
    for (centre, half) in scene.walls() {
        let [x, y, z] = scale.vector(half);
        let body = RigidBodyBuilder::fixed().translation(vector(scale.vector(centre)));
        world.insert(body, surface(ColliderBuilder::cuboid(x, y, z)));
    }
    let shapes = scene.shapes.iter().map(|s| shape(s, scale)).collect::<Result<Vec<_>, _>>()?;
    let handles = scene.bodies.iter().map(|body| {
        let collider = surface(ColliderBuilder::new(shapes[body.shape as usize].clone()).density(1.0));
        world.insert(placed(body, scale), collider).0
    });
    let handles = handles.collect();
    // Eight lanes are two times four unless the compiler may use AVX: Rapier has no other code for other processors.
    let lanes = match (cfg!(feature = "rapier-simd8"), cfg!(target_feature = "avx")) {
        (false, _) => "4 lanes",
        (true, true) => "8 lanes (feature simd8)",
        (true, false) => "8 lanes (feature simd8) compiled without AVX",
    };
    let settings = format!(
        "prediction {prediction}, no cap on speeds, fast rotation allowed, no sleep, {lanes}, {}",
        if parallel {
            format!("feature parallel with {} thread(s)", setup.threads)
        } else {
            "features as shipped".into()
        }
    );
    Ok(Box::new(Rapier { world, handles, scale, settings }))
}

fn vector([x, y, z]: [f32; 3]) -> Vector {
    Vector::new(x, y, z)
}

fn shape(shape: &NeutralShape, scale: Scale) -> Result<SharedShape, String> {
    Ok(match shape {
        NeutralShape::Sphere { radius } => SharedShape::ball(scale.length(*radius)),
        NeutralShape::Box { half } => {
            let [x, y, z] = scale.vector(*half);
            SharedShape::cuboid(x, y, z)
        }
        NeutralShape::Hull { points } => {
            let points: Vec<Vector> = points.iter().map(|&p| vector(scale.vector(p))).collect();
            SharedShape::convex_hull(&points).ok_or("Rapier finds no convex hull")?
        }
    })
}

fn placed(body: &NeutralBody, scale: Scale) -> RigidBodyBuilder {
    let [x, y, z, w] = body.orientation.map(|x| x as f32);
    let pose = Pose::from_parts(vector(scale.vector(body.position)), Rotation::from_xyzw(x, y, z, w));
    let builder = if body.fixed { RigidBodyBuilder::fixed() } else { RigidBodyBuilder::dynamic() };
    builder
        .pose(pose)
        .linvel(vector(scale.vector(body.velocity)))
        .angvel(vector(body.spin.map(|x| x as f32)))
        .allow_fast_rotation(true)
        .can_sleep(false)
}

impl Engine for Rapier {
    fn version(&self) -> String {
        rapier3d::VERSION.into()
    }

    fn settings(&self) -> String {
        self.settings.clone()
    }

    fn step(&mut self) -> Result<(), String> {
        self.world.step();
        Ok(())
    }

    fn read(&self, state: &mut State) {
        state.clear();
        for &handle in &self.handles {
            let body = &self.world.bodies[handle];
            // Shapes are given about their centres of mass, but a computed centre may differ from the origin by rounding.
            let (p, q, v, w) = (body.center_of_mass(), body.rotation(), body.linvel(), body.angvel());
            state.push(
                self.scale.back([p.x, p.y, p.z]),
                [q.x, q.y, q.z, q.w].map(f64::from),
                self.scale.back([v.x, v.y, v.z]),
                [w.x, w.y, w.z].map(f64::from),
            );
        }
    }
}
