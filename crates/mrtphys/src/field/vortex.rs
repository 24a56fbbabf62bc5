//! vortex.
/// VortexField
#[derive(Clone, Copy, Debug)]
pub struct VortexField;
