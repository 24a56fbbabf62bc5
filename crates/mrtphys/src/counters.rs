//! Counts of what was done, as the thesis counts (section 5.3.4): they never influence a result.

/// Counts of one step, or summed over steps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// pairs whose bounding spheres were compared
    pub sphere_tests: u64,
    /// pairs whose bounding spheres met, so that a pair routine was asked
    pub detect_calls: u64,
    /// contacts that the pair routines reported
    pub contacts: u64,
    /// contacts that were answered with an impulse
    pub impacts: u64,
    /// those of them against a boundary
    pub wall_impacts: u64,
    /// impacts whose friction law would have left the pair approaching, so that the frictionless law answered
    pub fallbacks: u64,
    /// contacts whose overlap was projected out
    pub projections: u64,
    /// simultaneous impacts that ran out of their round budget and were left for the next step
    pub undecided: u64,
    /// bodies set aside because their motion was no longer a finite number
    pub quarantined: u64,
}

impl std::ops::AddAssign for Counters {
    fn add_assign(&mut self, o: Counters) {
        self.sphere_tests += o.sphere_tests;
        self.detect_calls += o.detect_calls;
        self.contacts += o.contacts;
        self.impacts += o.impacts;
        self.wall_impacts += o.wall_impacts;
        self.fallbacks += o.fallbacks;
        self.projections += o.projections;
        self.undecided += o.undecided;
        self.quarantined += o.quarantined;
    }
}
