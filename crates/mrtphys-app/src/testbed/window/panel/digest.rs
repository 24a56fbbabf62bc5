//! The digest of the state, on request.

use crate::testbed::window::ask::Inquiry;
use crate::testbed::window::desk::Desk;
use crate::testbed::window::format::{count, number};
use eframe::egui;

const HINT: &str = "32 digits that stand for the whole state: time, every body, and what contacts remember. Equal hashes mean \
     states that are equal to the last bit. The same scene after the same steps and edits has the same hash on every machine, \
     with every broad phase and number of threads, and 'mrtphys run' reports it, too";

/// A digest, and what it is of.
struct Answer {
    digest: String,
    steps: u64,
    time: f64,
}

/// The line that asks for it and shows it.
#[derive(Default)]
pub struct Digest {
    inquiry: Inquiry<Answer>,
    /// the scene it was asked of
    opened: u64,
}

impl Digest {
    /// Shows it.
    pub fn show(&mut self, ui: &mut egui::Ui, desk: &mut Desk) {
        if self.opened != desk.opened {
            (self.inquiry, self.opened) = (Inquiry::default(), desk.opened);
        }
        let mut copied = None;
        ui.horizontal(|ui| {
            let button = ui.button("State hash").on_hover_text(HINT);
            desk.probes.mark("energies.hash", &button);
            if button.clicked() {
                self.inquiry.ask(&desk.session, ui.ctx(), |studio| {
                    let world = &studio.loaded.world;
                    Answer { digest: world.state_hash(), steps: world.steps(), time: world.time() }
                });
            }
            if let Some(answer) = self.inquiry.answer() {
                let copy = ui.button("Copy").on_hover_text("Put the hash into the clipboard");
                desk.probes.mark("energies.copy hash", &copy);
                copied = copy.clicked().then(|| answer.digest.clone());
            }
        });
        if let Some(text) = copied {
            ui.ctx().copy_text(text);
        }
        let steps = desk.report().sides.first().map_or(0, |side| side.numbers.steps);
        if let Some(answer) = self.inquiry.answer() {
            desk.probes.say(|| "energies.hash".into(), &answer.digest);
            ui.add(egui::Label::new(egui::RichText::new(&answer.digest).monospace()).wrap()).on_hover_text(HINT);
            ui.weak(whose(answer, steps));
        }
    }
}

/// Which state a digest is of, now that so many steps are made.
fn whose(answer: &Answer, steps: u64) -> String {
    let s = if answer.steps == 1 { "" } else { "s" };
    let of = format!("after {} physical step{s}, at {} s", count(answer.steps), number(answer.time));
    if answer.steps == steps { of } else { format!("{of}; time has moved on") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_digest_says_which_state_it_is_of() {
        let mut answer = Answer { digest: String::new(), steps: 1280, time: 2.5 };
        assert_eq!(whose(&answer, 1280), "after 1 280 physical steps, at 2.5 s");
        assert_eq!(whose(&answer, 1281), "after 1 280 physical steps, at 2.5 s; time has moved on");
        answer.steps = 1;
        assert_eq!(whose(&answer, 1), "after 1 physical step, at 2.5 s");
    }
}
