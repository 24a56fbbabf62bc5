//! Polyhedron against half-space or limit quadrangle.

use super::half_space_sphere::{bounding_spheres, normal_of};
use crate::math::{Real, Vec3, max};
use crate::narrow::clip::{clean, order_round, perimeter_centroid};
use crate::narrow::sat::FLAT;
use crate::narrow::{Placed, Touch, Touches};
use crate::shape::Polyhedron;

/// Reports the contact of a polyhedron (first) with a half-space or a limit quadrangle, which acts as the half-space behind
/// it; the normal leads into the wall. See `corners_against_wall`.
pub fn touch(a: &Placed<'_>, b: &Placed<'_>, out: &mut Touches) {
    match (a.shape.downcast::<Polyhedron>(), normal_of(b)) {
        (Some(p), Some(normal)) => corners_against_wall(a, &p.corners, (b.position, normal), out),
        _ => bounding_spheres(a, b, out),
    }
}

/// The contact of a body with these corners and a wall, given by a point on it and its normal into the allowed side.
///
/// The deepest corners carry the contact, all of them: those within [`FLAT`] of the body's radius of the deepest. The point
/// is the centroid of the edges of their convex hull, so that a flat landing gives no spin however the body's surface or
/// its inside is cut up. The manifold lists every corner at or below the wall.
///
/// A body whose centre of mass is behind the wall is pushed through its centre of mass: which of its corners is deepest
/// says nothing any more about how it came there, and no spin is worth inventing for it.
pub(super) fn corners_against_wall(a: &Placed<'_>, corners: &[Vec3], wall: (Vec3, Vec3), out: &mut Touches) {
    let (on_wall, normal) = wall;
    let height = normal.dot(a.position - on_wall);
    let down = a.rotation.transpose_mul(normal);
    let lowest = corners.iter().fold(Real::INFINITY, |m, c| crate::math::min(m, down.dot(*c)));
    let depth = -(height + lowest);
    let touches = depth >= 0.0;
    if !touches {
        return;
    }
    let tied = lowest + FLAT * a.ball.radius;
    let at_wall = max(tied, -height);
    let first_point = out.points.len();
    let area = &mut out.scratch.corners;
    area.clear();
    let mut feature = u32::MAX;
    for (i, &c) in corners.iter().enumerate() {
        let h = down.dot(c);
        if h <= tied {
            area.push(*a.rotation * c);
            feature = feature.min(i as u32);
        }
        if h <= at_wall {
            out.points.push(a.position + *a.rotation * c);
        }
    }
    let point = if height < 0.0 {
        a.position
    } else {
        if area.len() > 3 {
            order_round(area, normal, FLAT * a.ball.radius, &mut out.scratch.order);
            clean(area, FLAT * a.ball.radius);
        }
        a.position + perimeter_centroid(area)
    };
    let point_count = (out.points.len() - first_point) as u32;
    out.list.push(Touch { normal: -normal, point, depth, feature, first_point: first_point as u32, point_count });
}
