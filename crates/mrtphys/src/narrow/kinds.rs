//! The inventory of kinds.
/// Number of a kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct KindId(pub(crate) u16);
/// The kinds there are, with the pair routines declared for them.
#[derive(Clone, Debug)]
pub struct Kinds {}
