//! point.
/// PointField
#[derive(Clone, Copy, Debug)]
pub struct PointField;
