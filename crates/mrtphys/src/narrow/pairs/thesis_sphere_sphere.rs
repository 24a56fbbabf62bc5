//! The thesis's generic routine (section 6.3.6): two bodies as their bounding spheres, two contact points.

use super::sphere_sphere::meet;
use crate::narrow::{Placed, Touches};

/// One contact. The thesis lets the impact act at P1 on the first body and at P2 on the second; where they overlap and there
/// is friction, that changes the angular momentum by (P1 - P2) x dp. So the two points are reported as the manifold, and the
/// impact acts at their midpoint on both.
pub fn touch(a: &Placed<'_>, b: &Placed<'_>, out: &mut Touches) {
    if let Some(m) = meet(&a.ball, &b.ball) {
        out.push(m.normal, (m.p1 + m.p2) * 0.5, m.depth, 0, &[m.p1, m.p2]);
    }
}
