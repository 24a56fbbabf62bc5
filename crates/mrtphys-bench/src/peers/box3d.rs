//! Box3D, behind the interface of the comparison.

use super::scene::{NeutralBody, NeutralShape, SceneData};
use super::{Engine, Margin, Scale, Setup, State};
use boxddd_sys::ffi;
use std::ffi::{c_char, c_void};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Substeps of a step: what Box3D's own documentation and samples use.
const SUBSTEPS: i32 = 4;

/// A block of bodies is counted in 16 bits and a worker has four: what is beyond would stand still in silence
/// (`b3ComputeBlockCount`, `b3InitBlocks`).
const BODIES_PER_WORKER: usize = 4 * 65_535;

struct Box3d {
    world: ffi::b3WorldId,
    bodies: Vec<ffi::b3BodyId>,
    scale: Scale,
    dt: f32,
    settings: String,
}

/// Puts a scene into Box3D. It has as many workers as the number of bodies needs; where these are more than threads, the
/// threads of the pool in which it is called do their work, so that no more threads compute than were asked for.
///
/// # Errors
/// More bodies than Box3D moves, or a shape that it does not take, in words.
pub(super) fn create(scene: &SceneData, setup: Setup) -> Result<Box<dyn Engine>, String> {
    let scale = Scale::of(scene);
    let workers = setup.threads.max(scene.bodies.len().div_ceil(BODIES_PER_WORKER));
    if workers > ffi::B3_MAX_WORKERS as usize {
        return Err(format!("{} bodies: Box3D moves at most {}", scene.bodies.len(), 32 * BODIES_PER_WORKER));
    }
    let unit = if setup.margin == Margin::Thin { 0.05 } else { 1.0 };
    // SAFETY: no other world exists in this process: one scene a process. Everything that depends on this unit is made after.
    unsafe { ffi::b3SetLengthUnitsPerMeter(unit) };
    // SAFETY: returns a plain value.
    let mut def = unsafe { ffi::b3DefaultWorldDef() };
    def.gravity = vector(scale.vector(scene.gravity));
    def.restitutionThreshold = 0.0;
    def.maximumLinearSpeed = 1e6;
    def.enableSleep = false;
    def.workerCount = workers as u32;
    if workers > setup.threads {
        def.enqueueTask = Some(spawn);
        def.finishTask = Some(wait);
    }
    // SAFETY: a definition that began as the default one; it is only read.
    let world = unsafe { ffi::b3CreateWorld(&def) };
    let settings = format!(
        "{SUBSTEPS} substeps, length unit {unit}, restitution threshold 0, speed cap 1e6, fast rotation allowed, no sleep, \
         {workers} worker(s) on {} thread(s){}",
        setup.threads,
        env!("MRTPHYS_BENCH_BOX3D")
    );
    let mut engine = Box3d { world, bodies: Vec::new(), scale, dt: scene.dt as f32, settings };
    engine.fill(scene)?;
    Ok(Box::new(engine))
}

/// A task of Box3D with what belongs to it, on its way to another thread.
struct Task(unsafe extern "C" fn(*mut c_void), *mut c_void);

// SAFETY: Box3D hands out tasks for other threads to run; what they share is its own concern.
unsafe impl Send for Task {}

/// Gives a task to the pool. Box3D asks for no order: it says itself that there may be fewer threads than workers
/// (`b3SolverTask`).
///
/// # Safety
/// Called by Box3D only, with its own task and the context that belongs to it.
unsafe extern "C" fn spawn(
    task: ffi::b3TaskCallback,
    context: *mut c_void,
    _: *mut c_void,
    _: *const c_char,
) -> *mut c_void {
    let Some(task) = task else { return std::ptr::null_mut() };
    let done = Arc::new(AtomicBool::new(false));
    let (task, told) = (Task(task, context), done.clone());
    rayon::spawn(move || {
        let Task(run, context) = { task };
        // SAFETY: the task is called once with the context that came with it, which Box3D keeps until it has waited for it.
        unsafe { run(context) };
        told.store(true, Ordering::Release);
    });
    Arc::into_raw(done).cast_mut().cast()
}

/// Waits for a task and does others meanwhile.
///
/// # Safety
/// Called by Box3D only, once for each task that is not null.
unsafe extern "C" fn wait(task: *mut c_void, _: *mut c_void) {
    // SAFETY: made by `spawn`, waited for once.
    let done = unsafe { Arc::from_raw(task.cast_const().cast::<AtomicBool>()) };
    while !done.load(Ordering::Acquire) {
        if rayon::yield_now() != Some(rayon::Yield::Executed) {
            std::hint::spin_loop();
        }
    }
}

fn vector([x, y, z]: [f32; 3]) -> ffi::b3Vec3 {
    ffi::b3Vec3 { x, y, z }
}

/// A shape ready to be attached. The hulls belong to us; Box3D copies them.
enum Ready {
    Sphere(f32),
    Box(Box<ffi::b3BoxHull>),
    Hull(*mut ffi::b3HullData),
}

