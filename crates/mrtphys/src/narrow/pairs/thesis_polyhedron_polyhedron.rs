//! Two polyhedra as in the thesis (section 6.6.2): all crossings of the edges of one with the faces of the other.

use super::closest::{holds, on_polyhedron};
use super::thesis_sphere_sphere;
use crate::bounds::Aabb;
use crate::math::{Mat3, Real, Vec3, max};
use crate::narrow::{Placed, Touches};
use crate::shape::Polyhedron;
use robust::{Coord3D, orient3d};

/// Below this length a difference of unit vectors has lost half of its digits, and a radius of this part of the body's size
/// has no direction worth the name. A number, not a length: nothing here depends on the scale of the scene.
const NO_DIRECTION: Real = 1.0 / (1u64 << 26) as Real;

/// One contact at P, the centre of the axis-parallel box round all crossings, which is common to both bodies. The normal is
/// perpendicular to the plane that halves the angle of the collision radii: N = (r1^ - r2^) / |r1^ - r2^|.
///
/// Sound where the thesis is not: one polyhedron wholly inside the other crosses nothing and is found all the same; a normal
/// that is not defined is replaced by the line of centres. The depth is how far the bodies overlap along the normal.
pub fn touch(a: &Placed<'_>, b: &Placed<'_>, out: &mut Touches) {
    let (Some(p1), Some(p2)) = (a.shape.downcast::<Polyhedron>(), b.shape.downcast::<Polyhedron>()) else {
        return thesis_sphere_sphere::touch(a, b, out);
    };
    let mut crossings = Aabb::EMPTY;
    collect(a, p1, b, p2, &mut crossings);
    collect(b, p2, a, p1, &mut crossings);
    let (point, normal) = if !crossings.is_empty() {
        let point = (crossings.min + crossings.max) * 0.5;
        (point, bisector_normal(a, b, point))
    } else if lies_in(a, p1, b, p2) {
        let Some((point, outward)) = exit(a, b, p2) else { return };
        (point, -outward)
    } else if lies_in(b, p2, a, p1) {
        let Some(found) = exit(b, a, p1) else { return };
        found
    } else {
        return;
    };
    let depth = reach(a, p1, normal) + reach(b, p2, -normal);
    out.push(normal, point, max(depth, 0.0), 0, &[point]);
}

/// Where the edges of the first polyhedron cross the faces of the second: the box round the crossings, world coordinates.
fn collect(a: &Placed<'_>, p1: &Polyhedron, b: &Placed<'_>, p2: &Polyhedron, crossings: &mut Aabb) {
    // The faces move into the axes of the edges: fewer rotations than the other way round, and no memory.
    let into: Mat3 = a.rotation.transpose() * *b.rotation;
    let shift = a.rotation.transpose_mul(b.position - a.position);
    let whole = Aabb::of_points(p1.corners.iter().copied());
    for t in &p2.triangles {
        let triangle = t.map(|i| into * p2.corners[i as usize] + shift);
        let bounds = Aabb::of_points(triangle);
        if !bounds.meets(&whole) {
            continue;
        }
        for e in &p1.edges {
            let [p, q] = e.ends.map(|i| p1.corners[i as usize]);
            let edge = Aabb { min: p.min(q), max: p.max(q) };
            if let Some(x) = edge.meets(&bounds).then(|| crossing(p, q, triangle)).flatten() {
                let x = a.position + *a.rotation * x;
                *crossings = crossings.union(&Aabb { min: x, max: x });
            }
        }
    }
}

/// Where a segment crosses a triangle; touching counts, lying in its plane doesn't. The signs are exact, so a segment that
/// passes through the common side of two triangles never slips between them.
fn crossing(p: Vec3, q: Vec3, [a, b, c]: [Vec3; 3]) -> Option<Vec3> {
    let side = |u: Vec3, v: Vec3, w: Vec3, x: Vec3| {
        let at = |v: Vec3| Coord3D { x: v.x, y: v.y, z: v.z };
        orient3d(at(u), at(v), at(w), at(x))
    };
    let (above, below) = (side(a, b, c, p), side(a, b, c, q));
    let apart = (above >= 0.0 && below <= 0.0) || (above <= 0.0 && below >= 0.0);
    if !apart || (above == 0.0 && below == 0.0) {
        return None;
    }
    let turns = [side(p, q, a, b), side(p, q, b, c), side(p, q, c, a)];
    let through = turns.iter().all(|&s| s >= 0.0) || turns.iter().all(|&s| s <= 0.0);
    through.then(|| p + (q - p) * (above / (above - below)))
}

