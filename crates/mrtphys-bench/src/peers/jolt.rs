//! Jolt, behind the interface of the comparison.
//!
//! The C interface of `joltc-sys` does not reach Jolt's `PhysicsSettings`: neither the distance of speculative contacts
//! (0.02) nor the smallest velocity that rebounds (1) can be set. Jolt knows no other lengths than these and a few like them,
//! so a scene that is twenty times as large is a scene with a twentieth of the margin: this is how the thin margin is had. Nor
//! can gravity be set: it is 9.81 downwards along y, times a factor that every body has.

use super::scene::{NeutralBody, NeutralShape, SceneData};
use super::{Engine, Margin, Scale, Setup, State};
use joltc_sys::*;
use std::ffi::{CStr, c_uint, c_void};
use std::ptr::{null, null_mut};

/// Layer of what never moves, and of the rest; the broad phase has the same two.
const FIXED: u16 = 0;
const MOVING: u16 = 1;

/// Gravity along y that Jolt applies to a body of factor 1.
const GRAVITY: f32 = -9.81;

/// Bytes of temporary memory: a contact constraint has about 900.
const BYTES_PER_CONSTRAINT: usize = 1_100;

/// More would not fit into Jolt's temporary memory, whose size is a 32-bit number.
const MOST_CONSTRAINTS: usize = 2_500_000;

struct Jolt {
    system: *mut JPC_PhysicsSystem,
    memory: *mut JPC_TempAllocatorImpl,
    jobs: *mut JPC_JobSystemThreadPool,
    layers: *mut JPC_BroadPhaseLayerInterface,
    layer_filter: *mut JPC_ObjectVsBroadPhaseLayerFilter,
    pair_filter: *mut JPC_ObjectLayerPairFilter,
    bodies: Vec<*mut JPC_Body>,
    scale: Scale,
    dt: f32,
    settings: String,
}

/// Puts a scene into Jolt.
///
/// # Errors
/// A shape that Jolt does not take, in words.
pub(super) fn create(scene: &SceneData, setup: Setup) -> Result<Box<dyn Engine>, String> {
    let larger = if setup.margin == Margin::Thin { 20.0 } else { 1.0 };
    let scale = Scale(Scale::of(scene).0 * larger);
    if scene.gravity[0] != 0.0 || scene.gravity[2] != 0.0 {
        return Err("gravity along x or z: the C interface of joltc-sys 0.3 cannot turn Jolt's".into());
    }
    let settings = format!(
        "scene enlarged {larger} times, so that the fixed speculative distance is {} and the smallest rebound {} in units of \
         the others; speed caps 1e6, no damping, no sleep",
        0.02 / larger,
        1.0 / larger
    );
    let mut engine = Jolt::new(scene.bodies.len(), setup.threads, scale);
    engine.dt = scene.dt as f32;
    engine.settings = settings;
    engine.fill(scene)?;
    Ok(Box::new(engine))
}

unsafe extern "C" fn layer_count(_: *const c_void) -> c_uint {
    2
}

unsafe extern "C" fn layer_of(_: *const c_void, layer: JPC_ObjectLayer) -> JPC_BroadPhaseLayer {
    layer as JPC_BroadPhaseLayer
}

unsafe extern "C" fn layer_meets(_: *const c_void, layer: JPC_ObjectLayer, other: JPC_BroadPhaseLayer) -> bool {
    layer == MOVING || u16::from(other) == MOVING
}

unsafe extern "C" fn pair_meets(_: *const c_void, a: JPC_ObjectLayer, b: JPC_ObjectLayer) -> bool {
    a == MOVING || b == MOVING
}

