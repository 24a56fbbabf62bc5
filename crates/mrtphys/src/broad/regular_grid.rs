//! grid
use super::*;
/// grid
#[derive(Clone, Debug, Default)]
pub struct RegularGrid;
impl RegularGrid {
    /// new
    pub fn new(_r: Option<u32>) -> Self {
        RegularGrid
    }
}
impl BroadPhase for RegularGrid {
    fn name(&self) -> String {
        unimplemented!()
    }
    fn find(&mut self, _v: &BoundsView<'_>, _o: &mut Candidates) {
        unimplemented!()
    }
}
