//! A polyhedron and a half-space as in the thesis (section 6.7.2): the contact point is a corner.

use super::half_space_sphere::{bounding_spheres, normal_of};
use crate::math::{Real, Vec3};
use crate::narrow::{Placed, Touches};
use crate::shape::Polyhedron;

/// First the polyhedron, then the half-space. The thesis leaves open which corner: the deepest one, and of several equally
/// deep ones the first.
pub fn touch(body: &Placed<'_>, wall: &Placed<'_>, out: &mut Touches) {
    match body.shape.downcast::<Polyhedron>() {
        Some(p) => deepest_corner(&p.corners, body, wall, out),
        None => bounding_spheres(body, wall, out),
    }
}

/// Reports the deepest of the corners, if it is not in front of the half-space.
pub(super) fn deepest_corner(corners: &[Vec3], body: &Placed<'_>, wall: &Placed<'_>, out: &mut Touches) {
    let Some(normal) = normal_of(wall) else {
        return bounding_spheres(body, wall, out);
    };
    // N.(x + R c - P) = N.(x - P) + (R^T N).c: one product per corner instead of a rotation.
    let offset = normal.dot(body.position - wall.position);
    let local_normal = body.rotation.transpose_mul(normal);
    let mut deepest: Option<(usize, Real)> = None;
    for (i, c) in corners.iter().enumerate() {
        let d = offset + local_normal.dot(*c);
        if deepest.is_none_or(|(_, least)| d < least) {
            deepest = Some((i, d));
        }
    }
    if let Some((i, d)) = deepest.filter(|&(_, d)| d <= 0.0) {
        let point = body.position + *body.rotation * corners[i];
        out.push(-normal, point, -d, i as u32, &[point]);
    }
}
