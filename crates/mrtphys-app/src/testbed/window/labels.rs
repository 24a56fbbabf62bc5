//! What is written over the picture.

use super::action::Action;
use super::desk::Desk;
use super::format::{count, duration, number, with_unit};
use super::viewport::Pane;
use crate::testbed::session::{Numbers, Report};
use eframe::egui::{self, Align2, Color32, CornerRadius, FontId, Rect, Ui};
use mrtphys_view::Legend;
use std::time::Duration;

/// Distance from the edges \[points\].
const EDGE: f32 = 8.0;
/// What is below the buttons at the top \[points\].
const BELOW_TOOLS: f32 = 38.0;

/// Text on a plate, so that it can be read on any picture; the plate's rectangle.
fn plate(ui: &Ui, anchor: Align2, at: egui::Pos2, text: &str, within: Rect) -> Rect {
    let font = FontId { size: egui::TextStyle::Small.resolve(ui.style()).size * 1.25, ..egui::FontId::default() };
    let visuals = ui.visuals();
    let most = (within.width() - 4.0 * EDGE).max(40.0);
    let galley = ui.painter().layout(text.to_string(), font, visuals.strong_text_color(), most);
    let size = galley.size() + egui::vec2(10.0, 6.0);
    let mut rect = anchor.anchor_size(at, size);
    // Moved back inside where it would be cut off.
    let (low, high) = (within.min, within.max - size);
    rect = Rect::from_min_size(
        egui::pos2(rect.min.x.clamp(low.x, high.x.max(low.x)), rect.min.y.clamp(low.y, high.y.max(low.y))),
        size,
    );
    let fill = visuals.window_fill.gamma_multiply(0.86);
    ui.painter().rect(rect, CornerRadius::same(4), fill, visuals.window_stroke(), egui::StrokeKind::Inside);
    ui.painter().galley(rect.min + egui::vec2(5.0, 3.0), galley, visuals.text_color());
    rect
}

/// Name and speed beside a body whose centre is here on the screen.
pub fn name_tag(ui: &Ui, pane: Pane, at: egui::Pos2, name: &str, speed: Option<f64>) {
    let text = match speed {
        Some(v) => format!("{name}\n{}", with_unit(v, "m/s")),
        None => format!("{name}\nfixed"),
    };
    plate(ui, Align2::LEFT_BOTTOM, at + egui::vec2(12.0, -12.0), &text, pane.rect.shrink(2.0));
}

/// What went wrong with the picture.
pub fn trouble(ui: &Ui, rect: Rect, text: &str) {
    plate(ui, Align2::CENTER_CENTER, rect.center(), &format!("There is no picture: {text}"), rect);
}

/// Whose picture it is, and what it costs.
pub fn side(ui: &Ui, report: &Report, pane: Pane) {
    let Some(side) = report.sides.get(pane.side) else { return };
    let title = if pane.side == 0 { "World" } else { "Rival" };
    let text = format!("{title}: {}\n{}", settings(&side.numbers), costs(&side.numbers));
    plate(ui, Align2::LEFT_TOP, pane.rect.min + egui::vec2(EDGE, BELOW_TOOLS), &text, pane.rect);
    if pane.side == 1
        && let Some(agrees) = report.rival_agrees
    {
        let at = pane.rect.left_bottom() + egui::vec2(0.0, -EDGE);
        plate(ui, Align2::CENTER_BOTTOM, at, agreement(agrees), egui::Rect::EVERYTHING);
    }
}

/// Whether two states are the same.
pub fn agreement(agrees: bool) -> &'static str {
    if agrees { "Both states are the same, bit for bit" } else { "The states differ" }
}

/// The settings in which worlds are compared.
pub fn settings(numbers: &Numbers) -> String {
    let s = &numbers.settings;
    format!("{}, {}, {}, {}", s.broad_phase, s.friction_law, s.impact, s.integrator)
}

/// Time and tests of a step.
pub fn costs(numbers: &Numbers) -> String {
    let c = &numbers.counters;
    format!(
        "{} a step, {} sphere tests, {} detect calls",
        duration(Duration::from_secs_f64(step_time(numbers))),
        count(c.sphere_tests),
        count(c.detect_calls)
    )
}

/// Computing time of a step \[s\].
pub fn step_time(numbers: &Numbers) -> f64 {
    let stages: f64 = numbers.stages.iter().map(|s| s.1.as_secs_f64()).sum();
    if stages > 0.0 { stages } else { numbers.cost.as_secs_f64() / f64::from(numbers.settings.steps_per_frame.max(1)) }
}

/// What the colors mean, at the lower left.
pub fn legends(ui: &Ui, rect: Rect, legends: &[Legend]) {
    let mut bottom = rect.bottom() - EDGE;
    for legend in legends {
        bottom -=
            if legend.samples.is_empty() { kinds(ui, rect, bottom, legend) } else { ramp(ui, rect, bottom, legend) };
        bottom -= 6.0;
    }
}

fn font(ui: &Ui) -> FontId {
    FontId { size: egui::TextStyle::Small.resolve(ui.style()).size * 1.2, ..FontId::default() }
}

