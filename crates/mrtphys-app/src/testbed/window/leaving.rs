//! Whether what the user has made may be left behind: asked once, before it is lost.

use super::action::Action;
use super::probe::Probes;
use eframe::egui;

/// The question, while it is asked.
#[derive(Default)]
pub struct Leaving {
    wanted: Option<Action>,
}

/// What the user answered.
pub enum Answer {
    /// save first, and stay
    Save,
    /// do what was wanted
    Go(Action),
}

/// What would be lost: bodies and fields that were made or changed by hand since the scene was opened or saved, and files that
/// are not written yet. Nothing is asked of somebody who only watched: a scene begins in the same way again.
pub fn losses(unsaved: bool, jobs: usize) -> Vec<String> {
    let mut list = Vec::new();
    if unsaved {
        list.push("Bodies or fields were changed by hand, and the scene was not saved since.".into());
    }
    match jobs {
        0 => {}
        1 => list.push("A file is still being made: it will not be written.".into()),
        n => list.push(format!("{n} files are still being made: they will not be written.")),
    }
    list
}

impl Leaving {
    /// Asks, before this is done.
    pub fn ask(&mut self, wanted: Action) {
        self.wanted = Some(wanted);
    }

    /// Whether it is being asked.
    pub fn is_open(&self) -> bool {
        self.wanted.is_some()
    }

    /// Shows the question; the answer, once there is one. What nothing would be lost by any more is done.
    pub fn show(&mut self, context: &egui::Context, probes: &mut Probes, losses: &[String]) -> Option<Answer> {
        let wanted = self.wanted.clone()?;
        if losses.is_empty() {
            return self.wanted.take().map(Answer::Go);
        }
        let quits = wanted == Action::Quit;
        let (mut answer, mut stays) = (None, false);
        let modal = egui::Modal::new(egui::Id::unique("leaving")).show(context, |ui| {
            ui.set_width(360.0);
            ui.heading(if quits { "Quit?" } else { "Open another scene?" });
            ui.add_space(4.0);
            for loss in losses {
                ui.add(egui::Label::new(loss).wrap());
            }
            ui.add_space(8.0);
            ui.horizontal(|ui| {
                let mut button = |text: &str, name: &str, hint: &str| {
                    let shown = ui.button(text).on_hover_text(hint);
                    probes.mark(name, &shown);
                    shown.clicked()
                };
                stays = button("Cancel", "leaving.cancel", "Go on with this scene (Escape)");
                if button("Save scene...", "leaving.save", "Write the present state as a scene") {
                    answer = Some(Answer::Save);
                }
                let text = if quits { "Quit all the same" } else { "Open all the same" };
                if button(text, "leaving.go", "What was not saved is lost") {
                    answer = Some(Answer::Go(wanted));
                }
            });
        });
        // The dialog itself knows that it is in front from its second picture on only.
        stays |= context.input(|i| i.key_pressed(egui::Key::Escape));
        if answer.is_some() || stays || modal.should_close() {
            self.wanted = None;
        }
        answer
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_would_be_lost_is_asked_about() {
        assert!(losses(false, 0).is_empty());
        assert_eq!(losses(true, 0).len(), 1);
        let both = losses(true, 2);
        assert!(both[0].contains("by hand") && both[1].starts_with("2 files"));
    }
}
