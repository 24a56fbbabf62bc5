//! What the thesis's two space subdivisions have in common: which objects can be listed in cells, how large the scene is,
//! and the pairs that no cell can answer for.

use super::{BoundsView, Candidates};
use crate::bounds::{Aabb, Ball, BoundaryBounds, rounding_of};
use crate::math::{ROUNDING, Real, Vec3, max};

/// The objects of a step, sorted by how they must be treated. Objects are numbered: bodies by slot, then the listed faces.
#[derive(Clone, Debug, Default)]
pub(super) struct Scene {
    /// number of body slots: object `bodies + k` is the boundary `faces[k]`
    pub bodies: u32,
    /// boundaries whose face has a finite box
    pub faces: Vec<u32>,
    /// box round the listed bodies and faces; empty where there are none
    pub extent: Extent,
    /// boundaries that reach to infinity: every body is compared with them
    unbounded: Vec<u32>,
    /// bodies without a finite box: they are compared with everything
    boundless: Vec<u32>,
    fence: Fence,
}

/// The box of the scene, and how far to the upper side boxes must be drawn out so that cells agree with spheres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Extent {
    pub bounds: Aabb,
    pub reach: Real,
}

impl Default for Extent {
    fn default() -> Extent {
        Extent { bounds: Aabb::EMPTY, reach: 0.0 }
    }
}

impl Extent {
    /// Adds the rounding margin. Two spheres that touch may pass [`Ball::meets`] while their rounded boxes miss each other:
    /// the test errs by at most 6 roundings of the sum of the radii, a corner by one rounding of itself, and neither
    /// exceeds twice the largest coordinate of the scene. Only upper sides are drawn out (that suffices for a pair, one
    /// of the two is below the other), so that a box that ends exactly on a cell's border is listed as in the thesis.
    fn settle(&mut self) {
        let b = &self.bounds;
        let largest = if b.is_empty() { 0.0 } else { max(b.min.max_abs(), b.max.max_abs()) };
        self.reach = 32.0 * ROUNDING * largest;
    }
}

/// The free region in front of all listed one-sided faces. A body inside has crossed nothing: one look at six numbers
/// instead of one at every face.
#[derive(Clone, Debug)]
struct Fence {
    /// largest offset of the faces that look along +x, +y, +z
    low: Vec3,
    /// the same along -x, -y, -z
    high: Vec3,
    /// some face looks in another direction: every body must ask each face
    oblique: bool,
}

impl Default for Fence {
    fn default() -> Fence {
        Fence { low: Vec3::splat(Real::NEG_INFINITY), high: Vec3::splat(Real::NEG_INFINITY), oblique: false }
    }
}

impl Fence {
    fn add(&mut self, normal: Vec3, offset: Real) {
        for axis in 0..3 {
            let mut unit = Vec3::ZERO;
            unit[axis] = 1.0;
            if normal == unit {
                self.low[axis] = max(self.low[axis], offset);
                return;
            }
            if normal == -unit {
                self.high[axis] = max(self.high[axis], offset);
                return;
            }
        }
        self.oblique = true;
    }

    /// Whether the body may reach behind some face. For an axis-parallel normal this is the very expression of
    /// [`BoundaryBounds::reaches_behind`], since products with 0 and 1 are exact.
    fn may_be_crossed(&self, body: &Ball) -> bool {
        let near =
            |distance: Real, offset: Real| offset.is_finite() && distance <= body.radius + rounding_of(body, offset);
        let crosses = |k: usize| {
            near(body.center[k] - self.low[k], self.low[k]) || near(-body.center[k] - self.high[k], self.high[k])
        };
        self.oblique || (0..3).any(crosses)
    }
}

/// Whether a box can be listed in cells.
fn is_bounded(b: &Aabb) -> bool {
    b.min.is_finite() && b.max.is_finite() && !b.is_empty()
}

/// Box of a body.
#[inline]
pub(super) fn body_box(view: &BoundsView<'_>, slot: usize) -> Aabb {
    view.boxes.get(slot).copied().unwrap_or_else(|| Aabb::of_ball(&view.balls[slot]))
}

/// The boundary's face can be listed in cells, and a body that neither meets its box nor reaches behind is not concerned.
fn is_listed_face(b: &BoundaryBounds) -> bool {
    b.ball.radius < Real::INFINITY && is_bounded(&b.face)
}

