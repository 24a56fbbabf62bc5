//! What makes a speed worth something: energy, bodies that left, bodies that did not move, collisions. All of it is found from
//! positions and velocities alone, so that no engine is its own witness.

use crate::peers::State;
use crate::peers::scene::{SceneData, Triple, norm};
use mrtphys::Vec3;

/// A velocity that changed by more than this part of the mean one was changed by a collision; less is rounding.
const CHANGED: f64 = 1e-4;

/// A body in free flight moved v t if it did so to this part.
const MOVED: f64 = 1e-2;

/// A run in which fewer of the bodies in free flight moved v t is not a run of this scene. Some are short of it in an engine
/// that stops bodies at their first contact and turns them round in the next step.
pub const MOVED_ENOUGH: f64 = 0.9;

/// Masses and moments of the bodies of a scene.
pub struct Masses {
    /// per shape: mass, moments per mass, principal axes
    shapes: Vec<(f64, [f64; 3], [f64; 4])>,
    of_body: Vec<u32>,
    fixed: Vec<bool>,
    gravity: Triple,
}

impl Masses {
    /// Those of a scene.
    ///
    /// # Errors
    /// A shape without mass, in words.
    pub fn new(scene: &SceneData) -> Result<Masses, String> {
        let shape = |s: &crate::peers::scene::NeutralShape| {
            let (mass, p) = s.mass()?;
            let m = p.moments_per_mass;
            Ok((mass, [m.x, m.y, m.z], [p.axes.x, p.axes.y, p.axes.z, p.axes.w]))
        };
        Ok(Masses {
            shapes: scene.shapes.iter().map(shape).collect::<Result<_, String>>()?,
            of_body: scene.bodies.iter().map(|b| b.shape).collect(),
            fixed: scene.bodies.iter().map(|b| b.fixed).collect(),
            gravity: scene.gravity,
        })
    }

    /// Kinetic and potential energy \[J\].
    pub fn energy(&self, state: &State) -> f64 {
        // Neumaier's sum: a plain one of a million terms is off by more than the energy of an exact engine.
        let (mut sum, mut lost) = (0.0f64, 0.0);
        for i in (0..self.of_body.len()).filter(|&i| !self.fixed[i]) {
            let (mass, moments, [x, y, z, w]) = self.shapes[self.of_body[i] as usize];
            let square = |v: Triple| v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
            let spin = state.spin[i];
            let rotational = if moments[0] == moments[1] && moments[1] == moments[2] {
                moments[0] * square(spin)
            } else {
                let [qx, qy, qz, qw] = state.orientation[i];
                let turn = mrtphys::Quat { x: qx, y: qy, z: qz, w: qw } * mrtphys::Quat { x, y, z, w };
                let local = turn.conjugate().rotate(Vec3::new(spin[0], spin[1], spin[2]));
                moments[0] * local.x * local.x + moments[1] * local.y * local.y + moments[2] * local.z * local.z
            };
            let height: f64 = (0..3).map(|k| -self.gravity[k] * state.position[i][k]).sum();
            let term = mass * (0.5 * (square(state.velocity[i]) + rotational) + height);
            let next = sum + term;
            lost += if sum.abs() >= term.abs() { (sum - next) + term } else { (term - next) + sum };
            sum = next;
        }
        sum + lost
    }
}

/// Bodies whose centre is outside the container.
pub fn escaped(scene: &SceneData, state: &State) -> usize {
    let Some((low, high)) = scene.container else { return 0 };
    // Not being inside, rather than being outside: a position that is no number has escaped.
    let inside = |p: &Triple| (0..3).all(|k| low[k] <= p[k] && p[k] <= high[k]);
    state.position.iter().filter(|p| !inside(p)).count()
}

/// Says in words how a state differs from that of the scene's file.
///
/// # Errors
/// It differs by more than single precision explains.
pub fn same_start(scene: &SceneData, state: &State) -> Result<(), String> {
    if state.position.len() != scene.bodies.len() {
        return Err(format!("{} bodies of {}", state.position.len(), scene.bodies.len()));
    }
    let size = |f: fn(&crate::peers::scene::NeutralBody) -> Triple| {
        scene.bodies.iter().map(|b| norm(f(b))).fold(f64::MIN_POSITIVE, f64::max)
    };
    let largest = [size(|b| b.position), size(|b| b.velocity), size(|b| b.spin)];
    for (i, body) in scene.bodies.iter().enumerate() {
        let pairs =
            [(body.position, state.position[i]), (body.velocity, state.velocity[i]), (body.spin, state.spin[i])];
        for (what, ((a, b), largest)) in
            ["position", "velocity", "angular velocity"].iter().zip(pairs.into_iter().zip(largest))
        {
            if !(norm([a[0] - b[0], a[1] - b[1], a[2] - b[2]]) <= 1e-5 * largest) {
                return Err(format!("body {i} starts with the {what} {b:?}, not {a:?}"));
            }
        }
    }
    Ok(())
}

/// What is counted over steps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Watched {
    /// steps
    pub steps: u64,
    /// bodies times steps
    pub body_steps: u64,
    /// of these, with a velocity that changed
    pub changes: u64,
    /// sum over the steps of the root of the mean square velocity \[m/s\]
    pub speed: f64,
    /// of the bodies times steps without a change, those that moved v t
    pub moved: u64,
}

impl Watched {
    /// Part of the bodies in free flight that moved v t; `None` if none was in free flight.
    pub fn moved_part(&self) -> Option<f64> {
        let free = self.body_steps - self.changes;
        (free > 0).then(|| self.moved as f64 / free as f64)
    }

    /// Steps with a change of velocity, per body and second.
    pub fn rate(&self, dt: f64) -> f64 {
        self.changes as f64 / (self.body_steps as f64 * dt)
    }
}

/// Looks at the states before and after a step.
pub fn watch(scene: &SceneData, before: &State, after: &State, watched: &mut Watched) {
    let n = scene.bodies.len();
    let square = |v: Triple| v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    let mean = (before.velocity.iter().map(|&v| square(v)).sum::<f64>() / n as f64).sqrt();
    // A position in single precision is known to its last place only.
    let extent = before.position.iter().map(|&p| norm(p)).fold(0.0, f64::max);
    let rounding = extent * 8.0 * f64::from(f32::EPSILON);
    watched.steps += 1;
    watched.speed += mean;
    for i in (0..n).filter(|&i| !scene.bodies[i].fixed) {
        let difference = |a: Triple, b: Triple| [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
        let fall = scene.gravity.map(|g| g * scene.dt);
        let change = difference(fall, difference(before.velocity[i], after.velocity[i]));
        watched.body_steps += 1;
        // A change that is no number is one.
        if !(norm(change) <= CHANGED * mean) {
            watched.changes += 1;
            continue;
        }
        let way = before.velocity[i].map(|v| v * scene.dt);
        let error = norm(difference(way, difference(before.position[i], after.position[i])));
        let allowed = MOVED * norm(way) + rounding + norm(fall) * scene.dt;
        watched.moved += u64::from(error <= allowed);
    }
}
