//! Polyhedron against polyhedron: true normal of least depth, contact area by clipping.

use super::sphere_sphere;
use crate::narrow::convex_contact::{Pieces, touch_pieces};
use crate::narrow::{Placed, Touches};
use crate::shape::Polyhedron;

/// Reports the contacts of two polyhedra, one for each pair of convex pieces that overlap; equal ones are merged. A body
/// inside the other is pushed out by the shortest way; of two bodies in identical poses the first face decides.
pub fn touch(a: &Placed<'_>, b: &Placed<'_>, out: &mut Touches) {
    let (Some(pa), Some(pb)) = (a.shape.downcast::<Polyhedron>(), b.shape.downcast::<Polyhedron>()) else {
        return sphere_sphere::touch(a, b, out);
    };
    touch_pieces((a, Pieces::Of(&pa.pieces)), (b, Pieces::Of(&pb.pieces)), out);
}
