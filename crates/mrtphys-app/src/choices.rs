//! Choices by name: what there is, what is not in this version yet, and what was probably meant.

use mrtphys::{Algorithm, BroadPhaseKind, FrictionLaw, ImpactMode};

/// Names of the contract that this version does not have yet.
const LATER_ALGORITHMS: &[&str] = &["event-driven", "rollback"];
const LATER_BROAD_PHASES: &[&str] = &["bvh"];

/// Reads an algorithm.
pub fn algorithm(text: &str) -> Result<Algorithm, String> {
    choose(text, Algorithm::ALL, LATER_ALGORITHMS)
}

/// Reads a friction law.
pub fn friction_law(text: &str) -> Result<FrictionLaw, String> {
    choose(text, FrictionLaw::ALL, &[])
}

/// Reads how simultaneous impacts are answered.
pub fn impact(text: &str) -> Result<ImpactMode, String> {
    choose(text, ImpactMode::ALL, &[])
}

/// Reads a broad phase with its parameters.
pub fn broad_phase(text: &str) -> Result<BroadPhaseKind, String> {
    const NAMES: [&str; 4] = ["brute-force", "regular-grid", "adaptive-tree", "sorted-grid"];
    let name = text.split(':').next().unwrap_or_default();
    if LATER_BROAD_PHASES.contains(&name) {
        return Err(not_yet(name, &NAMES));
    }
    text.parse().map_err(|reason: String| {
        if NAMES.contains(&name) { reason } else { unknown(&reason, closest(name, NAMES.iter().copied())) }
    })
}

fn choose<T: Copy>(text: &str, all: &[(&'static str, T)], later: &[&str]) -> Result<T, String> {
    if let Some((_, value)) = all.iter().find(|(name, _)| *name == text) {
        return Ok(*value);
    }
    let names: Vec<&str> = all.iter().map(|c| c.0).collect();
    if later.contains(&text) {
        return Err(not_yet(text, &names));
    }
    Err(unknown(&names.join(", "), closest(text, names.iter().chain(later).copied())))
}

fn not_yet(name: &str, there_is: &[&str]) -> String {
    format!("'{name}' is not in this version; there is {}", there_is.join(", "))
}

fn unknown(there_is: &str, meant: Option<&str>) -> String {
    let tip = meant.map(|m| format!("; did you mean '{m}'?")).unwrap_or_default();
    format!("there is {there_is}{tip}")
}

/// The name that was probably meant: the most alike, if it is alike at all.
pub fn closest<'a>(text: &str, names: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    const ALIKE: f64 = 0.7;
    let alike = |name: &str| strsim::jaro_winkler(text, name);
    names.map(|n| (alike(n), n)).filter(|(a, _)| *a >= ALIKE).max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, n)| n)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_choice_is_read() {
        for (name, value) in FrictionLaw::ALL {
            assert_eq!(friction_law(name), Ok(*value));
        }
        assert_eq!(broad_phase("regular-grid:20"), Ok(BroadPhaseKind::RegularGrid { resolution: Some(20) }));
    }

    #[test]
    fn what_comes_later_is_refused_by_name() {
        for refused in [algorithm("event-driven").unwrap_err(), algorithm("rollback").unwrap_err()] {
            assert!(refused.contains("not in this version"), "{refused}");
        }
        let refused = broad_phase("bvh").unwrap_err();
        assert!(refused.contains("'bvh' is not in this version"), "{refused}");
    }

    #[test]
    fn what_is_unknown_lists_the_choices_and_guesses() {
        let refused = friction_law("kurtenbahc").unwrap_err();
        assert!(refused.contains("coulomb") && refused.contains("did you mean 'kurtenbach'?"), "{refused}");
        let refused = broad_phase("sorted_grid").unwrap_err();
        assert!(refused.contains("brute-force") && refused.contains("did you mean 'sorted-grid'?"), "{refused}");
        assert!(!impact("xyz").unwrap_err().contains("did you mean"));
        let refused = broad_phase("regular-grid:0").unwrap_err();
        assert!(refused.contains("1 to 1024"), "{refused}");
    }
}
