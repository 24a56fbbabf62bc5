//! The random numbers of scenes: xoshiro256++ (Blackman and Vigna, "Scrambled linear pseudorandom number generators",
//! ACM TOMS 47, 2021), its state filled by SplitMix64 (Steele, Lea and Flood, OOPSLA 2014). The generator and the order of
//! its draws are part of the scene language: the same scene has the same bodies on every machine, in every version.

use mrtphys::math::{Real, Vec3};

/// Smallest squared length of an accepted point of the cube: nearer to the centre, directions would be coarse.
const INNERMOST: Real = 1.0 / 16.0;

/// A stream of random numbers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Random {
    s: [u64; 4],
}

impl Random {
    /// The stream of a seed.
    pub fn new(seed: u64) -> Random {
        let mut state = seed;
        let mut next = || {
            state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
            let z = (state ^ (state >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
            let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
            z ^ (z >> 31)
        };
        Random { s: [next(), next(), next(), next()] }
    }

    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        let s = &mut self.s;
        let out = s[0].wrapping_add(s[3]).rotate_left(23).wrapping_add(s[0]);
        let t = s[1] << 17;
        s[2] ^= s[0];
        s[3] ^= s[1];
        s[1] ^= s[2];
        s[0] ^= s[3];
        s[2] ^= t;
        s[3] = s[3].rotate_left(45);
        out
    }

    /// A number from \[0, 1): the upper 53 bits, times 2^-53.
    pub fn unit(&mut self) -> Real {
        (self.bits() >> 11) as Real * (1.0 / (1u64 << 53) as Real)
    }

    /// A vector of this length in a random direction, every direction as likely as every other: points of the cube
    /// \[-1, 1)^3 are drawn (x, y, z) until one lies in the shell 1/16 <= x^2 + y^2 + z^2 <= 1, and stretched by
    /// length / sqrt(x^2 + y^2 + z^2). Only operations that IEEE 754 rounds correctly, so the same bits everywhere.
    pub fn direction(&mut self, length: Real) -> Vec3 {
        loop {
            let (x, y, z) = (2.0 * self.unit() - 1.0, 2.0 * self.unit() - 1.0, 2.0 * self.unit() - 1.0);
            let squared = x * x + y * y + z * z;
            if (INNERMOST..=1.0).contains(&squared) {
                let k = length / squared.sqrt();
                return Vec3::new(x * k, y * k, z * k);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seeding_is_splitmix64() {
        // First outputs of the published SplitMix64 for the seed 1234567.
        let r = Random::new(1_234_567);
        assert_eq!(r.s[0], 6_457_827_717_110_365_317);
        assert_eq!(r.s[1], 3_203_168_211_198_807_973);
    }

    #[test]
    fn bits_are_xoshiro256_plus_plus() {
        // First outputs of the published xoshiro256++ from the state 1, 2, 3, 4.
        let mut r = Random { s: [1, 2, 3, 4] };
        assert_eq!([r.bits(), r.bits(), r.bits()], [41_943_041, 58_720_359, 3_588_806_011_781_223]);
    }

    #[test]
    fn directions_have_the_length_and_no_preference() {
        let mut r = Random::new(7);
        let n = 20_000;
        let (mut sum, mut squares) = (Vec3::ZERO, Vec3::ZERO);
        for _ in 0..n {
            let v = r.direction(3.0);
            assert!((v.length() - 3.0).abs() < 1e-14);
            sum += v / 3.0;
            squares += v.mul_elements(v) / 9.0;
        }
        // Standard deviations: sqrt(1/3n) of a mean component, sqrt(4/45n) of a mean square.
        let n = f64::from(n);
        assert!((sum / n).max_abs() < 4.0 * (1.0 / (3.0 * n)).sqrt());
        assert!((squares / n - Vec3::splat(1.0 / 3.0)).max_abs() < 4.0 * (4.0 / (45.0 * n)).sqrt());
    }

    #[test]
    fn doubling_the_length_doubles_the_vector_exactly() {
        let (a, b) = (Random::new(3).direction(0.7), Random::new(3).direction(1.4));
        assert_eq!(a * 2.0, b);
    }
}
