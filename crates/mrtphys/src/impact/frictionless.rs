//! frictionless
/// Frictionless
#[derive(Clone, Copy, Debug)]
pub struct Frictionless;
impl super::ImpactLaw for Frictionless {
    fn name(&self) -> &str {
        unimplemented!()
    }
    fn impulse(&self, _e: &super::Encounter) -> Option<super::Impulse> {
        unimplemented!()
    }
}
