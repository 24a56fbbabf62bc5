//! A quadrangle and a half-space as in the thesis (section 6.7.2): the contact point is a corner.

use super::half_space_sphere::bounding_spheres;
use super::thesis_polyhedron_half_space::deepest_corner;
use crate::narrow::{Placed, Touches};
use crate::shape::Quadrangle;

/// First the quadrangle, then the half-space: the deepest corner, of several equally deep ones the first.
pub fn touch(body: &Placed<'_>, wall: &Placed<'_>, out: &mut Touches) {
    match body.shape.downcast::<Quadrangle>() {
        Some(q) => deepest_corner(&q.corners, body, wall, out),
        None => bounding_spheres(body, wall, out),
    }
}
