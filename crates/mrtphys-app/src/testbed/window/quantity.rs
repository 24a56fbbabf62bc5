//! Numbers as people write them: read, and entered.

use super::format::{DIGITS, rounded, with_unit};
use eframe::egui;
use mrtphys::Vec3;
use std::ops::RangeInclusive;

/// Digits that are shown in vectors.
const FEWER_DIGITS: usize = 4;
/// Width of a component of a vector \[points\].
const COMPONENT: f32 = 62.0;

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
    if written.is_empty() || written == unit {
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

/// How a value is entered.
#[derive(Clone, Debug)]
pub struct Entry<'a> {
    /// its unit; empty for a plain number
    pub unit: &'a str,
    /// what a drag across the widget changes about, where the value itself is near zero
    pub scale: f64,
    /// what there may be
    pub range: RangeInclusive<f64>,
    /// what it is
    pub hint: &'a str,
}

impl<'a> Entry<'a> {
    /// Any number.
    pub fn any(unit: &'a str, scale: f64, hint: &'a str) -> Entry<'a> {
        Entry { unit, scale, range: f64::NEG_INFINITY..=f64::INFINITY, hint }
    }

    /// Numbers from zero on.
    pub fn positive(unit: &'a str, scale: f64, hint: &'a str) -> Entry<'a> {
        Entry { range: 0.0..=f64::INFINITY, ..Entry::any(unit, scale, hint) }
    }

    /// Shows the value and lets it be dragged or typed; what is typed holds from Enter on. The new value, if it was
    /// changed: by more than its digits show, so that looking at a number never rounds it.
    pub fn show(&self, ui: &mut egui::Ui, value: f64) -> Option<f64> {
        self.widget(ui, value, (DIGITS, None), self.hint)
    }

    fn widget(&self, ui: &mut egui::Ui, value: f64, (digits, width): (usize, Option<f32>), hint: &str) -> Option<f64> {
        let mut new = value;
        let unit = self.unit;
        let speed = (value.abs() * 0.01).max(self.scale.abs() * 0.005);
        let drag = egui::DragValue::new(&mut new)
            .speed(if speed.is_finite() { speed } else { self.scale })
            .range(self.range.clone())
            .clamp_existing_to_range(false)
            .update_while_editing(false)
            .custom_formatter(move |x, _| rounded(x, digits))
            .custom_parser(move |text| parse(text, unit));
        let response = match width {
            // A number that gets longer must not push the panel about.
            Some(width) => ui.add_sized([width, ui.spacing().interact_size.y], drag.clip_text(true)),
            None if unit.is_empty() => ui.add(drag),
            None => ui.add(drag.suffix(format!(" {unit}"))),
        };
        let changed = response.changed();
        response.on_hover_ui(|ui| {
            ui.set_max_width(320.0);
            ui.label(format!("{hint}\n{}", with_unit(value, unit)));
        });
        (changed && rounded(new, digits) != rounded(value, digits)).then_some(new)
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