impl Ready {
    fn new(shape: &NeutralShape, scale: Scale) -> Result<Ready, String> {
        Ok(match shape {
            NeutralShape::Sphere { radius } => Ready::Sphere(scale.length(*radius)),
            NeutralShape::Box { half } => Ready::cuboid(scale.vector(*half)),
            NeutralShape::Hull { points } => {
                let points: Vec<ffi::b3Vec3> = points.iter().map(|&p| vector(scale.vector(p))).collect();
                let count = points.len() as i32;
                // SAFETY: `count` points, only read.
                let hull = unsafe { ffi::b3CreateHull(points.as_ptr(), count, count) };
                if hull.is_null() {
                    return Err("Box3D finds no convex hull".into());
                }
                Ready::Hull(hull)
            }
        })
    }

    fn cuboid([x, y, z]: [f32; 3]) -> Ready {
        // SAFETY: returns a plain value; its offsets are relative to itself.
        Ready::Box(Box::new(unsafe { ffi::b3MakeBoxHull(x, y, z) }))
    }

    fn attach(&self, body: ffi::b3BodyId, def: &ffi::b3ShapeDef) {
        // SAFETY: the body was made by this world; definition and geometry live through the call and are copied by it.
        unsafe {
            match self {
                Ready::Sphere(radius) => {
                    let sphere = ffi::b3Sphere { center: vector([0.0; 3]), radius: *radius };
                    ffi::b3CreateSphereShape(body, def, &sphere);
                }
                // The box hull begins with its hull; the pointer is to the whole of it, over which the hull's offsets reach.
                Ready::Box(hull) => {
                    ffi::b3CreateHullShape(body, def, std::ptr::from_ref(&**hull).cast());
                }
                Ready::Hull(hull) => {
                    ffi::b3CreateHullShape(body, def, *hull);
                }
            }
        }
    }
}

impl Drop for Ready {
    fn drop(&mut self) {
        if let Ready::Hull(hull) = self {
            // SAFETY: made by b3CreateHull, destroyed here only.
            unsafe { ffi::b3DestroyHull(*hull) };
        }
    }
}

impl Box3d {
    fn fill(&mut self, scene: &SceneData) -> Result<(), String> {
        // SAFETY: returns a plain value.
        let mut def = unsafe { ffi::b3DefaultShapeDef() };
        def.density = 1.0;
        def.baseMaterial.friction = scene.friction as f32;
        def.baseMaterial.restitution = scene.restitution as f32;
        for (centre, half) in scene.walls() {
            // SAFETY: returns a plain value.
            let mut wall = unsafe { ffi::b3DefaultBodyDef() };
            wall.position = vector(self.scale.vector(centre));
            // SAFETY: the world lives; a definition that began as the default one, only read.
            let body = unsafe { ffi::b3CreateBody(self.world, &wall) };
            Ready::cuboid(self.scale.vector(half)).attach(body, &def);
        }
        let shapes = scene.shapes.iter().map(|s| Ready::new(s, self.scale)).collect::<Result<Vec<_>, _>>()?;
        for body in &scene.bodies {
            let id = self.place(body);
            shapes[body.shape as usize].attach(id, &def);
            self.bodies.push(id);
        }
        Ok(())
    }

    fn place(&self, body: &NeutralBody) -> ffi::b3BodyId {
        // SAFETY: returns a plain value.
        let mut def = unsafe { ffi::b3DefaultBodyDef() };
        let [x, y, z, w] = body.orientation.map(|x| x as f32);
        def.type_ = if body.fixed { ffi::b3BodyType_b3_staticBody } else { ffi::b3BodyType_b3_dynamicBody };
        def.position = vector(self.scale.vector(body.position));
        def.rotation = ffi::b3Quat { v: vector([x, y, z]), s: w };
        def.linearVelocity = vector(self.scale.vector(body.velocity));
        def.angularVelocity = vector(body.spin.map(|x| x as f32));
        def.enableSleep = false;
        def.allowFastRotation = true;
        // SAFETY: the world lives; a definition that began as the default one, only read.
        unsafe { ffi::b3CreateBody(self.world, &def) }
    }
}

impl Engine for Box3d {
    fn version(&self) -> String {
        // SAFETY: returns a plain value.
        let v = unsafe { ffi::b3GetVersion() };
        format!("{}.{}.{} (boxddd-sys 0.4)", v.major, v.minor, v.revision)
    }

    fn settings(&self) -> String {
        self.settings.clone()
    }

    fn step(&mut self) -> Result<(), String> {
        // SAFETY: the world lives and no other call is under way.
        unsafe { ffi::b3World_Step(self.world, self.dt, SUBSTEPS) };
        Ok(())
    }

    fn read(&self, state: &mut State) {
        state.clear();
        for &body in &self.bodies {
            // SAFETY: the bodies live as long as their world.
            let (p, q, v, w) = unsafe {
                (
                    ffi::b3Body_GetWorldCenter(body),
                    ffi::b3Body_GetRotation(body),
                    ffi::b3Body_GetLinearVelocity(body),
                    ffi::b3Body_GetAngularVelocity(body),
                )
            };
            state.push(
                self.scale.back([p.x, p.y, p.z]),
                [q.v.x, q.v.y, q.v.z, q.s].map(f64::from),
                self.scale.back([v.x, v.y, v.z]),
                [w.x, w.y, w.z].map(f64::from),
            );
        }
    }
}

impl Drop for Box3d {
    fn drop(&mut self) {
        // SAFETY: made by b3CreateWorld, destroyed here only.
        unsafe { ffi::b3DestroyWorld(self.world) };
    }
}
