//! brute_force
use super::*;
/// BruteForce
#[derive(Clone, Debug, Default)]
pub struct BruteForce;
impl BroadPhase for BruteForce {
    fn name(&self) -> String {
        unimplemented!()
    }
    fn find(&mut self, _v: &BoundsView<'_>, _o: &mut Candidates) {
        unimplemented!()
    }
}
