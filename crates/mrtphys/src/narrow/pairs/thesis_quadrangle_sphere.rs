//! A quadrangle and the bounding sphere of anything, as in the thesis (section 6.6.3).

use super::closest::{is_round_off, on_triangle};
use super::thesis_sphere_sphere;
use crate::math::max;
use crate::narrow::{Placed, Touches};
use crate::shape::Quadrangle;

/// First the quadrangle, then the sphere. Like a polyhedron's, but a quadrangle has no inside: the normal points to the side
/// on which the sphere's centre is, or along the quadrangle's normal where the centre is on it.
pub fn touch(body: &Placed<'_>, sphere: &Placed<'_>, out: &mut Touches) {
    let Some(quad) = body.shape.downcast::<Quadrangle>() else {
        return thesis_sphere_sphere::touch(body, sphere, out);
    };
    let r = sphere.ball.radius;
    if r < 0.0 || !r.is_finite() {
        return;
    }
    let center = body.rotation.transpose_mul(sphere.ball.center - body.position);
    // Plane and convex: two triangles.
    let [a, b, c, d] = quad.corners;
    let (p, q) = (on_triangle(center, [a, b, c]), on_triangle(center, [a, c, d]));
    let nearest = if (q - center).length_squared() < (p - center).length_squared() { q } else { p };
    let gap = center - nearest;
    let distance = gap.length();
    if distance > r || distance.is_nan() {
        return;
    }
    let on_it = is_round_off(distance, quad.ball.radius + center.length());
    let away = if !on_it {
        gap
    } else if gap.dot(quad.normal) < 0.0 {
        -quad.normal
    } else {
        quad.normal
    };
    let Some(away) = away.try_normalize() else { return };
    let normal = *body.rotation * away;
    let on_quad = body.position + *body.rotation * nearest;
    let on_sphere = sphere.ball.center - normal * r;
    out.push(normal, (on_quad + on_sphere) * 0.5, max(r - distance, 0.0), 0, &[on_quad, on_sphere]);
}
