//! How time passes (thesis, section 7.1 and appendix B.3).

use crate::testbed::session::{Command, Numbers, PaceReport, RealTime, Report, time_code};
use crate::testbed::window::action::Action;
use crate::testbed::window::desk::Desk;
use crate::testbed::window::format::{brief, count, reading};
use crate::testbed::window::pending::Pending;
use crate::testbed::window::quantity::{Entry, Slid};
use crate::testbed::window::table::{Row, rows};
use eframe::egui;
use std::time::Instant;

/// Limits of the sliders and of what can be typed in; a scene may say more.
const FPS: std::ops::RangeInclusive<u32> = 1..=1000;
const STEPS: std::ops::RangeInclusive<u32> = 1..=1000;
/// Simulated seconds per real second.
const SPEEDS: std::ops::RangeInclusive<f64> = 0.01..=100.0;

/// The section.
#[derive(Default)]
pub struct Animation {
    fps: Pending<u32>,
    steps: Pending<u32>,
    speed: Pending<f64>,
    real_time: Pending<RealTime>,
}

/// The buttons: name in tests, text, action, hint.
const BUTTONS: [(&str, &str, Action, &str); 4] = [
    ("animation.back", "Back", Action::Back, "Go back by one frame (Left)"),
    ("animation.step", "Step", Action::Step, "Make one frame, and stand still (Right)"),
    ("animation.physical", "Substep", Action::PhysicalStep, "Make one physical step, and stand still (.)"),
    ("animation.restart", "Restart", Action::Restart, "Begin again with the scene as it was loaded (R)"),
];

impl Animation {
    /// Shows it.
    pub fn show(&mut self, ui: &mut egui::Ui, desk: &mut Desk) {
        let report = desk.report();
        let Some(side) = report.sides.first() else { return };
        let (numbers, pace, running) = (side.numbers.clone(), report.pace, report.running);
        let code = time_code(numbers.frame, numbers.settings.fps);
        buttons(ui, running, desk);
        desk.probes.say(|| "animation.code".into(), &code);
        let code = egui::RichText::new(code).monospace().size(18.0);
        ui.vertical_centered(|ui| {
            ui.label(code).on_hover_text("Time code: hours h: minutes ': seconds \": frames f of animation time");
        });
        rows(ui, &mut desk.probes, "animation", &clock_rows(&numbers));
        ui.add_space(4.0);
        self.rates(ui, &numbers, desk);
        self.real_time(ui, &pace, desk);
        ui.add_space(4.0);
        let pace = pace_rows(desk.report(), &numbers);
        rows(ui, &mut desk.probes, "animation", &pace);
    }

    fn rates(&mut self, ui: &mut egui::Ui, numbers: &Numbers, desk: &mut Desk) {
        let now = Instant::now();
        let hint = "Frames per second of animation time [1/s]. Setting it begins the frame counter anew";
        let mut fps = self.fps.shown(numbers.settings.fps, now);
        let (slider, changed) = rate(ui, "Frames per Second", hint, &mut fps, FPS);
        desk.probes.mark("animation.fps", &slider);
        if changed {
            self.fps.ask(fps, now);
            desk.send(Command::Fps(fps.max(1)));
        }
        let hint = "Physical steps that a frame is divided into: more of them are more exact and slower. The frame counter goes on";
        let mut steps = self.steps.shown(numbers.settings.steps_per_frame, now);
        let (slider, changed) = rate(ui, "Physical Steps per Frame", hint, &mut steps, STEPS);
        desk.probes.mark("animation.steps", &slider);
        if changed {
            self.steps.ask(steps, now);
            desk.send(Command::StepsPerFrame(steps.max(1)));
        }
    }

