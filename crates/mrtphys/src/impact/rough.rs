//! rough
/// Rough
#[derive(Clone, Copy, Debug)]
pub struct Rough;
impl super::ImpactLaw for Rough {
    fn name(&self) -> &str {
        unimplemented!()
    }
    fn impulse(&self, _e: &super::Encounter) -> Option<super::Impulse> {
        unimplemented!()
    }
}
