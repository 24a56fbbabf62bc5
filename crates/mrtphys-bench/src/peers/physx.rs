//! PhysX, behind the interface of the comparison.

use super::scene::{NeutralBody, NeutralShape, SceneData};
use super::{Engine, Margin, Scale, Setup, State};
use physx_sys::*;
use std::mem::size_of;
use std::ptr::{null, null_mut};

struct Physx {
    foundation: *mut PxFoundation,
    physics: *mut PxPhysics,
    dispatcher: *mut PxDefaultCpuDispatcher,
    scene: *mut PxScene,
    material: *mut PxMaterial,
    /// with whether they are fixed: only those that are not have velocities
    bodies: Vec<(*mut PxRigidActor, bool)>,
    scale: Scale,
    dt: f32,
    /// contact offset other than the default
    offset: Option<f32>,
    /// threads that step
    threads: usize,
}

/// Puts a scene into PhysX.
///
/// # Errors
/// PhysX does not start, or a shape that it does not take, in words.
pub(super) fn create(scene: &SceneData, setup: Setup) -> Result<Box<dyn Engine>, String> {
    let offset = (setup.margin == Margin::Thin).then_some(0.001);
    let mut engine = Physx::new(scene, setup.threads, offset)?;
    engine.fill(scene)?;
    Ok(Box::new(engine))
}

fn vector([x, y, z]: [f32; 3]) -> PxVec3 {
    PxVec3 { x, y, z }
}

/// A geometry in the place that the C interface wants: behind a pointer to what all geometries begin with.
enum Geometry {
    Sphere(PxSphereGeometry),
    Box(PxBoxGeometry),
    Hull(PxConvexMeshGeometry),
}

impl Geometry {
    fn pointer(&self) -> *const PxGeometry {
        match self {
            Geometry::Sphere(g) => std::ptr::from_ref(g).cast(),
            Geometry::Box(g) => std::ptr::from_ref(g).cast(),
            Geometry::Hull(g) => std::ptr::from_ref(g).cast(),
        }
    }
}

impl Physx {
    fn new(scene: &SceneData, threads: usize, offset: Option<f32>) -> Result<Physx, String> {
        let scale = Scale::of(scene);
        // SAFETY: the calls that PhysX demands, in its order, once a process (one scene a process). With no threads of its own
        // the dispatcher runs every task on the thread that steps.
        unsafe {
            let foundation = physx_create_foundation();
            let physics = physx_create_physics(foundation);
            if physics.is_null() {
                return Err("PhysX does not start".into());
            }
            let workers = if threads == 1 { 0 } else { threads as u32 };
            let mode = PxDefaultCpuDispatcherWaitForWorkMode::WaitForWork;
            let dispatcher = phys_PxDefaultCpuDispatcherCreate(workers, null_mut(), mode, 0);
            let mut desc = PxSceneDesc_new(PxPhysics_getTolerancesScale(physics));
            desc.gravity = vector(scale.vector(scene.gravity));
            desc.cpuDispatcher = dispatcher.cast();
            desc.filterShader = get_default_simulation_filter_shader();
            desc.bounceThresholdVelocity = 1e-4;
            // The default, PABP, is the same made for several threads.
            if threads == 1 {
                desc.broadPhaseType = PxBroadPhaseType::Abp;
            }
            let made = PxPhysics_createScene_mut(physics, &desc);
            let (friction, restitution) = (scene.friction as f32, scene.restitution as f32);
            let material = PxPhysics_createMaterial_mut(physics, friction, friction, restitution);
            if made.is_null() || material.is_null() {
                return Err("PhysX makes no scene".into());
            }
            let (bodies, dt) = (Vec::with_capacity(scene.bodies.len()), scene.dt as f32);
            Ok(Physx { foundation, physics, dispatcher, scene: made, material, bodies, scale, dt, offset, threads })
        }
    }

    fn fill(&mut self, scene: &SceneData) -> Result<(), String> {
        for (centre, half) in scene.walls() {
            let geometry = self.geometry(&NeutralShape::Box { half })?;
            // SAFETY: a plain value made of a position.
            let pose = unsafe { PxTransform_new_1(&vector(self.scale.vector(centre))) };
            self.add_fixed(&pose, &geometry)?;
        }
        let shapes = scene.shapes.iter().map(|s| self.geometry(s)).collect::<Result<Vec<_>, String>>()?;
        for body in &scene.bodies {
            let geometry = &shapes[body.shape as usize];
            let [x, y, z, w] = body.orientation.map(|x| x as f32);
            // SAFETY: a plain value made of a position and an orientation.
            let pose = unsafe { PxTransform_new_5(&vector(self.scale.vector(body.position)), &PxQuat { x, y, z, w }) };
            let made = if body.fixed { self.add_fixed(&pose, geometry)? } else { self.add(&pose, geometry, body)? };
            self.bodies.push((made, body.fixed));
        }
        Ok(())
    }

    fn geometry(&self, shape: &NeutralShape) -> Result<Geometry, String> {
        // SAFETY: plain values, except that the hull holds its mesh, which lives as long as the process.
        unsafe {
            Ok(match shape {
                NeutralShape::Sphere { radius } => Geometry::Sphere(PxSphereGeometry_new(self.scale.length(*radius))),
                NeutralShape::Box { half } => {
                    let [x, y, z] = self.scale.vector(*half);
                    Geometry::Box(PxBoxGeometry_new(x, y, z))
                }
                NeutralShape::Hull { points } => {
                    let points: Vec<PxVec3> = points.iter().map(|&p| vector(self.scale.vector(p))).collect();
                    let flags = PxConvexMeshGeometryFlags::empty();
                    Geometry::Hull(PxConvexMeshGeometry_new(self.mesh(&points)?, &PxMeshScale_new(), flags))
                }
            })
        }
    }

