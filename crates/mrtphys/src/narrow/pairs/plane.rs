//! The two-sided plane (thesis, section 6.7.1). Towards each partner it is the half-space of the side on which that partner is
//! at home: what has crossed it is behind, and is let back. The side is remembered (see
//! [`LetBack`](crate::contact::let_back::LetBack)), not reconstructed from the previous position as in the thesis: c - v dt is
//! wrong as soon as v changed in the step.

use super::{
    half_space_sphere, polyhedron_half_space, quadrangle_half_space, sphere_sphere, thesis_polyhedron_half_space,
    thesis_quadrangle_half_space,
};
use crate::narrow::{Placed, Touches};
use crate::shape::{HalfSpace, LimitPlane};

/// The half-space that the plane is towards this partner. A partner whose side is not known is at home where its centre is;
/// exactly on the plane: on the side of the normal.
fn towards(plane: &Placed<'_>, partner: &Placed<'_>) -> Option<HalfSpace> {
    let normal = plane.shape.downcast::<LimitPlane>()?.normal;
    let above = (partner.ball.center - plane.position).dot(*plane.rotation * normal) >= 0.0;
    let positive = if plane.home_side == 0.0 { above } else { plane.home_side > 0.0 };
    Some(HalfSpace { normal: if positive { normal } else { -normal } })
}

/// First the plane, then the sphere, or whatever is taken as its bounding sphere.
pub fn sphere(plane: &Placed<'_>, body: &Placed<'_>, out: &mut Touches) {
    match towards(plane, body) {
        Some(wall) => half_space_sphere::touch(&Placed { shape: &wall, ..*plane }, body, out),
        None => sphere_sphere::touch(plane, body, out),
    }
}

/// Declares the routine of a body and a plane, made from that of the body and a half-space.
macro_rules! body_and_plane {
    ($(#[$doc:meta])* $name:ident, $half_space:path) => {
        $(#[$doc])*
        pub fn $name(body: &Placed<'_>, plane: &Placed<'_>, out: &mut Touches) {
            match towards(plane, body) {
                Some(wall) => $half_space(body, &Placed { shape: &wall, ..*plane }, out),
                None => sphere_sphere::touch(body, plane, out),
            }
        }
    };
}

body_and_plane! {
    /// First the polyhedron, then the plane: its deepest corners.
    polyhedron, polyhedron_half_space::touch
}
body_and_plane! {
    /// First the quadrangle, then the plane: its deepest corners.
    quadrangle, quadrangle_half_space::touch
}
body_and_plane! {
    /// First the polyhedron, then the plane: the thesis's deepest corner.
    thesis_polyhedron, thesis_polyhedron_half_space::touch
}
body_and_plane! {
    /// First the quadrangle, then the plane: the thesis's deepest corner.
    thesis_quadrangle, thesis_quadrangle_half_space::touch
}