fn ramp(ui: &Ui, rect: Rect, bottom: f32, legend: &Legend) -> f32 {
    let size = egui::vec2(190.0, 46.0);
    let plate = backdrop(ui, Rect::from_min_size(egui::pos2(rect.left() + EDGE, bottom - size.y), size));
    let (painter, color) = (ui.painter(), ui.visuals().text_color());
    let unit = if legend.unit.is_empty() { String::new() } else { format!(" [{}]", legend.unit) };
    painter.text(plate.left_top(), Align2::LEFT_TOP, format!("{}{unit}", legend.title), font(ui), color);
    let bar = Rect::from_min_size(plate.left_top() + egui::vec2(0.0, 15.0), egui::vec2(plate.width(), 9.0));
    let n = legend.samples.len();
    let width = bar.width() / n as f32;
    for (i, [r, g, b]) in legend.samples.iter().enumerate() {
        let x = bar.left() + width * i as f32;
        // A little overlap leaves no seams between pixels.
        let part = Rect::from_x_y_ranges(x..=(x + width + 0.7).min(bar.right()), bar.y_range());
        painter.rect_filled(part, 0.0, Color32::from_rgb(*r, *g, *b));
    }
    for (x, align, value) in [
        (bar.left(), Align2::LEFT_BOTTOM, legend.min),
        (bar.center().x, Align2::CENTER_BOTTOM, (legend.min + legend.max) / 2.0),
        (bar.right(), Align2::RIGHT_BOTTOM, legend.max),
    ] {
        painter.text(egui::pos2(x, plate.bottom()), align, number(value), font(ui), color);
    }
    size.y
}

fn kinds(ui: &Ui, rect: Rect, bottom: f32, legend: &Legend) -> f32 {
    let line = ui.text_style_height(&egui::TextStyle::Small) + 3.0;
    let height = line * (legend.kinds.len() + 1) as f32 + 8.0;
    let size = egui::vec2(150.0, height);
    let plate = backdrop(ui, Rect::from_min_size(egui::pos2(rect.left() + EDGE, bottom - height), size));
    let (painter, color) = (ui.painter(), ui.visuals().text_color());
    painter.text(plate.left_top(), Align2::LEFT_TOP, legend.title, font(ui), color);
    for (i, (name, [r, g, b])) in legend.kinds.iter().enumerate() {
        let at = plate.left_top() + egui::vec2(0.0, line * (i + 1) as f32);
        let dot = Rect::from_min_size(at + egui::vec2(0.0, 1.0), egui::vec2(10.0, line - 4.0));
        painter.rect_filled(dot, 2.0, Color32::from_rgb(*r, *g, *b));
        painter.text(at + egui::vec2(16.0, 0.0), Align2::LEFT_TOP, name, font(ui), color);
    }
    height
}

fn backdrop(ui: &Ui, rect: Rect) -> Rect {
    let visuals = ui.visuals();
    let fill = visuals.window_fill.gamma_multiply(0.86);
    ui.painter().rect(rect, CornerRadius::same(4), fill, visuals.window_stroke(), egui::StrokeKind::Inside);
    rect.shrink2(egui::vec2(7.0, 4.0))
}

/// The buttons at the upper right: what the mouse does.
pub fn tools(ui: &mut Ui, rect: Rect, desk: &mut Desk) {
    let place = Rect::from_min_max(
        egui::pos2(rect.right() - 132.0, rect.top() + EDGE),
        egui::pos2(rect.right() - EDGE, rect.top() + 40.0),
    );
    let builder = egui::UiBuilder::new().max_rect(place).layout(egui::Layout::right_to_left(egui::Align::TOP));
    ui.scope_builder(builder, |ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        let fill = ui.visuals().window_fill.gamma_multiply(0.86);
        let button = |text: &'static str| egui::Button::new(text).fill(fill);
        let hint = "everything fits into the picture (F)";
        let fit = ui.add(button("Fit")).on_hover_text(hint);
        desk.probes.mark("fit", &fit);
        if fit.clicked() {
            desk.actions.push(Action::FitCamera);
        }
        let hint = "the hand: a left drag on a body pulls it with a spring; let go to throw it (H, or hold Alt)";
        let on = desk.seeing.hand;
        let hand =
            ui.add(egui::Button::new("Hand").selected(on).fill(if on { ui.visuals().selection.bg_fill } else { fill }));
        desk.probes.mark("hand", &hand);
        if hand.on_hover_text(hint).clicked() {
            desk.seeing.hand ^= true;
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use mrtphys::counters::Counters;

    #[test]
    fn costs_are_those_of_a_step() {
        let mut numbers = Numbers { cost: Duration::from_millis(16), ..Numbers::default() };
        numbers.counters = Counters { sphere_tests: 133_888, detect_calls: 2088, ..Counters::default() };
        assert_eq!(costs(&numbers), "2.00 ms a step, 133 888 sphere tests, 2 088 detect calls");
        numbers.stages = vec![("move", Duration::from_micros(40)), ("find", Duration::from_micros(60))];
        assert_eq!(step_time(&numbers), 1e-4);
    }

    #[test]
    fn a_world_is_named_by_its_settings() {
        assert_eq!(settings(&Numbers::default()), "sorted-grid, kurtenbach, sequential, parabola");
    }
}
