//! Numbers as the panel says them: short, of even width, and never misleading.

use std::time::Duration;

/// A quantity with five digits after the first; a power of ten where it is very large or very small.
pub fn number(x: f64) -> String {
    if x == 0.0 {
        return "0".into();
    }
    if !x.is_finite() {
        return if x.is_nan() { "not a number".into() } else { format!("{x}") };
    }
    let size = x.abs();
    if !(1e-3..1e6).contains(&size) {
        return format!("{x:.5e}");
    }
    let before = size.log10().floor().max(0.0) as usize;
    format!("{x:.*}", 6usize.saturating_sub(before).max(1))
}

/// A quantity with three digits: for labels where room is short.
pub fn brief(x: f64) -> String {
    let size = x.abs();
    if x == 0.0 {
        "0".into()
    } else if !(1e-3..1e5).contains(&size) {
        format!("{x:.2e}")
    } else {
        let before = size.log10().floor() as i32;
        format!("{x:.*}", (2 - before).max(0) as usize)
    }
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
    fn numbers_keep_seven_digits_and_say_what_is_no_number() {
        let cases = [(0.0, "0"), (1.0, "1.000000"), (-12.5, "-12.50000"), (123_456.7, "123456.7")];
        for (x, text) in cases {
            assert_eq!(number(x), text);
        }
        assert_eq!([number(1.234_567_8e-5), number(3e9)], ["1.23457e-5", "3.00000e9"]);
        assert_eq!([number(f64::NAN), number(f64::NEG_INFINITY)], ["not a number", "-inf"]);
        assert_eq!(number(0.001), "0.001000");
    }

    #[test]
    fn brief_numbers_have_three_digits() {
        assert_eq!([brief(0.0), brief(1.0), brief(59.94), brief(-0.1)], ["0", "1.00", "59.9", "-0.100"]);
        assert_eq!([brief(12_345.0), brief(1e-5), brief(1e9)], ["12345", "1.00e-5", "1.00e9"]);
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