    fn real_time(&mut self, ui: &mut egui::Ui, pace: &PaceReport, desk: &mut Desk) {
        let now = Instant::now();
        let mode = self.real_time.shown(pace.real_time, now);
        ui.horizontal(|ui| {
            ui.label("Realtime").on_hover_text("How animation time follows real time");
            for (value, name) in RealTime::ALL {
                let shown = ui.selectable_label(mode == value, name).on_hover_text(meaning(value));
                desk.probes.mark(&format!("animation.realtime.{name}"), &shown);
                if shown.clicked() {
                    self.real_time.ask(value, now);
                    desk.send(Command::RealTime(value));
                }
            }
        });
        if mode == RealTime::Off {
            return;
        }
        let speed = self.speed.shown(pace.speed, now);
        let hint = "Seconds of animation time for a second of real time: 0.1 is slow motion";
        ui.label("Speed").on_hover_text(hint);
        let entry = Entry { range: SPEEDS, ..Entry::any("\u{d7}", 1.0, hint) };
        let (slider, new) = entry.slider(ui, speed, &Slid::new(SPEEDS, true));
        desk.probes.mark("animation.speed", &slider);
        if let Some(speed) = new {
            self.speed.ask(speed, now);
            desk.send(Command::Speed(speed));
        }
    }
}

/// What a real-time mode does.
pub fn meaning(mode: RealTime) -> &'static str {
    match mode {
        RealTime::Off => "As fast as it can be computed. \"fps reached\" says how fast that is",
        RealTime::IfPossible => {
            "Slowed down so that animation time never runs ahead of real time. It falls behind where frames are costly: \"fps reached\" tells"
        }
        RealTime::Forced => {
            "Kept together with real time: after a slow frame the late ones are merged into one with the physical steps of one, which is less exact. \"skipped\" counts them"
        }
    }
}

fn buttons(ui: &mut egui::Ui, running: bool, desk: &mut Desk) {
    let gap = ui.spacing().item_spacing.x;
    let width = (ui.available_width() - 4.0 * gap) / 5.0;
    let size = egui::vec2(width, 26.0);
    ui.horizontal(|ui| {
        // All five side by side in a narrow panel.
        ui.spacing_mut().button_padding.x = 1.0;
        let (text, hint) = if running { ("Stop", "Stand still (Space)") } else { ("Go", "Let time pass (Space)") };
        let go = egui::Button::new(egui::RichText::new(text).strong()).selected(running);
        let go = ui.add_sized(size, go).on_hover_text(hint);
        desk.probes.mark("animation.go", &go);
        if go.clicked() {
            desk.actions.push(Action::Go);
        }
        for (name, text, action, hint) in BUTTONS {
            let button = ui.add_sized(size, egui::Button::new(text)).on_hover_text(hint);
            desk.probes.mark(name, &button);
            if button.clicked() {
                desk.actions.push(action);
            }
        }
    });
}

fn rate(
    ui: &mut egui::Ui,
    name: &str,
    hint: &str,
    value: &mut u32,
    range: std::ops::RangeInclusive<u32>,
) -> (egui::Response, bool) {
    ui.label(name).on_hover_text(hint);
    let slid = Slid::new(f64::from(*range.start())..=f64::from(*range.end()), true);
    Entry::whole("", range, hint).count_slider(ui, value, &slid)
}

fn clock_rows(n: &Numbers) -> Vec<Row<'static>> {
    let s = &n.settings;
    let per_second = u64::from(s.fps) * u64::from(s.steps_per_frame);
    vec![
        Row::new("simulated time", format!("{} s", reading(n.time)), "Since the start of the scene [s]"),
        Row::new("frame", count(n.frame), "Frames since the frame rate was set"),
        Row::new("physical steps", count(n.steps), "Since the start of the scene"),
        Row::new("step length", format!("1/{} s", count(per_second)), "Simulated time of a physical step [s]"),
    ]
}

fn pace_rows(report: &Report, n: &Numbers) -> Vec<Row<'static>> {
    let pace = &report.pace;
    let reached =
        if report.running { format!("{} of {}", brief(pace.fps_reached), n.settings.fps) } else { "-".into() };
    let mut list = vec![Row::new(
        "fps reached",
        reached,
        "Frames computed per second of real time, and how many there are in a second of animation time",
    )];
    if pace.real_time == RealTime::Forced {
        list.push(Row::new(
            "skipped",
            count(pace.skipped),
            "Frames that were merged into others to keep up with real time",
        ));
    }
    list
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_step_length_is_said_as_the_fraction_it_is() {
        let rows = clock_rows(&Numbers { steps: 1234, ..Numbers::default() });
        let said: Vec<&str> = rows.iter().map(|r| r.value.as_str()).collect();
        assert_eq!(said, ["0 s", "0", "1 234", "1/480 s"]);
    }
}
