//! The pair table.
/// The resolved table.
#[derive(Clone, Debug)]
pub struct PairTable {}
