//! Numbers as people write them: read, and entered.

use super::format::{DIGITS, rounded, with_unit};
use super::typed::Typed;
use eframe::egui;
use mrtphys::Vec3;
use std::ops::RangeInclusive;

/// Digits that are shown in vectors.
const FEWER_DIGITS: usize = 4;
/// Width of a component of a vector \[points\].
const COMPONENT: f32 = 64.0;

/// Reads a number as people write it: `1/64`, `2.5`, `3e-4`, with a comma for the point, with the unit (`12 mm` for a
/// value in m) or without.
pub fn parse(text: &str, unit: &str) -> Option<f64> {
    let text = text.trim().replace('\u{2212}', "-").replace(',', ".");
    if matches!(text.as_str(), "infinite" | "inf") {
        return Some(f64::INFINITY);
    }
    let end = end_of_number(&text);
    let (digits, rest) = (text.get(..end)?.trim(), text.get(end..)?.trim());
    let value = match digits.split_once('/') {
        Some((a, b)) => a.trim().parse::<f64>().ok()? / b.trim().parse::<f64>().ok()?,
        None => digits.parse::<f64>().ok()?,
    };
    let value = value * factor_of(rest, unit)?;
    value.is_finite().then_some(value)
}

/// Where the number ends and a unit may begin. An `e` belongs to the number only before a digit or a sign.
fn end_of_number(text: &str) -> usize {
    let bytes = text.as_bytes();
    let belongs = |i: usize| match bytes[i] {
        b'0'..=b'9' | b'+' | b'-' | b'.' | b'/' | b' ' => true,
        b'e' | b'E' => i > 0 && matches!(bytes[i - 1], b'0'..=b'9' | b'.'),
        _ => false,
    };
    let end = (0..bytes.len()).find(|&i| !belongs(i)).unwrap_or(bytes.len());
    // A trailing exponent without digits is not one.
    let exponent = |i: usize| bytes.get(i + 1).is_some_and(|b| b.is_ascii_digit() || matches!(b, b'+' | b'-'));
    (0..end).find(|&i| matches!(bytes[i], b'e' | b'E') && !exponent(i)).unwrap_or(end)
}

/// What a written unit is in terms of the value's own: prefixes before the same unit.
fn factor_of(written: &str, unit: &str) -> Option<f64> {
    if written.is_empty() || written == unit || (written == "x" && unit == "\u{d7}") {
        return Some(1.0);
    }
    // kg has its prefix already.
    if unit == "kg" {
        return match written {
            "g" => Some(1e-3),
            "mg" => Some(1e-6),
            "t" => Some(1e3),
            _ => None,
        };
    }
    // A prefix of a power (mm3) would be raised to it: refused rather than misread.
    let base = unit.split('/').next().unwrap_or_default();
    let powered = base.ends_with(|c: char| c.is_ascii_digit());
    let prefix = written.strip_suffix(unit)?;
    match prefix {
        _ if powered => None,
        "n" => Some(1e-9),
        "u" => Some(1e-6),
        "m" => Some(1e-3),
        "c" => Some(1e-2),
        "k" => Some(1e3),
        "M" => Some(1e6),
        "G" => Some(1e9),
        _ => None,
    }
}

/// What a text means, or what was expected: for a person who typed it.
///
/// # Errors
/// It is no number, or none that can be computed with.
pub fn read(text: &str, unit: &str, whole: bool) -> Result<f64, String> {
    let x = parse(text, unit).ok_or_else(|| {
        let plain = text.trim().parse::<f64>();
        match plain {
            Ok(x) if x.is_infinite() => format!("At most {:.1e} can be computed with", f64::MAX),
            _ => expected(unit, whole),
        }
    })?;
    if whole && x.fract() != 0.0 { Err(expected(unit, whole)) } else { Ok(x) }
}

