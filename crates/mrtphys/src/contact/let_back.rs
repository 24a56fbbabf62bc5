//! The let-back memory of two-sided planes.
/// Bodies that have crossed a two-sided plane.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LetBack {}
