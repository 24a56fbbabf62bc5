//! The bar at the bottom: like a player's, over the recording.

use super::action::Action;
use super::desk::Desk;
use super::format::brief;
use super::pending::Pending;
use crate::testbed::session::{Command, RealTime, time_code};
use eframe::egui::{self, Color32, Painter, Pos2, Rect, Shape, Stroke, pos2, vec2};
use std::time::Instant;

/// The bar.
#[derive(Default)]
pub struct Transport {
    sought: Pending<u64>,
}

/// What is drawn on a button: letters for these are missing in many fonts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Icon {
    ToStart,
    Back,
    Play,
    Pause,
    Forward,
}

const BUTTON: egui::Vec2 = vec2(30.0, 26.0);

impl Transport {
    /// Shows it.
    pub fn show(&mut self, ui: &mut egui::Ui, desk: &mut Desk) {
        let report = desk.report();
        let Some(side) = report.sides.first() else { return };
        let (running, line, pace) = (report.running, report.timeline, report.pace);
        let code = time_code(side.numbers.frame, side.numbers.settings.fps);
        ui.horizontal_centered(|ui| {
            button(
                ui,
                desk,
                "transport.restart",
                Icon::ToStart,
                "Begin again with the scene as it was loaded (R)",
                Action::Restart,
            );
            button(ui, desk, "transport.back", Icon::Back, "One frame back (Left)", Action::Back);
            let (icon, hint) =
                if running { (Icon::Pause, "Stand still (Space)") } else { (Icon::Play, "Let time pass (Space)") };
            button(ui, desk, "transport.go", icon, hint, Action::Go);
            button(ui, desk, "transport.step", Icon::Forward, "One frame forward (Right)", Action::Step);
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                let speed = match pace.real_time {
                    RealTime::Off => "unbraked".into(),
                    _ => format!("\u{d7} {}", brief(pace.speed)),
                };
                let hint = "Seconds of animation time for a second of real time (panel: Animation)";
                fixed(ui, 66.0, &speed).on_hover_text(hint);
                let hint = "Time code: hours h: minutes ': seconds \": frames f of animation time";
                let code_shown = fixed(ui, 168.0, &code).on_hover_text(hint);
                desk.probes.mark("transport.code", &code_shown);
                desk.probes.say(|| "transport.code".into(), &code);
                let now = Instant::now();
                let mut at = self.sought.shown(line.now, now);
                let slider = scrub(ui, &mut at, line.first, line.last).on_hover_text(
                    "The recording: drag to go back to a frame. Running on from there replaces what came after",
                );
                desk.probes.mark("transport.scrub", &slider);
                if slider.changed() {
                    self.sought.ask(at, now);
                    desk.send(Command::Seek(at));
                }
            });
        });
    }
}

fn fixed(ui: &mut egui::Ui, width: f32, text: &str) -> egui::Response {
    let label = egui::Label::new(egui::RichText::new(text).monospace()).truncate();
    ui.add_sized([width, BUTTON.y], label)
}

/// A slider over the frames of the recording that fills the line.
fn scrub(ui: &mut egui::Ui, at: &mut u64, first: u64, last: u64) -> egui::Response {
    ui.spacing_mut().slider_width = (ui.available_width() - 8.0).max(40.0);
    let slider = egui::Slider::new(at, first..=last.max(first + 1)).show_value(false).trailing_fill(true);
    ui.add_enabled(last > first, slider)
}

fn button(ui: &mut egui::Ui, desk: &mut Desk, name: &str, icon: Icon, hint: &str, action: Action) {
    let shown = ui.add_sized(BUTTON, egui::Button::new("")).on_hover_text(hint);
    let color = ui.style().interact(&shown).fg_stroke.color;
    paint(ui.painter(), shown.rect, icon, color);
    desk.probes.mark(name, &shown);
    if shown.clicked() {
        desk.actions.push(action);
    }
}

fn paint(painter: &Painter, rect: Rect, icon: Icon, color: Color32) {
    let (c, r) = (rect.center(), 5.0);
    let triangle = |tip: Pos2, to: f32| {
        let points = vec![tip, tip + vec2(-to * 1.7 * r, -r), tip + vec2(-to * 1.7 * r, r)];
        painter.add(Shape::convex_polygon(points, color, Stroke::NONE));
    };
    let bar = |x: f32| {
        painter.rect_filled(Rect::from_center_size(pos2(x, c.y), vec2(2.6, 2.0 * r)), 0.0, color);
    };
    match icon {
        Icon::Play => triangle(c + vec2(0.9 * r, 0.0), 1.0),
        Icon::Pause => [-3.0, 3.0].iter().for_each(|dx| bar(c.x + dx)),
        Icon::Forward => {
            triangle(c + vec2(0.5 * r, 0.0), 1.0);
            bar(c.x + 1.2 * r);
        }
        Icon::Back => {
            triangle(c - vec2(0.5 * r, 0.0), -1.0);
            bar(c.x - 1.2 * r);
        }
        Icon::ToStart => {
            triangle(c - vec2(0.9 * r, 0.0), -1.0);
            triangle(c + vec2(0.7 * r, 0.0), -1.0);
            bar(c.x - 1.4 * r);
        }
    }
}
