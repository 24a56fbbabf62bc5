//! A field for a number, dragged or typed. What is typed and cannot be taken is kept, in red and with the reason, until it is
//! mended, or given up with Escape.

use eframe::egui;
use std::cell::RefCell;
use std::ops::RangeInclusive;

/// The reason stands beside the field for so long \[s\]; later where the field has the mouse or the keyboard.
const SAID_FOR: f64 = 5.0;

/// How a number is shown and read.
pub struct Typed<'a> {
    /// as it is written
    pub shown: &'a dyn Fn(f64) -> String,
    /// what a text means, or what was expected instead
    pub read: &'a dyn Fn(&str) -> Result<f64, String>,
    /// what there may be
    pub range: RangeInclusive<f64>,
    /// change for a point of dragging
    pub speed: f64,
    /// points; `None`: as the number needs
    pub width: Option<f32>,
    /// written behind the number
    pub suffix: String,
    /// what it is: said when the mouse rests on it
    pub hint: &'a str,
    /// the number with more digits than are shown: said there too
    pub exact: String,
}

/// What could not be taken.
#[derive(Clone)]
struct Refused {
    text: String,
    why: String,
    /// of which field: another one may stand in its place later
    hint: String,
    width: f32,
    /// when it was shown last: what is not shown is forgotten
    pass: u64,
    /// until when the reason is said unasked
    until: f64,
    /// the keyboard goes back to the field
    focus: bool,
}

impl Typed<'_> {
    /// Shows the number; the new one, if there is one. What is typed holds from Enter on.
    pub fn show(&self, ui: &mut egui::Ui, value: f64) -> (egui::Response, Option<f64>) {
        let key = ui.next_auto_id().with("refused");
        let pass = ui.ctx().cumulative_pass_nr();
        let refused = ui.data(|data| data.get_temp::<Refused>(key));
        let refused = refused.filter(|r| r.hint == self.hint && r.pass + 1 >= pass);
        ui.scope(|ui| match refused {
            Some(refused) => self.mend(ui, key, refused),
            None => self.drag(ui, key, value),
        })
        .inner
    }

    /// What a text means, within the range.
    fn take(&self, text: &str) -> Result<f64, String> {
        let x = (self.read)(text)?;
        if self.range.contains(&x) { Ok(x) } else { Err(self.expected()) }
    }

    fn expected(&self) -> String {
        let end = |x: f64| format!("{}{}", (self.shown)(x), self.suffix);
        match (*self.range.start(), *self.range.end()) {
            (low, f64::INFINITY) => format!("At least {} is expected", end(low)),
            (f64::NEG_INFINITY, high) => format!("At most {} is expected", end(high)),
            (low, high) => format!("{} to {} is expected", end(low), end(high)),
        }
    }

    fn drag(&self, ui: &mut egui::Ui, key: egui::Id, value: f64) -> (egui::Response, Option<f64>) {
        let mut new = value;
        let refused = RefCell::new(None);
        let drag = egui::DragValue::new(&mut new)
            .speed(self.speed)
            .range(self.range.clone())
            .clamp_existing_to_range(false)
            .update_while_editing(false)
            .custom_formatter(|x, _| (self.shown)(x))
            .custom_parser(|text| {
                // Nothing, or what was there: the field was only looked at.
                if text.trim().is_empty() || text == (self.shown)(value) {
                    return None;
                }
                let taken = self.take(text);
                taken.map_err(|why| *refused.borrow_mut() = Some((text.to_string(), why))).ok()
            });
        let response = match self.width {
            // A number that gets longer must not push the panel about.
            Some(width) => ui.add_sized([width, ui.spacing().interact_size.y], drag.clip_text(true)),
            None => ui.add(drag.suffix(self.suffix.clone())),
        };
        if let Some((text, why)) = refused.into_inner() {
            let (hint, width) = (self.hint.to_string(), response.rect.width());
            let refused = Refused { text, why, hint, width, pass: 0, until: 0.0, focus: false };
            remember(ui, key, refused);
        }
        let changed = response.changed();
        let response = response.on_hover_ui(|ui| {
            ui.set_max_width(320.0);
            ui.label(self.hint);
            if !self.exact.is_empty() {
                ui.label(&self.exact);
            }
        });
        (response, changed.then_some(new))
    }

    fn mend(&self, ui: &mut egui::Ui, key: egui::Id, mut refused: Refused) -> (egui::Response, Option<f64>) {
        let color = ui.visuals().error_fg_color;
        let id = key.with("text");
        let edit = egui::TextEdit::singleline(&mut refused.text).id(id).text_color(color).clip_text(true);
        let size = egui::vec2(refused.width, ui.spacing().interact_size.y);
        let response = ui.add_sized(size, edit.min_size(size));
        let frame = egui::Stroke::new(1.0, color);
        ui.painter().rect_stroke(response.rect, 3.0, frame, egui::StrokeKind::Inside);
        if std::mem::take(&mut refused.focus) {
            response.request_focus();
        }
        let mut taken = None;
        let given_up = ui.input(|i| i.key_pressed(egui::Key::Escape)) || refused.text.trim().is_empty();
        if response.lost_focus() {
            match self.take(&refused.text) {
                _ if given_up => return forget(ui, key, response, None),
                Ok(x) => taken = Some(x),
                Err(why) => {
                    refused.why = why;
                    remember(ui, key, refused.clone());
                }
            }
        } else {
            refused.pass = ui.ctx().cumulative_pass_nr();
            ui.data_mut(|data| data.insert_temp(key, refused.clone()));
        }
        if taken.is_some() {
            return forget(ui, key, response, taken);
        }
        let now = ui.input(|i| i.time);
        if now < refused.until || response.has_focus() || response.hovered() {
            say(ui, &response, &refused.why);
        }
        (response, None)
    }
}

