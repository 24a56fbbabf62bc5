//! Questions to the session's thread whose answers come a little later.

use crate::testbed::session::{Command, Session, Studio};
use std::sync::mpsc::{self, Receiver};

/// A question, and the newest answer to it.
pub struct Inquiry<T> {
    waiting: Option<Receiver<T>>,
    answer: Option<T>,
}

impl<T> Default for Inquiry<T> {
    fn default() -> Inquiry<T> {
        Inquiry { waiting: None, answer: None }
    }
}

impl<T: Send + 'static> Inquiry<T> {
    /// Asks. An answer that is still under way is no longer waited for; the last one stays until the new one is there.
    pub fn ask(
        &mut self,
        session: &Session,
        context: &eframe::egui::Context,
        question: impl FnOnce(&Studio<'_>) -> T + Send + 'static,
    ) {
        let (sender, receiver) = mpsc::channel();
        let context = context.clone();
        session.send(Command::Ask(Box::new(move |studio: &Studio<'_>| {
            // Whoever no longer waits does not mind.
            let _ = sender.send(question(studio));
            context.request_repaint();
        })));
        self.waiting = Some(receiver);
    }

    /// Whether an answer is under way.
    pub fn is_waiting(&mut self) -> bool {
        self.take();
        self.waiting.is_some()
    }

    /// The newest answer.
    pub fn answer(&mut self) -> Option<&T> {
        self.take();
        self.answer.as_ref()
    }

    /// Forgets question and answer.
    pub fn clear(&mut self) {
        (self.waiting, self.answer) = (None, None);
    }

    fn take(&mut self) {
        let Some(receiver) = &self.waiting else { return };
        match receiver.try_recv() {
            Ok(answer) => (self.waiting, self.answer) = (None, Some(answer)),
            Err(mpsc::TryRecvError::Disconnected) => self.waiting = None,
            Err(mpsc::TryRecvError::Empty) => {}
        }
    }
}
