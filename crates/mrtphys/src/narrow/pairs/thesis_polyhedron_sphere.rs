//! A polyhedron and the bounding sphere of anything, as in the thesis (section 6.6.2, Fig. 13).

use super::closest::{holds, is_round_off, on_polyhedron};
use super::thesis_sphere_sphere;
use crate::math::max;
use crate::narrow::{Placed, Touches};
use crate::shape::Polyhedron;

/// First the polyhedron, then the sphere. P2 is the point of the polyhedron's surface closest to the sphere's centre, the
/// normal is given by the sphere, and P1 is P2 projected along it onto the sphere. With the centre inside (left open in the
/// thesis) the normal is flipped, so that the sphere leaves by the shortest way. The impact acts half-way between P1 and P2.
pub fn touch(body: &Placed<'_>, sphere: &Placed<'_>, out: &mut Touches) {
    let Some(poly) = body.shape.downcast::<Polyhedron>() else {
        return thesis_sphere_sphere::touch(body, sphere, out);
    };
    let r = sphere.ball.radius;
    let center = body.rotation.transpose_mul(sphere.ball.center - body.position);
    let Some(nearest) = on_polyhedron(poly, center).filter(|_| r >= 0.0 && r.is_finite()) else { return };
    let gap = center - nearest.point;
    let inside = holds(poly, center);
    let distance = if inside { -gap.length() } else { gap.length() };
    if distance > r || distance.is_nan() {
        return;
    }
    // A centre on the surface has no direction from its closest point: the surface's own normal there.
    let outward = match distance {
        d if is_round_off(d.abs(), poly.ball.radius + center.length()) => nearest.outward,
        d if d < 0.0 => -gap,
        _ => gap,
    };
    let Some(outward) = outward.try_normalize() else { return };
    let normal = *body.rotation * outward;
    let on_poly = body.position + *body.rotation * nearest.point;
    let on_sphere = sphere.ball.center - normal * r;
    let point = (on_poly + on_sphere) * 0.5;
    out.push(normal, point, max(r - distance, 0.0), nearest.feature, &[on_poly, on_sphere]);
}
