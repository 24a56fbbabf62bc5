//! The inventory of kinds.
/// Number of a kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct KindId(pub(crate) u16);
/// The kinds there are, with the pair routines declared for them.
#[derive(Clone, Debug)]
pub struct Kinds {}

impl Kinds {
    /// s
    pub fn standard(_m: crate::def::ContactMode) -> Kinds {
        Kinds {}
    }
    /// i
    pub fn id(&self, _n: &str) -> Option<KindId> {
        Some(KindId(0))
    }
    /// n
    pub fn name(&self, _k: KindId) -> &str {
        "x"
    }
    /// r
    pub fn resolve(&self) -> super::pair_table::PairTable {
        unimplemented!()
    }
}
