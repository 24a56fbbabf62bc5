//! Numbers as people read them: short, or of even width, and never misleading.

use std::time::Duration;

/// How a number is written.
#[derive(Clone, Copy, Debug)]
struct Form {
    /// significant digits
    digits: usize,
    /// plain below this power of ten, and from a thousandth on; else with a power of ten
    plain: i32,
    /// whether zeros at the end are kept
    padded: bool,
}

/// Smallest power of ten that is written without it.
const LEAST_PLAIN: i32 = -3;
/// Digits of a number.
pub const DIGITS: usize = 6;

impl Form {
    fn write(self, x: f64) -> String {
        if x == 0.0 {
            return "0".into();
        }
        if !x.is_finite() {
            let infinite = if x > 0.0 { "infinite" } else { "-infinite" };
            return if x.is_nan() { "not a number" } else { infinite }.into();
        }
        // Rounded first: 9.99999999 has another power of ten than it seems.
        let scientific = format!("{x:.*e}", self.digits.saturating_sub(1));
        let (mantissa, power) = scientific.split_once('e').unwrap_or((&scientific, "0"));
        let power: i32 = power.parse().unwrap_or(0);
        if (LEAST_PLAIN..self.plain).contains(&power) {
            let decimals = (self.digits as i32 - 1 - power).max(0) as usize;
            return self.trimmed(&format!("{x:.decimals$}")).into();
        }
        format!("{}e{power}", self.trimmed(mantissa))
    }

    fn trimmed(self, text: &str) -> &str {
        let has_zeros = !self.padded && text.contains('.');
        if has_zeros { text.trim_end_matches('0').trim_end_matches('.') } else { text }
    }
}

/// A number as one would write it: at most six significant digits, none that says nothing.
pub fn number(x: f64) -> String {
    rounded(x, DIGITS)
}

/// As [`number`], with at most so many significant digits.
pub fn rounded(x: f64, digits: usize) -> String {
    Form { digits, plain: digits as i32, padded: false }.write(x)
}

/// A quantity that is watched while it changes: always seven digits, so that they do not jump about.
pub fn reading(x: f64) -> String {
    Form { digits: 7, plain: 6, padded: true }.write(x)
}

/// A quantity where room is short: always three digits.
pub fn brief(x: f64) -> String {
    Form { digits: 3, plain: 5, padded: true }.write(x)
}

/// A number with its unit.
pub fn with_unit(x: f64, unit: &str) -> String {
    if unit.is_empty() { number(x) } else { format!("{} {unit}", number(x)) }
}

/// A relative deviation such as E/E0 - 1, always as a power of ten: 2.2e-15.
pub fn deviation(x: f64) -> String {
    if x == 0.0 || !x.is_finite() { number(x) } else { format!("{x:.1e}") }
}

/// A count with its thousands apart.
pub fn count(n: u64) -> String {
    let digits = n.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}

/// A time that something took, in the unit that fits it.
pub fn duration(d: Duration) -> String {
    let s = d.as_secs_f64();
    match s {
        s if s < 1e-3 => format!("{:.1} µs", s * 1e6),
        s if s < 1.0 => format!("{:.2} ms", s * 1e3),
        s => format!("{s:.2} s"),
    }
}

/// The energy now against that at the start, less one; `None` where there was none to compare with.
pub fn drift(now: f64, start: f64) -> Option<f64> {
    let drift = (now - start) / start.abs();
    drift.is_finite().then_some(drift)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_true() {
        for (x, text) in [
            (0.0, "0"),
            (-0.0, "0"),
            (9.80665, "9.80665"),
            (-1.5, "-1.5"),
            (9.9999999, "10"),
            (133_888.0, "133888"),
            (1_338_885.0, "1.33888e6"),
            (0.001, "0.001"),
            (0.00012, "1.2e-4"),
            (2.22e-15, "2.22e-15"),
            (f64::INFINITY, "infinite"),
            (f64::NEG_INFINITY, "-infinite"),
            (f64::NAN, "not a number"),
        ] {
            assert_eq!(number(x), text);
        }
        assert_eq!(with_unit(2.0, "m/s"), "2 m/s");
        assert_eq!((rounded(-0.041_655_1, 4), rounded(99_999.0, 4)), ("-0.04166".into(), "1e5".into()));
    }

    #[test]
    fn readings_keep_seven_digits() {
        let cases = [
            (0.0, "0"),
            (1.0, "1.000000"),
            (-12.5, "-12.50000"),
            (123_456.7, "123456.7"),
            (9.999_999_99, "10.00000"),
            (999_999.99, "1.000000e6"),
            (0.001, "0.001000000"),
            (1.234_567_8e-5, "1.234568e-5"),
            (3e9, "3.000000e9"),
            (f64::NAN, "not a number"),
        ];
        for (x, text) in cases {
            assert_eq!(reading(x), text);
        }
    }

    #[test]
    fn brief_numbers_have_three_digits() {
        assert_eq!([brief(0.0), brief(1.0), brief(59.94), brief(-0.1)], ["0", "1.00", "59.9", "-0.100"]);
        assert_eq!([brief(12_345.0), brief(1e-5), brief(1e9)], ["12345", "1.00e-5", "1.00e9"]);
        assert_eq!([brief(9.999), brief(99_999.9)], ["10.0", "1.00e5"]);
    }

    /// Every form is within half a unit of its last digit, and is read as a number again.
    #[test]
    fn what_is_written_is_the_nearest_number_of_its_length() {
        type Writes = fn(f64) -> String;
        let forms: [(Writes, i32); 3] = [(number, 6), (reading, 7), (brief, 3)];
        for power in -30..30 {
            for m in [1.0, 1.234_567_890_1, -4.999_999_9, 9.999_999_9] {
                let x = m * 10f64.powi(power);
                for (form, digits) in forms {
                    let read: f64 = form(x).parse().unwrap();
                    assert!((read - x).abs() <= 0.51 * 10f64.powi(1 - digits) * x.abs(), "{x:e}: {}", form(x));
                }
            }
        }
    }

    #[test]
    fn deviations_are_powers_of_ten() {
        assert_eq!([2.24e-15, -0.5, 0.0].map(deviation), ["2.2e-15", "-5.0e-1", "0"]);
    }

    #[test]
    fn counts_have_their_thousands_apart() {
        assert_eq!([0, 999, 1000, 1_234_567].map(count), ["0", "999", "1 000", "1 234 567"]);
    }

    #[test]
    fn durations_have_a_fitting_unit() {
        let text = |s| duration(Duration::from_secs_f64(s));
        assert_eq!([text(0.0), text(2.5e-4), text(0.0123), text(3.0)], ["0.0 µs", "250.0 µs", "12.30 ms", "3.00 s"]);
    }

    #[test]
    fn a_drift_needs_something_to_compare_with() {
        assert_eq!(drift(1.1, 1.0).map(|d| (d * 1e6).round()), Some(100_000.0));
        assert_eq!(drift(-1.5, -1.0), Some(-0.5), "less energy is a loss, whatever the sign");
        assert_eq!(drift(1.0, 0.0), None);
    }
}
