//! Polyhedron against quadrangle: as two polyhedra, the quadrangle being a flat one with two sides.

use super::sphere_sphere;
use crate::narrow::convex_contact::{Pieces, touch_pieces};
use crate::narrow::{Placed, Touches};
use crate::shape::{Polyhedron, Quadrangle};

/// Reports the contacts of a polyhedron with a thin two-sided quadrangle, one for each convex piece that it meets.
pub fn touch(a: &Placed<'_>, b: &Placed<'_>, out: &mut Touches) {
    let (Some(p), Some(q)) = (a.shape.downcast::<Polyhedron>(), b.shape.downcast::<Quadrangle>()) else {
        return sphere_sphere::touch(a, b, out);
    };
    touch_pieces((a, Pieces::Of(&p.pieces)), (b, Pieces::Flat(q)), out);
}
