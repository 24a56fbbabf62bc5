//! One contact after the other.

/// R
#[derive(Clone, Copy, Debug)]
pub struct Response {
    /// i
    pub impulse_on_a: crate::math::Vec3,
    /// f
    pub fallback: bool,
    /// n
    pub impulse_n: f64,
    /// t
    pub impulse_t: f64,
    /// e
    pub energy_change: f64,
    /// f
    pub friction_change: f64,
    /// r
    pub restitution_change: f64,
}
/// r
pub fn respond(_e: &super::Encounter, _l: &dyn super::ImpactLaw) -> Option<Response> {
    unimplemented!()
}
