//! Free rotation.
use crate::math::{Quat, Real, Vec3};
use crate::model::Inertia;
/// Orientation after free rotation for a time.
pub fn rotate_free(q: Quat, _l: Vec3, _inertia: &Inertia, _dt: Real) -> Quat {
    q
}
