//! Quadrangle against quadrangle: as two flat polyhedra with two sides each.

use super::sphere_sphere;
use crate::narrow::convex_contact::{Pieces, touch_pieces};
use crate::narrow::{Placed, Touches};
use crate::shape::Quadrangle;

/// Reports the contact of two thin two-sided quadrangles. Two that lie in one plane meet at their rims, with a normal in
/// that plane.
pub fn touch(a: &Placed<'_>, b: &Placed<'_>, out: &mut Touches) {
    let (Some(p), Some(q)) = (a.shape.downcast::<Quadrangle>(), b.shape.downcast::<Quadrangle>()) else {
        return sphere_sphere::touch(a, b, out);
    };
    touch_pieces((a, Pieces::Flat(p)), (b, Pieces::Flat(q)), out);
}