fn expected(unit: &str, whole: bool) -> String {
    let what = if whole { "A whole number" } else { "A number" };
    let example = match (whole, unit) {
        (true, _) => "",
        (_, "m") => ", such as 2.5, 1/64, 3e-4 or 12 mm,",
        (_, "kg") => ", such as 2.5, 1/64, 3e-4 or 12 g,",
        _ => ", such as 2.5, 1/64 or 3e-4,",
    };
    let unit = if unit.is_empty() { String::new() } else { format!(" in {unit}") };
    format!("{what}{unit}{example} is expected")
}

/// How a value is entered.
#[derive(Clone, Debug)]
pub struct Entry<'a> {
    /// its unit; empty for a plain number
    pub unit: &'a str,
    /// what a drag across the widget changes about, where the value itself is near zero
    pub scale: f64,
    /// what there may be
    pub range: RangeInclusive<f64>,
    /// whether it has no fraction
    pub whole: bool,
    /// what it is
    pub hint: &'a str,
}

impl<'a> Entry<'a> {
    /// Any number.
    pub fn any(unit: &'a str, scale: f64, hint: &'a str) -> Entry<'a> {
        Entry { unit, scale, range: f64::NEG_INFINITY..=f64::INFINITY, whole: false, hint }
    }

    /// Numbers from zero on.
    pub fn positive(unit: &'a str, scale: f64, hint: &'a str) -> Entry<'a> {
        Entry { range: 0.0..=f64::INFINITY, ..Entry::any(unit, scale, hint) }
    }

    /// Whole numbers.
    pub fn whole(unit: &'a str, range: RangeInclusive<u32>, hint: &'a str) -> Entry<'a> {
        let range = f64::from(*range.start())..=f64::from(*range.end());
        // A whole number changes by one within a few points of dragging.
        Entry { whole: true, range, ..Entry::any(unit, 20.0, hint) }
    }

    /// Shows the value and lets it be dragged or typed; what is typed holds from Enter on. The new value, if it was
    /// changed: by more than its digits show, so that looking at a number never rounds it.
    pub fn show(&self, ui: &mut egui::Ui, value: f64) -> Option<f64> {
        self.widget(ui, value, (DIGITS, None), self.hint)
    }

    /// As [`show`](Entry::show), for whole numbers.
    pub fn count(&self, ui: &mut egui::Ui, value: &mut u32) -> bool {
        let new = self.show(ui, f64::from(*value));
        new.map(|x| *value = x as u32).is_some()
    }

    /// A slider that fills the line, with the number at its right, which may be beyond the slider's ends. The new value, if
    /// it was changed.
    pub fn slider(&self, ui: &mut egui::Ui, value: f64, slid: &Slid) -> (egui::Response, Option<f64>) {
        let mut slid_to = value;
        let mut slider = egui::Slider::new(&mut slid_to, slid.range.clone())
            .logarithmic(slid.logarithmic)
            .clamping(egui::SliderClamping::Edits)
            .show_value(false);
        if self.whole {
            slider = slider.integer();
        }
        let (response, typed) = ui
            .horizontal(|ui| {
                let gap = ui.spacing().item_spacing.x;
                ui.spacing_mut().slider_width = (ui.available_width() - slid.number - gap).max(40.0);
                let response = ui.add(slider).on_hover_text(self.hint);
                let typed = ui.scope(|ui| {
                    ui.spacing_mut().interact_size.x = slid.number;
                    self.show(ui, value)
                });
                (response, typed.inner)
            })
            .inner;
        let new = typed.or(response.changed().then_some(slid_to));
        (response, new)
    }

    /// As [`slider`](Entry::slider), for whole numbers.
    pub fn count_slider(&self, ui: &mut egui::Ui, value: &mut u32, slid: &Slid) -> (egui::Response, bool) {
        let (response, new) = self.slider(ui, f64::from(*value), slid);
        (response, new.map(|x| *value = x as u32).is_some())
    }

    fn widget(&self, ui: &mut egui::Ui, value: f64, (digits, width): (usize, Option<f32>), hint: &str) -> Option<f64> {
        let unit = self.unit;
        let speed = (value.abs() * 0.01).max(self.scale.abs() * 0.005);
        let typed = Typed {
            shown: &|x| if self.whole { format!("{x:.0}") } else { rounded(x, digits) },
            read: &|text| read(text, unit, self.whole),
            range: self.range.clone(),
            speed: if speed.is_finite() { speed } else { self.scale },
            width,
            suffix: if unit.is_empty() { String::new() } else { format!(" {unit}") },
            hint,
            exact: with_unit(value, unit),
        };
        let new = typed.show(ui, value).1?;
        let new = if self.whole { new.round() } else { new };
        let same = if self.whole { new == value } else { rounded(new, digits) == rounded(value, digits) };
        (!same).then_some(new)
    }

    /// The three components of a vector in a row. The new vector, if it was changed.
    pub fn vector(&self, ui: &mut egui::Ui, value: Vec3) -> Option<Vec3> {
        let mut new = value.to_array();
        let mut changed = false;
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 3.0;
            for (x, axis) in new.iter_mut().zip(["x", "y", "z"]) {
                let hint = format!("{axis}: {}", self.hint);
                if let Some(y) = self.widget(ui, *x, (FEWER_DIGITS, Some(COMPONENT)), &hint) {
                    (*x, changed) = (y, true);
                }
            }
        });
        changed.then(|| Vec3::new(new[0], new[1], new[2]))
    }
}

