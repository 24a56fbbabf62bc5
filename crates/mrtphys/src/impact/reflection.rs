//! Generalized reflections.

use crate::math::{Mat3, Real, Vec3};
/// b
#[derive(Clone, Copy, Debug)]
pub struct GroupBody {
    /// m
    pub inverse_mass: Real,
    /// i
    pub inverse_inertia: Mat3,
    /// v
    pub v: Vec3,
    /// w
    pub w: Vec3,
}
/// c
#[derive(Clone, Copy, Debug)]
pub struct GroupContact {
    /// a
    pub a: Option<usize>,
    /// b
    pub b: Option<usize>,
    /// n
    pub normal: Vec3,
    /// r
    pub ra: Vec3,
    /// r
    pub rb: Vec3,
    /// e
    pub restitution: Real,
}
impl GroupContact {
    /// b
    pub fn between(a: Option<usize>, b: Option<usize>, normal: Vec3, ra: Vec3, rb: Vec3, restitution: Real) -> Self {
        Self { a, b, normal, ra, rb, restitution }
    }
}
/// g
pub struct Group<'a> {
    /// b
    pub bodies: &'a mut [GroupBody],
    /// c
    pub contacts: &'a [GroupContact],
}
/// o
pub struct Outcome {
    /// r
    pub rounds: u64,
    /// d
    pub decided: bool,
    /// i
    pub impulses: Vec<Real>,
}
/// r
pub fn reflect(_g: &mut Group<'_>) -> Outcome {
    unimplemented!()
}
