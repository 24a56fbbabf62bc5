//! Which pairs were in contact in the last step.
/// Keys of the pairs that were in contact, ascending.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactMemory {
    /// keys of the pairs, ascending
    pub keys: Vec<u64>,
}
impl ContactMemory {
    /// Whether the pair was in contact in the last step.
    pub fn holds(&self, key: u64) -> bool {
        self.keys.binary_search(&key).is_ok()
    }
}