impl Jolt {
    fn new(bodies: usize, threads: usize, scale: Scale) -> Jolt {
        let constraints = (8 * bodies + 4096).min(MOST_CONSTRAINTS);
        let memory = constraints * BYTES_PER_CONSTRAINT + 512 * bodies + (32 << 20);
        let memory = u32::try_from(memory).unwrap_or(u32::MAX - (1 << 20));
        let layers = JPC_BroadPhaseLayerInterfaceFns {
            GetNumBroadPhaseLayers: Some(layer_count),
            GetBroadPhaseLayer: Some(layer_of),
        };
        let layer_filter = JPC_ObjectVsBroadPhaseLayerFilterFns { ShouldCollide: Some(layer_meets) };
        let pair_filter = JPC_ObjectLayerPairFilterFns { ShouldCollide: Some(pair_meets) };
        // SAFETY: the calls that Jolt demands, in its order, once a process (one scene a process). The callbacks take no data.
        // All that is made here is kept until the engine is dropped.
        unsafe {
            JPC_RegisterDefaultAllocator();
            JPC_FactoryInit();
            JPC_RegisterTypes();
            let engine = Jolt {
                system: JPC_PhysicsSystem_new(),
                memory: JPC_TempAllocatorImpl_new(memory),
                jobs: JPC_JobSystemThreadPool_new3(
                    JPC_MAX_PHYSICS_JOBS as c_uint,
                    JPC_MAX_PHYSICS_BARRIERS as c_uint,
                    threads as i32 - 1,
                ),
                layers: JPC_BroadPhaseLayerInterface_new(null(), layers),
                layer_filter: JPC_ObjectVsBroadPhaseLayerFilter_new(null(), layer_filter),
                pair_filter: JPC_ObjectLayerPairFilter_new(null(), pair_filter),
                bodies: Vec::with_capacity(bodies),
                scale,
                dt: 0.0,
                settings: String::new(),
            };
            let most = bodies as c_uint + 64;
            JPC_PhysicsSystem_Init(
                engine.system,
                most,
                0,
                constraints as c_uint * 2,
                constraints as c_uint,
                engine.layers,
                engine.layer_filter,
                engine.pair_filter,
            );
            engine
        }
    }

    fn fill(&mut self, scene: &SceneData) -> Result<(), String> {
        let template = JPC_BodyCreationSettings {
            MotionType: JPC_MOTION_TYPE_DYNAMIC,
            ObjectLayer: MOVING,
            Friction: scene.friction as f32,
            Restitution: scene.restitution as f32,
            LinearDamping: 0.0,
            AngularDamping: 0.0,
            MaxLinearVelocity: 1e6,
            MaxAngularVelocity: 1e6,
            AllowSleeping: false,
            GravityFactor: self.scale.length(scene.gravity[1]) / GRAVITY,
            ..Default::default()
        };
        for (centre, half) in scene.walls() {
            let shape = self.shape(&NeutralShape::Box { half })?;
            let position = real(self.scale.vector(centre));
            let wall = JPC_BodyCreationSettings { Position: position, Shape: shape, ..fixed(template) };
            self.add(&wall)?;
        }
        let shapes = scene.shapes.iter().map(|s| self.shape(s)).collect::<Result<Vec<_>, _>>()?;
        for body in &scene.bodies {
            let settings = self.placed(body, if body.fixed { fixed(template) } else { template });
            let body = self.add(&JPC_BodyCreationSettings { Shape: shapes[body.shape as usize], ..settings })?;
            self.bodies.push(body);
        }
        // SAFETY: the system lives; no step is under way.
        unsafe { JPC_PhysicsSystem_OptimizeBroadPhase(self.system) };
        Ok(())
    }

    fn placed(&self, body: &NeutralBody, template: JPC_BodyCreationSettings) -> JPC_BodyCreationSettings {
        let [x, y, z, w] = body.orientation.map(|x| x as f32);
        JPC_BodyCreationSettings {
            Position: real(self.scale.vector(body.position)),
            Rotation: JPC_Quat { x, y, z, w },
            LinearVelocity: real(self.scale.vector(body.velocity)),
            AngularVelocity: real(body.spin.map(|x| x as f32)),
            ..template
        }
    }

    fn add(&self, settings: &JPC_BodyCreationSettings) -> Result<*mut JPC_Body, String> {
        // SAFETY: the system lives; settings that began as the default ones and a shape that is never released.
        unsafe {
            let bodies = JPC_PhysicsSystem_GetBodyInterface(self.system);
            let body = JPC_BodyInterface_CreateBody(bodies, settings);
            if body.is_null() {
                return Err("Jolt has no room for another body".into());
            }
            JPC_BodyInterface_AddBody(bodies, JPC_Body_GetID(body), JPC_ACTIVATION_ACTIVATE);
            Ok(body)
        }
    }

