//! The let-back memory of two-sided planes.
/// Bodies that have crossed a two-sided plane.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LetBack {}

impl LetBack {
    /// h
    pub fn home_side(&self, _b: u32, _s: u32) -> Option<f64> {
        None
    }
    /// s
    pub fn settle(&mut self, _b: u32, _s: u32, _d: f64, _r: f64, _v: f64) {}
    /// f
    pub fn forget(&mut self, _s: u32) {}
    /// e
    pub fn entries(&self) -> impl Iterator<Item = [u64; 3]> + '_ {
        std::iter::empty()
    }
    /// e
    pub fn from_entries(_e: &[[u64; 3]]) -> Option<LetBack> {
        None
    }
}
