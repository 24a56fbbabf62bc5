//! gravity.
/// EarthGravity
#[derive(Clone, Copy, Debug)]
pub struct EarthGravity;
