//! Quadrangle against half-space or limit quadrangle.

use super::half_space_sphere::{bounding_spheres, normal_of};
use super::polyhedron_half_space::corners_against_wall;
use crate::narrow::{Placed, Touches};
use crate::shape::Quadrangle;

/// Reports the contact of a quadrangle (first) with a half-space or a limit quadrangle, by the same rule as for polyhedra:
/// the deepest corners carry it, and a body whose centre is behind the wall is pushed through its centre of mass.
pub fn touch(a: &Placed<'_>, b: &Placed<'_>, out: &mut Touches) {
    match (a.shape.downcast::<Quadrangle>(), normal_of(b)) {
        (Some(q), Some(normal)) => corners_against_wall(a, &q.corners, (b.position, normal), out),
        _ => bounding_spheres(a, b, out),
    }
}
