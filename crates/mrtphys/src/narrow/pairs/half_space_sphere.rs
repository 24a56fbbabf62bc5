//! A half-space and a sphere, or whatever is taken as its bounding sphere (thesis, section 6.7.2). Exact for spheres.

use super::sphere_sphere;
use crate::math::Vec3;
use crate::narrow::{Placed, Touches};
use crate::shape::{HalfSpace, LimitQuadrangle};

/// Unit normal of a placed half-space into the allowed side, world axes; `None` for a shape that is none.
pub(crate) fn normal_of(wall: &Placed<'_>) -> Option<Vec3> {
    let local = match wall.shape.downcast::<HalfSpace>() {
        Some(h) => h.normal,
        None => wall.shape.downcast::<LimitQuadrangle>()?.normal,
    };
    Some(*wall.rotation * local)
}

/// What answers a pair of which a routine does not know one type: bounding spheres, or the half-space (second) and the
/// bounding sphere of the body (first).
pub(super) fn bounding_spheres(a: &Placed<'_>, b: &Placed<'_>, out: &mut Touches) {
    if normal_of(b).is_none() {
        return sphere_sphere::touch(a, b, out);
    }
    let first = out.list.len();
    touch(b, a, out);
    out.flip_from(first);
}

/// First the half-space, then the sphere. With D = C - P the sphere is free if D.N > r; touching is contact, and so is being
/// behind, however far. The contact point is the deepest point of the sphere, C - r N.
pub fn touch(wall: &Placed<'_>, body: &Placed<'_>, out: &mut Touches) {
    let Some(normal) = normal_of(wall) else {
        return sphere_sphere::touch(wall, body, out);
    };
    let r = body.ball.radius;
    let d = (body.ball.center - wall.position).dot(normal);
    if d <= r && r >= 0.0 && r.is_finite() {
        let point = body.ball.center - normal * r;
        out.push(normal, point, r - d, 0, &[point]);
    }
}
