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

impl Counters {
    /// Names of the counts, in the order of [`to_array`](Counters::to_array).
    pub const NAMES: [&'static str; 9] = [
        "sphere_tests",
        "detect_calls",
        "contacts",
        "impacts",
        "wall_impacts",
        "fallbacks",
        "projections",
        "undecided",
        "quarantined",
    ];

    /// The counts in the order of [`NAMES`](Counters::NAMES).
    pub fn to_array(&self) -> [u64; 9] {
        [
            self.sphere_tests,
            self.detect_calls,
            self.contacts,
            self.impacts,
            self.wall_impacts,
            self.fallbacks,
            self.projections,
            self.undecided,
            self.quarantined,
        ]
    }

    /// From counts in the order of [`NAMES`](Counters::NAMES).
    pub fn from_array(c: [u64; 9]) -> Counters {
        Counters {
            sphere_tests: c[0],
            detect_calls: c[1],
            contacts: c[2],
            impacts: c[3],
            wall_impacts: c[4],
            fallbacks: c[5],
            projections: c[6],
            undecided: c[7],
            quarantined: c[8],
        }
    }
}

impl std::ops::AddAssign for Counters {
    fn add_assign(&mut self, o: Counters) {
        let (a, b) = (self.to_array(), o.to_array());
        *self = Counters::from_array(std::array::from_fn(|i| a[i] + b[i]));
    }
}