    /// A shape that lives as long as the process: bodies hold it, and one scene a process is all there is.
    fn shape(&self, shape: &NeutralShape) -> Result<*const JPC_Shape, String> {
        let (mut made, mut error) = (null_mut::<JPC_Shape>(), null_mut::<JPC_String>());
        // SAFETY: settings that began as the default ones, points that outlive the call, and places for the results.
        let good = unsafe {
            match shape {
                NeutralShape::Sphere { radius } => {
                    let settings = JPC_SphereShapeSettings {
                        Density: 1.0,
                        Radius: self.scale.length(*radius),
                        ..Default::default()
                    };
                    JPC_SphereShapeSettings_Create(&settings, &mut made, &mut error)
                }
                NeutralShape::Box { half } => {
                    let half = real(self.scale.vector(*half));
                    let settings = JPC_BoxShapeSettings {
                        Density: 1.0,
                        HalfExtent: half,
                        ConvexRadius: 0.0,
                        ..Default::default()
                    };
                    JPC_BoxShapeSettings_Create(&settings, &mut made, &mut error)
                }
                NeutralShape::Hull { points } => {
                    let points: Vec<JPC_Vec3> = points.iter().map(|&p| real(self.scale.vector(p))).collect();
                    let settings = JPC_ConvexHullShapeSettings {
                        Density: 1.0,
                        Points: points.as_ptr(),
                        PointsLen: points.len(),
                        MaxConvexRadius: 0.0,
                        ..Default::default()
                    };
                    JPC_ConvexHullShapeSettings_Create(&settings, &mut made, &mut error)
                }
            }
        };
        if good {
            return Ok(made);
        }
        // SAFETY: Jolt has filled in the reason; it is read once and given back.
        unsafe {
            let why = CStr::from_ptr(JPC_String_c_str(error)).to_string_lossy().into_owned();
            JPC_String_delete(error);
            Err(format!("Jolt takes no such shape: {why}"))
        }
    }
}

fn fixed(template: JPC_BodyCreationSettings) -> JPC_BodyCreationSettings {
    JPC_BodyCreationSettings { MotionType: JPC_MOTION_TYPE_STATIC, ObjectLayer: FIXED, ..template }
}

fn real([x, y, z]: [f32; 3]) -> JPC_Vec3 {
    JPC_Vec3 { x, y, z, _w: z }
}

impl Engine for Jolt {
    fn version(&self) -> String {
        "5.0.0 (joltc-sys 0.3)".into()
    }

    fn settings(&self) -> String {
        self.settings.clone()
    }

    fn step(&mut self) -> Result<(), String> {
        // SAFETY: all of these live, and no other call is under way.
        let error = unsafe { JPC_PhysicsSystem_Update(self.system, self.dt, 1, self.memory, self.jobs) };
        if error == JPC_PHYSICS_UPDATE_ERROR_NONE {
            Ok(())
        } else {
            Err(format!("Jolt reports a full cache (code {error}): contacts were left out"))
        }
    }

    fn read(&self, state: &mut State) {
        state.clear();
        for &body in &self.bodies {
            // SAFETY: bodies live as long as their system; no step is under way.
            let (p, q, v, w) = unsafe {
                (
                    JPC_Body_GetCenterOfMassPosition(body),
                    JPC_Body_GetRotation(body),
                    JPC_Body_GetLinearVelocity(body),
                    JPC_Body_GetAngularVelocity(body),
                )
            };
            state.push(
                self.scale.back([p.x, p.y, p.z]),
                [q.x, q.y, q.z, q.w].map(f64::from),
                self.scale.back([v.x, v.y, v.z]),
                [w.x, w.y, w.z].map(f64::from),
            );
        }
    }
}

impl Drop for Jolt {
    fn drop(&mut self) {
        // SAFETY: each was made by its `new` and is given back once, the system before what it uses.
        unsafe {
            JPC_PhysicsSystem_delete(self.system);
            JPC_ObjectLayerPairFilter_delete(self.pair_filter);
            JPC_ObjectVsBroadPhaseLayerFilter_delete(self.layer_filter);
            JPC_BroadPhaseLayerInterface_delete(self.layers);
            JPC_JobSystemThreadPool_delete(self.jobs);
            JPC_TempAllocatorImpl_delete(self.memory);
        }
    }
}
