//! The pair table.
/// The resolved table.
#[derive(Clone, Debug)]
pub struct PairTable {}

/// e
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// r
    pub routine: super::Routine,
    /// s
    pub swapped: bool,
    /// n
    pub name: &'static str,
}
impl PairTable {
    /// l
    pub fn lookup(&self, _a: super::kinds::KindId, _b: super::kinds::KindId) -> Entry {
        unimplemented!()
    }
}