    fn mesh(&self, points: &[PxVec3]) -> Result<*mut PxConvexMesh, String> {
        // SAFETY: the description points at `points`, which outlive the call; the rest are PhysX's own defaults.
        let mesh = unsafe {
            let mut desc = PxConvexMeshDesc_new();
            desc.points.stride = size_of::<PxVec3>() as u32;
            desc.points.data = points.as_ptr().cast();
            desc.points.count = points.len() as u32;
            desc.flags = PxConvexFlags::ComputeConvex;
            let params = PxCookingParams_new(PxPhysics_getTolerancesScale(self.physics));
            let place = PxPhysics_getPhysicsInsertionCallback_mut(self.physics);
            phys_PxCreateConvexMesh(&params, &desc, place, null_mut())
        };
        if mesh.is_null() { Err("PhysX finds no convex hull".into()) } else { Ok(mesh) }
    }

    fn add_fixed(&self, pose: &PxTransform, geometry: &Geometry) -> Result<*mut PxRigidActor, String> {
        // SAFETY: physics, scene and material live; pose and geometry are read during the calls only.
        unsafe {
            let offset = PxTransform_new_2(PxIDENTITY::PxIdentity);
            let actor = phys_PxCreateStatic(self.physics, pose, geometry.pointer(), self.material, &offset);
            if actor.is_null() {
                return Err("PhysX takes no such fixed body".into());
            }
            self.set_offset(actor.cast());
            PxScene_addActor_mut(self.scene, actor.cast(), null());
            Ok(actor.cast())
        }
    }

    fn add(&self, pose: &PxTransform, geometry: &Geometry, body: &NeutralBody) -> Result<*mut PxRigidActor, String> {
        // SAFETY: physics, scene and material live; pose and geometry are read during the calls only.
        unsafe {
            let offset = PxTransform_new_2(PxIDENTITY::PxIdentity);
            let actor = phys_PxCreateDynamic(self.physics, pose, geometry.pointer(), self.material, 1.0, &offset);
            if actor.is_null() {
                return Err("PhysX takes no such body".into());
            }
            self.set_offset(actor.cast());
            PxRigidBody_setLinearDamping_mut(actor.cast(), 0.0);
            PxRigidBody_setAngularDamping_mut(actor.cast(), 0.0);
            PxRigidBody_setMaxLinearVelocity_mut(actor.cast(), 1e6);
            PxRigidBody_setMaxAngularVelocity_mut(actor.cast(), 1e6);
            PxRigidDynamic_setSleepThreshold_mut(actor, 0.0);
            PxRigidDynamic_setStabilizationThreshold_mut(actor, 0.0);
            PxScene_addActor_mut(self.scene, actor.cast(), null());
            PxRigidDynamic_setLinearVelocity_mut(actor, &vector(self.scale.vector(body.velocity)), true);
            PxRigidDynamic_setAngularVelocity_mut(actor, &vector(body.spin.map(|x| x as f32)), true);
            Ok(actor.cast())
        }
    }

    /// # Safety
    /// The actor lives and has one shape.
    unsafe fn set_offset(&self, actor: *const PxRigidActor) {
        let Some(offset) = self.offset else { return };
        let mut shape: *mut PxShape = null_mut();
        // SAFETY: room for one pointer, which is filled in as the actor has a shape.
        unsafe {
            PxRigidActor_getShapes(actor, &mut shape, 1, 0);
            PxShape_setContactOffset_mut(shape, offset);
        }
    }
}

impl Engine for Physx {
    fn version(&self) -> String {
        "5.1.3 (physx-sys 0.11)".into()
    }

    fn settings(&self) -> String {
        let offset = self.offset.unwrap_or(0.02);
        format!(
            "contact offset {offset}, bounce threshold 1e-4, speed caps 1e6, no damping, no sleep, PGS, PCM, {}",
            if self.threads == 1 { "ABP, no worker".into() } else { format!("PABP, {} workers", self.threads) }
        )
    }

    fn step(&mut self) -> Result<(), String> {
        let mut error = 0;
        // SAFETY: the scene lives; results are fetched before anything else is asked of it.
        unsafe {
            PxScene_simulate_mut(self.scene, self.dt, null_mut(), null_mut(), 0, true);
            PxScene_fetchResults_mut(self.scene, true, &mut error);
        }
        if error == 0 { Ok(()) } else { Err(format!("PhysX reports error {error}")) }
    }

    fn read(&self, state: &mut State) {
        state.clear();
        for &(body, fixed) in &self.bodies {
            // SAFETY: the actors live as long as their scene; no step is under way.
            let pose = unsafe { PxRigidActor_getGlobalPose(body) };
            let none = || vector([0.0; 3]);
            let (v, w) = if fixed {
                (none(), none())
            } else {
                // SAFETY: as above, and the actor is a dynamic one.
                unsafe {
                    (PxRigidDynamic_getLinearVelocity(body.cast()), PxRigidDynamic_getAngularVelocity(body.cast()))
                }
            };
            let (p, q) = (pose.p, pose.q);
            state.push(
                self.scale.back([p.x, p.y, p.z]),
                [q.x, q.y, q.z, q.w].map(f64::from),
                self.scale.back([v.x, v.y, v.z]),
                [w.x, w.y, w.z].map(f64::from),
            );
        }
    }
}

impl Drop for Physx {
    fn drop(&mut self) {
        // SAFETY: each was made once and is given back once, what is used after what uses it.
        unsafe {
            PxScene_release_mut(self.scene);
            PxDefaultCpuDispatcher_release_mut(self.dispatcher);
            PxPhysics_release_mut(self.physics);
            PxFoundation_release_mut(self.foundation);
        }
    }
}
