//! tree
use super::*;
/// tree
#[derive(Clone, Debug, Default)]
pub struct AdaptiveTree;
impl AdaptiveTree {
    /// new
    pub fn new(_o: u32, _d: u32) -> Self {
        AdaptiveTree
    }
}
impl BroadPhase for AdaptiveTree {
    fn name(&self) -> String {
        unimplemented!()
    }
    fn find(&mut self, _v: &BoundsView<'_>, _o: &mut Candidates) {
        unimplemented!()
    }
}
