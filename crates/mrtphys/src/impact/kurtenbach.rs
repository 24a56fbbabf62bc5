//! kurtenbach
/// Kurtenbach
#[derive(Clone, Copy, Debug)]
pub struct Kurtenbach;
impl super::ImpactLaw for Kurtenbach {
    fn name(&self) -> &str {
        unimplemented!()
    }
    fn impulse(&self, _e: &super::Encounter) -> Option<super::Impulse> {
        unimplemented!()
    }
}
/// KurtenbachLiteral
#[derive(Clone, Copy, Debug)]
pub struct KurtenbachLiteral;
impl super::ImpactLaw for KurtenbachLiteral {
    fn name(&self) -> &str {
        unimplemented!()
    }
    fn impulse(&self, _e: &super::Encounter) -> Option<super::Impulse> {
        unimplemented!()
    }
}
/// VelocityWeights
#[derive(Clone, Copy, Debug)]
pub struct VelocityWeights;
impl super::ImpactLaw for VelocityWeights {
    fn name(&self) -> &str {
        unimplemented!()
    }
    fn impulse(&self, _e: &super::Encounter) -> Option<super::Impulse> {
        unimplemented!()
    }
}
