//! Sphere against quadrangle.

use super::sphere_polyhedron::{nearest_on_polygon, push_sphere_contact};
use super::sphere_sphere;
use crate::narrow::sat::FLAT;
use crate::narrow::{Placed, Touches};
use crate::shape::{Quadrangle, Sphere};

/// Reports the contact of a sphere (first) with a thin two-sided quadrangle, at the point nearest to the sphere's centre. A
/// centre exactly in the quadrangle counts as in front of it, on the side of its normal; one exactly on its rim as outside.
///
/// A body that is not a [`Sphere`] is taken as its bounding sphere.
pub fn touch(a: &Placed<'_>, b: &Placed<'_>, out: &mut Touches) {
    let Some(q) = b.shape.downcast::<Quadrangle>() else { return sphere_sphere::touch(a, b, out) };
    let (center, radius) = match a.shape.downcast::<Sphere>() {
        Some(s) => (a.position, s.radius()),
        None => (a.ball.center, a.ball.radius),
    };
    // An unbounded body has no sphere to be taken for.
    if !radius.is_finite() {
        return;
    }
    let c = b.rotation.transpose_mul(center - b.position);
    let height = q.normal.dot(c - q.corners[0]);
    let reaches = height.abs() <= radius && radius.is_finite();
    if !reaches {
        return;
    }
    let nearest = nearest_on_polygon(4, |i| q.corners[i], (q.normal, height), c);
    let (distance, outward, feature) = match nearest.on {
        None if height < 0.0 => (-height, -q.normal, 0),
        None => (height, q.normal, 0),
        Some((i, j)) => {
            if nearest.distance_squared > radius * radius {
                return;
            }
            let distance = nearest.distance_squared.sqrt();
            // On the rim itself the direction to the centre is rounding: straight away from the middle instead.
            let away = if distance > FLAT * (radius + q.ball.radius) { c - nearest.point } else { nearest.point };
            let feature = 1 + 4 * i.min(j) + i.max(j);
            (distance, away.try_normalize().unwrap_or(q.normal), feature as u32)
        }
    };
    let outward = *b.rotation * outward;
    push_sphere_contact(out, (center, radius), -(outward / outward.length()), radius - distance, feature);
}