/// The text stays for the next picture. Whoever pressed Enter is still at it.
fn remember(ui: &egui::Ui, key: egui::Id, refused: Refused) {
    let (now, focus) = ui.input(|i| (i.time, i.key_pressed(egui::Key::Enter)));
    let refused = Refused { pass: ui.ctx().cumulative_pass_nr(), until: now + SAID_FOR, focus, ..refused };
    ui.data_mut(|data| data.insert_temp(key, refused));
    ui.ctx().request_repaint();
    ui.ctx().request_repaint_after_secs(SAID_FOR as f32);
}

fn forget(ui: &egui::Ui, key: egui::Id, response: egui::Response, taken: Option<f64>) -> (egui::Response, Option<f64>) {
    ui.data_mut(|data| data.remove::<Refused>(key));
    ui.ctx().request_repaint();
    (response, taken)
}

fn say(ui: &egui::Ui, response: &egui::Response, why: &str) {
    if !ui.is_rect_visible(response.rect) {
        return;
    }
    let (id, layer) = (response.id.with("why"), ui.layer_id());
    egui::Tooltip::always_open(ui.ctx().clone(), layer, id, response).width(280.0).show(|ui| {
        ui.colored_label(ui.visuals().error_fg_color, why);
        ui.weak("Escape leaves the number as it was.");
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testbed::window::quantity::read;
    use eframe::egui::{Event, Key, Modifiers, PointerButton, Pos2};

    /// A field from 0 to 10 in a window without a screen.
    struct Window {
        context: egui::Context,
        value: f64,
        at: Pos2,
    }

    impl Window {
        fn new() -> Window {
            let mut window = Window { context: egui::Context::default(), value: 3.0, at: Pos2::ZERO };
            window.show(Vec::new());
            window
        }

        fn show(&mut self, events: Vec<Event>) {
            let (value, mut seen) = (self.value, None);
            let input = egui::RawInput { events, ..egui::RawInput::default() };
            let mut output = self.context.run_ui(input, |ui| {
                let typed = Typed {
                    shown: &|x| x.to_string(),
                    read: &|text| read(text, "m", false),
                    range: 0.0..=10.0,
                    speed: 1.0,
                    width: None,
                    suffix: " m".into(),
                    hint: "length",
                    exact: String::new(),
                };
                seen = Some(typed.show(ui, value));
            });
            output.textures_delta.clear();
            let (response, new) = seen.unwrap();
            self.at = response.rect.center();
            self.value = new.unwrap_or(value);
        }

        fn key(&mut self, key: Key) {
            let event =
                |pressed| Event::Key { key, physical_key: None, pressed, repeat: false, modifiers: Modifiers::NONE };
            self.show(vec![event(true)]);
            self.show(vec![event(false)]);
            self.show(Vec::new());
        }

        fn type_anew(&mut self, text: &str) {
            let (pos, button, modifiers) = (self.at, PointerButton::Primary, Modifiers::NONE);
            for pressed in [true, false] {
                let click = Event::PointerButton { pos, button, pressed, modifiers };
                self.show(vec![Event::PointerMoved(pos), click]);
            }
            self.show(Vec::new());
            self.show(vec![Event::Text(text.into())]);
        }
    }

    #[test]
    fn what_can_be_read_is_taken() {
        let mut window = Window::new();
        window.type_anew("1/4");
        assert_eq!(window.value, 3.0, "not before Enter");
        window.key(Key::Enter);
        assert_eq!(window.value, 0.25);
    }

    #[test]
    fn what_cannot_be_taken_is_kept_to_be_mended() {
        for (wrong, right) in [("4x", 4.0), ("7 s", 7.0), ("100", 10.0)] {
            let mut window = Window::new();
            window.type_anew(wrong);
            window.key(Key::Enter);
            assert_eq!(window.value, 3.0, "{wrong}");
            // The text is still there with the keyboard in it: its last letter goes.
            window.key(Key::Backspace);
            window.key(Key::Enter);
            assert_eq!(window.value, right, "{wrong}");
        }
    }

    #[test]
    fn escape_gives_it_up() {
        let mut window = Window::new();
        window.type_anew("4x");
        window.key(Key::Enter);
        window.key(Key::Escape);
        window.key(Key::Backspace);
        window.key(Key::Enter);
        assert_eq!(window.value, 3.0);
        window.type_anew("5");
        window.key(Key::Enter);
        assert_eq!(window.value, 5.0);
    }
}
