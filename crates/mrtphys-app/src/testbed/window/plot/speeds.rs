//! How many bodies have which speed, beside the distribution of Maxwell (1860) and Boltzmann.

use std::f64::consts::PI;

/// Bins of the histogram for many bodies; few bodies have fewer, so that a bin has some.
const BINS: usize = 40;
/// Parts of a bin in each half of which the expected number is summed.
const FINE: usize = 4;
/// Parts of the expected curve: so many that its corners are not seen.
const SMOOTH: usize = 200;
/// A bin that is expected to have fewer says nothing about chi squared.
const FEWEST: f64 = 5.0;

/// A histogram of speeds, and what is expected of bodies of this energy.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Histogram {
    /// width of a bin \[m/s\]
    pub width: f64,
    /// bodies in each bin
    pub counts: Vec<u32>,
    /// bodies expected in each bin
    pub expected: Vec<f64>,
    /// speed \[m/s\] and bodies in a bin there, as a smooth curve
    pub curve: Vec<[f64; 2]>,
}

impl Histogram {
    /// Of masses \[kg\] and speeds \[m/s\]; `None`: nothing moves.
    ///
    /// In equilibrium a body of mass m has a speed between v and v + dv with the probability
    /// 4 pi v^2 (m/(2 pi kT))^(3/2) exp(-m v^2/(2 kT)) dv, where kT is two thirds of the mean energy of translation: bodies of
    /// different masses share one temperature, and the curve is the sum over them.
    pub fn new(bodies: &[(f64, f64)]) -> Option<Histogram> {
        let good: Vec<(f64, f64)> =
            bodies.iter().copied().filter(|(m, v)| *m > 0.0 && m.is_finite() && v.is_finite()).collect();
        let heat = good.iter().map(|(m, v)| m * v * v).sum::<f64>() / (3.0 * good.len().max(1) as f64);
        let fastest = good.iter().map(|b| b.1).fold(0.0, f64::max);
        if !(heat > 0.0 && heat.is_finite() && fastest > 0.0) {
            return None;
        }
        let masses = groups(&good);
        let lightest = masses.first().map_or(1.0, |g| g.0);
        // Beyond three and a half thermal speeds of the lightest there is one body in some thousand.
        let end = fastest.max(3.5 * (heat / lightest).sqrt());
        let bins = ((2.0 * (good.len() as f64).cbrt()) as usize).clamp(8, BINS);
        let width = end / bins as f64;
        let mut counts = vec![0; bins];
        for (_, v) in &good {
            counts[((v / width) as usize).min(bins - 1)] += 1;
        }
        let density = |v: f64| masses.iter().map(|(m, n)| n * maxwell(v, m / heat)).sum::<f64>();
        // Simpson's rule in each bin.
        let inside = |i: usize| {
            let (a, b) = (width * i as f64, width * (i + 1) as f64);
            let h = width / (2 * FINE) as f64;
            let at = |k: usize| density(a + h * k as f64) * if k % 2 == 1 { 4.0 } else { 2.0 };
            (density(a) + (1..2 * FINE).map(at).sum::<f64>() + density(b)) * h / 3.0
        };
        let expected = (0..bins).map(inside).collect();
        let point = |k: usize| {
            let v = end * k as f64 / SMOOTH as f64;
            [v, density(v) * width]
        };
        Some(Histogram { width, counts, expected, curve: (0..=SMOOTH).map(point).collect() })
    }

    /// Sum over the bins of (counted - expected)^2/expected, and how many bins there are in it. In equilibrium the sum is about
    /// as large as the number; bins with few expected bodies are taken together with their neighbours.
    pub fn chi_squared(&self) -> (f64, usize) {
        let (mut sum, mut bins, mut counted, mut expected) = (0.0, 0, 0.0, 0.0);
        for (c, e) in self.counts.iter().zip(&self.expected) {
            (counted, expected) = (counted + f64::from(*c), expected + e);
            if expected >= FEWEST {
                sum += (counted - expected) * (counted - expected) / expected;
                bins += 1;
                (counted, expected) = (0.0, 0.0);
            }
        }
        (sum, bins)
    }
}

/// Masses with the number of bodies that have them, lightest first; very many different ones are taken together by the percent.
fn groups(bodies: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut masses: Vec<f64> = bodies.iter().map(|b| b.0).collect();
    masses.sort_by(f64::total_cmp);
    let mut groups: Vec<(f64, f64)> = Vec::new();
    for m in masses {
        match groups.last_mut() {
            Some((mass, n)) if m <= *mass * 1.01 => *n += 1.0,
            _ => groups.push((m, 1.0)),
        }
    }
    groups
}

/// The density of speeds for m/kT = `b`.
fn maxwell(v: f64, b: f64) -> f64 {
    4.0 * PI * v * v * (b / (2.0 * PI)).powf(1.5) * (-0.5 * b * v * v).exp()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Speeds at even steps of the distribution, by its running integral: a gas without fluctuations.
    fn gas(n: usize, mass: f64, heat: f64) -> Vec<(f64, f64)> {
        let b = mass / heat;
        let (h, mut v, mut sum) = (1e-4 / b.sqrt(), 0.0, 0.0);
        let mut all = Vec::new();
        while all.len() < n {
            sum += maxwell(v + 0.5 * h, b) * h;
            v += h;
            while all.len() < n && sum >= (all.len() as f64 + 0.5) / n as f64 {
                all.push((mass, v));
            }
        }
        all
    }

    #[test]
    fn a_gas_in_equilibrium_is_recognised() {
        let h = Histogram::new(&gas(4096, 2.0, 3.0)).unwrap();
        assert_eq!(h.counts.iter().sum::<u32>(), 4096);
        assert!((h.expected.iter().sum::<f64>() / 4096.0 - 1.0).abs() < 0.01);
        let (chi, bins) = h.chi_squared();
        assert!(bins > 15 && chi < 3.0, "{chi} of {bins}");
    }

    #[test]
    fn equal_speeds_are_no_equilibrium() {
        let h = Histogram::new(&vec![(1.0, 1.0); 512]).unwrap();
        let (chi, bins) = h.chi_squared();
        assert!(chi > 20.0 * bins as f64, "{chi} of {bins}");
    }

    #[test]
    fn different_masses_share_a_temperature() {
        let mut both = gas(2000, 1.0, 0.7);
        both.extend(gas(2000, 9.0, 0.7));
        let (chi, bins) = Histogram::new(&both).unwrap().chi_squared();
        assert!(bins > 10 && chi < 0.2 * bins as f64, "{chi} of {bins}");
    }

    #[test]
    fn without_motion_there_is_no_histogram() {
        for bad in [vec![], vec![(1.0, 0.0); 9], vec![(f64::INFINITY, 1.0)], vec![(1.0, f64::NAN)]] {
            assert_eq!(Histogram::new(&bad), None);
        }
    }
}