/// What a slider is like.
#[derive(Clone, Debug)]
pub struct Slid {
    /// from its left end to its right
    pub range: RangeInclusive<f64>,
    /// whether equal ways are equal factors
    pub logarithmic: bool,
    /// room for the number with its unit \[points\]
    pub number: f32,
}

impl Slid {
    /// With room for a short number.
    pub fn new(range: RangeInclusive<f64>, logarithmic: bool) -> Slid {
        Slid { range, logarithmic, number: 58.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::super::format::number;
    use super::*;

    #[test]
    fn what_is_shown_can_be_read() {
        for x in [0.0, 1.0, -2.5, 1e-9, 6.02e23, 0.001, f64::INFINITY] {
            assert_eq!(parse(&number(x), "m"), Some(x), "{x}");
            if x.is_finite() {
                assert_eq!(parse(&with_unit(x, "m"), "m"), Some(x), "{x}");
            }
        }
    }

    #[test]
    fn what_was_expected_is_said() {
        assert_eq!(read("2.5", "m", false), Ok(2.5));
        assert_eq!(read("12", "", true), Ok(12.0));
        for (text, unit, whole, why) in [
            ("abc", "m", false, "A number in m, such as 2.5, 1/64, 3e-4 or 12 mm, is expected"),
            ("1e400", "", false, "At most 1.8e308 can be computed with"),
            ("-1e999", "m", false, "At most 1.8e308 can be computed with"),
            ("2.5", "frames", true, "A whole number in frames is expected"),
            ("x", "", true, "A whole number is expected"),
        ] {
            assert_eq!(read(text, unit, whole), Err(why.into()), "{text}");
        }
    }

    #[test]
    fn units_and_fractions_are_read() {
        for (text, unit, value) in [
            ("1/64", "s", 0.015625),
            (" 12 mm", "m", 0.012),
            ("12mm", "m", 0.012),
            ("2,5", "m", 2.5),
            ("3e-4 m", "m", 3e-4),
            ("5 g", "kg", 5e-3),
            ("1 t", "kg", 1000.0),
            ("3 km/s", "m/s", 3000.0),
            ("\u{2212}3", "m", -3.0),
        ] {
            let read = parse(text, unit).unwrap_or(f64::NAN);
            assert!((read - value).abs() <= 1e-15 * value.abs(), "{text}: {read}");
        }
        for (text, unit) in [
            ("", "m"),
            ("m", "m"),
            ("3 s", "m"),
            ("1/0", "m"),
            ("1 mm3", "m3"),
            ("1e999", "m"),
            ("1e m", "s"),
            ("--1", "m"),
            ("NaN", "m"),
        ] {
            assert_eq!(parse(text, unit), None, "{text}");
        }
    }
}