/// The thesis's normal. A collision radius of no length has no direction and takes no part.
fn bisector_normal(a: &Placed<'_>, b: &Placed<'_>, point: Vec3) -> Vec3 {
    let direction = |body: &Placed<'_>| {
        let radius = point - body.position;
        let defined = radius.max_abs() > NO_DIRECTION * body.ball.radius;
        radius.try_normalize().filter(|_| defined).unwrap_or(Vec3::ZERO)
    };
    let bisector = direction(a) - direction(b);
    let centers = b.position - a.position;
    let chosen = if bisector.max_abs() > NO_DIRECTION { bisector } else { centers };
    chosen.try_normalize().unwrap_or(super::sphere_sphere::CONCENTRIC_NORMAL)
}

/// Whether the first polyhedron lies in the second, given that their surfaces do not cross: one corner tells for all.
fn lies_in(a: &Placed<'_>, p1: &Polyhedron, b: &Placed<'_>, p2: &Polyhedron) -> bool {
    p1.corners.first().is_some_and(|&c| {
        let world = a.position + *a.rotation * c;
        holds(p2, b.rotation.transpose_mul(world - b.position))
    })
}

/// By which way a polyhedron leaves the one that holds it: through the point of the outer surface closest to its centre.
/// Returns that point and the direction out there, the normal from the outer to the inner one. It leads straight through the
/// inner one's centre, so that it is not set spinning.
fn exit(inner: &Placed<'_>, outer: &Placed<'_>, surface: &Polyhedron) -> Option<(Vec3, Vec3)> {
    let center = outer.rotation.transpose_mul(inner.position - outer.position);
    let nearest = on_polyhedron(surface, center)?;
    let outward = if holds(surface, center) { nearest.point - center } else { center - nearest.point };
    let outward = outward.try_normalize().or_else(|| nearest.outward.try_normalize())?;
    Some((outer.position + *outer.rotation * nearest.point, *outer.rotation * outward))
}

/// Largest component of a polyhedron's corners along a direction \[m\].
fn reach(body: &Placed<'_>, poly: &Polyhedron, direction: Vec3) -> Real {
    let local = body.rotation.transpose_mul(direction);
    let most = poly.corners.iter().fold(Real::NEG_INFINITY, |m, c| max(m, local.dot(*c)));
    direction.dot(body.position) + most
}

#[cfg(test)]
mod tests {
    use super::*;

    const A: Vec3 = Vec3::new(0.1, 0.7, -0.3);
    const B: Vec3 = Vec3::new(1.3, -0.2, 0.9);

    /// Two triangles with the common side A B, and segments through points of that side: whatever round-off does to the
    /// points, no segment passes between the two.
    #[test]
    fn nothing_slips_between_two_triangles() {
        let (left, right) = (Vec3::new(-0.4, -0.9, 0.2), Vec3::new(1.9, 1.1, 0.35));
        for i in 1..2000 {
            let on_side = A + (B - A) * (i as Real / 2000.0);
            let (p, q) = (on_side + Vec3::new(0.3, -0.1, 0.77), on_side - Vec3::new(0.3, -0.1, 0.77));
            let found = [[A, B, left], [B, A, right]].map(|t| crossing(p, q, t));
            let x = found[0].or(found[1]).expect("through the common side");
            assert!((x - on_side).length() < 1e-15);
        }
    }

    #[test]
    fn touching_counts_and_lying_in_the_plane_does_not() {
        let t = [Vec3::ZERO, Vec3::X, Vec3::Y];
        let inside = Vec3::new(0.25, 0.25, 0.0);
        assert_eq!(crossing(inside, inside + Vec3::Z, t), Some(inside));
        assert_eq!(crossing(inside + Vec3::Z, inside, t), Some(inside));
        assert_eq!(crossing(Vec3::X, Vec3::new(1.0, 0.0, -1.0), t), Some(Vec3::X));
        assert_eq!(crossing(inside + Vec3::Z, inside + Vec3::Z * 0.5, t), None);
        assert_eq!(crossing(Vec3::new(2.0, 0.0, 1.0), Vec3::new(2.0, 0.0, -1.0), t), None);
        assert_eq!(crossing(Vec3::new(-1.0, 0.25, 0.0), Vec3::new(1.0, 0.25, 0.0), t), None);
        assert_eq!(crossing(Vec3::splat(Real::NAN), inside, t), None);
    }
}
