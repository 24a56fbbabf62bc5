//! Computing time of each stage of a step.

use crate::testbed::window::desk::Desk;
use crate::testbed::window::format::duration;
use crate::testbed::window::table::{Row, rows};
use eframe::egui;
use std::time::Duration;

/// The section.
#[derive(Default)]
pub struct Stages {}

impl Stages {
    /// Shows it.
    pub fn show(&mut self, ui: &mut egui::Ui, desk: &mut Desk) {
        let Some(side) = desk.report().sides.first() else { return };
        let n = side.numbers.clone();
        let steps = n.settings.steps_per_frame.max(1);
        let parts = parts(&n.stages);
        if parts.is_empty() {
            ui.weak("No step has been made yet.");
        }
        for (name, time, part) in parts {
            bar(ui, name, time, part);
        }
        ui.add_space(2.0);
        rows(
            ui,
            &mut desk.probes,
            "stages",
            &[
                Row::sum(
                    "step",
                    duration(n.stages.iter().map(|s| s.1).sum()),
                    "All stages of a physical step together, averaged over the latest steps",
                ),
                Row::new(
                    "last frame",
                    duration(n.cost),
                    "Computing time of the last frame with all its physical steps",
                ),
                Row::new("steps of a frame", steps.to_string(), "Physical steps per frame"),
            ],
        );
    }
}

/// Stages with their share of the whole.
fn parts(stages: &[(&'static str, Duration)]) -> Vec<(&'static str, Duration, f32)> {
    let whole: f64 = stages.iter().map(|s| s.1.as_secs_f64()).sum();
    let part = |d: Duration| if whole > 0.0 { (d.as_secs_f64() / whole) as f32 } else { 0.0 };
    stages.iter().map(|&(name, time)| (name, time, part(time))).collect()
}

/// Widths of the columns \[points\]: name, time, share.
const NAME: f32 = 74.0;
const TIME: f32 = 66.0;
const SHARE: f32 = 44.0;
const LINE: f32 = 18.0;

fn bar(ui: &mut egui::Ui, name: &str, time: Duration, part: f32) {
    let width = ui.available_width();
    let (rect, response) = ui.allocate_exact_size(egui::vec2(width, LINE), egui::Sense::hover());
    let (painter, visuals) = (ui.painter(), ui.visuals());
    let text = |x: f32, align: egui::Align2, style: egui::TextStyle, text: String| {
        let at = egui::pos2(x, rect.center().y);
        painter.text(at, align, text, style.resolve(ui.style()), visuals.text_color());
    };
    text(rect.left(), egui::Align2::LEFT_CENTER, egui::TextStyle::Body, name.into());
    text(rect.right() - SHARE, egui::Align2::RIGHT_CENTER, egui::TextStyle::Monospace, duration(time));
    text(rect.right(), egui::Align2::RIGHT_CENTER, egui::TextStyle::Monospace, format!("{:.0} %", 100.0 * part));
    let left = egui::pos2(rect.left() + NAME, rect.top() + 4.0);
    let right = egui::pos2(rect.right() - SHARE - TIME, rect.bottom() - 4.0);
    let mut bar = egui::Rect::from_min_max(left, right.max(left));
    painter.rect_filled(bar, 2.0, visuals.extreme_bg_color);
    bar.set_width(bar.width() * part.clamp(0.0, 1.0));
    painter.rect_filled(bar, 2.0, visuals.selection.bg_fill);
    response.on_hover_text(hint(name));
}

/// What a stage does.
fn hint(name: &str) -> &'static str {
    match name {
        "motion" => "Force and flow fields, and the motion of every body over the step",
        "bounds" => "Bounding spheres and boxes of all bodies",
        "broad" => "Broad phase: pairs that may collide",
        "narrow" => "Narrow phase: the contacts of those pairs",
        "impact" => "Impulses of the contacts",
        "projection" => "Overlaps that are pushed apart",
        _ => "A stage of a physical step",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_add_up_to_the_whole() {
        let ms = Duration::from_millis;
        let shares = parts(&[("motion", ms(1)), ("broad", ms(3))]);
        assert_eq!((shares[0].2, shares[1].2), (0.25, 0.75));
        assert_eq!(parts(&[("motion", Duration::ZERO)])[0].2, 0.0);
    }
}
