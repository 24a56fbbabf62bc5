//! What is said to the user: news that go by themselves, and errors that stay until they are dismissed.

use super::desk::Message;
use eframe::egui;
use std::time::{Duration, Instant};

/// How long news stay.
const NEWS_STAY: Duration = Duration::from_secs(6);
/// Most messages at once; the oldest make room.
const MOST: usize = 6;

/// The messages on the screen.
#[derive(Debug, Default)]
pub struct Messages {
    shown: Vec<(Message, Instant)>,
}

impl Messages {
    /// Takes up new messages. One that is there already begins anew instead of standing there twice.
    pub fn take(&mut self, new: &mut Vec<Message>, now: Instant) {
        for message in new.drain(..) {
            self.shown.retain(|(old, _)| *old != message);
            self.shown.push((message, now));
        }
        let too_many = self.shown.len().saturating_sub(MOST);
        self.shown.drain(..too_many);
        self.shown.retain(|(m, since)| m.is_error || now.saturating_duration_since(*since) < NEWS_STAY);
    }

    /// The texts on the screen, oldest first.
    pub fn texts(&self) -> impl Iterator<Item = &str> {
        self.shown.iter().map(|(m, _)| m.text.as_str())
    }

    /// Whether something will go by itself, so that the screen has to be drawn again.
    pub fn will_change(&self) -> bool {
        self.shown.iter().any(|(m, _)| !m.is_error)
    }

    /// Shows them at the lower left of a place.
    pub fn show(&mut self, context: &egui::Context, within: egui::Rect) {
        if self.shown.is_empty() {
            return;
        }
        let mut dismissed = None;
        let corner = within.left_bottom() + egui::vec2(10.0, -10.0);
        let area = egui::Area::new(egui::Id::unique("messages"))
            .order(egui::Order::Foreground)
            .pivot(egui::Align2::LEFT_BOTTOM);
        area.fixed_pos(corner).show(context, |ui| {
            ui.set_max_width((within.width() - 20.0).clamp(160.0, 460.0));
            for (i, (message, _)) in self.shown.iter().enumerate() {
                if one(ui, message) {
                    dismissed = Some(i);
                }
                ui.add_space(4.0);
            }
        });
        if let Some(i) = dismissed {
            self.shown.remove(i);
        }
    }
}

/// Shows a message; whether it was clicked away.
fn one(ui: &mut egui::Ui, message: &Message) -> bool {
    let color = if message.is_error { ui.visuals().error_fg_color } else { ui.visuals().text_color() };
    let frame = egui::Frame::popup(ui.style()).stroke(egui::Stroke::new(1.0, color.gamma_multiply(0.6)));
    frame
        .show(ui, |ui| {
            ui.horizontal_top(|ui| {
                let close = ui.small_button("\u{d7}").on_hover_text("Dismiss");
                ui.add(egui::Label::new(egui::RichText::new(&message.text).color(color)).wrap());
                close.clicked()
            })
            .inner
        })
        .inner
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(is_error: bool, text: &str) -> Message {
        Message { is_error, text: text.into() }
    }

    #[test]
    fn news_go_and_errors_stay() {
        let (mut shown, start) = (Messages::default(), Instant::now());
        shown.take(&mut vec![message(false, "saved"), message(true, "lost")], start);
        assert!(shown.will_change());
        shown.take(&mut Vec::new(), start + NEWS_STAY);
        assert_eq!(shown.texts().collect::<Vec<_>>(), ["lost"]);
        assert!(!shown.will_change());
    }

    #[test]
    fn nothing_is_said_twice_and_nothing_floods() {
        let (mut shown, start) = (Messages::default(), Instant::now());
        for i in 0..50 {
            shown.take(&mut vec![message(true, "same"), message(true, &i.to_string())], start);
        }
        assert_eq!(shown.texts().count(), MOST);
        assert_eq!(shown.texts().filter(|t| *t == "same").count(), 1);
    }
}
