//! coulomb
/// Coulomb
#[derive(Clone, Copy, Debug)]
pub struct Coulomb;
impl super::ImpactLaw for Coulomb {
    fn name(&self) -> &str {
        unimplemented!()
    }
    fn impulse(&self, _e: &super::Encounter) -> Option<super::Impulse> {
        unimplemented!()
    }
}