impl Scene {
    /// Looks at everything once.
    pub fn survey(&mut self, view: &BoundsView<'_>) {
        self.faces.clear();
        self.unbounded.clear();
        self.boundless.clear();
        self.fence = Fence::default();
        self.bodies = view.balls.len() as u32;
        self.extent = Extent::default();
        for (k, b) in view.boundaries.iter().enumerate() {
            if !is_listed_face(b) {
                self.unbounded.push(k as u32);
                continue;
            }
            self.faces.push(k as u32);
            self.extent.bounds = self.extent.bounds.union(&b.face);
            if let Some((normal, offset)) = b.behind {
                self.fence.add(normal, offset);
            }
        }
        for (slot, ball) in view.balls.iter().enumerate() {
            if ball.is_empty() {
                continue;
            }
            let b = body_box(view, slot);
            if is_bounded(&b) {
                self.extent.bounds = self.extent.bounds.union(&b);
            } else {
                self.boundless.push(slot as u32);
            }
        }
        self.extent.settle();
    }

    /// Number of object numbers, whether listed or not.
    pub fn objects(&self) -> usize {
        self.bodies as usize + self.faces.len()
    }

    /// The object's box, its upper side drawn out by `reach` (at least the extent's); `None`: it is not listed in cells.
    #[inline]
    pub fn listed_box(&self, view: &BoundsView<'_>, object: usize, reach: Real) -> Option<Aabb> {
        let mut b = match object.checked_sub(self.bodies as usize) {
            Some(k) => view.boundaries[self.faces[k] as usize].face,
            None if view.balls[object].is_empty() => return None,
            None => body_box(view, object),
        };
        if !is_bounded(&b) {
            return None;
        }
        b.max += Vec3::splat(reach);
        Some(b)
    }

    /// Whether the object never moves.
    #[inline]
    pub fn is_immovable(&self, view: &BoundsView<'_>, object: u32) -> bool {
        object >= self.bodies || view.is_fixed(object)
    }

    /// The bounding-sphere test of two listed objects, not both immovable.
    #[inline]
    pub fn test(&self, view: &BoundsView<'_>, a: u32, b: u32, out: &mut Candidates) {
        out.sphere_tests += 1;
        let (a, b) = if a < b { (a, b) } else { (b, a) };
        let ball = &view.balls[a as usize];
        if b < self.bodies {
            if ball.meets(&view.balls[b as usize]) {
                out.pairs.push([a, b]);
            }
        } else {
            let k = self.faces[(b - self.bodies) as usize];
            if view.boundaries[k as usize].reaches(ball) {
                out.walls.push([a, k]);
            }
        }
    }

    /// The pairs that no cell can answer for: whatever has no finite box, with everything; and every body that reaches
    /// behind a face, wherever that is. `walls_before`: number of walls in `out` when this step's search began.
    pub fn finish(&self, view: &BoundsView<'_>, walls_before: usize, out: &mut Candidates) {
        for (k, &a) in self.boundless.iter().enumerate() {
            for b in 0..self.objects() as u32 {
                let done = a == b || self.boundless[..k].binary_search(&b).is_ok();
                let empty = b < self.bodies && view.balls[b as usize].is_empty();
                let immovable = self.is_immovable(view, a) && self.is_immovable(view, b);
                if !(done || empty || immovable) {
                    self.test(view, a, b, out);
                }
            }
        }
        let movable = |slot: &usize| !view.is_fixed(*slot as u32) && !view.balls[*slot].is_empty();
        for &k in &self.unbounded {
            let boundary = &view.boundaries[k as usize];
            for slot in (0..view.balls.len()).filter(movable) {
                out.sphere_tests += 1;
                if boundary.reaches(&view.balls[slot]) {
                    out.walls.push([slot as u32, k]);
                }
            }
        }
        self.crossed(view, walls_before, out);
    }

    /// Adds the bodies that reach behind a face without having been compared with it. Those that were compared are among
    /// the walls already, since reaching behind is reaching: sorting brings the two together.
    fn crossed(&self, view: &BoundsView<'_>, walls_before: usize, out: &mut Candidates) {
        let known = out.walls.len();
        for (slot, ball) in view.balls.iter().enumerate() {
            if ball.is_empty() || !self.fence.may_be_crossed(ball) || view.is_fixed(slot as u32) {
                continue;
            }
            for &k in &self.faces {
                if view.boundaries[k as usize].reaches_behind(ball) {
                    out.walls.push([slot as u32, k]);
                }
            }
        }
        if out.walls.len() == known {
            return;
        }
        let mut walls = out.walls.split_off(walls_before);
        walls.sort_unstable();
        walls.dedup();
        out.walls.append(&mut walls);
        out.sphere_tests += (out.walls.len() - known) as u64;
    }
}
