//! Stage 2: bounding spheres and boxes of everything, once a step. Bounds are conservative for the exact routines: whatever
//! a pair routine would call a contact overlaps in bounds.

use crate::math::{Mat3, Real, Vec3};
use crate::model::Model;
use crate::par;
use crate::state::{Line, State};
use crate::work::Work;
use std::sync::atomic::{AtomicU64, Ordering};

/// A sphere; radius below zero: empty, meets nothing; infinite: meets everything that is not empty.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Ball {
    /// centre \[m\]
    pub center: Vec3,
    /// radius \[m\]
    pub radius: Real,
}

impl Ball {
    /// The empty ball.
    pub const EMPTY: Ball = Ball { center: Vec3::ZERO, radius: -1.0 };

    /// Whether the ball is empty.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.radius < 0.0
    }

    /// Whether two balls meet; touching counts. **The** bounding-sphere test: every broad phase uses this very expression,
    /// so that they agree to the last bit.
    #[inline]
    pub fn meets(&self, o: &Ball) -> bool {
        let d = self.center - o.center;
        let r = self.radius + o.radius;
        d.length_squared() <= r * r && self.radius >= 0.0 && o.radius >= 0.0
    }
}

/// An axis-parallel box; bounds may be infinite; `min > max` in any axis: empty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// lower corner \[m\]
    pub min: Vec3,
    /// upper corner \[m\]
    pub max: Vec3,
}

impl Aabb {
    /// The empty box.
    pub const EMPTY: Aabb = Aabb { min: Vec3::splat(Real::INFINITY), max: Vec3::splat(Real::NEG_INFINITY) };
    /// All of space.
    pub const EVERYWHERE: Aabb = Aabb { min: Vec3::splat(Real::NEG_INFINITY), max: Vec3::splat(Real::INFINITY) };

    /// The box round a ball.
    #[inline]
    pub fn of_ball(b: &Ball) -> Aabb {
        let r = Vec3::splat(b.radius);
        Aabb { min: b.center - r, max: b.center + r }
    }

    /// The smallest box that holds all the points.
    pub fn of_points(points: impl IntoIterator<Item = Vec3>) -> Aabb {
        points.into_iter().fold(Aabb::EMPTY, |b, p| Aabb { min: b.min.min(p), max: b.max.max(p) })
    }

    /// The smallest box that holds both.
    #[inline]
    pub fn union(&self, o: &Aabb) -> Aabb {
        Aabb { min: self.min.min(o.min), max: self.max.max(o.max) }
    }

    /// Whether the boxes meet; touching counts.
    #[inline]
    pub fn meets(&self, o: &Aabb) -> bool {
        self.min.x <= o.max.x
            && o.min.x <= self.max.x
            && self.min.y <= o.max.y
            && o.min.y <= self.max.y
            && self.min.z <= o.max.z
            && o.min.z <= self.max.z
    }

    /// Whether the box holds nothing.
    pub fn is_empty(&self) -> bool {
        self.min.x > self.max.x || self.min.y > self.max.y || self.min.z > self.max.z
    }
}

/// Bounds of a boundary.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundaryBounds {
    /// bounding sphere, radius infinite for half-spaces and planes; for a limit quadrangle that of its four points
    pub ball: Ball,
    /// bounding box of the face itself; [`Aabb::EVERYWHERE`] for half-spaces and planes
    pub face: Aabb,
    /// unit normal into the allowed side and its offset: what lies at `normal . x < offset` is behind. `None` for a
    /// two-sided plane or a bounded shape
    pub behind: Option<(Vec3, Real)>,
}

impl BoundaryBounds {
    /// Whether the boundary's pair routine must be asked about a body with this bounding sphere: the sphere of the face is
    /// met (the thesis's test), or the body reaches behind the face, wherever that is. Inside a convex set of limits the
    /// second says nothing new, so the counts stay the thesis's; outside it catches what has crossed.
    #[inline]
    pub fn reaches(&self, body: &Ball) -> bool {
        if body.is_empty() {
            return false;
        }
        if self.ball.radius == Real::INFINITY || self.ball.meets(body) {
            return true;
        }
        self.reaches_behind(body)
    }

