//! Scales that numbers are drawn with: round, and steady from picture to picture.

use mrtphys::Real;

/// The largest of 1, 2, 5 times a power of ten that is not above `x`; 1 where `x` is not a positive number.
pub fn round_down(x: Real) -> Real {
    if !(x.is_finite() && x > 0.0) {
        return 1.0;
    }
    let power = 10f64.powi(x.log10().floor() as i32);
    [5.0, 2.0].into_iter().map(|k| k * power).find(|&k| k <= x).unwrap_or(power)
}

/// The smallest of 1, 2, 5 times a power of ten that is not below `x`; 1 where `x` is not a positive number.
pub fn round_up(x: Real) -> Real {
    let below = round_down(x);
    if !(x > below) || !x.is_finite() {
        return below;
    }
    // The next one is 2 or 2.5 times as large.
    let leading = below / 10f64.powi(below.log10().round() as i32);
    if (0.19..0.21).contains(&leading) || (1.9..2.1).contains(&leading) { below * 2.5 } else { below * 2.0 }
}

/// The value that is drawn as large as anything is: the largest lately seen, rounded up. It grows at once, and falls only
/// when for some pictures nothing came near: arrows and colors do not flicker while the largest value changes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Scale {
    largest: Real,
}

/// A scale falls by this factor a picture.
const FALL: Real = 0.98;

impl Scale {
    /// Takes note of the largest value of a picture; returns what is to be drawn as large as anything is.
    pub fn follow(&mut self, largest: Real) -> Real {
        let largest = if largest.is_finite() { largest.max(0.0) } else { 0.0 };
        self.largest = largest.max(self.largest * FALL);
        self.full()
    }

    /// What is drawn as large as anything is: 1, 2 or 5 times a power of ten.
    pub fn full(&self) -> Real {
        round_up(self.largest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn round_numbers_enclose() {
        let all = [0.013, 0.02, 0.7, 1.0, 4.99, 5.1, 9.9, 3e-40, 0.0, Real::NAN].map(round_down);
        let right = [0.01, 0.02, 0.5, 1.0, 2.0, 5.0, 5.0, 2e-40, 1.0, 1.0];
        assert!(all.iter().zip(right).all(|(a, b)| (a / b - 1.0).abs() < 1e-9), "{all:?}");
        let all = [0.013, 0.02, 0.7, 1.0, 4.99, 5.1, 9.9, 2.3e-40, 0.0, Real::NAN, 0.21, 201.0].map(round_up);
        let right = [0.02, 0.02, 1.0, 1.0, 5.0, 10.0, 10.0, 5e-40, 1.0, 1.0, 0.5, 500.0];
        assert!(all.iter().zip(right).all(|(a, b)| (a / b - 1.0).abs() < 1e-9), "{all:?}");
    }

    #[test]
    fn a_scale_grows_at_once_and_falls_slowly() {
        let mut s = Scale::default();
        assert_eq!(s.follow(3.0), 5.0);
        assert_eq!(s.follow(7.0), 10.0);
        assert_eq!(s.follow(0.1), 10.0);
        let falling: Vec<Real> = (0..300).map(|_| s.follow(0.1)).collect();
        assert!(falling.is_sorted_by(|a, b| a >= b));
        assert!((falling[299] - 0.1).abs() < 1e-9, "{}", falling[299]);
        assert_eq!(s.follow(Real::NAN), s.full());
    }
}
