//! The hand that holds a body.
//!
//! A critically damped spring from the grip point to the target, x'' = -w^2 x - 2 w x', taken implicitly over a step h:
//! with e the way from the target to the point and u the point's velocity,
//!
//! u' = u - h w^2 (e + h u') - 2 h w u'   =>   u' = (u - h w^2 e) / (1 + w h)^2,
//!
//! which shrinks for every h. The impulse that makes the point's velocity u' is K^-1 (u' - u), `K = 1/m + [r]x^T J^-1 [r]x`
//! (the matrix of equation (37)): so the motion is the same for every mass. The spring's frequency follows the frame rate,
//! so a body arrives after about as many pictures in every scene.

use super::command::Grip;
use mrtphys::world::Body;
use mrtphys::{BodyId, Mat3, Real, Vec3, World};
use mrtphys_scene::Loaded;

/// The spring's angular frequency, in units of the frame rate.
const STIFFNESS: Real = 0.4;
/// How fast turning dies down, in units of the spring's frequency: slow enough for a body to swing about the hand once.
const SPIN_DAMPING: Real = 0.5;
/// The hand moves a body by at most this part of its diameter in a step: more, and it could pass through another unseen
/// (requirement 4).
const LARGEST_STEP: Real = 0.25;

/// A hand at work.
#[derive(Clone, Debug)]
pub struct Hand {
    /// what it holds, and where to
    pub grip: Grip,
}

/// The motion of a body before the hand touched it.
pub struct Untouched {
    body: BodyId,
    position: Vec3,
    velocity: Vec3,
    angular_momentum: Vec3,
}

impl Untouched {
    fn of(body: &Body) -> Untouched {
        let Body { id, position, velocity, angular_momentum, .. } = *body;
        Untouched { body: id, position, velocity, angular_momentum }
    }

    /// Undoes what the hand did.
    pub fn put_back(self, world: &mut World) {
        // What was taken from a body fits it.
        let _ = world.set_position(self.body, self.position);
        let _ = world.set_velocity(self.body, self.velocity);
        let _ = world.set_angular_momentum(self.body, self.angular_momentum);
    }
}

impl Hand {
    /// Takes hold.
    ///
    /// # Errors
    /// The body is gone, or a place is not a finite number.
    pub fn new(grip: Grip, loaded: &Loaded) -> Result<Hand, String> {
        loaded.world.body(grip.body).map_err(|e| format!("hold: {e}"))?;
        if grip.point.is_finite() && grip.target.is_finite() {
            return Ok(Hand { grip });
        }
        let name = loaded.names.body_name(grip.body).unwrap_or_default();
        Err(format!("hold body '{name}': a place is not a finite number"))
    }

    /// Puts the body where it is wanted at once: in a world that stands still.
    ///
    /// # Errors
    /// The place is out of range.
    pub fn carry(&self, world: &mut World) -> Result<(), String> {
        let Ok(body) = world.body(self.grip.body) else { return Ok(()) };
        let arm = body.orientation.rotate(self.grip.point);
        world.set_position(body.id, self.grip.target - arm).map_err(|e| e.to_string())
    }

    /// Pulls for a step of this length \[s\]. What the body did before, so that a step that fails can be undone; `None`: the
    /// body is gone, or was set aside.
    pub fn pull(&mut self, world: &mut World, dt: Real) -> Option<Untouched> {
        let body = world.body(self.grip.body).ok().filter(|b| !b.set_aside)?;
        let before = Untouched::of(&body);
        let reach = LARGEST_STEP * 2.0 * body.shape.bounding_sphere().radius;
        let arm = body.orientation.rotate(self.grip.point);
        let error = body.position + arm - self.grip.target;
        if body.mass == Real::INFINITY {
            let _ = world.set_position(body.id, body.position - shortened(error, reach));
            return Some(before);
        }
        let w = STIFFNESS * Real::from(world.settings().fps);
        // Turning dies down about the grip point, not about the centre: the point's velocity stays what it is.
        let rest = 1.0 / (1.0 + SPIN_DAMPING * w * dt);
        let u = body.velocity + body.angular_velocity.cross(arm);
        let _ = world.set_angular_momentum(body.id, body.angular_momentum * rest);
        let _ = world.set_velocity(body.id, u - (body.angular_velocity * rest).cross(arm));
        let grow = 1.0 + w * dt;
        let wanted = shortened((u - error * (dt * w * w)) / (grow * grow), reach / dt);
        if let Some(per_mass) = solve(&point_mobility(&body, arm), wanted - u) {
            let _ = world.apply_impulse(body.id, per_mass * body.mass, body.position + arm);
        }
        Some(before)
    }
}

/// At most this long.
fn shortened(v: Vec3, longest: Real) -> Vec3 {
    let length = v.length();
    if length > longest { v * (longest / length) } else { v }
}

/// The velocity that an impulse at a point gives the point, times the mass: `1 - m [r]x J^-1 [r]x`. A number near 1 for
/// every mass.
fn point_mobility(body: &Body, arm: Vec3) -> Mat3 {
    let inverse = body.inertia.inverse_world(body.orientation);
    let column = |axis: Vec3| axis + (inverse * arm.cross(axis) * body.mass).cross(arm);
    Mat3::from_columns(column(Vec3::X), column(Vec3::Y), column(Vec3::Z))
}

/// Cramer's rule: the matrix is symmetric, and its eigenvalues are 1 or more.
fn solve(m: &Mat3, b: Vec3) -> Option<Vec3> {
    let [x, y, z] = m.c;
    let d = x.dot(y.cross(z));
    (d.is_normal()).then(|| Vec3::new(b.dot(y.cross(z)), x.dot(b.cross(z)), x.dot(y.cross(b))) / d)
}