    /// Whether the body reaches behind the face, or may do so as far as rounding can tell: pair routines compute the same
    /// distance in another order, and every broad phase must ask about every contact they can find.
    #[inline]
    pub fn reaches_behind(&self, body: &Ball) -> bool {
        match self.behind {
            Some((normal, offset)) => normal.dot(body.center) - offset <= body.radius + rounding_of(body, offset),
            None => false,
        }
    }
}

/// What rounding can do to the distance of a ball's centre from a plane with this offset.
#[inline]
pub(crate) fn rounding_of(body: &Ball, offset: Real) -> Real {
    16.0 * Real::EPSILON * (body.center.max_abs() + offset.abs() + body.radius)
}

/// Bounding spheres of all bodies, rotation matrices of those that are no spheres, boxes where the broad phase wants them.
/// Returns the largest speed of any body as a multiple of its own radius, squared \[1/s2\]. What the motion has done on its way is
/// not done again.
pub fn place(model: &Model, state: &State, work: &mut Work) -> Real {
    let fastest = match work.placed.take() {
        Some(fastest) => {
            work.rotations.clear();
            fastest
        }
        None => place_balls(model, state, work),
    };
    let lines = &state.lines;
    let wants_boxes = work.broad.as_ref().is_some_and(|b| b.wants_boxes());
    work.boxes.resize(if wants_boxes { lines.len() } else { 0 }, Aabb::EMPTY);
    let rotations = &work.rotations;
    par::for_each_block(&mut work.boxes, |first, boxes| {
        for (i, bounding_box) in boxes.iter_mut().enumerate() {
            let slot = first + i;
            let rotation = rotations.get(slot).unwrap_or(&Mat3::IDENTITY);
            *bounding_box = model.body(slot).shape.bounding_box(lines[slot].x, rotation);
        }
    });
    fastest
}

/// Bounding spheres and rotation matrices.
fn place_balls(model: &Model, state: &State, work: &mut Work) -> Real {
    let (lines, fastest) = (&state.lines, Fastest::default());
    work.balls.resize(lines.len(), Ball::EMPTY);
    if model.all_spheres {
        work.rotations.clear();
        par::for_each_block(&mut work.balls, |first, balls| {
            let mut largest = 0.0;
            for (ball, line) in balls.iter_mut().zip(&lines[first..]) {
                *ball = Ball { center: line.x, radius: line.radius };
                largest = faster(largest, line);
            }
            fastest.note(largest);
        });
    } else {
        work.rotations.resize(lines.len(), Mat3::IDENTITY);
        par::for_each_block2(&mut work.balls, &mut work.rotations, |first, balls, rotations| {
            fastest.note(lines[first..first + balls.len()].iter().fold(0.0, faster));
            for (i, (ball, rotation)) in balls.iter_mut().zip(rotations).enumerate() {
                place_one(model, state, first + i, ball, rotation);
            }
        });
    }
    fastest.get()
}

/// The largest of some numbers that are not negative, found by any number of threads: the bits of such numbers are in order as
/// the numbers are.
#[derive(Default)]
pub(crate) struct Fastest(AtomicU64);

impl Fastest {
    pub fn note(&self, largest: Real) {
        self.0.fetch_max(largest.to_bits(), Ordering::Relaxed);
    }

    pub fn get(self) -> Real {
        Real::from_bits(self.0.into_inner())
    }
}

/// The larger of this and the square of the body's speed over its radius \[1/s2\].
#[inline(always)]
pub(crate) fn faster(largest: Real, line: &Line) -> Real {
    let (v2, r2) = (line.v.length_squared(), line.radius * line.radius);
    if v2 > largest * r2 { v2 / r2 } else { largest }
}

fn place_one(model: &Model, state: &State, slot: usize, ball: &mut Ball, rotation: &mut Mat3) {
    let (body, line) = (model.body(slot), &state.lines[slot]);
    if line.radius < 0.0 {
        *ball = Ball::EMPTY;
    } else if body.is_plain_sphere() {
        *ball = Ball { center: line.x, radius: line.radius };
    } else {
        *rotation = state.spins[slot].q.to_matrix();
        *ball = placed_ball(&body.ball, line.x, rotation);
    }
}

/// Bounding sphere of a placed shape.
#[inline]
pub fn placed_ball(local: &Ball, position: Vec3, rotation: &Mat3) -> Ball {
    Ball { center: position + *rotation * local.center, radius: local.radius }
}
