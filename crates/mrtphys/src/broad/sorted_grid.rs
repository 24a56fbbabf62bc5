//! sorted_grid
use super::*;
/// SortedGrid
#[derive(Clone, Debug, Default)]
pub struct SortedGrid;
impl BroadPhase for SortedGrid {
    fn name(&self) -> String {
        unimplemented!()
    }
    fn find(&mut self, _v: &BoundsView<'_>, _o: &mut Candidates) {
        unimplemented!()
    }
}
