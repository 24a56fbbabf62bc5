//! uniform.
/// UniformField
#[derive(Clone, Copy, Debug)]
pub struct UniformField;
